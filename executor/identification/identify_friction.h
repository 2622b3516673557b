#pragma once
// Friction of a joint from slow motions to both sides: Coulomb, hysteresis, viscous, an offset, the
// ways within which the first two turn after a reversal, and how much of the effort all that does
// not explain. With z that follows the way (shared/joint_torque/friction_memory.h),
//   effort = coulomb z(way) + hysteresis z(hysteresis_way) + viscous velocity + offset,
// is linear but for the ways, which are searched. Pure mathematics; set-up code; allocates.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/identification/finding.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

/// One cycle of a joint that moves; m, m/s and N, or rad, rad/s and Nm.
struct RubSample {
  std::uint8_t joint = 0;
  bool counts = true;  ///< its effort is looked at; else only where it leads friction
  double position = 0.0;
  double velocity = 0.0;
  double effort = 0.0;  ///< without gravity and inertia
};

struct FrictionIdentification {
  enum class Status : std::uint8_t {
    kIdentified = 0,
    kTooShort = 1,    ///< a joint has no room to move to both sides
    kNoFriction = 2,  ///< its effort does not follow the motion: 6077h is not what it should be
  };
  Status status = Status::kTooShort;
  int joint = 0;                      ///< where it is not identified
  std::vector<JointFriction> joints;  ///< one each
};

/// @param samples in the order in which they were taken
[[nodiscard]] FrictionIdentification identify_friction(const Robot& robot,
                                                       const std::vector<RubSample>& samples);

/// What a cell's joint_torque names: a file as shared/config/friction_file.h reads it.
[[nodiscard]] std::string friction_file(const Robot& robot, const FrictionIdentification& friction);

/// Lines for people.
[[nodiscard]] std::string describe(const Robot& robot, const FrictionIdentification& friction);

[[nodiscard]] const char* to_string(FrictionIdentification::Status status);

[[nodiscard]] Finding finding_of(const Robot& robot, const FrictionIdentification& friction);

}  // namespace tenon::executor
