// Response times: the analysis against numbers worked out by hand, and every frame of every robot
// file measured on a virtual bus with an end for each node.

#include "hw/bus_load/response_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hw/arm/canopen_arm.h"
#include "hw/bus_load/bus_load.h"
#include "shared/base/error.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/hw/scripted_node.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

const ResponseTime& find(const ResponseTimes& times, std::uint32_t id) {
  const auto found = std::find_if(times.frames.begin(), times.frames.end(),
                                  [id](const ResponseTime& time) { return time.frame.id == id; });
  EXPECT_NE(found, times.frames.end()) << id;
  return *found;
}

// Longest frames at 1 Mbit/s: SYNC 55, command 115, feedback, force and torque 135, heartbeat 65
// us. Less 3 us of intermission at the end.
TEST(ResponseTimes, OfOneAxisAreThoseWorkedOutByHand) {
  Robot robot = gantry_robot();
  robot.joints.resize(1);
  const ResponseTimes times = response_times(robot);
  // A heartbeat is on the wire: 65 + 55.
  EXPECT_DOUBLE_EQ(find(times, 0x080).worst_us, 117.0);
  // Own queue 335 (with the heartbeat, which everything passes), the axis's 135 + 65.
  EXPECT_DOUBLE_EQ(find(times, 0x181).worst_us, 532.0);
  EXPECT_DOUBLE_EQ(find(times, 0x182).worst_us, 532.0);
  // Blocked by heartbeat 704h 65, own queue 200, force and torque 270.
  EXPECT_DOUBLE_EQ(find(times, 0x190).worst_us, 532.0);
  // Own queue 180, heartbeats 701h and 704h 130; feedback is through by then.
  EXPECT_DOUBLE_EQ(find(times, 0x201).worst_us, 307.0);
  // Blocked by 704h or 77Fh 65, own queue 200, SYNC 55, force and torque 270, command 115.
  EXPECT_DOUBLE_EQ(find(times, 0x701).worst_us, 702.0);

  EXPECT_DOUBLE_EQ(find(times, 0x080).nominal_us, 44.0);
  EXPECT_DOUBLE_EQ(find(times, 0x201).nominal_us, 92.0);
  EXPECT_DOUBLE_EQ(times.feedback_nominal_us, 47.0 + 3 * 111.0);
  EXPECT_DOUBLE_EQ(times.feedback_worst_us, 117.0 + 532.0);
  EXPECT_DOUBLE_EQ(times.room_us(), 2000.0 - 649.0);
  EXPECT_NO_THROW(check_response_times(robot));
}

TEST(ResponseTimes, FeedbackThatMayComeAfterTheNextSyncIsRefusedWithTheNumbers) {
  Robot robot = gantry_robot();
  robot.bitrate_bps = 500'000;
  robot.cycle_us = 2000;
  const std::string message = tests::refusal([&] { check_response_times(robot); });
  EXPECT_NE(message.find("after 2000 us"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(ResponseTimes, FramesThatCanNeverGoThroughAreRefused) {
  Robot robot = gantry_robot();
  robot.bitrate_bps = 100'000;
  EXPECT_THROW((void)response_times(robot), InputError);
}

/// A robot's nodes, each with a controller of its own, and its master on one bus at its bit rate.
class TimedBench {
 public:
  struct Measured {
    double least_us = std::numeric_limits<double>::max();
    double most_us = 0.0;
    std::uint32_t least_bits = 1000;
    std::uint32_t most_bits = 0;
    int frames = 0;
  };

  explicit TimedBench(const Robot& robot)
      : robot_(robot), bus_({.bitrate_bps = robot.bitrate_bps}), arm_(robot, bus_.attach()) {
    for (const Joint& joint : robot.joints) add(ScriptedNode::Kind::kDrive, joint.node);
    add(ScriptedNode::Kind::kSensor, robot.sensor.node);
  }

  bool prepare() {
    for (int i = 0; i < 10'000; ++i) {
      if (arm_.prepare(bus_.now_ns())) return true;
      if (arm_.state() == ArmState::kFault) return false;
      run_until(bus_.now_ns() + 1'000'000);
    }
    return false;
  }

  void measure(int cycles) {
    bus_.set_observer([this](const sim::VirtualBus::Transmission& sent) {
      Measured& measured = measured_[sent.frame.id];
      const double response_us = 1e-3 * static_cast<double>(sent.end_ns - sent.queued_ns);
      measured.least_us = std::min(measured.least_us, response_us);
      measured.most_us = std::max(measured.most_us, response_us);
      measured.least_bits = std::min(measured.least_bits, sent.bits.nominal);
      measured.most_bits = std::max(measured.most_bits, sent.bits.nominal);
      ++measured.frames;
    });
    const std::int64_t begin_ns = bus_.now_ns();
    const std::int64_t busy_ns = bus_.statistics().busy_ns;
    for (int i = 0; i < cycles; ++i) cycle(i);
    load_ = static_cast<double>(bus_.statistics().busy_ns - busy_ns) /
            static_cast<double>(bus_.now_ns() - begin_ns);
  }

  [[nodiscard]] const std::map<std::uint32_t, Measured>& measured() const { return measured_; }
  [[nodiscard]] double load() const { return load_; }
  [[nodiscard]] double feedback_us_max() const { return feedback_us_max_; }
  [[nodiscard]] int incomplete() const { return incomplete_; }

 private:
  void add(ScriptedNode::Kind kind, std::uint8_t node) {
    nodes_.push_back(std::make_unique<ScriptedNode>(kind, node, bus_.attach()));
  }

  void step_nodes() {
    const bool interpolated =
        canopen_drive(robot_.joints.front()).mode == DriveMode::kInterpolatedPosition;
    for (const auto& node : nodes_) {
      if (interpolated) node->objects[0x650200].value = 0x43;  // no mode 8
      node->step(bus_.now_ns());
    }
  }

  void run_until(std::int64_t until_ns) {
    while (bus_.now_ns() < until_ns) {
      step_nodes();
      bus_.advance(std::min(until_ns, bus_.next_event_ns()));
    }
    step_nodes();
  }

  void cycle(int number) {
    const std::int64_t sync_ns = bus_.now_ns();
    const std::int64_t next_ns = sync_ns + std::int64_t{1000} * robot_.cycle_us;
    // Values that stuff much, little, and anything between.
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int value = number * 7919 * static_cast<int>(i + 1);
      nodes_[i]->position_counts = number % 3 == 0 ? 0 : number % 3 == 1 ? -1 : value;
      for (auto& counts : nodes_[i]->wrench_counts) {
        counts = static_cast<std::int16_t>(number % 3 == 0 ? 0 : value % 1000);
      }
    }
    arm_.start_cycle(sync_ns);
    ArmFeedback feedback;
    while (!arm_.receive(bus_.now_ns(), feedback) && bus_.now_ns() < next_ns) {
      step_nodes();
      bus_.advance(std::min(next_ns, bus_.next_event_ns()));
    }
    const double took_us = 1e-3 * static_cast<double>(bus_.now_ns() - sync_ns);
    feedback_us_max_ = std::max(feedback_us_max_, took_us);
    incomplete_ += bus_.now_ns() >= next_ns ? 1 : 0;
    arm_.command(bus_.now_ns(), ArmRequest::kEnabled, feedback.position);
    run_until(next_ns);
  }

  Robot robot_;
  sim::VirtualBus bus_;
  CanopenArm arm_;
  std::vector<std::unique_ptr<ScriptedNode>> nodes_;
  std::map<std::uint32_t, Measured> measured_;
  double load_ = 0.0;
  double feedback_us_max_ = 0.0;
  int incomplete_ = 0;
};

/// Every robot file of CiA 402 drives, in the order of their names; of motors in MIT mode
/// mit_arm_test.cpp knows.
std::vector<std::filesystem::path> robot_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(tests::in_tree("hw/robots"))) {
    const auto file = entry.path() / "robot.yaml";
    if (!speaks_mit(load_robot(file))) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(ResponseTimes, OfEachRobotFileMeasuredOnTheVirtualBusLieBetweenNominalAndWorst) {
  ASSERT_FALSE(robot_files().empty());
  for (const auto& file : robot_files()) {
    const Robot robot = load_robot(file);
    TimedBench bench(robot);
    ASSERT_TRUE(bench.prepare()) << file;
    bench.measure(2000);
    const ResponseTimes times = response_times(robot);
    std::printf(
        "%s: us\nCOB-ID  frame                          frames  nominal    least     most    "
        "worst\n",
        robot.name.c_str());
    for (const ResponseTime& time : times.frames) {
      const auto found = bench.measured().find(time.frame.id);
      ASSERT_NE(found, bench.measured().end()) << robot.name << ": no " << time.frame.name;
      const TimedBench::Measured& measured = found->second;
      std::printf("  %03X   %-30s %6d %8.0f %8.0f %8.0f %8.0f\n", time.frame.id,
                  time.frame.name.c_str(), measured.frames, time.nominal_us, measured.least_us,
                  measured.most_us, time.worst_us);
      const std::string of = robot.name + ": " + time.frame.name;
      EXPECT_GE(measured.least_us, time.nominal_us) << of;
      EXPECT_LE(measured.most_us, time.worst_us) << of;
      EXPECT_GE(measured.least_bits + 3, nominal_frame_bits(time.frame.data_bytes)) << of;
      EXPECT_LE(measured.most_bits + 3, worst_frame_bits(time.frame.data_bytes)) << of;
    }
    const BusLoad load = bus_load(robot);
    std::printf(
        "load: %.1f %% nominal, %.1f measured, %.1f worst; SYNC to last feedback %.0f, %.0f, "
        "%.0f us of %.0f\n\n",
        100 * load.nominal, 100 * bench.load(), 100 * load.worst, times.feedback_nominal_us,
        bench.feedback_us_max(), times.feedback_worst_us, times.cycle_us);
    EXPECT_GE(bench.load(), load.nominal) << robot.name;
    EXPECT_LE(bench.load(), load.worst) << robot.name;
    EXPECT_GE(bench.feedback_us_max(), times.feedback_nominal_us - 3) << robot.name;
    EXPECT_LE(bench.feedback_us_max(), times.feedback_worst_us) << robot.name;
    EXPECT_EQ(bench.incomplete(), 0) << robot.name;
    EXPECT_TRUE(times.leaves_room()) << describe(times);
  }
}

}  // namespace
}  // namespace tenon::hw
