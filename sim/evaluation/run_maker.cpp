#include "sim/evaluation/run_maker.h"

#include <cstdio>
#include <map>
#include <utility>

#include "shared/base/error.h"

namespace tenon::sim {

Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  if (text.find('-') != std::string::npos ||
      std::sscanf(text.c_str(), "%zu/%zu%c", &shard.index, &shard.count, &rest) != 2 ||
      shard.index < 1 || shard.index > shard.count) {
    throw InputError("--shard \"" + text + "\": must be I/N with 1 <= I <= N, such as 1/8");
  }
  --shard.index;
  return shard;
}

RunMaker::RunMaker(Evaluation& evaluation, const Parameters& parameters)
    : evaluation_(evaluation), threads_(parameters.threads) {
  if (!parameters.log.empty()) {
    log_.emplace(parameters.log, parameters.identity);
    take_up(parameters.log, log_->found());
  }
  for (const std::filesystem::path& file : parameters.others) {
    take_up(file, read_run_log(file, parameters.identity));
  }
  std::vector<std::map<std::size_t, Run>> wanted(evaluation.candidates.size());
  for (const Job& job :
       jobs_of(wanted.size(), parameters.count, parameters.shard.index, parameters.shard.count)) {
    ++all_;
    auto known = evaluation.candidates[job.plan].runs.extract(job.number);
    if (known.empty()) {
      missing_.push_back(job);
    } else {
      wanted[job.plan].insert(std::move(known));
    }
  }
  for (std::size_t plan = 0; plan < wanted.size(); ++plan) {
    evaluation.candidates[plan].runs = std::move(wanted[plan]);
  }
}

void RunMaker::take_up(const std::filesystem::path& file, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string where = file.string() + ":" + std::to_string(i + 2) + ": ";
    const std::optional<RunRecord> record = parse_run_line(lines[i]);
    if (!record) throw InputError(where + "is damaged; remove the line, and its run is made again");
    for (std::size_t plan = 0; plan < evaluation_.candidates.size(); ++plan) {
      Candidate& candidate = evaluation_.candidates[plan];
      if (candidate.hash != record->plan) continue;
      const Run run{evaluation_.trial(plan, record->number), record->result};
      const auto [known, is_new] = candidate.runs.emplace(record->number, run);
      if (line_of(candidate, known->second) != lines[i]) {
        throw InputError(
            where + "contradicts " +
            (is_new ? "what the seed draws for run " : "what stands elsewhere about run ") +
            std::to_string(record->number) + "; remove the file");
      }
    }
  }
}

void RunMaker::make(const Execute& execute, const std::function<void(const Run&)>& ended) {
  run_all(
      missing_, threads_,
      [&](const Job& job) {
        Trial trial = evaluation_.trial(job.plan, job.number);
        TrialResult result = execute(job.plan, trial);
        return Run{std::move(trial), std::move(result)};
      },
      [&](const Job& job, Run run) {
        Candidate& candidate = evaluation_.candidates[job.plan];
        if (log_) log_->append(line_of(candidate, run));
        ended(candidate.runs.emplace(job.number, std::move(run)).first->second);
      });
  missing_.clear();
}

}  // namespace tenon::sim
