#pragma once
// Everything that asks the system for real time. Called once from the thread that will run the
// control loop, before it does; set-up code, system calls.

#include <string>
#include <vector>

namespace tenon::executor {

struct RealtimeParameters {
  int priority = 80;  ///< of SCHED_FIFO
  int cpu = -1;       ///< to stay on; -1: any
};

/// Scheduler (and reads it back), memory locked, heap that neither trims nor maps, stack touched,
/// affinity, processor kept out of deep sleep (as long as the process lives). Does all that it can.
/// @return a line for each that the system refused, with what it asks for; empty where all is well
[[nodiscard]] std::vector<std::string> enter_realtime(const RealtimeParameters& parameters);

}  // namespace tenon::executor
