#pragma once
// Many jobs on a few threads. Offline; allocates.

#include <cstddef>
#include <functional>

namespace tenon {

/// As many as the machine runs at a time; at least 1.
[[nodiscard]] std::size_t all_cores();

/// Calls job(i, worker) once for each i < jobs, begun in this order, and returns when all have
/// ended. At most `threads` run at a time, the caller's included; `worker` is which of them, from 0
/// for the caller's. With one thread, or one job, all of it runs on the caller's. What a job gives
/// must depend on its i alone; then nothing depends on the number of threads.
///
/// Where a job throws, no further one begins; once those in flight have ended, the exception is
/// thrown here. Of several it is that of the lowest i, at any number of threads.
void fan_out(std::size_t jobs, std::size_t threads,
             const std::function<void(std::size_t i, std::size_t worker)>& job);

}  // namespace tenon
