#pragma once
// Walks a plan's graph: one guarded move at a time, and from its outcome to the next. Between two
// moves there is no gap: the next one starts in the next cycle, from the rest setpoint of the last.
// It sees neither arm nor clock. Real-time, one thread; refers to a plan that must outlive it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "shared/motion/guarded_move.h"
#include "shared/plan/plan.h"
#include "shared/plan/transition.h"

namespace tenon::executor {

/// One executed step.
struct StepReport {
  std::size_t step = 0;
  Vector6 commanded = Vector6::Zero();  ///< displacement as planned, m and rad
  ContactSignature signature_before;
  GuardedMove::Result result;
  Transition transition;
  std::int64_t start_ns = 0;
};

/// The same plan. @throws InputError where it has no steps; for constructors.
[[nodiscard]] const Plan& with_steps(const Plan& plan);

class PlanRunner {
 public:
  enum class Status : std::uint8_t {
    kRunning = 0,
    kDone = 1,    ///< the plan says done
    kFailed = 2,  ///< the last report's transition says why
  };

  /// @param plan as decode_plan() accepts it: every successor exists and is greater
  explicit PlanRunner(const Plan& plan);

  /// One cycle. After the end the last setpoint holds.
  GuardedMove::Output update(const GuardedMove::Input& input);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] Status status() const { return status_; }
  /// The step that the last update() belonged to.
  [[nodiscard]] std::size_t step() const { return step_; }
  /// The next update() begins a move: that of next_step().
  [[nodiscard]] bool between_moves() const { return status_ == Status::kRunning && begin_next_; }
  [[nodiscard]] std::size_t next_step() const { return next_; }
  /// That update() was the first of its move.
  [[nodiscard]] bool move_started() const { return move_started_; }
  /// Contacts held as the current move began, and as they stand.
  [[nodiscard]] ContactSignature signature_before() const { return before_; }
  [[nodiscard]] ContactSignature signature() const { return signature_; }

  [[nodiscard]] std::size_t report_count() const { return report_count_; }
  [[nodiscard]] const StepReport& report(std::size_t i) const { return reports_[i]; }

 private:
  void finish(const GuardedMove::Result& result);

  const Plan& plan_;
  Status status_ = Status::kRunning;
  std::size_t step_ = 0;
  std::size_t next_ = 0;
  std::optional<GuardedMove> move_;
  std::optional<Pose> first_;  ///< where the tool stood as the plan began
  bool begin_next_ = true;
  bool move_started_ = false;
  std::int64_t start_ns_ = 0;
  ContactSignature before_;
  ContactSignature signature_;
  GuardedMove::Output output_;
  /// Successors only grow, so no step runs twice.
  std::array<StepReport, kMaxSteps> reports_{};
  std::size_t report_count_ = 0;
};

}  // namespace tenon::executor
