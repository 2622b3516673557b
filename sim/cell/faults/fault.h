#pragma once
// A fault to inject into a simulated bus or device: what, where, when, how likely. Plain data; the
// party that carries it out knows nothing of the executor. `--fault help` lists the kinds.

#include <cstddef>
#include <cstdint>
#include <optional>

namespace tenon::sim {

enum class FaultKind : std::uint8_t {
  // On the bus. `node` is the one whose frames are meant, of setpoints the one that they are for;
  // 0: every frame.
  kDrop = 0,           ///< a frame is lost for all receivers
  kDelay = 1,          ///< a frame arrives `value` seconds late
  kDuplicate = 2,      ///< a frame arrives twice
  kCorruptLength = 3,  ///< a frame arrives with one data byte fewer
  kBusOff = 4,         ///< the node's controller leaves the bus
  kQueueFull = 5,      ///< the node's transmit queue takes no frame (ENOBUFS)
  kInterfaceDown = 6,  ///< the interface is down for all
  // In a device.
  kNodeReset = 7,        ///< the node restarts, as after a dip of its supply
  kSilentNode = 8,       ///< the node neither sends nor receives
  kEmergency = 9,        ///< the node sends the emergency of code `value`, a drive faults with it
  kEncoderJump = 10,     ///< the joint's position reads `value` m or rad further from then on
  kBrakeFailure = 11,    ///< the joint's brake does not hold
  kStaleForce = 12,      ///< the sensor repeats its last sample, counter included
  kTornForce = 13,       ///< the two halves of a wrench come from different samples
  kSaturatedForce = 14,  ///< the sensor reads its range
  kTorqueLoss = 15,      ///< the joint's drive gives `value` times its effort, 0 <= value < 1
  kFrozenDrive = 16,     ///< the drive stands still under power, and says that all is well
  // In a drive that does less than its standard says.
  kKeepsPower = 17,   ///< it stays in quick stop active, under power, once its master is lost
  kSlowBrake = 18,    ///< the brake holds `value` seconds after its output; the drive waits less
  kResumesStop = 19,  ///< a quick stop is over as soon as an enable word from before it is found
  // In the sensor, beside the three above.
  kFrozenForce = 20,     ///< the wrench stays as it was, the counter runs on
  kDriftingForce = 21,   ///< the force along x moves away by `value` newtons a second
  kForgedForce = 22,     ///< the force along x reads `value` newtons more
  kWrongUnits = 23,      ///< it reads `value` times what it feels, as if in another unit
  kWrongMatrix = 24,     ///< x reads y, y reads z, z reads x, as by another sensor's calibration
  kOverrangeForce = 25,  ///< it tells by its own means that it is loaded beyond its range
  // In a drive.
  kFrozenEffort = 26,  ///< the effort that it reports stays as it was
};

/// Who carries it out.
enum class FaultTarget : std::uint8_t {
  kBus = 0,
  kNode = 1,    ///< a device of either sort
  kDrive = 2,   ///< drives alone
  kSensor = 3,  ///< the force/torque sensor alone
};

[[nodiscard]] constexpr FaultTarget target_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kDrop:
    case FaultKind::kDelay:
    case FaultKind::kDuplicate:
    case FaultKind::kCorruptLength:
    case FaultKind::kBusOff:
    case FaultKind::kQueueFull:
    case FaultKind::kInterfaceDown:
      return FaultTarget::kBus;
    case FaultKind::kNodeReset:
    case FaultKind::kSilentNode:
    case FaultKind::kEmergency:
      return FaultTarget::kNode;
    case FaultKind::kEncoderJump:
    case FaultKind::kBrakeFailure:
    case FaultKind::kTorqueLoss:
    case FaultKind::kFrozenDrive:
    case FaultKind::kKeepsPower:
    case FaultKind::kSlowBrake:
    case FaultKind::kResumesStop:
    case FaultKind::kFrozenEffort:
      return FaultTarget::kDrive;
    case FaultKind::kStaleForce:
    case FaultKind::kTornForce:
    case FaultKind::kSaturatedForce:
    case FaultKind::kFrozenForce:
    case FaultKind::kDriftingForce:
    case FaultKind::kForgedForce:
    case FaultKind::kWrongUnits:
    case FaultKind::kWrongMatrix:
    case FaultKind::kOverrangeForce:
      return FaultTarget::kSensor;
  }
  return FaultTarget::kBus;
}

[[nodiscard]] constexpr bool is_bus_fault(FaultKind kind) {
  return target_of(kind) == FaultTarget::kBus;
}

/// It strikes frames once they are sent.
[[nodiscard]] constexpr bool strikes_frames(FaultKind kind) {
  return kind == FaultKind::kDrop || kind == FaultKind::kDelay || kind == FaultKind::kDuplicate ||
         kind == FaultKind::kCorruptLength;
}

/// Its `frames` say which are meant.
[[nodiscard]] constexpr bool chooses_frames(FaultKind kind) {
  return strikes_frames(kind) || kind == FaultKind::kQueueFull;
}

enum class FrameKind : std::uint8_t {
  kAny = 0,
  kSync = 1,
  kHeartbeat = 2,
  kEmergency = 3,
  kAnswers = 4,    ///< process data that a device sends
  kSetpoints = 5,  ///< process data that a device receives
  kSdo = 6,        ///< both ways
  kOne = 7,        ///< the identifier `cob_id`
};

/// What the cell is doing, as it can tell by itself.
enum class FaultPhase : std::uint8_t {
  kEnabling = 0,  ///< a drive's power comes on
  kFree = 1,      ///< all drives are enabled, a joint moves, and nothing touches
  kSliding = 2,   ///< something has touched for 50 ms, and a joint moves
  kContact = 3,   ///< something touches
  kStopping = 4,  ///< all drives were enabled, and one ramps down, or its brake closes
};
inline constexpr std::size_t kFaultPhases = 5;

/// What the value of kEncoderJump is in, where whoever wrote it said so.
enum class FaultUnit : std::uint8_t { kAny = 0, kMetre = 1, kRadian = 2 };

struct Fault {
  FaultKind kind = FaultKind::kDrop;
  std::uint8_t node = 0;
  /// Begin, in simulated time since switching on, or since its phase began for the first time.
  double time_s = 0.0;
  double duration_s = 0.0;   ///< 0: once; for states (silent, down, stale...) until the end
  double probability = 1.0;  ///< of every frame or sample while it lasts
  double value = 0.0;        ///< see the kind
  std::uint64_t seed = 1;    ///< of the draws
  std::optional<FaultPhase> at = std::nullopt;  ///< unset: it waits for no phase
  std::optional<int> at_step = std::nullopt;    ///< of the plan, from 0; unset: for no step
  FrameKind frames = FrameKind::kAny;           ///< of those that choose frames
  std::uint32_t cob_id = 0;                     ///< of FrameKind::kOne
  FaultUnit unit = FaultUnit::kAny;
};

}  // namespace tenon::sim
