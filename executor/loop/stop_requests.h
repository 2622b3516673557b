#pragma once
// What ends a run before its time, by whose word: set by anyone, on any thread and in a signal's
// handler. The loop takes each once.

#include <atomic>

namespace tenon::executor {

struct StopRequests {
  /// Somebody means the arm: it is let go of, too, where it is held because its brake is not
  /// enough.
  std::atomic<bool> by_user{false};
  /// Nobody's word about the arm: an end of input, a lost terminal, a stray signal. Ends the work,
  /// and lets go of nothing.
  std::atomic<bool> by_circumstance{false};

  [[nodiscard]] bool any() const noexcept {
    return by_user.load(std::memory_order_relaxed) ||
           by_circumstance.load(std::memory_order_relaxed);
  }
};

}  // namespace tenon::executor
