#pragma once
// What a plan takes for granted of the cell that executes it. Plain data; any thread.

namespace tenon::planner {

struct CellAssumptions {
  double contact_stiffness_Npm = 5e4;
  double latency_max_s = 0.010;  ///< (n + 1/2) T + tau_arm
};

}  // namespace tenon::planner
