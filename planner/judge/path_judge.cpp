#include "planner/judge/path_judge.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "planner/judge/approach_speeds.h"
#include "planner/judge/envelopes.h"
#include "planner/judge/last_move.h"
#include "planner/judge/passage.h"
#include "planner/judge/plain_touches.h"
#include "shared/plan/codec.h"

namespace tenon::planner {
namespace {

// How often the approach distances of a path may be lowered before it runs at contact speed.
constexpr int kSpeedAttempts = 2;
// Of the tilt that a plan holds: most cells have no more.
constexpr double kUsualTilt = 0.5;
// So many starts are run before somebody is asked whether to go on.
constexpr std::size_t kAtOnce = 64;
// How often envelopes may be widened to more draws.
constexpr std::uint64_t kEnvelopeBatches = 4;

void append(std::vector<Chain>& chains, const std::vector<Chain>& more) {
  chains.insert(chains.end(), more.begin(), more.end());
}

/// In every physics.
std::vector<Chain> chains_of(const Certification& certification) {
  std::vector<Chain> chains;
  for (const VariantRun& run : certification.runs) append(chains, run.chains);
  return chains;
}

}  // namespace

PathJudge::PathJudge(const Task& task, const Start& start, const Parameters& parameters,
                     RolloutPool& pool, ClockSeconds now_s)
    : task_(task),
      start_(start),
      held_(task),
      parameters_(parameters),
      pool_(pool),
      now_s_(std::move(now_s)) {}

Judgement PathJudge::judge(std::span<const Vector6> displacements, Asker asker,
                           std::span<const std::size_t> plain) {
  missed_.clear();
  asker_ = asker;
  try {
    return judged(displacements, plain);
  } catch (const Stopped&) {
    return Undecided{};
  }
}

void PathJudge::stop_if_asked() const {
  if (stop_ && stop_()) throw Stopped{};
}

Judgement PathJudge::judged(std::span<const Vector6> displacements,
                            std::span<const std::size_t> plain) {
  Plan slow = draft_plan(task_, start_, parameters_.assumptions, displacements, plain);
  slow.method = parameters_.method;
  if (slow.method == PlanMethod::kMha) {
    const std::vector<Draw> looked =
        run(slow, screening_starts(slow, held_, start_, pool_.front()), effort_.corners);
    if (missed_draw(looked, task_.particle_sigmas) != nullptr) {
      // Else the first of all corners that misses, which these are some of.
      return *missed(slow, asker_ == Asker::kGuide ? looked : corners_of(slow));
    }
    Judgement judgement = at_once(slow, good_chains(looked));
    if (std::holds_alternative<JudgedPlan>(judgement)) return judgement;
    if (asker_ == Asker::kGuide) {
      if (auto again = misses_again(slow)) return *std::move(again);
    }
  }
  Certification at_contact_speed = certified(slow);
  if (!at_contact_speed.holds()) return refutation_of(at_contact_speed);
  if (slow.method != PlanMethod::kMha) {
    const Extremes extremes{
        run(slow, corner_starts(slow, held_, start_, pool_.front()), effort_.corners),
        rim_of(slow)};
    return estimated(slow, std::move(at_contact_speed), extremes);
  }
  std::vector<Candidate> candidates;
  if (auto plain = with_plain_touches(slow, at_contact_speed.runs.front().chains)) {
    Certification as_plain = certified(*plain);
    if (as_plain.holds()) candidates.push_back({std::move(*plain), std::move(as_plain)});
  }
  candidates.push_back({std::move(slow), std::move(at_contact_speed)});  // as it was searched
  return first_that_holds(std::move(candidates));
}

Judgement PathJudge::at_once(const Plan& slow, std::span<const Chain> chains) {
  Plan plain = with_plain_touches(slow, chains).value_or(slow);
  std::vector<Chain> again;
  if (auto centred = passage_centred(plain, chains)) {
    plain = *std::move(centred);
    again = good_chains(
        run(plain, screening_starts(plain, held_, start_, pool_.front()), effort_.corners));
    if (!again.empty()) chains = again;
  }
  std::vector<double> distances_m = slow_from(plain, chains, task_.particle_sigmas);
  Judgement judgement = Refutation{};
  for (int attempt = 0; attempt < kSpeedAttempts; ++attempt) {
    Plan plan = with_slow_from(plain, distances_m);
    if (auto centred = with_last_move_centred(plan, chains, task_)) plan = *std::move(centred);
    std::optional<Certification> certification;
    if (asker_ == Asker::kSearch) certification = certified(plan);
    judgement = at_speeds(plan, std::move(certification), distances_m);
    if (std::holds_alternative<JudgedPlan>(judgement) || !any_fast(distances_m)) break;
  }
  return judgement;
}

std::optional<Plan> PathJudge::passage_centred(const Plan& plan, std::span<const Chain> chains) {
  PassageStarts starts;
  if (!tilted_axes(held_).empty()) {
    Task usual = held_;
    usual.tilt_rad *= kUsualTilt;
    starts = {passage_starts(plan, usual, start_, pool_.front()),
              passage_starts(plan, held_, start_, pool_.front())};
  }
  const RunStarts run_them = [this](const Plan& tried, std::span<const JudgedStart> some,
                                    const std::function<bool(const Draw&)>& until) {
    return run(tried, some, effort_.corners, until);
  };
  return with_passage_centred(plan, chains, task_, starts, pool_.front(), run_them);
}

Judgement PathJudge::first_that_holds(std::vector<Candidate> candidates) {
  Judgement judgement = Refutation{};
  for (const Candidate& slow : candidates) {
    judgement = at_speed(slow);
    if (std::holds_alternative<JudgedPlan>(judgement)) return judgement;
  }
  for (Candidate& slow : candidates) {
    judgement = at_contact_speed(std::move(slow));
    if (std::holds_alternative<JudgedPlan>(judgement)) break;
  }
  return judgement;
}

Judgement PathJudge::at_speed(const Candidate& slow) {
  std::vector<double> distances_m =
      slow_from(slow.plan, chains_of(slow.certification), task_.particle_sigmas);
  Judgement judgement = Refutation{};
  for (int attempt = 0; attempt < kSpeedAttempts && any_fast(distances_m); ++attempt) {
    Plan fast = with_slow_from(slow.plan, distances_m);
    if (auto again = misses_again(fast)) return *std::move(again);
    Certification certification = certified(fast);
    Candidate tried = centred(std::move(fast), std::move(certification));
    judgement = at_speeds(tried.plan, std::move(tried.certification), distances_m);
    if (std::holds_alternative<JudgedPlan>(judgement)) break;
  }
  return judgement;
}

Judgement PathJudge::at_contact_speed(Candidate&& slow) {
  if (auto again = misses_again(slow.plan)) return *std::move(again);
  std::vector<double> throughout(slow.plan.steps.size(), 0.0);
  Candidate tried = centred(std::move(slow.plan), std::move(slow.certification));
  return at_speeds(tried.plan, std::move(tried.certification), throughout);
}

PathJudge::Candidate PathJudge::centred(Plan plan, Certification certification) {
  Candidate as_is{std::move(plan), std::move(certification)};
  if (!as_is.certification.holds()) return as_is;
  auto moved = with_last_move_centred(as_is.plan, chains_of(as_is.certification), task_);
  if (!moved) return as_is;
  Certification again = certified(*moved);
  return again.holds() ? Candidate{std::move(*moved), std::move(again)} : as_is;
}

Judgement PathJudge::at_speeds(const Plan& plan, std::optional<Certification> certification,
                               std::vector<double>& distances_m) {
  const auto refuted = [&](Refutation refutation) {
    distances_m.assign(distances_m.size(), 0.0);
    return refutation;
  };
  if (certification && !certification->holds()) return refuted(refutation_of(*certification));
  Extremes extremes{corners_of(plan), {}};
  if (const auto miss = missed(plan, extremes.corners)) return refuted(*miss);
  if (!certification) certification = certified(plan);
  if (!certification->holds()) return refuted(refutation_of(*certification));
  extremes.rim = rim_of(plan);
  std::vector<Chain> good = good_chains(extremes.corners);
  append(good, good_chains(extremes.rim));
  const Chain& known = certification->runs.front().chains.front();
  if (const auto beyond = beyond_reach(with_envelopes(plan, task_, good), known)) {
    return refuted(*beyond);
  }
  std::vector<Draw> draws;
  if (!shorten(plan, good, distances_m)) {
    draws = drawn(plan, kSearchSeed);
    if (const auto miss = missed(plan, draws)) return refuted(*miss);
    append(good, good_chains(draws));
  }
  if (draws.empty() || shorten(plan, good, distances_m)) {
    return Refutation{{}, std::nullopt, "a start met a contact before the tool was slow"};
  }
  append(good, chains_of(*certification));
  std::variant<Plan, Refutation> judged = widened(plan, std::move(good));
  if (const auto* miss = std::get_if<Refutation>(&judged)) return refuted(*miss);
  if (const auto beyond = beyond_reach(std::get<Plan>(judged), known)) return refuted(*beyond);
  return estimated(std::get<Plan>(std::move(judged)), *std::move(certification), extremes);
}

std::optional<Refutation> PathJudge::beyond_reach(const Plan& plan, const Chain& known) const {
  if (parameters_.reach == nullptr) return std::nullopt;
  const auto refusal = parameters_.reach->refusal(plan);
  if (!refusal) return std::nullopt;
  return Refutation{known, refusal->step, "out of the arm's reach: " + refusal->why};
}

std::variant<Plan, Refutation> PathJudge::widened(const Plan& plan, std::vector<Chain> good) {
  Plan judged = with_envelopes(plan, task_, good);
  for (std::uint64_t batch = 0; batch < kEnvelopeBatches; ++batch) {
    const std::vector<Draw> further = drawn(plan, kEnvelopeSeed + batch);
    if (const auto miss = missed(plan, further)) return *miss;
    const std::vector<Chain> more = good_chains(further);
    if (stay_within(judged, more)) break;
    append(good, more);
    judged = with_envelopes(plan, task_, good);
  }
  if (!stay_within(judged, good)) throw std::logic_error("an envelope excludes its own chain");
  return judged;
}

Judgement PathJudge::estimated(Plan plan, Certification certification, const Extremes& extremes) {
  Validation estimate;
  estimate.draws = run(plan,
                       drawn_starts(judging_seed(plan), parameters_.draws, DrawnPhysics::kEven,
                                    plan, task_, start_, pool_.front()),
                       effort_.validation);
  const CalibrationErrors all = errors_to_hold(task_).front();
  if (held_.tilt_rad < all.tilt_rad || held_.sensor_error_m < all.sensor_error_m) {
    // With its envelopes, and centred, it may hold more.
    hold_extremes(
        plan, task_, start_, pool_.front(), estimate,
        [&](std::span<const JudgedStart> starts) { return run(plan, starts, effort_.corners); });
  } else {
    estimate.corners = decided_by(plan, task_, extremes.corners);
    estimate.rim = decided_by(plan, task_, extremes.rim);
    estimate.held = all;
  }
  plan.cost = certification.cost;
  plan.draws = static_cast<std::uint32_t>(estimate.draws.size());
  plan.draws_at_goal = static_cast<std::uint32_t>(estimate.at_goal());
  return JudgedPlan{std::move(plan), std::move(certification), std::move(estimate)};
}

Certification PathJudge::certified(const Plan& plan) {
  stop_if_asked();
  Certification result = timed(now_s_, effort_.certification.time_s, [&] {
    return certify(encode_plan(plan), task_, pool_, CertificationExtent::kToFirstRefutation);
  });
  for (const VariantRun& run : result.runs) {
    for (const Chain& chain : run.chains) effort_.certification.moves += chain.steps.size();
  }
  return result;
}

std::vector<Draw> PathJudge::corners_of(const Plan& plan) {
  const auto starts = corner_starts(plan, held_, start_, pool_.front());
  if (asker_ == Asker::kSearch) return run_to_miss(plan, starts, effort_.corners);
  const auto run_some = [&](std::span<const JudgedStart> some) {
    return run(plan, some, effort_.corners);
  };
  return run_past_miss(starts, task_.particle_sigmas, kAtOnce, run_some);
}

std::vector<Draw> PathJudge::rim_of(const Plan& plan) {
  return run(plan, rim_starts(plan, held_, start_, pool_.front()), effort_.validation);
}

std::vector<Draw> PathJudge::drawn(const Plan& plan, std::uint64_t seed) {
  return run_to_miss(plan,
                     drawn_starts(seed, parameters_.draws, DrawnPhysics::kCorners, plan, held_,
                                  start_, pool_.front()),
                     effort_.validation);
}

std::optional<Refutation> PathJudge::misses_again(const Plan& plan) {
  const std::vector<Draw> draws = run_to_miss(plan, missed_, effort_.corners);
  const Draw* miss = missed_draw(draws, task_.particle_sigmas);
  if (miss == nullptr) return std::nullopt;
  return told(plan, *miss);
}

std::optional<Refutation> PathJudge::missed(const Plan& plan, std::span<const Draw> draws) {
  const Draw* miss = missed_draw(draws, task_.particle_sigmas);
  if (miss == nullptr) return std::nullopt;
  for (const Draw& draw : draws) {
    if (!missed_draw({&draw, 1}, task_.particle_sigmas)) continue;
    missed_.push_back({draw.chain.start, draw.sigmas_out});
  }
  return told(plan, *miss);
}

Refutation PathJudge::told(const Plan& plan, const Draw& miss) {
  Refutation refutation = refutation_of(miss, task_, start_);
  if (asker_ == Asker::kGuide) {
    for (const JudgedStart& start : missed_) refutation.others.push_back(start.particle);
  }
  std::vector<JudgedStart> levelled;
  const auto level = [&](const Particle& start) {
    const bool off = !start.physics.sensor_error_m.isZero(0.0);
    if (!off && tilt_of(start, task_, start_).norm_rad() == 0.0) return;
    levelled.push_back({without_tilt(start, task_, start_), 0.0});
    levelled.back().particle.physics.sensor_error_m.setZero();
  };
  level(miss.chain.start);
  for (const Particle& start : refutation.others) level(start);
  const std::vector<Draw> draws =
      run(plan, levelled, effort_.corners, [](const Draw& draw) { return draw.at_goal; });
  refutation.by_calibration = arrived(draws) > 0;
  return refutation;
}

std::vector<Draw> PathJudge::run_to_miss(const Plan& plan, std::span<const JudgedStart> starts,
                                         Effort& effort) {
  return run(plan, starts, effort, [this](const Draw& draw) {
    return !draw.at_goal && draw.sigmas_out <= task_.particle_sigmas;
  });
}

std::vector<Draw> PathJudge::run(const Plan& plan, std::span<const JudgedStart> starts,
                                 Effort& effort, const std::function<bool(const Draw&)>& until) {
  std::vector<Draw> draws;
  while (!starts.empty()) {
    stop_if_asked();
    const std::span<const JudgedStart> some = starts.first(std::min(kAtOnce, starts.size()));
    starts = starts.subspan(some.size());
    std::vector<Draw> ran =
        timed(now_s_, effort.time_s, [&] { return run_starts(plan, task_, some, pool_, until); });
    for (const Draw& draw : ran) effort.moves += draw.chain.steps.size();
    const bool ended = until && until(ran.back());
    std::move(ran.begin(), ran.end(), std::back_inserter(draws));
    if (ended) break;
  }
  return draws;
}

}  // namespace tenon::planner
