// tenon-evaluate: many runs of plans through the real executor and CAN protocol on the virtual arm,
// in worlds that a seed draws. Only composes; see sim/README.md.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hw/bus_load.h"
#include "hw/response_times.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/evaluation_html.h"
#include "sim/evaluation/evaluation_json.h"
#include "sim/evaluation/figure_files.h"
#include "sim/evaluation/run_maker.h"
#include "sim/evaluation/summary.h"
#include "sim/main_evaluate_chain.h"
#include "sim/virtual_arm/environment_offset.h"

namespace {

using namespace tenon;
namespace fs = std::filesystem;

struct CommandLine {
  std::string cell;
  std::string task;
  std::vector<std::string> plans;
  std::string experiment;
  std::size_t count = 100;
  std::uint64_t seed = 0;
  std::size_t threads = 1;
  std::string shard = "1/1";
  std::vector<std::string> merge;
  std::optional<std::size_t> only;
  std::vector<std::string> by;
  std::string runs;
  std::string json;
  std::string report;
  std::string summary;
  std::string figures;
  std::string black_box;
};

// --- What is evaluated ------------------------------------------------------------------------

std::string hash_of(const std::string& bytes) {
  return format("%016llx", static_cast<unsigned long long>(config::fnv1a_64(bytes)));
}

/// Of cell, robot, task, experiment and this program: what a run depends on besides plan and
/// number.
std::string identity_of(const CommandLine& line, const Task& task) {
  std::string cell;
  for (const auto& file : cell_files(line.cell)) cell += config::read_file(file);
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::string program{std::istreambuf_iterator<char>(stream), {}};

  nlohmann::ordered_json identity;
  identity["tenon-evaluate"] = TENON_VERSION;
  identity["program"] = hash_of(program);
  identity["cell"] = hash_of(cell);
  identity["task"] = format("%016llx", static_cast<unsigned long long>(task.hash));
  identity["experiment"] =
      line.experiment.empty() ? "" : hash_of(config::read_file(line.experiment));
  identity["seed"] = line.seed;
  return identity.dump();
}

std::string replay_of(const CommandLine& line) {
  std::string text = "tenon-evaluate --cell " + shell_word(line.cell) + " --task " +
                     shell_word(line.task) + " --seed " + std::to_string(line.seed);
  if (!line.experiment.empty()) text += " --experiment " + shell_word(line.experiment);
  return text;
}

sim::Evaluation evaluation_of(const CommandLine& line, const Cell& cell) {
  sim::Evaluation evaluation;
  evaluation.task = load_task(line.task);
  evaluation.cell = cell.name;
  if (!line.experiment.empty()) evaluation.ranges = load_experiment(line.experiment);
  evaluation.seed = line.seed;
  evaluation.replay = replay_of(line);
  for (const std::string& by : line.by) evaluation.by.push_back(sim::parse_bins(by));
  for (const std::string& file : line.plans) {
    sim::Candidate candidate;
    candidate.file = file;
    candidate.hash = hash_of(config::read_file(file));
    candidate.plan = load_plan(file);
    candidate.start = sim::find_start(evaluation.task, candidate.plan.start_name);
    for (const sim::Candidate& other : evaluation.candidates) {
      if (!line.figures.empty() && fs::path(file).stem() == fs::path(other.file).stem()) {
        throw InputError("--figures " + line.figures + ": the figures of " + file + " and " +
                         other.file + " would have the same names; rename one of them");
      }
      if (other.hash == candidate.hash) {
        throw InputError("--plan " + file + ": is the same plan as " + other.file +
                         "; give it once");
      }
    }
    evaluation.candidates.push_back(std::move(candidate));
  }
  return evaluation;
}

/// A typing error in --by must not cost a thousand runs.
void check_bins(const sim::Evaluation& evaluation, std::size_t count) {
  for (const sim::Bins& bins : evaluation.by) {
    bool any = false;
    for (std::size_t number = 0; number < count && !any; ++number) {
      any = bins.bin_of(evaluation.trial(0, number)).has_value();
    }
    if (!any) {
      throw InputError("--by " + bins.quantity +
                       ": no draw of the experiment falls in the given range");
    }
  }
}

// --- Many runs --------------------------------------------------------------------------------

/// One line that is written over, on a terminal alone.
class Progress {
 public:
  Progress(std::size_t all, std::size_t before) : all_(all), before_(before) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void count(bool succeeded) {
    ++made_;
    succeeded_ += succeeded;
    if (!terminal_) return;
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
    const double rate_ps = static_cast<double>(made_) / std::max(elapsed_s, 1e-3);
    const std::size_t so_far = before_ + made_;
    constexpr std::size_t kWidth = 30;
    const std::string bar(kWidth * so_far / all_, '#');
    std::fprintf(stderr,
                 "\r\033[K[%-30s] %zu of %zu runs, %.1f %% succeeded, %.2f runs/s, %.0f s left",
                 bar.c_str(), so_far, all_,
                 1e2 * static_cast<double>(succeeded_) / static_cast<double>(made_), rate_ps,
                 static_cast<double>(all_ - so_far) / rate_ps);
    shown_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t all_;
  std::size_t before_;
  std::size_t made_ = 0;
  std::size_t succeeded_ = 0;
  bool terminal_ = ::isatty(STDERR_FILENO) == 1;
  bool shown_ = false;
  Clock::time_point begin_ = Clock::now();
};

std::string log_file_of(const CommandLine& line) {
  if (!line.runs.empty() || line.json.empty()) return line.runs;
  return fs::path(line.json).replace_extension(".jsonl").string();
}

void make_runs(const CommandLine& line, const Cell& cell, sim::Evaluation& evaluation) {
  std::vector<PlanRunner> runners;
  for (const sim::Candidate& candidate : evaluation.candidates) {
    runners.emplace_back(cell, evaluation.task, candidate);
  }

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
  if (found > 0) std::printf("%zu of %zu runs are there already\n", found, maker.all());

  Progress progress(maker.all(), found);
  maker.make([&](std::size_t plan, const sim::Trial& trial) { return runners[plan].run(trial); },
             [&](const sim::Run& run) {
               progress.count(classify(run.result) == sim::TrialClass::kSucceeded);
             });
}

/// One run of each plan, told step by step.
int replay(const CommandLine& line, const Cell& cell, const sim::Evaluation& evaluation) {
  for (std::size_t plan = 0; plan < evaluation.candidates.size(); ++plan) {
    const sim::Candidate& candidate = evaluation.candidates[plan];
    const sim::Trial trial = evaluation.trial(plan, *line.only);
    std::printf(
        "%s, run %zu: %.2f standard deviations off, seed %llu (tenon-sim makes the same world)\n",
        candidate.file.c_str(), trial.number, trial.distance,
        static_cast<unsigned long long>(trial.seed));
    const sim::TrialResult result =
        PlanRunner(cell, evaluation.task, candidate).tell(trial, line.black_box);
    std::printf(
        "%s\n%s\n", to_string(classify(result)),
        sim::run_line(candidate.hash, {trial, result}, evaluation.ranges.has_value()).c_str());
  }
  return 0;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  check_writable(folder / "x.svg");
}

void write_figures(const fs::path& folder, const sim::Evaluation& evaluation) {
  for (const sim::FigureFile& file : sim::figure_files(evaluation)) {
    write_file(folder / file.name, file.svg);
  }
}

/// What is written, and every log that is read, must be a file of its own.
void check_apart(const CommandLine& line) {
  std::vector<std::string> files = line.merge;
  for (const std::string& file :
       {log_file_of(line), line.json, line.report, line.summary, line.black_box}) {
    if (!file.empty()) files.push_back(file);
  }
  std::set<fs::path> known;
  for (const std::string& file : files) {
    if (known.insert(fs::weakly_canonical(fs::absolute(file))).second) continue;
    throw InputError(file + ": is given for two files, or is the run log of --json; give each a " +
                     "name of its own");
  }
}

int evaluate(const CommandLine& line) {
  check_apart(line);
  if (!line.black_box.empty() && line.plans.size() != 1) {
    throw InputError("--black-box " + line.black_box + ": holds one run; give one --plan");
  }
  if (line.only && !(line.json + line.report + line.summary + line.figures).empty()) {
    throw InputError(
        "--only: tells one run here; leave out --json, --report, --summary and --figures");
  }
  for (const std::string& file : {line.json, line.report, line.summary, line.black_box}) {
    if (!file.empty()) check_writable(file);
  }
  if (!line.figures.empty()) make_folder(line.figures);
  const Cell cell = load_cell(line.cell);
  hw::check_bus_load(cell.robot);
  hw::check_response_times(cell.robot);
  sim::Evaluation evaluation = evaluation_of(line, cell);
  if (line.only) return replay(line, cell, evaluation);
  check_bins(evaluation, line.count);
  make_runs(line, cell, evaluation);
  if (!line.json.empty()) write_file(line.json, sim::evaluation_json(evaluation));
  if (!line.report.empty()) write_file(line.report, sim::evaluation_html(evaluation));
  if (!line.summary.empty()) write_file(line.summary, sim::summary_json(evaluation));
  if (!line.figures.empty()) write_figures(line.figures, evaluation);
  std::fputs(sim::describe(evaluation).c_str(), stdout);
  return 0;
}

// --- Command line -----------------------------------------------------------------------------

int parse_and_evaluate(int argc, char** argv) {
  CommandLine line;
  CLI::App app{
      "How plans fare in many drawn worlds: each run goes through the executor and the CAN "
      "protocol to the virtual arm, in virtual time.",
      "tenon-evaluate"};
  app.footer(
      "Example:\n  tenon-evaluate --cell hw/cells/gantry3.yaml --task "
      "planner/tasks/box_on_table_2d.yaml \\\n                 --plan plan.tnp -n 1000 --seed 1 "
      "--threads 2 --json out.json --report out.html\n\n"
      "Run again, it goes on where it was stopped. Exit status: 0 all runs were made, however they "
      "ended; 2 bad input.");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", line.cell, "cell file")->required();
  app.add_option("--task", line.task, "task file, or a variant of one: TASK.yaml#VARIANT")
      ->required();
  app.add_option("--plan", line.plans, "plan file; several meet the same worlds")->required();
  app.add_option("--experiment", line.experiment,
                 "ranges to draw from how the world differs from what task and cell file say");
  app.add_option("-n", line.count, "number of runs of each plan")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--seed", line.seed, "what is drawn follows from it and the run's number")
      ->check(CLI::Range(0.0, 9007199254740992.0).description("[0, 2^53]"))
      ->required();
  app.add_option("--threads", line.threads, "results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--by", line.by, "break success down by a drawn quantity: friction=0.1:0.8:7")
      ->expected(1, 2);
  app.add_option("--runs", line.runs, "run log to go on with; default: --json's name with .jsonl");
  CLI::Option* shard =
      app.add_option("--shard", line.shard, "only the I-th part of N of the runs: I/N")
          ->capture_default_str();
  CLI::Option* merge =
      app.add_option("--merge", line.merge, "run logs of shards; what they lack is made");
  app.add_option("--json", line.json, "file for results and all runs");
  app.add_option("--report", line.report, "file for an HTML page with the plots");
  app.add_option("--summary", line.summary,
                 "file for the results without the single runs, as JSON");
  app.add_option("--figures", line.figures, "folder for the page's plots, each an SVG file");
  CLI::Option* only =
      app.add_option("--only", line.only, "make one run again by its number, and tell it in full")
          ->check(CLI::Range(0, 10'000'000))
          ->excludes(shard)
          ->excludes(merge);
  app.add_option("--black-box", line.black_box,
                 "with --only and one plan: the run's last minute of cycles as CSV")
      ->needs(only);
  parse(app, argc, argv);
  return evaluate(line);
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("tenon-evaluate", [&] { return parse_and_evaluate(argc, argv); });
}
