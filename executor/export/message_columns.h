#pragma once
// The columns of each kind of message. What a message cannot know in its state is no value, and
// numbers that stand for words are words. Pure; allocates.

#include <optional>
#include <string>
#include <vector>

#include "executor/export/column.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"

namespace tenon::executor {

struct JointName {
  std::string name;
  std::string unit;  ///< "_m", "_rad"; empty where the log does not say
};

/// @param setup thresholds of each step, where the log has them
[[nodiscard]] Columns<tenon::cycle_state_t> cycle_columns(
    const std::vector<JointName>& joints, const std::optional<tenon::run_setup_t>& setup);
[[nodiscard]] Columns<tenon::step_event_t> step_columns();
[[nodiscard]] Columns<tenon::run_status_t> status_columns();
[[nodiscard]] Columns<tenon::run_setup_t> setup_columns(const std::vector<JointName>& joints);
[[nodiscard]] Columns<tenon::run_summary_t> summary_columns();

/// "contact" of a step's outcome, "?" where there is no such number.
[[nodiscard]] const char* outcome_text(int outcome);
/// How a step went another way than planned, one line; empty: it did not.
[[nodiscard]] std::string deviation_text(const tenon::step_event_t& message);

}  // namespace tenon::executor
