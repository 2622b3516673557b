#pragma once
// How far a sensor's newest sample is behind the SYNCs that were sent, told by its counter: a
// sensor that counts a sample for each SYNC, or for each m of them, has counted fewer than were
// sent by what its answers are late. Whether it counts so is seen first; of one that counts
// otherwise nothing is known. Real-time, no clock; one thread.

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace tenon::hw {

class SampleLag {
 public:
  /// A whole tare's: within them a count may be missing or too many, in a sensor that counts SYNCs.
  static constexpr int kLearningSamples = 200;
  /// Of the SYNCs a sensor may miss so many for ever; each leaves it behind by one.
  static constexpr double kMissedShare = 0.01;
  /// More is more than one sample late, whatever is left of a SYNC that was missed before.
  static constexpr double kBehindMost_samples = 1.5;

  /// @param cycles_per_sample m
  explicit SampleLag(int cycles_per_sample) : cycles_per_sample_(cycles_per_sample) {}

  /// Forgets all that was counted.
  void reset() noexcept { *this = SampleLag(cycles_per_sample_); }

  /// A cycle has closed whose SYNC was heard.
  void sync_heard() noexcept { ++syncs_; }
  /// A new sample has come in it, or came late before it.
  void take(std::uint16_t counter) noexcept {
    const auto counted = static_cast<std::uint16_t>(counter - last_);
    const bool first = !known_;
    known_ = true;
    last_ = counter;
    // One that counts backwards has begun anew.
    if (first || counted > kBackwards) return begin(counted > kBackwards && !first);
    counts_ += counted;
    if (cycles_per_count_ == 0) return learn();
    const double samples = static_cast<double>(syncs_ - cycles_per_count_ * counts_) /
                           static_cast<double>(cycles_per_sample_);
    behind_ = std::max(0.0, behind_ + samples - kMissedShare * static_cast<double>(counted));
    syncs_ = counts_ = 0;
  }

  /// It counts SYNCs, and its newest sample is too old.
  [[nodiscard]] bool late() const noexcept { return behind_ > kBehindMost_samples; }
  /// How old, in samples.
  [[nodiscard]] double behind_samples() const noexcept { return behind_; }

 private:
  static constexpr std::uint16_t kBackwards = 0x7FFF;

  void begin(bool anew) noexcept {
    syncs_ = counts_ = 0;
    if (!anew) return;
    cycles_per_count_ = 0;
    behind_ = 0.0;
  }
  void learn() noexcept {
    if (counts_ == 0 || syncs_ < kLearningSamples * cycles_per_sample_) return;
    for (const int cycles : {cycles_per_sample_, 1}) {
      if (std::abs(syncs_ - cycles * counts_) <= cycles) cycles_per_count_ = cycles;
    }
    begin(false);
  }

  int cycles_per_sample_;
  int cycles_per_count_ = 0;  ///< 0: not known
  std::uint16_t last_ = 0;
  bool known_ = false;
  std::int64_t syncs_ = 0;   ///< since the last sample, or since learning began
  std::int64_t counts_ = 0;  ///< likewise
  double behind_ = 0.0;
};

}  // namespace tenon::hw
