#pragma once
// From a task to a certified and validated plan: attractors, search, certification of the very
// bytes, validation, and back to the search without the edge that was contradicted.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/attractors.h"
#include "planner/certification.h"
#include "planner/mha_search.h"
#include "planner/plan_builder.h"
#include "planner/successor.h"
#include "planner/validation.h"

namespace tenon::planner {

enum class PlanStatus : std::uint8_t {
  kPlanned = 0,
  kInCollision = 1,    ///< the start, a particle of it, or the goal
  kAlreadyAtGoal = 2,  ///< nothing to plan: no step is needed
  kExhausted = 3,      ///< the searched graph has no path left
  kNoAttractor = 4,    ///< likewise, and no push makes the start more certain
  kTimeLimit = 5,
  kExpansionLimit = 6,
  kNotCertified = 7,  ///< every path that was found was refuted, as often as the budget allows
};
[[nodiscard]] const char* to_string(PlanStatus status);

struct PlannerOptions {
  /// A baseline plans and certifies its single particle alone. Its plan runs at contact speed
  /// throughout, checks no envelope, and is validated as any other but never refused for it.
  PlanMethod method = PlanMethod::kMha;
  std::size_t threads = 1;
  CellAssumptions assumptions;
  ValidationParameters validation;
  std::size_t expansions_max = 5000;  ///< of one search
  std::size_t rounds_max = 100;       ///< searches, each without what the last ones had refuted
  /// Told, in a line, what has just been done; may be empty.
  std::function<void(const std::string&)> progress;
};

/// Seconds spent in each part.
struct PlannerTimes {
  double attractors_s = 0.0;
  double search_s = 0.0;
  double certification_s = 0.0;
  double validation_s = 0.0;
};

struct PlanReport {
  PlanMethod method = PlanMethod::kMha;
  PlanStatus status = PlanStatus::kExhausted;
  std::string reason;  ///< one line where it is not kPlanned
  std::optional<Plan> plan;
  std::vector<std::uint8_t> bytes;   ///< of the plan, as a file has them
  SearchResult search;               ///< the last one
  std::size_t expansions = 0;        ///< of all searches
  std::size_t expansions_first = 0;  ///< of the first of them, before anything was refuted
  std::size_t attractors = 0;
  std::size_t states = 0;
  std::vector<std::string> refusals;  ///< what was refuted, and why
  std::vector<std::string> adapted;   ///< what the cell changed in the task, see fit_to_cell()
  SuccessorEngine::Counters search_moves;
  SuccessorEngine::Counters attractor_moves;
  std::uint64_t certification_moves = 0;
  std::uint64_t validation_moves = 0;
  Certification certification;
  Validation validation;  ///< by the draws of kEstimateSeed
  PlannerTimes times;
};

/// Results depend on task, start and options, not on the number of threads; where the time limit
/// strikes depends on the clock.
/// @param now_s a clock that only grows, for the task's time limit and the times of the report
/// @throws InputError where a plan cannot be represented
[[nodiscard]] PlanReport make_plan(const Task& task, const Start& start, const Rollout& rollout,
                                   const PlannerOptions& options,
                                   const std::function<double()>& now_s);

/// Empty where start, particles and goal are free with the part as large as it may be; otherwise a
/// line that says what is not, where, and what to do.
[[nodiscard]] std::string collision(const Task& task, const Start& start, Rollout& rollout);

}  // namespace tenon::planner
