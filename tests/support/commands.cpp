#include "tests/support/commands.h"

#include <chrono>
#include <filesystem>

#include "tests/support/child_process.h"
#include "tests/support/places.h"

namespace tenon::tests {

Ended run(const ScratchFolder& folder, const std::vector<std::string>& command,
          std::chrono::seconds most) {
  ChildProcess child(folder.path(), command);
  const int status = child.wait(most);
  return {status, child.out(), child.err()};
}

std::string put_box_plan(const ScratchFolder& folder, const std::string& start) {
  const std::filesystem::path file = folder.path() / ("start_" + start + ".tnp");
  std::filesystem::copy_file(shared_plan("box_" + start + "_gantry3"), file);
  return file;
}

}  // namespace tenon::tests
