#include "executor/main_exec_steps.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <thread>

namespace tenon::executor {
namespace {

constexpr int kPoll_ms = 50;
constexpr std::size_t kLineMost = 80;  // a longer one is no word

}  // namespace

class UserWords::Listener {
 public:
  Listener(Controller& controller, StopRequests& stop, bool step_by_step)
      : controller_(controller), stop_(stop), step_by_step_(step_by_step) {
    thread_ = std::thread([this] { listen(); });
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() {
    over_.store(true);
    thread_.join();
  }

 private:
  void listen();
  void take(std::string_view typed);
  void obey(const std::string& line);
  void end_of_input();

  Controller& controller_;
  StopRequests& stop_;
  bool step_by_step_;
  bool paused_ = false;
  std::string line_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

void UserWords::Listener::listen() {
  while (!over_.load()) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kPoll_ms) <= 0) continue;
    std::array<char, 256> typed{};
    const ssize_t size = ::read(STDIN_FILENO, typed.data(), typed.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) return end_of_input();
    take({typed.data(), static_cast<std::size_t>(size)});
  }
}

void UserWords::Listener::take(std::string_view typed) {
  for (const char letter : typed) {
    if (letter != '\n') {
      if (line_.size() < kLineMost) line_ += letter;
      continue;
    }
    obey(line_);
    line_.clear();
  }
}

void UserWords::Listener::obey(const std::string& line) {
  if (line == "p" || line == "r") {
    paused_ = line == "p";
    controller_.pause(paused_);
    std::fputs(paused_ ? "tenon-exec: pausing; r and Enter goes on\n" : "tenon-exec: going on\n",
               stderr);
  } else if (line.empty() && step_by_step_) {
    controller_.allow_step();
  } else {
    std::fputs(step_by_step_ ? "tenon-exec: p pauses, r goes on, Enter alone begins the step\n"
                             : "tenon-exec: p pauses, r goes on\n",
               stderr);
  }
}

void UserWords::Listener::end_of_input() {
  if (!step_by_step_ && !paused_) return;
  std::fprintf(stderr,
               "tenon-exec: standard input has ended, and %s has nobody to ask: ending the plan\n",
               step_by_step_ ? "--step" : "a paused move");
  stop_.by_circumstance.store(true, std::memory_order_relaxed);
}

UserWords::UserWords(Controller& controller, StopRequests& stop, bool step_by_step)
    : listener_(std::make_unique<Listener>(controller, stop, step_by_step)) {}

UserWords::~UserWords() = default;

}  // namespace tenon::executor
