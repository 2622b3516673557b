// Whatever comes over LCM, as tenon-monitor takes it, for its lines and for its dashboard: the
// first byte picks the channel and the window, what follows is the message.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "executor/monitor/dashboard.h"
#include "executor/monitor/run_model.h"
#include "executor/monitor/run_view.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/received/received.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "tests/fuzz/support/must.h"

namespace {

using namespace tenon;
using namespace tenon::executor;
using fuzz::must;

/// What is decoded encodes to as many bytes again.
template <typename Message>
void check_decoded(std::span<const std::uint8_t> bytes) {
  const auto message = decoded<Message>(bytes);
  if (!message) return;
  must(message->getEncodedSize() == static_cast<int>(bytes.size()),
       "a message is as long as its bytes");
}

// Before and after a run of which all is known, at one of some sizes.
void check_dashboard(const char* channel, std::span<const std::uint8_t> bytes, unsigned window) {
  constexpr std::array<int, 4> kWidths = {1, 40, 80, 200};
  View view;
  view.width = kWidths.at(window & 3U);
  view.height = 24;
  RunModel model;
  for (int i = 0; i < 2; ++i) {
    model.take(channel, bytes, i);
    // What a message of one kind said is read beside those of the others.
    if (!model.cycle) model.cycle = {cycle_state_t{}, 0};
    if (!model.status) model.status = {run_status_t{}, 0};
    view.now_ns = 3'000'000'000 * i;
    const std::vector<Line> lines = dashboard(model, view);
    must(lines.size() == static_cast<std::size_t>(view.height), "a screen is as high as it is");
    for (const Line& line : lines) {
      must(line.size() == static_cast<std::size_t>(view.width), "a line is as wide as the screen");
      for (const Glyph& glyph : line) {
        const bool shown = glyph.code >= 0x20 && glyph.code != 0x7F;
        must(shown && (glyph.code < 0x80 || glyph.code >= 0xA0), "no control code is shown");
      }
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array<const char*, 8> kChannels = {
      kCycleChannel, kStepChannel,   kRunChannel, "OTHER",
      kSetupChannel, kStatusChannel, "OTHER",     ""};
  const std::span<const std::uint8_t> bytes = std::span(data, size).subspan(1);
  check_decoded<cycle_state_t>(bytes);
  check_decoded<step_event_t>(bytes);
  check_decoded<run_summary_t>(bytes);
  check_decoded<run_setup_t>(bytes);
  check_decoded<run_status_t>(bytes);
  const char* channel = kChannels.at(data[0] & 7U);
  check_dashboard(channel, bytes, data[0] >> 3U);
  RunView view;
  for (int i = 0; i < 2; ++i) {
    const std::string text = view.take(channel, bytes);
    must(text.size() < 4000, "a message is a line or two");
    for (const char c : text) {
      must(c == '\n' || static_cast<unsigned char>(c) >= 0x20, "no control byte is shown");
    }
  }
  must(view.malformed() <= 2, "a message is counted once");
  return 0;
}
