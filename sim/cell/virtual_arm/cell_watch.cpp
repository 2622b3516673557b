#include "sim/cell/virtual_arm/cell_watch.h"

#include <algorithm>
#include <string>

namespace tenon::sim {

void CellWatch::power_on() {
  for (const Drive402& drive : drives_) {
    states_seen_.push_back(drive.state());
    brakes_seen_.push_back(drive.brake_engaged());
  }
}

void CellWatch::look_at_drives(std::int64_t time_ns) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const auto tell = [&](const char* what) {
      events_.add(time_ns, "drive " + robot_.joints[i].name + ": " + what);
    };
    if (drives_[i].state() != states_seen_[i]) {
      tell(to_string(drives_[i].state()));
      if (drives_[i].state() == Drive402::State::kFault) ++faults_;
      states_seen_[i] = drives_[i].state();
    }
    if (drives_[i].brake_engaged() != brakes_seen_[i]) {
      brakes_seen_[i] = drives_[i].brake_engaged();
      tell(brakes_seen_[i] ? "brake engaged" : "brake released");
    }
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
