// tenon-inspect: what a plan file says, whether it still holds, why it works, and how a run of it
// went.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "executor/recorded/result_file.h"
#include "executor/recorded/run_log.h"
#include "planner/cell_fit/cell_fit.h"
#include "planner/goal_certainty.h"
#include "planner/report/html_report.h"
#include "planner/report/inspection.h"
#include "planner/report/report_data.h"
#include "planner/report/run_page.h"
#include "planner/report/search_section.h"
#include "planner/report/statistics.h"
#include "planner/report/summary.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/system/fan_out.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace {

using namespace tenon;

struct Arguments {
  std::string plan;
  std::string json;
  std::string task;
  std::string report;
  std::string run;
  std::string log;
  std::string recertify;
  std::string cell;
  std::string statistics;
  std::size_t threads = all_cores();
};

void describe(CLI::App& app, Arguments& a) {
  app.set_version_flag("--version", TENON_VERSION);
  app.footer(
      "Exit status:\n"
      "  0  shown, and what was asked for is written; --recertify: the plan is what it says\n"
      "  1  --recertify: it is not; or a file could not be written\n"
      "  2  bad input, or a place that nothing can be written to\n\n"
      "Examples:\n"
      "  tenon-inspect plan.tnp --recertify planner/tasks/box_on_table_2d.yaml\n"
      "  tenon-inspect plan.tnp --task planner/tasks/box_on_table_2d.yaml --report plan.html\n"
      "  tenon-inspect plan.tnp --task planner/tasks/box_on_table_2d.yaml \\\n"
      "                --run result.json --log run.lcmlog --report run.html");
  app.add_option("plan", a.plan, "Plan file")->required();
  app.add_option("--json", a.json,
                 "File for everything that the plan holds, - for standard output");
  app.add_option("--task", a.task, "Task file that the plan was made from");
  CLI::Option* report =
      app.add_option("--report", a.report,
                     "HTML file: the plan, played step by step, and why it works; with --run or "
                     "--log the run, laid over it");
  app.add_option("--run", a.run, "Result of a run of the plan, as tenon-exec --json wrote it")
      ->needs(report);
  app.add_option("--log", a.log, "Log of a run of the plan, as tenon-exec --log wrote it")
      ->needs(report);
  app.add_option("--recertify", a.recertify,
                 "Task file: simulate the plan's whole chain and its validation again; exit status "
                 "1 if they are not what the plan says");
  app.add_option("--cell", a.cell, "Cell file that the plan was made with");
  app.add_option("--statistics", a.statistics,
                 "What tenon-plan --json wrote with this plan: text and the plan's page then tell "
                 "of the search");
  app.add_option("--threads", a.threads, "Threads of the simulation")
      ->check(CLI::Range(1, 256))
      ->default_str("all cores");
}

std::vector<std::uint8_t> bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

// The task as the planner had it.
planner::CellFit task_of(const Plan& plan, const std::string& file, const std::string& cell_file) {
  Task task = load_task(file);
  if (task.hash != plan.task_hash) {
    std::fprintf(stderr,
                 "tenon-inspect: note: %s is not byte for byte the task that the plan was "
                 "made from\n",
                 file.c_str());
  }
  sim::OdeRollout physics(task);
  task = planner::with_goal_certainty(std::move(task), physics);
  if (!cell_file.empty()) return planner::fit_to_cell(task, load_cell(cell_file));
  planner::CellFit fit{task, {}, {}};
  fit.assumptions.contact_stiffness_Npm = task.contact_stiffness_Npm;
  return fit;
}

// What a repetition found, in lines.
struct Verdict {
  bool holds = true;
  std::string text;

  void add(bool good, const std::string& what, const std::string& line) {
    holds = holds && good;
    text += what + (good ? ": yes, " : ": NO, ") + line + "\n";
  }
};

// The draws that the planner made, again: their seed is in the plan.
void validate_again(const Plan& plan, const Task& task, planner::RolloutPool& pool,
                    Verdict& verdict) {
  const planner::Validation validation =
      planner::validate(plan, task, planner::start_of(plan, task), plan.draws, pool);
  verdict.add(validation.at_goal() == plan.draws_at_goal, "validated",
              planner::estimate_text(validation, task));
  if (plan.method != PlanMethod::kMha) return;
  const std::size_t arrived = planner::arrived(validation.corners);
  verdict.add(arrived == validation.corners.size(), "validated",
              planner::corners_text(validation, task));
}

Verdict recertify(const Arguments& a, const Plan& plan, const std::vector<std::uint8_t>& bytes) {
  if (plan.draws > planner::kDrawsMax) {
    throw InputError(a.plan + ": draws = " + std::to_string(plan.draws) + ", must be at most " +
                     std::to_string(planner::kDrawsMax) + " to be repeated");
  }
  const auto [task, assumptions, changes] = task_of(plan, a.recertify, a.cell);
  const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-6 * std::abs(y); };
  if (!same(plan.contact_stiffness_Npm, assumptions.contact_stiffness_Npm) ||
      !same(plan.latency_max_s, assumptions.latency_max_s)) {
    throw InputError(
        format("%s: made for contact stiffness %g N/m and latency %g s, this task%s has "
               "%g N/m and %g s: give the --cell that it was made for",
               a.plan.c_str(), plan.contact_stiffness_Npm, plan.latency_max_s,
               a.cell.empty() ? "" : " on this cell", assumptions.contact_stiffness_Npm,
               assumptions.latency_max_s));
  }
  planner::RolloutPool pool(sim::OdeRollout(task), a.threads);
  const planner::Certification certification = planner::certify(bytes, task, pool);
  Verdict verdict;
  for (const planner::VariantRun& run : certification.runs) {
    const std::string line =
        run.holds ? format(", %zu particle%s", run.chains.size(), plural(run.chains.size()))
                  : format(": step %zu, particle %zu: ", run.disagreement.step,
                           run.disagreement.particle) +
                        run.disagreement.why;
    verdict.add(run.holds, "certified", run.variant.name + line);
  }
  if (std::abs(certification.cost - plan.cost) > 1e-3 * certification.cost) {
    verdict.add(false, "certified",
                format("the plan says that it costs %.0f, its chain costs %.0f", plan.cost,
                       certification.cost));
  }
  if (task.hash != plan.task_hash) {
    verdict.add(false, "certified", "the plan was made from another version of " + a.recertify);
  }
  if (plan.method == PlanMethod::kMha && !plan.check_envelopes) {
    verdict.add(false, "certified", "the plan checks no envelopes");
  }
  if (plan.draws < planner::kDrawsMin) {
    verdict.add(false, "validated",
                format("the plan is judged by %u draws, at least %zu are wanted", plan.draws,
                       planner::kDrawsMin));
  }
  validate_again(plan, task, pool, verdict);
  return verdict;
}

// The run that the report is of; none where it is of the plan alone.
std::optional<RecordedRun> run_of(const Arguments& a, const Plan& plan) {
  if (a.run.empty() && a.log.empty()) return std::nullopt;
  if (a.run.empty()) return executor::read_run_log(a.log, plan);
  const RecordedRun result = executor::read_run_result(a.run, config::read_file(a.run), plan);
  if (a.log.empty()) return result;
  return executor::joined(executor::read_run_log(a.log, plan), result, a.log, a.run);
}

std::string report_of(const Arguments& a, const Plan& plan, const std::vector<std::uint8_t>& bytes,
                      const planner::SearchStory* story) {
  const std::optional<RecordedRun> run = run_of(a, plan);
  if (run && a.task.empty()) return planner::run_report(plan, *run, nullptr);
  const Task task = task_of(plan, a.task, a.cell).task;
  planner::RolloutPool pool(sim::OdeRollout(task), a.threads);
  const planner::Certification certification = planner::certify(bytes, task, pool);
  const planner::Validation validation =
      planner::validate(plan, task, planner::start_of(plan, task), planner::kReportDraws, pool);
  if (!run) return planner::html_report(plan, task, certification, validation, story);
  const planner::ReportData data = planner::report_data(plan, task, certification, validation);
  return planner::run_report(plan, *run, &data);
}

int run(const Arguments& a) {
  check_apart({{"--json", a.json}, {"--report", a.report}}, {{"the plan", a.plan},
                                                             {"--task", a.task},
                                                             {"--recertify", a.recertify},
                                                             {"--cell", a.cell},
                                                             {"--statistics", a.statistics},
                                                             {"--run", a.run},
                                                             {"--log", a.log}});
  if (!a.report.empty() && a.task.empty() && a.run.empty() && a.log.empty()) {
    throw InputError("--report needs --task TASK.yaml, or a run of the plan (--run, --log)");
  }
  if (!a.cell.empty() && a.task.empty() && a.recertify.empty()) {
    throw InputError(
        "--cell is for --task and --recertify, and would change nothing here; leave it out");
  }
  const Plan plan = load_plan(a.plan);
  const std::vector<std::uint8_t> bytes = bytes_of(a.plan);
  std::optional<planner::SearchStory> story;
  if (!a.statistics.empty()) {
    story = planner::read_statistics(a.statistics, config::read_file(a.statistics), bytes);
  }
  const Verdict verdict = a.recertify.empty() ? Verdict{} : recertify(a, plan, bytes);
  if (!a.report.empty()) write_file(a.report, report_of(a, plan, bytes, story ? &*story : nullptr));
  if (a.json == "-") {
    std::fputs(planner::plan_json(plan, bytes.size()).c_str(), stdout);
  } else {
    if (!a.json.empty()) write_file(a.json, planner::plan_json(plan, bytes.size()));
    std::fputs(planner::header_text(plan, bytes.size()).c_str(), stdout);
    if (story) std::fputs(planner::search_text(*story).c_str(), stdout);
    std::fputs(planner::step_table(plan).c_str(), stdout);
  }
  std::fputs(verdict.text.c_str(), a.json == "-" ? stderr : stdout);
  return verdict.holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tenon::run_main("tenon-inspect", [&] {
    Arguments arguments;
    CLI::App app("Shows a plan file, certifies it again, and reports why it works.");
    describe(app, arguments);
    tenon::parse(app, argc, argv);
    return run(arguments);
  });
}
