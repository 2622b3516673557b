#pragma once
// A run as its result.json tells it. Offline; any thread.

#include <string>

#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon::executor {

/// Without samples: what a result holds are the steps and the counts.
/// @param name of the file, for messages  @param text what is in it
/// @throws InputError where that is no result, or one of another plan
[[nodiscard]] RecordedRun read_run_result(const std::string& name, const std::string& text,
                                          const Plan& plan);

/// The log's run with what the result alone knows.
/// @param log_name, result_name of the files, for messages
/// @throws InputError where they are of different runs
[[nodiscard]] RecordedRun joined(RecordedRun log, const RecordedRun& result,
                                 const std::string& log_name, const std::string& result_name);

}  // namespace tenon::executor
