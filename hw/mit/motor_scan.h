#pragma once
// Which motors in MIT mode answer, what they hold and how they do. It asks alone: it writes
// nothing, and switches no motor on or off. Time and frames are arguments; no I/O but the bus. Not
// real-time; one thread.
//
// Each motor in its turn is asked for its registers, then for a feedback. One that has told none of
// three questions its MST_ID counts as silent.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

class MotorScan {
 public:
  static constexpr std::int64_t kAnswer_ns = 100'000'000;
  static constexpr int kTries = 3;

  struct Found {
    std::optional<std::uint32_t> answers_on;  ///< an identifier; unset: it is silent
    std::map<std::uint8_t, std::uint32_t> registers{};
    std::optional<CanFrame> feedback{};  ///< unset: it gives none by request
  };

  explicit MotorScan(const Robot& robot);

  /// Takes in a frame. A motor answers on whatever MST_ID it has.
  void process(const CanFrame& frame);
  /// Asks, and asks again. Call it about every millisecond.
  void update(std::int64_t now_ns, CanBus& bus);
  [[nodiscard]] bool done() const { return at_ == found_.size(); }
  /// By joint.
  [[nodiscard]] const Found& found(std::size_t joint) const { return found_[joint]; }

 private:
  [[nodiscard]] bool asks_feedback() const;
  void next(bool silent);

  std::vector<Joint> joints_;
  std::vector<Found> found_;
  std::size_t at_ = 0;        ///< joint
  std::size_t question_ = 0;  ///< its registers, then the feedback
  int tries_ = 0;
  std::int64_t asked_ns_ = 0;
};

// Lines for people.
/// "motor 1 (arm_1): answers on 0x011, PMAX 3.2, VMAX 5, TMAX 40, CTRL_MODE 1, TIMEOUT 400", or
/// that it is silent.
[[nodiscard]] std::string describe_registers(const Robot& robot, std::size_t joint,
                                             const MotorScan::Found& found);
/// "motor 1 (arm_1): off, joint at 0.1200 rad, -0.10 Nm, board 31 degC, coil 36 degC", or why not.
[[nodiscard]] std::string describe_state(const Robot& robot, std::size_t joint,
                                         const MotorScan::Found& found);
/// What bring-up would refuse such a motor for; empty: nothing.
[[nodiscard]] std::string refusal_of(const Robot& robot, std::size_t joint,
                                     const MotorScan::Found& found);
/// It answers, and has no error.
[[nodiscard]] bool is_well(const Robot& robot, std::size_t joint, const MotorScan::Found& found);

}  // namespace tenon::hw::mit
