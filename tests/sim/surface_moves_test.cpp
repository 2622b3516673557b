// Drawn moves of a keyed peg about the mouth of its socket, both meshes: the peg never goes
// through, the solver has nothing to say, and nothing sinks in deeper than it may.

#include <gtest/gtest.h>

#include <algorithm>

#include "shared/base/random.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/scene.h"
#include "tests/sim/keyed_peg.h"

namespace tenon::sim {
namespace {

struct Seen {
  int contacts = 0;
  int inserted = 0;
  double depth_max_m = 0.0;
};

Seen run_moves(CoordinateMask axes, int count) {
  const Task task = keyed_peg();
  OdeRollout rollout(task);
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene(task.held, task.environment);
  scene.attach(tool.body());
  Random random(11);
  const auto drawn = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  Seen seen;
  for (int i = 0; i < count; ++i) {
    Particle particle;
    particle.physics.contact_stiffness_Npm = 1e6;
    particle.physics.friction = 0.1 + 0.5 * random.uniform();
    particle.pose.position_m << drawn(1.5e-3), drawn(1.5e-3), 0.034;
    MoveParameters move;
    move.compliance.compliant_axes = axes;
    move.speeds.approach_mps = move.speeds.contact_mps = 0.02;
    move.displacement.head<3>() << drawn(4e-3), drawn(4e-3), -0.01 - 0.02 * random.uniform();
    std::vector<TraceSample> trace;
    const RolloutResult result = rollout.simulate(particle, move, 1000, &trace);
    EXPECT_TRUE(result.valid) << i << ": " << result.failure;
    seen.contacts += result.move.outcome == Outcome::kContact;
    seen.inserted += result.move.pose.position_m.z() < 0.028;
    for (std::size_t k = 0; k < trace.size(); k += 100) {
      tool.place(trace[k].input.pose);
      tool.show();
      seen.depth_max_m = std::max(seen.depth_max_m, scene.overlap_m());
    }
  }
  return seen;
}

TEST(SurfaceMoves, InTranslation) {
  const Seen seen = run_moves(0b000111, 40);
  EXPECT_LE(seen.depth_max_m, 100e-6);  // a tenth of the clearance
  EXPECT_GT(seen.contacts, 10);
  EXPECT_GT(seen.inserted, 2);
}

TEST(SurfaceMoves, WithTheWristYielding) {
  const Seen seen = run_moves(0b111111, 12);
  EXPECT_LE(seen.depth_max_m, 100e-6);
  EXPECT_GT(seen.contacts, 3);
}

}  // namespace
}  // namespace tenon::sim
