#include "planner/judge/judged_starts.h"

#include <algorithm>
#include <array>

#include "planner/belief/belief.h"
#include "shared/base/random.h"
#include "shared/task/pose_error.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

// A start whose every draw collides is no start; the planner has refused it before.
constexpr int kAttempts = 1000;

using Corners = std::vector<PhysicalParameters>;

double with_give(double stiffness_Npm, double give_mpN) {
  return stiffness_Npm / (1.0 + give_mpN * stiffness_Npm);
}

/// Lowest and highest friction, no latency and the longest, with the part as large as it may be,
/// then as drawn where that is something else; the contact softest or stiffest, by turns, such that
/// neither goes with one of the rest. @param odd the other way round
Corners corners(const Plan& plan, const Task& task, bool odd) {
  std::vector<double> latencies_s = {0.0};
  if (plan.latency_max_s > 0.0) latencies_s.push_back(plan.latency_max_s);
  Corners all;
  for (const bool slippery : {true, false}) {
    for (const double latency_s : latencies_s) {
      const bool soft = (slippery != (latency_s > 0.0)) != odd;
      const auto stiffness_Npm = [&](bool low) {
        return with_give(plan.contact_stiffness_Npm, low ? task.contact_give_mpN : 0.0);
      };
      const double friction = slippery ? task.friction.low : task.friction.high;
      all.push_back({friction, stiffness_Npm(soft), task.oversize_m, latency_s});
      if (task.oversize_m == 0.0) continue;
      all.push_back({friction, stiffness_Npm(!soft), 0.0, latency_s});
    }
  }
  return all;
}

/// By turns, so that starts that have them in turn have all of them softest and stiffest.
std::array<Corners, 2> corners(const Plan& plan, const Task& task) {
  return {corners(plan, task, false), corners(plan, task, true)};
}

/// Those of the corners with the largest part.
Corners largest(Corners all, const Task& task) {
  std::erase_if(all, [&](const auto& one) { return one.oversize_m != task.oversize_m; });
  return all;
}

/// Where moves turn with the tool, a particle's pose is what the arm knows of it, and has no room
/// for a turn that it does not know of.
bool part_may_be_tilted(const Task& task) { return !task.motion.carried_axes; }

/// None, and as far as it may be about each axis, either way, of the environment, of the part in
/// the hand, and of both, together and apart: an odd number, so that taking turns ties none of them
/// to a corner.
std::vector<Tilt> extreme_tilts(const Task& task) {
  std::vector<Tilt> tilts = {{}};
  const bool held = part_may_be_tilted(task);
  for (const int axis : tilted_axes(task)) {
    for (const double turn_rad : {task.tilt_rad, -task.tilt_rad}) {
      const Vector3 turn = turn_rad * Vector3::Unit(axis - 3);
      const Vector3 each = std::sqrt(0.5) * turn;
      tilts.push_back({turn, Vector3::Zero()});
      if (!held) continue;
      tilts.push_back({Vector3::Zero(), turn});
      tilts.push_back({each, each});
      tilts.push_back({each, -each});
    }
  }
  return tilts;
}

/// Evenly from the ball of all tilts, of both together.
Tilt draw_tilt(Random& random, const Task& task) {
  const std::vector<int> axes = tilted_axes(task);
  const bool held = part_may_be_tilted(task);
  Tilt tilt;
  const auto drawn = [&] { return random.uniform(-task.tilt_rad, task.tilt_rad); };
  do {
    for (const int axis : axes) {
      tilt.environment_rad[axis - 3] = drawn();
      if (held) tilt.held_rad[axis - 3] = drawn();
    }
  } while (tilt.norm_rad() > task.tilt_rad);
  return tilt;
}

/// The particle in an environment that is turned, besides, about the goal, with its part turned
/// about the tool.
Particle tilted(const Particle& particle, const Tilt& tilt, const Task& task) {
  Particle other = particle;
  if (!tilt.environment_rad.isZero()) {
    const Vector3 goal_m = compose(particle.environment, task.goal).position_m;
    Vector6 turn = Vector6::Zero();
    turn.tail<3>() = tilt.environment_rad;
    other.environment = compose(environment_pose(turn, goal_m), particle.environment);
  }
  if (!tilt.held_rad.isZero()) {
    other.pose.orientation = (rotation_of(tilt.held_rad) * particle.pose.orientation).normalized();
  }
  return other;
}

JudgedStart draw_place(Random& random, const Tilt& tilt, const Task& task, const Start& start,
                       Rollout& rollout) {
  const bool uniform = task.errors == Distribution::kUniform;
  JudgedStart drawn;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Vector6 offset = Vector6::Zero();
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(task.coordinates, axis) || start.sigma[axis] == 0.0) continue;
      const double z =
          uniform ? task.particle_sigmas * (2.0 * random.uniform() - 1.0) : random.normal();
      offset[axis] = z * start.sigma[axis];
    }
    drawn.particle = tilted(particle_off(offset, task, start, {}), tilt, task);
    drawn.sigmas_out = sigmas_out(task, start, offset);
    if (drawn.sigmas_out > drawn_sigmas(task)) continue;
    if (!rollout.in_collision(drawn.particle.tool())) break;
  }
  return drawn;
}

/// Along every uncertain coordinate both ways, and to every corner between them: unit vectors, and
/// the corners of a box where errors are uniform.
std::vector<Vector6> rim_directions(const Task& task, const Start& start) {
  std::vector<int> axes;
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis) && start.sigma[axis] > 0.0) axes.push_back(axis);
  }
  std::vector<Vector6> directions;
  for (const int axis : axes) {
    directions.push_back(Vector6::Unit(axis));
    directions.push_back(-Vector6::Unit(axis));
  }
  if (axes.size() < 2) return directions;
  for (unsigned corner = 0; corner < 1U << axes.size(); ++corner) {
    Vector6 direction = Vector6::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      direction[axes[i]] = (corner >> i & 1U) != 0 ? 1.0 : -1.0;
    }
    directions.push_back(task.errors == Distribution::kUniform ? direction
                                                               : direction.normalized());
  }
  return directions;
}

/// Those of a rim that do not collide, each with all of the parameters of its turn.
std::vector<JudgedStart> starts_at(double sigmas, const std::array<Corners, 2>& physics,
                                   const Task& task, const Start& start, Rollout& rollout) {
  const std::vector<Tilt> tilts = extreme_tilts(task);
  // As many as share no factor with the corners: taking turns ties none of them to one.
  const std::vector<Vector3> errors = sensor_errors(task);
  std::vector<JudgedStart> starts;
  bool odd = true;
  for (const Vector6& direction : rim_directions(task, start)) {
    odd = !odd;
    const Particle level =
        particle_off(sigmas * direction.cwiseProduct(start.sigma), task, start, {});
    if (rollout.in_collision(level.tool())) continue;
    for (const PhysicalParameters& one : physics[odd ? 1 : 0]) {
      Particle particle = tilted(level, tilts[starts.size() % tilts.size()], task);
      if (rollout.in_collision(particle.tool())) particle = level;
      particle.physics = one;
      particle.physics.sensor_error_m = errors[starts.size() % errors.size()];
      starts.push_back({particle, sigmas});
    }
  }
  return starts;
}

}  // namespace

std::vector<JudgedStart> drawn_starts(std::uint64_t seed, std::size_t count, DrawnPhysics physics,
                                      const Plan& plan, const Task& task, const Start& start,
                                      Rollout& rollout) {
  const std::array<Corners, 2> extremes = corners(plan, task);
  Random random(seed);
  Random late(stream_seed(seed, "latency"));
  Random turned(stream_seed(seed, "tilt"));
  Random off(stream_seed(seed, "sensor"));
  Random give(stream_seed(seed, "contact give"));
  const bool felt = sensor_errors(task).size() > 1;
  std::vector<JudgedStart> starts;
  for (std::size_t i = 0; i < count; ++i) {
    const bool at_corner = physics == DrawnPhysics::kCorners && i % 2 == 1;
    const Tilt tilt = draw_tilt(turned, task);
    JudgedStart drawn = draw_place(random, tilt, task, start, rollout);
    PhysicalParameters& p = drawn.particle.physics;
    p.contact_stiffness_Npm =
        with_give(plan.contact_stiffness_Npm, give.uniform() * task.contact_give_mpN);
    p.friction = random.uniform(task.friction.low, task.friction.high);
    if (task.oversize_m > 0.0) p.oversize_m = random.uniform() * task.oversize_m;
    p.latency_s = late.uniform() * plan.latency_max_s;
    const std::size_t corner = i / 2 % extremes[0].size();
    if (at_corner) p = extremes[i / 2 / extremes[0].size() % 2][corner];
    if (felt) {
      for (double& error_m : p.sensor_error_m) {
        error_m = off.uniform(-task.sensor_error_m, task.sensor_error_m);
      }
    }
    starts.push_back(drawn);
  }
  return starts;
}

std::vector<int> tilted_axes(const Task& task) {
  std::vector<int> axes;
  for (int axis = 3; axis < 6; ++axis) {
    if (!has(task.coordinates, axis) && task.tilt_rad > 0.0) axes.push_back(axis);
  }
  return axes;
}

std::vector<CalibrationErrors> errors_to_hold(const Task& task) {
  const bool tilted = !tilted_axes(task).empty();
  const bool felt = sensor_errors(task).size() > 1;
  const auto share = [&](double of) {
    return CalibrationErrors{tilted ? of * task.tilt_rad : 0.0,
                             felt ? of * task.sensor_error_m : 0.0};
  };
  if (tilted) return {share(1.0), share(0.5), share(0.0)};
  if (felt) return {share(1.0), share(0.0)};
  return {share(0.0)};
}

Task holding(const Task& task, const CalibrationErrors& errors) {
  Task held = task;
  held.tilt_rad = errors.tilt_rad;
  held.sensor_error_m = errors.sensor_error_m;
  return held;
}

Tilt tilt_of(const Particle& particle, const Task& task, const Start& start) {
  Tilt tilt{rotation_vector(particle.environment.orientation),
            displacement_between(start.pose, particle.pose).tail<3>()};
  for (int axis = 3; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) continue;
    tilt.environment_rad[axis - 3] = tilt.held_rad[axis - 3] = 0.0;
  }
  return tilt;
}

Particle without_tilt(const Particle& particle, const Task& task, const Start& start) {
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = rotation_vector(particle.environment.orientation) -
                   tilt_of(particle, task, start).environment_rad;
  Particle level = particle;
  level.environment = environment_pose(turn, task.error_about_m);
  level.pose.orientation = start.pose.orientation;
  return level;
}

std::vector<JudgedStart> corner_starts(const Plan& plan, const Task& task, const Start& start,
                                       Rollout& rollout) {
  return starts_at(task.particle_sigmas, corners(plan, task), task, start, rollout);
}

std::vector<JudgedStart> screening_starts(const Plan& plan, const Task& task, const Start& start,
                                          Rollout& rollout) {
  const std::array<Corners, 2> physics = corners(plan, task);
  const std::size_t each = physics[0].size();
  const std::vector<JudgedStart> all =
      starts_at(task.particle_sigmas, physics, task, start, rollout);
  std::vector<JudgedStart> some;
  for (std::size_t i = 0; i < all.size() / each; ++i) {
    // No side of a coordinate goes with a parameter.
    const std::size_t turn = (i + i / each + i / (each * each)) % each;
    some.push_back(all[i * each + turn]);
  }
  return some;
}

std::vector<JudgedStart> passage_starts(const Plan& plan, const Task& task, const Start& start,
                                        Rollout& rollout) {
  const std::array<Corners, 2> turns = corners(plan, task);
  Corners physics = turns[0];
  physics.insert(physics.end(), turns[1].begin(), turns[1].end());
  const std::vector<Tilt> tilts = extreme_tilts(task);
  const std::vector<Vector3> errors = sensor_errors(task);
  Task level = task;
  level.tilt_rad = 0.0;
  const std::vector<JudgedStart> rim =
      starts_at(task.particle_sigmas, {Corners(1), Corners(1)}, level, start, rollout);
  if (rim.empty()) return {};
  // Of each tilt an even number, half of them with either size.
  const std::size_t each = 2 * ((rim.size() - 1) / tilts.size() + 1);
  std::vector<JudgedStart> starts;
  for (std::size_t i = 0; i < each * tilts.size(); ++i) {
    const JudgedStart& from = rim[(i + i / rim.size()) % rim.size()];
    Particle particle = tilted(from.particle, tilts[i / each], task);
    if (rollout.in_collision(particle.tool())) particle = from.particle;
    // Odd ones as drawn, where that is another size; no kind of tilt goes with the rest.
    particle.physics = physics[(2 * (i / 2 + i / (4 * each)) + i % 2) % physics.size()];
    particle.physics.sensor_error_m = errors[i % errors.size()];
    starts.push_back({particle, from.sigmas_out});
  }
  return starts;
}

std::vector<JudgedStart> rim_starts(const Plan& plan, const Task& task, const Start& start,
                                    Rollout& rollout) {
  if (drawn_sigmas(task) <= task.particle_sigmas) return {};
  const auto [even, odd] = corners(plan, task);
  return starts_at(drawn_sigmas(task), {largest(even, task), largest(odd, task)}, task, start,
                   rollout);
}

}  // namespace tenon::planner
