// tenon-monitor: watches a run over LCM, on a terminal as a dashboard, elsewhere as lines, and
// writes a log for other tools. It can only listen. Only composes; see executor/README.md.

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "executor/export/log_scan.h"
#include "executor/main_monitor_export.h"
#include "executor/main_monitor_screen.h"
#include "executor/monitor/dashboard.h"
#include "executor/monitor/recording.h"
#include "executor/monitor/run_model.h"
#include "executor/monitor/run_view.h"
#include "executor/telemetry/telemetry.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/signals.h"
#include "shared/system/lcm_url.h"
#include "shared/system/monotonic_clock.h"
#include "shared/system/whole_datagrams.h"

namespace tenon::executor {
namespace {

constexpr int kWait_ms = 50;
constexpr std::int64_t kRefresh_ns = 100'000'000;
constexpr int kQueue = 5000;  // messages: some seconds of a fast cycle

struct Options {
  std::string url = kDefaultLcmUrl;
  std::string record_to = ".";
  bool lines = false;
};

std::atomic<bool> leave_asked{false};

std::span<const std::uint8_t> bytes_of(const lcm::ReceiveBuffer& buffer) {
  return {static_cast<const std::uint8_t*>(buffer.data), buffer.data_size};
}

/// @param lacks of a log that was played to its end: what is missing in it, or nothing
int exit_status(std::uint64_t malformed, const std::string& lacks) {
  if (malformed > 0) {
    std::fprintf(stderr, "tenon-monitor: %llu messages could not be decoded\n",
                 static_cast<unsigned long long>(malformed));
  }
  if (!lacks.empty()) std::fprintf(stderr, "tenon-monitor: %s\n", lacks.c_str());
  return malformed > 0 || !lacks.empty() ? 1 : 0;
}

/// LCM passes over what is damaged without a word. @param url of a source that has ended
std::string what_the_source_lacks(const std::string& url) {
  const std::string log = lcm_log_of(url);
  return log.empty() ? "" : log_lacks(log);
}

// The bytes as they came: LCM's own decoding lets what is malformed throw through its C code.
template <typename Listener>
void subscribe(lcm::LCM& lcm, Listener& listener) {
  for (const char* channel :
       {kCycleChannel, kStepChannel, kRunChannel, kSetupChannel, kStatusChannel}) {
    lcm.subscribeFunction(channel, &Listener::take, &listener)->setQueueCapacity(kQueue);
  }
  take_whole_datagrams_only();
}

// Waits for messages, at most kWait_ms. False: nothing will come any more, as at the end of a log.
// A signal, such as that of a window's new size, ends the wait alone.
bool listen(lcm::LCM& lcm) {
  errno = 0;
  return lcm.handleTimeout(kWait_ms) >= 0 || errno == EINTR;
}

// --- lines ----------------------------------------------------------------------------------

struct Lines {
  static void take(const lcm::ReceiveBuffer* buffer, const std::string& channel, Lines* lines) {
    lines->say(lines->view.take(channel, bytes_of(*buffer)));
    // What else comes says nothing of whether the run goes on.
    if (channel != kCycleChannel && channel != kRunChannel) return;
    lines->heard_ns = monotonic_now_ns();
    lines->silence_told = false;
  }
  /// Once, where nothing more comes of what was to come.
  void tell_silence(const std::string& url) {
    const double silent_s = 1e-9 * static_cast<double>(monotonic_now_ns() - heard_ns);
    if (silence_told || silent_s < kStaleAfter_s) return;
    silence_told = true;
    if (view.running()) {
      say(format("stale: no cycle for %.1f s, and the run has not ended\n", silent_s));
    } else if (!anything) {
      say("waiting: nothing has come yet from " + url + "\n");
    }
  }
  void say(const std::string& text) {
    anything = anything || !text.empty();
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }
  RunView view;
  std::int64_t heard_ns = monotonic_now_ns();
  bool silence_told = false;
  bool anything = false;
};

int print_lines(lcm::LCM& lcm, const std::string& url) {
  Lines lines;
  subscribe(lcm, lines);
  while (!leave_asked && listen(lcm)) lines.tell_silence(url);
  std::printf("\n");
  std::fflush(stdout);
  return exit_status(lines.view.malformed(), leave_asked ? "" : what_the_source_lacks(url));
}

// --- dashboard ------------------------------------------------------------------------------

std::string stamp() {
  const auto now_s = static_cast<std::time_t>(wall_clock_us() / 1'000'000);
  std::tm parts{};
  std::array<char, 32> text{};
  if (::localtime_r(&now_s, &parts) == nullptr) return "0";
  std::strftime(text.data(), text.size(), "%Y%m%d-%H%M%S", &parts);
  return text.data();
}

class Dashboard {
 public:
  Dashboard(const Options& options, std::unique_ptr<Screen> screen)
      : screen_(std::move(screen)), recording_(options.record_to) {
    view_.source = options.url;
    view_.keys = screen_->keys();
  }

  static void take(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                   Dashboard* dashboard) {
    const auto bytes = bytes_of(*buffer);
    dashboard->model_.take(channel, bytes, monotonic_now_ns());
    dashboard->say(dashboard->recording_.add(buffer->recv_utime, channel, bytes));
  }

  /// Until somebody leaves.
  int run(lcm::LCM& lcm) {
    std::int64_t shown_ns = 0;
    while (!leave_asked && !press(screen_->key())) {
      if (view_.source_ended) {
        wait_until_ns(monotonic_now_ns() + kRefresh_ns);
      } else {
        view_.source_ended = !listen(lcm);
        if (view_.source_ended) view_.source_lacks = what_the_source_lacks(view_.source);
      }
      const std::int64_t now_ns = monotonic_now_ns();
      if (now_ns - shown_ns < kRefresh_ns) continue;
      shown_ns = now_ns;
      show(now_ns);
    }
    say(recording_.end());
    screen_.reset();
    if (!view_.notice.empty()) std::printf("%s\n", view_.notice.c_str());
    return exit_status(model_.malformed, view_.source_lacks);
  }

 private:
  void show(std::int64_t now_ns) {
    screen_->take_size();
    view_.width = screen_->width();
    view_.height = screen_->height();
    view_.now_ns = now_ns;
    view_.recording = recording_.file();
    view_.recorded = recording_.messages();
    screen_->show(dashboard(model_, view_));
  }
  /// True: leave.
  bool press(int key) {
    if (key == 'r') say(recording_.on() ? recording_.end() : recording_.begin(stamp()));
    constexpr int kControlL = 'L' - '@';
    if (key == kControlL) screen_->redraw();
    return key == 'q';
  }
  void say(const Recording::Said& said) {
    if (said.text.empty()) return;
    view_.notice = said.text;
    view_.notice_bad = said.bad;
  }

  std::unique_ptr<Screen> screen_;
  RunModel model_;
  Recording recording_;
  View view_;
};

int watch(const Options& options) {
  check_lcm_url(options.url);
  check_lcm_log(options.url);
  if (!has_multicast_route(options.url)) {
    throw InputError("--lcm-url " + options.url + ": no multicast route; " + kSetMulticastRoute);
  }
  lcm::LCM lcm(options.url);
  if (!lcm.good()) throw InputError("--lcm-url " + options.url + ": cannot be opened");
  stop_on_signals(leave_asked);
  auto screen = options.lines ? nullptr : Screen::open();
  if (screen == nullptr) return print_lines(lcm, options.url);
  Dashboard dashboard(options, std::move(screen));
  subscribe(lcm, dashboard);
  return dashboard.run(lcm);
}

// --- export ---------------------------------------------------------------------------------

// The subcommand, whose options go into `options`.
CLI::App* describe_export(CLI::App& app, ExportOptions& options) {
  CLI::App* sub = app.add_subcommand("export", "Writes a run's log as CSV and MCAP and ends");
  sub->footer("Examples:\n  tenon-monitor export run.lcmlog --csv run.csv --mcap run.mcap");
  sub->add_option("log", options.log, "Log of tenon-exec --log, or of the key r")->required();
  sub->add_option("--csv", options.csv, "File for a table: a row a control cycle");
  sub->add_option("--mcap", options.mcap,
                  "File for PlotJuggler and Foxglove: every message, what happened, the tool's "
                  "frames");
  sub->add_option("--run", options.run, "Which run of a log that holds several, from 1")
      ->check(CLI::Range(1, 1'000'000))
      ->default_str("the last");
  return sub;
}

}  // namespace
}  // namespace tenon::executor

int main(int argc, char** argv) {
  return tenon::run_main("tenon-monitor", [&] {
    using namespace tenon::executor;
    Options options;
    ExportOptions export_options;
    CLI::App app{
        "Watches a run of tenon-exec over LCM: on a terminal as a dashboard, else line by line."};
    app.footer(
        "Exit status:\n"
        "  0  all that came, or all of the log, was shown or written\n"
        "  1  messages could not be decoded, or a log is damaged, breaks off or ends before its "
        "run\n"
        "  2  bad input, or a place that nothing can be written to\n\n"
        "Examples:\n"
        "  tenon-monitor\n"
        "  tenon-monitor --lcm-url 'file://run.lcmlog?speed=1'\n"
        "  tenon-monitor export run.lcmlog --csv run.csv --mcap run.mcap");
    app.set_version_flag("--version", TENON_VERSION);
    app.add_option("--lcm-url", options.url, "Where telemetry comes from")
        ->type_name("URL")
        ->capture_default_str();
    app.add_option("--record-to", options.record_to, "Folder of what the key r records")
        ->capture_default_str();
    app.add_flag("--lines", options.lines, "Write lines on a terminal too");
    const CLI::App* exports = describe_export(app, export_options);
    tenon::parse(app, argc, argv);
    return exports->parsed() ? run_export(export_options) : watch(options);
  });
}
