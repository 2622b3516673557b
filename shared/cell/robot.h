#pragma once
// A robot as hw/robots/NAME gives it: its URDF the mechanics, robot.yaml the drives and the bus.

#include <any>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/math/pose.h"

namespace tenon {

/// Mass of a link, in the link's frame: that of the joint before it, moving with it.
struct LinkInertia {
  double mass_kg = 0.0;
  Vector3 com_m = Vector3::Zero();
  Eigen::Matrix3d inertia_kgm2 = Eigen::Matrix3d::Zero();  ///< about the centre of mass
};

struct Joint {
  enum class Kind : std::uint8_t { kPrismatic, kRevolute };
  std::string name;
  Kind kind = Kind::kPrismatic;
  Pose origin;                      ///< joint frame in its parent link's frame at position 0
  Vector3 axis = Vector3::UnitX();  ///< unit, in the joint frame
  std::uint8_t node = 0;            ///< its drive's number on the bus, 1..127
  /// What its drive's protocol alone knows of it, in a type of that protocol's own.
  std::any drive;
  double counts_per_unit = 0.0;  ///< per m or rad; negative where the drive counts backwards
  double zero_counts = 0.0;      ///< counts at position 0
  double lower = 0.0;            ///< m or rad
  double upper = 0.0;
  double speed_max = 0.0;  ///< m/s or rad/s
  double acceleration_max = 0.0;
  double effort_max = 0.0;           ///< N or Nm
  double rated_effort = 0.0;         ///< N or Nm, of motor and gear at the joint
  double following_error_max = 0.0;  ///< m or rad, beyond which a drive stops by itself
  double stiffness = 0.0;            ///< N/m or Nm/rad, of servo and gear under load
  LinkInertia link;                  ///< the link behind the joint
};

/// "m" or "rad": what the joint's position is in.
[[nodiscard]] inline const char* joint_unit(const Joint& joint) {
  return joint.kind == Joint::Kind::kPrismatic ? "m" : "rad";
}

/// What a force/torque sensor speaks, and with it what makes it take a sample.
enum class SensorProtocol : std::uint8_t {
  kNode = 0,          ///< a node as the drives are: the beginning of a cycle
  kRobotousRft = 1,   ///< its own clock
  kAtiNetcanoem = 2,  ///< a request
  kNone = 3,          ///< there is none: the joints' efforts tell the force
};

/// The buses of an arm, as CanFrame::bus names them.
inline constexpr std::uint8_t kArmBus = 0;
inline constexpr std::uint8_t kSensorBus = 1;

/// A force/torque sensor whose sample comes in two frames.
struct ForceTorqueSensor {
  SensorProtocol protocol = SensorProtocol::kNode;
  std::string profile{};                  ///< its name
  std::vector<std::string> unverified{};  ///< of the profile: what nobody has seen, for people
  std::uint8_t node = 0;                  ///< 0: it is no node
  /// Of what is no node, 11 bits: where it is asked, and its two frames.
  std::uint32_t request_id = 0;
  std::array<std::uint32_t, 2> sample_ids{};
  int rate_hz = 0;  ///< of one with its own clock
  /// What rounding leaves of a reading; of one that tells no wrench but gauges, about that.
  double force_per_count_N = 0.0;
  double torque_per_count_Nm = 0.0;
  double force_range_N = 0.0;  ///< saturation
  double torque_range_Nm = 0.0;
  double force_noise_N = 0.0;  ///< standard deviation of a sample, by data sheet
  double torque_noise_Nm = 0.0;
  /// m: a new sample every so many cycles, 1 to kMostCyclesPerSample.
  int cycles_per_sample = 1;
  std::uint32_t own_bitrate_bps = 0;  ///< of a bus that it has to itself; 0: it is on the arm's

  static constexpr int kMostCyclesPerSample = 20;
  static constexpr std::uint32_t kIdentifierMax = 0x7FF;

  [[nodiscard]] bool absent() const { return protocol == SensorProtocol::kNone; }
  /// It has a clock of its own: a sample may fall into any cycle, and none is waited for.
  [[nodiscard]] bool streams() const { return protocol == SensorProtocol::kRobotousRft; }
  [[nodiscard]] bool has_own_bus() const { return own_bitrate_bps != 0; }
  [[nodiscard]] std::uint8_t bus() const { return has_own_bus() ? kSensorBus : kArmBus; }
};

struct Robot {
  std::string name;
  std::vector<Joint> joints;  ///< base to flange, at most kMaxJoints
  Pose flange;                ///< in the last link's frame
  ForceTorqueSensor sensor;
  std::uint32_t bitrate_bps = 1'000'000;
  std::uint32_t cycle_us = 2000;
  std::uint32_t heartbeat_ms = 100;  ///< of every node and of the master
  std::uint32_t heartbeat_timeout_ms = 300;
  std::uint8_t master_node = 127;
  /// Joints whose targets share a frame: 1, or 2 where single ones would overload the bus.
  int targets_per_frame = 1;
  bool brakes = true;                ///< joints without power are held
  double response_lag_s = 0.0;       ///< tau_arm: setpoint to motion, protocol_lag_s() included
  double stiffness_Npm = 1e6;        ///< of the arm at the tool, physical
  int measurement_delay_cycles = 1;  ///< n
};

/// Time constant of the filter that smooths the joints' efforts where they tell the force.
inline constexpr int kEffortFilterCycles = 3;
/// So much older than a sensor's sample is that force: the filter, and the middle of two cycles.
inline constexpr int kEffortDelayCycles = kEffortFilterCycles + 1;

/// What the protocol alone takes from a setpoint to the motion: a target is taken up as the next
/// cycle begins and reached as the one after does.
[[nodiscard]] inline double protocol_lag_s(double cycle_s) { return 2.0 * cycle_s; }

/// T, and with it m T, in which a sensor has a new sample.
[[nodiscard]] inline double sample_period_s(const Robot& robot) {
  return 1e-6 * robot.cycle_us * robot.sensor.cycles_per_sample;
}

/// tau = (n + m/2) T + tau_arm: from a force to the motion that answers it.
[[nodiscard]] inline double latency_s(const Robot& robot) {
  const double cycles = robot.measurement_delay_cycles + 0.5 * robot.sensor.cycles_per_sample;
  return cycles * 1e-6 * robot.cycle_us + robot.response_lag_s;
}

}  // namespace tenon
