#pragma once
// The executor's view of a robot: joints that follow position setpoints, and a wrench at a sensor.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "shared/math/pose.h"

namespace tenon {

inline constexpr std::size_t kMaxJoints = 7;
/// Per joint; rad, or m for a linear axis.
using JointVector = std::array<double, kMaxJoints>;

/// What an arm is asked to be.
enum class ArmRequest : std::uint8_t {
  kDisabled = 0,   ///< drives off, brakes on
  kEnabled = 1,    ///< following position setpoints
  kQuickStop = 2,  ///< ramp down by the drives themselves, then hold
};

/// What an arm is.
enum class ArmState : std::uint8_t {
  kUnconfigured = 0,  ///< prepare() is not finished
  kDisabled = 1,
  kEnabling = 2,
  kEnabled = 3,
  kStopping = 4,  ///< quick stop, or disabling
  kFault = 5,     ///< see ArmFault; a new prepare() starts over
};

enum class ArmFaultKind : std::uint8_t {
  kNone = 0,
  kNoAnswer = 1,         ///< a node did not answer in configuration
  kConfiguration = 2,    ///< a node refused or did not keep a setting
  kHeartbeatLost = 3,    ///< a node fell silent
  kUnexpectedReset = 4,  ///< boot-up from a running node
  kDriveFault = 5,       ///< the drive says so; code is its error code
  kDriveState = 6,       ///< a drive left operation enabled unasked
  kFeedbackMissing = 7,  ///< too many cycles without a joint's feedback
  kSensorStale = 8,      ///< too many cycles without a wrench, or with none but late ones
  kSensorInvalid = 9,    ///< saturated, torn or self-reported fault
  kBusDown = 10,         ///< code: which, of several (CanFrame::bus)
  kBusOff = 11,          ///< likewise
  kOtherMaster = 12,  ///< another master sends on the bus; code is the identifier that betrayed it
  kQueueFull = 13,    ///< our own frames were refused; code: cycles in a row
  kBusSilent = 14,    ///< nobody answered at all; code: cycles in a row
  kSetpointNotFinite = 15,  ///< of a joint that follows; nothing of it was sent
  kSetpointUnsent = 16,     ///< a joint's setpoints were refused again and again; code: how many
};

/// Plain data, so that real-time code can carry it. describe() in hw gives the line for people.
struct ArmFault {
  ArmFaultKind kind = ArmFaultKind::kNone;
  std::uint8_t node = 0;     ///< number on the bus, 0 where none is meant
  std::uint32_t object = 0;  ///< of the node's own, in its protocol's terms, or 0
  std::uint32_t code = 0;    ///< the node's own: of its error, of its refusal, or its status
  bool refused = false;      ///< of kConfiguration: code says why, and is no value
};

/// A force at which an arm stops all drives by itself, as soon as it hears of it.
struct ForceLimit {
  Vector3 unloaded_N = Vector3::Zero();  ///< what the sensor reads of itself and the payload
  double limit_N = std::numeric_limits<double>::infinity();  ///< greatest distance from that
};

struct ArmFeedback {
  std::int64_t sync_ns = 0;  ///< the cycle that this belongs to
  JointVector position{};
  JointVector effort{};            ///< N or Nm
  std::uint32_t joints_fresh = 0;  ///< bit i: joint i answered this cycle
  std::uint32_t joints_off = 0;    ///< bit i: and said that its motor has no power
  Vector6 wrench =
      Vector6::Zero();        ///< what acts on the load beyond the sensor, in sensor axes, raw
  bool wrench_fresh = false;  ///< a new, whole sample
  std::uint16_t wrench_counter = 0;
  /// The force, N, at which the arm has stopped its drives by itself; 0: it has not. They stay
  /// stopped until all are off.
  double force_stopped_N = 0.0;
  ArmState state = ArmState::kUnconfigured;
  ArmFault fault;
};

/// Real-time but for prepare(): no allocation, no throw, no clock; time is an argument. A cycle is
/// start_cycle(), receive() until it returns true or the deadline passes, command(). One thread.
class Arm {
 public:
  Arm() = default;
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;
  virtual ~Arm() = default;

  [[nodiscard]] virtual std::size_t joint_count() const noexcept = 0;

  /// Configures the devices; call it repeatedly, about every millisecond, until it says true.
  /// False and state kFault: it failed, see fault(). Not real-time.
  [[nodiscard]] virtual bool prepare(std::int64_t now_ns) = 0;

  /// Opens a control cycle: what makes the devices act and answer leaves here.
  virtual void start_cycle(std::int64_t now_ns) noexcept = 0;
  /// Takes in what has arrived. True once everything that this cycle expects is there.
  [[nodiscard]] virtual bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept = 0;
  /// Closes the cycle: setpoints and state request leave for the drives, and the sign of life when
  /// due. While the drives are not enabled the positions are ignored and the actual ones are sent.
  virtual void command(std::int64_t now_ns, ArmRequest request,
                       const JointVector& position) noexcept = 0;

  /// From now on, until the next call. Without effect where the arm or its drives cannot: whoever
  /// calls looks at every wrench all the same.
  virtual void limit_force(const ForceLimit& /*limit*/) noexcept {}
  /// From now on, until the next call: false where nothing that the arm does needs its sensor, and
  /// no fault of that is the arm's.
  virtual void rely_on_sensor(bool /*relied*/) noexcept {}
  /// Takes in what comes between cycles; nothing of it is this cycle's feedback. True: there was
  /// something.
  virtual bool attend(std::int64_t /*now_ns*/) noexcept { return false; }

  /// Waits for the bus, at most so long. Returns at once in lockstep.
  virtual void wait(std::int64_t at_most_ns) noexcept = 0;

  [[nodiscard]] virtual ArmState state() const noexcept = 0;
  [[nodiscard]] virtual ArmFault fault() const noexcept = 0;
};

}  // namespace tenon
