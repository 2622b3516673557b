// MitArm and the motors of mit6 on a bus in its own bit rate, in virtual time: bring-up, a cycle,
// and what comes of lost frames, faults and a dead executor.

#include "hw/mit/mit_arm.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "hw/bus_load/bus_load.h"
#include "hw/bus_load/response_times.h"
#include "hw/robot_arm/open_arm.h"
#include "shared/base/text.h"
#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "sim/cell/bus/virtual_bus.h"
#include "sim/cell/faults/bus_faults.h"
#include "sim/cell/faults/fault_spec.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::hw::mit {
namespace {

Cell mit6() { return load_cell(tests::in_tree("hw/cells/mit6.yaml")); }

/// The arm against its virtual cell; a caller that asks for a state and says where to go.
class Bench {
 public:
  explicit Bench(const Cell& told = mit6(), const Cell& real = mit6(),
                 const std::vector<std::string>& faults = {})
      : cell(told),
        link({.bitrate_bps = told.robot.bitrate_bps}, told.robot.master_node),
        arm(told, link.master()),
        world(real, load_task(tests::in_tree("planner/tasks/box_on_table_2d.yaml")),
              options(faults)),
        time(arm, world, link, {.cycle_ns = std::int64_t{1000} * told.robot.cycle_us}) {
    if (faults.empty()) return;
    bus_faults =
        std::make_unique<sim::BusFaults>(parsed(faults), told.robot.master_node, 0, nullptr);
    link.bus().set_disturbance(bus_faults.get());
  }

  bool enable() {
    if (!time.prepare()) return false;
    request = ArmRequest::kEnabled;
    for (int i = 0; i < 100 && arm.state() != ArmState::kEnabled; ++i) cycle();
    return arm.state() == ArmState::kEnabled;
  }
  void cycle() { (void)time.cycle(*this); }
  void cycles(int count) {
    for (int i = 0; i < count; ++i) cycle();
  }

  // What Lockstep calls.
  void begin(std::int64_t now_ns) { arm.start_cycle(now_ns); }
  bool finish(std::int64_t now_ns) {
    (void)arm.receive(now_ns, feedback);
    if (arm.state() != ArmState::kEnabled) target = feedback.position;
    arm.command(now_ns, request, target);
    return true;
  }

  [[nodiscard]] std::string fault() const { return fault_text(arm.fault(), cell.robot); }
  [[nodiscard]] double fallen_rad(const sim::Truth& since) const {
    double most = 0.0;
    const sim::Truth truth = world.truth();
    for (std::size_t i = 0; i < truth.drives.size(); ++i) {
      most = std::max(most, std::abs(truth.drives[i].position - since.drives[i].position));
    }
    return most;
  }

  Cell cell;
  sim::VirtualLink link;
  MitArm arm;
  sim::VirtualCell world;
  sim::Lockstep time;
  std::unique_ptr<sim::BusFaults> bus_faults;
  ArmRequest request = ArmRequest::kDisabled;
  JointVector target{};
  ArmFeedback feedback;

 private:
  static std::vector<sim::Fault> parsed(const std::vector<std::string>& specs) {
    std::vector<sim::Fault> faults;
    for (const std::string& spec : specs) faults.push_back(sim::parse_fault(spec));
    return faults;
  }
  static sim::VirtualCell::Options options(const std::vector<std::string>& specs) {
    sim::VirtualCell::Options options;
    options.faults = parsed(specs);
    return options;
  }
};

TEST(MitArm, ComesUpHoldsItselfAgainstGravityAndFollows) {
  Bench bench;
  ASSERT_TRUE(bench.enable()) << bench.fault();
  const sim::Truth before = bench.world.truth();
  bench.cycles(250);
  EXPECT_LT(bench.fallen_rad(before), 2e-3);
  const double start = bench.target[5];
  for (int i = 0; i < 250; ++i) {
    bench.target[5] = start + 0.2 * i / 250.0;
    bench.cycle();
  }
  bench.cycles(100);
  EXPECT_NEAR(bench.world.truth().drives[5].position, start + 0.2, 2e-3);
  EXPECT_NEAR(bench.feedback.position[5], start + 0.2, 2e-3);
  EXPECT_EQ(bench.arm.fault().kind, ArmFaultKind::kNone) << bench.fault();
  EXPECT_EQ(bench.time.statistics().incomplete_cycles, 0);
}

TEST(MitArm, ACyclesFramesFitItsBusAsComputed) {
  Bench bench;
  ASSERT_TRUE(bench.enable()) << bench.fault();
  bench.cycles(500);
  const ResponseTimes times = response_times(bench.cell.robot);
  EXPECT_LE(1e-3 * static_cast<double>(bench.time.statistics().latest_feedback_ns),
            times.feedback_worst_us);
  EXPECT_TRUE(times.leaves_room());
  const BusLoad load = bus_load(bench.cell.robot);
  // SYNC; a command and an answer of each of six; two of the sensor.
  EXPECT_EQ(load.frames_per_cycle, 1U + 12U + 2U);
  EXPECT_EQ(load.worst_bits, 55U + 14U * 135U);
}

TEST(MitArm, ABusThatIsTooSlowIsRefusedWithTheLoad) {
  Robot robot = mit6().robot;
  robot.bitrate_bps = 500'000;
  const std::string line = tests::refusal([&] { check_bus_load(robot); });
  EXPECT_NE(line.find("take a cycle of at least 5000 us"), std::string::npos) << line;
}

// Motors without brakes: what nothing carries any more falls, here as far as the part on the table
// and the gears' friction let it.
TEST(MitArm, ADeadExecutorIsNoticedByEveryMotorAfterItsTimeoutAndTheArmFalls) {
  Bench bench;
  ASSERT_TRUE(bench.enable()) << bench.fault();
  bench.cycles(100);  // the stand lets go of what obeys
  const sim::Truth before = bench.world.truth();
  bench.time.leave_alone(15'000'000);
  for (const auto& drive : bench.world.truth().drives) EXPECT_EQ(drive.state, "on");
  EXPECT_LT(bench.fallen_rad(before), 2e-3);
  bench.time.leave_alone(10'000'000);
  for (const auto& drive : bench.world.truth().drives) {
    EXPECT_EQ(drive.state, "error: lost communication") << drive.joint;
    EXPECT_EQ(drive.error_code, 0xD) << drive.joint;
  }
  bench.time.leave_alone(300'000'000);
  EXPECT_GT(bench.fallen_rad(before), 5e-3);
}

TEST(MitArm, DisablingSwitchesEveryMotorOffAtOnce) {
  Bench bench;
  ASSERT_TRUE(bench.enable()) << bench.fault();
  bench.request = ArmRequest::kDisabled;
  bench.cycles(3);
  EXPECT_EQ(bench.arm.state(), ArmState::kDisabled);
  for (const auto& drive : bench.world.truth().drives) EXPECT_EQ(drive.state, "off");
}

TEST(MitArm, AQuickStopHoldsTheArmWhereItIs) {
  Bench bench;
  ASSERT_TRUE(bench.enable()) << bench.fault();
  const sim::Truth before = bench.world.truth();
  bench.request = ArmRequest::kQuickStop;
  bench.cycles(200);
  EXPECT_EQ(bench.arm.state(), ArmState::kStopping);
  EXPECT_LT(bench.fallen_rad(before), 2e-3);
}

TEST(MitArm, FiveLostAnswersAreBorneASilentMotorIsNamed) {
  Bench brief(mit6(), mit6(), {"drop:node=3,id=answers,time_s=2.2,duration_s=0.019"});
  ASSERT_TRUE(brief.enable()) << brief.fault();
  brief.cycles(300);
  EXPECT_EQ(brief.arm.fault().kind, ArmFaultKind::kNone) << brief.fault();
  EXPECT_GT(brief.arm.counters().joint_frames_missing, 0U);

  Bench silent(mit6(), mit6(), {"drop:node=3,id=answers,time_s=2.2,duration_s=9"});
  ASSERT_TRUE(silent.enable()) << silent.fault();
  silent.cycles(300);
  EXPECT_EQ(silent.fault(),
            "motor 3 (arm_3): no feedback (0x013) in 6 cycles in a row, at most 5 are allowed; "
            "check bus load and wiring");
}

// A reset takes away the mode and the TIMEOUT that bring-up has written, and a motor comes on all
// the same. Whenever it falls: the motor goes where it is told, or is named.
TEST(MitArm, AMotorThatIsResetOnItsWayToTheEnabledArmIsNamedOrFollows) {
  int named = 0;
  int followed = 0;
  for (const int node : {1, 4, 6}) {
    for (double at_s = 0.05; at_s < 2.0; at_s += 0.05) {
      const std::string reset = format("node-reset:node=%d,time_s=%.2f", node, at_s);
      Bench bench(mit6(), mit6(), {reset});
      if (!bench.enable()) {
        EXPECT_NE(bench.fault().find(format("motor %d (arm_%d): ", node, node)), std::string::npos)
            << reset << ": " << bench.fault();
        ++named;
        continue;
      }
      const auto joint = static_cast<std::size_t>(node - 1);
      const double start = bench.target[joint];
      for (int i = 0; i < 50 && bench.arm.state() == ArmState::kEnabled; ++i) {
        bench.target[joint] = start + 0.02 * i / 50.0;
        bench.cycle();
      }
      bench.cycles(100);
      if (bench.arm.state() == ArmState::kFault) {
        EXPECT_NE(bench.fault().find(format("motor %d (arm_%d): ", node, node)), std::string::npos)
            << reset << ": " << bench.fault();
        ++named;
        continue;
      }
      EXPECT_NEAR(bench.world.truth().drives[joint].position, start + 0.0196, 3e-3) << reset;
      ++followed;
    }
  }
  EXPECT_GT(named, 0);
  EXPECT_GT(followed, 0);
  std::printf("%d named, %d followed\n", named, followed);
}

// Three or four cycles of 4 ms without a command, of which a watchdog of 12 ms bears two.
TEST(MitArm, LostCommandsEndInLostCommunicationByName) {
  Cell cell = mit6();
  MitMotor motor = mit_motor(cell.robot.joints[1]);
  motor.watchdog_ms = 12;
  cell.robot.joints[1].drive = motor;
  Bench bench(cell, mit6(), {"drop:node=2,id=rpdo,time_s=2.2,duration_s=0.0155"});
  ASSERT_TRUE(bench.enable()) << bench.fault();
  bench.cycles(300);
  EXPECT_EQ(bench.fault(),
            "motor 2 (arm_2): error 0xD (lost communication): no command for 12 ms, its TIMEOUT; "
            "check bus load and wiring");
}

TEST(MitArm, AnErrorOfAMotorIsNamedAndTheOthersHold) {
  Bench bench(mit6(), mit6(), {"emergency:node=6,time_s=2.2,code=0xA"});
  ASSERT_TRUE(bench.enable()) << bench.fault();
  bench.cycles(300);
  EXPECT_EQ(bench.fault(), "motor 6 (arm_6): error 0xA (over-current); see the motor's manual");
  EXPECT_EQ(bench.world.truth().drives[0].state, std::string("on"));
}

TEST(MitArm, AMotorThatDoesNotAnswerAtAllIsNamedInBringUp) {
  Bench bench(mit6(), mit6(), {"silent-node:node=4"});
  EXPECT_FALSE(bench.time.prepare());
  EXPECT_EQ(bench.fault(),
            "motor 4 (arm_4): no answer to MST_ID (register 7) on 0x014 in three tries; check "
            "power, wiring, bit rate, its ESC_ID 4, and that its MST_ID is 0x014");
}

TEST(MitArm, RangesThatTheMotorHoldsOtherwiseAreRefusedWithBoth) {
  Cell told = mit6();
  MitMotor motor = mit_motor(told.robot.joints[1]);
  motor.velocity_max_radps = 30.0;
  told.robot.joints[1].drive = motor;
  Bench bench(told, mit6());
  EXPECT_FALSE(bench.time.prepare());
  EXPECT_EQ(bench.fault(),
            "motor 2 (arm_2): holds VMAX (register 22) = 5 where 30 is in the robot file; set one "
            "like the other, and save it in the motor");
}

TEST(MitArm, RobotsThatCannotShareABusAreRefused) {
  const auto refused = [](const std::function<void(MitMotor&, Joint&)>& change) {
    Robot robot = mit6().robot;
    MitMotor motor = mit_motor(robot.joints[0]);
    change(motor, robot.joints[0]);
    robot.joints[0].drive = motor;
    return tests::refusal([&] { check_robot(robot); });
  };
  EXPECT_EQ(refused([](MitMotor&, Joint&) {}), "accepted");
  EXPECT_NE(refused([](MitMotor& m, Joint&) { m.feedback_id = 0x000; }).find("0x000"),
            std::string::npos);
  EXPECT_NE(refused([](MitMotor& m, Joint&) { m.feedback_id = 0x181; }).find("0x181"),
            std::string::npos);
  EXPECT_NE(refused([](MitMotor&, Joint& j) { j.node = 16; }).find("motor 16, must be 1..15"),
            std::string::npos);
  EXPECT_NE(refused([](MitMotor& m, Joint&) { m.watchdog_ms = 8; }).find("at least 12"),
            std::string::npos);
}

TEST(MitArm, FaultsThatItsMotorsCannotHaveAreRefused) {
  const std::string line = tests::refusal([] { Bench(mit6(), mit6(), {"brake-failure:node=3"}); });
  EXPECT_NE(line.find("robot mit6 has no drive that can have it"), std::string::npos) << line;
}

TEST(MitArm, SaysAtItsStartThatNoBrakeHoldsIt) {
  const auto lines = start_remarks(mit6().robot);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("20 ms after the executor has died"), std::string::npos) << lines[0];
}

/// mit6 with a Robotous RFT whose identifiers are no motor's, or with an ATI NETCANOEM board.
Cell with_sensor(SensorProtocol protocol) {
  Cell cell = mit6();
  ForceTorqueSensor& sensor = cell.robot.sensor;
  sensor.protocol = protocol;
  sensor.profile = "another";
  sensor.node = 0;
  const bool streams = sensor.streams();
  sensor.request_id = streams ? 0x64 : 0x170;
  sensor.sample_ids = streams ? std::array<std::uint32_t, 2>{0x41, 0x42}
                              : std::array<std::uint32_t, 2>{0x170, 0x171};
  sensor.rate_hz = streams ? 200 : 0;
  sensor.cycles_per_sample = 2;
  return cell;
}

/// What is counted as late in enabling and 500 cycles.
std::uint64_t late_frames(Bench& bench) {
  EXPECT_TRUE(bench.enable()) << fault_text(bench.arm.fault(), bench.cell.robot);
  bench.cycles(500);
  EXPECT_EQ(bench.arm.state(), ArmState::kEnabled);
  return bench.arm.counters().late_frames;
}

TEST(MitArm, WorksWithSensorsThatAreNoCanopenNodes) {
  Bench with_node;
  const std::uint64_t late_with_node = late_frames(with_node);
  for (const auto protocol : {SensorProtocol::kRobotousRft, SensorProtocol::kAtiNetcanoem}) {
    const Cell cell = with_sensor(protocol);
    Bench bench(cell, cell);
    EXPECT_EQ(late_frames(bench), late_with_node);  // answers to the stops, and none of the sensor
    EXPECT_EQ(bench.arm.counters().wrenches_missing, 0U);
    EXPECT_EQ(bench.arm.counters().wrench_halves_torn, 0U);
    EXPECT_NO_THROW(check_bus_load(cell.robot));
    EXPECT_NO_THROW(check_response_times(cell.robot));
  }
}

TEST(MitArm, NamesASensorThatDoesNotStart) {
  Cell told = with_sensor(SensorProtocol::kRobotousRft);
  Bench bench(told);  // where a CANopen node stands
  EXPECT_FALSE(bench.enable());
  EXPECT_EQ(bench.arm.fault().kind, ArmFaultKind::kNoAnswer);
  EXPECT_NE(fault_text(bench.arm.fault(), told.robot).find("no answer to set rate (0Fh) on 0x041"),
            std::string::npos);
}

}  // namespace
}  // namespace tenon::hw::mit
