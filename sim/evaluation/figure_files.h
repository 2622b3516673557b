#pragma once
// The figures of an evaluation's page as files that stand alone. Offline.

#include <string>
#include <vector>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

struct FigureFile {
  std::string name;  ///< PLAN_FIGURE.svg
  std::string svg;
};

/// Of every plan: runs, draws and ends (for a task in space seen from two sides: runs_xy and so
/// on), errors, and `by` where success is broken down. What a pointer over a mark would show is
/// left out.
[[nodiscard]] std::vector<FigureFile> figure_files(const Evaluation& evaluation);

}  // namespace tenon::sim
