// tenon-plan: a task file in, a certified plan out.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "executor/dry_run/cell_reach.h"
#include "planner/cell_fit/cell_fit.h"
#include "planner/check/task_check.h"
#include "planner/goal_certainty.h"
#include "planner/main_plan_new_task.h"
#include "planner/planner.h"
#include "planner/report/check_page.h"
#include "planner/report/html_report.h"
#include "planner/report/statistics.h"
#include "planner/report/summary.h"
#include "planner/search_moves.h"
#include "planner/smaller_errors.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/load.h"
#include "shared/system/fan_out.h"
#include "shared/system/monotonic_clock.h"
#include "shared/task/find_start.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace {

using namespace tenon;

struct Arguments {
  std::string task;
  std::string start;
  std::string cell;
  std::string method = to_string(PlanMethod::kMha);
  std::string output;
  std::string json;
  std::string report;
  std::size_t threads = all_cores();
  std::size_t draws = planner::kDrawsMin;
  std::optional<double> time_limit_s;
  std::optional<std::uint64_t> move_limit;
  double improve_s = 0.0;
  bool exact_search = false;
  bool strict = false;
  bool verbose = false;
  bool check = false;
  NewTaskArguments new_task;
};

void describe_new_task(CLI::App& app, NewTaskArguments& a) {
  auto* parts = app.add_option("--new-task", a.parts,
                               "Write a task for two parts, files of STL or OBJ, in place of a "
                               "plan; -o names its file")
                    ->expected(2)
                    ->option_text("PLUG SOCKET");
  app.add_option("--goal", a.goal,
                 "With --new-task: where the plug's file stands in the socket's, assembled, m and "
                 "rad; without it both are in one frame")
      ->expected(3, 6)
      ->option_text("X Y Z [RX RY RZ]")
      ->needs(parts);
  app.add_option("--uniform-mm", a.uniform_mm,
                 "With --new-task: the socket is anywhere within so much along each axis")
      ->check(CLI::Range(0.01, 100.0))
      ->needs(parts)
      ->capture_default_str();
  app.add_option("--uniform-deg", a.uniform_deg,
                 "With --new-task: and turned by anything up to this; 0: not at all")
      ->check(CLI::Range(0.0, 30.0))
      ->needs(parts)
      ->capture_default_str();
}

void describe(CLI::App& app, Arguments& a) {
  app.set_version_flag("--version", TENON_VERSION);
  app.footer(
      "Exit status:\n"
      "  0  a plan is written; --check: nothing is wrong; --new-task: a task is written\n"
      "  1  there is no plan, and the last line says why; or a file could not be written;\n"
      "     or, with --strict, a plan is written but its success is doubtful\n"
      "  2  bad input, or a place that nothing can be written to; --check: something is wrong\n\n"
      "Examples:\n"
      "  tenon-plan --check planner/tasks/box_on_table_2d.yaml\n"
      "  tenon-plan planner/tasks/box_on_table_2d.yaml --start 1 -o plan.tnp");
  app.add_option("task", a.task, "Task file");
  describe_new_task(app, a.new_task);
  app.add_option("--start", a.start, "Name of the start to plan from")
      ->type_name("NAME")
      ->default_str("the task's first");
  app.add_option("--cell", a.cell, "Cell file: plan with what its arm and contact stiffness allow");
  std::vector<std::string> methods;
  methods.reserve(kPlanMethods.size());
  for (const PlanMethod method : kPlanMethods) methods.emplace_back(to_string(method));
  app.add_option("--method", a.method, "Planner; all but mha are baselines with one particle")
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  app.add_option("--threads", a.threads, "Threads that plan; the plan does not depend on them")
      ->check(CLI::Range(1, 256))
      ->default_str("all cores");
  app.add_option("--time-limit", a.time_limit_s,
                 "Seconds after which no path is searched for any more")
      ->default_str("the task's");
  app.add_option("--move-limit", a.move_limit,
                 "Simulated moves after which no path is searched for any more, the same on every "
                 "machine")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000'000}))
      ->default_str("none");
  app.add_option("--improve", a.improve_s,
                 "Seconds to look for better plans once there is one; each is printed and written")
      ->check(CLI::Range(0.0, 86400.0))
      ->default_str("0");
  app.add_option("--draws", a.draws, "Random starts of the validation")
      ->check(CLI::Range(planner::kDrawsMin, planner::kDrawsMax))
      ->capture_default_str();
  app.add_flag(
      "--exact-search", a.exact_search,
      "Search with exact distances from meshes too: several times as slow. Plans are proven "
      "with exact ones in any case");
  app.add_flag("-v,--verbose", a.verbose, "Say on standard error what has been found and refuted");
  app.add_option("-o,--output", a.output,
                 "Plan file to write, of --new-task the task file; required but for --check");
  CLI::Option* check =
      app.add_flag("--check", a.check,
                   "Plan nothing: say what of the task is understood, and what is wrong with it");
  app.add_flag("--strict", a.strict,
               "Exit status 1 where a warning says that too few random starts end at the goal")
      ->excludes(check, app.get_option("--new-task"));
  app.add_option("--report", a.report,
                 "HTML file: the plan, played step by step, and why it works; with --check "
                 "pictures of scene, starts, particles and goal");
  app.add_option("--json", a.json, "File for the statistics, - for standard output");
}

PlanMethod chosen_method(const std::string& name) {
  const auto* found = std::find_if(kPlanMethods.begin(), kPlanMethods.end(),
                                   [&](PlanMethod method) { return name == to_string(method); });
  return *found;  // the command line lets no other through
}

const Start& chosen_start(const Task& task, const std::string& name) {
  if (name.empty() && !task.starts.empty()) return task.starts.front();
  if (const Start* start = find_start(task, name)) return *start;
  throw InputError("--start " + name + ": task '" + task.name + "' has no start of that name; " +
                   (task.starts.size() == 1 ? "its only one is " : "its starts are ") +
                   start_names(task) + start_meant(task, name));
}

/// Writes every plan as it comes, so that who stops the program has the best one so far.
void write_each(const Arguments& a, planner::PlannerOptions& options,
                const std::function<double()>& now_s) {
  options.planned = [&a, now_s](const planner::PlanReport& report) {
    write_file(a.output, report.bytes);
    if (a.improve_s == 0.0 || a.json == "-") return;
    std::printf("%6.1f s: %zu step%s, %s", now_s(), report.plan->steps.size(),
                plural(report.plan->steps.size()), planner::cost_text(*report.plan).c_str());
    std::fflush(stdout);
  };
}

/// Looks at the start that is named, else at all.
int check(const Arguments& a, Task task) {
  std::string changes;
  std::optional<Cell> cell;
  planner::CellAssumptions assumptions;
  if (!a.cell.empty()) {
    planner::CellFit fit = planner::fit_to_cell(task, cell.emplace(load_cell(a.cell)));
    task = std::move(fit.task);
    assumptions = planner::stored_assumptions(task, fit.assumptions);
    changes = planner::cell_changes_text(fit.changes);
  }
  const std::vector<Start> starts =
      a.start.empty() ? task.starts : std::vector<Start>{chosen_start(task, a.start)};
  planner::TaskCheck checked =
      planner::check_task(task, starts, [](const Task& part) -> std::unique_ptr<Rollout> {
        return std::make_unique<sim::OdeRollout>(part);
      });
  if (cell) {
    const executor::CellReach reach(*cell);
    for (const Start& start : starts) {
      std::string why;
      if (planner::reach_of_moves(task, start, assumptions, reach, why)) continue;
      checked.refuse(why);
      break;
    }
  }
  if (!a.report.empty()) write_file(a.report, planner::check_page(a.task, task, checked));
  std::fputs((planner::check_text(a.task, task, checked) + changes).c_str(), stdout);
  return checked.refused() ? 2 : 0;
}

/// Of what only planning writes, nothing is taken and then not written.
void write_nothing_more(const char* what, const char* option, const std::string& given) {
  if (given.empty()) return;
  throw InputError(
      format("%s: %s plans nothing and would write nothing there; leave it out", option, what));
}

double checked_time_limit_s(double time_limit_s) {
  if (time_limit_s > 0.0 && time_limit_s <= 86400.0) return time_limit_s;
  throw InputError(format("--time-limit = %g, must be in (0, 86400] s", time_limit_s));
}

/// Writes what planning has come to. @return exit status
int tell(const Arguments& a, const planner::PlanReport& report, const Task& task,
         const Start& start, const Rollout& rollout) {
  if (a.json == "-") {
    std::fputs(planner::statistics_json(report, task).c_str(), stdout);
  } else if (!a.json.empty()) {
    write_file(a.json, planner::statistics_json(report, task));
  }
  if (report.status == planner::PlanStatus::kInCollision) throw InputError(report.reason);
  if (report.status != planner::PlanStatus::kPlanned) {
    std::fprintf(stderr, "tenon-plan: no plan from start '%s': %s: %s\n", start.name.c_str(),
                 planner::to_string(report.status), report.reason.c_str());
    return 1;
  }
  if (!a.report.empty()) {
    const Task certain = planner::with_goal_certainty(task, *rollout.clone());
    write_file(a.report, planner::html_report(report, certain));
  }
  if (a.json != "-") std::fputs(planner::summary(report, task, a.output).c_str(), stdout);
  const std::string doubt = planner::doubt_text(report.validation, task);
  if (doubt.empty()) return 0;
  std::fprintf(stderr, "tenon-plan: warning: %s\n", doubt.c_str());
  return a.strict ? 1 : 0;
}

int run(const Arguments& a) {
  Task task = load_task(a.task);
  if (a.check) {
    write_nothing_more("--check", "--output", a.output);
    write_nothing_more("--check", "--json", a.json);
    check_apart({{"--report", a.report}}, {{"the task", a.task}, {"--cell", a.cell}});
    check_variants(a.task);
    return check(a, std::move(task));
  }
  if (a.output.empty()) throw InputError("--output is required; see --help");
  if (a.time_limit_s) task.time_limit_s = checked_time_limit_s(*a.time_limit_s);
  check_apart({{"--output", a.output}, {"--json", a.json}, {"--report", a.report}},
              {{"the task", a.task}, {"--cell", a.cell}});
  check_writable(a.output);
  if (!a.json.empty() && a.json != "-") check_writable(a.json);
  if (!a.report.empty()) check_writable(a.report);

  planner::PlannerOptions options;
  options.method = chosen_method(a.method);
  options.threads = a.threads;
  options.draws = a.draws;
  if (a.move_limit) options.moves_max = *a.move_limit;
  if (a.verbose) {
    options.progress = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  }
  std::vector<std::string> adapted;
  std::optional<executor::CellReach> reach;
  if (!a.cell.empty()) {
    const Cell cell = load_cell(a.cell);
    planner::CellFit fit = planner::fit_to_cell(task, cell);
    options.reach = &reach.emplace(cell);
    task = std::move(fit.task);
    options.assumptions = fit.assumptions;
    adapted = std::move(fit.changes);
  }
  const Start& start = chosen_start(task, a.start);
  const sim::OdeRollout rollout(task);
  const sim::OdeRollout sampled(task, sim::MeshDistances::kSampled);
  if (!a.exact_search) options.search_physics = &sampled;

  const std::int64_t began_ns = monotonic_now_ns();
  const auto now_s = [&] { return 1e-9 * static_cast<double>(monotonic_now_ns() - began_ns); };
  options.improve_s = a.improve_s;
  write_each(a, options, now_s);
  planner::PlanReport report = planner::make_plan(task, start, rollout, options, now_s);
  report.adapted = std::move(adapted);
  report.reason += planner::smaller_errors_text(report, task, start, rollout, options, now_s);

  return tell(a, report, task, start, rollout);
}

}  // namespace

int main(int argc, char** argv) {
  return tenon::run_main("tenon-plan", [&] {
    Arguments arguments;
    CLI::App app("Plans guarded moves that reach a goal although the start is uncertain.");
    describe(app, arguments);
    tenon::parse(app, argc, argv);
    if (arguments.new_task.parts.empty() == arguments.task.empty()) {
      throw InputError(arguments.task.empty()
                           ? "no task: give a task file, or --new-task PLUG SOCKET"
                           : "--new-task writes a task file: give none to plan");
    }
    if (arguments.task.empty()) {
      if (arguments.output.empty()) throw InputError("--output is required; see --help");
      write_nothing_more("--new-task", "--json", arguments.json);
      write_nothing_more("--new-task", "--report", arguments.report);
      if (!arguments.cell.empty()) {
        throw InputError("--cell: --new-task writes a task for any cell; leave it out");
      }
      arguments.new_task.output = arguments.output;
      return write_new_task(arguments.new_task);
    }
    return run(arguments);
  });
}
