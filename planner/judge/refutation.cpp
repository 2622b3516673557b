#include "planner/judge/refutation.h"

#include <cmath>

#include "planner/judge/judged_starts.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/inserted.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

/// " by -0.17 degrees about z"; about no one axis: " by 0.12 degrees".
std::string turn_text(const Vector3& turn_rad) {
  int most = 0;
  turn_rad.cwiseAbs().maxCoeff(&most);
  const bool about_one = std::abs(turn_rad[most]) == turn_rad.norm();
  const double told_rad = about_one ? turn_rad[most] : turn_rad.norm();
  return format(" by %.2f degrees", shown(told_rad, 3)) +
         (about_one ? format(" about %c", "xyz"[most]) : "");
}

/// ", tilted by -0.17 degrees about z", ", the part tilted in the hand by 0.12 degrees", or both.
std::string tilt_name(const Particle& particle, const Task& task, const Start& start) {
  // What rounding makes of a turn about one axis is none about another.
  constexpr double kNoTurn_rad = 1e-9;
  const Tilt tilt = tilt_of(particle, task, start);
  std::string name;
  const auto tell = [&](const std::string& what, const Vector3& turn_rad) {
    if (turn_rad.norm() < kNoTurn_rad) return;
    name += what + turn_text((turn_rad.array().abs() < kNoTurn_rad).select(0.0, turn_rad));
  };
  tell(", tilted", tilt.environment_rad);
  tell(", the part tilted in the hand", tilt.held_rad);
  return name;
}

}  // namespace

Refutation refutation_of(const Certification& certification) {
  const VariantRun& run = *certification.refuting();
  Refutation refutation{
      run.chains[run.disagreement.particle], std::nullopt,
      run.variant.name + ", " + format("step %zu: ", run.disagreement.step) + run.disagreement.why};
  // The same particle in the same physics: the step itself cannot be relied on.
  if (&run != &certification.runs.front()) refutation.step = run.disagreement.step;
  return refutation;
}

Refutation refutation_of(const Draw& missed, const Task& task, const Start& start) {
  return {missed.chain, std::nullopt,
          "a start " + out_text(task, missed.sigmas_out) + " missed the goal at " +
              corner_name(missed.chain.start, task, start) + ": " + miss_text(missed.chain, task)};
}

std::string miss_text(const Chain& missed, const Task& task) {
  if (!missed.done) return format("step %zu: ", missed.steps.back()) + missed.failure;
  const Pose end = missed.end();
  return format("ended %.2f mm and %.2f degrees from the goal",
                1e3 * (end.position_m - task.goal.position_m).norm(),
                shown(end.orientation.angularDistance(task.goal.orientation), 3)) +
         (inserted(task, end) ? "" : ", not inserted");
}

std::string corner_name(const Particle& particle, const Task& task, const Start& start) {
  const PhysicalParameters& corner = particle.physics;
  std::string name = format("friction %.3g, ", corner.friction);
  if (task.contact_give_mpN > 0.0) {
    name += format("contacts of %.3g N/mm, ", 1e-3 * corner.contact_stiffness_Npm);
  }
  name += format("latency %.1f ms", 1e3 * corner.latency_s);
  if (task.oversize_m > 0.0) {
    name += corner.oversize_m <= 0.0
                ? ", the part as drawn"
                : format(", the part %.3g mm larger than drawn", 1e3 * corner.oversize_m);
  }
  const Vector3& off_m = corner.sensor_error_m;
  if (!off_m.isZero(0.0)) name += format(", the force sensor %.2g mm off", 1e3 * off_m.norm());
  return name + tilt_name(particle, task, start);
}

}  // namespace tenon::planner
