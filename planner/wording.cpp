#include "planner/wording.h"

#include <algorithm>
#include <limits>

#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

/// How near the search has come.
std::string nearest(const BeliefGraph& graph) {
  double nearest_m = std::numeric_limits<double>::infinity();
  double certain_m2 = nearest_m;
  for (StateId state = 0; state < graph.size(); ++state) {
    const BeliefSummary& belief = graph.summary(state);
    nearest_m = std::min(nearest_m, belief.farthest_m);
    certain_m2 = std::min(certain_m2, belief.uncertainty_m2);
  }
  return format(
      " (the nearest had all particles within %.1f mm of the goal, the most certain %.2g m^2)",
      1e3 * nearest_m, certain_m2);
}

/// What has been tried by then.
std::string tried(const PlanReport& report, const BeliefGraph& graph) {
  return format("%zu expansion%s and %zu refuted path%s", report.expansions,
                plural(report.expansions), report.refusals.size(), plural(report.refusals.size())) +
         nearest(graph) +
         (report.refusals.empty() ? "" : "; last refuted: " + report.refusals.back());
}

/// Which directions stay open, and what would settle them.
std::string unsettled(CoordinateMask axes, Distribution errors) {
  std::string names;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(axes, axis)) continue;
    names += std::string(names.empty() ? "" : ", ") + axis_name(axis);
  }
  if (names.empty()) return {};
  return format(
      "; nothing that was pushed against settles %s: it takes a face across it that the part can "
      "reach with its whole spread, or a smaller %s there",
      names.c_str(), errors == Distribution::kUniform ? "uniform bound" : "sigma");
}

}  // namespace

std::string guide_text(const Guide& guide) {
  std::string contacts;
  for (const ContactAttractor& contact : guide.contacts) {
    contacts += format("%s%s%s to %s", contacts.empty() ? "" : ", ", contact.sign > 0 ? "+" : "-",
                       axis_name(contact.axis),
                       contact.flat != 0 ? "lie flat on a face"
                       : contact.face    ? "a face"
                                         : "an edge");
  }
  return contacts;
}

std::vector<std::string> heuristic_names(const std::vector<Guide>& guides) {
  std::vector<std::string> names = {"anchor"};
  for (const Guide& guide : guides) {
    const std::string contacts = guide_text(guide);
    names.push_back((contacts.empty() ? "straight" : contacts) +
                    (guide.goals.size() > 1 ? ", to the goal by its mouth" : ", to the goal"));
  }
  return names;
}

std::string guides_found(const std::vector<Guide>& guides, std::uint64_t moves) {
  std::string text =
      format("%zu guide%s, found with %llu move%s", guides.size(), plural(guides.size()),
             static_cast<unsigned long long>(moves), plural(moves));
  for (const Guide& guide : guides) text += "; " + guide_text(guide);
  return text;
}

std::string still(const char* doing, std::uint64_t moves, std::size_t states) {
  return format("%s, %llu move%s simulated and %zu state%s so far", doing,
                static_cast<unsigned long long>(moves), plural(moves), states, plural(states));
}

std::string guide_followed(const Guide& guide, std::size_t moves) {
  return "the guide " + guide_text(guide) +
         format(" leads to the goal in %zu step%s", moves, plural(moves));
}

std::string guide_left(const Guide& guide, const std::string& where) {
  return "the guide " + guide_text(guide) + " is left at " + where;
}

std::string path_found(const SearchResult& search) {
  return format("a path of %zu step%s after %zu expansion%s", search.path.size(),
                plural(search.path.size()), search.expanded.size(), plural(search.expanded.size()));
}

std::string less_to_hold(const CalibrationErrors& held) {
  if (held == CalibrationErrors{}) {
    return "no plan bears what calibration may leave: looking for one without";
  }
  std::string text = format("no plan bears that tilt: looking for one that bears %.2f degrees",
                            shown(held.tilt_rad, 3));
  if (held.sensor_error_m > 0.0) {
    text += format(", and the force sensor %.2g mm off", 1e3 * held.sensor_error_m);
  }
  return text;
}

std::string way_refuted(std::size_t starts, bool truer) {
  if (starts > 1) return format("; %zu starts that missed become particles", starts);
  if (starts == 1) return "; it becomes a particle";
  return truer ? "; now followed by the physics that judges" : "; the guide is left";
}

std::string lesson(const Refutation& refutation, std::optional<std::size_t> refused_step) {
  return refutation.why + (refused_step ? format("; its move in step %zu is refused", *refused_step)
                                        : "; it becomes a particle");
}

std::string already_at_goal(const Start& start) {
  return "start '" + start.name + "' is already within the goal's tolerances";
}

std::string no_path(PlanStatus status, const PlanReport& report, const BeliefGraph& graph,
                    const SearchLimits& limits, Distribution errors) {
  std::string what = "the searched graph has no path left after ";
  if (status == PlanStatus::kTimeLimit) {
    what = format("no path within %g s (raise --time-limit), after ", limits.time_s);
  } else if (status == PlanStatus::kMoveLimit) {
    what = format("no path within %llu simulated move%s (raise --move-limit), after ",
                  static_cast<unsigned long long>(limits.moves), plural(limits.moves));
  } else if (status == PlanStatus::kExpansionLimit) {
    what = format("%zu expansion%s in a search, the limit: no path after ", limits.expansions,
                  plural(limits.expansions));
  } else if (status == PlanStatus::kNoAttractor) {
    what = "no push from the start reduces its uncertainty, and no path exists after ";
  }
  return what + tried(report, graph) + unsettled(report.unsettled, errors);
}

std::string every_path_refuted(const PlanReport& report, std::size_t paths) {
  return format("every one of %zu paths was refuted, the last one: ", paths) +
         report.refusals.back();
}

}  // namespace tenon::planner
