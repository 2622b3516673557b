#include "planner/judge/refutation.h"

#include "shared/base/text.h"
#include "shared/task/spread.h"

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

Refutation refutation_of(const Draw& missed, const Task& task) {
  return {missed.chain, std::nullopt,
          "a start " + out_text(task, missed.sigmas_out) + " missed the goal at " +
              corner_name(missed.chain.start.physics, task)};
}

std::string corner_name(const PhysicalParameters& corner, const Task& task) {
  std::string name =
      format("friction %.3g, latency %.1f ms", corner.friction, 1e3 * corner.latency_s);
  if (task.oversize_m <= 0.0) return name;
  if (corner.oversize_m <= 0.0) return name + ", the part as drawn";
  return name + format(", the part %.3g mm larger than drawn", 1e3 * corner.oversize_m);
}

}  // namespace tenon::planner
