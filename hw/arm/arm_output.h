#pragma once
// What an arm says: SYNC, the setpoints of its joints (each in a frame of its own, or packed two to
// a frame with the controlwords beside them), and the master's heartbeat when it is due. A bus that
// takes nothing any more is told to the supervision.
//
// Real-time, no clock; one thread. Bus, joints, supervision and counters outlive it.

#include <cstdint>
#include <span>

#include "hw/arm/arm_counters.h"
#include "hw/arm/arm_supervision.h"
#include "hw/arm/joint_channel.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class ArmOutput {
 public:
  ArmOutput(const Robot& robot, CanBus& bus, std::span<JointChannel> joints,
            ArmSupervision& supervision, ArmCounters& counters);

  /// The first heartbeat is due now.
  void begin(std::int64_t now_ns) noexcept { next_heartbeat_ns_ = now_ns; }

  void send_sync() noexcept;
  /// What the sensor is asked by.
  void send_request(const CanFrame& frame) noexcept { send(frame); }
  /// @param follow `position` (m or rad), else where each joint is. A joint that has not been heard
  /// of is sent nothing: nothing is known that could be a safe target.
  void send_setpoints(ArmRequest request, bool follow, const JointVector& position) noexcept;
  /// To drives that wait in pre-operational since they have missed this master: they hear stops and
  /// say where and in which state they are again.
  void send_starts() noexcept;
  /// All drives at once, where they have an RPDO for it.
  void send_stop() noexcept;
  /// Where it is due.
  void send_heartbeat(std::int64_t now_ns) noexcept;

 private:
  /// False: the transmit queue is full.
  bool send(const CanFrame& frame) noexcept;
  void send_packed_setpoints() noexcept;

  CanBus& bus_;
  const std::span<JointChannel> joints_;
  const std::uint8_t master_node_;
  const bool packed_;  ///< two targets a frame
  const std::int64_t heartbeat_ns_;
  ArmSupervision& supervision_;
  ArmCounters& counters_;
  std::int64_t next_heartbeat_ns_ = 0;
};

}  // namespace tenon::hw
