#include "planner/collision.h"

#include <algorithm>

#include "planner/belief/belief.h"
#include "shared/base/text.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

constexpr const char* kAsk = "; tenon-plan --check says what stands in what";

std::string where(const Vector3& p) { return format("(%.4f, %.4f, %.4f) m", p.x(), p.y(), p.z()); }

}  // namespace

std::string collision(const Task& task, const Start& start, Rollout& rollout) {
  const std::string overlaps =
      task.oversize_m > 0.0
          ? format(" is in collision with a part %g mm larger than drawn", 1e3 * task.oversize_m)
          : " is in collision";
  const std::string what = "start '" + start.name + "' of task '" + task.name + "' at ";
  if (rollout.in_collision(start.pose)) {
    return what + where(start.pose.position_m) + overlaps + ": move the start or the environment" +
           kAsk;
  }
  const Belief belief = cross_polytope(task, start);
  const auto inside =
      std::find_if(belief.particles.begin(), belief.particles.end(),
                   [&](const Particle& particle) { return rollout.in_collision(particle.tool()); });
  if (inside != belief.particles.end()) {
    return what + where(inside->tool().position_m) + ", " + reach_text(task) + "," + overlaps +
           ": move the start or lower its " +
           (task.errors == Distribution::kUniform ? "bounds" : "sigma") + kAsk;
  }
  if (!rollout.in_collision(task.goal)) return {};
  return "the goal of task '" + task.name + "' at " + where(task.goal.position_m) + overlaps +
         ": move it or the environment" + (task.oversize_m > 0.0 ? ", or lower oversize_m" : "") +
         kAsk;
}

}  // namespace tenon::planner
