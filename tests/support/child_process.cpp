#include "tests/support/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tenon::tests {
namespace {

constexpr std::chrono::milliseconds kPoll{5};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void redirect(const std::string& file, int descriptor) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
}

}  // namespace

ChildProcess::ChildProcess(const std::filesystem::path& folder, std::vector<std::string> command)
    : files_(folder / std::filesystem::path(command.at(0)).filename()) {
  const std::string out_file = files_.string() + ".out";
  const std::string err_file = files_.string() + ".err";
  std::vector<char*> pointers;
  for (std::string& argument : command) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    redirect(out_file, STDOUT_FILENO);
    redirect(err_file, STDERR_FILENO);
    ::execvp(pointers[0], pointers.data());
    ::_exit(127);
  }
}

ChildProcess::~ChildProcess() {
  if (ended()) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void ChildProcess::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

bool ChildProcess::ended() {
  if (pid_ < 0) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == 0) return false;
  pid_ = -1;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return true;
}

int ChildProcess::wait(std::chrono::seconds bound) {
  const auto end = std::chrono::steady_clock::now() + bound;
  while (!ended()) {
    if (std::chrono::steady_clock::now() > end) send(SIGKILL);
    std::this_thread::sleep_for(kPoll);
  }
  return status_;
}

bool ChildProcess::wait_until(const std::function<bool()>& condition, std::chrono::seconds bound) {
  const auto end = std::chrono::steady_clock::now() + bound;
  while (!condition()) {
    if (ended() || std::chrono::steady_clock::now() > end) return condition();
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

std::string ChildProcess::out() const { return text_of(files_.string() + ".out"); }

std::string ChildProcess::err() const { return text_of(files_.string() + ".err"); }

}  // namespace tenon::tests
