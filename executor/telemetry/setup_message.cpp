#include "executor/telemetry/setup_message.h"

#include <algorithm>

#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"

namespace tenon::executor {
namespace {

struct Way {
  double from = 0.0;
  double to = 0.0;
};

// Of the tool along a displacement, of its rotation where it has no translation. The envelope is a
// box.
Way way_along(const Vector6& displacement, const Envelope& envelope) {
  const bool turns = displacement.head<3>().isZero(0.0);
  const Vector3 direction =
      (turns ? displacement.tail<3>() : displacement.head<3>()).stableNormalized();
  Way way;
  for (int i = 0; i < 3; ++i) {
    const int axis = turns ? i + 3 : i;
    const double one = direction[i] * envelope.travelled_min[axis];
    const double other = direction[i] * envelope.travelled_max[axis];
    way.from += std::min(one, other);
    way.to += std::max(one, other);
  }
  return way;
}

void add_step(const Plan& plan, const Step& step, tenon::run_setup_t& message) {
  const ParameterSet& set = plan.parameter_sets[step.parameter_set];
  const Vector6& d = step.displacement;
  message.displacement.push_back({d[0], d[1], d[2], d[3], d[4], d[5]});
  unsigned expected = 0;
  Way seen;
  for (const Outcome outcome : kOutcomes) {
    const OutcomeRule& rule = step.rule(outcome);
    if (rule.successor == kSuccessorFail) continue;
    const Way way = way_along(d, rule.envelope);
    seen = expected == 0 ? way : Way{std::min(seen.from, way.from), std::max(seen.to, way.to)};
    expected |= 1U << static_cast<unsigned>(outcome);
  }
  message.expected.push_back(static_cast<std::int8_t>(expected));
  message.expected_from.push_back(seen.from);
  message.expected_to.push_back(seen.to);
  message.force_on_N.push_back(set.thresholds.force_on_N);
  message.torque_on_Nm.push_back(set.thresholds.torque_on_Nm);
  message.timeout_s.push_back(1e-6 * set.timeout_us);
  message.trigger_mask.push_back(static_cast<std::int16_t>(set.trigger_mask.bits));
  message.sensed_axes.push_back(static_cast<std::int8_t>(set.sensed_axes));
}

}  // namespace

tenon::run_setup_t setup_message(const Cell& cell, const Plan* plan) {
  tenon::run_setup_t message{};
  message.cycle_s = 1e-6 * cell.robot.cycle_us;
  message.force_fault_N = cell.force_fault_N;
  message.torque_fault_Nm = cell.torque_fault_Nm;
  message.cell = cell.name;
  message.robot = cell.robot.name;
  message.joint_count = static_cast<std::int8_t>(cell.robot.joints.size());
  for (const Joint& joint : cell.robot.joints) {
    message.joint_names += joint.name + '\n';
    message.joint_linear.push_back(joint.kind == Joint::Kind::kPrismatic ? 1 : 0);
    message.joint_lower.push_back(joint.lower);
    message.joint_upper.push_back(joint.upper);
  }
  if (plan == nullptr) return message;
  message.plan = plan->task_name;
  message.start = plan->start_name;
  message.force_limit_N = plan->force_limit_N;
  message.torque_limit_Nm = plan->torque_limit_Nm;
  message.compliant_axes = static_cast<std::int8_t>(plan->compliance.compliant_axes);
  message.step_count = static_cast<std::int16_t>(plan->steps.size());
  for (const Step& step : plan->steps) add_step(*plan, step, message);
  return message;
}

void tell_bus(const CanBusTraffic& now, const CanBusTraffic& before, double since_s,
              std::uint32_t bitrate_bps, tenon::run_status_t& message) {
  const auto number = [](std::uint64_t count) { return static_cast<std::int64_t>(count); };
  message.bus_known = 1;
  message.bus_up = now.status.up ? 1 : 0;
  message.bus_off = now.status.bus_off ? 1 : 0;
  message.error_passive = now.status.error_passive ? 1 : 0;
  message.sent = number(now.status.sent);
  message.received = number(now.status.received);
  message.send_failures = number(now.status.send_failures);
  message.malformed = number(now.status.malformed);
  message.error_frames = number(now.status.error_frames);
  message.overruns = number(now.status.overruns);
  if (since_s <= 0.0 || bitrate_bps == 0) return;
  const auto grown = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a - b); };
  const double bits_most = since_s * bitrate_bps;
  message.bus_load = grown(now.nominal_bits, before.nominal_bits) / bits_most;
  message.bus_load_worst = grown(now.worst_bits, before.worst_bits) / bits_most;
  message.frame_rate_hz = (grown(now.status.sent, before.status.sent) +
                           grown(now.status.received, before.status.received)) /
                          since_s;
}

}  // namespace tenon::executor
