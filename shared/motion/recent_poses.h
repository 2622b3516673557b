#pragma once
// Where a tool was last, and so how slow it is. Real-time: no allocation, bounded work.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "shared/base/time_units.h"
#include "shared/math/pose.h"

namespace tenon {

class RecentPoses {
 public:
  /// Speeds are judged over at least this, where so many poses fit into the memory.
  static constexpr std::int64_t kWindow_ns = 20'000'000;

  struct Moment {
    std::int64_t time_ns = 0;
    Pose pose;
  };

  /// @param time_ns later than the one before
  void add(std::int64_t time_ns, const Pose& pose) {
    memory_[added_ % kMemory] = {time_ns, pose};
    ++added_;
  }

  /// From the pose before to the last one; 0 until there are two.
  [[nodiscard]] double step_s() const {
    return added_ < 2 ? 0.0
                      : kNanosecond_s * static_cast<double>(back(0).time_ns - back(1).time_ns);
  }

  /// Over the whole window; false while it is not full.
  [[nodiscard]] bool slower_than(double speed_mps, double speed_radps) const {
    const std::size_t moments = std::min(added_, kMemory);
    for (std::size_t i = 1; i < moments; ++i) {
      const std::int64_t window_ns = back(0).time_ns - back(i).time_ns;
      if (window_ns < kWindow_ns && i + 1 < kMemory) continue;
      const double window_s = kNanosecond_s * static_cast<double>(window_ns);
      return stayed(i, speed_mps * window_s, speed_radps * window_s);
    }
    return false;
  }

 private:
  static constexpr std::size_t kMemory = 64;

  [[nodiscard]] const Moment& back(std::size_t moments) const {
    return memory_[(added_ - 1 - moments) % kMemory];
  }

  /// Whether none of the last so many poses is this far from the present one: what turns back amid
  /// the window is at both of its ends where it was.
  [[nodiscard]] bool stayed(std::size_t moments, double way_m, double way_rad) const {
    for (std::size_t i = 1; i <= moments; ++i) {
      const Vector6 moved = displacement_between(back(i).pose, back(0).pose);
      if (moved.head<3>().norm() >= way_m || moved.tail<3>().norm() >= way_rad) return false;
    }
    return true;
  }

  std::array<Moment, kMemory> memory_{};
  std::size_t added_ = 0;
};

}  // namespace tenon
