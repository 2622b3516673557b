#pragma once
// The rows of a robot's fault matrix: every kind of fault, how it is brought about, and by which
// rows of the executor's table it may be named. What it comes to in which phase is not written down
// here: that follows from the table's bounds.

#include <span>
#include <string>
#include <vector>

#include "executor/faults/fault_table.h"
#include "shared/cell/robot.h"

namespace tenon::tests {

/// Who brings the fault about.
enum class Act {
  kSpec,         ///< bus or device, as tenon-sim --fault does
  kOtherMaster,  ///< a SYNC from a third end of the bus
  kPause,        ///< the loop wakes up a second late, once (SIGSTOP, SIGCONT)
  kKill,         ///< the loop runs no more (SIGKILL)
  kLate,         ///< the loop wakes up a period and a half late, every time
  kNotFinite,    ///< setpoints on their way to the arm are no numbers
  kJointLimit,   ///< a joint's limit stands in the way of what the plan commands
  kObstacle,     ///< something stands in the way that no draw of the task puts there
};

struct FaultKind {
  const char* name = "";
  Act act = Act::kSpec;
  /// As for --fault, without at and time_s. JOINT, SENSOR, VERTICAL, LIVELY (whose heartbeat is
  /// watched), JUMP, LATE (most of a cycle) and CODE (of an emergency) stand for the robot's.
  std::string spec;
  /// Which may name it; empty: it is ridden out.
  std::vector<const executor::FaultRow*> names;
  bool while_moving_only = false;      ///< there is none where nothing moves
  bool drive_moves_by_itself = false;  ///< the force is bounded by the drive alone
  /// The master reaches a drive no more: it has to stop by itself.
  bool master_is_lost = false;
  /// Why such a robot cannot have it, in any phase; empty: it can.
  std::string impossible{};
};

[[nodiscard]] std::vector<FaultKind> fault_kinds(const Robot& robot);

/// Nothing stops its drives when their master is gone, as is said at every start: they stay under
/// power.
[[nodiscard]] bool has_drives_without_reaction(const Robot& robot);

/// By which an encoder that jumps misreads, m or rad: twice what its drive's following error
/// allows.
[[nodiscard]] double jump_of(const Robot& robot);

/// The kind's spec for a robot.
[[nodiscard]] std::string spec_for(const FaultKind& kind, const Robot& robot);

}  // namespace tenon::tests
