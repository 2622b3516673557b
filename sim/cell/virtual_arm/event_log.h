#pragma once
// The virtual cell's time line of what matters, bounded. One thread.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "shared/base/text.h"
#include "shared/ports/can_bus.h"
#include "sim/cell/virtual_arm/truth.h"

namespace tenon::sim {

class EventLog {
 public:
  static constexpr std::size_t kEventsMax = 500;

  /// @param time_ns since the cell was switched on
  void add(std::int64_t time_ns, std::string what) {
    if (events_.size() >= kEventsMax) return;
    events_.push_back({static_cast<double>(time_ns) * 1e-9, std::move(what)});
  }

  void emergency(std::int64_t time_ns, const CanFrame& frame) {
    const unsigned code = static_cast<unsigned>(frame.data[1]) << 8 | frame.data[0];
    const char* meaning = code == 0x8130   ? " (heartbeat of the master lost)"
                          : code == 0x8611 ? " (following error)"
                          : code == 0x8210 ? " (PDO too short)"
                          : code == 0      ? " (reset)"
                                           : "";
    add(time_ns, format("node %u: emergency %04Xh%s", frame.id & 0x7FU, code, meaning));
  }

  [[nodiscard]] const std::vector<TruthEvent>& events() const { return events_; }

 private:
  std::vector<TruthEvent> events_;
};

}  // namespace tenon::sim
