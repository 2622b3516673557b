#include "hw/canopen/heartbeat_watch.h"

#include <cassert>

namespace tenon::hw::canopen {

void HeartbeatWatch::add(std::uint8_t node) {
  assert(count_ < kMaxNodes);
  entries_[count_++].node = node;
}

void HeartbeatWatch::restart(std::int64_t now_ns) {
  for (std::size_t i = 0; i < count_; ++i) {
    entries_[i].state = kNotSeen;
    entries_[i].last_ns = now_ns;
  }
}

bool HeartbeatWatch::process(const Heartbeat& heartbeat, std::int64_t now_ns) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (entries_[i].node == heartbeat.node) {
      entries_[i].state = heartbeat.state;
      entries_[i].last_ns = now_ns;
      return true;
    }
  }
  return false;
}

std::uint8_t HeartbeatWatch::state(std::uint8_t node) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (entries_[i].node == node) {
      return entries_[i].state;
    }
  }
  return kNotSeen;
}

std::optional<std::uint8_t> HeartbeatWatch::silent(std::int64_t now_ns,
                                                   std::int64_t timeout_ns) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (now_ns - entries_[i].last_ns > timeout_ns) {
      return entries_[i].node;
    }
  }
  return std::nullopt;
}

}  // namespace tenon::hw::canopen
