#pragma once
// What a sensor reads while nothing touches moves between two tares; each newton of it shifts a
// compliant tool by 1 / K. A move through free air shows it: began without contact, ended without,
// nothing but noise over the whole of its way. What its last samples read is the sensor's new zero.
// A body that the tool brushes on such a way does not push evenly: its first samples and its last
// differ by more than noise and the payload's own motion make of them. Real-time, one thread.

#include <algorithm>
#include <cmath>
#include <optional>

#include "shared/math/pose.h"

namespace tenon::executor {

class FreeAirZero {
 public:
  struct Parameters {
    int samples = 50;                                ///< that the newest mean is about
    Vector6 deviation_max = Vector6::Constant(0.3);  ///< over the whole way, N and Nm
    Vector6 moved_max = Vector6::Constant(0.75);     ///< since the tare
  };

  explicit FreeAirZero(const Parameters& parameters) : parameters_(parameters) {}

  /// A move begins. @param free it holds no contact
  void begin(bool free) {
    steady_ = free;
    count_ = 0;
    mean_.setZero();
    squares_.setZero();
    newest_.setZero();
    first_.setZero();
    steps_.setZero();
  }
  /// Something touches, or may.
  void touch() { steady_ = false; }

  /// One fresh sample, N and Nm, against the zero as it is.
  void add(const Vector6& sample) {
    if (!steady_) return;
    ++count_;
    if (count_ > 1) steps_ += (sample - last_).cwiseAbs2();
    last_ = sample;
    if (count_ <= parameters_.samples) first_ += sample / parameters_.samples;
    // Welford's recurrence.
    const Vector6 before = sample - mean_;
    mean_ += before / count_;
    squares_ += before.cwiseProduct(sample - mean_);
    newest_ += (sample - newest_) / std::min(count_, parameters_.samples);
  }

  /// The move has ended in free air.
  /// @return by how much the zero is to move now, no farther from the tare than it may; empty where
  /// the way was too short, or not free all along
  [[nodiscard]] std::optional<Vector6> end() {
    if (!steady_ || count_ < 2 * parameters_.samples) return std::nullopt;
    const Vector6 deviation = (squares_ / (count_ - 1)).cwiseSqrt();
    if ((deviation.array() > parameters_.deviation_max.array()).any() || is_uneven()) {
      return std::nullopt;
    }
    const Vector6 before = moved_;
    moved_ = (moved_ + newest_).cwiseMax(-parameters_.moved_max).cwiseMin(parameters_.moved_max);
    return moved_ - before;
  }

  /// Since the tare, N and Nm.
  [[nodiscard]] const Vector6& moved() const { return moved_; }

 private:
  // Of the deviation that the difference of two means may have.
  static constexpr double kDeviations = 6.0;
  // Of moved_max: what speeding up and braking may leave of a payload that is not quite known.
  static constexpr double kOwnShare = 0.4;

  /// By what neighbours differ tells the noise, whatever the mean does (von Neumann).
  [[nodiscard]] bool is_uneven() const {
    const Vector6 noise = (0.5 * steps_ / (count_ - 1)).cwiseSqrt();
    const Vector6 allowed = (kDeviations * std::sqrt(2.0 / parameters_.samples) * noise)
                                .cwiseMax(kOwnShare * parameters_.moved_max);
    return ((newest_ - first_).cwiseAbs().array() > allowed.array()).any();
  }

  Parameters parameters_;
  bool steady_ = false;
  int count_ = 0;
  Vector6 mean_ = Vector6::Zero();
  Vector6 squares_ = Vector6::Zero();
  Vector6 newest_ = Vector6::Zero();
  Vector6 first_ = Vector6::Zero();  ///< mean of the first
  Vector6 last_ = Vector6::Zero();
  Vector6 steps_ = Vector6::Zero();  ///< squares of what a sample differs by from the one before
  Vector6 moved_ = Vector6::Zero();
};

}  // namespace tenon::executor
