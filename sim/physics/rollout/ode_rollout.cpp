#include "sim/physics/rollout/ode_rollout.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "shared/ports/collision_depth.h"
#include "sim/physics/contacts/contact_law.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/scene.h"
#include "sim/physics/solver/locked_contacts.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {
namespace {

// A part this deep inside another has gone through it; the force limit alone presses far less.
constexpr double kTunnelled_m = 5e-3;
// Where two solids meet, a point that is pressed in deeper than it is beside an edge is taken to
// have come from that side. So none comes in by more than this between two looks at the contacts,
// or than the way of a sixteenth of a step.
constexpr double kImpact_m = 10e-6;
constexpr int kHalvingsMax = 4;
constexpr std::int64_t kMicrosecond_ns = 1000;
constexpr double kMicrosecond_s = 1e-6;

/// Whether the moves that these parameters tell of can rotate the tool.
bool turns(const MoveParameters& move) {
  constexpr unsigned kRotations = 0b111000;
  return (move.compliance.compliant_axes & kRotations) != 0 ||
         !move.displacement.tail<3>().isZero(0.0);
}

/// That holds a particle's tool where it is at rest.
Vector3 resting_force_N(const Particle& particle, const MoveParameters& move) {
  Vector3 force_N;
  for (int axis = 0; axis < 3; ++axis) {
    force_N[axis] = move.thresholds.force_keep_N * particle.signature.sign(axis);
  }
  return force_N;
}

/// Rounded up to whole steps of the task's, so that half of them see the same, and from those to
/// steps that are longer.
std::size_t steps_of(double latency_s, std::int64_t task_step_us, std::int64_t step_us) {
  constexpr double kRounding = 1e-6;  // of a value that a plan file holds
  const double whole = std::ceil((1.0 - kRounding) * latency_s /
                                 (kMicrosecond_s * static_cast<double>(task_step_us)));
  const std::int64_t latency_us = static_cast<std::int64_t>(whole) * task_step_us;
  return static_cast<std::size_t>((latency_us + step_us - 1) / step_us);
}

}  // namespace

/// What a move sees of the plant, so many steps late.
class LateView {
 public:
  void begin(std::size_t steps_late) {
    ring_.resize(steps_late + 1);
    now_ = 0;
    full_ = false;
  }

  /// Takes what is, and shows what was; as long as nothing has come through, `input` is left.
  void pass(const Pose& pose, const Vector6& wrench, GuardedMove::Input& input) {
    ring_[now_] = {pose, wrench};
    now_ = (now_ + 1) % ring_.size();
    full_ = full_ || now_ == 0;
    if (!full_) return;
    input.pose = ring_[now_].pose;
    input.wrench = ring_[now_].wrench;
    input.wrench_fresh = true;
  }

 private:
  struct Seen {
    Pose pose;
    Vector6 wrench;
  };
  std::vector<Seen> ring_;
  std::size_t now_ = 0;  ///< to be written next: the oldest once the ring is full
  bool full_ = false;
};

struct OdeRollout::Physics {
  Physics(const Task& task, MeshDistances distances)
      : scene(task.held, task.environment, {}, distances),
        sampled(distances == MeshDistances::kSampled),
        tool(world, task.compliance) {
    scene.attach(tool.body());
  }

  void begin(const Particle& particle, const MoveParameters& move) {
    turning = turns(move);
    const double series_Npm = particle.physics.contact_stiffness_Npm;
    law = {particle.physics.friction, part_stiffness_Npm(series_Npm)};
    tool.set_compliance(move.compliance, turning, {arm_give_mpN(series_Npm)});
    tool.place(particle.pose, resting_force_N(particle, move));
    scene.place_environment(particle.environment);
    scene.set_oversize(particle.physics.oversize_m);
    // What is known of exact distances goes on to hold. Sampled ones may rise faster than the way:
    // nothing that was seen before may have a part in what a move does.
    if (sampled) {
      scene.moved_anywhere();
    } else {
      scene.placed();
    }
    wrench.setZero();
    sensor_error_m = particle.physics.sensor_error_m;
    known.reset();
  }

  /// One step of the plant. @return deepest overlap before it
  double step(const GuardedMove::Setpoint& setpoint, double step_s, int halvings = kHalvingsMax) {
    if (!scene.has_solids()) return leap(setpoint, step_s);
    const CompliantTool::State before = tool.state();
    const Vector6 wrench_before = wrench;
    const double depth_m = leap(setpoint, step_s);
    if (halvings == 0 || scene.clearance_m() > 0.0) return depth_m;
    tool.show();
    known = scene.find_contacts(turning);
    if (known->depth_max_m <= depth_m + kImpact_m) return depth_m;
    const Pose there = tool.part_pose();
    tool.return_to(before);
    wrench = wrench_before;
    moved_from(there);
    (void)step(setpoint, 0.5 * step_s, halvings - 1);
    (void)step(setpoint, 0.5 * step_s, halvings - 1);
    return depth_m;
  }

  /// A step, whatever it meets. @return deepest overlap before it
  double leap(const GuardedMove::Setpoint& setpoint, double step_s) {
    if (scene.clearance_m() > 0.0) {
      wrench.setZero();
      fly(setpoint, step_s);
      return 0.0;
    }
    tool.show();
    const Scene::Contacts contacts = known ? *known : scene.find_contacts(turning);
    if (contacts.points == 0) {
      wrench.setZero();
      fly(setpoint, step_s);
    } else if (turning || !slide(setpoint, step_s)) {
      solve(setpoint, step_s);
    }
    return contacts.depth_max_m;
  }

  /// Under the wrench as it stands.
  void fly(const GuardedMove::Setpoint& setpoint, double step_s) {
    const Pose before = tool.part_pose();
    tool.fly(setpoint, step_s, wrench);
    moved_from(before);
  }

  /// @return false where the contacts need the solver, turning or not
  bool slide(const GuardedMove::Setpoint& setpoint, double step_s) {
    if (!locked.solve(scene.points(), law, tool.free_velocity_mps(setpoint, step_s),
                      tool.give_mpspN(step_s), step_s)) {
      return false;
    }
    wrench = locked.wrench_about(tool.part_pose().position_m);
    fly(setpoint, step_s);
    return true;
  }

  void solve(const GuardedMove::Setpoint& setpoint, double step_s) {
    const Pose before = tool.part_pose();
    scene.make_joints(world, step_s, law);
    // The force hardly changes within a step, and next to the damping it turns the tool by little.
    tool.drive(setpoint, step_s, imagined_Nm());
    world.step(step_s);
    tool.follow();
    wrench = scene.wrench();
    moved_from(before);
  }

  void moved_from(const Pose& before) {
    known.reset();
    const Pose now = tool.part_pose();
    double most_m = (now.position_m - before.position_m).norm();
    if (turning) {
      most_m += scene.reach_m() * before.orientation.angularDistance(now.orientation);
    }
    scene.moved(most_m);
  }

  /// About the tool, by the force at its lever to where the arm takes the sensor to be.
  [[nodiscard]] Vector3 imagined_Nm() const {
    if (sensor_error_m.isZero(0.0)) return Vector3::Zero();
    return Vector3(wrench.head<3>()).cross(tool.pose().orientation * sensor_error_m);
  }
  /// The wrench about the tool as the arm has it from its sensor.
  [[nodiscard]] Vector6 felt() const {
    Vector6 felt = wrench;
    if (!sensor_error_m.isZero(0.0)) felt.tail<3>() += imagined_Nm();
    return felt;
  }

  OdeWorld world;
  Scene scene;
  bool sampled;
  CompliantTool tool;
  LockedContacts locked;
  ContactLaw law;
  std::optional<Scene::Contacts> known;  ///< as all stands
  LateView view;
  bool turning = true;
  Vector6 wrench = Vector6::Zero();
  Vector3 sensor_error_m = Vector3::Zero();
};

OdeRollout::OdeRollout(const Task& task, MeshDistances distances)
    : task_(task), distances_(distances), physics_(std::make_unique<Physics>(task, distances)) {}

OdeRollout::~OdeRollout() = default;

RolloutResult OdeRollout::simulate(const Particle& particle, const MoveParameters& move,
                                   std::int64_t step_us, std::vector<TraceSample>* trace) {
  Physics& p = *physics_;
  const double step_s = kMicrosecond_s * static_cast<double>(step_us);
  const std::uint64_t messages_before = ode_messages();
  p.begin(particle, move);
  p.view.begin(steps_of(particle.physics.latency_s, task_.rollout_step_us, step_us));

  GuardedMove guarded(move, particle.signature);
  GuardedMove::Input input;
  input.pose = p.tool.pose();
  input.wrench_fresh = false;  // nothing has been measured yet
  RolloutResult result;
  for (;;) {
    const GuardedMove::Output output = guarded.update(input);
    if (trace != nullptr) trace->push_back({input, output.setpoint});
    if (output.phase == GuardedMove::Phase::kDone) break;

    if (p.step(output.setpoint, step_s) > kTunnelled_m) {
      result.failure = "a part has gone through another";
      return result;
    }
    input.time_ns += step_us * kMicrosecond_ns;
    p.view.pass(p.tool.pose(), p.felt(), input);
  }
  if (ode_messages() != messages_before) {
    result.failure = "the contact solver did not converge";
    return result;
  }
  result.valid = true;
  result.move = *guarded.result();
  result.touching = p.scene.touching();
  return result;
}

bool OdeRollout::in_collision(const Pose& tool_pose) {
  physics_->tool.place(tool_pose);
  physics_->scene.place_environment({});
  physics_->scene.set_oversize(task_.oversize_m);
  return physics_->scene.overlap_m(kCollisionDepth_m) > kCollisionDepth_m;
}

std::unique_ptr<Rollout> OdeRollout::clone() const {
  return std::make_unique<OdeRollout>(task_, distances_);
}

}  // namespace tenon::sim
