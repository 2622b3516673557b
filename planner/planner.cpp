#include "planner/planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "planner/belief_graph.h"
#include "planner/contact_greedy.h"
#include "planner/envelopes.h"
#include "planner/text.h"
#include "shared/base/error.h"
#include "shared/plan/codec.h"

namespace tenon::planner {
namespace {

// How often the approach distances of a path may be lowered before it runs at contact speed.
constexpr int kSpeedAttempts = 2;

std::string where(const Vector3& p) { return format("(%.4f, %.4f, %.4f) m", p.x(), p.y(), p.z()); }

/// Empty where start and particles are free.
std::string start_collision(const Task& task, const Start& start, Rollout& rollout) {
  if (rollout.in_collision(start.pose)) {
    return "start '" + start.name + "' of task '" + task.name + "' at " +
           where(start.pose.position_m) + " is in collision: move the start or the environment";
  }
  for (const Particle& particle : cross_polytope(task, start).particles) {
    if (!rollout.in_collision(particle.pose)) continue;
    return "start '" + start.name + "' of task '" + task.name + "' is in collision " +
           format("%g", task.particle_sigmas) + " standard deviations out, at " +
           where(particle.pose.position_m) + ": move the start or lower its sigma";
  }
  return {};
}

template <typename Work>
auto timed(const std::function<double()>& now_s, double& seconds, Work work) {
  const double from_s = now_s();
  auto result = work();
  seconds += now_s() - from_s;
  return result;
}

class Planning {
 public:
  Planning(const Task& task, const Start& start, const Rollout& rollout,
           const PlannerOptions& options, const std::function<double()>& now_s)
      : task_(task),
        start_(start),
        options_(options),
        now_s_(now_s),
        began_s_(now_s()),
        pool_(rollout, options.threads),
        succ_(pool_, search_move(task, start, options.assumptions), task.rollout_step_us),
        long_succ_(pool_, long_move(task, search_move(task, start, options.assumptions)),
                   task.rollout_step_us) {}

  PlanReport run() {
    report_.method = options_.method;
    const std::string collision = start_collision(task_, start_, pool_.front());
    if (!collision.empty()) return finish(PlanStatus::kStartInCollision, collision);
    Belief belief = start_belief(task_, start_, options_.method);
    for (Particle& particle : belief.particles) {
      particle.physics.contact_stiffness_Npm = options_.assumptions.contact_stiffness_Npm;
    }
    if (at_goal(summarise(belief, task_), task_)) {
      return finish(PlanStatus::kAlreadyAtGoal,
                    "start '" + start_.name + "' is already within the goal's tolerances");
    }
    Attractors attractors = timed(now_s_, report_.times.attractors_s, [&] {
      return find_attractors(task_, belief, long_succ_, pool_.front());
    });
    if (is_baseline()) attractors.guides.clear();
    report_.attractors = attractors.guides.size();
    BeliefGraph graph(task_, belief, std::move(attractors), succ_);
    for (std::size_t round = 0; round < options_.rounds_max; ++round) {
      if (!search(graph)) return report_with_counters(graph);
      if (try_path(graph)) return report_with_counters(graph);
    }
    finish(PlanStatus::kNotCertified,
           format("every one of %zu paths was refuted, the last one: ", options_.rounds_max) +
               report_.refusals.back());
    return report_with_counters(graph);
  }

 private:
  [[nodiscard]] bool out_of_time() const { return now_s_() - began_s_ > task_.time_limit_s; }

  /// Such a planner has nothing but its one particle.
  [[nodiscard]] bool is_baseline() const { return options_.method != PlanMethod::kMha; }

  PlanReport& finish(PlanStatus status, const std::string& reason) {
    report_.status = status;
    report_.reason = reason;
    return report_;
  }

  PlanReport report_with_counters(const BeliefGraph& graph) {
    report_.states = graph.size();
    report_.search_moves = succ_.counters();
    report_.attractor_moves = long_succ_.counters();
    return std::move(report_);
  }

  /// False where there is no path; the report says why.
  bool search(BeliefGraph& graph) {
    report_.search = timed(now_s_, report_.times.search_s, [&] {
      const SearchParameters parameters{task_.w1, task_.w2, options_.expansions_max};
      const auto stop = [&] { return out_of_time(); };
      return options_.method == PlanMethod::kContactGreedy
                 ? contact_greedy_search(graph, parameters, stop)
                 : mha_search(graph, parameters, stop);
    });
    report_.expansions += report_.search.expanded.size();
    if (report_.search.has_path) return true;
    const std::string after =
        format("%zu expansions and %zu refuted edges", report_.expansions, graph.refused());
    if (report_.search.status == SearchStatus::kStopped) {
      const bool late = out_of_time();
      finish(late ? PlanStatus::kTimeLimit : PlanStatus::kExpansionLimit,
             late ? format("no path within %g s, after ", task_.time_limit_s) + after
                  : "no path after " + after + ", the limit");
    } else if (report_.attractors == 0 && !is_baseline()) {
      finish(PlanStatus::kNoAttractor,
             "no push from the start reduces its uncertainty, and no path exists after " + after);
    } else {
      finish(PlanStatus::kExhausted, "the searched graph has no path left after " + after);
    }
    return false;
  }

  /// Certifies and validates the path; true ends the planning with a plan, false refuses an edge.
  bool try_path(BeliefGraph& graph) {
    std::vector<Vector6> displacements;
    for (const PathEdge& edge : report_.search.path) {
      displacements.push_back(graph.displacement(edge.from, edge.label));
    }
    Plan slow = draft_plan(task_, start_, options_.assumptions, displacements);
    slow.method = options_.method;
    Certification at_contact_speed = certified(slow);
    if (const VariantRun* refuting = at_contact_speed.refuting()) {
      refuse(graph, refuting->disagreement.step,
             refuting->variant.name + ", " + refuting->disagreement.why);
      return false;
    }
    if (is_baseline()) {
      Validation validation = validated(slow);
      complete(graph, slow, std::move(at_contact_speed), std::move(validation));
      return true;
    }
    std::vector<double> distances_m =
        slow_from(slow, good_chains(at_contact_speed, {}), task_.particle_sigmas);
    for (int attempt = 0; attempt < kSpeedAttempts && any_fast(distances_m); ++attempt) {
      if (try_speeds(graph, with_slow_from(slow, distances_m), distances_m)) return true;
    }
    const std::vector<double> none(distances_m.size(), 0.0);
    if (try_speeds(graph, with_slow_from(slow, none), distances_m)) return true;
    refuse(graph, left_at_, "at contact speed, a draw within the particles' reach missed the goal");
    return false;
  }

  /// Completes the plan where it holds at its speeds; otherwise lowers the distances, to be tried
  /// next. At contact speed throughout there is nothing to lower.
  bool try_speeds(const BeliefGraph& graph, const Plan& plan, std::vector<double>& distances_m) {
    Certification certification = certified(plan);
    if (!certification.holds()) {
      left_at_ = certification.refuting()->disagreement.step;
      distances_m.assign(distances_m.size(), 0.0);
      return false;
    }
    Validation validation = validated(plan);
    if (const auto step = left_at(plan, certification, validation)) {
      left_at_ = *step;
      distances_m.assign(distances_m.size(), 0.0);
      return false;
    }
    if (shorten(plan, validation, distances_m)) return false;
    const std::vector<Chain> good = good_chains(certification, validation);
    complete(graph, with_envelopes(plan, task_, good), std::move(certification),
             std::move(validation));
    return true;
  }

  static bool any_fast(const std::vector<double>& distances_m) {
    return std::any_of(distances_m.begin(), distances_m.end(), [](double d) { return d > 0.0; });
  }

  static Plan with_slow_from(Plan plan, const std::vector<double>& distances_m) {
    for (std::size_t i = 0; i < distances_m.size(); ++i) plan.steps[i].slow_from_m = distances_m[i];
    return through_bytes(plan);
  }

  Certification certified(const Plan& plan) {
    Certification result = timed(now_s_, report_.times.certification_s,
                                 [&] { return certify(encode_plan(plan), task_, pool_); });
    for (const VariantRun& run : result.runs) {
      for (const Chain& chain : run.chains) {
        report_.certification_moves += chain.steps.size();
      }
    }
    return result;
  }

  Validation validated(const Plan& plan) {
    Validation result = timed(now_s_, report_.times.validation_s, [&] {
      ValidationParameters parameters = options_.validation;
      parameters.stop_when_refuted = !is_baseline();
      return validate(plan, task_, start_, parameters, pool_);
    });
    report_.validation_moves += result.moves();
    return result;
  }

  /// Every chain that ended at the goal.
  static std::vector<Chain> good_chains(const Certification& certification,
                                        const Validation& validation) {
    std::vector<Chain> chains;
    for (const VariantRun& run : certification.runs) {
      chains.insert(chains.end(), run.chains.begin(), run.chains.end());
    }
    const std::vector<Chain> validated = validation.good_chains();
    chains.insert(chains.end(), validated.begin(), validated.end());
    return chains;
  }

  /// Where the first draw that should have reached the goal left the way of those that did; empty
  /// where all did.
  std::optional<std::size_t> left_at(const Plan& plan, const Certification& certification,
                                     const Validation& validation) const {
    const Plan judged = with_envelopes(plan, task_, good_chains(certification, validation));
    for (const Draw& draw : validation.draws) {
      if (draw.at_goal || draw.mahalanobis > task_.particle_sigmas) continue;
      const std::size_t move = first_deviation(judged, draw.chain);
      return move < draw.chain.steps.size() ? draw.chain.steps[move] : plan.steps.size() - 1;
    }
    return std::nullopt;
  }

  /// True where a draw met a contact before the tool was slow; the distance is then shortened.
  static bool shorten(const Plan& plan, const Validation& validation,
                      std::vector<double>& distances_m) {
    const std::vector<double> allowed_m =
        slow_from(plan, validation.good_chains(), std::numeric_limits<double>::infinity());
    bool shortened = false;
    for (std::size_t i = 0; i < distances_m.size(); ++i) {
      // slow_from() keeps its margin; half of it is enough for what was only drawn.
      if (plan.steps[i].slow_from_m <= allowed_m[i] + 0.5 * kSlowMargin_m) continue;
      distances_m[i] = allowed_m[i];
      shortened = true;
    }
    return shortened;
  }

  void refuse(BeliefGraph& graph, std::size_t step, const std::string& why) {
    const PathEdge& edge = report_.search.path[step];
    graph.refuse(edge.from, edge.label);
    report_.refusals.push_back(format("step %zu: ", step) + why);
  }

  void complete(const BeliefGraph& graph, Plan plan, Certification certification,
                Validation validation) {
    plan.cost = certification.cost;
    // The bound speaks of the searched graph; the chain's own cost may differ a little from g.
    const double bound = report_.search.bound * certification.cost / report_.search.cost;
    plan.bound = std::isfinite(bound) ? std::max(1.0, bound) : 0.0;
    plan.draws = static_cast<std::uint32_t>(validation.draws.size());
    plan.draws_at_goal = static_cast<std::uint32_t>(validation.at_goal());
    report_.bytes = encode_plan(plan);
    report_.plan = through_bytes(plan);
    for (const Chain& chain : good_chains(certification, validation)) {
      if (first_deviation(*report_.plan, chain) == chain.moves.size()) continue;
      throw std::logic_error("an envelope does not hold what it was made from");
    }
    report_.certification = std::move(certification);
    report_.validation = std::move(validation);
    report_.states = graph.size();
    finish(PlanStatus::kPlanned, "");
  }

  const Task& task_;
  const Start& start_;
  PlannerOptions options_;
  const std::function<double()>& now_s_;
  double began_s_;
  RolloutPool pool_;
  SuccessorEngine succ_;
  SuccessorEngine long_succ_;
  std::size_t left_at_ = 0;  // step at which the last plan tried did not hold
  PlanReport report_;
};

}  // namespace

const char* to_string(PlanStatus status) {
  switch (status) {
    case PlanStatus::kPlanned:
      return "planned";
    case PlanStatus::kStartInCollision:
      return "start in collision";
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
  }
  return "?";
}

PlanReport make_plan(const Task& task, const Start& start, const Rollout& rollout,
                     const PlannerOptions& options, const std::function<double()>& now_s) {
  return Planning(task, start, rollout, options, now_s).run();
}

void check_start(const Task& task, const Start& start, Rollout& rollout) {
  const std::string collision = start_collision(task, start, rollout);
  if (!collision.empty()) throw InputError(collision);
}

}  // namespace tenon::planner
