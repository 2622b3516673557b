#pragma once
// What Tables II to IV of Kim and Likhachev, "Parts Assembly Planning under Uncertainty with
// Simulation-Aided Physical Reasoning", print.

#include <array>
#include <cstddef>
#include <span>

namespace tenon::paper_tables {

struct PaperRow {
  const char* start;  ///< ours of the same number
  double time_s;
  double cost;
  double nodes;  ///< of the path
  double expansions;
  double error_mean_m;  ///< of the particles' distances from the goal
  double error_std_m;
};

struct PaperTable {
  const char* number;
  const char* title;
  const char* task;  ///< planner/tasks/TASK.yaml
  std::span<const PaperRow> rows;
  /// It simulates every particle for every primitive at each expansion. The paper counts expansions
  /// only.
  double moves_an_expansion;

  [[nodiscard]] double moves(const PaperRow& row) const {
    return moves_an_expansion * row.expansions;
  }
};

inline constexpr std::array<PaperRow, 12> kTable2 = {{
    {"1", 367, 42032, 9, 10, 0.0165, 0.0085},
    {"2", 482, 46544, 12, 12, 0.0143, 0.0072},
    {"3", 364, 35812, 8, 10, 0.0163, 0.0067},
    {"4", 484, 45172, 10, 11, 0.0158, 0.0055},
    {"5", 502, 47644, 13, 13, 0.0439, 0.0066},
    {"6", 396, 47847, 11, 11, 0.0273, 0.0290},
    {"7", 488, 42900, 13, 14, 0.0146, 0.0059},
    {"8", 685, 48839, 14, 16, 0.0296, 0.0059},
    {"9", 638, 45951, 12, 16, 0.0171, 0.0063},
    {"10", 463, 41891, 9, 13, 0.0382, 0.0203},
    {"11", 711, 42198, 16, 19, 0.0370, 0.0099},
    {"12", 637, 47356, 13, 16, 0.0162, 0.0089},
}};

/// The other row of this table is start 6 of Table II.
inline constexpr std::array<PaperRow, 1> kTable3 = {{{"6", 1322, 42958, 11, 17, 0.0611, 0.0009}}};

inline constexpr std::array<PaperRow, 3> kTable4 = {{
    {"1", 706, 12164, 16, 21, 0.0032, 0.0009},
    {"2", 604, 12474, 16, 19, 0.0029, 0.0018},
    {"3", 830, 15311, 22, 25, 0.0035, 0.0011},
}};

inline constexpr std::array<PaperTable, 3> kPaperTables = {{
    {"II", "box on a table, in the plane", "box_on_table_2d", kTable2, 4 * 4},
    {"III", "box on a table, in space", "box_on_table_3d", kTable3, 6 * 6},
    {"IV", "peg in a hole, in the plane", "peg_in_hole_2d", kTable4, 4 * 4},
}};

}  // namespace tenon::paper_tables
