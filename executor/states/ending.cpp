#include "executor/states/ending.h"

#include <cmath>

#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

const char* wrench_unit(int axis) { return axis < 3 ? "N" : "Nm"; }

Joint joint_of(const Cell& cell, int index) {
  const auto i = static_cast<std::size_t>(index);
  if (index >= 0 && i < cell.robot.joints.size()) return cell.robot.joints[i];
  Joint none;
  none.name = "?";
  return none;
}

std::string during(const Ending& ending) {
  return ending.step < 0 ? "" : format("step %d: ", ending.step);
}

const char* to_string(ArmState state) {
  switch (state) {
    case ArmState::kUnconfigured:
      return "unconfigured";
    case ArmState::kDisabled:
      return "disabled";
    case ArmState::kEnabling:
      return "enabling";
    case ArmState::kEnabled:
      return "enabled";
    case ArmState::kStopping:
      return "stopping";
    case ArmState::kFault:
      return "fault";
  }
  return "?";
}

// What is said of an axis or a joint that does not stand where the plan begins.
std::string off_start(const char* unit, const Ending& e, const Plan& plan) {
  return format(
      " is at %.4f %s, the plan's start '%s' has it at %.4f, must be within %.3g: move it there or "
      "use --go-to-start",
      e.value, unit, plan.start_name.c_str(), e.wanted, e.bound);
}

std::string unreachable(const Ending& e) {
  return during(e) +
         format("the commanded tool pose is out of the robot's reach by %.3g m or rad", e.value);
}

std::string joint_limit(const Ending& e, const Joint& joint) {
  return during(e) + "joint " + joint.name +
         format(" would come to rest at %.6g %s, beyond its limit %.6g", e.value, joint_unit(joint),
                e.bound);
}

std::string joint_speed(const Ending& e, const Joint& joint) {
  return during(e) + "joint " + joint.name +
         format(" would move at %.4g %s/s, at most %.4g", e.value, joint_unit(joint), e.bound);
}

std::string tare_moving(const Ending& e, const Joint& joint) {
  return "joint " + joint.name +
         format(" moved by %.3g %s while taring, at most %.3g", e.value, joint_unit(joint),
                e.bound);
}

std::string tare_unsteady(const Ending& e) {
  return format("sensor not steady while taring: standard deviation of %s is %.3g %s, at most %.3g",
                axis_name(e.index), e.value, wrench_unit(e.index), e.bound);
}

std::string tare_offset(const Ending& e) {
  return format(
      "something pushes while taring, or the sensor's calibration or unit is another: without the "
      "payload its %s reads %.4g %s, the cell's sensor_bias is %.4g, must be within %.3g: free the "
      "part, or calibrate again",
      axis_name(e.index), e.value, wrench_unit(e.index), e.wanted, e.bound);
}

std::string not_at_goal(const Ending& e, const Plan& plan) {
  return format(
      "plan '%s' came to its end, but not to its goal: the tool's %s is at %.4f %s, the goal at "
      "%.4f, and the plan's steps account for no more than %.4f between them",
      plan.task_name.c_str(), axis_name(e.index), e.value, axis_unit(e.index), e.wanted, e.bound);
}

std::string touched(const Ending& e) {
  return format("touched something on the way to the start: %s reads %.3g %s, at most %.3g",
                axis_name(e.index), e.value, wrench_unit(e.index), e.bound);
}

std::string sensor_saturated(const Ending& e) {
  return format("sensor axis %s reads %.4g %s, its range ends at %.4g", axis_name(e.index), e.value,
                wrench_unit(e.index), e.bound);
}

std::string feedback_missing(const Ending& e, const Joint& joint) {
  return "joint " + joint.name +
         format(" did not answer for %.0f cycles in a row, at most %.0f", e.value, e.bound);
}

std::string blind(const Ending& e) {
  return format(
      "no sample of the wrench could be trusted for %.3g s, at most %.3g: the loop is late, or "
      "answers are missing, again and again",
      e.value, e.bound);
}

std::string wrench_frozen(const Ending& e) {
  if (e.index >= 0) {
    return format(
        "the sensor's axis %s has not changed for %.0f samples, though its counter and other axes "
        "run: it measures no more; restart the sensor, and look at its cable",
        axis_name(e.index), e.value);
  }
  return format(
      "the sensor's wrench has not changed for %.0f samples, though its counter runs: it measures "
      "no more; restart the sensor",
      e.value);
}

std::string tare_drift(const Ending& e) {
  return format(
      "the sensor's %s moved by %.3g %s at rest in free air, at most %.3g: its zero drifts, or "
      "something began to push; let it warm up, and free the part",
      axis_name(e.index), e.value, wrench_unit(e.index), e.bound);
}

std::string zero_moved(const Ending& e) {
  return format(
      "the plan came to its end, but the wrench there, where nothing is held, is %.3g %s about "
      "or along %s, at most %.3g: the sensor's zero has moved since the tare and with it what the "
      "plan has met, or something pushes; look where the part is",
      e.value, wrench_unit(e.index), axis_name(e.index), e.bound);
}

std::string encoder_jump(const Ending& e, const Joint& joint) {
  return format(
      "node %d (%s) answers that it moved by %.3g %s at once, at most %.3g by its commands and "
      "its speed: check its encoder",
      static_cast<int>(joint.node), joint.name.c_str(), e.value, joint_unit(joint), e.bound);
}

std::string effort_frozen(const Ending& e, const Joint& joint) {
  return format(
      "node %d (%s) has reported the same effort for %.0f cycles in which its joint moved: it "
      "measures no more; see to its current sensor, and to what its feedback maps",
      static_cast<int>(joint.node), joint.name.c_str(), e.value);
}

std::string feedback_poor(const Ending& e) {
  return format("feedback was missing in %.0f cycles, too many for what the plan was made for",
                e.value);
}

std::string following_error(const Ending& e, const Joint& joint) {
  return format(
      "node %d (%s) is %.3g %s away from where it was commanded, at most %.3g: it does not follow",
      static_cast<int>(joint.node), joint.name.c_str(), e.value, joint_unit(joint), e.bound);
}

// What was seen of the brakes once the run had ended for another reason.
std::string after_the_end(const Ending& e, const Cell& cell, const std::string& arm_fault_text) {
  std::string text;
  if (e.slip.joint >= 0 && e.reason != EndReason::kBrakeFailed) {
    text = "; then " + describe(e.slip, cell);
  }
  const std::string held = describe(e.hold, e.arm_fault, arm_fault_text);
  if (!held.empty()) text += "; it was " + held;
  const std::size_t joints = cell.robot.joints.size();
  if (joints > 0 && e.brakes_unwatched == (1U << joints) - 1U) {
    return text + "; for want of answers nobody could watch whether a brake holds";
  }
  std::string unwatched;
  for (std::size_t i = 0; i < joints; ++i) {
    if ((e.brakes_unwatched >> i & 1U) == 0) continue;
    const Joint& joint = cell.robot.joints[i];
    unwatched += (unwatched.empty() ? "" : ", ") +
                 format("node %d (%s)", static_cast<int>(joint.node), joint.name.c_str());
  }
  if (unwatched.empty()) return text;
  return text + "; for want of answers nobody could watch whether the brake holds at " + unwatched;
}

std::string arm_fault(const ArmFault& fault, const std::string& text) {
  if (!text.empty()) return "arm: " + text;
  return format("arm: fault kind %d, node %d, object %06x, code %x", static_cast<int>(fault.kind),
                static_cast<int>(fault.node), static_cast<unsigned>(fault.object),
                static_cast<unsigned>(fault.code));
}

std::string arm_not_enabled(const Ending& e) {
  return format("the arm left the enabled state unasked: %s",
                to_string(static_cast<ArmState>(e.index)));
}

std::string nothing_met(const Ending& e) {
  return format("nothing was met within %g m along %c%s", std::abs(e.value),
                e.value < 0.0 ? '-' : '+', axis_name(e.index));
}

std::string of_the_sensor(const Ending& e) {
  if (e.reason == EndReason::kTareUnsteady) return tare_unsteady(e);
  if (e.reason == EndReason::kTareOffset) return tare_offset(e);
  if (e.reason == EndReason::kTareDrift) return tare_drift(e);
  if (e.reason == EndReason::kZeroMoved) return zero_moved(e);
  if (e.reason == EndReason::kSensorSaturated) return sensor_saturated(e);
  if (e.reason == EndReason::kWrenchFrozen) return wrench_frozen(e);
  if (e.reason == EndReason::kSensorNotFinite) return "the sensor's reading is not a number";
  return format("no wrench for %.3g s, at most %.3g", e.value, e.bound);
}

/// What another drive may have to do with too large a wrench; empty where none stays behind.
std::string behind(const Ending& e, const Cell& cell) {
  if (e.laggard < 0) return {};
  const Joint joint = joint_of(cell, e.laggard);
  return format(
      "; just before, node %d (%s) was %.3g %s from where it was commanded: see to that "
      "drive first",
      static_cast<int>(joint.node), joint.name.c_str(), e.lag, joint_unit(joint));
}

std::string too_hard(const Ending& e) {
  const bool force = e.reason == EndReason::kForceFault;
  return format(force ? "external force %.4g N above force_fault_N = %.4g"
                      : "external torque %.4g Nm above torque_fault_Nm = %.4g",
                e.value, e.bound);
}

std::string not_held(const Ending& e, const Joint& joint) {
  return format(
      "the plan came to its end, but node %d (%s) is %.3g %s from where it was told to hold it, "
      "and the tool further off than %.3g mm, or turned: its drive does not follow, or its brake "
      "slips; look where the part is",
      static_cast<int>(joint.node), joint.name.c_str(), e.value, joint_unit(joint), 1e3 * e.bound);
}

std::string not_disabled(const Ending& e, const Joint& joint) {
  return format(
      "node %d (%s) has not said that it is off within %.3g s: it may be under power; cut the "
      "cell's power before anybody reaches in",
      static_cast<int>(joint.node), joint.name.c_str(), e.value);
}

std::string of_a_joint(const Ending& e, const Cell& cell, const Plan& plan) {
  if (e.reason == EndReason::kBrakeFailed) return describe(e.slip, cell);
  const Joint joint = joint_of(cell, e.index);
  if (e.reason == EndReason::kOtherBranch) {
    return "joint " + joint.name + off_start(joint_unit(joint), e, plan);
  }
  if (e.reason == EndReason::kTareMoving) return tare_moving(e, joint);
  if (e.reason == EndReason::kJointLimit) return joint_limit(e, joint);
  if (e.reason == EndReason::kJointSpeed) return joint_speed(e, joint);
  if (e.reason == EndReason::kFeedbackMissing) return feedback_missing(e, joint);
  if (e.reason == EndReason::kEncoderJump) return encoder_jump(e, joint);
  if (e.reason == EndReason::kEffortFrozen) return effort_frozen(e, joint);
  if (e.reason == EndReason::kNotDisabled) return not_disabled(e, joint);
  if (e.reason == EndReason::kNotHeld) return not_held(e, joint);
  return following_error(e, joint);
}

std::string of_the_loop(const Ending& e) {
  if (e.reason == EndReason::kBlind) return blind(e);
  if (e.reason == EndReason::kFeedbackPoor) return feedback_poor(e);
  return format("the control loop cannot keep its period: %.0f late cycles", e.value);
}

std::string why(const Ending& e, const Plan& plan, const Cell& cell,
                const std::string& arm_fault_text) {
  switch (e.reason) {
    case EndReason::kNone:
      return "still running";
    case EndReason::kPlanDone:
      return "plan '" + plan.task_name + "' done";
    case EndReason::kPlanFailed:
      return format("step %d: ", e.index) + describe(e.transition);
    case EndReason::kStopRequested:
      return "stopped on request";
    case EndReason::kNotAtStart:
      return format("the tool's %s", axis_name(e.index)) + off_start(axis_unit(e.index), e, plan);
    case EndReason::kNotAtGoal:
      return not_at_goal(e, plan);
    case EndReason::kContactOnApproach:
      return touched(e);
    case EndReason::kUnreachable:
      return unreachable(e);
    case EndReason::kForceFault:
    case EndReason::kTorqueFault:
      return too_hard(e) + behind(e, cell);
    case EndReason::kArmFault:
      return arm_fault(e.arm_fault, arm_fault_text);
    case EndReason::kArmNotEnabled:
      return arm_not_enabled(e);
    case EndReason::kEnableTimeout:
      return format("the arm was not enabled within %.3g s", e.value);
    case EndReason::kBlind:
    case EndReason::kOverruns:
    case EndReason::kFeedbackPoor:
      return of_the_loop(e);
    case EndReason::kMeasured:
      return "all readings are taken";
    case EndReason::kNothingMet:
      return nothing_met(e);
    case EndReason::kTareUnsteady:
    case EndReason::kTareOffset:
    case EndReason::kTareDrift:
    case EndReason::kZeroMoved:
    case EndReason::kSensorSaturated:
    case EndReason::kSensorNotFinite:
    case EndReason::kWrenchFrozen:
    case EndReason::kWrenchMissing:
      return of_the_sensor(e) + behind(e, cell);
    case EndReason::kOtherBranch:
    case EndReason::kTareMoving:
    case EndReason::kJointLimit:
    case EndReason::kJointSpeed:
    case EndReason::kFeedbackMissing:
    case EndReason::kBrakeFailed:
    case EndReason::kFollowingError:
    case EndReason::kEncoderJump:
    case EndReason::kNotDisabled:
    case EndReason::kNotHeld:
    case EndReason::kEffortFrozen:
      return of_a_joint(e, cell, plan);
  }
  return "?";
}

std::string outside(const char* what, const Transition& t) {
  if (t.travelled_min >= t.travelled_max) {
    return format("%s along %s outside what validation saw", what, axis_name(t.index));
  }
  return std::string(what) + format(" %.4g %s along %s where validation saw %.4g to %.4g",
                                    shown(t.travelled, t.index), t.index < 3 ? "mm" : "deg",
                                    axis_name(t.index), shown(t.travelled_min, t.index),
                                    shown(t.travelled_max, t.index));
}

}  // namespace

std::string describe(const Transition& transition) {
  const auto bit = static_cast<std::uint16_t>(transition.index < 0 ? 0 : 1U << transition.index);
  switch (transition.deviation) {
    case Deviation::kNone:
      return "as planned";
    case Deviation::kUnexpectedOutcome:
      return "the plan has no way on from this outcome";
    case Deviation::kTravelOutside:
      return outside("travelled", transition);
    case Deviation::kPlaceOutside:
      return outside("ended, from the start,", transition);
    case Deviation::kContactMissing:
      return "contact " + tenon::to_string(ContactSignature{bit}) +
             " is missing, validation always had it";
    case Deviation::kContactUnforeseen:
      return "contact " + tenon::to_string(ContactSignature{bit}) + " was never seen in validation";
  }
  return "?";
}

std::string describe(const BrakeSlip& slip, const Cell& cell) {
  const Joint joint = joint_of(cell, slip.joint);
  return "joint " + joint.name +
         format(" moved by %.3g %s with the drives off, at most %.3g: its brake does not hold",
                slip.moved, joint_unit(joint), slip.bound);
}

std::string describe(Hold hold, const ArmFault& fault, const std::string& arm_fault_text) {
  const std::string cause = fault.kind == ArmFaultKind::kNone ? "the arm's drives are not enabled"
                                                              : arm_fault(fault, arm_fault_text);
  switch (hold) {
    case Hold::kNone:
      return {};
    case Hold::kHeld:
      return "held under power until it was told to stop";
    case Hold::kLost:
      return "held under power, and is not any more: " + cause;
    case Hold::kRefused:
      return "not held under power: " + cause;
  }
  return {};
}

std::string describe(const Ending& e, const Plan& plan, const Cell& cell,
                     const std::string& arm_fault_text) {
  return why(e, plan, cell, arm_fault_text) + after_the_end(e, cell, arm_fault_text);
}

}  // namespace tenon::executor
