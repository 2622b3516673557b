#pragma once
// Whether a fault can strike anything of a robot's cell. One that cannot would prove nothing, and
// look as if all had withstood it. Set-up code.

#include <span>

#include "shared/cell/robot.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

/// @throws InputError in one line for a node that the robot does not have, one that is no drive
/// where a drive is meant, frames that the node does not send, or a jump in the other unit
void check_faults(std::span<const Fault> faults, const Robot& robot);

}  // namespace tenon::sim
