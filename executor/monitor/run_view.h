#pragma once
// A run as tenon-monitor prints it where there is no terminal: messages in, lines out. Whatever
// arrives, it shows what it can and counts the rest. Not for real time; one thread.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tenon {
class cycle_state_t;
class step_event_t;
class run_summary_t;
}  // namespace tenon

namespace tenon::executor {

class RunView {
 public:
  /// What is to be written for a message of a channel (telemetry.h), or nothing.
  [[nodiscard]] std::string take(std::string_view channel, std::span<const std::uint8_t> bytes);
  /// A cycle has come, and no end of the run.
  [[nodiscard]] bool running() const { return running_; }
  /// What no decoder could make sense of.
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }

 private:
  [[nodiscard]] std::string show(const tenon::cycle_state_t& m);
  [[nodiscard]] static std::string show(const tenon::step_event_t& m);
  [[nodiscard]] std::string show(const tenon::run_summary_t& m);
  template <typename Message>
  [[nodiscard]] std::string shown(std::span<const std::uint8_t> bytes);

  int state_ = -1;
  bool running_ = false;
  std::uint64_t malformed_ = 0;
};

}  // namespace tenon::executor
