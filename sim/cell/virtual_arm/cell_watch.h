#pragma once
// Notices what matters in the virtual cell as it happens: states of drives, brakes, first contacts
// and the largest force, for the truth. It changes nothing. Private to sim; one thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/devices/robot_devices.h"
#include "sim/cell/faults/fault_phases.h"
#include "sim/cell/virtual_arm/arm_body.h"
#include "sim/cell/virtual_arm/event_log.h"

namespace tenon::sim {

class CellWatch {
 public:
  /// All must outlive it. @param drives one a joint
  /// @param phases are told as they begin
  CellWatch(const Robot& robot, const VirtualDrives& drives, const ArmBody& arm,
            FaultPhases& phases)
      : robot_(robot), drives_(drives), arm_(arm), phases_(phases) {}

  /// The drives have been switched on. Before the others.
  void power_on();
  /// At all drives. @param time_ns since the cell was switched on
  void look_at_drives(std::int64_t time_ns);
  /// At the contacts of the last step of physics.
  void look_at_contacts(std::int64_t time_ns);

  /// At what the cell does, after both. @param now_ns of the caller's clock
  void look_at_phases(std::int64_t now_ns);

  [[nodiscard]] EventLog& events() { return events_; }
  [[nodiscard]] const EventLog& events() const { return events_; }
  [[nodiscard]] double contact_force_N_max() const { return contact_force_N_max_; }
  /// Times that a drive entered fault.
  [[nodiscard]] std::uint32_t faults() const { return faults_; }

 private:
  const Robot& robot_;
  const VirtualDrives& drives_;
  const ArmBody& arm_;
  FaultPhases& phases_;
  EventLog events_;
  std::vector<std::string_view> states_seen_;
  std::vector<bool> brakes_seen_;
  std::set<std::pair<std::size_t, std::size_t>> contacts_seen_;
  double contact_force_N_max_ = 0.0;
  bool were_enabled_ = false;
  std::optional<std::int64_t> touching_since_ns_;  ///< without interruption
  std::optional<std::int64_t> moving_since_ns_;    ///< the same
  std::uint32_t faults_ = 0;
};

}  // namespace tenon::sim
