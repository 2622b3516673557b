#include "tests/support/rest_watch.h"

#include <algorithm>
#include <cmath>

#include "shared/base/text.h"

namespace tenon::tests {
namespace {

bool has_power(const std::string& state) {
  return state == "operation enabled" || state == "quick stop active" ||
         state == "fault reaction active" || state == "on";
}

constexpr double kStandingShare = 0.1;

double play_of(const Joint& joint) { return joint.kind == Joint::Kind::kRevolute ? 2e-3 : 5e-4; }

}  // namespace

void RestWatch::look(const sim::Truth& truth) {
  axes_.resize(truth.drives.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const sim::DriveTruth& drive = truth.drives[i];
    Axis& axis = axes_[i];
    if (drive.brake_engaged && !axis.closed) axis.closed_at = drive.position;
    axis.closed = drive.brake_engaged;
    axis.slip = axis.closed ? std::max(axis.slip, std::abs(drive.position - axis.closed_at)) : 0.0;
    const bool moved =
        std::abs(drive.position - axis.stands_at) > kStandingShare * play_of(robot_.joints[i]);
    if (moved) axis.stands_at = drive.position;
    axis.stood = moved ? 0 : axis.stood + 1;
    axis.state = drive.state;
    axis.powered = has_power(drive.state);
  }
}

bool RestWatch::off() const {
  return !axes_.empty() && std::all_of(axes_.begin(), axes_.end(), [this](const Axis& axis) {
    return (axis.closed || !robot_.brakes) && !axis.powered;
  });
}

bool RestWatch::stands() const {
  return !axes_.empty() && std::all_of(axes_.begin(), axes_.end(), [](const Axis& axis) {
    return axis.stood >= kStandingLooks;
  });
}

bool RestWatch::held() const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].slip > play_of(robot_.joints[i])) return false;
  }
  return !axes_.empty();
}

std::string RestWatch::complaints(double forged) const {
  std::string all;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    const bool braked = axis.closed && axis.slip <= play_of(robot_.joints[i]) + forged;
    const bool good = !axis.powered && (braked || !robot_.brakes);
    if (good) continue;
    all += format("%s%s: %s, brake %s, slipped by %.3g", all.empty() ? "" : "; ",
                  robot_.joints[i].name.c_str(), axis.state.c_str(), axis.closed ? "on" : "off",
                  axis.slip);
  }
  return all;
}

}  // namespace tenon::tests
