#pragma once
// Whether motors that have come on are still what bring-up has made of them: one that was reset
// since then is in another mode, and without a TIMEOUT. Reads those registers back, one a cycle,
// while all motors stand. Real-time, no allocation, one thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hw/mit/motor_bring_up.h"
#include "shared/cell/robot.h"
#include "shared/mit/robot_motors.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

class MotorRecheck {
 public:
  static constexpr int kAnswerCycles = 5;
  static constexpr int kTries = 3;

  explicit MotorRecheck(const Robot& robot);

  /// None is known to be as it was.
  void restart() noexcept;
  /// Once a cycle while all motors are on: what to ask now.
  [[nodiscard]] std::optional<CanFrame> next() noexcept;
  /// @return that the frame was the answer that is waited for
  [[nodiscard]] bool take(const CanFrame& frame) noexcept;

  [[nodiscard]] bool done() const noexcept { return at_ == count_; }
  /// A motor that is not as it was, or does not say.
  [[nodiscard]] const std::optional<ArmFault>& fault() const noexcept { return fault_; }

 private:
  struct Question {
    std::uint8_t node = 0;
    std::uint8_t number = 0;
    std::uint32_t value = 0;
    MitMotor motor;
  };

  std::array<Question, 2 * kMaxJoints> questions_{};
  std::size_t count_ = 0;
  std::size_t at_ = 0;
  int tries_ = 0;
  int waited_ = 0;  ///< cycles since the question
  std::optional<ArmFault> fault_;
};

}  // namespace tenon::hw::mit
