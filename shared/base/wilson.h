#pragma once
// How sure a count of successes makes of their probability. Pure; any thread.

#include <cstddef>

namespace tenon {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Wilson's score interval of a proportion, 95 %, without continuity correction (Wilson 1927).
/// [0, 1] where nothing was counted.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t count);

}  // namespace tenon
