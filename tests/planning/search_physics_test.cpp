// What is searched on may be as wrong as it likes: no plan is written that the truth does not bear
// out.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "planner/judge/certification.h"
#include "planner/planner.h"
#include "shared/base/random.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/places.h"

namespace tenon::planner {
namespace {

enum class Lie { kNone, kRandom, kAlwaysReached, kFlipped, kTempting };

/// ODE's, with a lie about some of the moves. Which, and what about, depends on the move alone.
class LyingRollout final : public Rollout {
 public:
  LyingRollout(const Task& task, Lie lie, unsigned one_in)
      : task_(task), truth_(task), lie_(lie), one_in_(one_in) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    RolloutResult result = truth_.simulate(particle, move, step_us, trace);
    const double sum = 1e7 * (particle.pose.position_m.sum() + 3.0 * move.displacement.sum());
    Random random(static_cast<std::uint64_t>(std::llround(std::abs(sum))));
    if (lie_ == Lie::kNone || random.uniform() * one_in_ >= 1.0) return result;
    Pose& end = result.move.pose;
    switch (lie_) {
      case Lie::kNone:
        break;
      case Lie::kRandom:
        for (int axis = 0; axis < 3; ++axis) {
          if (move.compliance.compliant_axes >> axis & 1U) {
            end.position_m[axis] += 0.05 * (random.uniform() - 0.5);
          }
        }
        break;
      case Lie::kAlwaysReached:
        end.position_m = particle.pose.position_m + move.displacement.head<3>();
        result.move.outcome = Outcome::kReached;
        result.move.signature = {};
        break;
      case Lie::kFlipped:
        end.position_m = particle.pose.position_m - (end.position_m - particle.pose.position_m);
        break;
      case Lie::kTempting:  // nearer to the goal, and to each other, than anything has brought them
        end.position_m = 0.5 * (end.position_m + task_.goal.position_m);
        break;
    }
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override {
    return truth_.in_collision(tool_pose);
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<LyingRollout>(task_, lie_, one_in_);
  }

 private:
  Task task_;
  sim::OdeRollout truth_;
  Lie lie_;
  unsigned one_in_;
};

struct Tally {
  int planned = 0;
  std::size_t refuted = 0;
};

/// So small a budget may leave a plan that holds less than all of the tilt, which draws have.
void expect_only_tilts_missed(const PlanReport& report, const Task& task, RolloutPool& pool) {
  std::vector<JudgedStart> levelled;
  for (const Draw& draw : report.validation.draws) {
    if (draw.at_goal) continue;
    EXPECT_LT(report.validation.held.tilt_rad, task.tilt_rad);
    const Start& start = start_of(*report.plan, task);
    EXPECT_GT(tilt_of(draw.chain.start, task, start).norm_rad(), 0.0);
    levelled.push_back({without_tilt(draw.chain.start, task, start), draw.sigmas_out});
  }
  EXPECT_EQ(arrived(run_starts(*report.plan, task, levelled, pool)), levelled.size());
}

Tally plan_on_lies(const std::string& name) {
  const Task task = load_task(tests::in_tree("planner/tasks/" + name + ".yaml"));
  const sim::OdeRollout truth(task);
  Tally tally;
  for (const Lie lie : {Lie::kRandom, Lie::kAlwaysReached, Lie::kFlipped, Lie::kTempting}) {
    for (const unsigned one_in : {1U, 20U}) {
      const LyingRollout lying(task, lie, one_in);
      PlannerOptions options;
      options.search_physics = &lying;
      options.threads = 2;
      options.expansions_max = 60;
      options.rounds_max = 6;
      const PlanReport report = make_plan(task, task.starts.front(), truth, options);
      tally.refuted += report.refusals.size();
      if (report.status != PlanStatus::kPlanned) continue;
      ++tally.planned;
      RolloutPool pool(truth, 2);
      EXPECT_TRUE(certify(report.bytes, task, pool).holds()) << name << " " << one_in;
      EXPECT_EQ(arrived(report.validation.corners), report.validation.corners.size());
      expect_only_tilts_missed(report, task, pool);
    }
  }
  std::printf("%s: %d planned on lies, %zu paths refuted\n", name.c_str(), tally.planned,
              tally.refuted);
  return tally;
}

TEST(SearchPhysics, LiesAreRefutedAndNeverWritten) {
  const Tally toy = plan_on_lies("toy_1d");
  const Tally box = plan_on_lies("box_on_table_2d");
  EXPECT_GT(toy.refuted + box.refuted, 0U);
  EXPECT_GT(toy.planned + box.planned, 0);  // on the smaller lies
}

TEST(SearchPhysics, TheTruthInItsPlaceGivesTheSameBytes) {
  const Task task = load_task(tests::in_tree("planner/tasks/toy_1d.yaml"));
  const sim::OdeRollout truth(task);
  PlannerOptions options;
  options.draws = 20;
  const PlanReport without = make_plan(task, task.starts.front(), truth, options);
  const LyingRollout honest(task, Lie::kNone, 1);
  options.search_physics = &honest;
  EXPECT_EQ(make_plan(task, task.starts.front(), truth, options).bytes, without.bytes);
  EXPECT_FALSE(without.bytes.empty());
}

}  // namespace
}  // namespace tenon::planner
