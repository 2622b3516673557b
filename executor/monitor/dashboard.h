#pragma once
// What tenon-monitor shows on a terminal: a pure function from what is known of a run to lines of
// styled glyphs. The worst comes first; every number has its unit; what does not fit is said.
// Allocates; any thread.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/monitor/run_model.h"
#include "executor/monitor/styled.h"

namespace tenon::executor {

struct View {
  int width = 80;              ///< columns; made for 40 to 200
  int height = 24;             ///< rows
  std::int64_t now_ns = 0;     ///< monotonic
  std::string source{};        ///< the URL, for people
  bool source_ended = false;   ///< a log that has been played
  std::string source_lacks{};  ///< of a log that has been played, empty: nothing
  bool keys = true;            ///< somebody can press one
  std::string recording{};     ///< the file that is being recorded to, empty: none
  std::uint64_t recorded = 0;  ///< messages
  std::string notice{};        ///< what became of a recording
  bool notice_bad = false;
};

/// Exactly `height` lines of exactly `width` glyphs.
[[nodiscard]] std::vector<Line> dashboard(const RunModel& model, const View& view);

/// Nothing came for so long: the publisher is gone, or the network.
inline constexpr double kStaleAfter_s = 1.0;

}  // namespace tenon::executor
