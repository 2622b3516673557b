#include "planner/check/touchable.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/search/guide_moves.h"
#include "shared/base/text.h"
#include "shared/ports/collision_depth.h"

namespace tenon::planner {
namespace {

// Lines through more places would not end within a second.
constexpr std::size_t kPlacesMax = 8;
constexpr double kStridesMax = 250.0;
constexpr double kSamePlace_m = 1e-3;
// So far beyond the first contact it is seen what is touched.
constexpr double kInto_m = 2.0 * kCollisionDepth_m;

/// Where lines go through, along one axis.
std::vector<double> places(const Task& task, const Start& start, int axis) {
  const double tip_m = start.pose.position_m[axis];
  std::vector<double> places = {tip_m};
  const auto add = [&](double place_m) {
    const bool known = std::any_of(places.begin(), places.end(), [&](double other_m) {
      return std::abs(other_m - place_m) < kSamePlace_m;
    });
    if (!known && places.size() < kPlacesMax) places.push_back(place_m);
  };
  add(task.goal.position_m[axis]);
  const Vector3 part_m = compose(start.pose, task.held.front().pose).position_m;
  for (const Shape& shape : task.environment) {
    add(shape.pose.position_m[axis] - (part_m[axis] - tip_m));
  }
  return places;
}

class Sweeps {
 public:
  Sweeps(const Task& task, const Start& start, Probe& probe)
      : task_(task),
        start_(start),
        probe_(probe),
        reach_m_(push_reach_m(task)),
        stride_m_(std::max(probe.stride_m(), reach_m_ / kStridesMax)) {}

  /// All axes in turns: what one contact has settled is no spread for the next.
  void all() {
    for (bool found = true; found;) {
      found = false;
      for (int axis = 0; axis < 3; ++axis) {
        if (!has(task_.coordinates, axis) || start_.sigma[axis] <= 0.0 || touched(axis)) continue;
        along(axis);
        if (touched(axis)) found = true;
      }
    }
  }

  /// Both ways along an axis.
  void along(int axis) {
    axis_ = axis;
    std::array<std::vector<double>, 3> where;
    for (int other = 0; other < 3; ++other) {
      const auto index = static_cast<std::size_t>(other);
      where.at(index) = {start_.pose.position_m[other]};
      if (other != axis && has(task_.coordinates, other)) {
        where.at(index) = places(task_, start_, other);
      }
    }
    for (const double x : where[0]) {
      for (const double y : where[1]) {
        for (const double z : where[2]) line({x, y, z});
      }
    }
  }

  [[nodiscard]] std::vector<Touch> take() { return std::move(touches_); }

 private:
  [[nodiscard]] bool touched(int axis) const {
    return std::any_of(touches_.begin(), touches_.end(),
                       [axis](const Touch& touch) { return touch.axis == axis; });
  }

  [[nodiscard]] double spread_m(int axis) const {
    return task_.particle_sigmas * start_.sigma[axis];
  }

  /// Every place where the line passes from free to not, or back.
  void line(const Vector3& through_m) {
    Pose at = start_.pose;
    at.position_m = through_m;
    at = moved(at, axis_, -reach_m_);
    bool was_free = probe_.free(at);
    for (double way_m = stride_m_; way_m <= 2.0 * reach_m_; way_m += stride_m_) {
      const Pose next = moved(at, axis_, stride_m_);
      const bool is_free = probe_.free(next);
      if (was_free && !is_free) consider(at, 1);
      if (!was_free && is_free) consider(next, -1);
      was_free = is_free;
      at = next;
    }
  }

  /// @param free from where a push along the sign touches soon
  void consider(const Pose& free, int sign) {
    const auto way_m = probe_.way_to_touch(free, axis_, sign, stride_m_);
    if (!way_m) return;
    Touch touch;
    touch.axis = axis_;
    touch.sign = sign;
    touch.tool = moved(free, axis_, sign * *way_m);
    touch.from_start_m = (touch.tool.position_m - start_.pose.position_m).norm();
    const auto known = std::find_if(touches_.begin(), touches_.end(), [&](const Touch& other) {
      return other.axis == axis_ && other.sign == sign;
    });
    const bool nearer = known == touches_.end() || touch.from_start_m < known->from_start_m;
    if (!nearer && known->in_legs) return;
    if (!whole_spread_touches(touch)) return;
    touch.in_legs = legs_lead_to(moved(touch.tool, axis_, -sign * kSamePlace_m), touch.legs);
    if (known != touches_.end() && (known->in_legs == touch.in_legs ? !nearer : known->in_legs)) {
      return;
    }
    touch.shape = probe_.met_at(moved(touch.tool, axis_, sign * kInto_m));
    if (known == touches_.end()) {
      touches_.push_back(touch);
    } else {
      *known = touch;
    }
  }

  /// In any order of the axes. @param legs gets that order
  [[nodiscard]] bool legs_lead_to(const Pose& to, std::string& legs) {
    const Vector3 way_m = to.position_m - start_.pose.position_m;
    std::array<int, 3> order = {0, 1, 2};
    do {
      Pose at = start_.pose;
      const auto leg = [&](int axis) {
        const int sign = way_m[axis] < 0.0 ? -1 : 1;
        const double leg_m = std::abs(way_m[axis]);
        if (leg_m > 0.0 && probe_.way_to_touch(at, axis, sign, leg_m)) return false;
        at = moved(at, axis, way_m[axis]);
        return true;
      };
      if (!std::all_of(order.begin(), order.end(), leg)) continue;
      for (const int axis : order) {
        if (way_m[axis] == 0.0) continue;
        legs.append(legs.empty() ? "" : ", ").append(axis_name(axis));
      }
      return true;
    } while (std::next_permutation(order.begin(), order.end()));
    return false;
  }

  [[nodiscard]] bool whole_spread_touches(const Touch& touch) {
    const double within_m = task_.attractor_ratio * spread_m(axis_);
    // As far back as the farthest of the spread would begin.
    const Pose back = moved(touch.tool, axis_, -touch.sign * (within_m + kSamePlace_m));
    if (probe_.way_to_touch(back, axis_, touch.sign, within_m)) return false;  // something else
    for (int corner = 0; corner < 8; ++corner) {
      Pose from = back;
      for (int other = 0; other < 3; ++other) {
        if (other == axis_) continue;
        const double sign = (corner >> other & 1) != 0 ? 1.0 : -1.0;
        from.position_m[other] += touched(other) ? 0.0 : sign * spread_m(other);
      }
      if ((corner >> axis_ & 1) != 0) continue;  // the same corner again
      if (!probe_.free(from)) return false;
      const double farthest_m = 2.0 * within_m + kSamePlace_m;
      if (!probe_.way_to_touch(from, axis_, touch.sign, farthest_m)) return false;
    }
    return true;
  }

  const Task& task_;
  const Start& start_;
  Probe& probe_;
  const double reach_m_;
  const double stride_m_;
  int axis_ = 0;
  std::vector<Touch> touches_;
};

}  // namespace

double push_reach_m(const Task& task) {
  if (!task.guide_moves) return task.long_step_m;  // the task says so, and gives pushes the time
  double reach_m = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (has(task.coordinates, axis)) reach_m = std::max(reach_m, longest_move(task, axis));
  }
  return std::min(reach_m, task.long_step_m);
}

std::vector<Touch> touchable(const Task& task, const Start& start, Probe& probe) {
  Sweeps sweeps(task, start, probe);
  sweeps.all();
  return sweeps.take();
}

}  // namespace tenon::planner
