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
// How often envelopes may be widened to more draws.
constexpr std::uint64_t kEnvelopeBatches = 4;
// A chain that stays this close to the search's particles has done as they did.
constexpr double kForeseen_m = 1e-4;

std::string where(const Vector3& p) { return format("(%.4f, %.4f, %.4f) m", p.x(), p.y(), p.z()); }

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
    const std::string overlap = collision(task_, start_, pool_.front());
    if (!overlap.empty()) return finish(PlanStatus::kInCollision, overlap);
    belief_ = start_belief(task_, start_, options_.method);
    for (Particle& particle : belief_.particles) {
      particle.physics.contact_stiffness_Npm = options_.assumptions.contact_stiffness_Npm;
    }
    if (at_goal(summarise(belief_, task_), task_)) {
      return finish(PlanStatus::kAlreadyAtGoal,
                    "start '" + start_.name + "' is already within the goal's tolerances");
    }
    attractors_ = timed(now_s_, report_.times.attractors_s, [&] {
      return is_baseline() ? Attractors{{}, goal_attractors(task_, belief_, long_succ_)}
                           : find_attractors(task_, belief_, long_succ_, pool_.front(),
                                             [this] { return out_of_time(); });
    });
    report_.attractors = attractors_.guides.size();
    tell(format("%zu guides, found with %llu moves", report_.attractors,
                static_cast<unsigned long long>(long_succ_.counters().rollouts)));
    graph_.emplace(task_, belief_, attractors_, succ_);
    for (std::size_t round = 0; round < options_.rounds_max; ++round) {
      if (!search()) return report_with_counters();
      const std::optional<Refutation> refutation = try_path();
      if (!refutation) return report_with_counters();
      learn(*refutation);
      tell("refuted: " + report_.refusals.back());
    }
    finish(PlanStatus::kNotCertified,
           format("every one of %zu paths was refuted, the last one: ", options_.rounds_max) +
               report_.refusals.back());
    return report_with_counters();
  }

 private:
  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(format("%6.1f s: ", now_s_() - began_s_) + what);
  }

  [[nodiscard]] bool out_of_time() const { return now_s_() - began_s_ > task_.time_limit_s; }

  /// Such a planner has nothing but its one particle.
  [[nodiscard]] bool is_baseline() const { return options_.method != PlanMethod::kMha; }

  PlanReport& finish(PlanStatus status, const std::string& reason) {
    report_.status = status;
    report_.reason = reason;
    return report_;
  }

  PlanReport report_with_counters() {
    report_.states += graph_->size();
    report_.search_moves = succ_.counters();
    report_.attractor_moves = long_succ_.counters();
    return std::move(report_);
  }

  /// False where there is no path; the report says why.
  bool search() {
    report_.search = timed(now_s_, report_.times.search_s, [&] {
      const SearchParameters parameters{task_.w1, task_.w2, options_.expansions_max};
      const auto stop = [&] { return out_of_time(); };
      return options_.method == PlanMethod::kContactGreedy
                 ? contact_greedy_search(*graph_, parameters, stop)
                 : mha_search(*graph_, parameters, stop);
    });
    report_.expansions += report_.search.expanded.size();
    if (report_.refusals.empty()) report_.expansions_first = report_.expansions;
    if (report_.search.has_path) {
      tell(format("a path of %zu steps after %zu expansions", report_.search.path.size(),
                  report_.search.expanded.size()));
      return true;
    }
    const std::string after =
        format("%zu expansions and %zu refuted paths", report_.expansions,
               report_.refusals.size()) +
        nearest() + (report_.refusals.empty() ? "" : "; last refuted: " + report_.refusals.back());
    if (report_.search.status == SearchStatus::kStopped) {
      const bool late = out_of_time();
      finish(late ? PlanStatus::kTimeLimit : PlanStatus::kExpansionLimit,
             late ? format("no path within %g s (raise --time-limit), after ", task_.time_limit_s) +
                        after
                  : format("%zu expansions in a search, the limit: no path after ",
                           options_.expansions_max) +
                        after);
    } else if (report_.attractors == 0 && !is_baseline()) {
      finish(PlanStatus::kNoAttractor,
             "no push from the start reduces its uncertainty, and no path exists after " + after);
    } else {
      finish(PlanStatus::kExhausted, "the searched graph has no path left after " + after);
    }
    return false;
  }

  /// How near the search has come.
  [[nodiscard]] std::string nearest() const {
    double nearest_m = std::numeric_limits<double>::infinity();
    double certain_m2 = nearest_m;
    for (StateId state = 0; state < graph_->size(); ++state) {
      const BeliefSummary& belief = graph_->summary(state);
      nearest_m = std::min(nearest_m, belief.farthest_m);
      certain_m2 = std::min(certain_m2, belief.uncertainty_m2);
    }
    return format(
        " (the nearest had all particles within %.1f mm of the goal, the most certain %.2g m^2)",
        1e3 * nearest_m, certain_m2);
  }

  /// What speaks against a path.
  struct Refutation {
    Chain chain;
    std::optional<std::size_t> step;  ///< at which the chain went wrong, where that is known
    std::string why;
  };

  /// Certifies and validates the path; empty where it became the plan.
  std::optional<Refutation> try_path() {
    std::vector<Vector6> displacements;
    for (const PathEdge& edge : report_.search.path) {
      displacements.push_back(graph_->displacement(edge.from, edge.label));
    }
    Plan slow = draft_plan(task_, start_, options_.assumptions, displacements);
    slow.method = options_.method;
    Certification at_contact_speed = certified(slow);
    if (!at_contact_speed.holds()) return refutation_of(at_contact_speed);
    if (is_baseline()) {
      complete(slow, std::move(at_contact_speed));
      return std::nullopt;
    }
    std::vector<double> distances_m =
        slow_from(slow, good_chains(at_contact_speed, {}), task_.particle_sigmas);
    for (int attempt = 0; attempt < kSpeedAttempts && any_fast(distances_m); ++attempt) {
      const Plan fast = with_slow_from(slow, distances_m);
      if (!try_speeds(fast, certified(fast), distances_m)) return std::nullopt;
    }
    return try_speeds(slow, std::move(at_contact_speed), distances_m);
  }

  /// Completes the plan where it holds at its speeds; otherwise lowers the distances, to be tried
  /// next. At contact speed throughout there is nothing to lower.
  std::optional<Refutation> try_speeds(const Plan& plan, Certification certification,
                                       std::vector<double>& distances_m) {
    if (!certification.holds()) {
      distances_m.assign(distances_m.size(), 0.0);
      return refutation_of(certification);
    }
    const Validation validation = validated(plan, kSearchSeed);
    if (auto miss = missed(validation)) {
      distances_m.assign(distances_m.size(), 0.0);
      return miss;
    }
    if (shorten(plan, validation, distances_m)) {
      return Refutation{{}, std::nullopt, "a draw met a contact before the tool was slow"};
    }
    // Envelopes around the chains, widened to more draws until all of a batch stay within them:
    // what one start in a hundred does is no reason to stop.
    std::vector<Chain> good = good_chains(certification, validation);
    Plan judged = with_envelopes(plan, task_, good);
    for (std::uint64_t batch = 0; batch < kEnvelopeBatches; ++batch) {
      const Validation further = validated(plan, kEnvelopeSeed + batch);
      if (auto miss = missed(further)) return miss;
      const std::vector<Chain> more = further.good_chains();
      if (std::all_of(more.begin(), more.end(), [&](const Chain& c) { return stays(judged, c); })) {
        break;
      }
      good.insert(good.end(), more.begin(), more.end());
      judged = with_envelopes(plan, task_, good);
    }
    for (const Chain& chain : good) {
      if (!stays(judged, chain)) throw std::logic_error("an envelope excludes its own chain");
    }
    complete(judged, std::move(certification));
    return std::nullopt;
  }

  /// The first draw within the particles' reach that missed the goal.
  [[nodiscard]] std::optional<Refutation> missed(const Validation& validation) const {
    for (const Draw& draw : validation.draws) {
      if (draw.at_goal || draw.mahalanobis > task_.particle_sigmas) continue;
      return Refutation{draw.chain, std::nullopt,
                        format("a draw %.2f sigma out missed the goal", draw.mahalanobis)};
    }
    return std::nullopt;
  }

  static bool stays(const Plan& plan, const Chain& chain) {
    return first_deviation(plan, chain) == chain.moves.size();
  }

  static Refutation refutation_of(const Certification& certification) {
    const VariantRun& run = *certification.refuting();
    Refutation refutation{run.chains[run.disagreement.particle], std::nullopt,
                          run.variant.name + ", " + format("step %zu: ", run.disagreement.step) +
                              run.disagreement.why};
    // The same particle in the same physics: the step itself cannot be relied on.
    if (&run != &certification.runs.front()) refutation.step = run.disagreement.step;
    return refutation;
  }

  /// A chain from a start that the search did not know of makes that start a particle. Otherwise
  /// the search was wrong about a move, and does without it.
  void learn(const Refutation& refutation) {
    std::vector<Particle>& particles = belief_.particles;
    Particle start = refutation.chain.start;
    start.physics.contact_stiffness_Npm = options_.assumptions.contact_stiffness_Npm;
    const auto known = std::find_if(particles.begin(), particles.end(),
                                    [&](const Particle& p) { return same_start(p, start); });
    if (known == particles.end()) {
      particles.push_back(start);
      report_.states += graph_->size();
      graph_.emplace(task_, belief_, attractors_, succ_);
      report_.refusals.push_back(refutation.why + "; it becomes a particle");
      return;
    }
    const auto particle = static_cast<std::size_t>(known - particles.begin());
    const std::size_t step = refutation.step.value_or(departure(refutation.chain, particle));
    const PathEdge& edge = report_.search.path[step];
    succ_.refuse(graph_->belief(edge.from).particles[particle],
                 graph_->displacement(edge.from, edge.label));
    report_.refusals.push_back(refutation.why + format("; its move in step %zu is refused", step));
  }

  static bool same_start(const Particle& a, const Particle& b) {
    return a.pose == b.pose && a.physics == b.physics;
  }

  /// The step in which a chain leaves what the search had foreseen for its particle; the last one
  /// where it does not.
  [[nodiscard]] std::size_t departure(const Chain& chain, std::size_t particle) const {
    for (std::size_t i = 0; i < chain.moves.size(); ++i) {
      const PathEdge& edge = report_.search.path[chain.steps[i]];
      const Particle& foreseen = graph_->belief(edge.to).particles[particle];
      if (chain.moves[i].signature != foreseen.signature ||
          displacement_between(foreseen.pose, chain.moves[i].pose).norm() > kForeseen_m) {
        return chain.steps[i];
      }
    }
    return chain.steps.back();
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

  Validation validated(const Plan& plan, std::uint64_t seed) {
    Validation result = timed(now_s_, report_.times.validation_s, [&] {
      ValidationParameters parameters = options_.validation;
      parameters.seed = seed;
      parameters.stop_when_refuted = seed != kEstimateSeed;
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

  void complete(Plan plan, Certification certification) {
    const Validation estimate = validated(plan, kEstimateSeed);
    plan.cost = certification.cost;
    plan.bound = std::isfinite(report_.search.bound) ? report_.search.bound : 0.0;
    plan.draws = static_cast<std::uint32_t>(estimate.draws.size());
    plan.draws_at_goal = static_cast<std::uint32_t>(estimate.at_goal());
    report_.bytes = encode_plan(plan);
    report_.plan = through_bytes(plan);
    report_.certification = std::move(certification);
    report_.validation = estimate;
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
  Belief belief_;  // the method's particles, and the starts that refuted a path
  Attractors attractors_;
  std::optional<BeliefGraph> graph_;
  PlanReport report_;
};

}  // namespace

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
  }
  return "?";
}

PlanReport make_plan(const Task& task, const Start& start, const Rollout& rollout,
                     const PlannerOptions& options, const std::function<double()>& now_s) {
  return Planning(task, start, rollout, options, now_s).run();
}

std::string collision(const Task& task, const Start& start, Rollout& rollout) {
  const std::string overlaps =
      task.oversize_m > 0.0
          ? format(" is in collision with a part %g mm larger than drawn", 1e3 * task.oversize_m)
          : " is in collision";
  const std::string what = "start '" + start.name + "' of task '" + task.name + "' at ";
  if (rollout.in_collision(start.pose)) {
    return what + where(start.pose.position_m) + overlaps + ": move the start or the environment";
  }
  const Belief belief = cross_polytope(task, start);
  const auto inside =
      std::find_if(belief.particles.begin(), belief.particles.end(),
                   [&](const Particle& particle) { return rollout.in_collision(particle.pose); });
  if (inside != belief.particles.end()) {
    return what + where(inside->pose.position_m) +
           format(", %g standard deviations out,", task.particle_sigmas) + overlaps +
           ": move the start or lower its sigma";
  }
  if (!rollout.in_collision(task.goal)) return {};
  return "the goal of task '" + task.name + "' at " + where(task.goal.position_m) + overlaps +
         ": move it or the environment" + (task.oversize_m > 0.0 ? ", or lower oversize_m" : "");
}

}  // namespace tenon::planner
