#pragma once
// A shape of a task as ODE geometry and as a surface: with surfaces, the one place in physics that
// knows which kinds of shapes there are. It knows neither contacts nor joints. Private to sim; used
// on the thread of its world.

#include <ode/ode.h>

#include <memory>
#include <optional>
#include <string>

#include "shared/math/pose.h"
#include "shared/task/task.h"
#include "sim/physics/surfaces/prism.h"
#include "sim/physics/surfaces/surface.h"

namespace tenon::sim {

/// Owns the geometry. A shape either stands in the world or hangs on a body.
class ShapeGeometry {
 public:
  explicit ShapeGeometry(const Shape& shape, MeshDistances distances = MeshDistances::kExact);
  ShapeGeometry(const ShapeGeometry&) = delete;
  ShapeGeometry& operator=(const ShapeGeometry&) = delete;
  ~ShapeGeometry();

  [[nodiscard]] const std::string& name() const { return shape_.name; }
  /// Of a solid, a box around it that only says where it is.
  [[nodiscard]] dGeomID id() const { return geometry_; }
  /// Neither box nor cylinder: its contacts come from its surface alone.
  [[nodiscard]] bool is_solid() const { return shape_.kind == Shape::Kind::kSolid; }
  /// As drawn, in the frame of the shape's centre. Made when first asked for.
  [[nodiscard]] const Surface& surface();
  /// By this much the surface stands out farther than drawn.
  [[nodiscard]] double offset_m() const;
  /// Of its centre, in the world.
  [[nodiscard]] Pose pose() const;

  /// @param X_WT the frame in which the shape was drawn, in the world
  void place(const Pose& X_WT);
  /// @param X_BP the frame in which the shape was drawn, in the body's
  void attach(dBodyID body, const Pose& X_BP);
  /// Every size as drawn and this much more.
  void set_oversize(double oversize_m);

  /// The largest gap between the two along the axes of either, m: they are at least this far apart.
  /// 0 or less tells nothing.
  [[nodiscard]] double separation_m(const ShapeGeometry& other) const;
  /// Which of its axes (0 to 2) the shape is a prism along, and which of another one's is parallel.
  struct AxesInCommon {
    int own = 0;
    int other = 0;
  };
  /// Empty where the two stand askew.
  [[nodiscard]] std::optional<AxesInCommon> axes_in_common(const ShapeGeometry& other) const;
  /// As it stands. @param axis one that it is a prism along
  [[nodiscard]] Prism prism(int axis) const;

  /// No point of an attached shape is farther than this from the body's origin.
  [[nodiscard]] double reach_m() const;

 private:
  /// Half of its size as it is, along its own axes.
  [[nodiscard]] Vector3 half_m() const;
  /// Its axes in the world, a column each.
  [[nodiscard]] Eigen::Matrix3d axes() const;
  /// Half of what it measures along three directions. @param ways in its axes, a unit vector a row
  [[nodiscard]] Vector3 half_along_m(const Eigen::Matrix3d& ways) const;

  Shape shape_;
  double oversize_m_ = 0.0;
  MeshDistances distances_;
  dGeomID geometry_;
  std::shared_ptr<const Surface> surface_;
};

}  // namespace tenon::sim
