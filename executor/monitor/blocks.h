#pragma once
// The blocks of the dashboard, each as lines for a column of so many glyphs (39 or more show all of
// it). Pure; allocates.

#include <string>
#include <vector>

#include "executor/monitor/run_model.h"
#include "executor/monitor/styled.h"

namespace tenon::executor {

/// From here on a block says more.
inline constexpr int kWide = 60;

struct Block {
  Line title;
  std::vector<Line> lines;
};

[[nodiscard]] Block run_block(const RunModel& model, int width);
[[nodiscard]] Block step_block(const RunModel& model, int width);
[[nodiscard]] Block force_block(const RunModel& model, int width);
[[nodiscard]] Block joint_block(const RunModel& model, int width);
[[nodiscard]] Block bus_block(const RunModel& model, int width);
/// @param now_ns monotonic
[[nodiscard]] Block timing_block(const RunModel& model, int width, std::int64_t now_ns);
/// Finished steps, the newest first.
[[nodiscard]] Block history_block(const RunModel& model, int width);

/// What the run is about now, as one banner or more, the worst first.
struct Banner {
  Style style = Style::kGoodBanner;
  std::string text;
};
/// @param source_ended a log that has been played is not stale
/// @param source_lacks what is missing in it, or nothing
[[nodiscard]] std::vector<Banner> banners(const RunModel& model, const std::string& source,
                                          bool source_ended, const std::string& source_lacks,
                                          std::int64_t now_ns);
/// What is shown is old.
[[nodiscard]] bool stale(const RunModel& model, bool source_ended, std::int64_t now_ns);

}  // namespace tenon::executor
