#include "sim/main_evaluate_input.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "shared/base/error.h"
#include "shared/base/fnv.h"
#include "shared/base/text.h"
#include "shared/config/command_line.h"
#include "shared/config/file_options.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/task/find_start.h"
#include "sim/evaluation/corner.h"

namespace tenon {
namespace {

namespace fs = std::filesystem;

std::string hex(std::uint64_t hash) {
  return format("%016llx", static_cast<unsigned long long>(hash));
}

std::string hash_of(const std::string& bytes) { return hex(fnv1a_64(bytes)); }

/// Of a file that need not fit into memory.
std::string hash_of_file(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1 << 16> part;
  std::uint64_t hash = kFnv1aOfNothing;
  while (file.read(part.data(), part.size()), file.gcount() > 0) {
    hash = fnv1a_64({part.data(), static_cast<std::size_t>(file.gcount())}, hash);
  }
  return hex(hash);
}

std::string replay_of(const EvaluateLine& line) {
  std::string text = "tenon-evaluate --cell " + shell_word(line.cell) + " --task " +
                     shell_word(line.task) + " --seed " + std::to_string(line.seed);
  if (!line.experiment.empty()) text += " --experiment " + shell_word(line.experiment);
  if (!line.corner.empty()) text += " --corner " + line.corner;
  return text;
}

/// What is written, and every log that is read, must be a file of its own.
void check_files(const EvaluateLine& line) {
  std::vector<FileOption> written = {
      {"the run log", log_file_of(line)}, {"--json", line.json},   {"--report", line.report},
      {"--summary", line.summary},        {"--junit", line.junit}, {"--black-box", line.black_box}};
  for (const std::string& log : line.merge) written.push_back({"--merge", log});
  std::vector<FileOption> read = {
      {"--cell", line.cell}, {"--task", line.task}, {"--experiment", line.experiment}};
  for (const std::string& plan : line.plans) read.push_back({"--plan", plan});
  check_apart(written, read);
}

void check_other(const EvaluateLine& line, const sim::Candidate& candidate,
                 const sim::Candidate& other) {
  if (!line.figures.empty() && fs::path(candidate.file).stem() == fs::path(other.file).stem()) {
    throw InputError("--figures " + line.figures + ": the figures of " + candidate.file + " and " +
                     other.file + " would have the same names; rename one of them");
  }
  if (other.hash == candidate.hash) {
    throw InputError("--plan " + candidate.file + ": is the same plan as " + other.file +
                     "; give it once");
  }
}

}  // namespace

std::string identity_of(const EvaluateLine& line, const Task& task) {
  std::string cell;
  for (const auto& file : cell_files(line.cell)) cell += config::read_file(file);

  nlohmann::ordered_json identity;
  identity["tenon-evaluate"] = TENON_VERSION;
  identity["program"] = hash_of_file("/proc/self/exe");
  identity["cell"] = hash_of(cell);
  identity["task"] = hex(task.hash);
  identity["experiment"] =
      line.experiment.empty() ? "" : hash_of(config::read_file(line.experiment));
  identity["corner"] = line.corner;
  identity["seed"] = line.seed;
  return identity.dump();
}

std::string log_file_of(const EvaluateLine& line) {
  if (!line.runs.empty() || line.json.empty()) return line.runs;
  return fs::path(line.json).replace_extension(".jsonl").string();
}

void check_options(const EvaluateLine& line) {
  check_files(line);
  if (!line.black_box.empty() && line.plans.size() != 1) {
    throw InputError("--black-box " + line.black_box + ": holds one run; give one --plan");
  }
  const std::string of_many = line.json + line.report + line.summary + line.figures + line.junit;
  if (line.only && (!of_many.empty() || line.min_success)) {
    throw InputError(
        "--only: tells one run here; leave out --json, --report, --summary, --figures, --junit and "
        "--min-success");
  }
}

sim::Evaluation evaluation_of(const EvaluateLine& line, const Cell& cell) {
  sim::Evaluation evaluation;
  evaluation.task = load_task(line.task);
  evaluation.cell = cell;
  if (!line.experiment.empty()) evaluation.ranges = load_experiment(line.experiment);
  if (!line.corner.empty()) {
    evaluation.ranges =
        sim::at_corner(evaluation.ranges.value_or(WorldRanges{}), line.corner, evaluation.task);
  }
  evaluation.seed = line.seed;
  evaluation.replay = replay_of(line);
  for (const std::string& by : line.by) evaluation.by.push_back(sim::parse_bins(by));
  for (const std::string& file : line.plans) {
    sim::Candidate candidate;
    candidate.file = file;
    candidate.hash = hash_of(config::read_file(file));
    candidate.plan = load_plan(file);
    candidate.start = start_or_first(evaluation.task, candidate.plan.start_name);
    for (const sim::Candidate& other : evaluation.candidates) check_other(line, candidate, other);
    evaluation.candidates.push_back(std::move(candidate));
  }
  return evaluation;
}

}  // namespace tenon
