#pragma once
// poll() with nanoseconds. Real-time (blocks as asked), no allocation.

#include <poll.h>

#include <cstdint>
#include <span>

namespace tenon::hw {

/// Waits until one of the descriptors is ready or the time has passed; true where one is ready.
inline bool poll_wait(std::span<pollfd> wanted, std::int64_t at_most_ns) noexcept {
  const std::int64_t time_ns = at_most_ns > 0 ? at_most_ns : 0;
  const timespec timeout{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  return ::ppoll(wanted.data(), wanted.size(), &timeout, nullptr) > 0;
}

}  // namespace tenon::hw
