#pragma once
// How long a piece of work took, by a clock that its caller hands in. Offline; any thread.

#include <functional>

namespace tenon::planner {

/// Seconds since some fixed moment; never less than the last time.
using ClockSeconds = std::function<double()>;

/// What work() returns; the time that it took is added to seconds.
template <typename Work>
auto timed(const ClockSeconds& now_s, double& seconds, Work work) {
  const double from_s = now_s();
  auto result = work();
  seconds += now_s() - from_s;
  return result;
}

}  // namespace tenon::planner
