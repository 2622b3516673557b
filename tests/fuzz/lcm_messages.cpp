// Whatever comes over LCM, as tenon-monitor takes it: the first byte picks the channel and whether
// it shows on a terminal, what follows is the message.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "executor/telemetry/run_view.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/received/received.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
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

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array<const char*, 4> kChannels = {kCycleChannel, kStepChannel, kRunChannel,
                                                    "OTHER"};
  const std::span<const std::uint8_t> bytes = std::span(data, size).subspan(1);
  check_decoded<cycle_state_t>(bytes);
  check_decoded<step_event_t>(bytes);
  check_decoded<run_summary_t>(bytes);
  const bool terminal = (data[0] & 4U) != 0;
  RunView view(terminal);
  for (int i = 0; i < 2; ++i) {
    const std::string text = view.take(kChannels.at(data[0] & 3U), bytes);
    must(text.size() < 4000, "a message is a line or two");
    for (const char c : text) {
      const bool of_ours = c == '\n' || (terminal && (c == '\r' || c == '\033'));
      must(of_ours || static_cast<unsigned char>(c) >= 0x20, "no control byte is shown");
    }
  }
  must(view.malformed() <= 2, "a message is counted once");
  return 0;
}
