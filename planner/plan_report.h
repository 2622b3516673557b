#pragma once
// What planning came to: a plan or the reason why there is none, and what it took. Plain data; any
// thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/belief/successor.h"
#include "planner/judge/certification.h"
#include "planner/judge/judge_effort.h"
#include "planner/judge/validation.h"
#include "planner/search/mha_search.h"
#include "shared/plan/plan.h"

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
  kMoveLimit = 8,     ///< as many moves as the budget allows have been simulated
  kOutOfReach = 9,    ///< the cell's arm cannot hold the start or the goal
};
[[nodiscard]] const char* to_string(PlanStatus status);

/// Seconds spent before judging.
struct PlannerTimes {
  double attractors_s = 0.0;
  double search_s = 0.0;
};

/// One of the searches that planning made, each without what refuted the paths before.
struct SearchRound {
  SearchParameters parameters;
  std::vector<std::size_t> expansions;  ///< by heuristic, see PlanReport
  std::size_t steps = 0;                ///< of its path; 0: none
  double cost = 0.0;                    ///< of its path
  double lower_bound = 0.0;             ///< of the optimum
  std::string outcome;                  ///< in words: what came of its path
};
[[nodiscard]] SearchRound round_of(const SearchParameters& parameters, const SearchResult& search,
                                   std::size_t heuristics);

/// The last round's path is the plan, and no other one's is any more.
void last_is_the_plan(std::vector<SearchRound>& rounds);

struct PlanReport {
  PlanMethod method = PlanMethod::kMha;
  PlanStatus status = PlanStatus::kExhausted;
  std::string reason;               ///< one line where it is not kPlanned
  std::optional<Plan> plan;         ///< where it is kPlanned
  std::vector<std::uint8_t> bytes;  ///< of the plan, as a file has them

  Certification certification;  ///< of the plan
  Validation validation;        ///< of the plan, see validate()

  // What it took.
  SearchResult search;              ///< the last one that the plan is of, else the last one
  std::vector<SearchRound> rounds;  ///< all of them
  /// What chooses among the open states, in words: the anchor, then each guide.
  std::vector<std::string> heuristics;
  std::size_t expansions = 0;        ///< of all searches
  std::size_t expansions_first = 0;  ///< of the first of them, before anything was refuted
  std::size_t guides = 0;            ///< that led the searches
  std::string guide;                 ///< that was followed to the letter; empty: a search's path
  CoordinateMask unsettled = 0;      ///< see Attractors
  std::size_t states = 0;
  std::vector<std::string> refusals;  ///< what was refuted, and why
  std::vector<std::string> adapted;   ///< what the cell changed in the task, see fit_to_cell()
  SuccessorEngine::Counters search_moves;
  SuccessorEngine::Counters attractor_moves;
  JudgeEffort judging;
  PlannerTimes times;
};

}  // namespace tenon::planner
