#pragma once
// The injected faults of one device that last: which are on, until when, and by their own draws
// whether they strike this sample. Seeded, without a clock.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "shared/base/random.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class ActiveFaults {
 public:
  void begin(const Fault& fault, std::int64_t now_ns) {
    const auto duration_ns = static_cast<std::int64_t>(1e9 * fault.duration_s);
    const std::int64_t end_ns =
        duration_ns > 0 ? now_ns + duration_ns : std::numeric_limits<std::int64_t>::max();
    active_.push_back({fault, end_ns, Random(fault.seed)});
  }

  void advance(std::int64_t now_ns) {
    std::erase_if(active_, [now_ns](const Active& active) { return now_ns >= active.end_ns; });
  }

  /// The last begun of that kind; null: none.
  [[nodiscard]] const Fault* find(FaultKind kind) const {
    const auto found = std::find_if(active_.rbegin(), active_.rend(), [kind](const Active& active) {
      return active.fault.kind == kind;
    });
    return found == active_.rend() ? nullptr : &found->fault;
  }

  /// Draws for each of that kind.
  [[nodiscard]] bool strikes(FaultKind kind) {
    bool struck = false;
    for (Active& active : active_) {
      if (active.fault.kind != kind) continue;
      struck = active.source.uniform() < active.fault.probability || struck;
    }
    return struck;
  }

 private:
  struct Active {
    Fault fault;
    std::int64_t end_ns = 0;
    Random source;
  };

  std::vector<Active> active_;
};

/// Whether a fault that is drawn once happens at all.
[[nodiscard]] inline bool happens(const Fault& fault) {
  return Random(fault.seed).uniform() < fault.probability;
}

/// The error code that a fault of kind kEmergency carries.
[[nodiscard]] inline std::uint16_t emergency_code(const Fault& fault) {
  return static_cast<std::uint16_t>(std::clamp(fault.value, 0.0, 65535.0));
}

}  // namespace tenon::sim
