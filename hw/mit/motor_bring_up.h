#pragma once
// Brings motors in MIT mode from anywhere to known settings, one after the other, off all the time:
// each is switched off, and its registers are read. What the robot file says and a motor may be
// told is written and read back; what other tools rely on must be there already. A state machine
// with time and frames as arguments. Not real-time; one thread.
//
//   kAsking -- answer, as it should be ---> the next register, in the end kDone
//           -- another value, writable ---> written, asked again
//           -- another value -------------> kFailed
//           -- silence, three times ------> kFailed

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

/// A register, and what it must hold.
struct RegisterSetting {
  std::uint8_t number = 0;
  std::uint32_t value = 0;  ///< of a float, its bits
  bool writable = false;
};

/// Of a joint's motor, in the order of bring-up.
[[nodiscard]] std::vector<RegisterSetting> motor_settings(const Joint& joint);

/// "PMAX (register 21)", and the value as people read it.
[[nodiscard]] const char* register_name(std::uint8_t number);
[[nodiscard]] bool is_float(std::uint8_t number);

class MotorBringUp {
 public:
  enum class State : std::uint8_t { kAsking, kDone, kFailed };
  static constexpr std::int64_t kAnswer_ns = 100'000'000;
  static constexpr int kTries = 3;

  explicit MotorBringUp(const Robot& robot);

  /// Starts over.
  void restart();
  /// Takes in a frame.
  void process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus);
  /// Asks, and asks again.
  void update(std::int64_t now_ns, CanBus& bus);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const ArmFault& fault() const { return fault_; }

 private:
  struct Task {
    std::size_t joint = 0;
    RegisterSetting setting;
  };

  void ask(std::int64_t now_ns, CanBus& bus);
  void fail(ArmFaultKind kind, std::uint32_t code);
  void advance(std::int64_t now_ns, CanBus& bus);

  std::vector<Joint> joints_;
  std::vector<Task> tasks_;
  std::size_t at_ = 0;
  int tries_ = 0;
  bool written_ = false;  ///< the present register has been
  std::int64_t asked_ns_ = 0;
  State state_ = State::kAsking;
  ArmFault fault_;
};

}  // namespace tenon::hw::mit
