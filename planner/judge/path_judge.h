#pragma once
// Whether a path becomes a plan: certified from its very bytes, its touches plain, its way in
// centred and its approach fast where that holds, its last move centred on the goal, validated by
// draws, and given envelopes. What does not hold comes back as a refutation; what to learn from it
// is not decided here.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "planner/belief/rollout_pool.h"
#include "planner/judge/certification.h"
#include "planner/judge/judge_effort.h"
#include "planner/judge/plan_draft.h"
#include "planner/judge/refutation.h"
#include "planner/judge/timed.h"
#include "planner/judge/validation.h"
#include "shared/plan/plan.h"
#include "shared/ports/arm_reach.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// A plan that holds, with its cost and its own estimate of its success; it has no bound yet, which
/// only the search can tell.
struct JudgedPlan {
  Plan plan;
  Certification certification;
  Validation estimate;  ///< as validate() would say of the plan
};

/// There was no time to tell.
struct Undecided {};

using Judgement = std::variant<JudgedPlan, Refutation, Undecided>;

/// Of one task and start. One thread at a time; the pool starts its own.
class PathJudge {
 public:
  struct Parameters {
    /// A baseline is certified for its single particle alone. Its plan runs at contact speed
    /// throughout, checks no envelope, and is validated but never refuted by draws.
    PlanMethod method = PlanMethod::kMha;
    CellAssumptions assumptions;
    std::size_t draws = kDrawsMin;  ///< of each validation
    /// Where not null: a plan that this arm cannot execute is refuted.
    const ArmReach* reach = nullptr;
  };

  /// task, start and pool must outlive this.
  PathJudge(const Task& task, const Start& start, const Parameters& parameters, RolloutPool& pool,
            ClockSeconds now_s);

  /// From now on starts refute that have up to these errors; at first, all of the task's.
  void hold(const CalibrationErrors& errors) { held_ = holding(task_, errors); }

  /// @param stop asked every few hundred moves: whether to leave a path undecided
  void stop_when(std::function<bool()> stop) { stop_ = std::move(stop); }

  /// Who learns from a refutation, and so what is looked at first.
  enum class Asker : std::uint8_t {
    /// Goes on by other moves: certification comes first, which says which move is at fault, and
    /// then the first start at the corners that misses.
    kSearch,
    /// Is found anew from all starts that miss: the corners come first, and those are told that
    /// miss
    /// among as many again as it takes to find one, see run_past_miss().
    kGuide,
  };

  /// @param displacements of the path's steps, values that a plan file can hold
  /// @param plain those of the steps whose touches are plain
  /// @throws InputError where they cannot be represented as a plan
  [[nodiscard]] Judgement judge(std::span<const Vector6> displacements,
                                Asker asker = Asker::kSearch,
                                std::span<const std::size_t> plain = {});

  /// So far.
  [[nodiscard]] const JudgeEffort& effort() const { return effort_; }

 private:
  /// Corners and rim of a plan, run once: its envelopes change no motion.
  struct Extremes {
    std::vector<Draw> corners;
    std::vector<Draw> rim;
  };

  struct Candidate {
    Plan plan;
    Certification certification;
  };

  /// Stops a judgement.
  struct Stopped {};

  [[nodiscard]] Judgement judged(std::span<const Vector6> displacements,
                                 std::span<const std::size_t> plain);
  void stop_if_asked() const;
  /// Certified, and if it holds with its last move centred, where that holds as well.
  [[nodiscard]] Candidate centred(Plan plan, Certification certification);
  /// Plain, fast and centred, at its end and on the way in, by what chains at contact speed show,
  /// and certified as that alone.
  [[nodiscard]] Judgement at_once(const Plan& slow, std::span<const Chain> chains);
  /// Placed in the middle of what lets the part in, where that is another place.
  [[nodiscard]] std::optional<Plan> passage_centred(const Plan& plan,
                                                    std::span<const Chain> chains);
  /// Each fast, and only then each at contact speed throughout, which takes longer to judge and to
  /// execute. @param candidates certified at contact speed @return the last refutation where none
  /// holds
  [[nodiscard]] Judgement first_that_holds(std::vector<Candidate> candidates);
  /// As fast as it holds.
  [[nodiscard]] Judgement at_speed(const Candidate& slow);
  [[nodiscard]] Judgement at_contact_speed(Candidate&& slow);
  /// Where the plan does not hold at its speeds, the distances are lowered, to be tried next. At
  /// contact speed throughout there is nothing to lower.
  /// @param certification made after the corners have been run where there is none
  [[nodiscard]] Judgement at_speeds(const Plan& plan, std::optional<Certification> certification,
                                    std::vector<double>& distances_m);
  /// Envelopes around the chains, widened to more draws until all of a batch stay within them: what
  /// one start in a hundred does is no reason to stop.
  [[nodiscard]] std::variant<Plan, Refutation> widened(const Plan& plan, std::vector<Chain> good);
  /// Of a plan with envelopes that the arm cannot execute. @param known one of its chains
  [[nodiscard]] std::optional<Refutation> beyond_reach(const Plan& plan, const Chain& known) const;
  [[nodiscard]] Judgement estimated(Plan plan, Certification certification,
                                    const Extremes& extremes);
  /// Where a start that this path has missed at other speeds or otherwise pressed, misses again.
  [[nodiscard]] std::optional<Refutation> misses_again(const Plan& plan);
  /// Of draws that may refute: the first miss. All are remembered.
  [[nodiscard]] std::optional<Refutation> missed(const Plan& plan, std::span<const Draw> draws);
  /// And all that this path has missed, where those are asked for.
  [[nodiscard]] Refutation told(const Plan& plan, const Draw& miss);
  [[nodiscard]] Certification certified(const Plan& plan);
  [[nodiscard]] std::vector<Draw> rim_of(const Plan& plan);
  /// These and the draws may refute, and end with the first miss unless all are asked for; of the
  /// draws every second one is at a corner of friction, size and latency.
  [[nodiscard]] std::vector<Draw> corners_of(const Plan& plan);
  [[nodiscard]] std::vector<Draw> drawn(const Plan& plan, std::uint64_t seed);
  /// @param effort to which this adds
  [[nodiscard]] std::vector<Draw> run(const Plan& plan, std::span<const JudgedStart> starts,
                                      Effort& effort,
                                      const std::function<bool(const Draw&)>& until = {});
  [[nodiscard]] std::vector<Draw> run_to_miss(const Plan& plan, std::span<const JudgedStart> starts,
                                              Effort& effort);

  const Task& task_;
  const Start& start_;
  Task held_;  ///< the task, with the tilt that is held
  Parameters parameters_;
  RolloutPool& pool_;
  ClockSeconds now_s_;
  std::function<bool()> stop_{};
  JudgeEffort effort_;
  Asker asker_ = Asker::kSearch;
  std::vector<JudgedStart> missed_;  ///< by the path that is judged
};

}  // namespace tenon::planner
