#include "planner/report/run_path.h"

#include <cmath>

#include "planner/report/moments.h"

namespace tenon::planner {

Pose pose_of(const std::array<float, 7>& tool) {
  return {Vector3(tool[0], tool[1], tool[2]),
          Eigen::Quaterniond(tool[3], tool[4], tool[5], tool[6]).normalized()};
}

std::optional<Pose> fit_of(const Plan& plan, const RecordedRun& run) {
  if (!run.done || run.steps.empty() || run.steps.back().successor != kSuccessorDone) {
    return std::nullopt;
  }
  const Pose& end = run.steps.back().tool;
  Pose fit;
  if ((plan.coordinates >> 3U) != 0) {
    fit.orientation = plan.goal.orientation * end.orientation.conjugate();
  }
  const Vector3 moved = plan.goal.position_m - fit.orientation * end.position_m;
  for (int axis = 0; axis < 3; ++axis) {
    const bool turned = (plan.coordinates >> 3U) != 0;
    if (turned || has(plan.coordinates, axis)) fit.position_m[axis] = moved[axis];
  }
  return fit;
}

std::vector<Pose> tools_of(const Plan& plan, const RecordedRun& run, std::size_t most) {
  std::vector<Pose> tools;
  const Moments moments(run.samples.size(), most);
  for (const std::size_t i : moments.samples()) {
    if (!std::isnan(run.samples[i].tool[0])) tools.push_back(pose_of(run.samples[i].tool));
  }
  if (!tools.empty()) return tools;
  tools.push_back(plan.start);
  for (const RecordedStep& step : run.steps) tools.push_back(step.tool);
  return tools;
}

}  // namespace tenon::planner
