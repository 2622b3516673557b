#pragma once
// How long what is measured with noise may repeat itself, by how often it was seen to. Real-time.

#include <algorithm>
#include <cmath>

namespace tenon::executor {

/// That what is alive is named all the same, each sample: once in 60 years at 500 Hz.
inline constexpr double kRepetitionChanceMost = 1e-12;

/// What repeats itself in less than nearly every second pair does so wherever in a count it stands,
/// and half as often again at the most; what is quieter may stand still for ever.
/// @param repeats  of so many pairs of neighbouring samples
/// @param chance  that a sample repeats the one before, as far as else is known; 0: nothing is
/// @return how many samples in a row may be equal, not more than `most`; 0: any number
[[nodiscard]] inline int equal_samples_most(int repeats, int pairs, double chance, int most) {
  constexpr double kShareMost = 0.45;
  constexpr double kHalfAgain = 1.5;
  const double share = (repeats + 3.0 * std::sqrt(repeats) + 9.0) / pairs;
  if (share > kShareMost || chance > kHalfAgain * kShareMost) return 0;
  const double likely = std::max(chance, kHalfAgain * share);
  const double samples = std::ceil(std::log(kRepetitionChanceMost) / std::log(likely));
  return std::min(static_cast<int>(samples), most);
}

}  // namespace tenon::executor
