#pragma once
// Where the tool was in a run, as its page draws it. Pure; any thread.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon::planner {

/// As a log has it.
[[nodiscard]] Pose pose_of(const std::array<float, 7>& tool);

/// What brings a run that reached its goal onto the goal of the drawn task: the environment was not
/// where the task has it. Along the plan's coordinates alone. None where it was not done.
[[nodiscard]] std::optional<Pose> fit_of(const Plan& plan, const RecordedRun& run);

/// As measured; without samples, where the plan begins and where its steps came to rest. Never
/// empty. @param most that are left of the samples, at least 2
[[nodiscard]] std::vector<Pose> tools_of(const Plan& plan, const RecordedRun& run,
                                         std::size_t most);

}  // namespace tenon::planner
