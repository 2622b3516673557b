#pragma once
// What the motions of an identification have in common: drives on, something slow and watched,
// drives off. A cycle is as the controller's: feedback in, joint setpoints out, no clock, bus or
// thread.
//
//   waiting -- enabled --> active -- done, stop, limit --> stopping -- at rest --> disabling -->
//   finished
//                            \------- fault ---> quick stopping --- at rest ------/
//
// Real-time but for the constructor and begin(): no allocation, no lock, no throw. One thread.

#include <cstdint>

#include "executor/ending.h"
#include "executor/joint_command.h"
#include "executor/supervision.h"
#include "executor/tool_kinematics.h"
#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class IdentificationMotion {
 public:
  struct Command {
    ArmRequest request = ArmRequest::kDisabled;
    JointVector position{};
  };

  /// Copies the cell. @throws InputError for a robot without joints
  explicit IdentificationMotion(const Cell& cell);
  IdentificationMotion(const IdentificationMotion&) = delete;
  IdentificationMotion& operator=(const IdentificationMotion&) = delete;
  virtual ~IdentificationMotion() = default;

  [[nodiscard]] Command cycle(const ArmFeedback& feedback) noexcept;
  /// Ends it in the next cycle.
  void request_stop() noexcept { stop_requested_ = true; }

  [[nodiscard]] bool finished() const noexcept { return state_ == State::kFinished; }
  /// kNone where nothing went wrong.
  [[nodiscard]] const Ending& ending() const noexcept { return ending_; }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }

 protected:
  /// The drives are on and the joints rest.
  virtual void begin() = 0;
  /// One cycle of it. @return true: done, all at rest or nearly
  virtual bool act(const ArmFeedback& feedback) = 0;

  void end(const Ending& ending);
  /// Joints or tool that cannot be followed end it.
  template <typename Target>
  void follow(const Target& target) {
    if (const auto refused = joints_.follow(target)) end(*refused);
  }

  [[nodiscard]] const ToolKinematics& kinematics() const { return kinematics_; }
  [[nodiscard]] Supervision& supervision() { return supervision_; }
  [[nodiscard]] const Supervision& supervision() const { return supervision_; }
  [[nodiscard]] const JointVector& commanded() const { return joints_.position(); }
  [[nodiscard]] double cycle_s() const { return cycle_s_; }

 private:
  enum class State : std::uint8_t {
    kWaiting = 0,
    kActive = 1,
    kStopping = 2,
    kQuickStopping = 3,
    kDisabling = 4,
    kFinished = 5,
  };

  void enter(State state);
  void run_state(const ArmFeedback& feedback);
  void wait_for_drives(const ArmFeedback& feedback);
  void wait_for_power_off(const ArmFeedback& feedback);
  [[nodiscard]] ArmRequest request() const;

  Cell cell_;
  double cycle_s_;
  ToolKinematics kinematics_;
  Supervision supervision_;
  JointCommand joints_;
  State state_ = State::kWaiting;
  double in_state_s_ = 0.0;
  bool stop_requested_ = false;
  Ending ending_;
};

}  // namespace tenon::executor
