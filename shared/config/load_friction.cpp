#include <optional>

#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/friction_file.h"
#include "shared/config/yaml_value.h"
#include "shared/ports/arm.h"

namespace tenon::config {
namespace {

constexpr double kEffortMax = 1e5;
constexpr double kViscousMax = 1e7;

/// Each key's unit is its joint's.
JointFriction read_joint(const Value& value, const Joint& joint) {
  const bool turns = joint.kind == Joint::Kind::kRevolute;
  const char* coulomb = turns ? "coulomb_Nm" : "coulomb_N";
  const char* viscous = turns ? "viscous_Nmspr" : "viscous_Nspm";
  const char* offset = turns ? "offset_Nm" : "offset_N";
  const char* way = turns ? "way_rad" : "way_m";
  const char* residual = turns ? "residual_Nm" : "residual_N";
  const char* hysteresis = turns ? "hysteresis_Nm" : "hysteresis_N";
  const char* hysteresis_way = turns ? "hysteresis_way_rad" : "hysteresis_way_m";
  const Map map(value,
                {"name", coulomb, way, hysteresis, hysteresis_way, viscous, offset, residual});
  JointFriction friction;
  friction.coulomb = map.number(coulomb, {0.0, kEffortMax});
  friction.viscous = map.number(viscous, {0.0, kViscousMax});
  friction.offset = map.number(offset, within(kEffortMax));
  friction.way = map.number(way, positive_to(1.0));
  friction.hysteresis = map.number(hysteresis, {0.0, kEffortMax});
  friction.hysteresis_way = map.number(hysteresis_way, positive_to(1.0));
  friction.residual = map.number(residual, positive_to(kEffortMax));
  return friction;
}

}  // namespace

std::vector<JointFriction> read_friction(const std::filesystem::path& file, const Robot& robot) {
  const Value document = Value::parse(file, read_file(file));
  expect_kind(file, document, FileKind::kFriction);
  const Map map(document, {"friction_of", "joints"});
  const Value of = map.at("friction_of");
  if (of.text() != robot.name) of.refuse_value(robot.name + ", the cell's robot");
  std::vector<std::optional<JointFriction>> found(robot.joints.size());
  for (const Value& entry : map.at("joints").list(1, kMaxJoints)) {
    const auto name = entry.peek("name");
    if (!name) entry.refuse("the required key name is missing");
    bool known = false;
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      if (robot.joints[i].name != name->text()) continue;
      if (found[i]) name->refuse_value("listed once");
      found[i] = read_joint(entry, robot.joints[i]);
      known = true;
    }
    if (!known) name->refuse_value("a joint of robot " + robot.name);
  }
  std::vector<JointFriction> joints;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) map.at("joints").refuse("lacks joint " + robot.joints[i].name);
    joints.push_back(*found[i]);
  }
  return joints;
}

}  // namespace tenon::config
