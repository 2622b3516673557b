#pragma once
// Where things are on this machine. Nothing else under tests/ knows a path that is not the
// repository's own, so that what a test unit is compiled to does not depend on where it stands.

#include <string>
#include <vector>

namespace tenon::tests {

/// A file or folder of the repository, such as "hw/cells/gantry3.yaml".
[[nodiscard]] std::string in_tree(const std::string& path);
/// One of the executables, such as "tenon-plan".
[[nodiscard]] std::string executable(const std::string& name);
/// Every task file that ships, sorted.
[[nodiscard]] std::vector<std::string> task_files();
/// The file of a plan that the build makes, see tests/plans/.
/// @throws std::runtime_error where it is not there
[[nodiscard]] std::string shared_plan(const std::string& name);

// What most tests use of the repository.
[[nodiscard]] std::string gantry_cell_file();
[[nodiscard]] std::string box_task_file();

}  // namespace tenon::tests
