#include "tests/solids/solid_moves.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>
#include <vector>

#include "shared/base/fnv.h"
#include "shared/base/random.h"
#include "shared/system/fan_out.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/solids/fcl_witness.h"

namespace tenon::tests {
namespace {

constexpr std::size_t kMovesOfAChain = 10;
constexpr std::int64_t kStep_us = 1000;
constexpr std::size_t kInstants_ms = 100;

TriangleMesh as_its_file_has_it(const Solid& solid) {
  TriangleMesh mesh = solid.mesh();
  for (Vector3& point_m : mesh.points_m) point_m += solid.centre_m();
  return mesh;
}

Shape shape_of(const char* name, const std::shared_ptr<const Solid>& solid, const Pose& pose) {
  return Shape{name, Shape::Kind::kSolid, solid->size_m(), pose, solid};
}

/// One pair as a task has it, turned; the tool frame stands at the foremost end of the held part.
class Scenery {
 public:
  Scenery(const SolidPair& pair, const Eigen::Quaterniond& turned)
      : pair_(pair),
        turned_(turned),
        witness_(as_its_file_has_it(*pair.held), as_its_file_has_it(*pair.environment)) {
    const double along_m = pair.held->size_m().dot(pair.way_out.cwiseAbs());
    tip_m_ = pair.held->centre_m() - 0.5 * along_m * pair.way_out;
    task_.held = {shape_of("held", pair.held,
                           {pair.held->centre_m() - tip_m_, Eigen::Quaterniond::Identity()})};
    task_.environment = {
        shape_of("environment", pair.environment, {turned * pair.environment->centre_m(), turned})};
  }

  [[nodiscard]] const Task& task() const { return task_; }
  [[nodiscard]] FclWitness::Opinion opinion(const Pose& tool) const {
    const Pose X_TH = compose(tool, {-tip_m_, Eigen::Quaterniond::Identity()});
    return witness_.at(compose(inverse({Vector3::Zero(), turned_}), X_TH));
  }
  /// In the task frame. @param aside_m, turn_rad as if nothing were turned
  [[nodiscard]] Pose tool_at(double lift_m, const Vector3& aside_m, const Vector3& turn_rad) const {
    return {turned_ * (tip_m_ + lift_m * pair_.way_out + aside_m), turned_ * rotation_of(turn_rad)};
  }
  [[nodiscard]] const Eigen::Quaterniond& turned() const { return turned_; }
  [[nodiscard]] const SolidPair& pair() const { return pair_; }

 private:
  const SolidPair& pair_;
  Eigen::Quaterniond turned_;
  FclWitness witness_;
  Vector3 tip_m_;
  Task task_;
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  Vector3 within(double most) {
    const double x = between(-most, most);
    const double y = between(-most, most);
    return {x, y, between(-most, most)};
  }

 private:
  Random random_;
};

/// Free of the environment by both opinions; empty where a hundred draws found none.
std::optional<Pose> drawn_start(const Scenery& scenery, sim::OdeRollout& rollout, Draw& draw) {
  const SolidPair& pair = scenery.pair();
  const bool above = draw.between(0.0, 1.0) < 0.5;
  for (int i = 0; i < 100; ++i) {
    const double room_m = above ? 5e-3 : 0.25 * pair.play_m;
    const double lift_m =
        above ? pair.depth_m + draw.between(0.5e-3, 5e-3) : draw.between(0.1e-3, pair.depth_m);
    const Vector3 aside_m = draw.within(room_m);
    const Pose tool = scenery.tool_at(lift_m, aside_m - pair.way_out * pair.way_out.dot(aside_m),
                                      draw.within(above ? 0.05 : 0.0));
    if (!rollout.in_collision(tool) && !scenery.opinion(tool).surfaces_meet) return tool;
  }
  return std::nullopt;
}

MoveParameters drawn_move(const Scenery& scenery, std::uint8_t compliant_axes, Draw& draw) {
  constexpr double kFarthest_m = 0.01;
  MoveParameters move;
  move.compliance.compliant_axes = compliant_axes;
  move.speeds.approach_mps = move.speeds.contact_mps = draw.between(5e-3, 50e-3);
  const Vector3 inwards = -scenery.pair().way_out * draw.between(0.0, kFarthest_m);
  move.displacement.head<3>() = scenery.turned() * (draw.within(0.5 * kFarthest_m) + inwards);
  if ((compliant_axes & 0b111000) != 0) move.displacement.tail<3>() = draw.within(0.05);
  return move;
}

/// Adds what the witness says along a trace.
void look(const Scenery& scenery, const std::vector<TraceSample>& trace, SolidMovesSeen& seen) {
  for (std::size_t k = 0; k < trace.size(); k += kInstants_ms) {
    // The last instant too.
    const std::size_t at = k + kInstants_ms < trace.size() ? k : trace.size() - 1;
    const FclWitness::Opinion opinion = scenery.opinion(trace[at].input.pose);
    ++seen.instants;
    seen.meeting += opinion.surfaces_meet ? 1 : 0;
    seen.depth_max_m = std::max(seen.depth_max_m, opinion.depth_m);
  }
}

std::uint64_t print_of(const GuardedMove::Result& move, std::uint64_t before) {
  std::array<double, 9> numbers{};
  for (int i = 0; i < 3; ++i) numbers[static_cast<std::size_t>(i)] = move.pose.position_m[i];
  for (int i = 0; i < 4; ++i) {
    numbers[static_cast<std::size_t>(3 + i)] = move.pose.orientation.coeffs()[i];
  }
  numbers[7] = static_cast<double>(move.outcome);
  numbers[8] = std::bit_cast<double>(before);
  const auto bytes = std::bit_cast<std::array<char, sizeof numbers>>(numbers);
  return fnv1a_64({bytes.data(), bytes.size()});
}

SolidMovesSeen run_chain(const Scenery& scenery, sim::OdeRollout& rollout,
                         std::uint8_t compliant_axes, Draw draw) {
  SolidMovesSeen seen;
  const std::optional<Pose> start = drawn_start(scenery, rollout, draw);
  if (!start) return seen;
  Particle particle;
  particle.pose = *start;
  particle.physics.contact_stiffness_Npm = 1e6;
  particle.physics.friction = draw.between(0.1, 0.6);
  for (std::size_t i = 0; i < kMovesOfAChain; ++i) {
    std::vector<TraceSample> trace;
    const RolloutResult result =
        rollout.simulate(particle, drawn_move(scenery, compliant_axes, draw), kStep_us, &trace);
    ++seen.moves;
    look(scenery, trace, seen);
    if (!result.valid) {
      if (seen.invalid++ == 0) seen.first_invalid = result.failure;
      break;
    }
    seen.contacts += result.move.outcome == Outcome::kContact ? 1 : 0;
    seen.fingerprint = print_of(result.move, seen.fingerprint);
    particle.pose = result.move.pose;
    particle.signature = result.move.signature;
  }
  return seen;
}

}  // namespace

SolidMovesSeen run_solid_moves(const SolidPair& pair, const SolidMovesOptions& options) {
  const Scenery scenery(pair, options.turned);
  const std::size_t chains = (options.moves + kMovesOfAChain - 1) / kMovesOfAChain;
  std::vector<SolidMovesSeen> all(chains);
  fan_out(chains, options.threads, [&](std::size_t i, std::size_t) {
    sim::OdeRollout rollout(scenery.task());
    all[i] =
        run_chain(scenery, rollout, options.compliant_axes, Draw(stream_seed(options.seed, i)));
  });
  SolidMovesSeen seen;
  for (const SolidMovesSeen& one : all) {
    seen.moves += one.moves;
    seen.contacts += one.contacts;
    seen.meeting += one.meeting;
    seen.instants += one.instants;
    if (seen.invalid == 0) seen.first_invalid = one.first_invalid;
    seen.invalid += one.invalid;
    seen.depth_max_m = std::max(seen.depth_max_m, one.depth_max_m);
    seen.fingerprint = stream_seed(seen.fingerprint, one.fingerprint);
  }
  return seen;
}

}  // namespace tenon::tests
