#pragma once
// A task file for two parts, and what was measured of them in words. Pure.

#include <string>

#include "planner/new_task/part_fit.h"
#include "shared/geometry/solid.h"

namespace tenon::planner {

/// One of the two, as its file has it.
struct NewPart {
  std::string file;  ///< as the task is to name it
  double scale_m = 1.0;
  double longest_raw = 0.0;
  std::shared_ptr<const Solid> solid;
};

struct NewTask {
  std::string name;
  NewPart plug;
  NewPart socket;
  Pose X_SP;  ///< of the plug's file in the socket's, assembled
  double uniform_m = 2e-3;
  double uniform_rad = 0.0;
  PartFit fit;
};

/// Lines of what was measured and taken for granted.
[[nodiscard]] std::string findings(const NewTask& task);

/// A complete task, explained where it stands. The fit has a way out.
[[nodiscard]] std::string task_text(const NewTask& task);

}  // namespace tenon::planner
