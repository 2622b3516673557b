#pragma once
// The evaluation as a page to look at: one HTML file with its plots inside. Offline.

#include <string>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

[[nodiscard]] std::string evaluation_html(const Evaluation& evaluation);

}  // namespace tenon::sim
