#pragma once
// A fixed delay between drives and servos, in steps of physics. Private to sim.

#include <cstddef>
#include <span>
#include <vector>

#include "sim/cell/virtual_arm/servo_joint.h"

namespace tenon::sim {

class DemandDelay {
 public:
  /// @param steps 0: none. Until so many have passed, the brakes hold.
  DemandDelay(std::size_t joints, std::size_t steps)
      : ring_(steps + 1, std::vector<ServoJoint::Demand>(joints)) {}

  /// What the drives demand now; to be filled before delayed().
  [[nodiscard]] std::vector<ServoJoint::Demand>& now() { return ring_[newest_]; }
  /// What they demanded so many steps ago. Ends the step.
  [[nodiscard]] std::span<const ServoJoint::Demand> delayed() {
    newest_ = (newest_ + 1) % ring_.size();
    return ring_[newest_];  // the oldest, and the next to be overwritten
  }

 private:
  std::vector<std::vector<ServoJoint::Demand>> ring_;
  std::size_t newest_ = 0;
};

}  // namespace tenon::sim
