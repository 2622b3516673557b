#include "tests/faults/matrix/fault_kind.h"

#include <algorithm>
#include <set>
#include <utility>

#include "shared/base/text.h"
#include "shared/canopen/robot_drives.h"
#include "shared/mit/robot_motors.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::fault_row;
using Names = std::vector<const executor::FaultRow*>;

const executor::FaultRow* arm(ArmFaultKind kind) { return fault_row(EndReason::kArmFault, kind); }

/// A joint that stays behind is named for that, or, in a contact, for what the others press with or
/// come to without it.
Names stays_behind() {
  return {fault_row(EndReason::kFollowingError), fault_row(EndReason::kForceFault),
          fault_row(EndReason::kPlanFailed), fault_row(EndReason::kNotHeld)};
}

/// A zero that drifts is named for it while it is found; later for what the plan makes of a force
/// that is none.
Names drifts() {
  return {fault_row(EndReason::kTareDrift), fault_row(EndReason::kZeroMoved),
          fault_row(EndReason::kPlanFailed), fault_row(EndReason::kForceFault),
          fault_row(EndReason::kTorqueFault)};
}

/// As tenon-sim --fault brings it about.
FaultKind spec(const char* name, const char* text, Names names) {
  return {name, Act::kSpec, text, std::move(names)};
}

std::vector<FaultKind> kinds_of_the_bus() {
  const Names missing = {arm(ArmFaultKind::kFeedbackMissing)};
  const Names stale = {arm(ArmFaultKind::kSensorStale)};
  // At rest the drive itself misses them.
  Names unmoved = stays_behind();
  unmoved.push_back(arm(ArmFaultKind::kDriveFault));
  return {
      spec("a frame dropped", "drop:node=JOINT", {}),
      spec("frames dropped", "drop:node=JOINT,duration_s=100", missing),
      spec("frames delayed", "delay:node=JOINT,duration_s=100,delay_s=LATE,id=answers", missing),
      // All frames twice would be more than the bus carries.
      spec("frames duplicated", "duplicate:node=JOINT,duration_s=100", {}),
      spec("frames short", "corrupt-length:node=SENSOR,duration_s=100,id=answers", stale),
      spec("heartbeat lost", "drop:node=LIVELY,duration_s=100,id=heartbeat",
           {arm(ArmFaultKind::kHeartbeatLost)}),
      spec("queue full", "queue-full:node=127,duration_s=100", {arm(ArmFaultKind::kQueueFull)}),
      spec("bus-off", "bus-off:node=127", {arm(ArmFaultKind::kBusOff)}),
      spec("interface down", "interface-down", {arm(ArmFaultKind::kBusDown)}),
      spec("answers lost", "drop:node=JOINT,duration_s=100,id=answers", missing),
      spec("RPDOs lost", "drop:node=JOINT,duration_s=100,id=rpdo", unmoved),
      {"another master", Act::kOtherMaster, "", {arm(ArmFaultKind::kOtherMaster)}},
  };
}

std::vector<FaultKind> kinds_of_devices() {
  const Names behind = stays_behind();
  const Names stale = {arm(ArmFaultKind::kSensorStale)};
  // The arm tells by the force's frame, the executor by the whole wrench.
  const Names ends = {fault_row(EndReason::kSensorSaturated), arm(ArmFaultKind::kSensorInvalid)};
  return {
      spec("node reset", "node-reset:node=JOINT", {arm(ArmFaultKind::kUnexpectedReset)}),
      spec("emergency", "emergency:node=JOINT,code=CODE", {arm(ArmFaultKind::kDriveFault)}),
      spec("force torn", "torn-force:duration_s=100", stale),
      spec("force stale", "stale-force:duration_s=100", stale),
      spec("force saturated", "saturated-force:duration_s=100", ends),
      spec("force overrange", "overrange-force:duration_s=100", ends),
      spec("force beyond its limit", "forged-force:force_N=80",
           {fault_row(EndReason::kForceFault)}),
      {"encoder jump",
       Act::kSpec,
       "encoder-jump:node=JOINT,JUMP",
       {fault_row(EndReason::kEncoderJump)},
       false,
       true},
      spec("force frozen", "frozen-force:duration_s=100", {fault_row(EndReason::kWrenchFrozen)}),
      spec("force drifts", "drifting-force:duration_s=100,rate_Nps=20", drifts()),
      spec("drive does not follow", "frozen-drive:node=JOINT", behind),
      spec("brake failed", "brake-failure:node=VERTICAL", {fault_row(EndReason::kBrakeFailed)}),
  };
}

std::vector<FaultKind> kinds_of_the_executor() {
  return {
      {"setpoints not finite", Act::kNotFinite, "", {arm(ArmFaultKind::kSetpointNotFinite)}},
      {"SIGSTOP", Act::kPause, "", {arm(ArmFaultKind::kDriveFault)}},
      {"SIGKILL", Act::kKill, "", {}},
      {"late wake-ups",
       Act::kLate,
       "",
       {fault_row(EndReason::kOverruns), fault_row(EndReason::kBlind)}},
      {"joint limit", Act::kJointLimit, "", {fault_row(EndReason::kJointLimit)}, true},
      {"unexpected contact", Act::kObstacle, "", {fault_row(EndReason::kPlanFailed)}, true},
  };
}

/// Where efforts tell the force, one that stands still has a name, or has led to a force, a contact
/// or a way that there is not. In other cells nothing asks for it.
FaultKind effort_frozen(const Robot& robot) {
  Names names;
  if (robot.sensor.absent()) {
    names = {fault_row(EndReason::kEffortFrozen), fault_row(EndReason::kForceFault),
             fault_row(EndReason::kPlanFailed)};
  }
  return spec("effort frozen", "frozen-effort:node=JOINT", names);
}

/// What is another fault, or none, where motors speak the MIT mode.
void adapt_to_motors(FaultKind& kind) {
  const std::string name = kind.name;
  // It comes up without a word, and off.
  if (name == "node reset") kind.names = {arm(ArmFaultKind::kDriveState)};
  // A motor that is sent nothing answers nothing.
  if (name == "RPDOs lost") kind.names = {arm(ArmFaultKind::kFeedbackMissing)};
  if (name == "brake failed") kind.impossible = "its motors have no brakes";
}

}  // namespace

std::vector<FaultKind> fault_kinds(const Robot& robot) {
  static const std::set<std::string> kMasterIsLost = {"SIGKILL", "SIGSTOP",        "queue full",
                                                      "bus-off", "interface down", "RPDOs lost"};
  std::vector<FaultKind> all = kinds_of_the_bus();
  for (auto part : {kinds_of_devices(), kinds_of_the_executor()}) {
    for (FaultKind& kind : part) all.push_back(std::move(kind));
  }
  all.push_back(effort_frozen(robot));
  for (FaultKind& kind : all) {
    kind.master_is_lost = kMasterIsLost.contains(kind.name);
    if (speaks_mit(robot)) adapt_to_motors(kind);
  }
  return all;
}

bool has_drives_without_reaction(const Robot& robot) {
  return !speaks_mit(robot) &&
         std::any_of(robot.joints.begin(), robot.joints.end(), [](const Joint& joint) {
           const DriveProfile& profile = canopen_drive(joint).profile;
           return profile.object(DriveObject::kConnectionOption).presence == Presence::kAbsent;
         });
}

double jump_of(const Robot& robot) { return 2.0 * robot.joints.front().following_error_max; }

std::string spec_for(const FaultKind& kind, const Robot& robot) {
  const bool turns = robot.joints.front().kind == Joint::Kind::kRevolute;
  const bool motors = speaks_mit(robot);
  constexpr double kLate = 0.7;  // of a cycle: so long the executor waits for answers
  const std::string joint = std::to_string(robot.joints.front().node);
  const std::string sensor = std::to_string(robot.sensor.node);
  const std::pair<const char*, std::string> words[] = {
      {"JOINT", joint},
      {"SENSOR", sensor},
      {"LIVELY", motors ? sensor : joint},
      // The gantry's z, the other arm's shoulder.
      {"VERTICAL", std::to_string(robot.joints[turns ? 1 : 2].node)},
      {"JUMP", format(turns ? "jump_rad=%g" : "jump_m=%g", jump_of(robot))},
      {"LATE", format("%g", kLate * 1e-6 * robot.cycle_us)},
      // A drive's supply; a motor's over-current.
      {"CODE", motors ? "0xA" : "0x3210"},
  };
  std::string text = kind.spec;
  for (const auto& [word, value] : words) {
    const std::size_t at = text.find(word);
    if (at != std::string::npos) text.replace(at, std::string(word).size(), value);
  }
  return text;
}

}  // namespace tenon::tests
