#pragma once
// Makes the runs of an evaluation that are not there yet, and keeps each as it ends. What it leaves
// behind does not depend on threads, interruptions or shards. Offline; made and used on one thread,
// which starts others.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/run_all.h"
#include "sim/evaluation/run_log.h"

namespace tenon::sim {

/// One of several parts of the runs.
struct Shard {
  std::size_t index = 0;  ///< below `count`
  std::size_t count = 1;
};
/// "I/N" with 1 <= I <= N. @throws InputError for anything else
[[nodiscard]] Shard parse_shard(const std::string& text);

class RunMaker {
 public:
  struct Parameters {
    std::size_t count = 100;  ///< runs of each plan, over all shards
    std::size_t threads = 1;
    Shard shard;
    std::string identity;       ///< of what a run depends on besides plan and number
    std::filesystem::path log;  ///< empty: none is kept
    std::vector<std::filesystem::path> others;  ///< logs of other shards, left as they are
  };

  /// One run of a plan; follows from plan and trial alone. Called on any thread.
  using Execute = std::function<TrialResult(std::size_t plan, const Trial& trial)>;

  /// Takes up what the logs hold of this shard's runs; drops all other runs of the evaluation,
  /// which must outlive this. @throws InputError where a log cannot be used, or two disagree about
  /// a run
  RunMaker(Evaluation& evaluation, const Parameters& parameters);

  [[nodiscard]] std::size_t all() const { return all_; }
  [[nodiscard]] std::size_t missing() const { return missing_.size(); }
  /// That the log's last line was, and has been cut off.
  [[nodiscard]] bool log_was_torn() const { return log_ && log_->was_torn(); }

  /// Once. @param ended called with each run once it is kept, by one thread at a time
  void make(const Execute& execute, const std::function<void(const Run&)>& ended);

 private:
  void take_up(const std::filesystem::path& file, const std::vector<std::string>& lines);
  [[nodiscard]] std::string line_of(const Candidate& candidate, const Run& run) const {
    return run_line(candidate.hash, run, evaluation_.ranges.has_value());
  }

  Evaluation& evaluation_;
  std::size_t threads_;
  std::optional<RunLog> log_;
  std::size_t all_ = 0;
  std::vector<Job> missing_;
};

}  // namespace tenon::sim
