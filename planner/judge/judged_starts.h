#pragma once
// The starts that a plan is judged from: drawn, and set where draws are rare. Offline; one thread.

#include <cstdint>
#include <vector>

#include "shared/plan/plan.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct JudgedStart {
  Particle particle;
  double sigmas_out = 0.0;  ///< see shared/task/spread.h
};

/// What of friction, size, latency and tilt the draws have.
enum class DrawnPhysics : std::uint8_t {
  kEven,     ///< drawn evenly from their ranges
  kCorners,  ///< every second draw at one of the corners of these ranges, in turn
};

/// Normal starts out to c_p + 1 standard deviations, or uniform ones; farther ones, and those in
/// collision, are drawn again. @param rollout asked for collisions
[[nodiscard]] std::vector<JudgedStart> drawn_starts(std::uint64_t seed, std::size_t count,
                                                    DrawnPhysics physics, const Plan& plan,
                                                    const Task& task, const Start& start,
                                                    Rollout& rollout);

/// The rotations that are no coordinate, where the task has a tilt.
[[nodiscard]] std::vector<int> tilted_axes(const Task& task);

/// What a plan is tried with in turn until one is found: all of the task's tilt, half of it, none.
[[nodiscard]] std::vector<double> tilts_to_hold(const Task& task);

/// Whether the environment is turned about an axis that is no coordinate.
[[nodiscard]] bool is_tilted(const Particle& start, const Task& task);

/// The start in an environment that is turned about coordinates alone.
[[nodiscard]] Particle without_tilt(const Particle& start, const Task& task);

/// On the rim of the particles' reach, c_p standard deviations out or at the bounds, along every
/// uncertain coordinate both ways and to every corner between them; each at all corners of
/// friction, size and latency, and tilted in turn about each axis that is no coordinate, either
/// way, and not at all; a tilt by which one would collide it does without.
[[nodiscard]] std::vector<JudgedStart> corner_starts(const Plan& plan, const Task& task,
                                                     const Start& start, Rollout& rollout);

/// A look at all of these starts: each at one of the corners of friction, size and latency, in
/// turn, tilted as it is there.
[[nodiscard]] std::vector<JudgedStart> screening_starts(const Plan& plan, const Task& task,
                                                        const Start& start, Rollout& rollout);

/// All of the rim's, each twice at least, with each tilt of corner_starts() as often, at the
/// corners of friction, size and latency in turn, and of each tilt half with the largest part.
[[nodiscard]] std::vector<JudgedStart> passage_starts(const Plan& plan, const Task& task,
                                                      const Start& start, Rollout& rollout);

/// As corner_starts() where drawing ends, one standard deviation farther, with the largest part;
/// none where errors are uniform.
[[nodiscard]] std::vector<JudgedStart> rim_starts(const Plan& plan, const Task& task,
                                                  const Start& start, Rollout& rollout);

}  // namespace tenon::planner
