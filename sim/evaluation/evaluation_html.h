#pragma once
// The evaluation as a page to look at: one HTML file that shows where the part went, replays what
// was recorded, and holds the plots. Offline.

#include <cstddef>
#include <string>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

/// Recordings that a page has room for, over all plans: it stays below 3 MB.
inline constexpr std::size_t kReplaysMax = 24;

/// Of many runs the places of some are drawn (run_sample.h); tables and rates are those of all.
[[nodiscard]] std::string evaluation_html(const Evaluation& evaluation);

}  // namespace tenon::sim
