// The schemas that editors complete from, held against the loaders: into each mapping of each file
// a key is put that nobody knows, and the loader says which it knows there.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "shared/base/error.h"
#include "shared/config/drive_file.h"
#include "shared/config/friction_file.h"
#include "shared/config/load.h"
#include "shared/config/sensor_file.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

using nlohmann::json;
using Names = std::set<std::string>;
using Loader = std::function<void(const std::filesystem::path&)>;

const char* const kUnknown = "qqqqqqqqqqqq";

json schema_of(const std::string& kind) {
  return json::parse(std::ifstream(in_tree("shared/config/schemas/" + kind + ".schema.json")));
}

Names keys_of(const json& properties) {
  Names names;
  for (const auto& [key, value] : properties.items()) names.insert(key);
  return names;
}

/// "FILE:3: x: is an unknown key, known here: a, b; did you mean ..."
Names known_in(const std::string& message) {
  const std::string mark = "known here: ";
  const std::size_t begin = message.find(mark);
  if (begin == std::string::npos) return {};
  std::string list = message.substr(begin + mark.size());
  list.erase(std::min(list.size(), list.find(';')));
  Names names;
  std::stringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    names.insert(word.substr(word.find_first_not_of(' ')));
  }
  return names;
}

class Walk {
 public:
  Walk(const json& schema, std::filesystem::path file, Loader load)
      : schema_(schema), file_(std::move(file)), load_(std::move(load)) {
    std::ostringstream text;
    text << std::ifstream(file_).rdbuf();
    text_ = text.str();
  }

  void all() { visit(YAML::Load(text_), "#"); }

  [[nodiscard]] const Names& visited() const { return visited_; }

 private:
  /// Where a schema's place leads, through references and alternatives.
  [[nodiscard]] std::string resolved(std::string place, const YAML::Node& node) const {
    for (;;) {
      const json& at = schema_.at(json::json_pointer(place.substr(1)));
      if (at.contains("$ref")) {
        place = at["$ref"].get<std::string>();
        continue;
      }
      if (!at.contains("anyOf")) return place;
      std::string found;
      for (std::size_t i = 0; i < at["anyOf"].size() && found.empty(); ++i) {
        const std::string alternative = place + "/anyOf/" + std::to_string(i);
        if (fits(alternative, node)) found = alternative;
      }
      if (found.empty()) return place;
      place = found;
    }
  }

  [[nodiscard]] bool fits(const std::string& place, const YAML::Node& node) const {
    const json& at = schema_.at(json::json_pointer(place.substr(1)));
    if (node.IsSequence()) return at.value("type", "") == "array";
    if (!node.IsMap()) return at.value("type", "") != "object" && at.value("type", "") != "array";
    if (!at.contains("properties")) return false;
    for (const auto& entry : node) {
      if (!at["properties"].contains(entry.first.as<std::string>())) return false;
    }
    return true;
  }

  void visit(const YAML::Node& node, const std::string& from) {
    const std::string place = resolved(from, node);
    const json& at = schema_.at(json::json_pointer(place.substr(1)));
    if (node.IsSequence() && at.contains("items")) {
      for (const YAML::Node& item : node) visit(item, place + "/items");
    }
    if (!node.IsMap() || !at.contains("properties")) return;
    visited_.insert(place);
    EXPECT_EQ(known_at(node), keys_of(at["properties"])) << file_ << " " << place;
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>();
      ASSERT_TRUE(at["properties"].contains(key)) << file_ << " " << place << " " << key;
      visit(entry.second, place + "/properties/" + key);
    }
  }

  /// What the loader knows beside the mapping's first key.
  [[nodiscard]] Names known_at(const YAML::Node& map) const {
    const YAML::Mark mark = map.begin()->first.Mark();
    const bool flow = map.Style() == YAML::EmitterStyle::Flow;
    const std::string put =
        std::string(kUnknown) + ": 0" +
        (flow ? ", " : "\n" + std::string(static_cast<std::size_t>(mark.column), ' '));
    std::string changed = text_;
    changed.insert(static_cast<std::size_t>(mark.pos), put);
    const std::filesystem::path beside = file_.parent_path() / "changed.yaml";
    std::ofstream(beside) << changed;
    try {
      load_(beside);
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(kUnknown), std::string::npos) << message;
      return known_in(message);
    }
    ADD_FAILURE() << file_ << " loads with an unknown key:\n" << changed;
    return {};
  }

  const json& schema_;
  std::filesystem::path file_;
  Loader load_;
  std::string text_;
  Names visited_;
};

/// Every place of a schema where a mapping with keys of its own may stand.
void add_mappings(const json& at, const std::string& place, Names& mappings) {
  if (at.is_object() && at.contains("properties") && at["properties"].is_object() &&
      at.value("type", "") == "object") {
    mappings.insert(place);
  }
  if (!at.is_structured()) return;
  for (const auto& [key, value] : at.items()) add_mappings(value, place + "/" + key, mappings);
}

std::vector<std::filesystem::path> yaml_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A copy of what ships, since files name others by their place.
class Schemas : public testing::Test {
 protected:
  Schemas() {
    for (const char* folder :
         {"hw/cells", "hw/robots", "hw/drives", "hw/sensors", "planner/tasks"}) {
      std::filesystem::create_directories(scratch.path() / folder);
      std::filesystem::copy(in_tree(folder), scratch.path() / folder,
                            std::filesystem::copy_options::recursive);
    }
    scratch.put("sim/experiments/here.yaml", "name: here\n");
    for (const auto& entry : std::filesystem::directory_iterator(in_tree("sim/experiments"))) {
      if (entry.path().extension() != ".yaml") continue;
      std::filesystem::copy(entry.path(),
                            scratch.path() / "sim/experiments" / entry.path().filename());
    }
  }

  /// All shipped files of a kind and these; together they reach every mapping of the schema.
  void hold(const std::string& kind, const std::string& folder, const Loader& load,
            const std::vector<std::string>& more = {}) {
    const json schema = schema_of(kind);
    for (std::size_t i = 0; i < more.size(); ++i) {
      scratch.put(folder + "/more" + std::to_string(i) + ".yaml", more[i]);
    }
    Names visited;
    for (const auto& file : yaml_files(scratch.path() / folder)) {
      Walk walk(schema, file, load);
      walk.all();
      visited.insert(walk.visited().begin(), walk.visited().end());
    }
    Names mappings;
    add_mappings(schema, "#", mappings);
    EXPECT_EQ(visited, mappings);
  }

  ScratchFolder scratch;
};

TEST_F(Schemas, ATaskHasTheKeysThatItsLoaderKnows) {
  hold("task", "planner/tasks", [](const auto& file) { static_cast<void>(load_task(file)); },
       {R"(name: every shape
coordinates: [x, y, z]
held:
  - {name: peg, cylinder: {diameter_m: 0.02, length_m: 0.1}, pose: {position_m: [0, 0, 0.05]}}
environment:
  - {name: wall, extrusion: {profile_m: [[0, 0], [1, 0], [0, 1]], length_m: 0.1}, pose: {position_m: [1, 0, 0]}}
  - {name: hole, ring: {inner_diameter_m: 0.03, outer_diameter_m: 0.1, length_m: 0.1}, pose: {position_m: [0, 0, 0]}}
  - {name: socket, mesh: {file: parts/keyed_socket.stl, scale: 0.001}, pose: {position_m: [3, 0, 0]}}
starts:
  - {name: a, pose: {position_m: [0, 0, 0.1]}, sigma_m: [0.008, 0.008, 0.008]}
goal: {pose: {position_m: [0, 0, 0]}, tolerance_m: 2e-3, tolerances: {z_m: 4e-3}, free: [y], inserted: {box_m: [1, 1, 1], pose: {position_m: [0, 0, 0]}}}
primitives: {step_m: 0.01, long_step_m: 0.2, direct_reach_m: 0.1}
speeds: {approach_mps: 0.10, contact_mps: 0.05}
contact: {force_on_N: 9, force_keep_N: 3, force_off_N: 1.5, debounce_s: 0.006, force_limit_N: 20}
compliance: {axes: [x, y, z], mass_kg: 2.0, damping_Nspm: 1500, stiffness_Npm: 1000}
search: {w1: 2}
physics: {friction: {low: 0.1, nominal: 0.3, high: 0.6}, contact_stiffness_Npm: 5e4}
)"});
}

constexpr const char* kGantryFriction = R"(friction_of: gantry3
joints:
  - {name: x, coulomb_N: 6, viscous_Nspm: 3, offset_N: 0.1, way_m: 3e-5, hysteresis_N: 1, hysteresis_way_m: 5e-3, residual_N: 1.5}
  - {name: y, coulomb_N: 6, viscous_Nspm: 3, offset_N: 0.1, way_m: 3e-5, hysteresis_N: 1, hysteresis_way_m: 5e-3, residual_N: 1.5}
  - {name: z, coulomb_N: 6, viscous_Nspm: 3, offset_N: 0.1, way_m: 3e-5, hysteresis_N: 1, hysteresis_way_m: 5e-3, residual_N: 1.5}
)";

std::string arm_friction() {
  std::string text = "friction_of: csp6\njoints:\n";
  for (int i = 1; i <= 6; ++i) {
    text += "  - {name: arm_" + std::to_string(i) +
            ", coulomb_Nm: 6, viscous_Nmspr: 3, offset_Nm: 0.1, way_rad: 3e-4, hysteresis_Nm: 1, "
            "hysteresis_way_rad: 5e-3, residual_Nm: 1.5}\n";
  }
  return text;
}

TEST_F(Schemas, AFrictionFileHasTheKeysThatItsLoaderKnows) {
  hold("friction", "friction",
       [](const auto& file) {
         std::ostringstream text;
         text << std::ifstream(file).rdbuf();
         const bool gantry = text.str().find("friction_of: gantry3") != std::string::npos;
         const std::string robot = gantry ? "gantry3" : "csp6";
         static_cast<void>(config::read_friction(
             file, load_robot(in_tree("hw/robots/" + robot + "/robot.yaml"))));
       },
       {kGantryFriction, arm_friction()});
}

TEST_F(Schemas, ACellHasTheKeysThatItsLoaderKnows) {
  const std::string biased =
      "\nsensor_bias: {force_N: [0, 0, 0], torque_Nm: [0, 0, 0], force_tolerance_N: 1, "
      "torque_tolerance_Nm: 0.1}\n";
  scratch.put("friction/gantry3.yaml", kGantryFriction);
  const std::string gantry = scratch.get("hw/cells/gantry3.yaml");
  hold("cell", "hw/cells", [](const auto& file) { static_cast<void>(load_cell(file)); },
       {gantry.find("sensor_bias:") == std::string::npos ? gantry + biased : gantry,
        gantry + "\njoint_torque: {friction: ../../friction/gantry3.yaml}\n"});
}

TEST_F(Schemas, ADriveHasTheKeysThatItsLoaderKnows) {
  hold("drive", "hw/drives", [](const auto& file) { static_cast<void>(load_drive(file)); },
       {"name: all\nobjects: {6072h: {presence: optional, how: clamp}}\n"
        "extra: [{object: 2010h, type: u8, value: 1}]\npdos: {mapping: fixed}\n"});
}

TEST_F(Schemas, AnExperimentHasTheKeysThatItsLoaderKnows) {
  std::string every = "name: every\n";
  const json schema = schema_of("experiment");
  for (const auto& [key, value] : schema["properties"].items()) {
    if (value.contains("anyOf")) every += key + ": {sigma: 0.001}\n";
  }
  hold("experiment", "sim/experiments",
       [](const auto& file) { static_cast<void>(load_experiment(file)); }, {every});
}

TEST_F(Schemas, ARobotHasTheKeysThatItsLoaderKnows) {
  std::string polled = scratch.get("hw/robots/gantry3/robot.yaml");
  polled.erase(polled.find("sensor:"));
  polled.replace(polled.find("gantry3.urdf"), 0, "gantry3/");
  polled +=
      "sensor: {profile: ../sensors/robotous_rft.yaml, identifiers: {first: 0x21}, bus: "
      "{bitrate_bps: 1000000}}\n";
  hold("robot", "hw/robots", [](const auto& file) { static_cast<void>(load_robot(file)); },
       {polled});
}

TEST_F(Schemas, ASensorHasTheKeysThatItsLoaderKnows) {
  hold("sensor", "hw/sensors",
       [](const auto& file) { static_cast<void>(config::read_sensor_profile(file)); });
}

}  // namespace
}  // namespace tenon::tests
