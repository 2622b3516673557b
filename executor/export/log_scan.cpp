#include "executor/export/log_scan.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "executor/record/channels.h"
#include "executor/recorded/event_file.h"
#include "executor/recorded/named.h"
#include "lcmtypes/received/received.h"
#include "shared/base/error.h"

namespace tenon::executor {
namespace {

class Scanner {
 public:
  void take(const LoggedEvent& event) {
    if (event.channel == kSetupChannel) take_as<tenon::run_setup_t>(event);
    if (event.channel == kCycleChannel) take_as<tenon::cycle_state_t>(event);
    if (event.channel == kRunChannel) take_as<tenon::run_summary_t>(event);
    if (event.channel == kStepChannel) take_as<tenon::step_event_t>(event);
    if (event.channel == kStatusChannel) take_as<tenon::run_status_t>(event);
    ++events_;
    run_.end_event = events_;
  }

  LogScan finish() {
    keep();
    return std::move(scan_);
  }

 private:
  template <typename Message>
  void take_as(const LoggedEvent& event) {
    if (const std::optional<Message> message = decoded<Message>(event.message)) {
      look_at(*message);
    } else {
      ++scan_.malformed;
    }
  }
  void look_at(const tenon::run_setup_t& m) {
    if (m.sequence == 0) begin();
    scan_.open = m.sequence == 0 || !run_.ended;
    if (!run_.setup) run_.setup = m;
  }
  void look_at(const tenon::cycle_state_t& m) {
    if (m.sequence == 0) begin();
    scan_.open = m.sequence == 0 || !run_.ended;
    if (run_.cycles == 0) {
      run_.start_ns = m.monotonic_ns;
      run_.start_us = m.utime;
      run_.joint_count = m.joint_position.size();
    }
    ++run_.cycles;
    run_.last_ns = std::max(run_.last_ns, m.monotonic_ns);
  }
  void look_at(const tenon::run_summary_t& /*m*/) {
    run_.ended = true;
    scan_.open = false;
  }
  template <typename Message>
  void look_at(const Message& /*m*/) {}

  /// A run begins at 0; what was told before its first cycle is its own.
  void begin() {
    if (run_.cycles == 0) return;
    keep();
    run_ = {};
    run_.first_event = events_;
  }
  void keep() {
    if (run_.cycles > 0) scan_.runs.push_back(std::move(run_));
  }

  LogScan scan_;
  LoggedRun run_;
  std::size_t events_ = 0;
};

}  // namespace

std::vector<JointName> LoggedRun::joints() const {
  std::vector<JointName> names;
  if (setup) {
    for (const RecordedJoint& joint : joints_of(*setup)) {
      names.push_back({joint.name, joint.linear ? "_m" : "_rad"});
    }
  }
  for (std::size_t i = names.size(); !setup && i < joint_count; ++i) {
    names.push_back({std::to_string(i), ""});
  }
  return names;
}

std::int64_t LoggedRun::since_ns(std::int64_t monotonic_ns) const {
  if (monotonic_ns <= start_ns) return 0;
  // Of a log of anybody's, the difference may be more than there is room for.
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  const std::uint64_t since =
      static_cast<std::uint64_t>(monotonic_ns) - static_cast<std::uint64_t>(start_ns);
  return static_cast<std::int64_t>(std::min(since, kMost));
}

namespace {

/// Whatever it holds.
LogScan scan_events(const std::filesystem::path& file) {
  EventFile events(file);
  Scanner scanner;
  std::string damage;
  try {
    while (const std::optional<LoggedEvent> event = events.next()) scanner.take(*event);
  } catch (const InputError& error) {
    damage = error.what();
  }
  LogScan scan = scanner.finish();
  scan.damage = std::move(damage);
  scan.breaks_off = events.breaks_off();
  return scan;
}

}  // namespace

LogScan scan_log(const std::filesystem::path& file) {
  LogScan scan = scan_events(file);
  if (scan.runs.empty()) {
    throw InputError(file.string() +
                     ": holds no cycle of a run; give a log of tenon-exec or tenon-monitor");
  }
  return scan;
}

std::string log_lacks(const std::filesystem::path& file) {
  const LogScan scan = scan_events(file);
  if (!scan.damage.empty()) return scan.damage + "; not all that was logged is shown";
  if (scan.breaks_off) {
    return file.string() + ": breaks off within a message; what stands before is shown";
  }
  if (scan.open) return file.string() + ": ends before the run does; what it holds is shown";
  return "";
}

}  // namespace tenon::executor
