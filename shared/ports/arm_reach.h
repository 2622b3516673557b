#pragma once
// The planner's view of an arm: what its joints can do of a plan. One thread at a time.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "shared/math/pose.h"
#include "shared/motion/outcome.h"
#include "shared/plan/plan.h"

namespace tenon {

/// Where a plan may have brought an arm: all places of the tool that its steps so far allow, and
/// the joint positions that reach them continuously. Never changes.
class ArmPlace {
 public:
  ArmPlace() = default;
  ArmPlace(const ArmPlace&) = delete;
  ArmPlace& operator=(const ArmPlace&) = delete;
  virtual ~ArmPlace() = default;

  /// After one more step, from anywhere here to anywhere that its envelopes allow.
  /// @param contacts that the tool may hold as the step begins
  /// @param why set to one line where the arm cannot make the step
  /// @return null where it cannot
  [[nodiscard]] virtual std::shared_ptr<const ArmPlace> after(const Step& step,
                                                              ContactSignature contacts,
                                                              std::string& why) const = 0;

  /// The same plan's tool at one pose, however it may have come there.
  /// @param tool as the arm knows it, task frame  @return null where the arm cannot hold it
  [[nodiscard]] virtual std::shared_ptr<const ArmPlace> elsewhere(const Pose& tool,
                                                                  std::string& why) const = 0;
};

class ArmReach {
 public:
  ArmReach() = default;
  ArmReach(const ArmReach&) = delete;
  ArmReach& operator=(const ArmReach&) = delete;
  virtual ~ArmReach() = default;

  /// Where a plan begins. @param draft its start, compliance and parameter sets; steps do not count
  /// @param why set to one line where there is no such place  @return null where the arm cannot
  /// hold the start, or not move along the plan's axes there
  [[nodiscard]] virtual std::shared_ptr<const ArmPlace> start(const Plan& draft,
                                                              std::string& why) const = 0;

  struct Refusal {
    std::size_t step = 0;
    std::string why;  ///< one line
  };

  /// Of a whole plan, as the executor's dry run says. @return empty where the arm can execute it
  [[nodiscard]] virtual std::optional<Refusal> refusal(const Plan& plan) const = 0;
};

}  // namespace tenon
