#include "sim/cell/virtual_arm/virtual_cell.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "shared/base/error.h"
#include "shared/base/time_units.h"
#include "shared/task/find_start.h"
#include "shared/task/inserted.h"
#include "shared/task/pose_error.h"
#include "sim/cell/devices/robot_devices.h"
#include "sim/cell/faults/bus_faults.h"
#include "sim/cell/faults/fault_check.h"
#include "sim/cell/faults/fault_spec.h"
#include "sim/cell/virtual_arm/arm_body.h"
#include "sim/cell/virtual_arm/cell_watch.h"
#include "sim/cell/virtual_arm/demand_delay.h"
#include "sim/cell/virtual_arm/drive_friction.h"
#include "sim/cell/virtual_arm/effort_mean.h"
#include "sim/cell/virtual_arm/moment_maker.h"
#include "sim/cell/virtual_arm/start_joints.h"

namespace tenon::sim {
namespace {

constexpr double kOverlapMax_m = 1e-5;
constexpr double kStandstill = 1e-4;  // m/s or rad/s
/// Who calls each millisecond is at most this behind, a step of physics being half of one.
constexpr std::int64_t kAwake_ns = 1'500'000;

SensorImperfections sensor_imperfections(const WorldDraw& world) {
  SensorImperfections imperfections;
  imperfections.force_drift_N_sqrts = world.force_drift_N_sqrts;
  imperfections.torque_drift_Nm_sqrts = world.torque_drift_Nm_sqrts;
  return imperfections;
}

bool is_sync(const CanFrame& frame) { return frame.id == canopen::kSync && !frame.extended; }
bool is_arms_sync(const CanFrame& frame) { return is_sync(frame) && frame.bus == kArmBus; }

std::size_t delay_steps(const VirtualCell::Options& options) {
  const double step_s = static_cast<double>(options.physics_step_ns) / kNanosecondsPerSecond;
  return static_cast<std::size_t>(std::lround(options.world.extra_delay_s / step_s));
}

std::size_t steps_in_cycle(const Robot& robot, const VirtualCell::Options& options) {
  const std::int64_t steps = std::int64_t{1000} * robot.cycle_us / options.physics_step_ns;
  return static_cast<std::size_t>(std::max<std::int64_t>(1, steps));
}

/// Those of devices, the earliest last.
std::vector<Fault> pending_faults(const Robot& robot, const std::vector<Fault>& all) {
  check_faults(all, robot);
  std::vector<Fault> faults = faults_of_devices(all, robot.master_node);
  for (Fault& fault : faults) {
    if (fault.node == 0 && target_of(fault.kind) == FaultTarget::kSensor) {
      fault.node = robot.sensor.node;
    }
  }
  std::stable_sort(faults.begin(), faults.end(),
                   [](const Fault& a, const Fault& b) { return a.time_s > b.time_s; });
  return faults;
}

ArmBody::Parameters arm_parameters(const Cell& cell, const Cell& real, const Task& task,
                                   const VirtualCell::Options& options) {
  ArmBody::Parameters parameters;
  // The master knows the cell as its file has it, and drives the arm to the start by that.
  parameters.start = options.joints ? *options.joints
                                    : start_joints(cell, start_or_first(task, options.start).pose);
  parameters.X_BE = compose(real.X_BT, environment_pose(options.offset, task.error_about_m));
  // The protocol's part is in the drives already.
  const double protocol_s = protocol_lag_s(1e-6 * cell.robot.cycle_us);
  parameters.servo_lag_s = std::max(0.0, cell.robot.response_lag_s - protocol_s);
  parameters.backlash_m = options.world.backlash_m;
  parameters.backlash_rad = options.world.backlash_rad;
  parameters.contact_law.friction = options.world.friction.value_or(task.friction.nominal);
  parameters.contact_law.stiffness_Npm = real.contact_stiffness_Npm;
  return parameters;
}

}  // namespace

class VirtualCell::Impl {
 public:
  Impl(const Cell& cell, const Task& task, const Options& options)
      : cell_(real_cell(cell, options.world)),
        task_(task),
        options_(options),
        start_name_(start_or_first(task, options.start).name),
        faults_to_come_(pending_faults(cell.robot, options.faults)),
        phases_(options.phases != nullptr ? *options.phases : own_phases_),
        arm_(cell_, real_task(task, options.world), arm_parameters(cell, cell_, task, options)),
        drives_(virtual_drives(cell.robot, options.twins)),
        sensor_(
            virtual_sensor(cell_.robot.sensor, options.seed, sensor_imperfections(options.world))),
        delay_(cell.robot.joints.size(), delay_steps(options)),
        efforts_(cell.robot.joints.size(), steps_in_cycle(cell.robot, options),
                 options.effort_noise_permille, options.seed),
        cycle_ns_(std::int64_t{1000} * cell.robot.cycle_us) {
    make_friction();
    check_faults();
    if (arm_.overlap_m() > kOverlapMax_m) {
      throw InputError(
          "task " + task.name + ": at start \"" + start_name_ + "\" the part stands " +
          std::to_string(arm_.overlap_m()) +
          " m deep in the displaced environment; choose another start, seed or offset");
    }
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i]->measured(measure(i), 0);
  }

  void step(std::int64_t now_ns, CanBus& bus);
  [[nodiscard]] Truth truth() const;
  [[nodiscard]] CellMoment moment() { return moment_.take(time_ns()); }
  [[nodiscard]] Pose environment() const {
    return compose(cell_.X_BT, environment_pose(options_.offset, task_.error_about_m));
  }
  [[nodiscard]] std::int64_t physics_cost_ns() const { return physics_cost_ns_; }
  [[nodiscard]] bool at_standstill() const;

 private:
  void make_friction();
  void check_faults() const;
  void power_on(std::int64_t now_ns);
  void advance_physics(std::int64_t now_ns);
  void physics_step();
  void inject_faults();
  [[nodiscard]] std::int64_t sync_time_ns(std::int64_t now_ns, std::int64_t syncs_left) const;
  void deliver(const CanFrame& frame, std::int64_t now_ns);
  void pass_wrench();
  void send(CanBus& bus, bool arbitrate);
  [[nodiscard]] VirtualDrive::Measurement measure(std::size_t i) const;
  /// Of physics, since the cell was switched on.
  [[nodiscard]] std::int64_t time_ns() const { return physics_ns_ - on_ns_; }
  [[nodiscard]] std::int64_t stopwatch_ns() const {
    return options_.stopwatch_ns != nullptr ? options_.stopwatch_ns() : 0;
  }

  Cell cell_;  ///< the real one
  Task task_;  ///< the nominal one
  Options options_;
  std::string start_name_;
  std::vector<Fault> faults_to_come_;  ///< the earliest last
  FaultPhases own_phases_;
  FaultPhases& phases_;
  ArmBody arm_;
  VirtualDrives drives_;
  std::unique_ptr<VirtualSensor> sensor_;
  DemandDelay delay_;
  std::vector<FrictionState> friction_;  ///< of the drives; empty: none
  EffortMean efforts_;                   ///< as the drives report them
  std::uint32_t powered_ = 0;            ///< bit i: drive i gave effort in the last step

  bool on_ = false;
  std::int64_t on_ns_ = 0;
  std::int64_t physics_ns_ = 0;
  std::int64_t sync_ns_ = 0;  ///< when the last SYNC acted
  std::int64_t physics_cost_ns_ = 0;
  // The sensor reports the mean since its last sample, as sensors that sample faster do.
  Vector6 wrench_sum_ = Vector6::Zero();
  int wrench_count_ = 0;
  std::int64_t cycle_ns_;
  std::vector<CanFrame> incoming_;
  std::vector<CanFrame> outgoing_;
  std::uint64_t frames_not_sent_ = 0;

  CellWatch watch_{cell_.robot, drives_, arm_, phases_};
  MomentMaker moment_{drives_, arm_};
};

void VirtualCell::Impl::make_friction() {
  const std::vector<DriveFriction>& drawn = options_.world.drive_friction;
  for (std::size_t i = 0; i < drives_.size() && i < drawn.size(); ++i) {
    friction_.emplace_back(cell_.robot.joints[i], drawn[i], arm_.joint(i).position);
  }
}

void VirtualCell::Impl::check_faults() const {
  for (const Fault& fault : faults_to_come_) {
    for (const auto& drive : drives_) {
      if (drive->number() != fault.node || drive->can_have(fault)) continue;
      if (target_of(fault.kind) == FaultTarget::kSensor) continue;
      throw InputError(std::string("fault ") + to_string(fault.kind) + ": robot " +
                       cell_.robot.name + " has no drive that can have it at node " +
                       std::to_string(fault.node) + "; --fault help lists all");
    }
  }
}

void VirtualCell::Impl::power_on(std::int64_t now_ns) {
  on_ = true;
  on_ns_ = physics_ns_ = now_ns;
  for (const auto& drive : drives_) drive->power_on(now_ns);
  watch_.power_on();
  sensor_->power_on(now_ns);
}

void VirtualCell::Impl::step(std::int64_t now_ns, CanBus& bus) {
  if (!on_) power_on(now_ns);
  send(bus, false);
  incoming_.clear();
  ReceivedFrame received;
  while (bus.receive(received)) incoming_.push_back(received.frame);
  std::int64_t syncs_left = std::count_if(incoming_.begin(), incoming_.end(), is_arms_sync);
  for (const CanFrame& frame : incoming_) {
    if (is_arms_sync(frame)) {
      --syncs_left;
      sync_ns_ = sync_time_ns(now_ns, syncs_left);
      advance_physics(sync_ns_);
    }
    deliver(frame, now_ns);
    send(bus, is_sync(frame));
  }
  advance_physics(now_ns);
  for (const auto& drive : drives_) drive->advance(now_ns);
  sensor_->advance(now_ns);
  send(bus, false);
  watch_.look_at_drives(time_ns());
}

// A SYNC that was due while the caller slept acts when due: who calls late must not shake the arm.
std::int64_t VirtualCell::Impl::sync_time_ns(std::int64_t now_ns, std::int64_t syncs_left) const {
  const std::int64_t latest_ns = now_ns - syncs_left * cycle_ns_;  // several came a cycle apart
  const std::int64_t due_ns = sync_ns_ + cycle_ns_;
  if (now_ns - physics_ns_ <= kAwake_ns || due_ns < physics_ns_) return latest_ns;
  return std::min(due_ns, latest_ns);
}

void VirtualCell::Impl::deliver(const CanFrame& frame, std::int64_t now_ns) {
  if (frame.bus == kArmBus) {
    for (const auto& drive : drives_) drive->receive(frame, now_ns);
  }
  if (frame.bus != cell_.robot.sensor.bus()) return;
  if (sensor_->is_asked_by(frame)) pass_wrench();
  sensor_->receive(frame, now_ns);
}

void VirtualCell::Impl::advance_physics(std::int64_t now_ns) {
  while (physics_ns_ + options_.physics_step_ns <= now_ns) {
    inject_faults();
    physics_step();
    if (!sensor_->is_due(physics_ns_)) continue;
    pass_wrench();
    sensor_->stream(physics_ns_);
  }
}

void VirtualCell::Impl::physics_step() {
  const std::int64_t step_ns = options_.physics_step_ns;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Joint& joint = cell_.robot.joints[i];
    const VirtualDrive::Demand demand = drives_[i]->demand(step_ns);
    delay_.now()[i] = {demand.brake,
                       demand.powered,
                       (demand.position_counts - joint.zero_counts) / joint.counts_per_unit,
                       demand.velocity_countsps / joint.counts_per_unit,
                       demand.torque_max_permille / kPermille * joint.rated_effort,
                       demand.impedance};
  }
  const std::int64_t before_ns = stopwatch_ns();
  const std::span<const ServoJoint::Demand> demands = delay_.delayed();
  arm_.step(demands, static_cast<double>(step_ns) / kNanosecondsPerSecond);
  physics_cost_ns_ += stopwatch_ns() - before_ns;
  physics_ns_ += step_ns;
  powered_ = 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (demands[i].powered && !demands[i].brake) powered_ |= 1U << i;
    if (i < friction_.size()) friction_[i].update(arm_.joint(i).position, arm_.joint(i).velocity);
    const bool rubs = i < friction_.size() && (powered_ >> i & 1U) != 0;
    efforts_.add(i, arm_.joint(i).effort + (rubs ? friction_[i].effort() : 0.0));
  }
  efforts_.next();
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i]->measured(measure(i), step_ns);
  wrench_sum_ += arm_.wrench();
  ++wrench_count_;
  watch_.look_at_drives(time_ns());
  watch_.look_at_contacts(time_ns());
  watch_.look_at_phases(physics_ns_);
  if (options_.watched) moment_.look();
}

void VirtualCell::Impl::inject_faults() {
  const auto is_due = [this](const Fault& fault) {
    const auto begins_ns = begin_ns(fault, on_ns_, &phases_);
    return begins_ns && *begins_ns <= physics_ns_;
  };
  // Few: what waits for a phase may come before what waits for a time.
  for (std::size_t left = faults_to_come_.size(); left-- > 0;) {
    if (!is_due(faults_to_come_[left])) continue;
    const Fault fault = faults_to_come_[left];
    faults_to_come_.erase(faults_to_come_.begin() + static_cast<std::ptrdiff_t>(left));
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      if (cell_.robot.joints[i].node == fault.node) drives_[i]->inject(fault);
    }
    if (cell_.robot.sensor.node == fault.node) sensor_->inject(fault);
    watch_.events().add(time_ns(), "fault " + std::string(to_string(fault.kind)) + ", node " +
                                       std::to_string(fault.node));
  }
}

VirtualDrive::Measurement VirtualCell::Impl::measure(std::size_t i) const {
  const Joint& joint = cell_.robot.joints[i];
  const ServoJoint::State& state = arm_.joint(i);
  return {state.encoder * joint.counts_per_unit + joint.zero_counts,
          state.velocity * joint.counts_per_unit, kPermille * efforts_.of(i) / joint.rated_effort,
          efforts_.off_permille(i)};
}

void VirtualCell::Impl::pass_wrench() {
  if (wrench_count_ == 0) return;
  sensor_->measured(wrench_sum_ / wrench_count_, wrench_count_ * options_.physics_step_ns);
  wrench_sum_ = Vector6::Zero();
  wrench_count_ = 0;
}

void VirtualCell::Impl::send(CanBus& bus, bool arbitrate) {
  outgoing_.clear();
  for (const auto& drive : drives_) drive->take(outgoing_);
  const std::size_t of_drives = outgoing_.size();
  sensor_->take(outgoing_);
  for (CanFrame& frame : std::span(outgoing_).subspan(of_drives)) {
    frame.bus = cell_.robot.sensor.bus();
  }
  // Frames that become ready together leave by priority.
  if (arbitrate) {
    std::stable_sort(outgoing_.begin(), outgoing_.end(),
                     [](const CanFrame& a, const CanFrame& b) { return a.id < b.id; });
  }
  for (const CanFrame& frame : outgoing_) {
    if (bus.send(frame) != SendResult::kSent) ++frames_not_sent_;
    if (frame.id > canopen::kEmergency && frame.id < canopen::kTpdo1) {
      watch_.events().emergency(time_ns(), frame);
    }
  }
}

Truth VirtualCell::Impl::truth() const {
  Truth truth;
  truth.task = task_.name;
  truth.start = start_name_;
  truth.seed = options_.seed;
  truth.time_s = static_cast<double>(time_ns()) / kNanosecondsPerSecond;
  truth.offset = options_.offset;
  truth.world = options_.world;
  truth.world.friction = options_.world.friction.value_or(task_.friction.nominal);
  truth.world.contact_stiffness_Npm = cell_.contact_stiffness_Npm;
  truth.tool = compose(inverse(environment()), arm_.tool());
  truth.error = displacement_between(task_.goal, truth.tool);
  truth.error_norm_m = truth.error.head<3>().norm();
  truth.error_norm_rad = truth.error.tail<3>().norm();
  truth.goal_tolerance_m = task_.goal_tolerance_m;
  truth.goal_axes = task_.goal_axes;
  truth.within_tolerance = within_tolerance(task_, truth.tool);
  truth.contact_force_N_max = watch_.contact_force_N_max();
  truth.touching = arm_.scene().touching();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const VirtualDrive::Look look = drives_[i]->look();
    truth.drives.push_back({cell_.robot.joints[i].name, cell_.robot.joints[i].node, look.state,
                            look.brake_engaged, look.operational, look.error_code,
                            arm_.joint(i).position});
  }
  truth.faults = watch_.faults();
  truth.solver_messages = arm_.solver_messages();
  truth.frames_not_sent = frames_not_sent_;
  truth.events = watch_.events().events();
  return truth;
}

bool VirtualCell::Impl::at_standstill() const {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (std::abs(arm_.joint(i).velocity) > kStandstill) return false;
  }
  return true;
}

VirtualCell::VirtualCell(const Cell& cell, const Task& task, const Options& options)
    : impl_(std::make_unique<Impl>(cell, task, options)) {}

VirtualCell::~VirtualCell() = default;

void VirtualCell::step(std::int64_t now_ns, CanBus& bus) { impl_->step(now_ns, bus); }

Truth VirtualCell::truth() const { return impl_->truth(); }

CellMoment VirtualCell::moment() { return impl_->moment(); }

Pose VirtualCell::environment() const { return impl_->environment(); }

std::int64_t VirtualCell::physics_cost_ns() const { return impl_->physics_cost_ns(); }

bool VirtualCell::at_standstill() const { return impl_->at_standstill(); }

}  // namespace tenon::sim
