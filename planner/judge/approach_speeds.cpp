#include "planner/judge/approach_speeds.h"

#include <algorithm>
#include <limits>

#include "planner/judge/plan_draft.h"

namespace tenon::planner {
namespace {

// A run at approach speed shorter than this is not worth a second speed.
constexpr double kShortestFast_m = 0.020;

}  // namespace

std::vector<double> slow_from(const Plan& plan, std::span<const Chain> chains,
                              double particle_sigmas) {
  std::vector<double> distances;
  for (std::size_t step = 0; step < plan.steps.size(); ++step) {
    const Vector3 way = plan.steps[step].displacement.head<3>();
    const double length_m = way.norm();
    double nearest_m = std::numeric_limits<double>::infinity();
    double farthest_m = 0.0;
    bool in_contact = false;
    for (const Chain& chain : chains) {
      for (std::size_t i = 0; i < chain.moves.size(); ++i) {
        if (chain.steps[i] != step || length_m == 0.0) continue;
        const double along_m = chain.moves[i].travelled.head<3>().dot(way) / length_m;
        farthest_m = std::max(farthest_m, along_m);
        if (chain.moves[i].outcome == Outcome::kReached) continue;
        in_contact = true;
        nearest_m = std::min(nearest_m, along_m);
      }
    }
    // The chains start c_p standard deviations out; keep one more in hand.
    const double spread_m = in_contact ? (farthest_m - nearest_m) / (2.0 * particle_sigmas) : 0.0;
    const double fast_m = in_contact ? nearest_m - spread_m - kSlowMargin_m : length_m;
    distances.push_back(fast_m < kShortestFast_m ? 0.0 : std::min(fast_m, length_m));
  }
  return distances;
}

Plan with_slow_from(Plan plan, std::span<const double> distances_m) {
  for (std::size_t i = 0; i < distances_m.size(); ++i) plan.steps[i].slow_from_m = distances_m[i];
  return through_bytes(plan);
}

bool any_fast(std::span<const double> distances_m) {
  return std::any_of(distances_m.begin(), distances_m.end(), [](double d) { return d > 0.0; });
}

bool shorten(const Plan& plan, std::span<const Chain> drawn, std::vector<double>& distances_m) {
  const std::vector<double> allowed_m =
      slow_from(plan, drawn, std::numeric_limits<double>::infinity());
  bool shortened = false;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    // slow_from() keeps its margin; half of it is enough for what was only drawn.
    if (plan.steps[i].slow_from_m <= allowed_m[i] + 0.5 * kSlowMargin_m) continue;
    distances_m[i] = allowed_m[i];
    shortened = true;
  }
  return shortened;
}

}  // namespace tenon::planner
