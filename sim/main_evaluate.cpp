// tenon-evaluate: many runs of plans through the real executor and CAN protocol on the virtual arm,
// in worlds that a seed draws. Only composes; see sim/README.md.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hw/bus_load/bus_load.h"
#include "hw/bus_load/response_times.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/load.h"
#include "shared/system/fan_out.h"
#include "shared/system/record_file.h"
#include "shared/task/spread.h"
#include "sim/evaluation/corner.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/evaluation_html.h"
#include "sim/evaluation/evaluation_json.h"
#include "sim/evaluation/evaluation_junit.h"
#include "sim/evaluation/figure_files.h"
#include "sim/evaluation/recording.h"
#include "sim/evaluation/run_line.h"
#include "sim/evaluation/run_maker.h"
#include "sim/evaluation/summary.h"
#include "sim/evaluation_chain/trial_runner.h"
#include "sim/main_evaluate_input.h"
#include "sim/main_evaluate_progress.h"

namespace {

using namespace tenon;
namespace fs = std::filesystem;

// --- Many runs --------------------------------------------------------------------------------

using Runners = std::vector<sim::TrialRunner>;

Runners runners_of(const Cell& cell, const sim::Evaluation& evaluation) {
  Runners runners;
  for (const sim::Candidate& candidate : evaluation.candidates) {
    runners.emplace_back(cell, evaluation.task, candidate);
  }
  return runners;
}

void make_runs(const EvaluateLine& line, const Runners& runners, sim::Evaluation& evaluation) {
  sim::RunMaker::Parameters parameters;
  parameters.count = line.count;
  parameters.threads = line.threads;
  parameters.shard = sim::parse_shard(line.shard);
  parameters.identity = identity_of(line, evaluation.task);
  parameters.log = log_file_of(line);
  parameters.others.assign(line.merge.begin(), line.merge.end());
  sim::RunMaker maker(evaluation, parameters);
  if (maker.log_was_torn()) {
    std::fprintf(stderr, "%s: its last line was torn\n", parameters.log.c_str());
  }
  const std::size_t found = maker.all() - maker.missing();
  if (found > 0)
    std::printf("%zu of %zu run%s %s there already\n", found, maker.all(), plural(maker.all()),
                found == 1 ? "is" : "are");

  Progress progress(maker.all(), found);
  maker.make([&](std::size_t plan, const sim::Trial& trial) { return runners[plan].run(trial); },
             [&](const sim::Run& run) {
               progress.count(classify(run.result) == sim::TrialClass::kSucceeded);
             });
}

/// What the page replays is made again, and kept as it goes. A run that another machine made, and
/// that comes out otherwise here, is left out and said.
void record_examples(const EvaluateLine& line, const Runners& runners,
                     sim::Evaluation& evaluation) {
  struct Made {
    std::size_t plan;
    const sim::Run* run;
    sim::Recording recording;
    bool same = false;
  };
  std::vector<Made> all;
  const std::size_t most = sim::kReplaysMax / evaluation.candidates.size();
  for (std::size_t plan = 0; plan < evaluation.candidates.size(); ++plan) {
    for (const sim::Run* run : sim::examples(evaluation.candidates[plan], most)) {
      all.push_back({plan, run, {}, false});
    }
  }
  fan_out(all.size(), line.threads, [&](std::size_t i, std::size_t) {
    Made& made = all[i];
    const sim::TrialResult result = runners[made.plan].record(made.run->trial, made.recording);
    made.same =
        sim::run_line("", {made.run->trial, result}, false) == sim::run_line("", *made.run, false);
  });
  for (Made& made : all) {
    const std::size_t number = made.run->trial.number;
    if (made.same && made.recording.moments().empty()) continue;  // no plan began
    if (made.same) {
      evaluation.candidates[made.plan].recordings.emplace(number, std::move(made.recording));
    } else {
      std::fprintf(stderr,
                   "tenon-evaluate: run %zu came out otherwise when it was made again, and cannot "
                   "be replayed; was it made by another machine?\n",
                   number);
    }
  }
}

/// One run of each plan, told step by step.
int replay(const EvaluateLine& line, const Cell& cell, const sim::Evaluation& evaluation) {
  FinalFiles files;
  for (std::size_t plan = 0; plan < evaluation.candidates.size(); ++plan) {
    const sim::Candidate& candidate = evaluation.candidates[plan];
    const sim::Trial trial = evaluation.trial(plan, *line.only);
    std::printf("%s, run %zu: %s%s, seed %llu (tenon-sim makes the same world)\n",
                candidate.file.c_str(), trial.number,
                out_text(evaluation.task, trial.distance).c_str(), sim::tilt_text(trial).c_str(),
                static_cast<unsigned long long>(trial.seed));
    if (!sim::made_for(candidate, evaluation.task)) std::printf("%s\n", sim::kOtherTask);
    RecordReport black_box;
    const sim::TrialResult result =
        sim::TrialRunner(cell, evaluation.task, candidate).tell(trial, line.black_box, black_box);
    std::printf(
        "%s\n%s\n", to_string(classify(result)),
        sim::run_line(candidate.hash, {trial, result}, evaluation.ranges.has_value()).c_str());
    if (!black_box.whole()) files.add_loss(loss_text(black_box));
  }
  return files.conclude("tenon-evaluate", 0);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  check_writable(folder / "x.svg");
}

void write_figures(FinalFiles& files, const fs::path& folder, const sim::Evaluation& evaluation) {
  for (const sim::FigureFile& file : sim::figure_files(evaluation)) {
    files.write({"--figures", folder / file.name}, file.svg);
  }
}

int evaluate(const EvaluateLine& line) {
  check_options(line);
  for (const std::string& file :
       {line.json, line.report, line.summary, line.junit, line.black_box}) {
    if (!file.empty()) check_writable(file);
  }
  if (!line.figures.empty()) make_folder(line.figures);
  const Cell cell = load_cell(line.cell);
  hw::check_bus_load(cell.robot);
  hw::check_response_times(cell.robot);
  sim::Evaluation evaluation = evaluation_of(line, cell);
  if (line.only) return replay(line, cell, evaluation);
  sim::check_bins(evaluation, line.count);
  const Runners runners = runners_of(cell, evaluation);
  make_runs(line, runners, evaluation);
  if (!line.report.empty()) record_examples(line, runners, evaluation);
  std::fputs(sim::describe(evaluation).c_str(), stdout);
  FinalFiles files;
  files.write({"--json", line.json}, sim::evaluation_json(evaluation));
  files.write({"--report", line.report}, sim::evaluation_html(evaluation));
  files.write({"--summary", line.summary}, sim::summary_json(evaluation));
  files.write({"--junit", line.junit}, sim::evaluation_junit(evaluation, line.min_success));
  if (!line.figures.empty()) write_figures(files, line.figures, evaluation);
  const std::string missed = line.min_success ? sim::shortfall(evaluation, *line.min_success) : "";
  if (!missed.empty()) std::fprintf(stderr, "tenon-evaluate: --min-success: %s\n", missed.c_str());
  return files.conclude("tenon-evaluate", missed.empty() ? 0 : 1);
}

// --- Command line -----------------------------------------------------------------------------

/// What is written of all runs, and what they must come to.
void add_files(CLI::App& app, EvaluateLine& line) {
  app.add_option("--json", line.json, "File for results and all runs");
  app.add_option("--report", line.report,
                 "File for an HTML page: paths, replays of failures, plots");
  app.add_option("--summary", line.summary,
                 "File for the results without the single runs, as JSON");
  app.add_option("--junit", line.junit,
                 "File for CI tools: JUnit's XML, a testsuite a plan, a testcase a run");
  app.add_option("--min-success", line.min_success,
                 "Proportion of each plan's runs that must succeed, such as 0.99: below it the "
                 "exit status is 1")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--figures", line.figures, "Folder for the page's plots, each an SVG file");
}

/// How the worlds of the runs differ.
void add_draws(CLI::App& app, EvaluateLine& line) {
  app.add_option("--experiment", line.experiment,
                 "Ranges to draw from how the world differs from what task and cell file say");
  std::string corners;
  for (const std::string& corner : sim::corner_names()) {
    corners.append(corners.empty() ? "" : "|").append(corner);
  }
  app.add_option("--corner", line.corner,
                 "Friction low or high and the held part drawn or largest, of what the task leaves "
                 "open, instead of what --experiment draws of them")
      ->type_name("TEXT:{" + corners + "}");
}

int parse_and_evaluate(int argc, char** argv) {
  EvaluateLine line;
  CLI::App app{
      "How plans fare in many drawn worlds: each run goes through the executor and the CAN "
      "protocol to the virtual arm, in virtual time.",
      "tenon-evaluate"};
  app.footer(
      "Run again, it goes on where it was stopped.\n\n"
      "Exit status:\n"
      "  0  all runs were made, however they ended\n"
      "  1  fewer than --min-success succeeded, or not all of what was asked for could be written\n"
      "  2  bad input, or a place that nothing can be written to\n\n"
      "Examples:\n"
      "  tenon-evaluate --cell hw/cells/gantry3.yaml --task planner/tasks/box_on_table_2d.yaml \\\n"
      "                 --plan plan.tnp -n 1000 --seed 1 --json out.json --report out.html");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", line.cell, "Cell file")->required();
  app.add_option("--task", line.task, "Task file, or a variant of one: TASK.yaml#VARIANT")
      ->required();
  app.add_option("--plan", line.plans, "Plan file; several meet the same worlds")->required();
  add_draws(app, line);
  app.add_option("-n", line.count, "Number of runs of each plan")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--seed", line.seed, "What is drawn follows from it and the run's number")
      ->check(CLI::Range(0.0, 9007199254740992.0).description("[0, 2^53]"))
      ->required();
  app.add_option("--threads", line.threads,
                 "Threads that make the runs; results do not depend on them")
      ->check(CLI::Range(1, 1024))
      ->default_str("all cores");
  app.add_option("--by", line.by,
                 "Break success down by a drawn quantity, or by two: friction=0.1:0.8:7")
      ->type_name("QUANTITY")
      ->expected(1, 2);
  app.add_option("--runs", line.runs, "Run log to go on with; default: --json's name with .jsonl");
  CLI::Option* shard =
      app.add_option("--shard", line.shard, "Only the I-th part of N of the runs: I/N")
          ->type_name("I/N")
          ->capture_default_str();
  CLI::Option* merge =
      app.add_option("--merge", line.merge, "Run logs of shards; what they lack is made");
  add_files(app, line);
  CLI::Option* only =
      app.add_option("--only", line.only, "Make one run again by its number, and tell it in full")
          ->check(CLI::Range(0, 10'000'000))
          ->excludes(shard)
          ->excludes(merge);
  app.add_option("--black-box", line.black_box,
                 "With --only and one plan: the run's last minute of cycles as CSV")
      ->needs(only);
  parse(app, argc, argv);
  return evaluate(line);
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("tenon-evaluate", [&] { return parse_and_evaluate(argc, argv); });
}
