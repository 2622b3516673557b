#pragma once
// Counts durations in bins of one microsecond. Fixed size; real-time to fill, one thread.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tenon::executor {

class Histogram {
 public:
  static constexpr std::size_t kBins = 4096;  ///< the last one takes everything longer

  void add(std::int64_t duration_ns) {
    const auto bin = static_cast<std::size_t>(std::max<std::int64_t>(0, duration_ns) / 1000);
    ++bins_[std::min(bin, kBins - 1)];
    ++count_;
    max_ns_ = std::max(max_ns_, duration_ns);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double max_us() const { return 1e-3 * static_cast<double>(max_ns_); }

  /// Upper edge of the bin that holds the given share of all durations; max_us() where that bin is
  /// the last one. 0 where nothing was counted. @param share 0..1
  [[nodiscard]] double percentile_us(double share) const {
    if (count_ == 0) return 0.0;
    const double wanted = share * static_cast<double>(count_);
    double below = 0.0;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      below += static_cast<double>(bins_[bin]);
      if (below >= wanted && below > 0.0) {
        return std::min(static_cast<double>(bin + 1), max_us());
      }
    }
    return max_us();
  }

 private:
  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace tenon::executor
