#pragma once
// A shape of a task as ODE geometry: the one place in physics that knows which kinds of shapes
// there are. It knows neither contacts nor joints. Private to sim; used on the thread of its world.

#include <ode/ode.h>

#include <string>

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon::sim {

/// Owns the geometry. A shape either stands in the world or hangs on a body.
class ShapeGeometry {
 public:
  explicit ShapeGeometry(const Shape& shape);
  ShapeGeometry(const ShapeGeometry&) = delete;
  ShapeGeometry& operator=(const ShapeGeometry&) = delete;
  ~ShapeGeometry();

  [[nodiscard]] const std::string& name() const { return shape_.name; }
  [[nodiscard]] dGeomID id() const { return geometry_; }

  /// @param X_WT the frame in which the shape was drawn, in the world
  void place(const Pose& X_WT);
  /// @param X_BP the frame in which the shape was drawn, in the body's
  void attach(dBodyID body, const Pose& X_BP);
  /// Every size as drawn and this much more.
  void set_oversize(double oversize_m);

  /// How far the boxes around the two, along the world's axes, are apart: the shapes are at least
  /// as far. 0 where they overlap or touch.
  [[nodiscard]] double gap_m(const ShapeGeometry& other) const;
  /// The boxes overlap or touch.
  [[nodiscard]] bool is_near(const ShapeGeometry& other) const;
  /// No point of an attached shape is farther than this from the body's origin.
  [[nodiscard]] double reach_m() const;

 private:
  Shape shape_;
  double oversize_m_ = 0.0;
  dGeomID geometry_;
};

}  // namespace tenon::sim
