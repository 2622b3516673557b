#pragma once
// tenon-plan --new-task: two part files in, a task file out.

#include <optional>
#include <string>
#include <vector>

namespace tenon {

struct NewTaskArguments {
  std::vector<std::string> parts;  ///< plug, socket
  std::vector<double> goal;        ///< of the plug in the socket: x y z [rx ry rz], m and rad
  double uniform_mm = 2.0;
  double uniform_deg = 0.0;
  std::string output;
};

/// Writes the task and says what was measured. @return 0, or 1 where no straight way leads out
/// @throws InputError
[[nodiscard]] int write_new_task(const NewTaskArguments& arguments);

}  // namespace tenon
