#include "executor/monitor/run_model.h"

#include <algorithm>
#include <cmath>

#include "executor/telemetry/telemetry.h"
#include "lcmtypes/received/received.h"
#include "shared/motion/contact_signature.h"

namespace tenon::executor {
namespace {

constexpr std::size_t kStepsKept = 64;

// Clocks and counts that came over the network may be anything.
double seconds_between(std::int64_t before_ns, std::int64_t after_ns) {
  constexpr double kMost_s = 3600.0;
  const double seconds = 1e-9 * (static_cast<double>(after_ns) - static_cast<double>(before_ns));
  return std::clamp(seconds, 0.0, kMost_s);
}

// A run begins at 0. A message that another one has overtaken begins no run.
bool begins_anew(std::int64_t sequence, std::int64_t last) {
  constexpr std::int64_t kOvertaken = 50;
  return sequence < last && (sequence <= 0 || last - kOvertaken > sequence);
}

}  // namespace

void RecentWorst::add(std::int64_t time_ns, double value) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t second = std::max<std::int64_t>(0, time_ns) / kSecond_ns;
  const bool fresh =
      second_ < 0 || second < second_ || second - second_ >= static_cast<std::int64_t>(kSeconds);
  if (fresh) worst_.fill(0.0);
  for (std::int64_t s = second_ + 1; !fresh && s <= second; ++s) {
    worst_[static_cast<std::size_t>(s) % kSeconds] = 0.0;
  }
  second_ = second;
  double& worst = worst_[static_cast<std::size_t>(second) % kSeconds];
  worst = std::max(worst, value);
}

double RecentWorst::value() const { return *std::max_element(worst_.begin(), worst_.end()); }

void RunModel::take(std::string_view channel, std::span<const std::uint8_t> bytes,
                    std::int64_t now_ns) {
  if (channel == kCycleChannel) {
    if (const auto m = received<tenon::cycle_state_t>(bytes)) take(*m, now_ns);
  } else if (channel == kSetupChannel) {
    const auto m = received<tenon::run_setup_t>(bytes);
    if (!m) return;
    if (m->sequence <= 0 || (setup && m->sequence <= setup->message.sequence)) forget_run();
    setup = {*m, now_ns};
  } else if (channel == kStatusChannel) {
    if (const auto m = received<tenon::run_status_t>(bytes)) status = {*m, now_ns};
  } else if (channel == kRunChannel) {
    if (const auto m = received<tenon::run_summary_t>(bytes)) summary = {*m, now_ns};
  } else if (channel == kStepChannel) {
    if (const auto m = received<tenon::step_event_t>(bytes)) steps.push_front(*m);
    if (steps.size() > kStepsKept) steps.pop_back();
  }
}

template <typename Message>
std::optional<Message> RunModel::received(std::span<const std::uint8_t> bytes) {
  auto message = decoded<Message>(bytes);
  if (!message) ++malformed;
  return message;
}

void RunModel::forget_run() {
  const std::uint64_t counted = malformed;
  *this = RunModel{};
  malformed = counted;
}

void RunModel::take(const tenon::cycle_state_t& message, std::int64_t now_ns) {
  if (cycle && begins_anew(message.sequence, cycle->message.sequence)) forget_run();
  const double since_s = cycle ? seconds_between(cycle->message.motion_ns, message.motion_ns) : 0.0;
  wrench_age_s = message.wrench_fresh != 0 ? 0.0 : wrench_age_s + since_s;
  const auto fresh = static_cast<std::uint32_t>(message.joints_fresh);
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    joint_silent_s[i] = (fresh >> i & 1U) != 0 ? 0.0 : joint_silent_s[i] + since_s;
  }
  wakeup_late_s.add(message.monotonic_ns, message.wakeup_late_s);
  compute_s.add(message.monotonic_ns, message.compute_s);
  follow_move(message, since_s);
  cycle = {message, now_ns};
}

void RunModel::follow_move(const tenon::cycle_state_t& message, double since_s) {
  if (message.step < 0) return;
  if (message.step == move.step) {
    const double pace = status ? std::clamp(status->message.pace, 0.0, 1.0) : 1.0;
    move.elapsed_s += pace * since_s;
    return;
  }
  move = {};
  move.step = message.step;
  move.whole = cycle.has_value();
  move.start = pose_of(message);
}

std::string signature_text(std::int16_t bits) {
  return tenon::to_string(ContactSignature{static_cast<std::uint16_t>(bits)});
}

std::string joint_name(const RunModel& model, int joint) {
  if (!model.setup || joint < 0) return std::to_string(joint);
  const std::string& names = model.setup->message.joint_names;
  std::size_t begin = 0;
  for (int i = 0; i < joint && begin != std::string::npos; ++i) {
    const std::size_t end = names.find('\n', begin);
    begin = end == std::string::npos ? end : end + 1;
  }
  const std::size_t end = begin == std::string::npos ? begin : names.find('\n', begin);
  return end == std::string::npos ? std::to_string(joint) : names.substr(begin, end - begin);
}

Pose pose_of(const tenon::cycle_state_t& message) {
  Pose pose;
  pose.position_m = Vector3(message.pose_position_m);
  const double* q = message.pose_orientation_wxyz;
  const Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  if (std::isfinite(orientation.squaredNorm()) && orientation.norm() > 0.5) {
    pose.orientation = orientation.normalized();
  }
  return pose;
}

double way_along(std::span<const double> displacement, const Pose& start, const Pose& pose) {
  const Vector3 translation(displacement[0], displacement[1], displacement[2]);
  const Vector3 rotation(displacement[3], displacement[4], displacement[5]);
  if (translation.norm() > 0.0) {
    return (pose.position_m - start.position_m).dot(translation.normalized());
  }
  if (!(rotation.norm() > 0.0)) return 0.0;
  const Eigen::AngleAxisd turned(pose.orientation * start.orientation.conjugate());
  return turned.angle() * turned.axis().dot(rotation.normalized());
}

}  // namespace tenon::executor
