#include "sim/virtual_arm/virtual_cell.h"

#include <algorithm>
#include <deque>
#include <set>
#include <vector>

#include "shared/base/error.h"
#include "sim/devices/drive_402.h"
#include "sim/devices/force_torque_node.h"
#include "sim/virtual_arm/arm_body.h"
#include "sim/virtual_arm/environment_offset.h"
#include "sim/virtual_arm/event_log.h"
#include "sim/virtual_arm/start_joints.h"

namespace tenon::sim {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;
constexpr double kOverlapMax_m = 1e-5;
constexpr double kStandstill_mps = 1e-4;
constexpr double kPermille = 1000.0;

Drive402::Parameters drive_parameters(const Joint& joint) {
  Drive402::Parameters parameters;
  parameters.node = joint.node;
  parameters.name = "tenon virtual drive " + joint.name;
  parameters.mode = static_cast<std::int8_t>(joint.mode);
  parameters.quick_stop_counts_ps2 =
      static_cast<std::uint32_t>(std::abs(joint.counts_per_unit) * joint.acceleration_max);
  return parameters;
}

bool is_sync(const CanFrame& frame) { return frame.id == canopen::kSync && !frame.extended; }

ArmBody::Parameters arm_parameters(const Cell& cell, const Task& task,
                                   const VirtualCell::Options& options) {
  ArmBody::Parameters parameters;
  parameters.start_m = options.joints_m ? *options.joints_m
                                        : start_joints(cell, find_start(task, options.start).pose);
  parameters.X_BE = compose(cell.X_BT, displaced(Pose{}, options.offset));
  // Taking up a target with the next SYNC and interpolating to it are two cycles already.
  const double protocol_s = 2e-6 * cell.robot.cycle_us;
  parameters.servo_lag_s = std::max(0.0, cell.robot.response_lag_s - protocol_s);
  parameters.surface.friction = options.friction.value_or(task.friction.nominal);
  parameters.surface.stiffness_Npm = cell.contact_stiffness_Npm;
  return parameters;
}

}  // namespace

class VirtualCell::Impl {
 public:
  Impl(const Cell& cell, const Task& task, const Options& options)
      : cell_(cell),
        task_(task),
        options_(options),
        start_name_(find_start(task, options.start).name),
        arm_(cell, task, arm_parameters(cell, task, options)),
        sensor_(cell.robot.sensor, options.seed),
        cycle_ns_(std::int64_t{1000} * cell.robot.cycle_us) {
    for (const Joint& joint : cell.robot.joints) drives_.emplace_back(drive_parameters(joint));
    demands_.resize(drives_.size());
    if (arm_.overlap_m() > kOverlapMax_m) {
      throw InputError(
          "task " + task.name + ": at start \"" + start_name_ + "\" the part stands " +
          std::to_string(arm_.overlap_m()) +
          " m deep in the displaced environment; choose another start, seed or offset");
    }
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].measured(measure(i), 0);
  }

  void step(std::int64_t now_ns, CanBus& bus);
  [[nodiscard]] Truth truth() const;
  [[nodiscard]] bool at_standstill() const;

 private:
  void power_on(std::int64_t now_ns);
  void advance_physics(std::int64_t now_ns);
  void physics_step();
  void deliver(const CanFrame& frame, std::int64_t now_ns);
  void sample_sensor();
  void send(CanBus& bus, bool arbitrate);
  void log_drives();
  void log_contacts();
  [[nodiscard]] Drive402::Measurement measure(std::size_t i) const;

  Cell cell_;
  Task task_;
  Options options_;
  std::string start_name_;
  ArmBody arm_;
  std::deque<Drive402> drives_;
  ForceTorqueNode sensor_;
  std::vector<ArmBody::JointDemand> demands_;

  bool on_ = false;
  std::int64_t on_ns_ = 0;
  std::int64_t physics_ns_ = 0;
  // The sensor reports the mean since its last sample, as sensors that sample faster do.
  Vector6 wrench_sum_ = Vector6::Zero();
  int wrench_count_ = 0;
  std::int64_t cycle_ns_;
  std::vector<CanFrame> incoming_;
  std::vector<CanFrame> outgoing_;
  std::uint64_t frames_not_sent_ = 0;

  EventLog events_;
  std::vector<Drive402::State> states_seen_;
  std::vector<bool> brakes_seen_;
  std::set<std::string> contacts_seen_;
  double contact_force_N_max_ = 0.0;
  std::uint32_t faults_ = 0;
};

void VirtualCell::Impl::power_on(std::int64_t now_ns) {
  on_ = true;
  on_ns_ = physics_ns_ = now_ns;
  for (Drive402& drive : drives_) {
    drive.node().power_on(now_ns);
    states_seen_.push_back(drive.state());
    brakes_seen_.push_back(drive.brake_engaged());
  }
  sensor_.node().power_on(now_ns);
}

void VirtualCell::Impl::step(std::int64_t now_ns, CanBus& bus) {
  if (!on_) power_on(now_ns);
  send(bus, false);
  incoming_.clear();
  ReceivedFrame received;
  while (bus.receive(received)) incoming_.push_back(received.frame);
  std::int64_t syncs_left = std::count_if(incoming_.begin(), incoming_.end(), is_sync);
  for (const CanFrame& frame : incoming_) {
    if (is_sync(frame)) {
      // Several at once: the caller is late. They came a cycle apart, and act so.
      --syncs_left;
      advance_physics(now_ns - syncs_left * cycle_ns_);
      sample_sensor();
    }
    deliver(frame, now_ns);
    send(bus, is_sync(frame));
  }
  advance_physics(now_ns);
  for (Drive402& drive : drives_) drive.advance(now_ns);
  sensor_.advance(now_ns);
  send(bus, false);
  log_drives();
}

void VirtualCell::Impl::deliver(const CanFrame& frame, std::int64_t now_ns) {
  for (Drive402& drive : drives_) drive.node().receive(frame, now_ns);
  sensor_.node().receive(frame, now_ns);
}

void VirtualCell::Impl::advance_physics(std::int64_t now_ns) {
  while (physics_ns_ + options_.physics_step_ns <= now_ns) physics_step();
}

void VirtualCell::Impl::physics_step() {
  const std::int64_t step_ns = options_.physics_step_ns;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Joint& joint = cell_.robot.joints[i];
    const Drive402::Demand demand = drives_[i].demand(step_ns);
    demands_[i] = {demand.brake,
                   (demand.position_counts - joint.zero_counts) / joint.counts_per_unit,
                   demand.velocity_countsps / joint.counts_per_unit};
  }
  arm_.step(demands_, static_cast<double>(step_ns) / kNanosecondsPerSecond);
  physics_ns_ += step_ns;
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].measured(measure(i), step_ns);
  wrench_sum_ += arm_.wrench();
  ++wrench_count_;
  log_drives();
  log_contacts();
}

Drive402::Measurement VirtualCell::Impl::measure(std::size_t i) const {
  const Joint& joint = cell_.robot.joints[i];
  const ArmBody::JointState& state = arm_.joint(i);
  return {state.position_m * joint.counts_per_unit + joint.zero_counts,
          state.velocity_mps * joint.counts_per_unit,
          kPermille * state.effort_N / joint.rated_effort};
}

void VirtualCell::Impl::sample_sensor() {
  if (wrench_count_ == 0) return;
  sensor_.measured(wrench_sum_ / wrench_count_);
  wrench_sum_ = Vector6::Zero();
  wrench_count_ = 0;
}

void VirtualCell::Impl::send(CanBus& bus, bool arbitrate) {
  outgoing_.clear();
  for (Drive402& drive : drives_) drive.node().take(outgoing_);
  sensor_.node().take(outgoing_);
  // Frames that become ready together leave by priority.
  if (arbitrate) {
    std::stable_sort(outgoing_.begin(), outgoing_.end(),
                     [](const CanFrame& a, const CanFrame& b) { return a.id < b.id; });
  }
  for (const CanFrame& frame : outgoing_) {
    if (bus.send(frame) != SendResult::kSent) ++frames_not_sent_;
    if (frame.id > canopen::kEmergency && frame.id < canopen::kTpdo1) {
      events_.emergency(physics_ns_ - on_ns_, frame);
    }
  }
}

void VirtualCell::Impl::log_drives() {
  const std::int64_t time_ns = physics_ns_ - on_ns_;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const std::string drive = "drive " + cell_.robot.joints[i].name + ": ";
    if (drives_[i].state() != states_seen_[i]) {
      events_.add(time_ns, drive + to_string(drives_[i].state()));
      if (drives_[i].state() == Drive402::State::kFault) ++faults_;
      states_seen_[i] = drives_[i].state();
    }
    if (drives_[i].brake_engaged() != brakes_seen_[i]) {
      brakes_seen_[i] = drives_[i].brake_engaged();
      events_.add(time_ns, drive + (brakes_seen_[i] ? "brake engaged" : "brake released"));
    }
  }
}

void VirtualCell::Impl::log_contacts() {
  const double force_N = arm_.contact_force_N();
  if (force_N == 0.0) return;
  contact_force_N_max_ = std::max(contact_force_N_max_, force_N);
  for (const std::string& pair : arm_.touching()) {
    if (contacts_seen_.insert(pair).second) {
      events_.add(physics_ns_ - on_ns_, "first contact " + pair);
    }
  }
}

Truth VirtualCell::Impl::truth() const {
  Truth truth;
  truth.task = task_.name;
  truth.start = start_name_;
  truth.seed = options_.seed;
  truth.time_s = static_cast<double>(physics_ns_ - on_ns_) / kNanosecondsPerSecond;
  truth.offset = options_.offset;
  const Pose X_BE = compose(cell_.X_BT, displaced(Pose{}, options_.offset));
  truth.tool = compose(inverse(X_BE), arm_.tool());
  truth.error = displacement_between(task_.goal, truth.tool);
  truth.error_norm_m = truth.error.head<3>().norm();
  truth.error_norm_rad = truth.error.tail<3>().norm();
  truth.goal_tolerance_m = task_.goal_tolerance_m;
  truth.within_tolerance = truth.error_norm_m <= task_.goal_tolerance_m;
  truth.contact_force_N_max = contact_force_N_max_;
  truth.touching = arm_.touching();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive402& drive = drives_[i];
    truth.drives.push_back({cell_.robot.joints[i].name, cell_.robot.joints[i].node,
                            to_string(drive.state()), drive.brake_engaged(),
                            drive.node().state() == NmtState::kOperational, drive.error_code(),
                            arm_.joint(i).position_m});
  }
  truth.faults = faults_;
  truth.solver_messages = arm_.solver_messages();
  truth.frames_not_sent = frames_not_sent_;
  truth.events = events_.events();
  return truth;
}

bool VirtualCell::Impl::at_standstill() const {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (std::abs(arm_.joint(i).velocity_mps) > kStandstill_mps) return false;
  }
  return true;
}

VirtualCell::VirtualCell(const Cell& cell, const Task& task, const Options& options)
    : impl_(std::make_unique<Impl>(cell, task, options)) {}

VirtualCell::~VirtualCell() = default;

void VirtualCell::step(std::int64_t now_ns, CanBus& bus) { impl_->step(now_ns, bus); }

Truth VirtualCell::truth() const { return impl_->truth(); }

bool VirtualCell::at_standstill() const { return impl_->at_standstill(); }

}  // namespace tenon::sim
