#include "planner/report/report_canvas.h"

#include <utility>

#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/prism.h"

namespace tenon::planner {
namespace {

constexpr double kRim = 0.02;  // of the picture, around what it holds

drawing::Prism prism_of(const Shape& shape, const Pose& frame) {
  constexpr int kRoundSides = 24;
  return drawing::prism_of(shape, frame, kRoundSides);
}

/// As the picture has them: in mm, and y downwards.
std::vector<drawing::Point> on_page(std::vector<drawing::Point> points_m) {
  for (drawing::Point& p : points_m) p = {1e3 * p.x(), -1e3 * p.y()};
  return points_m;
}

}  // namespace

Canvas::Canvas(const drawing::View& view, const Task& task, const std::vector<Vector3>& tools_m)
    : view_(view) {
  for (const Shape& shape : task.environment) {
    for (const Vector3& corner : prism_of(shape, Pose{}).corners_m) grow(corner);
  }
  const auto hold = [&](const Vector3& tool_m) {
    for (const Shape& shape : task.held) {
      for (const Vector3& corner : prism_of(shape, Pose{tool_m, task.goal.orientation}).corners_m) {
        grow(corner);
      }
    }
  };
  hold(task.goal.position_m);
  for (const Vector3& tool_m : tools_m) hold(tool_m);
  const Point rim = Point::Constant(kRim * (high_.x() - low_.x()));
  low_ -= rim;
  high_ += rim;
}

void Canvas::grow(const Vector3& p) {
  low_ = low_.cwiseMin(view_.m(p));
  high_ = high_.cwiseMax(view_.m(p));
}

std::string Canvas::open(const std::string& title) const {
  const Point size_mm = 1e3 * (high_ - low_);
  return format("<svg role='img' viewBox='%.2f %.2f %.2f %.2f'>\n", 1e3 * low_.x(),
                -1e3 * high_.y(), size_mm.x(), size_mm.y()) +
         "<title>" + title + "</title>\n";
}

std::string Canvas::section(const Shape& shape, double depth_m, const std::string& style) const {
  if (shape.solid) {
    return area(drawing::section_of(*shape.solid, shape.pose, view_, depth_m), "evenodd", style);
  }
  const drawing::Prism prism = prism_of(shape, Pose{});
  std::vector<Point> points;
  const auto cut = [&](std::size_t i, std::size_t j) {
    const Vector3& a = prism.corners_m[i];
    const Vector3& b = prism.corners_m[j];
    const double da = a[view_.along] - depth_m;
    const double db = b[view_.along] - depth_m;
    if ((da < 0.0) != (db < 0.0)) points.push_back(view_.m(a + da / (da - db) * (b - a)));
  };
  const std::size_t sides = prism.sides();
  for (std::size_t i = 0; i < sides; ++i) {
    cut(i, (i + 1) % sides);
    cut(sides + i, sides + (i + 1) % sides);
    cut(i, sides + i);
  }
  return points.empty() ? std::string() : polygon(std::move(points), style);
}

std::string Canvas::shadow(const Shape& shape, const Pose& frame, const std::string& style) const {
  if (shape.solid) {
    return area(drawing::shadow_of(*shape.solid, compose(frame, shape.pose), view_), "nonzero",
                style);
  }
  std::vector<Point> points;
  for (const Vector3& corner : prism_of(shape, frame).corners_m) points.push_back(view_.m(corner));
  return polygon(std::move(points), style);
}

std::string Canvas::area(const drawing::Loops& loops, const char* rule,
                         const std::string& style) const {
  if (loops.empty()) return {};
  std::string path;
  for (const std::vector<Point>& loop : loops) {
    path += "M" + drawing::points_text(on_page(loop), 2) + "Z";
  }
  return "<path d='" + path + "' fill-rule='" + rule +
         format("' stroke-width='%.2f' ", 2.0 * unit_mm()) + style + "/>\n";
}

std::string Canvas::polygon(std::vector<Point> points_m, const std::string& style) const {
  return drawing::polygon(on_page(drawing::hull_of(std::move(points_m))), 2,
                          format("stroke-width='%.2f' ", 2.0 * unit_mm()) + style);
}

std::string Canvas::polyline(const std::vector<Vector3>& points, double width,
                             const std::string& style) const {
  std::vector<Point> points_m;
  points_m.reserve(points.size());
  for (const Vector3& p : points) points_m.push_back(view_.m(p));
  return "<polyline fill='none' points='" + drawing::points_text(on_page(std::move(points_m)), 2) +
         format("' stroke-width='%.2f' ", width * unit_mm()) + style + "/>\n";
}

std::string Canvas::dot(const Vector3& p, double radius, const std::string& style) const {
  return format("<circle cx='%.2f' cy='%.2f' r='%.2f' stroke-width='%.2f' ", 1e3 * view_.m(p).x(),
                -1e3 * view_.m(p).y(), radius * unit_mm(), 0.4 * radius * unit_mm()) +
         style + "/>\n";
}

}  // namespace tenon::planner
