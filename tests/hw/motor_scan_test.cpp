// Who asks motors in MIT mode how they do, against motors of the virtual arm: it finds them on
// whatever identifier they answer, tells what they hold and how they do, and changes nothing.

#include "hw/mit/motor_scan.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "sim/cell/devices/mit_drive.h"
#include "tests/support/places.h"

namespace tenon::hw::mit {
namespace {

/// The motors of mit6 behind a bus that carries a frame at once.
class MotorsOnBus final : public CanBus {
 public:
  explicit MotorsOnBus(const Robot& robot) {
    for (const Joint& joint : robot.joints) {
      motors.push_back(std::make_unique<sim::MitDrive>(joint));
      motors.back()->power_on(0);
    }
  }
  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    sent.push_back(frame);
    for (const auto& motor : motors) {
      motor->receive(frame, 0);
      motor->take(answers_);
    }
    return SendResult::kSent;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    if (next_ == answers_.size()) return false;
    received.frame = answers_[next_++];
    return true;
  }
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  void flush() noexcept override {}
  [[nodiscard]] CanBusStatus status() const noexcept override { return {}; }

  std::vector<std::unique_ptr<sim::MitDrive>> motors;
  std::vector<CanFrame> sent;

 private:
  std::vector<CanFrame> answers_;
  std::size_t next_ = 0;
};

struct ScanBench {
  explicit ScanBench(const Robot& real = mit6()) : bus(real) {}
  static Robot mit6() { return load_robot(tests::in_tree("hw/robots/mit6/robot.yaml")); }

  void run() {
    for (std::int64_t now_ns = 0; !scan.done() && now_ns < 60'000'000'000; now_ns += 1'000'000) {
      scan.update(now_ns, bus);
      ReceivedFrame received;
      while (bus.receive(received)) scan.process(received.frame);
    }
    ASSERT_TRUE(scan.done());
  }
  [[nodiscard]] std::string state(std::size_t joint) const {
    return describe_state(robot, joint, scan.found(joint));
  }

  Robot robot = mit6();
  MotorsOnBus bus;
  MotorScan scan{robot};
};

TEST(MotorScan, TellsWhatEachMotorHoldsAndHowItDoes) {
  ScanBench bench;
  bench.bus.motors[2]->inject({.kind = sim::FaultKind::kEmergency, .node = 3, .value = 0xC});
  bench.run();
  EXPECT_EQ(describe_registers(bench.robot, 0, bench.scan.found(0)),
            "motor 1 (arm_1): answers on 0x011, TIMEOUT 0, CTRL_MODE 2, PMAX 3.2, VMAX 5, TMAX 40");
  EXPECT_EQ(bench.state(0).substr(0, 34), "motor 1 (arm_1): off, joint at -3.");
  EXPECT_NE(bench.state(0).find("board 25 degC, coil 25 degC"), std::string::npos);
  EXPECT_EQ(bench.state(2).substr(0, 41), "motor 3 (arm_3): error 0xC (coil too hot)");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(refusal_of(bench.robot, i, bench.scan.found(i)), "");
    EXPECT_EQ(is_well(bench.robot, i, bench.scan.found(i)), i != 2) << i;
  }
}

TEST(MotorScan, SendsNothingButQuestions) {
  ScanBench bench;
  bench.run();
  EXPECT_EQ(bench.bus.sent.size(), 6U * 8U);
  for (const CanFrame& frame : bench.bus.sent) {
    EXPECT_EQ(frame.id, 0x7FFU);
    EXPECT_TRUE(frame.data[2] == 0x33 || frame.data[2] == 0xCC) << int{frame.data[2]};
  }
}

// As sold: MST_ID 0, and another range than the file's.
TEST(MotorScan, OneThatAnswersElsewhereOrHoldsAnotherRangeIsFoundAndRefused) {
  Robot real = ScanBench::mit6();
  MitMotor motor = mit_motor(real.joints[1]);
  motor.feedback_id = 0;
  real.joints[1].drive = motor;
  motor = mit_motor(real.joints[3]);
  motor.velocity_max_radps = 30.0;
  real.joints[3].drive = motor;
  ScanBench bench(real);
  bench.run();
  EXPECT_EQ(bench.scan.found(1).answers_on, 0U);
  EXPECT_EQ(refusal_of(bench.robot, 1, bench.scan.found(1)),
            "motor 2 (arm_2): holds MST_ID (register 7) = 0x000 where 0x012 is in the robot file; "
            "set one like the other, and save it in the motor");
  EXPECT_EQ(bench.state(1).substr(0, 21), "motor 2 (arm_2): off,");
  EXPECT_EQ(refusal_of(bench.robot, 3, bench.scan.found(3)),
            "motor 4 (arm_4): holds VMAX (register 22) = 30 where 5 is in the robot file; set one "
            "like the other, and save it in the motor");
}

TEST(MotorScan, ASilentMotorIsAskedThreeTimesAndNamed) {
  ScanBench bench;
  bench.bus.motors[4]->inject({.kind = sim::FaultKind::kSilentNode, .node = 5});
  bench.run();
  EXPECT_FALSE(bench.scan.found(4).answers_on);
  EXPECT_FALSE(is_well(bench.robot, 4, bench.scan.found(4)));
  EXPECT_TRUE(bench.scan.found(5).answers_on);
  EXPECT_EQ(bench.bus.sent.size(), 5U * 8U + 3U);
  EXPECT_NE(bench.state(4).find("motor 5 (arm_5): no answer to MST_ID (register 7) on 0x015"),
            std::string::npos)
      << bench.state(4);
}

}  // namespace
}  // namespace tenon::hw::mit
