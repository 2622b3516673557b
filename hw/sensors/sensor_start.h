#pragma once
// Brings a sensor that is no CANopen node to where it measures: one question after the other, each
// asked up to three times. A state machine with time and frames as arguments; which questions, and
// what answers them, each sensor says. Not real-time; one thread.
//
//   kAsking -- the answer ---------> the next question, in the end kDone
//           -- a wrong answer -----> kFailed: kConfiguration, or as the sensor says
//           -- silence, three times -> kFailed: kNoAnswer, object: what was asked
//
// Whatever else comes, from this sensor or others, is no answer.

#include <cstddef>
#include <cstdint>

#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class SensorStart {
 public:
  enum class State : std::uint8_t { kAsking, kDone, kFailed };
  static constexpr std::int64_t kAnswer_ns = 100'000'000;
  static constexpr int kTries = 3;

  /// @param bus that the sensor is on
  explicit SensorStart(std::uint8_t bus) : bus_(bus) {}
  SensorStart(const SensorStart&) = delete;
  SensorStart& operator=(const SensorStart&) = delete;
  virtual ~SensorStart() = default;

  /// Starts over.
  void restart();
  /// Takes in a frame.
  void process(const CanFrame& frame);
  /// Asks, and asks again.
  void update(std::int64_t now_ns, CanBus& bus);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const ArmFault& fault() const { return fault_; }

 protected:
  struct Question {
    CanFrame frame;
    std::uint32_t object = 0;               ///< what it is about, for the fault
    bool is_answered = true;                ///< false: what follows just waits for so long
    std::int64_t patience_ns = kAnswer_ns;  ///< for an answer
  };
  enum class Heard : std::uint8_t { kNothing, kAnswer, kWrong };

  [[nodiscard]] virtual std::size_t questions() const = 0;
  [[nodiscard]] virtual Question question(std::size_t which) const = 0;
  /// A question is about to be asked, perhaps again.
  virtual void begin(std::size_t /*which*/) {}
  /// @param fault what is wrong, where the answer is kWrong; its object is filled in
  [[nodiscard]] virtual Heard hear(std::size_t which, const CanFrame& frame, ArmFault& fault) = 0;

 private:
  void advance();

  std::uint8_t bus_;
  State state_ = State::kAsking;
  ArmFault fault_;
  std::size_t at_ = 0;
  int tries_ = 0;
  std::int64_t asked_ns_ = 0;
};

}  // namespace tenon::hw
