#include "planner/check/task_check.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "planner/belief/belief.h"
#include "planner/check/sizes.h"
#include "planner/check/understood.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/inserted.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

using Weight = Finding::Weight;

// What arms, calibrated and soft, are good for at best.
constexpr double kPlayMin_m = 5e-5;

std::string at(const Vector3& p) { return format("(%.4g, %.4g, %.4g) m", p.x(), p.y(), p.z()); }

const char* sign_text(int sign) { return sign > 0 ? "+" : "-"; }

std::string oversize_text(const Task& task) {
  if (task.oversize_m <= 0.0) return "";
  return format(", with a part %g mm larger than drawn (oversize_m)", 1e3 * task.oversize_m);
}

/// "peg stands 45 mm deep in bottom (free by +z)"
std::string overlap_text(const Overlap& overlap, const Task& task) {
  std::string text =
      overlap.held + format(" stands %.3g mm deep in ", 1e3 * overlap.depth_m) +
      overlap.environment +
      format(" (the shortest way out is %s%s)", sign_text(overlap.sign), axis_name(overlap.axis));
  return text + oversize_text(task);
}

class Checker {
 public:
  Checker(const Task& task, const MakeRollout& make) : task_(task), probe_(task, make) {}

  void sizes() {
    for (Finding& finding : doubtful_sizes(task_)) {
      check_.findings.push_back(std::move(finding));
    }
  }

  void goal() {
    const auto overlap = probe_.deepest(task_.goal);
    if (overlap) {
      check_.goal_free = false;
      if (tighter(*overlap)) return;
      add(Weight::kRefused,
          "the goal at " + at(task_.goal.position_m) +
              " is in collision: " + overlap_text(*overlap, task_) +
              ": shapes are placed by their middle; move the goal or one of them");
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!has(task_.coordinates, axis)) continue;
      const double reach_m = push_reach_m(task_);
      check_.goal_room.push_back({axis, probe_.way_to_touch(task_.goal, axis, -1, reach_m),
                                  probe_.way_to_touch(task_.goal, axis, 1, reach_m)});
      play(check_.goal_room.back());
    }
    const bool alone = std::all_of(check_.goal_room.begin(), check_.goal_room.end(),
                                   [](const GoalRoom& room) { return !room.down_m && !room.up_m; });
    if (alone) {
      add(Weight::kDoubt, "at the goal at " + at(task_.goal.position_m) +
                              " nothing is near: no push from it, along any coordinate, touches "
                              "the environment");
    }
  }

  /// A part as wide as its hole: nothing is in anything, and yet it never goes in.
  void play(const GoalRoom& room) {
    if (!room.down_m || !room.up_m) return;
    const double play_m = *room.down_m + *room.up_m;
    if (play_m >= kPlayMin_m) return;
    add(Weight::kDoubt,
        format("at the goal the play along %s (both ways together) is %s mm, less than %g mm: no "
               "arm puts it in; is a clearance missing between part and hole?",
               axis_name(room.axis), way_mm_text(play_m).c_str(), 1e3 * kPlayMin_m) +
            oversize_text(task_));
  }

  // Out of the one it is in the other: no place of the goal helps. @return it is so, and told
  bool tighter(const Overlap& overlap) {
    const Pose beside = moved(task_.goal, overlap.axis, overlap.sign * overlap.depth_m);
    const auto other = probe_.deepest(beside);
    const bool between = other && other->axis == overlap.axis && other->sign == -overlap.sign &&
                         other->environment != overlap.environment;
    if (!between) return false;
    add(Weight::kRefused, "at the goal at " + at(task_.goal.position_m) + " " + overlap.held +
                              format(" is %.2g mm wider along %s than the room between ",
                                     1e3 * other->depth_m, axis_name(overlap.axis)) +
                              overlap.environment + " and " + other->environment +
                              oversize_text(task_) + ": make it narrower, or the room wider");
    return true;
  }

  void start(const Start& start) {
    const std::string what = "start '" + start.name + "' at " + at(start.pose.position_m);
    StartCheck& checked = check_.starts.emplace_back();
    checked.name = start.name;
    if (const auto overlap = probe_.deepest(start.pose)) {
      checked.free = false;
      add(Weight::kRefused, what + " is in collision: " + overlap_text(*overlap, task_) +
                                ": move the start or the environment");
      return;
    }
    const Belief belief = cross_polytope(task_, start);
    for (const Particle& particle : belief.particles) {
      checked.particles.push_back({particle.tool(), probe_.free(particle.tool())});
    }
    const bool free = all_free(start, checked.particles, what);
    const bool arrived =
        std::all_of(belief.particles.begin(), belief.particles.end(),
                    [&](const Particle& p) { return within_tolerance(task_, p.tool()); });
    if (arrived && !belief.particles.empty()) {
      add(Weight::kDoubt, what +
                              " is already within the goal's tolerance, wherever in its spread "
                              "the part is: nothing is left to plan");
    }
    if (!free) return;
    corners(start, what);
    checked.touches = touchable(task_, start, probe_);
    untouched(start, checked.touches);
  }

  [[nodiscard]] TaskCheck take() {
    std::stable_sort(check_.findings.begin(), check_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.weight < b.weight; });
    // Where the sizes are wrong, all that collides does so for that.
    const std::vector<Finding> sizes = doubtful_sizes(task_);
    for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) {
      const auto found =
          std::find_if(check_.findings.begin(), check_.findings.end(),
                       [&](const Finding& finding) { return finding.text == size->text; });
      std::rotate(check_.findings.begin(), found, std::next(found));
    }
    return std::move(check_);
  }

 private:
  void add(Weight weight, std::string text) {
    check_.findings.push_back({weight, std::move(text)});
  }

  /// Whether all of them stand free. The first that does not is told of.
  bool all_free(const Start& start, const std::vector<CheckedParticle>& particles,
                const std::string& what) {
    for (const auto& [tool, free] : particles) {
      if (free) continue;
      const Vector6 off = displacement_between(start.pose, tool);
      int axis = 0;
      off.cwiseAbs().maxCoeff(&axis);
      const int sign = off[axis] < 0.0 ? -1 : 1;
      std::string text = what + " is free, but " + reach_text(task_) +
                         format(" along %s%s", sign_text(sign), axis_name(axis));
      const auto way_m = axis < 3 ? probe_.way_to_touch(start.pose, axis, sign, std::abs(off[axis]))
                                  : std::nullopt;
      if (way_m) {
        text += format(" the part would be %.3g mm inside ", 1e3 * (std::abs(off[axis]) - *way_m)) +
                probe_.met_at(tool) +
                format(": move the start, or lower its %s there from %g to %.3g m",
                       error_key(task_, axis), stated_error(task_, start, axis),
                       *way_m / std::abs(off[axis]) * stated_error(task_, start, axis));
      } else {
        text += " the part stands in " + probe_.met_at(tool) +
                format(": move the start or lower its %s there", error_key(task_, axis));
      }
      add(Weight::kRefused, text);
      return false;
    }
    return true;
  }

  /// Uniform errors reach to where all of them are at their bounds. @param what of the start
  void corners(const Start& start, const std::string& what) {
    if (task_.errors != Distribution::kUniform) return;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Pose tool = start.pose;
      std::string where;
      for (int axis = 0; axis < 3; ++axis) {
        const double bound_m = task_.particle_sigmas * start.sigma[axis];
        const int sign = (corner >> static_cast<unsigned>(axis) & 1U) != 0 ? 1 : -1;
        tool = moved(tool, axis, sign * bound_m);
        if (bound_m > 0.0) where += format(" %s%s", sign_text(sign), axis_name(axis));
      }
      const auto overlap = probe_.deepest(tool);
      if (!overlap) continue;
      std::string text =
          what + " is free at each of its bounds, but where all errors are at theirs,";
      text += where + ", " + overlap_text(*overlap, task_);
      text += ": no such world can be; lower a bound or move the start";
      add(Weight::kDoubt, std::move(text));
      return;
    }
  }

  void untouched(const Start& start, const std::vector<Touch>& touches) {
    CoordinateMask open = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double own_m = task_.goal_axes.tolerance[axis];
      const double allowed_m = own_m > 0.0 ? own_m : task_.goal_tolerance_m;
      const bool uncertain =
          task_.particle_sigmas * start.sigma[axis] > allowed_m && !has(task_.goal_axes.free, axis);
      if (!has(task_.coordinates, axis) || !uncertain || touched_along(touches, axis)) continue;
      open = static_cast<CoordinateMask>(open | 1U << static_cast<unsigned>(axis));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (!has(open, axis) || others_hide(start, open, axis)) continue;
      add(Weight::kDoubt,
          "start '" + start.name + "' has nothing to touch along " + axis_name(axis) +
              format(" within %.3g m: only a contact tells where the part is along it. It takes a "
                     "face across %s, wider than the start's spread, or a smaller %s there than "
                     "%g m",
                     push_reach_m(task_), axis_name(axis), error_key(task_, axis),
                     stated_error(task_, start, axis)));
    }
  }

  /// Whether the much larger spread along other open axes is why nothing is touched along one: a
  /// smaller one along them helps, and is asked for there.
  bool others_hide(const Start& start, CoordinateMask open, int axis) {
    constexpr double kMuchLarger = 4.0;
    Start known = start;
    double largest_m = 0.0;
    for (int other = 0; other < 3; ++other) {
      if (other == axis || !has(open, other)) continue;
      largest_m = std::max(largest_m, start.sigma[other]);
      known.sigma[other] = 0.0;
    }
    return largest_m > kMuchLarger * start.sigma[axis] &&
           touched_along(touchable(task_, known, probe_), axis);
  }

  static bool touched_along(const std::vector<Touch>& touches, int axis) {
    return std::any_of(touches.begin(), touches.end(),
                       [axis](const Touch& touch) { return touch.axis == axis; });
  }

  const Task& task_;
  Probe probe_;
  TaskCheck check_;
};

}  // namespace

bool TaskCheck::refused() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.weight == Finding::Weight::kRefused;
  });
}

void TaskCheck::refuse(std::string text) {
  const auto behind = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.weight != Finding::Weight::kRefused;
  });
  findings.insert(behind, {Finding::Weight::kRefused, std::move(text)});
}

TaskCheck check_task(const Task& task, const std::vector<Start>& starts, const MakeRollout& make) {
  Checker checker(task, make);
  checker.sizes();
  checker.goal();
  for (const Start& start : starts) checker.start(start);
  return checker.take();
}

}  // namespace tenon::planner
