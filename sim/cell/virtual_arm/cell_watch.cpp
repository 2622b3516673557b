#include "sim/cell/virtual_arm/cell_watch.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tenon::sim {
namespace {

constexpr double kMoving = 2e-3;  // m/s or rad/s
constexpr std::int64_t kSettled_ns = 50'000'000;

}  // namespace

void CellWatch::power_on() {
  for (const auto& drive : drives_) {
    states_seen_.emplace_back(drive->look().state);
    brakes_seen_.push_back(drive->look().brake_engaged);
  }
}

void CellWatch::look_at_drives(std::int64_t time_ns) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const auto tell = [&](const char* what) {
      events_.add(time_ns, "drive " + robot_.joints[i].name + ": " + what);
    };
    const VirtualDrive::Look look = drives_[i]->look();
    if (look.state != states_seen_[i]) {
      tell(look.state);
      if (look.faulted) ++faults_;
      states_seen_[i] = look.state;
    }
    if (look.brake_engaged != brakes_seen_[i]) {
      brakes_seen_[i] = look.brake_engaged;
      tell(brakes_seen_[i] ? "brake engaged" : "brake released");
    }
  }
}

void CellWatch::look_at_phases(std::int64_t now_ns) {
  const auto any = [this](const auto& is) {
    return std::any_of(drives_.begin(), drives_.end(),
                       [&](const auto& drive) { return is(drive->look()); });
  };
  if (any([](const VirtualDrive::Look& look) { return look.switched_on; })) {
    phases_.begin(FaultPhase::kEnabling, now_ns);
  }
  const bool enabled = !any([](const VirtualDrive::Look& look) { return !look.enabled; });
  were_enabled_ = were_enabled_ || enabled;
  if (were_enabled_ && any([](const VirtualDrive::Look& look) { return look.stopping; })) {
    phases_.begin(FaultPhase::kStopping, now_ns);
  }
  const bool touching = arm_.contact_force_N() > 0.0;
  if (!touching) touching_since_ns_.reset();
  if (touching && !touching_since_ns_) touching_since_ns_ = now_ns;
  if (!enabled) return;
  bool moving = false;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    moving = moving || std::abs(arm_.joint(i).velocity) > kMoving;
  }
  if (!moving) moving_since_ns_.reset();
  if (moving && !moving_since_ns_) moving_since_ns_ = now_ns;
  if (touching) phases_.begin(FaultPhase::kContact, now_ns);
  // Axes sag for a moment as their brakes open.
  if (!moving || now_ns - *moving_since_ns_ < kSettled_ns) return;
  if (!touching) phases_.begin(FaultPhase::kFree, now_ns);
  if (touching && now_ns - *touching_since_ns_ >= kSettled_ns) {
    phases_.begin(FaultPhase::kSliding, now_ns);
  }
}

void CellWatch::look_at_contacts(std::int64_t time_ns) {
  const double force_N = arm_.contact_force_N();
  if (force_N == 0.0) return;
  contact_force_N_max_ = std::max(contact_force_N_max_, force_N);
  for (const Scene::Pair& pair : arm_.scene().pairs()) {
    if (contacts_seen_.insert({pair.held, pair.environment}).second) {
      events_.add(time_ns, "first contact " + arm_.scene().name(pair));
    }
  }
}

}  // namespace tenon::sim
