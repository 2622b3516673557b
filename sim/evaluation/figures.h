#pragma once
// The figures of an evaluation's page, each an SVG element. Private to sim/evaluation.

#include <string>

#include "shared/drawing/view.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {

// Red and blue that colour-blind eyes tell apart; the shapes of the marks say it a second time.
inline constexpr const char* kSucceededColour = "#1f6eb4";
inline constexpr const char* kStoppedColour = "#e08214";
inline constexpr const char* kWrongColour = "#b2182b";
[[nodiscard]] const char* colour_of(TrialClass trial_class);

/// The style sheet of all of them.
inline constexpr const char* kFigureStyle =
    "svg text{font:12px system-ui,sans-serif}svg .label{font-size:13px;fill:#444}"
    ".ground{fill:#fff}.frame{fill:none;stroke:#999}.tick{stroke:#999}";

/// The way of each run from its beginning, step by step, seen from the environment as it really
/// stood.
[[nodiscard]] std::string figure_of_runs(const Evaluation& evaluation, const Candidate& candidate,
                                         const drawing::View& view);
/// Where the environment stood in each run, about where it was said to stand.
[[nodiscard]] std::string figure_of_draws(const Evaluation& evaluation, const Candidate& candidate,
                                          const drawing::View& view);
/// Where the part ended, close to the goal.
[[nodiscard]] std::string figure_of_ends(const Evaluation& evaluation, const Candidate& candidate,
                                         const drawing::View& view);
/// What its marks mean, and what it does not show: a sentence or more, for its caption.
[[nodiscard]] std::string note_of_ends(const Evaluation& evaluation, const Candidate& candidate,
                                       const drawing::View& view);
/// How many ended how far from the goal.
[[nodiscard]] std::string figure_of_errors(const Evaluation& evaluation,
                                           const Candidate& candidate);
/// Success by one drawn quantity or two.
[[nodiscard]] std::string figure_of_breakdown(const Evaluation& evaluation,
                                              const Candidate& candidate);
/// A proportion with its interval, to stand in a table.
[[nodiscard]] std::string rate_bar(const Rate& rate);

}  // namespace tenon::sim
