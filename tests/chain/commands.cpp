#include "tests/chain/commands.h"

#include <chrono>
#include <stdexcept>

#include "tests/support/child_process.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {

Ended run(const ScratchFolder& folder, const std::vector<std::string>& command) {
  ChildProcess child(folder.path(), command);
  const int status = child.wait(std::chrono::seconds(120));
  return {status, child.out(), child.err()};
}

std::string plan_by_command(const ScratchFolder& folder, const std::string& start) {
  const std::string file = folder.path() / ("start_" + start + ".tnp");
  const Ended ended = run(folder, {TENON_PLAN_EXE, box_task_file(), "--start", start, "--cell",
                                   gantry_cell_file(), "--threads", "2", "-o", file});
  if (ended.status != 0) throw std::runtime_error("no plan: " + ended.err);
  return file;
}

}  // namespace tenon::tests
