#pragma once
// What effort holds an arm against gravity, by the masses that its URDF and its cell give: motors
// without an integral part would sag under it. Real-time but for the constructor; one thread.

#include <array>
#include <cstddef>

#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon::hw::mit {

class Gravity {
 public:
  explicit Gravity(const Cell& cell);

  /// @param position of the joints, m or rad  @return N or Nm, a joint each
  [[nodiscard]] JointVector holding_effort(const JointVector& position) const noexcept;

 private:
  struct Link {
    Pose origin;
    Vector3 axis = Vector3::UnitX();
    bool revolute = true;
    double mass_kg = 0.0;
    Vector3 moment_kgm = Vector3::Zero();  ///< mass times its centre, in the link's frame
  };

  std::array<Link, kMaxJoints> links_{};
  std::size_t count_;
  Vector3 lift_mps2_;  ///< against gravity, base axes
};

}  // namespace tenon::hw::mit
