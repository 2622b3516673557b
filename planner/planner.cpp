#include "planner/planner.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include "planner/belief/belief_summary.h"
#include "planner/belief/corners.h"
#include "planner/belief/remembered_rollout.h"
#include "planner/belief/rollout_pool.h"
#include "planner/calibration_effort.h"
#include "planner/collision.h"
#include "planner/goal_certainty.h"
#include "planner/held_errors.h"
#include "planner/judge/path_judge.h"
#include "planner/progress.h"
#include "planner/search/contact_greedy.h"
#include "planner/search/goal_attractors.h"
#include "planner/search/guide_way.h"
#include "planner/search/touch_turns.h"
#include "planner/search_moves.h"
#include "planner/searched_graph.h"
#include "planner/wording.h"
#include "shared/plan/codec.h"

namespace tenon::planner {
namespace {

// By how much of what they exceed 1 by the weights are lowered, and where they become 1.
constexpr double kLowered = 0.5;
constexpr double kLeastShare = 0.1;

// So many moves are simulated for a first search before guides are followed to the letter. Where a
// search finds a path at all without long detours, it has found it by then.
constexpr std::uint64_t kFirstMoves = 1000;
// So many starts that its way has missed make the same guide try again.
constexpr int kTriesAGuide = 6;

class Planning {
 public:
  Planning(const Task& task, const Start& start, const Rollout& rollout,
           const PlannerOptions& options, const ClockSeconds& now_s)
      : task_(task),
        start_(start),
        options_(options),
        assumptions_(stored_assumptions(task, options.assumptions)),
        now_s_(now_s ? now_s : [] { return 0.0; }),
        progress_(options.progress, now_s_),
        pool_(RememberedRollout(rollout), options.threads),
        search_pool_(options.search_physics ? *options.search_physics : rollout, options.threads),
        succ_(search_pool_, search_move(task, start, assumptions_), search_step_us(task)),
        true_succ_(pool_, search_move(task, start, assumptions_), task.rollout_step_us),
        long_succ_(search_pool_, long_move(task, search_move(task, start, assumptions_)),
                   search_step_us(task)),
        judge_(task, start, {options.method, assumptions_, options.draws, options.reach}, pool_,
               now_s_),
        errors_(task) {
    report_.method = options.method;
    judge_.stop_when([this] { return !report_.plan && out_of_time(); });
    for (RolloutPool* pool : {&pool_, &search_pool_}) {
      if (options.progress) pool->after_each_move([this] { tell_if_silent(); });
    }
  }

  /// Guides, and then in turn: search a path, judge it, learn from what refuted it.
  PlanReport run() {
    const std::string overlap = collision(task_, start_, pool_.front());
    if (!overlap.empty()) return ended(PlanStatus::kInCollision, overlap);
    const std::string beyond = enter_reach();
    if (!beyond.empty()) return ended(PlanStatus::kOutOfReach, beyond);
    const Belief start = held(start_belief(task_, start_, options_.method));
    if (at_goal(summarise(start, task_), task_)) {
      return ended(PlanStatus::kAlreadyAtGoal, already_at_goal(start_));
    }
    const Attractors attractors = guides_from(start);
    searched_.emplace(task_, start, attractors, succ_);
    for (const CalibrationErrors& errors : errors_to_hold(task_)) {
      if (errors != errors_to_hold(task_).front()) progress_.tell(less_to_hold(errors));
      effort_.begin(moves_simulated(), succ_.counters());
      judge_.hold(errors);
      errors_.hold(errors);
      round_ = 0;
      if (found(start, attractors)) return improve(), ended(PlanStatus::kPlanned, "");
      const bool less_may = effort_.refuted() || (errors.sensor_error_m > 0.0 && !is_baseline());
      if (!less_may || out_of_time() || out_of_moves()) break;
    }
    if (!report_.search.has_path || out_of_time()) return without_path();
    return ended(PlanStatus::kNotCertified, every_path_refuted(report_, options_.rounds_max));
  }

 private:
  /// Guides followed to the letter, or a search along them. @return whether there is a plan
  bool found(const Belief& start, const Attractors& attractors) {
    searched_->begin_from(start);
    const bool in_turn = !is_baseline() && task_.motion.carried_axes;
    if (in_turn && followed_in_turn(attractors)) return true;
    if (in_turn && errors_.less_may_be_felt()) return false;
    searched_->begin_from(start);
    const auto enough = [this] {
      return !is_baseline() && effort_.searched(succ_.counters()) >= kFirstMoves;
    };
    if (searched([&] { return out_of_budget() || enough(); })) return true;
    const auto led = [this](const Guide& guide) { return leads(guide); };
    return enough() && (std::ranges::any_of(attractors.candidates, led) ||
                        searched([this] { return out_of_budget(); }));
  }

  /// From here on what the arm cannot make does not exist. @return why there is no plan then
  std::string enter_reach() {
    if (options_.reach == nullptr) return {};
    std::string why;
    reach_ = reach_of_moves(task_, start_, assumptions_, *options_.reach, why);
    if (!reach_) return why;
    for (SuccessorEngine* succ : {&succ_, &true_succ_, &long_succ_}) succ->within(*reach_);
    return {};
  }

  /// Whatever takes long is made of many moves, so none of it is silent for long.
  void tell_if_silent() {
    if (progress_.is_silent()) progress_.tell(still(doing_, moves_simulated(), states()));
  }

  [[nodiscard]] bool out_of_time() const { return progress_.since_began_s() > task_.time_limit_s; }
  [[nodiscard]] bool out_of_moves() const { return moves_simulated() >= options_.moves_max; }
  [[nodiscard]] bool out_of_budget() const {
    return out_of_moves() || out_of_time() || effort_.spent(moves_simulated());
  }

  [[nodiscard]] std::uint64_t moves_simulated() const {
    return succ_.counters().rollouts + true_succ_.counters().rollouts +
           long_succ_.counters().rollouts + judge_.effort().moves();
  }
  [[nodiscard]] std::size_t states() const { return searched_ ? searched_->states() : 0; }

  /// Such a planner has nothing but its one particle.
  [[nodiscard]] bool is_baseline() const { return options_.method != PlanMethod::kMha; }

  /// In the cell, by its arm where one is asked.
  [[nodiscard]] Belief held(Belief belief) const {
    Belief held =
        in_cell(std::move(belief), assumptions_.contact_stiffness_Npm, assumptions_.latency_max_s);
    if (reach_) held.arm = reach_->start();
    return held;
  }

  Attractors guides_from(const Belief& start) {
    const auto stop = [this] { return out_of_budget(); };
    const auto turns = [this] { return touched_in_turn(corners()); };
    Attractors attractors = timed(now_s_, report_.times.attractors_s, [&] {
      return is_baseline() ? Attractors{{}, {}, goal_attractors(task_, start, long_succ_), 0, {}}
                           : find_attractors(task_, start, long_succ_, pool_.front(), stop, turns);
    });
    report_.guides = attractors.guides.size();
    report_.heuristics = heuristic_names(attractors.guides);
    report_.unsettled = attractors.unsettled;
    progress_.tell(guides_found(attractors.guides, long_succ_.counters().rollouts));
    return attractors;
  }

  /// Several errors at their largest at once: what touches have to hold for that turn the part.
  [[nodiscard]] Belief corners() const { return held(corner_belief(errors_.task(), start_)); }

  std::vector<Guide> touched_in_turn(const Belief& starts) {
    const std::function<bool()> stop = [this] { return out_of_budget(); };
    return TouchTurns(task_, starts, start_.pose, succ_, search_pool_.front(), stop).find();
  }

  /// Starts that were not known, and that the guides do not lead, have others looked for that hold
  /// for them too. A guide that does not lead all corners at once may lead the tips, and what of
  /// the corners its way then misses: but not where less may be held instead.
  bool followed_in_turn(const Attractors& attractors) {
    const Belief tips = searched_->start();
    for (const Particle& corner : corners().particles) searched_->add(corner);
    const auto leads_from_some = [&](const Guide& guide) {
      if (errors_.less_may_be_felt()) return settles(guide, task_) && leads(guide);
      if (leads(guide)) return true;
      const Belief all = searched_->start();
      searched_->begin_from(tips);
      if (leads(guide)) return true;
      searched_->begin_from(all);
      return false;
    };
    const auto known = [this] { return searched_->start().particles.size(); };
    std::size_t before = known();
    std::vector<Guide> guides = errors_.felt_less() ? guides_in_turn(corners()) : attractors.turns;
    while (std::none_of(guides.begin(), guides.end(), leads_from_some)) {
      if (known() == before || errors_.less_may_be_felt() || out_of_budget()) return false;
      before = known();
      guides = guides_in_turn(searched_->start());
    }
    return true;
  }

  std::vector<Guide> guides_in_turn(const Belief& starts) {
    doing_ = "looking for guides";
    const auto touched = [&] { return touched_in_turn(starts); };
    std::vector<Guide> guides = timed(now_s_, report_.times.attractors_s, touched);
    progress_.tell(guides_found(guides, long_succ_.counters().rollouts));
    return guides;
  }

  /// Searches, each without what the ones before had refuted. @return whether there is a plan
  bool searched(const std::function<bool()>& stop) {
    for (; round_ < options_.rounds_max; ++round_) {
      search({task_.w1, task_.w2, options_.expansions_max}, stop);
      if (!report_.search.has_path) return false;
      const std::vector<Vector6> path = searched_->displacements(report_.search.path);
      Judgement judgement = judge_.judge(path);
      if (auto* judged = std::get_if<JudgedPlan>(&judgement)) {
        keep(std::move(*judged), path, report_.search);
        return true;
      }
      if (std::holds_alternative<Undecided>(judgement)) return false;
      learn(std::get<Refutation>(judgement));
    }
    return false;
  }

  /// Follows a guide to the letter. A start that was not known makes the next try take another way;
  /// one that was, and did otherwise than the search had it, makes the next tries go by what
  /// judges.
  bool leads(const Guide& guide) {
    SuccessorEngine* succ = &succ_;
    for (int tries = 0; tries < kTriesAGuide && !out_of_budget(); ++tries) {
      doing_ = "following guides";
      std::string left;
      const auto way = timed(now_s_, report_.times.search_s, [&] {
        return follow_guide(guide, task_, searched_->start(), start_.pose, *succ, pool_.front(),
                            &left);
      });
      progress_.tell(way ? guide_followed(guide, way->moves.size()) : guide_left(guide, left));
      if (!way) return false;
      doing_ = "judging a way";
      Judgement judgement = judge_.judge(way->moves, PathJudge::Asker::kGuide, way->plain);
      if (auto* judged = std::get_if<JudgedPlan>(&judgement)) {
        report_.guide = guide_text(guide);
        keep(std::move(*judged), way->moves, SearchResult{});
        return true;
      }
      if (std::holds_alternative<Undecided>(judgement)) return false;
      const auto& refutation = std::get<Refutation>(judgement);
      effort_.refute(refutation.by_calibration, way->moves.size(), moves_simulated());
      const std::size_t fresh = searched_->add_starts(refutation);
      const bool lesser = options_.search_physics || search_step_us(task_) > task_.rollout_step_us;
      const bool truer = fresh == 0 && succ != &true_succ_ && lesser;
      report_.refusals.push_back(refutation.why + way_refuted(fresh, truer));
      progress_.tell("refuted: " + report_.refusals.back());
      if (truer) succ = &true_succ_;
      if (fresh == 0 && !truer) return false;
    }
    return false;
  }

  void search(const SearchParameters& parameters, const std::function<bool()>& stop) {
    doing_ = "searching";
    BeliefGraph& graph = searched_->graph();
    report_.search = timed(now_s_, report_.times.search_s, [&] {
      return options_.method == PlanMethod::kContactGreedy
                 ? contact_greedy_search(graph, parameters, stop)
                 : mha_search(graph, parameters, stop);
    });
    report_.rounds.push_back(round_of(parameters, report_.search, graph.inadmissible_count() + 1));
    report_.expansions += report_.search.expanded.size();
    if (report_.refusals.empty()) report_.expansions_first = report_.expansions;
    doing_ = "judging a path";
    if (report_.search.has_path) progress_.tell(path_found(report_.search));
  }

  void learn(const Refutation& refutation) {
    effort_.refute(refutation.by_calibration, report_.search.path.size(), moves_simulated());
    const auto step = searched_->learn(refutation, report_.search.path);
    report_.refusals.push_back(lesson(refutation, step));
    report_.rounds.back().outcome = "refuted: " + report_.refusals.back();
    progress_.tell("refuted: " + report_.refusals.back());
  }

  PlanReport without_path() {
    const bool stopped = report_.search.status == SearchStatus::kStopped;
    const PlanStatus status = out_of_moves()                          ? PlanStatus::kMoveLimit
                              : out_of_time()                         ? PlanStatus::kTimeLimit
                              : stopped                               ? PlanStatus::kExpansionLimit
                              : report_.guides == 0 && !is_baseline() ? PlanStatus::kNoAttractor
                                                                      : PlanStatus::kExhausted;
    const SearchLimits limits{task_.time_limit_s, options_.expansions_max, options_.moves_max};
    const std::string refused = reach_ ? reach_->refused_text() : "";
    return ended(status, no_path(status, report_, searched_->graph(), limits, task_.errors) +
                             (refused.empty() ? "" : "; " + refused));
  }

  void keep(JudgedPlan judged, std::vector<Vector6> path, const SearchResult& search) {
    kept_path_ = std::move(path);
    judged.plan.bound = std::isfinite(search.bound) ? search.bound : 0.0;
    report_.bytes = encode_plan(judged.plan);
    report_.plan = through_bytes(judged.plan);
    report_.certification = std::move(judged.certification);
    report_.validation = std::move(judged.estimate);
    if (search.has_path) last_is_the_plan(report_.rounds);
    if (options_.planned) options_.planned(report_);
  }

  /// Ever lower weights while the budget lasts, the last of them 1. What refutes a path on the way
  /// is learnt as before; the plan that is there stays unless a cheaper one holds, or its bound can
  /// be told more closely.
  void improve() {
    const double until_s = now_s_() + options_.improve_s;
    const auto stop = [&] { return now_s_() >= until_s; };
    SearchResult kept = report_.search;
    double share = 1.0;  // of what the task's weights exceed 1 by
    for (std::size_t round = 0; options_.improve_s > 0.0 && !stop(); ++round) {
      const bool refuted = round > 0 && refuted_;
      refuted_ = false;
      if (!refuted && share == 0.0) break;
      if (!refuted) share = share > kLeastShare ? kLowered * share : 0.0;
      search(
          {1.0 + share * (task_.w1 - 1.0), 1.0 + share * (task_.w2 - 1.0), options_.expansions_max},
          stop);
      if (!report_.search.has_path || round == options_.rounds_max) break;
      if (better()) kept = report_.search;
    }
    report_.search = std::move(kept);
  }

  /// Whether the last search's path is kept.
  bool better() {
    const std::vector<Vector6> path = searched_->displacements(report_.search.path);
    std::string& outcome = report_.rounds.back().outcome;
    if (path == kept_path_) {
      outcome = "the plan's own path";
      return tell_bound();
    }
    Judgement judgement = judge_.judge(path);
    if (const auto* refutation = std::get_if<Refutation>(&judgement)) {
      learn(*refutation);
      refuted_ = true;
      return false;
    }
    auto& judged = std::get<JudgedPlan>(judgement);
    outcome = "holds, and is not cheaper";
    if (!(judged.plan.cost < report_.plan->cost)) return false;
    keep(std::move(judged), path, report_.search);
    return true;
  }

  /// The same path again: it may be proven to be nearer to the optimum.
  bool tell_bound() {
    const double bound = report_.search.bound;
    const double told = report_.plan->bound;
    if (!(bound < told || (told == 0.0 && std::isfinite(bound)))) return false;
    Plan plan = *report_.plan;
    plan.bound = bound;
    report_.bytes = encode_plan(plan);
    report_.plan = through_bytes(plan);
    if (options_.planned) options_.planned(report_);
    return true;
  }

  PlanReport ended(PlanStatus status, const std::string& reason) {
    report_.status = status;
    report_.reason = reason;
    report_.states = states();
    report_.search_moves = succ_.counters();
    report_.attractor_moves = long_succ_.counters();
    report_.judging = judge_.effort();
    return std::move(report_);
  }

  const Task& task_;
  const Start& start_;
  const PlannerOptions& options_;
  CellAssumptions assumptions_;
  ClockSeconds now_s_;
  Progress progress_;
  RolloutPool pool_;  ///< of the truth
  RolloutPool search_pool_;
  SuccessorEngine succ_;
  SuccessorEngine true_succ_;
  SuccessorEngine long_succ_;
  PathJudge judge_;
  std::optional<MoveReach> reach_;  ///< where an arm is asked
  std::optional<SearchedGraph> searched_;
  std::vector<Vector6> kept_path_;  ///< that the plan was made of
  CalibrationEffort effort_;
  HeldErrors errors_;
  std::size_t round_ = 0;
  bool refuted_ = false;  ///< the last better path
  const char* doing_ = "looking for guides";
  PlanReport report_;
};

}  // namespace

PlanReport make_plan(const Task& task, const Start& start, const Rollout& rollout,
                     const PlannerOptions& options, const ClockSeconds& now_s) {
  const Task certain = with_goal_certainty(task, *rollout.clone());
  return Planning(certain, start, rollout, options, now_s).run();
}

}  // namespace tenon::planner
