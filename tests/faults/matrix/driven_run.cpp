#include "tests/faults/matrix/driven_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "shared/base/text.h"
#include "shared/config/load.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/faulty_options.h"
#include "tests/support/places.h"

namespace tenon::tests {
namespace {

using executor::State;
using sim::FaultPhase;

constexpr std::int64_t kStopAfter_ns = 300'000'000;  // of free motion, for the phase of stopping
constexpr std::int64_t kLater_ns = 400'000'000;
constexpr double kWay_m = 0.01;
constexpr std::int64_t kPause_ns = 1'000'000'000;
// A masked detector may leave a run without an end.
constexpr std::int64_t kMost_ns = 60'000'000'000;

/// A shipped one, or one that tests have a plan for.
Cell cell_named(const std::string& name) {
  const std::filesystem::path own = in_tree("tests/plans/" + name + "/cell.yaml");
  return std::filesystem::exists(own) ? load_cell(own) : shipped_cell(name);
}

/// Where the tool meets what stands in its way: halfway between two moments of a phase.
struct Meeting {
  int axis = 0;
  double sign = 0.0;
  Vector3 tool_m = Vector3::Zero();
};

Meeting meeting_in(const Ground& ground, FaultPhase phase) {
  const Vector3& from = ground.begins[static_cast<std::size_t>(phase)].tool_m;
  const Vector3 way = ground.later[static_cast<std::size_t>(phase)].tool_m - from;
  const int axis = std::abs(way.x()) > std::abs(way.y()) ? 0 : 1;
  return {axis, std::copysign(1.0, way[axis]), from + 0.5 * way};
}

}  // namespace

Ground::Ground(const std::string& cell_name, const std::string& twin, const std::string& plan_of)
    : cell(cell_named(cell_name)),
      twins(twins_of(cell.robot, twin)),
      planned(planned_box(plan_of.empty() ? cell : shipped_cell(plan_of), "1")),
      dry_run(executor::dry_run(planned.plan, cell)) {
  WholeRun::Options run_options = with_faults({});
  run_options.twins = twins;
  WholeRun run(cell, planned.task, planned.plan, run_options);
  JointVector lowest{};
  JointVector highest{};
  const auto moment = [&] {
    const sim::Truth truth = run.result().truth;
    Moment now;
    for (std::size_t i = 0; i < truth.drives.size(); ++i) now.joints[i] = truth.drives[i].position;
    now.tool_m = truth.tool.position_m;
    now.lowest = lowest;
    now.highest = highest;
    return now;
  };
  lowest = highest = start = moment().joints;
  if (!run.prepare()) return;
  std::array<int, sim::kFaultPhases> taken{};
  while (run.cycle()) {
    const JointVector joints = moment().joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      lowest[i] = std::min(lowest[i], joints[i]);
      highest[i] = std::max(highest[i], joints[i]);
    }
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const auto began_ns = run.phases().began_ns(static_cast<FaultPhase>(i));
      if (began_ns && taken[i] == 0) {
        begins[i] = moment();
        taken[i] = 1;
      } else if (began_ns && taken[i] == 1 && run.now_ns() - *began_ns > kLater_ns) {
        const Moment now = moment();
        if ((now.tool_m - begins[i].tool_m).norm() < kWay_m) continue;
        later[i] = now;
        taken[i] = 2;
      }
    }
  }
}

std::optional<Ground::WayOn> Ground::way_on(FaultPhase phase) const {
  constexpr double kLeast = 1e-4;  // m or rad, more than a joint's noise
  const Moment& from = begins[static_cast<std::size_t>(phase)];
  const Moment& to = later[static_cast<std::size_t>(phase)];
  std::optional<WayOn> best;
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const double up = 0.5 * (to.joints[i] - from.highest[i]);
    const double down = 0.5 * (from.lowest[i] - to.joints[i]);
    const WayOn way = up > down ? WayOn{i, true, up, to.joints[i] - up}
                                : WayOn{i, false, down, to.joints[i] + down};
    if (way.half > std::max(kLeast, best ? best->half : 0.0)) best = way;
  }
  return best;
}

double Ground::force_most_N(double blind_s) const {
  double speed_mps = 0.0;
  for (const ParameterSet& set : planned.plan.parameter_sets) {
    speed_mps = std::max({speed_mps, set.speeds.approach_mps, set.speeds.contact_mps});
  }
  const double noticed_s = blind_s + 2e-6 * cell.robot.cycle_us + cell.robot.response_lag_s;
  return cell.force_fault_N + cell.contact_stiffness_Npm * speed_mps * noticed_s;
}

DrivenRun::Altered DrivenRun::altered(const Ground& ground, const FaultKind& kind,
                                      FaultPhase phase) {
  Altered world{ground.cell, ground.planned.task};
  if (kind.act == Act::kJointLimit) {
    const auto way = ground.way_on(phase).value();
    Joint& joint = world.cell.robot.joints[way.joint];
    (way.up ? joint.upper : joint.lower) = way.limit;
  }
  if (kind.act == Act::kObstacle) {
    constexpr double kEdge_m = 0.05;
    const Meeting meeting = meeting_in(ground, phase);
    Shape post{"post", Shape::Kind::kBox, Vector3::Constant(kEdge_m), {}};
    post.pose.position_m = meeting.tool_m;
    post.pose.position_m[meeting.axis] +=
        meeting.sign * 0.5 * (world.task.held.front().size_m[meeting.axis] + kEdge_m);
    post.pose.position_m.z() = 0.05;
    world.task.environment.push_back(post);
  }
  return world;
}

DrivenRun::DrivenRun(const Ground& ground, const FaultKind& kind, const Strike& strike)
    : kind_(kind),
      strike_(strike),
      world_(altered(ground, kind, strike.phase)),
      // A drift is a force only when it has come to one.
      watch_(world_.cell,
             kind.spec.find("force") != std::string::npos &&
                 kind.spec.find("drifting") == std::string::npos,
             [this] { return run_.result().truth; }),
      run_(world_.cell, world_.task, ground.planned.plan, options(ground), &watch_),
      third_(run_.bus().attach()),
      rest_(world_.cell.robot) {
  if (kind.act != Act::kObstacle) return;
  const Meeting meeting = meeting_in(ground, strike.phase);
  watch_.expect_post(meeting.axis, meeting.sign, meeting.tool_m[meeting.axis]);
}

void DrivenRun::drive() {
  if (kind_.act == Act::kPause || kind_.act == Act::kLate) {
    (void)run_.run_on_clock([this](std::int64_t) { return before_a_cycle(); });
  } else if (run_.prepare()) {
    bool more = true;
    while (more && run_.now_ns() < kMost_ns) {
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

WholeRun::Options DrivenRun::options(const Ground& ground) {
  std::vector<std::string> specs;
  if (kind_.act == Act::kSpec) {
    const std::string text = spec_for(kind_, world_.cell.robot);
    const char* first = text.find(':') == std::string::npos ? ":" : ",";
    specs.push_back(text + first + "at=" + sim::to_string(strike_.phase) +
                    format(",time_s=%g", strike_.after_s));
  }
  WholeRun::Options options = with_faults(specs);
  options.controller.masked = strike_.mask;
  options.twins = ground.twins;
  options.seed = strike_.seed;
  options.offset = strike_.offset;
  options.joints = ground.start;
  options.dry_run = ground.dry_run;
  if (kind_.act == Act::kNotFinite) {
    options.tamper = [this](JointVector& position) {
      if (watch_.has_struck()) position.fill(std::numeric_limits<double>::quiet_NaN());
    };
  }
  return options;
}

std::int64_t DrivenRun::before_a_cycle() {
  const std::int64_t now_ns = run_.now_ns();
  if (run_.controller().state() >= State::kHolding) rest_.look(run_.result().truth);
  if (strike_.phase == FaultPhase::kStopping) {
    const auto free_ns = run_.phases().began_ns(FaultPhase::kFree);
    if (free_ns && now_ns - *free_ns > kStopAfter_ns) run_.controller().request_stop();
    if (run_.controller().state() == State::kStopping) {
      run_.phases().begin(FaultPhase::kStopping, now_ns);
    }
  }
  const auto began_ns = run_.phases().began_ns(strike_.phase);
  if (!began_ns || now_ns < *began_ns + static_cast<std::int64_t>(1e9 * strike_.after_s)) return 0;
  const bool first = !watch_.has_struck();
  // What happens before a cycle can first be seen in it; a pause, in the one after it.
  watch_.struck(kind_.act == Act::kSpec);
  if (first && kind_.act == Act::kOtherMaster) (void)third_.send(CanFrame{.id = 0x080});
  if (first && kind_.act == Act::kPause) return kPause_ns;
  const std::int64_t cycle_ns = std::int64_t{1000} * world_.cell.robot.cycle_us;
  return kind_.act == Act::kLate ? cycle_ns + cycle_ns / 2 : 0;
}

bool DrivenRun::black_box_is_whole() {
  const executor::BlackBox& box = run_.runner().black_box();
  if (box.size() == 0) return false;
  for (std::size_t i = 1; i < box.size(); ++i) {
    if (box.at(i).sequence != box.at(i - 1).sequence + 1) return false;
  }
  const executor::CycleRecord& last = box.at(box.size() - 1);
  return last.end_reason == static_cast<std::uint8_t>(run_.result().ending.reason);
}

}  // namespace tenon::tests
