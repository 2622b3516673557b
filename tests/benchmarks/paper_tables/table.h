#pragma once
// One table of the paper with ours beside it, as text and as JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmarks/paper_tables/figures.h"
#include "tests/benchmarks/paper_tables/paper.h"

namespace tenon::paper_tables {

/// Our figures for the rows of a table, in their order.
struct OurTable {
  const PaperTable& paper;
  std::string task;  ///< as load_task() takes it
  double tolerance_m = 0.0;
  double uncertainty_m2 = 0.0;
  double particle_sigmas = 0.0;
  std::vector<Figures> rows;

  [[nodiscard]] bool all_planned() const;
};

[[nodiscard]] std::string heading(const OurTable& table);
/// @param row an index into rows
[[nodiscard]] std::string line(const OurTable& table, std::size_t row);
/// Means and sample standard deviations, as the paper's, where there is more than one row; then
/// what a simulated move took there and here.
[[nodiscard]] std::string ending(const OurTable& table);
/// Keys are documented in tests/README.md.
[[nodiscard]] nlohmann::ordered_json json_of(const OurTable& table);

}  // namespace tenon::paper_tables
