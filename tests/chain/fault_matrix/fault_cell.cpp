#include "tests/chain/fault_matrix/fault_cell.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <utility>

#include "shared/base/text.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/faulty_options.h"
#include "tests/support/rest_watch.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndManner;
using executor::EndReason;
using executor::FaultRow;
using executor::State;
using sim::FaultPhase;

// After the phase has begun.
constexpr double kStrike_s = 0.02;
constexpr std::int64_t kStrike_ns = 20'000'000;
constexpr std::int64_t kStopAfter_ns = 300'000'000;  // of free motion, for the phase of stopping
constexpr std::int64_t kLater_ns = 400'000'000;
constexpr std::int64_t kPause_ns = 1'000'000'000;
// A masked detector may leave a run without an end.
constexpr std::int64_t kCyclesMost = 15'000;

/// Watches every cycle: when a fault can be seen, and when the run ends for one. Counts from 1.
class Watch final : public executor::CycleSink {
 public:
  /// @param of_sensor the fault is the sensor's: what it tells is false
  Watch(const Cell& cell, bool of_sensor, std::function<sim::Truth()> truth)
      : robot_(cell.robot),
        force_fault_N_(cell.force_fault_N),
        of_sensor_(of_sensor),
        truth_(std::move(truth)) {
    const double lags = 3.0 * robot_.response_lag_s / (1e-6 * robot_.cycle_us);
    window_ = static_cast<std::size_t>(std::ceil(lags)) + 4;
  }

  /// The fault has struck: in the cycle that is over, or will do so in the next.
  void struck(bool in_the_last) {
    if (struck_) return;
    struck_ = in_the_last ? cycles_ : cycles_ + 1;
    if (in_the_last) look_at_the_truth();
  }
  void record(const executor::CycleRecord& r) noexcept override {
    ++cycles_;
    if (struck_ && !behind_ && behind(r)) behind_ = cycles_;
    if (struck_) look_at_the_truth();
    commands_.push_front(r.position_commanded);
    if (commands_.size() > window_) commands_.pop_back();
    const auto reason = static_cast<EndReason>(r.end_reason);
    const bool ended = reason != EndReason::kNone && reason != EndReason::kStopRequested &&
                       reason != EndReason::kPlanDone;
    if (ended && !named_) named_ = cycles_;
    if (r.state == State::kWatching && !off_) off_ = cycles_;
    if (r.state > State::kTaring && r.state <= State::kHolding && !tared_) tared_ = cycles_;
  }

  /// Where the bound of a row counts from; unset: that never was, or only the executor can tell.
  [[nodiscard]] std::optional<std::int64_t> since(const FaultRow& row) const {
    using enum EndReason;
    const EndReason reason = row.reason;
    if (reason == kFollowingError) return behind_;
    if (reason == kBrakeFailed) return off_;
    if (row.arm_fault == ArmFaultKind::kDriveFault || row.arm_fault == ArmFaultKind::kDriveState) {
      return left_;
    }
    // What is there while the sensor is tared is no force.
    const bool forged = of_sensor_ && struck_ && tared_ && *tared_ <= *struck_;
    if (reason == kForceFault) return forged ? struck_ : pressed_;
    const bool of_wrench = reason == kTorqueFault || reason == kSensorSaturated ||
                           row.arm_fault == ArmFaultKind::kSensorInvalid;
    const bool inside = reason == kJointLimit || reason == kPlanFailed || reason == kTareMoving;
    return inside || (of_wrench && !of_sensor_) ? std::nullopt : struck_;
  }
  [[nodiscard]] std::optional<std::int64_t> named() const { return named_; }
  [[nodiscard]] std::optional<std::int64_t> off() const { return off_; }
  [[nodiscard]] bool has_struck() const { return struck_.has_value(); }
  [[nodiscard]] std::int64_t cycles() const { return cycles_; }

 private:
  void look_at_the_truth() {
    if (left_ && pressed_) return;
    const sim::Truth truth = truth_();
    // What a drive shows that is neither being enabled nor enabled.
    const bool left =
        std::any_of(truth.drives.begin(), truth.drives.end(), [](const sim::DriveTruth& drive) {
          return drive.state != "operation enabled" && drive.state != "switched on" &&
                 drive.state != "ready to switch on";
        });
    if (left && !left_) left_ = cycles_;
    if (truth.contact_force_N_max > force_fault_N_ && !pressed_) pressed_ = cycles_;
  }
  [[nodiscard]] bool behind(const executor::CycleRecord& r) const {
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const JointVector& command : commands_) {
        nearest = std::min(nearest, std::abs(command[i] - r.position[i]));
      }
      if (!commands_.empty() && nearest > robot_.joints[i].following_error_max) return true;
    }
    return false;
  }

  const Robot& robot_;
  double force_fault_N_;
  bool of_sensor_;
  std::function<sim::Truth()> truth_;
  std::size_t window_;
  std::deque<JointVector> commands_;
  std::int64_t cycles_ = 0;
  std::optional<std::int64_t> struck_;
  std::optional<std::int64_t> behind_;
  std::optional<std::int64_t> left_;
  std::optional<std::int64_t> pressed_;
  std::optional<std::int64_t> tared_;
  std::optional<std::int64_t> named_;
  std::optional<std::int64_t> off_;
};

/// The cell and the task that the run meets where the fault is one of them.
struct Altered {
  Cell cell;
  Task task;
};

Altered altered(const Ground& ground, const FaultKind& kind, FaultPhase phase) {
  Altered world{ground.cell, ground.planned.task};
  const Ground::Moment& from = ground.begins[static_cast<std::size_t>(phase)];
  const Ground::Moment& to = ground.later[static_cast<std::size_t>(phase)];
  if (kind.act == Act::kJointLimit) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < world.cell.robot.joints.size(); ++i) {
      if (std::abs(to.joints[i] - from.joints[i]) > std::abs(to.joints[most] - from.joints[most])) {
        most = i;
      }
    }
    Joint& joint = world.cell.robot.joints[most];
    const double limit = 0.5 * (from.joints[most] + to.joints[most]);
    (to.joints[most] > from.joints[most] ? joint.upper : joint.lower) = limit;
  }
  if (kind.act == Act::kObstacle) {
    constexpr double kEdge_m = 0.05;
    const Vector3 way = to.tool_m - from.tool_m;
    const int axis = std::abs(way.x()) > std::abs(way.y()) ? 0 : 1;
    Shape post{"post", Shape::Kind::kBox, Vector3::Constant(kEdge_m), {}};
    post.pose.position_m = from.tool_m + 0.5 * way;
    post.pose.position_m[axis] +=
        std::copysign(0.5 * (world.task.held.front().size_m[axis] + kEdge_m), way[axis]);
    post.pose.position_m.z() = 0.05;
    world.task.environment.push_back(post);
  }
  return world;
}

/// One run, driven cycle by cycle.
class Driven {
 public:
  Driven(const Ground& ground, const FaultKind& kind, FaultPhase phase,
         const executor::FaultMask& mask)
      : kind_(kind),
        phase_(phase),
        world_(altered(ground, kind, phase)),
        watch_(world_.cell, kind.spec.find("force") != std::string::npos,
               [this] { return run_.result().truth; }),
        run_(world_.cell, world_.task, ground.planned.plan, options(ground, mask), &watch_),
        third_(run_.bus().attach()),
        rest_(world_.cell.robot) {}

  void drive() {
    if (kind_.act == Act::kPause || kind_.act == Act::kLate) {
      (void)run_.run_on_clock([this](std::int64_t) { return before_a_cycle(); });
    } else if (run_.prepare()) {
      bool more = true;
      while (more && watch_.cycles() < kCyclesMost) {
        (void)before_a_cycle();
        if (kind_.act == Act::kKill && watch_.has_struck()) break;
        more = run_.cycle();
      }
    }
    // More than the heartbeat's timeout, the longest ramp and a brake.
    for (int i = 0; i < 150; ++i) {
      run_.leave_alone(0.01);
      rest_.look(run_.result().truth);
    }
  }

  [[nodiscard]] const Watch& watch() const { return watch_; }
  [[nodiscard]] const RestWatch& rest() const { return rest_; }
  [[nodiscard]] WholeRun::Result result() const { return run_.result(); }

 private:
  [[nodiscard]] WholeRun::Options options(const Ground& ground, const executor::FaultMask& mask) {
    std::vector<std::string> specs;
    if (kind_.act == Act::kSpec) {
      const std::string text = spec_for(kind_, world_.cell.robot);
      const char* first = text.find(':') == std::string::npos ? ":" : ",";
      specs.push_back(text + first + "at=" + sim::to_string(phase_) +
                      format(",time_s=%g", kStrike_s));
    }
    WholeRun::Options options = with_faults(specs);
    options.controller.masked = mask;
    options.joints = ground.start;
    options.dry_run = ground.dry_run;
    if (kind_.act == Act::kNotFinite) {
      options.tamper = [this](JointVector& position) {
        if (watch_.has_struck()) position.fill(std::numeric_limits<double>::quiet_NaN());
      };
    }
    return options;
  }

  /// Stops, strikes. @return by how much the loop wakes up late, ns
  std::int64_t before_a_cycle() {
    const std::int64_t now_ns = run_.now_ns();
    if (run_.controller().state() >= State::kHolding) rest_.look(run_.result().truth);
    if (phase_ == FaultPhase::kStopping) {
      const auto free_ns = run_.phases().began_ns(FaultPhase::kFree);
      if (free_ns && now_ns - *free_ns > kStopAfter_ns) run_.controller().request_stop();
      if (run_.controller().state() == State::kStopping) {
        run_.phases().begin(FaultPhase::kStopping, now_ns);
      }
    }
    const auto began_ns = run_.phases().began_ns(phase_);
    if (!began_ns || now_ns < *began_ns + kStrike_ns) return 0;
    const bool first = !watch_.has_struck();
    // What happens before a cycle can first be seen in it; a pause, in the one after it.
    watch_.struck(kind_.act == Act::kSpec);
    if (first && kind_.act == Act::kOtherMaster) (void)third_.send(CanFrame{.id = 0x080});
    if (first && kind_.act == Act::kPause) return kPause_ns;
    const std::int64_t cycle_ns = std::int64_t{1000} * world_.cell.robot.cycle_us;
    return kind_.act == Act::kLate ? cycle_ns + cycle_ns / 2 : 0;
  }

  const FaultKind& kind_;
  FaultPhase phase_;
  Altered world_;
  Watch watch_;
  WholeRun run_;
  CanBus& third_;
  RestWatch rest_;
};

std::string promise_of(const FaultKind& kind) {
  std::string all;
  for (const FaultRow* row : kind.names) all += (all.empty() ? "" : " or ") + full_name(*row);
  return all.empty() ? "ridden out" : all;
}

/// In cycles from when the fault can be seen; what no time bounds is bounded by the run's end.
std::int64_t most_cycles(const FaultRow& row, const Robot& robot) {
  return executor::bound_cycles(row, robot).value_or(std::numeric_limits<std::int64_t>::max());
}

void judge_named(Outcome& outcome, const Driven& run, const FaultKind& kind, const Ground& ground) {
  const executor::Ending ending = run.result().ending;
  const FaultRow* row = executor::fault_row(ending.reason, ending.arm_fault.kind);
  outcome.verdict = Outcome::Verdict::kStopped;
  outcome.named = row;
  const auto since = row == nullptr ? std::nullopt : run.watch().since(*row);
  const std::int64_t took = run.watch().named().value_or(0) - since.value_or(0) + 1;
  const std::int64_t most = row == nullptr ? 0 : most_cycles(*row, ground.cell.robot);
  outcome.text = row == nullptr ? "no row" : full_name(*row);
  if (since) outcome.text += format(" %lld", static_cast<long long>(took));
  if (std::find(kind.names.begin(), kind.names.end(), row) == kind.names.end()) {
    outcome.complaint = "promised: " + promise_of(kind) + "; " + run.result().reason;
  } else if (since && (took < 1 || took > most)) {
    outcome.complaint = format("took %lld cycles, at most %lld", static_cast<long long>(took),
                               static_cast<long long>(most));
  }
}

/// Without a name: right where there was none to give, or the run was over before it was due.
void judge_unnamed(Outcome& outcome, const Driven& run, const FaultKind& kind, const Ground& ground,
                   FaultPhase phase) {
  const WholeRun::Result result = run.result();
  const EndReason wanted =
      phase == FaultPhase::kStopping ? EndReason::kStopRequested : EndReason::kPlanDone;
  outcome.text = "ridden out";
  if (result.ending.reason != wanted) {
    outcome.complaint = "ended otherwise: " + result.reason;
  } else if (wanted == EndReason::kPlanDone && !result.truth.within_tolerance) {
    outcome.complaint = format("done but wrong by %.2f mm", 1e3 * result.truth.error_norm_m);
  }
  const std::int64_t over = run.watch().off().value_or(run.watch().cycles());
  for (const FaultRow* row : kind.names) {
    const auto since = run.watch().since(*row);
    const bool due = since && over - *since > most_cycles(*row, ground.cell.robot);
    // What only the executor can tell is promised wherever it can be.
    if (due || kind.while_moving_only) outcome.complaint = "promised: " + promise_of(kind);
  }
}

/// The end state, by the truth.
void judge_end_state(Outcome& outcome, const Driven& run, const FaultKind& kind,
                     const Ground& ground) {
  const bool slips =
      outcome.named != nullptr && outcome.named->end_state == executor::EndState::kBrakeSlips;
  const std::string left = run.rest().complaints();
  if (!slips && !left.empty()) outcome.complaint += "; left as: " + left;
  if (slips && !run.rest().off()) outcome.complaint += "; left as: " + left;
  const double force_N = run.result().truth.contact_force_N_max;
  // An arm that falls presses as it falls, and one that its encoder deceives before anyone knows.
  if (!slips && !kind.drive_moves_by_itself && force_N > ground.force_most_N()) {
    outcome.complaint += format("; pressed with %.0f N", force_N);
  }
}

bool impossible(const FaultKind& kind, FaultPhase phase) {
  return kind.while_moving_only && phase != FaultPhase::kFree && phase != FaultPhase::kSliding;
}

}  // namespace

Ground::Ground(const std::string& cell_name)
    : cell(shipped_cell(cell_name)),
      planned(planned_box(cell, "1")),
      dry_run(executor::dry_run(planned.plan, cell)) {
  WholeRun run(cell, planned.task, planned.plan, with_faults({}));
  const auto moment = [&] {
    const sim::Truth truth = run.result().truth;
    Moment now;
    for (std::size_t i = 0; i < truth.drives.size(); ++i) now.joints[i] = truth.drives[i].position;
    now.tool_m = truth.tool.position_m;
    return now;
  };
  start = moment().joints;
  if (!run.prepare()) return;
  std::array<int, sim::kFaultPhases> taken{};
  while (run.cycle()) {
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const auto began_ns = run.phases().began_ns(static_cast<FaultPhase>(i));
      if (began_ns && taken[i] == 0) {
        begins[i] = moment();
        taken[i] = 1;
      } else if (began_ns && taken[i] == 1 && run.now_ns() - *began_ns > kLater_ns) {
        later[i] = moment();
        taken[i] = 2;
      }
    }
  }
}

double Ground::force_most_N() const {
  double speed_mps = 0.0;
  for (const ParameterSet& set : planned.plan.parameter_sets) {
    speed_mps = std::max({speed_mps, set.speeds.approach_mps, set.speeds.contact_mps});
  }
  const double noticed_s = 2e-6 * cell.robot.cycle_us + cell.robot.response_lag_s;
  return cell.force_fault_N + cell.contact_stiffness_Npm * speed_mps * noticed_s;
}

Outcome run_cell(const Ground& ground, const FaultKind& kind, FaultPhase phase,
                 const executor::FaultMask& mask) {
  Outcome outcome;
  if (impossible(kind, phase)) {
    outcome.verdict = Outcome::Verdict::kImpossible;
    outcome.text = "-";
    return outcome;
  }
  Driven run(ground, kind, phase, mask);
  run.drive();
  const EndReason reason = run.result().ending.reason;
  const bool orderly = reason == EndReason::kPlanDone || reason == EndReason::kStopRequested;
  if (!run.watch().has_struck()) {
    outcome.text = "?";
    outcome.complaint = "the phase never came: " + run.result().reason;
  } else if (kind.act == Act::kKill) {
    outcome.verdict = Outcome::Verdict::kKilled;
    outcome.text = "stopped by the drives";
  } else if (orderly || reason == EndReason::kNone) {
    judge_unnamed(outcome, run, kind, ground, phase);
  } else {
    judge_named(outcome, run, kind, ground);
  }
  judge_end_state(outcome, run, kind, ground);
  return outcome;
}

}  // namespace tenon::tests
