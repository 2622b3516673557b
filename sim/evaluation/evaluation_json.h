#pragma once
// The evaluation for programs; sim/README.md documents the keys. Offline.

#include <string>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

/// Depends on the runs alone, and not on how they were made: equal runs, equal bytes.
[[nodiscard]] std::string evaluation_json(const Evaluation& evaluation);
/// The same without the single runs.
[[nodiscard]] std::string summary_json(const Evaluation& evaluation);

}  // namespace tenon::sim
