#include "planner/check/understood.h"

#include <algorithm>

#include "planner/check/probe.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/ring.h"

namespace tenon::planner {

std::vector<Part> parts_of(const std::vector<Shape>& shapes) {
  std::vector<Part> parts;
  for (const Shape& shape : shapes) {
    const std::string name = piece_of(shape.name);
    if (!parts.empty() && name != shape.name && parts.back().name == name) {
      Part& part = parts.back();
      ++part.pieces;
      part.middle_m += (shape.pose.position_m - part.middle_m) / static_cast<double>(part.pieces);
      continue;
    }
    parts.push_back({name, 1, shape.size_m, shape.pose.position_m});
  }
  for (Part& part : parts) {
    // A mean of numbers that cancel is zero but for rounding.
    part.middle_m = part.middle_m.unaryExpr([](double m) { return m * m < 1e-18 ? 0.0 : m; });
  }
  return parts;
}

std::string size_text(const Part& part) {
  const std::string size = format("%.4g x %.4g x %.4g", 1e3 * part.size_m.x(),
                                  1e3 * part.size_m.y(), 1e3 * part.size_m.z());
  return part.pieces == 1 ? size : format("of %zu pieces, each ", part.pieces) + size;
}

std::string way_mm_text(double way_m) {
  return way_m < kWayKnownTo_m ? "below 0.01" : format("%.3g", 1e3 * way_m);
}

std::string spread_text(const Start& start, const Task& task) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (start.sigma[axis] <= 0.0) continue;
    text +=
        format("%s%s +-%.3g %s", text.empty() ? "" : ", ", axis_name(axis),
               shown(task.particle_sigmas * start.sigma[axis], axis), axis < 3 ? "mm" : "degrees");
  }
  return text.empty() ? "nothing uncertain" : text;
}

std::string way_text(const Touch& touch, const Start& start) {
  if (!touch.in_legs) return ", which no straight legs lead to";
  const double ahead_m = touch.tool.position_m[touch.axis] - start.pose.position_m[touch.axis];
  if (touch.sign * ahead_m >= 0.0) return {};
  return ", behind the start: by way of legs along " + touch.legs;
}

std::vector<Direction> directions_of(const Task& task, const Start& start,
                                     const StartCheck& checked) {
  std::vector<Direction> directions;
  const bool free = std::all_of(checked.particles.begin(), checked.particles.end(),
                                [](const CheckedParticle& particle) { return particle.free; });
  if (!checked.free || !free) return directions;
  for (int axis = 0; axis < 3; ++axis) {
    if (!has(task.coordinates, axis) || start.sigma[axis] <= 0.0) continue;
    for (const int sign : {1, -1}) {
      const auto found = std::find_if(
          checked.touches.begin(), checked.touches.end(),
          [&](const Touch& touch) { return touch.axis == axis && touch.sign == sign; });
      directions.push_back({axis, sign, found == checked.touches.end() ? nullptr : &*found});
    }
  }
  return directions;
}

}  // namespace tenon::planner
