#include "planner/main_plan_new_task.h"

#include <cstdio>
#include <filesystem>
#include <numbers>

#include "planner/new_task/part_fit.h"
#include "planner/new_task/task_text.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/load.h"
#include "shared/config/part_file.h"

namespace tenon {
namespace {

constexpr std::size_t kPosition = 3;
constexpr std::size_t kFullPose = 6;

planner::NewPart part_of(const std::string& file, const std::filesystem::path& folder) {
  const config::PartFile part = config::load_part(file);
  const auto named = std::filesystem::proximate(file, folder.empty() ? "." : folder);
  return {named.string(), part.scale_m, part.longest_raw, part.solid};
}

Pose goal_of(const std::vector<double>& goal) {
  Pose pose;
  if (goal.empty()) return pose;
  if (goal.size() != kPosition && goal.size() != kFullPose) {
    throw InputError(
        format("--goal has %zu numbers, must have x y z in m, or these and rx ry rz "
               "in rad",
               goal.size()));
  }
  pose.position_m = {goal[0], goal[1], goal[2]};
  if (goal.size() == kFullPose) pose.orientation = rotation_of({goal[3], goal[4], goal[5]});
  return pose;
}

/// The output's, without what ends it; other characters than a task's name may have become '_'.
std::string name_of(const std::string& output) {
  std::string name = std::filesystem::path(output).stem().string();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '_' && c != '-') c = '_';
  }
  return name;
}

}  // namespace

int write_new_task(const NewTaskArguments& a) {
  check_apart({{"--output", a.output}},
              {{"the plug", a.parts.front()}, {"the socket", a.parts.back()}});
  check_writable(a.output);
  const std::filesystem::path folder = std::filesystem::path(a.output).parent_path();
  planner::NewTask task;
  task.name = name_of(a.output);
  task.plug = part_of(a.parts.front(), folder);
  task.socket = part_of(a.parts.back(), folder);
  task.X_SP = goal_of(a.goal);
  task.uniform_m = 1e-3 * a.uniform_mm;
  task.uniform_rad = a.uniform_deg * std::numbers::pi / 180.0;
  task.fit = planner::fit_of(task.plug.solid, task.socket.solid, task.X_SP);
  std::fputs(planner::findings(task).c_str(), stdout);
  if (task.fit.overlap_m > planner::kTouching_m) {
    throw InputError(format(
        "assembled the two parts overlap by %.3f mm or more, of which %.3f mm may be rounding: are "
        "both files in one frame? If not, give the plug's place in the socket's frame "
        "(--goal X Y Z RX RY RZ); else make the plug smaller",
        1e3 * task.fit.overlap_m, 1e3 * planner::kTouching_m));
  }
  if (!task.fit.way_out) {
    std::fprintf(stderr,
                 "tenon-plan: no straight way leads the plug out of the socket: along none of the "
                 "file's axes and of the plug's large faces\n");
    return 1;
  }
  const std::string text = planner::task_text(task);
  write_file(a.output, text);
  std::printf("task: %s\n", a.output.c_str());
  return 0;
}

}  // namespace tenon
