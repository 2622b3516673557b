#pragma once
// The planner's port to an arm's reach, answered by the dry run: every step is walked through by
// the same code, by the same bounds, as the executor will before it moves. Allocates; one thread at
// a time.

#include <memory>
#include <optional>
#include <string>

#include "shared/cell/cell.h"
#include "shared/ports/arm_reach.h"

namespace tenon::executor {

class CellReach final : public ArmReach {
 public:
  /// @throws InputError for a robot without joints
  explicit CellReach(Cell cell);
  ~CellReach() override;

  [[nodiscard]] std::shared_ptr<const ArmPlace> start(const Plan& draft,
                                                      std::string& why) const override;
  [[nodiscard]] std::optional<Refusal> refusal(const Plan& plan) const override;

 private:
  struct Arm;
  class Place;
  class Root;
  class Stepped;
  struct Of;

  std::shared_ptr<const Arm> arm_;
};

}  // namespace tenon::executor
