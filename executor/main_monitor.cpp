// tenon-monitor: watches a run over LCM. Prints events as lines and, on a terminal, the state of
// the cycle about ten times a second. It can only listen.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "executor/telemetry/run_view.h"
#include "executor/telemetry/telemetry.h"
#include "shared/base/error.h"
#include "shared/config/command_line.h"
#include "shared/system/lcm_url.h"

namespace tenon::executor {
namespace {

// It holds nothing that an end could spoil, and LCM may be waiting for a log that gives nothing.
void leave(int /*signal*/) {
  static_cast<void>(::write(STDOUT_FILENO, "\n", 1));
  ::_exit(0);
}

// What LCM calls, with the bytes as they came: its own decoding lets what is malformed throw
// through its C code.
void take(const lcm::ReceiveBuffer* buffer, const std::string& channel, RunView* view) {
  const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
  std::fputs(view->take(channel, {bytes, buffer->data_size}).c_str(), stdout);
  std::fflush(stdout);
}

int watch(const std::string& url) {
  check_lcm_url(url);
  check_lcm_log(url);
  if (!has_multicast_route(url)) {
    throw InputError("--lcm-url " + url + ": no multicast route; " + kSetMulticastRoute);
  }
  lcm::LCM lcm(url);
  if (!lcm.good()) throw InputError("--lcm-url " + url + ": cannot be opened");
  RunView view(isatty(STDOUT_FILENO) == 1);
  for (const char* channel : {kCycleChannel, kStepChannel, kRunChannel}) {
    lcm.subscribeFunction(channel, &take, &view);
  }
  while (lcm.handle() >= 0) {
  }  // to the end of a log
  std::printf("\n");
  if (view.malformed() == 0) return 0;
  std::fprintf(stderr, "tenon-monitor: %llu messages could not be decoded\n",
               static_cast<unsigned long long>(view.malformed()));
  return 1;
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
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) (void)std::signal(signal, &leave);
    return watch(url);
  });
}
