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

std::optional<Refutation> missed_draw(const Validation& validation, double particle_sigmas) {
  for (const Draw& draw : validation.draws) {
    if (draw.at_goal || draw.mahalanobis > particle_sigmas) continue;
    return Refutation{draw.chain, std::nullopt,
                      format("a draw %.2f sigma out missed the goal", draw.mahalanobis)};
  }
  return std::nullopt;
}

}  // namespace tenon::planner
