// Tables I to IV of the paper, planned anew: its figures beside ours, at its tolerances and at
// ours.
//
//   paper_tables [--table I|II|III|IV] [--setting paper|ours] [--draws N] [--threads N] [--json
//   FILE]
//
// The tasks are those of planner/tasks, plain for our tolerances and #paper for the paper's. Exit
// status 0 where every start has a plan, 1 where one has none, 2 for bad usage.

#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "planner/planner.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "shared/system/monotonic_clock.h"
#include "shared/task/find_start.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/benchmarks/paper_tables/figures.h"
#include "tests/benchmarks/paper_tables/table.h"
#include "tests/benchmarks/paper_tables/toy.h"
#include "tests/support/places.h"

namespace {

using namespace tenon;
using namespace tenon::paper_tables;

constexpr const char* kUsage =
    "paper_tables [--table I|II|III|IV] [--setting paper|ours] [--draws N] [--threads N] "
    "[--json FILE]\n";

constexpr const char* kLegend =
    "Ours beside the paper's (Kim and Likhachev, Tables I to IV).\n"
    "time: attractors and search, of all rounds. cost: the paper does not print its weights, ours\n"
    "reproduce only the size. nodes: of the path, start and goal included. first path:\n"
    "expansions until there is a path, as the paper counts them; ours count that of the goal,\n"
    "which simulates nothing. expansions: those after refuted paths too; the paper refutes none.\n"
    "moves: simulated by all searches, attractors included; the paper does not print them: its\n"
    "expansions times particles times primitives. error: mean and standard deviation of the\n"
    "particles' distances from the goal at the end. physics: as planned, half the time step,\n"
    "lowest and highest friction. draws at goal: random starts of the validation, all of them and\n"
    "those within the particles' reach.\n";

struct Arguments {
  std::string table;    ///< empty: all
  std::string setting;  ///< empty: both
  std::string json;
  planner::PlannerOptions options;
};

std::size_t whole(const char* option, const std::string& text, std::size_t low, std::size_t high) {
  std::size_t read = 0;
  unsigned long value = 0;
  try {
    value = std::stoul(text, &read);
  } catch (const std::exception&) {
    read = 0;
  }
  if (read == 0 || read != text.size() || value < low || value > high) {
    throw InputError(std::string("--") + option + " " + text + ": must be a whole number from " +
                     std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

std::string one_of(const char* option, const std::string& text,
                   const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) {
    if (name == text) return text;
    all += (all.empty() ? "" : ", ") + name;
  }
  throw InputError(std::string("--") + option + " " + text + ": must be one of " + all);
}

Arguments parse(int argc, char** argv) {
  enum : int { kTable, kSetting, kDraws, kThreads, kJson, kHelp };
  const option options[] = {{"table", required_argument, nullptr, kTable},
                            {"setting", required_argument, nullptr, kSetting},
                            {"draws", required_argument, nullptr, kDraws},
                            {"threads", required_argument, nullptr, kThreads},
                            {"json", required_argument, nullptr, kJson},
                            {"help", no_argument, nullptr, kHelp},
                            {nullptr, 0, nullptr, 0}};
  Arguments a;
  for (int found = 0; (found = getopt_long(argc, argv, "", options, nullptr)) != -1;) {
    if (found == kTable) a.table = one_of("table", optarg, {"I", "II", "III", "IV"});
    if (found == kSetting) a.setting = one_of("setting", optarg, {"paper", "ours"});
    if (found == kDraws) a.options.draws = whole("draws", optarg, 1, 100'000);
    if (found == kThreads) a.options.threads = whole("threads", optarg, 1, 256);
    if (found == kJson) a.json = optarg;
    if (found == kHelp) {
      std::printf("%s\n%s", kUsage, kLegend);
      std::exit(0);
    }
    if (found == '?') throw InputError(std::string("usage: ") + kUsage);
  }
  if (optind < argc) throw InputError(std::string(argv[optind]) + ": no such option; see --help");
  if (!a.json.empty()) check_writable(a.json);
  return a;
}

double now_s() { return 1e-9 * static_cast<double>(monotonic_now_ns()); }

/// Plans every row and prints it as it comes.
OurTable planned(const PaperTable& paper, const std::string& name,
                 const planner::PlannerOptions& options) {
  const Task task = load_task(tests::in_tree("planner/tasks/") + name);
  const sim::OdeRollout rollout(task);
  OurTable table{paper, name, task.goal_tolerance_m, task.goal_uncertainty_m2, task.particle_sigmas,
                 {}};
  std::fputs(heading(table).c_str(), stdout);
  for (const PaperRow& row : paper.rows) {
    const planner::PlanReport report =
        planner::make_plan(task, start_or_first(task, row.start), rollout, options, now_s);
    table.rows.push_back(figures_of(report, task));
    std::fputs(line(table, table.rows.size() - 1).c_str(), stdout);
    std::fflush(stdout);
  }
  std::fputs(ending(table).c_str(), stdout);
  std::fflush(stdout);
  return table;
}

int run(const Arguments& a) {
  std::fputs(kLegend, stdout);
  nlohmann::ordered_json json = {{"threads", a.options.threads},
                                 {"tables", nlohmann::json::array()}};
  if (a.table.empty() || a.table == "I") {
    const Task toy = load_task(tests::in_tree("planner/tasks/toy_1d.yaml"));
    const std::vector<Expansion> expansions = expansions_of(toy, sim::OdeRollout(toy));
    std::fputs(text_of(expansions).c_str(), stdout);
    json["tables"].push_back(json_of(expansions));
  }
  bool all_planned = true;
  for (const PaperTable& paper : kPaperTables) {
    if (!a.table.empty() && a.table != paper.number) continue;
    for (const char* setting : {"paper", "ours"}) {
      if (!a.setting.empty() && a.setting != setting) continue;
      const std::string variant = setting == std::string("paper") ? "#paper" : "";
      const OurTable table = planned(paper, paper.task + (".yaml" + variant), a.options);
      all_planned = all_planned && table.all_planned();
      json["tables"].push_back(json_of(table));
    }
  }
  if (!a.json.empty()) write_file(a.json, json.dump(2) + "\n");
  return all_planned ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const InputError& error) {
    std::fprintf(stderr, "paper_tables: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "paper_tables: %s\n", error.what());
    return 1;
  }
}
