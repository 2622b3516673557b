#pragma once
// Times that are kept and compared are nanoseconds, as integers; times that are calculated with are
// seconds.

#include <cstdint>

namespace tenon {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
inline constexpr std::int64_t kNanosecondsPerMicrosecond = 1'000;
inline constexpr double kNanosecond_s = 1e-9;

}  // namespace tenon
