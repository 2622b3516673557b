#pragma once
// A lock-free queue from one producer thread to one consumer thread. It never waits: a full ring
// drops the new element and counts it.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tenon {

/// Real-time on both sides: wait-free, no allocation. The elements live inside the ring, by value.
/// push() belongs to one thread, pop() to one (other) thread, the counters to any.
///
/// Memory orders. Both counts only grow; their difference is the fill. Each side owns one count, so
/// it reads its own relaxed. The producer publishes an element by a release store of pushed_; the
/// consumer's acquire load of pushed_ therefore sees the element's bytes. The consumer gives a slot
/// back by a release store of popped_; the producer's acquire load of popped_ keeps the overwriting
/// of the slot behind the reading of it. dropped_ orders nothing, so it is relaxed.
template <typename T, std::size_t kCapacity>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(kCapacity > 0 && (kCapacity & (kCapacity - 1)) == 0, "a power of two");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  SpscRing() = default;
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  /// Producer. False: the ring was full, and the element is dropped and counted.
  bool push(const T& element) noexcept {
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
    if (pushed - popped_.load(std::memory_order_acquire) == kCapacity) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[pushed % kCapacity] = element;
    pushed_.store(pushed + 1, std::memory_order_release);
    return true;
  }

  /// Consumer. False: the ring was empty, and `element` is as it was.
  [[nodiscard]] bool pop(T& element) noexcept {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
    if (popped == pushed_.load(std::memory_order_acquire)) return false;
    element = slots_[popped % kCapacity];
    popped_.store(popped + 1, std::memory_order_release);
    return true;
  }

  /// Elements lost so far, for telemetry.
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return kCapacity; }

 private:
  // The two sides write different cache lines.
  static constexpr std::size_t kCacheLine = 64;
  alignas(kCacheLine) std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> popped_{0};
  alignas(kCacheLine) std::array<T, kCapacity> slots_{};
};

}  // namespace tenon
