#include "hw/main_can_check.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>

#include "hw/check/device_check.h"
#include "shared/base/error.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/eds/device_file.h"

namespace tenon::hw {
namespace {

/// The node before the first equals sign; unset: there is none, all is a file's name.
std::optional<std::uint8_t> node_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return std::nullopt;
  unsigned node = 0;
  const char* end = text.data() + equals;
  const auto [rest, error] = std::from_chars(text.data(), end, node);
  if (error != std::errc{} || rest != end) return std::nullopt;
  if (node < 1 || node > 127) throw InputError("--eds " + text + ": NODE must be in [1, 127]");
  return static_cast<std::uint8_t>(node);
}

bool has_node(const Robot& robot, std::uint8_t node) {
  return std::any_of(robot.joints.begin(), robot.joints.end(),
                     [&](const Joint& joint) { return joint.node == node; });
}

class Files {
 public:
  explicit Files(const Robot& robot) : robot_(robot) {}

  void add(const std::string& text) {
    auto node = node_of(text);
    const std::string name = node ? text.substr(text.find('=') + 1) : text;
    DeviceFile file = parse_device_file(name, config::read_file(name));
    for (const std::string& slip : file.slips)
      std::fprintf(stderr, "tenon-can: %s\n", slip.c_str());
    if (node && !has_node(robot_, *node)) {
      throw InputError("--eds " + text + ": is no joint's node of robot " + robot_.name);
    }
    if (node) {
      if (!named_.emplace(*node, file).second) {
        throw InputError("--eds " + text + ": this node has a file already");
      }
      return;
    }
    plain_.push_back(std::move(file));
  }

  /// One file without a node is for every joint; of several, each for the node that it names.
  [[nodiscard]] std::map<std::uint8_t, DeviceFile> by_node() const {
    auto all = named_;
    for (const DeviceFile& file : plain_) {
      if (plain_.size() == 1) {
        for (const Joint& joint : robot_.joints) all.emplace(joint.node, file);
      } else if (!file.node || !has_node(robot_, *file.node)) {
        throw InputError("--eds " + file.name +
                         ": of several files each must say its node, as in --eds 3=" + file.name);
      } else if (!all.emplace(*file.node, file).second) {
        throw InputError("--eds " + file.name + ": node " + std::to_string(*file.node) +
                         " has a file already");
      }
    }
    return all;
  }

 private:
  const Robot& robot_;
  std::map<std::uint8_t, DeviceFile> named_;
  std::vector<DeviceFile> plain_;
};

}  // namespace

int check_robot_file(const std::string& robot_file, const std::vector<std::string>& eds) {
  const Robot robot = load_robot(robot_file);
  Files files(robot);
  for (const std::string& text : eds) files.add(text);
  const CheckReport report = check_report(robot, files.by_node());
  std::fputs(report.text.c_str(), stdout);
  return report.good ? 0 : 1;
}

}  // namespace tenon::hw
