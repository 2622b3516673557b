#pragma once
// Few enough moments of a long series for a page, and no peak lost: every bucket of neighbours
// keeps its smallest and its largest value. Pure; any thread.

#include <cstddef>
#include <functional>
#include <vector>

namespace tenon::planner {

class Moments {
 public:
  using Value = std::function<double(std::size_t)>;  ///< of a sample; not a number: not known

  /// @param samples in the series  @param moments_max that are left of them, at least 2
  Moments(std::size_t samples, std::size_t moments_max);

  [[nodiscard]] std::size_t size() const { return moments_.size(); }
  /// The sample that a moment stands at: of each bucket the first and the last. Ascending; the
  /// first and the last of all are among them.
  [[nodiscard]] const std::vector<std::size_t>& samples() const { return moments_; }
  /// The values there: for what has no peaks, such as times and poses.
  [[nodiscard]] std::vector<double> at(const Value& value) const;
  /// The smallest and the largest value of each bucket, in the order in which they came. Unknown
  /// where all of the bucket are.
  [[nodiscard]] std::vector<double> peaks(const Value& value) const;

 private:
  std::size_t samples_;
  std::vector<std::size_t> moments_;
};

}  // namespace tenon::planner
