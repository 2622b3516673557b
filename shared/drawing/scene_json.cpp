#include "shared/drawing/scene_json.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "shared/base/text.h"
#include "shared/drawing/surface.h"
#include "shared/drawing/view.h"
#include "shared/task/ring.h"

namespace tenon::drawing {
namespace {

constexpr int kRoundSides = 40;
constexpr std::size_t kTrianglesMax = 16'000;  // of all shapes of a page
constexpr std::size_t kTrianglesLeast = 200;   // of one shape, however many there are

/// Shorter than "%.5f" where the number is: a page has thousands of them.
std::string number(double value) {
  std::string text = format("%.5f", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string quoted(const std::string& text) {
  constexpr char kFirstPrintable = ' ';
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') json += '\\';
    json += static_cast<unsigned char>(c) < kFirstPrintable ? ' ' : c;
  }
  return json + '"';
}

std::string shape_json(const Shape& shape, std::size_t triangles_max) {
  const TriangleMesh mesh = surface_of(shape, kRoundSides, triangles_max);
  std::string points;
  for (const Vector3& p : mesh.points_m) {
    points +=
        (points.empty() ? "" : ",") + number(p.x()) + "," + number(p.y()) + "," + number(p.z());
  }
  std::string corners;
  for (const Triangle& t : mesh.triangles) {
    corners += format("%s%u,%u,%u", corners.empty() ? "" : ",", t[0], t[1], t[2]);
  }
  return R"({"name":)" + quoted(piece_of(shape.name)) + R"(,"points_m":[)" + points +
         R"(],"triangles":[)" + corners + "]}";
}

std::string shapes_json(const std::vector<Shape>& shapes, std::size_t triangles_max) {
  std::string json;
  for (const Shape& shape : shapes) {
    json += (json.empty() ? "" : ",\n") + shape_json(shape, triangles_max);
  }
  return "[" + json + "]";
}

}  // namespace

std::string pose_json(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  std::string json = "[" + number(pose.position_m.x());
  for (const double value :
       {pose.position_m.y(), pose.position_m.z(), q.w(), q.x(), q.y(), q.z()}) {
    json += "," + number(value);
  }
  return json + "]";
}

std::string views_json(CoordinateMask coordinates) {
  std::string json;
  for (const View& view : views_of(coordinates)) {
    json += (json.empty() ? "" : ",") +
            format(R"({"right":%d,"up":%d,"along":%d,"title":)", view.right, view.up, view.along) +
            quoted(view.title) + "}";
  }
  return "[" + json + "]";
}

std::string scene_json(const Task& task) {
  const std::size_t shapes = std::max<std::size_t>(1, task.held.size() + task.environment.size());
  const std::size_t each = std::max(kTrianglesLeast, kTrianglesMax / shapes);
  return R"({"held":)" + shapes_json(task.held, each) + R"(,"environment":)" +
         shapes_json(task.environment, each) + "}";
}

}  // namespace tenon::drawing
