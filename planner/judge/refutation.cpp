#include "planner/judge/refutation.h"

#include "shared/base/text.h"

namespace tenon::planner {

Refutation refutation_of(const Certification& certification) {
  const VariantRun& run = *certification.refuting();
  Refutation refutation{
      run.chains[run.disagreement.particle], std::nullopt,
      run.variant.name + ", " + format("step %zu: ", run.disagreement.step) + run.disagreement.why};
  // The same particle in the same physics: the step itself cannot be relied on.
  if (&run != &certification.runs.front()) refutation.step = run.disagreement.step;
  return refutation;
}

std::optional<Refutation> missed_draw(std::span<const Draw> draws, double particle_sigmas) {
  for (const Draw& draw : draws) {
    if (draw.at_goal || draw.mahalanobis > particle_sigmas) continue;
    return Refutation{draw.chain, std::nullopt,
                      format("a draw %.2f sigma out missed the goal", draw.mahalanobis)};
  }
  return std::nullopt;
}

std::optional<Refutation> missed_corner(std::span<const Draw> corners, const Task& task) {
  for (const Draw& corner : corners) {
    if (corner.at_goal) continue;
    return Refutation{corner.chain, std::nullopt,
                      format("a start %g sigma out missed the goal at ", corner.mahalanobis) +
                          corner_name(corner.chain.start.physics, task)};
  }
  return std::nullopt;
}

std::string corner_name(const PhysicalParameters& corner, const Task& task) {
  std::string name =
      format("friction %g, latency %.1f ms", corner.friction, 1e3 * corner.latency_s);
  if (task.oversize_m <= 0.0) return name;
  if (corner.oversize_m <= 0.0) return name + ", the part as drawn";
  return name + format(", the part %g mm larger than drawn", 1e3 * corner.oversize_m);
}

}  // namespace tenon::planner
