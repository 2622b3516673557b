#pragma once
// The evaluation as CI tools read it: JUnit's XML, a testsuite a plan and a testcase a run. Pure.

#include <optional>
#include <string>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

/// Follows from the runs alone: equal runs, equal bytes. A run that did not succeed is a failure
/// of the type of its ending; one that said nothing about the plan (kNoWorld, kNoPhysics) is an
/// error. Properties hold success and its interval.
/// @param min_success proportion, 0 to 1: in a suite that reaches it, failed runs are skipped
/// tests with their reason, so that a report is red only where the plan is
[[nodiscard]] std::string evaluation_junit(const Evaluation& evaluation,
                                           std::optional<double> min_success);

}  // namespace tenon::sim
