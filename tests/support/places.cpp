#include "tests/support/places.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace tenon::tests {

// The three places are definitions of this file alone, see tests/CMakeLists.txt.

std::string in_tree(const std::string& path) { return TENON_SOURCE_DIR "/" + path; }

std::string executable(const std::string& name) { return TENON_BIN_DIR "/" + name; }

std::vector<std::string> task_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(in_tree("planner/tasks"))) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string shared_plan(const std::string& name) {
  std::string file = TENON_PLANS_DIR "/" + name + ".tnp";
  if (!std::filesystem::exists(file)) throw std::runtime_error(file + " has not been made");
  return file;
}

std::string gantry_cell_file() { return in_tree("hw/cells/gantry3.yaml"); }

std::string box_task_file() { return in_tree("planner/tasks/box_on_table_2d.yaml"); }

}  // namespace tenon::tests
