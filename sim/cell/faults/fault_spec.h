#pragma once
// Faults as people write them on a command line:
//
//   KIND[:KEY=VALUE[,KEY=VALUE]...]      drop:node=3,time_s=2,duration_s=0.5,probability=0.1,seed=7
//
// Set-up code.

#include <string>

#include "sim/cell/faults/fault.h"

namespace tenon::sim {

/// @throws InputError in one line for a kind or key that does not exist, a value out of its bounds,
/// or one that is missing
[[nodiscard]] Fault parse_fault(const std::string& text);

/// What `--fault help` prints: the keys, and for each kind a line of what it does and an example.
[[nodiscard]] std::string fault_help();

[[nodiscard]] const char* to_string(FaultKind kind);
[[nodiscard]] const char* to_string(FaultPhase phase);

}  // namespace tenon::sim
