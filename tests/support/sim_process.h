#pragma once
// tenon-sim in a process of its own, on a free port.

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace tenon::tests {

class SimProcess {
 public:
  /// Serves the box task's start on the gantry's cell, and returns once it listens.
  /// @param more further options  @param cell a cell file, empty for the gantry's
  /// @param task a task file, empty for the box's
  /// @throws std::runtime_error with its error where it does not start
  SimProcess(const std::filesystem::path& folder, const std::string& start,
             const std::vector<std::string>& more, const std::string& cell = {},
             const std::string& task = {});

  [[nodiscard]] ChildProcess& process() { return process_; }
  [[nodiscard]] int port() const { return port_; }
  /// For tenon-exec's --can.
  [[nodiscard]] std::string uri() const;

 private:
  ChildProcess process_;
  int port_ = 0;
};

}  // namespace tenon::tests
