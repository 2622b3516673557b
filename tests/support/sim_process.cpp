#include "tests/support/sim_process.h"

#include <stdexcept>

#include "tests/support/places.h"

namespace tenon::tests {
namespace {

std::vector<std::string> command(const std::string& ready_file, const std::string& start,
                                 const std::vector<std::string>& more, const std::string& cell,
                                 const std::string& task) {
  std::vector<std::string> all = {executable("tenon-sim"),
                                  "--cell",
                                  cell.empty() ? gantry_cell_file() : cell,
                                  "--task",
                                  task.empty() ? box_task_file() : task,
                                  "--start",
                                  start,
                                  "--can",
                                  "slcan-listen://127.0.0.1:0",
                                  "--ready-file",
                                  ready_file};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

SimProcess::SimProcess(const std::filesystem::path& folder, const std::string& start,
                       const std::vector<std::string>& more, const std::string& cell,
                       const std::string& task)
    : process_(folder, command(folder / "ready", start, more, cell, task)) {
  if (!process_.wait_until([&] { return std::filesystem::exists(folder / "ready"); })) {
    throw std::runtime_error("tenon-sim did not start: " + process_.err());
  }
  // "listening on 127.0.0.1:PORT", the last line so far.
  const std::string said = process_.out();
  port_ = std::stoi(said.substr(said.rfind(':') + 1));
}

std::string SimProcess::uri() const { return "slcan://127.0.0.1:" + std::to_string(port_); }

}  // namespace tenon::tests
