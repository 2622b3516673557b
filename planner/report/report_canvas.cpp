#include "planner/report/report_canvas.h"

#include <algorithm>
#include <cmath>

#include "shared/base/text.h"

namespace tenon::planner {
namespace {

constexpr double kRim = 0.02;  // of the picture, around what it holds
constexpr int kCircleCorners = 24;

/// A prism: so many corners below, as many above, in the task frame.
struct Prism {
  std::vector<Vector3> corners;

  [[nodiscard]] std::size_t sides() const { return corners.size() / 2; }
};

Prism prism_of(const Shape& shape, const Pose& frame) {
  const bool box = shape.kind == Shape::Kind::kBox;
  const int sides = box ? 4 : kCircleCorners;
  const double reach = box ? std::sqrt(2.0) : 1.0;
  const Pose pose = compose(frame, shape.pose);
  Prism prism;
  for (const double end : {-0.5, 0.5}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * M_PI * (i + 0.5) / sides;
      const Vector3 local(0.5 * reach * std::cos(angle) * shape.size_m.x(),
                          0.5 * reach * std::sin(angle) * shape.size_m.y(), end * shape.size_m.z());
      prism.corners.push_back(pose.position_m + pose.orientation * local);
    }
  }
  return prism;
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  const auto turns_left = [](const auto& a, const auto& b, const auto& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0.0;
  };
  std::vector<Eigen::Vector2d> chain;
  const auto half = [&](const auto begin, const auto end) {
    const std::size_t first = chain.size();
    for (auto point = begin; point != end; ++point) {
      while (chain.size() >= first + 2 &&
             !turns_left(chain[chain.size() - 2], chain.back(), *point)) {
        chain.pop_back();
      }
      chain.push_back(*point);
    }
    chain.pop_back();
  };
  if (points.size() < 3) return points;
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return chain;
}

}  // namespace

std::vector<View> views_of(CoordinateMask coordinates) {
  const View above{0, 1, 2, "Seen from above"};
  const View side{0, 2, 1, "Seen from the side, along y"};
  const View front{1, 2, 0, "Seen from the front, along x"};
  const bool x = (coordinates & 0b001) != 0;
  const bool y = (coordinates & 0b010) != 0;
  const bool z = (coordinates & 0b100) != 0;
  if (!z) return {above};
  if (!y) return {side};
  if (!x) return {front};
  return {above, side};
}

Canvas::Canvas(const View& view, const Task& task, const std::vector<Vector3>& tools_m)
    : view_(view) {
  for (const Shape& shape : task.environment) {
    for (const Vector3& corner : prism_of(shape, Pose{}).corners) grow(corner);
  }
  const auto hold = [&](const Vector3& tool_m) {
    for (const Shape& shape : task.held) {
      for (const Vector3& corner : prism_of(shape, Pose{tool_m, task.goal.orientation}).corners) {
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
  low_ = low_.cwiseMin(flat(p));
  high_ = high_.cwiseMax(flat(p));
}

std::string Canvas::open(int width_px) const {
  const Point size_mm = 1e3 * (high_ - low_);
  return format("<svg width='%d' viewBox='%.2f %.2f %.2f %.2f'>\n", width_px, 1e3 * low_.x(),
                -1e3 * high_.y(), size_mm.x(), size_mm.y());
}

std::string Canvas::section(const Shape& shape, double depth_m, const std::string& style) const {
  const Prism prism = prism_of(shape, Pose{});
  std::vector<Point> points;
  const auto cut = [&](std::size_t i, std::size_t j) {
    const Vector3& a = prism.corners[i];
    const Vector3& b = prism.corners[j];
    const double da = a[view_.along] - depth_m;
    const double db = b[view_.along] - depth_m;
    if ((da < 0.0) != (db < 0.0)) points.push_back(flat(a + da / (da - db) * (b - a)));
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
  std::vector<Point> points;
  for (const Vector3& corner : prism_of(shape, frame).corners) points.push_back(flat(corner));
  return polygon(std::move(points), style);
}

std::string Canvas::polygon(std::vector<Point> points, const std::string& style) const {
  std::string text = "<polygon points='";
  const std::vector<Point> outline = hull(std::move(points));
  for (const Point& p : outline) {
    text += format("%.2f,%.2f ", 1e3 * p.x(), -1e3 * p.y());
  }
  return text + "' stroke-width='" + format("%.2f", 2.0 * unit_mm()) + "' " + style + "/>\n";
}

std::string Canvas::polyline(const std::vector<Vector3>& points, double width,
                             const std::string& style) const {
  std::string text = "<polyline fill='none' points='";
  for (const Vector3& p : points) {
    text += format("%.2f,%.2f ", 1e3 * flat(p).x(), -1e3 * flat(p).y());
  }
  return text + format("' stroke-width='%.2f' ", width * unit_mm()) + style + "/>\n";
}

std::string Canvas::dot(const Vector3& p, double radius, const std::string& style) const {
  return format("<circle cx='%.2f' cy='%.2f' r='%.2f' stroke-width='%.2f' ", 1e3 * flat(p).x(),
                -1e3 * flat(p).y(), radius * unit_mm(), 0.4 * radius * unit_mm()) +
         style + "/>\n";
}

}  // namespace tenon::planner
