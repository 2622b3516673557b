#pragma once
// What an arm hears: the answers of its joints and the halves of its wrench become the feedback of
// a cycle; heartbeats and emergencies, a wrench beyond its range and what another master sends go
// on to the supervision. Decides nothing itself.
//
//   open_cycle()  takes in what came late, then waits for this cycle's answers
//   drain()       takes in what has come, until feedback() is complete()
//   close_cycle() what comes from now on is late
//
// Real-time, no clock; one thread. Joints, the wrench's source, supervision and counters outlive
// it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hw/arm/arm_counters.h"
#include "hw/arm/arm_supervision.h"
#include "hw/arm/joint_channel.h"
#include "hw/arm/other_master.h"
#include "hw/sensors/wrench_intake.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class ArmIntake {
 public:
  /// Bounds a cycle's work however much arrives.
  static constexpr int kMaxFramesPerCall = 256;

  ArmIntake(const Robot& robot, std::span<JointChannel> joints, WrenchSource& wrench_source,
            ArmSupervision& supervision, ArmCounters& counters);

  /// Forgets all that was heard.
  void reset() noexcept;
  /// @return what the sensor is to be sent right after SYNC
  [[nodiscard]] std::optional<CanFrame> open_cycle(std::int64_t now_ns, CanBus& bus) noexcept;
  /// @return frames taken
  int drain(std::int64_t now_ns, CanBus& bus) noexcept;
  /// Judges every force from now on, in its frame.
  void limit_force(const ForceLimit& limit) noexcept { limit_ = limit; }
  /// A frame of the bus that comes now.
  void take(const CanFrame& frame, std::int64_t now_ns) noexcept {
    take_received({frame, now_ns}, now_ns);
  }
  /// False: none was open.
  bool close_cycle() noexcept;

  /// A cycle waits for its answers.
  [[nodiscard]] bool cycle_open() const noexcept { return cycle_open_; }
  /// Whether everything that this cycle expects is there.
  [[nodiscard]] bool complete() const noexcept;
  /// State and fault are the supervision's to fill in.
  [[nodiscard]] const ArmFeedback& feedback() const noexcept { return feedback_; }

 private:
  void forget_freshness() noexcept;
  void take_received(const ReceivedFrame& received, std::int64_t now_ns) noexcept;
  [[nodiscard]] bool take_process_data(const ReceivedFrame& received) noexcept;
  [[nodiscard]] bool take_wrench_frame(const ReceivedFrame& received) noexcept;
  void judge_force(const Vector3& force_N) noexcept;
  void take_wrench(const WrenchIntake::Sample& sample) noexcept;

  const std::span<JointChannel> joints_;
  std::array<std::uint32_t, kMaxJoints> feedback_ids_{};
  const std::uint8_t sensor_node_;
  const OtherMaster other_master_;
  ArmSupervision& supervision_;
  ArmCounters& counters_;

  ForceLimit limit_;
  WrenchIntake wrench_intake_;
  ArmFeedback feedback_;
  bool cycle_open_ = false;
  bool wrench_late_ = false;  ///< one has come since the last cycle closed
};

}  // namespace tenon::hw
