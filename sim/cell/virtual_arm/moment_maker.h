#pragma once
// Gathers what there is to see of a cell from one step of physics to the next. Private to sim; one
// thread; no allocation.

#include <cstdint>

#include "shared/math/pose.h"
#include "sim/cell/devices/robot_devices.h"
#include "sim/cell/virtual_arm/arm_body.h"
#include "sim/cell/virtual_arm/cell_moment.h"

namespace tenon::sim {

class MomentMaker {
 public:
  /// Both must outlive it.
  MomentMaker(const VirtualDrives& drives, const ArmBody& arm) : drives_(drives), arm_(arm) {}

  /// At the last step of physics.
  void look();
  /// The moment that has passed; the next one begins.
  [[nodiscard]] CellMoment take(std::int64_t time_ns);

 private:
  void look_at_contacts();

  const VirtualDrives& drives_;
  const ArmBody& arm_;
  CellMoment moment_;
  Vector3 force_sum_N_ = Vector3::Zero();
  int steps_ = 0;
};

}  // namespace tenon::sim
