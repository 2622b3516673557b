#include "executor/sensing/following_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "executor/faults/fault_bounds.h"

namespace tenon::executor {
namespace {

// A first-order lag has come to 5 % of the way within three of its time constants.
constexpr double kFollowedLags = 3.0;
// A command that is lost or late is made up for by the next.
constexpr double kFollowedLost = 4.0;
constexpr double kRemembered_s = 0.1;

}  // namespace

FollowingWatch::FollowingWatch(const Robot& robot) : joint_count_(robot.joints.size()) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const double bound = robot.joints[i].following_error_max;
    bound_[i] = bound > 0.0 ? bound : std::numeric_limits<double>::infinity();
  }
  const double cycle_s = 1e-6 * robot.cycle_us;
  const double window = std::ceil(kFollowedLags * robot.response_lag_s / cycle_s) + kFollowedLost;
  window_ = static_cast<std::size_t>(std::clamp(window, 1.0, static_cast<double>(kWindowMost)));
  cycles_max_ = static_cast<int>(std::ceil(kFollowingPatience_s / cycle_s));
  remembered_cycles_ = static_cast<int>(std::ceil(kRemembered_s / cycle_s));
}

void FollowingWatch::rest_at(const JointVector& position) {
  commands_.fill(position);
  cycles_off_.fill(0);
  furthest_.fill(0.0);
}

void FollowingWatch::commanded(const JointVector& position) {
  newest_ = (newest_ + 1) % window_;
  commands_[newest_] = position;
}

std::optional<FollowingWatch::Excess> FollowingWatch::update(const JointVector& measured,
                                                             std::uint32_t fresh) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if ((fresh >> i & 1U) == 0) continue;
    const double error = error_of(i, measured[i]);
    remember(i, error);
    cycles_off_[i] = error > bound_[i] ? cycles_off_[i] + 1 : 0;
    if (cycles_off_[i] > cycles_max_) return Excess{static_cast<int>(i), error, bound_[i]};
  }
  return std::nullopt;
}

void FollowingWatch::remember(std::size_t joint, double error) {
  const bool old = ++furthest_age_[joint] > remembered_cycles_;
  if (error < furthest_[joint] && !old) return;
  furthest_[joint] = error;
  furthest_age_[joint] = 0;
}

std::optional<FollowingWatch::Excess> FollowingWatch::laggard() const {
  constexpr double kShareLeast = 0.25;
  std::optional<Excess> furthest;
  double most = kShareLeast;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const double share = furthest_[i] / bound_[i];
    if (share <= most) continue;
    most = share;
    furthest = Excess{static_cast<int>(i), furthest_[i], bound_[i]};
  }
  return furthest;
}

double FollowingWatch::error_of(std::size_t joint, double position) const {
  double low = commands_[0][joint];
  double high = low;
  for (std::size_t k = 1; k < window_; ++k) {
    low = std::min(low, commands_[k][joint]);
    high = std::max(high, commands_[k][joint]);
  }
  return std::max({0.0, low - position, position - high});
}

}  // namespace tenon::executor
