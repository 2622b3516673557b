#include "executor/sensing/encoder_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/base/time_units.h"

namespace tenon::executor {
namespace {

// As following_watch.cpp counts them.
constexpr double kLags = 3.0;
constexpr double kCommandsLost = 4.0;
// Either position may be rounded.
constexpr double kRounded_counts = 2.0;

}  // namespace

EncoderWatch::EncoderWatch(const Robot& robot)
    : joint_count_(robot.joints.size()), cycle_s_(1e-6 * robot.cycle_us) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const Joint& joint = robot.joints[i];
    speed_max_[i] =
        joint.speed_max > 0.0 ? joint.speed_max : std::numeric_limits<double>::infinity();
    const double counts = std::abs(joint.counts_per_unit);
    resolution_[i] = counts > 0.0 ? kRounded_counts / counts : 0.0;
  }
  const double window = std::ceil(kLags * robot.response_lag_s / cycle_s_) + kCommandsLost;
  window_ = static_cast<std::size_t>(std::clamp(window, 1.0, static_cast<double>(kWindowMost)));
}

void EncoderWatch::commanded(const JointVector& position) {
  newest_ = (newest_ + 1) % window_;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    changes_[newest_][i] = commanded_ ? position[i] - (*commanded_)[i] : 0.0;
  }
  commanded_ = position;
}

std::optional<EncoderWatch::Jump> EncoderWatch::update(const JointVector& measured,
                                                       std::uint32_t fresh, std::int64_t sync_ns) {
  std::optional<Jump> first;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    ++last_[i].cycles;
    if ((fresh >> i & 1U) == 0) continue;
    const std::optional<Jump> jump = judge(i, measured[i], sync_ns);
    if (!first) first = jump;
    last_[i] = {measured[i], sync_ns, 0, true};
  }
  return first;
}

std::optional<EncoderWatch::Jump> EncoderWatch::judge(std::size_t joint, double position,
                                                      std::int64_t sync_ns) const {
  const Answer& last = last_[joint];
  if (!last.known) return std::nullopt;
  double back = 0.0;
  double ahead = 0.0;
  for (std::size_t k = 0; k < window_; ++k) {
    back = std::min(back, changes_[k][joint]);
    ahead = std::max(ahead, changes_[k][joint]);
  }
  // A loop that slept has counted one cycle.
  const double slept_s = kNanosecond_s * static_cast<double>(sync_ns - last.sync_ns);
  const double cycles = std::max(static_cast<double>(last.cycles), slept_s / cycle_s_);
  const double beside = cycles * cycle_s_ * speed_max_[joint] + resolution_[joint];
  const double low = (cycles + kCommandsLost) * back - beside;
  const double high = (cycles + kCommandsLost) * ahead + beside;
  const double moved = position - last.position;
  if (moved >= low && moved <= high) return std::nullopt;
  return Jump{static_cast<int>(joint), moved, moved < low ? low : high};
}

}  // namespace tenon::executor
