#pragma once
// The data of an evaluation's page; shared/drawing/page/README.md has its keys. Pure; any thread.

#include <string>
#include <vector>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

/// One JSON object. @param samples a plan each: the runs whose paths it holds
[[nodiscard]] std::string evaluation_page_json(const Evaluation& evaluation,
                                               const std::vector<Candidate>& samples);

}  // namespace tenon::sim
