// tenon-monitor: watches a run over LCM. Prints events as lines and, on a terminal, the state of
// the cycle about ten times a second. It can only listen.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "executor/states/state_machine.h"
#include "executor/telemetry/lcm_url.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/base/error.h"
#include "shared/config/command_line.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/outcome.h"

namespace tenon::executor {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

void ask_to_stop(int /*signal*/) { stop_asked = 1; }

// Rounded to a unit, and without the sign of a zero.
double rounded(double value, double unit) { return std::round(value / unit) * unit + 0.0; }

class Monitor {
 public:
  explicit Monitor(bool terminal) : terminal_(terminal) {}

  void cycle(const tenon::cycle_state_t& m) {
    const auto state = static_cast<std::uint8_t>(m.state);
    if (state != state_) {
      line();
      std::printf("%s\n", to_string(static_cast<State>(state)));
      std::fflush(stdout);
      state_ = state;
    }
    constexpr std::int64_t kRefresh_us = 100'000;
    if (!terminal_ || m.utime - shown_us_ < kRefresh_us) return;
    shown_us_ = m.utime;
    const auto place = [&](int axis) { return rounded(m.pose_position_m[axis], 1e-4); };
    const auto force = [&](int axis) { return rounded(m.wrench[axis], 0.1); };
    const ContactSignature signature{static_cast<std::uint16_t>(m.signature)};
    std::printf(
        "\r\033[Kstep %3d  x %+.4f %+.4f %+.4f m  f %+6.1f %+6.1f %+6.1f N  %-8s late %d "
        "(%.0f us)",
        m.step, place(0), place(1), place(2), force(0), force(1), force(2),
        tenon::to_string(signature).c_str(), m.late_cycles, 1e6 * m.wakeup_late_s);
    std::fflush(stdout);
    open_line_ = true;
  }

  void step(const tenon::step_event_t& m) {
    line();
    const auto way = [&](int axis) { return rounded(m.travelled[axis], 1e-4); };
    const ContactSignature signature{static_cast<std::uint16_t>(m.signature)};
    std::printf("step %d: %s (holds %s) after %.4f %.4f %.4f m, %.1f N, %.2f s%s\n", m.step,
                to_string(static_cast<Outcome>(m.outcome)), tenon::to_string(signature).c_str(),
                way(0), way(1), way(2), m.peak_force_N, m.duration_s,
                m.deviation == 0 ? "" : ", not as planned");
    std::fflush(stdout);
  }

  void summary(const tenon::run_summary_t& m) {
    line();
    std::printf("%s: %s (%d steps, %lld late cycles)\n", m.exit_code == 0 ? "done" : "failed",
                m.message.c_str(), m.steps, static_cast<long long>(m.late_cycles));
    std::fflush(stdout);
  }

 private:
  // Ends the line that is being refreshed.
  void line() {
    if (open_line_) std::printf("\r\033[K");
    open_line_ = false;
  }

  bool terminal_;
  bool open_line_ = false;
  int state_ = -1;
  std::int64_t shown_us_ = 0;
};

// What LCM calls. Plain functions: in its templates a call by a pointer to a member crashes where
// GCC 12 compiles with -fsanitize=vptr.
void take_cycle(const lcm::ReceiveBuffer* /*buffer*/, const std::string& /*channel*/,
                const tenon::cycle_state_t* message, Monitor* monitor) {
  monitor->cycle(*message);
}
void take_step(const lcm::ReceiveBuffer* /*buffer*/, const std::string& /*channel*/,
               const tenon::step_event_t* message, Monitor* monitor) {
  monitor->step(*message);
}
void take_summary(const lcm::ReceiveBuffer* /*buffer*/, const std::string& /*channel*/,
                  const tenon::run_summary_t* message, Monitor* monitor) {
  monitor->summary(*message);
}

int watch(const std::string& url) {
  check_lcm_url(url);
  if (!has_multicast_route(url)) {
    throw InputError("--lcm-url " + url + ": no multicast route; " + kSetMulticastRoute);
  }
  lcm::LCM lcm(url);
  if (!lcm.good()) throw InputError("--lcm-url " + url + ": cannot be opened");
  Monitor monitor(isatty(STDOUT_FILENO) == 1);
  lcm.subscribeFunction(kCycleChannel, &take_cycle, &monitor);
  lcm.subscribeFunction(kStepChannel, &take_step, &monitor);
  lcm.subscribeFunction(kRunChannel, &take_summary, &monitor);
  constexpr int kPoll_ms = 200;
  while (stop_asked == 0) {
    if (lcm.handleTimeout(kPoll_ms) < 0) break;  // the end of a log, or a signal
  }
  std::printf("\n");
  return 0;
}

}  // namespace
}  // namespace tenon::executor

int main(int argc, char** argv) {
  return tenon::run_main("tenon-monitor", [&] {
    using namespace tenon::executor;
    std::string url = kDefaultLcmUrl;
    CLI::App app{"Watches a run of tenon-exec over LCM."};
    app.footer("Examples:\n  tenon-monitor\n  tenon-monitor --lcm-url 'file://run.lcmlog?speed=1'");
    app.set_version_flag("--version", TENON_VERSION);
    app.add_option("--lcm-url", url, "where telemetry comes from")->capture_default_str();
    tenon::parse(app, argc, argv);
    std::signal(SIGINT, &ask_to_stop);
    std::signal(SIGTERM, &ask_to_stop);
    return watch(url);
  });
}
