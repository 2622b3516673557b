#pragma once
// The names of all that may end a run. What each is, is a row of the table (fault_table.h). Plain
// data, any thread.

#include <cstdint>

namespace tenon::executor {

/// The numbers stand in telemetry.
enum class EndReason : std::uint8_t {
  kNone = 0,
  kPlanDone = 1,
  kPlanFailed = 2,         ///< index: step; transition says why
  kStopRequested = 3,      ///< by the user
  kNotAtStart = 4,         ///< index: axis; value: where the tool is, wanted, bound
  kTareUnsteady = 5,       ///< index: wrench axis; value: deviation, bound
  kTareMoving = 6,         ///< index: joint; value: motion while taring, bound
  kContactOnApproach = 7,  ///< index: wrench axis; value: N or Nm, bound
  kUnreachable = 8,        ///< the command has no joint positions; value: error left in m or rad
  kJointLimit = 9,         ///< index: joint; value: position asked for, bound
  kJointSpeed = 10,        ///< index: joint; value: speed asked for, bound
  kForceFault = 11,        ///< value: N, bound, laggard
  kTorqueFault = 12,       ///< value: Nm, bound, laggard
  kSensorSaturated = 13,   ///< index: sensor axis; value: reading, bound, laggard
  kSensorNotFinite = 14,
  kArmFault = 15,         ///< arm_fault
  kArmNotEnabled = 16,    ///< the arm left the enabled state unasked; index: ArmState
  kEnableTimeout = 17,    ///< value: s waited
  kFeedbackMissing = 18,  ///< index: joint; value: cycles in a row, bound
  kWrenchMissing = 19,    ///< value: s without a sample, bound
  kOverruns = 20,         ///< value: late cycles; the control loop cannot keep its period
  kOtherBranch = 21,   ///< the tool is at the start, index: this joint is not; value, wanted, bound
  kFeedbackPoor = 22,  ///< value: cycles without all of their feedback, too many of all
  kMeasured = 23,      ///< an identification has all its readings
  kNothingMet = 24,    ///< by an identification's motion; index: axis; value: way, m, signed
  kBrakeFailed = 25,   ///< index: joint; value: way that it moved with the drives off, bound
  kFollowingError = 26,  ///< index: joint; value: m or rad from all that it was commanded, bound
  kBlind = 27,           ///< value: s without a sample that guarded moves may see, bound
  kTareOffset = 28,      ///< index: wrench axis; value: mean less payload, the cell's bias, bound
  kNotAtGoal = 29,       ///< index: axis; value: where the tool is, wanted: the goal, bound
  kWrenchFrozen = 30,    ///< value: equal samples in a row; index: of this wrench axis, or -1: all
  kTareDrift = 31,       ///< index: wrench axis; value: what its mean moved by at rest, bound
  kEncoderJump = 32,     ///< index: joint; value: m or rad since its last answer, bound
  kZeroMoved = 33,       ///< index: wrench axis; value: mean at the end, nothing touching, bound
  kNotDisabled = 34,     ///< index: joint whose drive has not said that it is off; value: s waited
  kNotHeld = 35,         ///< index: joint; value: m or rad from its command, bound: m, of the tool
  kEffortFrozen = 36,    ///< index: joint; value: cycles of its motion with the same effort
};
inline constexpr EndReason kLastEndReason = EndReason::kEffortFrozen;
[[nodiscard]] const char* to_string(EndReason reason);

/// How the motion comes to rest.
enum class EndManner : std::uint8_t {
  kHold = 0,       ///< nothing moves, or the plan has come to its own rest
  kToolRamp = 1,   ///< the tool's setpoint ramps down, compliant
  kJointRamp = 2,  ///< the joints ramp down: the tool has no way on
  kQuickStop = 3,  ///< the drives stop by themselves at once
};
[[nodiscard]] EndManner end_manner(EndReason reason);

}  // namespace tenon::executor
