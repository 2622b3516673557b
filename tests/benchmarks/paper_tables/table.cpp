#include "tests/benchmarks/paper_tables/table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/base/text.h"

namespace tenon::paper_tables {
namespace {

/// A figure that both have.
struct Column {
  const char* key;
  const char* title;
  int width;
  double shown;      ///< times this
  int decimals;      ///< of a row
  int decimals_all;  ///< of means and deviations
  double Figures::*ours;
  double PaperRow::*paper;
};

constexpr Column kTime = {"time_s", "time s", 6, 1.0, 2, 2, &Figures::time_s, &PaperRow::time_s};
constexpr Column kMoves = {"moves", "moves", 5, 1.0, 0, 0, &Figures::moves, nullptr};
constexpr std::array kColumns = {
    kTime,
    Column{"cost", "cost", 6, 1.0, 0, 0, &Figures::cost, &PaperRow::cost},
    Column{"nodes", "nodes", 5, 1.0, 0, 1, &Figures::nodes, &PaperRow::nodes},
    Column{"expansions_first", "first path", 5, 1.0, 0, 1, &Figures::expansions_first,
           &PaperRow::expansions},
    Column{"expansions", "expansions", 5, 1.0, 0, 1, &Figures::expansions, &PaperRow::expansions},
    kMoves,
    Column{"error_mean_m", "error mm", 5, 1e3, 1, 1, &Figures::error_mean_m,
           &PaperRow::error_mean_m},
    Column{"error_std_m", "its std mm", 5, 1e3, 1, 1, &Figures::error_std_m,
           &PaperRow::error_std_m}};

/// The paper does not print its moves; they follow from its expansions.
double paper_value(const Column& column, const PaperTable& table, const PaperRow& row) {
  return column.paper == nullptr ? table.moves(row) : row.*column.paper;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of a sample, as the paper's.
double deviation(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - mean(values), 2);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

struct Sample {
  std::vector<double> ours;
  std::vector<double> paper;
};

Sample sample(const OurTable& table, const Column& column) {
  Sample sample;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (!table.rows[i].planned) continue;
    sample.ours.push_back(table.rows[i].*column.ours);
    sample.paper.push_back(paper_value(column, table.paper, table.paper.rows[i]));
  }
  return sample;
}

double total(const std::vector<double>& values) {
  return mean(values) * static_cast<double>(values.size());
}

std::string cell(const Column& column, int decimals, double ours, double paper) {
  return format(" %*.*f %*.*f |", column.width, decimals, column.shown * ours, column.width,
                decimals, column.shown * paper);
}

std::string statistic(const OurTable& table, const char* name,
                      double (*of)(const std::vector<double>&)) {
  std::string text = format("%5s |", name);
  for (const Column& column : kColumns) {
    const Sample both = sample(table, column);
    text += cell(column, column.decimals_all, of(both.ours), of(both.paper));
  }
  return text + "\n";
}

/// What a simulated move took, and how much of the ratio of times that explains.
struct Pace {
  double ours_s = 0.0;
  double paper_s = 0.0;
  double time_ratio = 0.0;
  double moves_ratio = 0.0;
};

Pace pace_of(const OurTable& table) {
  const Sample times = sample(table, kTime);
  const Sample moves = sample(table, kMoves);
  return {total(times.ours) / total(moves.ours), total(times.paper) / total(moves.paper),
          total(times.paper) / total(times.ours), total(moves.paper) / total(moves.ours)};
}

bool any_planned(const OurTable& table) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [](const Figures& row) { return row.planned; });
}

}  // namespace

bool OurTable::all_planned() const {
  return std::all_of(rows.begin(), rows.end(), [](const Figures& row) { return row.planned; });
}

std::string heading(const OurTable& table) {
  std::string text = format(
      "\nTable %s: %s. %s: every particle within %g mm, u at most %g m^2, particles at %g sigma.\n",
      table.paper.number, table.paper.title, table.task.c_str(), 1e3 * table.tolerance_m,
      table.uncertainty_m2, table.particle_sigmas);
  std::string titles = "      |";
  std::string whose = "start |";
  for (const Column& column : kColumns) {
    titles += format(" %-*s |", 2 * column.width + 1, column.title);
    whose += format(" %*s %*s |", column.width, "ours", column.width, "paper");
  }
  return text + titles + " certificate of ours\n" + whose +
         " bound  physics  draws at goal, in reach\n";
}

std::string line(const OurTable& table, std::size_t row) {
  const Figures& ours = table.rows[row];
  const PaperRow& paper = table.paper.rows[row];
  std::string text = format("%5s |", paper.start);
  if (!ours.planned) return text + " no plan: " + ours.reason + "\n";
  for (const Column& column : kColumns) {
    text +=
        cell(column, column.decimals, ours.*column.ours, paper_value(column, table.paper, paper));
  }
  return text + format(" %5.2f  %zu of %zu   %zu of %zu, %zu of %zu\n", ours.bound,
                       ours.variants_held, ours.variants, ours.draws_at_goal, ours.draws,
                       ours.draws_within_at_goal, ours.draws_within);
}

std::string ending(const OurTable& table) {
  if (!any_planned(table)) return {};
  std::string text;
  if (table.rows.size() > 1) {
    text += statistic(table, "mean", mean) + statistic(table, "std", deviation);
  }
  const Pace pace = pace_of(table);
  return text + format(
                    "A simulated move took %.2g ms here and %.2f s there. Of the %.0f times less "
                    "time, the simulator makes %.0f times and the number of moves %.2f.\n",
                    1e3 * pace.ours_s, pace.paper_s, pace.time_ratio,
                    pace.time_ratio / pace.moves_ratio, pace.moves_ratio);
}

nlohmann::ordered_json json_of(const OurTable& table) {
  nlohmann::ordered_json json = {{"table", table.paper.number},
                                 {"task", table.task},
                                 {"tolerance_m", table.tolerance_m},
                                 {"uncertainty_m2", table.uncertainty_m2},
                                 {"particle_sigmas", table.particle_sigmas},
                                 {"rows", nlohmann::json::array()}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Figures& ours = table.rows[i];
    nlohmann::ordered_json row = {{"start", table.paper.rows[i].start},
                                  {"planned", ours.planned},
                                  {"reason", ours.reason},
                                  {"ours", nlohmann::json::object()},
                                  {"paper", nlohmann::json::object()}};
    for (const Column& column : kColumns) {
      row["ours"][column.key] = ours.*column.ours;
      row["paper"][column.key] = paper_value(column, table.paper, table.paper.rows[i]);
    }
    row["certificate"] = {{"bound", ours.bound},
                          {"variants", ours.variants},
                          {"variants_held", ours.variants_held},
                          {"draws", ours.draws},
                          {"draws_at_goal", ours.draws_at_goal},
                          {"draws_within_particles", ours.draws_within},
                          {"draws_within_particles_at_goal", ours.draws_within_at_goal},
                          {"moves", ours.check_moves},
                          {"time_s", ours.check_s}};
    json["rows"].push_back(row);
  }
  if (any_planned(table)) {
    const Pace pace = pace_of(table);
    json["move_s"] = {{"ours", pace.ours_s}, {"paper", pace.paper_s}};
  }
  return json;
}

}  // namespace tenon::paper_tables
