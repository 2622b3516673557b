#pragma once
// A program in a process of its own, with its output in files. Ends no later than the test does.
// Use it on the thread that made it.

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tenon::tests {

class ChildProcess {
 public:
  /// Starts command[0], sought in PATH where it has no slash. Its output goes to NAME.out and
  /// NAME.err in `folder`, NAME being the program's; the folder outlives this.
  ChildProcess(const std::filesystem::path& folder, std::vector<std::string> command);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  void send(int signal) const;
  /// -1 once it has ended.
  [[nodiscard]] int pid() const { return pid_; }

  /// Its exit status, or minus the signal that ended it. Past the bound it is killed.
  int wait(std::chrono::seconds bound = std::chrono::seconds(60));
  /// Until `condition` holds. False where the child ended or the bound passed before.
  [[nodiscard]] bool wait_until(const std::function<bool()>& condition,
                                std::chrono::seconds bound = std::chrono::seconds(30));

  [[nodiscard]] std::string out() const;
  [[nodiscard]] std::string err() const;

 private:
  bool ended();

  std::filesystem::path files_;  ///< without .out and .err
  int pid_ = -1;                 ///< -1 once it has ended
  int status_ = 0;
};

}  // namespace tenon::tests
