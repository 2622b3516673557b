#pragma once
// The starts that a plan is judged from: drawn, and set where draws are rare. Offline; one thread.

#include <cmath>
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

/// What of friction, size, latency and contact stiffness the draws have. All are tilted by as much
/// as may be or less, about any axes.
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

/// What calibration may have left of errors that no coordinate is, as a task says it.
struct CalibrationErrors {
  double tilt_rad = 0.0;
  double sensor_error_m = 0.0;

  friend bool operator==(const CalibrationErrors&, const CalibrationErrors&) = default;
};

/// What a plan is tried with in turn until one is found: all that the task says, half of it where
/// it has a tilt, nothing.
[[nodiscard]] std::vector<CalibrationErrors> errors_to_hold(const Task& task);

/// The task with these.
[[nodiscard]] Task holding(const Task& task, const CalibrationErrors& errors);

/// What calibration has turned: rotation vectors in task axes, about axes that are no coordinates.
struct Tilt {
  Vector3 environment_rad = Vector3::Zero();
  Vector3 held_rad = Vector3::Zero();  ///< of the part in the hand, about the tool

  [[nodiscard]] double norm_rad() const {
    return std::hypot(environment_rad.norm(), held_rad.norm());
  }
};

/// @param start that the particle is one of
[[nodiscard]] Tilt tilt_of(const Particle& particle, const Task& task, const Start& start);

/// The particle with its environment turned about coordinates alone, and its part as it is held.
/// A force sensor that is off stays so.
[[nodiscard]] Particle without_tilt(const Particle& particle, const Task& task, const Start& start);

/// On the rim of the particles' reach, c_p standard deviations out or at the bounds, along every
/// uncertain coordinate both ways and to every corner between them; each at all corners of
/// friction, size and latency, on the softest or the stiffest contact by turns, and tilted in turn
/// about each axis that is no coordinate, either way, and not at all, as far as there are starts
/// for all of that; a tilt by which one would collide it does without. What is tilted is the
/// environment and, where moves do not turn with the tool, the part in the hand, or both, the same
/// way or against each other.
[[nodiscard]] std::vector<JudgedStart> corner_starts(const Plan& plan, const Task& task,
                                                     const Start& start, Rollout& rollout);

/// A look at all of these starts: each at one of the corners of friction, size and latency, in
/// turn, on the contact and tilted as it is there.
[[nodiscard]] std::vector<JudgedStart> screening_starts(const Plan& plan, const Task& task,
                                                        const Start& start, Rollout& rollout);

/// All of the rim's, each twice at least, with each tilt of corner_starts() as often, at the
/// corners of friction, size, latency and contact stiffness in turn, and of each tilt half with the
/// largest part.
[[nodiscard]] std::vector<JudgedStart> passage_starts(const Plan& plan, const Task& task,
                                                      const Start& start, Rollout& rollout);

/// As corner_starts() where drawing ends, one standard deviation farther, with the largest part;
/// none where errors are uniform.
[[nodiscard]] std::vector<JudgedStart> rim_starts(const Plan& plan, const Task& task,
                                                  const Start& start, Rollout& rollout);

}  // namespace tenon::planner
