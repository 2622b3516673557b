#include "executor/main_exec_steps.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <thread>

namespace tenon::executor {
namespace {

constexpr int kPoll_ms = 50;

}  // namespace

class StepByStep::Listener {
 public:
  Listener(Controller& controller, std::atomic<bool>& stop)
      : controller_(controller), stop_(stop), thread_([this] { listen(); }) {}
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() {
    over_.store(true);
    thread_.join();
  }

 private:
  void listen();

  Controller& controller_;
  std::atomic<bool>& stop_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

void StepByStep::Listener::listen() {
  while (!over_.load() && !stop_.load()) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kPoll_ms) <= 0) continue;
    std::array<char, 256> typed{};
    const ssize_t size = ::read(STDIN_FILENO, typed.data(), typed.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) {
      std::fputs("tenon-exec: standard input has ended, and --step has nobody to ask: stopping\n",
                 stderr);
      stop_.store(true);
      return;
    }
    if (std::find(typed.begin(), typed.begin() + size, '\n') != typed.begin() + size) {
      controller_.allow_step();
    }
  }
}

StepByStep::StepByStep(Controller& controller, std::atomic<bool>& stop)
    : listener_(std::make_unique<Listener>(controller, stop)) {}

StepByStep::~StepByStep() = default;

}  // namespace tenon::executor
