#include "planner/plan_report.h"

namespace tenon::planner {

const char* to_string(PlanStatus status) {
  switch (status) {
    case PlanStatus::kPlanned:
      return "planned";
    case PlanStatus::kInCollision:
      return "in collision";
    case PlanStatus::kAlreadyAtGoal:
      return "already at the goal";
    case PlanStatus::kExhausted:
      return "open list exhausted";
    case PlanStatus::kNoAttractor:
      return "no attractor, open list exhausted";
    case PlanStatus::kTimeLimit:
      return "time limit";
    case PlanStatus::kExpansionLimit:
      return "expansion limit";
    case PlanStatus::kNotCertified:
      return "not certified";
    case PlanStatus::kMoveLimit:
      return "move limit";
    case PlanStatus::kOutOfReach:
      return "out of reach";
  }
  return "?";
}

SearchRound round_of(const SearchParameters& parameters, const SearchResult& search,
                     std::size_t heuristics) {
  SearchRound round;
  round.parameters = parameters;
  round.expansions.resize(heuristics);
  for (const std::size_t queue : search.queues) ++round.expansions[queue];
  round.lower_bound = search.lower_bound;
  if (!search.has_path) {
    round.outcome = to_string(search.status);
    return round;
  }
  round.steps = search.path.size();
  round.cost = search.cost;
  return round;
}

void last_is_the_plan(std::vector<SearchRound>& rounds) {
  constexpr const char* kPlan = "the plan";
  for (SearchRound& round : rounds) {
    if (round.outcome == kPlan) round.outcome = "a plan, until a cheaper one was found";
  }
  rounds.back().outcome = kPlan;
}

}  // namespace tenon::planner
