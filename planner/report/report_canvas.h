#pragma once
// A plane of the task frame as inline SVG, in millimetres: shapes cut where the plane cuts them,
// everything else projected onto it. Pure; any thread.

#include <string>
#include <vector>

#include "shared/drawing/silhouette.h"
#include "shared/drawing/view.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Styles are SVG attributes. Widths and radii are in thousandths of the picture's width.
class Canvas {
 public:
  /// Holds the environment, and the held part at the goal and wherever these tools are.
  Canvas(const drawing::View& view, const Task& task, const std::vector<Vector3>& tools_m);

  /// @param title HTML: what the picture shows, for who cannot see it
  [[nodiscard]] std::string open(const std::string& title) const;

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
  using Point = drawing::Point;

  /// What closed lines enclose together.
  [[nodiscard]] std::string area(const drawing::Loops& loops, const char* rule,
                                 const std::string& style) const;
  /// The hull.
  [[nodiscard]] std::string polygon(std::vector<Point> points_m, const std::string& style) const;
  [[nodiscard]] double unit_mm() const { return high_.x() - low_.x(); }
  void grow(const Vector3& p);

  drawing::View view_;
  Point low_ = Point::Constant(1e9);  ///< m, as high_
  Point high_ = Point::Constant(-1e9);
};

}  // namespace tenon::planner
