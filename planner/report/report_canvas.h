#pragma once
// A plane of the task frame as inline SVG, in millimetres: shapes cut where the plane cuts them,
// everything else projected onto it. Pure; any thread.

#include <string>
#include <vector>

#include "shared/task/task.h"

namespace tenon::planner {

/// Two axes of the task frame, and the third that is looked along.
struct View {
  int right = 0;
  int up = 1;
  int along = 2;
  const char* title = "";
};

/// What shows the coordinates of a task: from above, from the side, or both.
[[nodiscard]] std::vector<View> views_of(CoordinateMask coordinates);

/// Styles are SVG attributes. Widths and radii are in thousandths of the picture's width.
class Canvas {
 public:
  /// Holds the environment, and the held part at the goal and wherever these tools are.
  Canvas(const View& view, const Task& task, const std::vector<Vector3>& tools_m);

  [[nodiscard]] std::string open(int width_px) const;

  /// The shape's outline where the plane through depth_m cuts it; empty where it does not.
  [[nodiscard]] std::string section(const Shape& shape, double depth_m,
                                    const std::string& style) const;
  /// All of the shape, as its shadow on the plane.
  [[nodiscard]] std::string shadow(const Shape& shape, const Pose& frame,
                                   const std::string& style) const;
  [[nodiscard]] std::string polyline(const std::vector<Vector3>& points, double width,
                                     const std::string& style) const;
  [[nodiscard]] std::string dot(const Vector3& p, double radius, const std::string& style) const;

 private:
  using Point = Eigen::Vector2d;  // right, up

  [[nodiscard]] Point flat(const Vector3& p) const { return {p[view_.right], p[view_.up]}; }
  [[nodiscard]] std::string polygon(std::vector<Point> points, const std::string& style) const;
  [[nodiscard]] double unit_mm() const { return high_.x() - low_.x(); }
  void grow(const Vector3& p);

  View view_;
  Point low_ = Point::Constant(1e9);
  Point high_ = Point::Constant(-1e9);
};

}  // namespace tenon::planner
