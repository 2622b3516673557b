#pragma once
// When each phase of a run began, as the cell itself can tell, and each step of the plan, as its
// executor tells: faults wait for them (`--fault KIND:at=PHASE`). Cell and executor note them,
// devices and bus look. One thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class FaultPhases {
 public:
  /// The first time counts. @param now_ns of the caller's clock
  void begin(FaultPhase phase, std::int64_t now_ns) {
    std::optional<std::int64_t>& began = began_ns_.at(static_cast<std::size_t>(phase));
    if (!began) began = now_ns;
  }
  [[nodiscard]] std::optional<std::int64_t> began_ns(FaultPhase phase) const {
    return began_ns_.at(static_cast<std::size_t>(phase));
  }

  /// A step of the plan runs, from 0. The first time counts.
  void begin_step(int step, std::int64_t now_ns) { steps_began_ns_.try_emplace(step, now_ns); }
  [[nodiscard]] std::optional<std::int64_t> step_began_ns(int step) const {
    const auto found = steps_began_ns_.find(step);
    if (found == steps_began_ns_.end()) return std::nullopt;
    return found->second;
  }

 private:
  std::array<std::optional<std::int64_t>, kFaultPhases> began_ns_{};
  std::map<int, std::int64_t> steps_began_ns_;
};

/// When a fault begins. @param on_ns time 0 of those that wait for no phase
/// @return unset: its phase or step has not begun
[[nodiscard]] inline std::optional<std::int64_t> begin_ns(const Fault& fault, std::int64_t on_ns,
                                                          const FaultPhases* phases) {
  const auto after_ns = static_cast<std::int64_t>(1e9 * fault.time_s);
  if (!fault.at && !fault.at_step) return on_ns + after_ns;
  if (phases == nullptr) return std::nullopt;
  const auto began =
      fault.at_step ? phases->step_began_ns(*fault.at_step) : phases->began_ns(*fault.at);
  if (!began) return std::nullopt;
  return *began + after_ns;
}

}  // namespace tenon::sim
