#include "shared/config/load_shapes.h"

#include <array>
#include <utility>

#include "shared/base/error.h"
#include "shared/base/fnv.h"
#include "shared/base/text.h"
#include "shared/config/files.h"
#include "shared/config/part_file.h"
#include "shared/geometry/extrusion.h"
#include "shared/geometry/mesh_check.h"
#include "shared/task/ring.h"

namespace tenon::config {
namespace {

constexpr std::size_t kShapesMax = 200;
constexpr std::size_t kCornersMax = 300;
constexpr double kScaleMax = 1000.0;
constexpr std::array<const char*, 5> kKinds = {"box_m", "cylinder", "ring", "extrusion", "mesh"};

Ring read_ring(const Value& value, const std::string& name, const Pose& pose) {
  const Map map(value, {"inner_diameter_m", "outer_diameter_m", "length_m", "segments"});
  Ring ring;
  ring.name = name;
  ring.pose = pose;
  ring.inner_diameter_m = map.number("inner_diameter_m", positive_to(kSizeMax_m));
  ring.outer_diameter_m = map.number("outer_diameter_m", {ring.inner_diameter_m, kSizeMax_m, true});
  ring.length_m = map.number("length_m", positive_to(kSizeMax_m));
  if (const auto segments = map.find("segments")) {
    ring.segments = static_cast<int>(segments->integer(8, 64));
  }
  return ring;
}

std::shared_ptr<const Solid> read_extrusion(const Value& value) {
  const Map map(value, {"profile_m", "length_m"});
  std::vector<Eigen::Vector2d> profile_m;
  for (const Value& corner : map.at("profile_m").list(3, kCornersMax)) {
    const std::vector<Value> place = corner.list(2, 2);
    profile_m.emplace_back(place[0].number(within(kSizeMax_m)),
                           place[1].number(within(kSizeMax_m)));
  }
  const double length_m = map.number("length_m", positive_to(kSizeMax_m));
  try {
    TriangleMesh mesh = extruded(std::move(profile_m), length_m);
    check_mesh(mesh);
    return std::make_shared<const Solid>(std::move(mesh));
  } catch (const InputError& error) {
    map.at("profile_m").refuse(error.what());
  }
}

/// Where the file's own origin stands, drawn about the middle of the box around the solid.
void set_solid(Shape& shape, std::shared_ptr<const Solid> solid) {
  shape.kind = Shape::Kind::kSolid;
  shape.size_m = solid->size_m();
  shape.pose = compose(shape.pose, {solid->centre_m(), Eigen::Quaterniond::Identity()});
  shape.solid = std::move(solid);
}

}  // namespace

std::shared_ptr<const Solid> ShapeReader::read_mesh(const Value& value) {
  const Map map(value, {"file", "scale"});
  const std::filesystem::path file = folder_ / map.at("file").text();
  const double scale = map.number("scale", positive_to(kScaleMax));
  std::shared_ptr<const Solid>& solid = meshes_[{file, scale}];
  if (solid) return solid;
  std::string bytes;
  try {
    bytes = read_file(file);
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
  try {
    solid = std::make_shared<const Solid>(parse_part(file, bytes, scale));
  } catch (const InputError& error) {
    value.refuse(file.string() + ": " + error.what());
  }
  contents_ += format("#%016llx", static_cast<unsigned long long>(fnv1a_64(bytes)));
  return solid;
}

/// A shape, or those that a ring is made of.
std::vector<Shape> ShapeReader::read_shape(const Value& value) {
  const Map map(value, {"name", "box_m", "cylinder", "ring", "extrusion", "mesh", "pose"});
  Shape shape;
  shape.name = map.at("name").name();
  if (!names_.insert(shape.name).second) map.at("name").refuse_value("unique among the shapes");
  shape.pose = map.at("pose").pose();
  const auto box = map.find("box_m");
  const auto cylinder = map.find("cylinder");
  const auto ring = map.find("ring");
  const auto extrusion = map.find("extrusion");
  const auto mesh = map.find("mesh");
  std::string given;
  for (const char* key : kKinds) {
    if (map.find(key)) given += std::string(given.empty() ? "" : " and ") + key;
  }
  if (given.find(' ') != std::string::npos) {
    value.refuse("has " + given + ": an entry is one shape; give each an entry of its own");
  }
  if (given.empty()) {
    value.refuse(
        "needs one of box_m: [x, y, z], cylinder: {diameter_m: d, length_m: l}, "
        "ring: {inner_diameter_m: i, outer_diameter_m: o, length_m: l}, "
        "extrusion: {profile_m: [[x, y], ...], length_m: l}, mesh: {file: f, scale: s}");
  }
  if (ring) return boxes_of(read_ring(*ring, shape.name, shape.pose));
  if (extrusion) {
    set_solid(shape, read_extrusion(*extrusion));
  } else if (mesh) {
    set_solid(shape, read_mesh(*mesh));
  } else if (box) {
    shape.size_m = box->vector(positive_to(kSizeMax_m));
  } else {
    const Map sizes(*cylinder, {"diameter_m", "length_m"});
    const double diameter_m = sizes.number("diameter_m", positive_to(kSizeMax_m));
    shape.kind = Shape::Kind::kCylinder;
    shape.size_m = {diameter_m, diameter_m, sizes.number("length_m", positive_to(kSizeMax_m))};
  }
  return {shape};
}

std::vector<Shape> ShapeReader::read(const Value& value) {
  std::vector<Shape> shapes;
  for (const Value& entry : value.list(1, kShapesMax)) {
    const std::vector<Shape> read = read_shape(entry);
    shapes.insert(shapes.end(), read.begin(), read.end());
  }
  return shapes;
}

}  // namespace tenon::config
