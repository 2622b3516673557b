#pragma once
// What the runs of a plan come to. Pure; allocates.

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/statistics.h"

namespace tenon::sim {

/// A proportion with its 95 % interval.
struct Rate {
  std::size_t successes = 0;
  std::size_t count = 0;

  [[nodiscard]] double value() const {
    return count == 0 ? 0.0 : static_cast<double>(successes) / static_cast<double>(count);
  }
  [[nodiscard]] Interval interval() const { return wilson_interval(successes, count); }
};

/// Success of the draws that are not farther out.
struct RateWithin {
  double distance = 0.0;  ///< see shared/task/spread.h
  double mass = 0.0;      ///< the probability of such a draw
  Rate rate;
};

struct Quantiles {
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Over the runs that were done, how far off the part was before and after.
struct AxisError {
  int axis = 0;
  Moments final;
  Moments initial;
  /// Final standard deviation over the initial one.
  [[nodiscard]] double ratio() const {
    return initial.deviation > 0.0 ? final.deviation / initial.deviation : 0.0;
  }
};

/// "1/240", "3.4 times", or nothing where it cannot be told.
[[nodiscard]] std::string ratio_text(const AxisError& error);

/// Of a plan for which made_for() does not hold.
inline constexpr const char* kOtherTask =
    "the plan was made for another task, or another variant of it";
[[nodiscard]] inline bool made_for(const Candidate& candidate, const Task& task) {
  return candidate.plan.task_hash == task.hash;
}

struct Summary {
  Rate success;
  std::size_t stopped = 0;
  std::size_t done_but_wrong = 0;
  std::size_t begun = 0;                       ///< that forces and times are of
  std::size_t done = 0;                        ///< that `errors` are of
  std::vector<RateWithin> within;              ///< 2, 3 and c_p, ascending; or the bounds
  Rate promised;                               ///< of the last of these, see within_promise()
  bool tilts = false;                          ///< some world is tilted
  std::map<std::string, std::size_t> endings;  ///< of all runs, by name
  std::vector<AxisError> errors;               ///< of the search coordinates
  Moments error_norm_m;                        ///< of the runs that were done
  Quantiles error_norms_m;
  Quantiles contact_force_N;  ///< largest of a run; over all runs that began
  Quantiles duration_s;
};
[[nodiscard]] Summary summarise(const Task& task, const Candidate& candidate);

/// Success by one drawn quantity or two: a row for each bin of the second, or a single one.
[[nodiscard]] std::vector<std::vector<Rate>> break_down(const std::vector<Bins>& by,
                                                        const Candidate& candidate);

/// Runs that did not succeed, done but wrong before stopped, then by number.
[[nodiscard]] std::vector<const Run*> failures(const Candidate& candidate);

/// Runs that failed alike.
struct FailureKind {
  static constexpr std::size_t kExamplesMax = 3;
  std::vector<const Run*> examples;  ///< the first by number
  std::size_t count = 0;

  [[nodiscard]] const Run& first() const { return *examples.front(); }
};
/// Alike in class, ending, step and outcome. Done but wrong before stopped, then the most frequent.
[[nodiscard]] std::vector<FailureKind> kinds_of_failure(const Candidate& candidate);

/// One line that names every plan whose runs succeeded more rarely than that, and how often they
/// did; empty where none did. @param min_success proportion, 0 to 1
[[nodiscard]] std::string shortfall(const Evaluation& evaluation, double min_success);

/// What is worth to be seen again: the first examples of every kind of failure that began, those
/// of all kinds in turn, and the first run that succeeded. At most `most` of them.
[[nodiscard]] std::vector<const Run*> examples(const Candidate& candidate, std::size_t most);

/// The shell command that makes a run again.
[[nodiscard]] std::string replay_command(const Evaluation& evaluation, const Candidate& candidate,
                                         std::size_t number);

/// For people: a few lines a plan, and its first failures with the command that replays each.
[[nodiscard]] std::string describe(const Evaluation& evaluation);

}  // namespace tenon::sim
