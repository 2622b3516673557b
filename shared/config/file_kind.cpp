#include "shared/config/file_kind.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "shared/base/error.h"
#include "shared/plan/codec.h"

namespace tenon::config {
namespace {

struct Kind {
  FileKind kind;
  std::string_view name;
  std::string_view where;                 ///< it goes
  std::vector<std::string_view> telling;  ///< keys that no other kind has
};

const std::array<Kind, 7>& kinds() {
  static const std::array<Kind, 7> kKinds = {{
      {FileKind::kTask,
       "a task file",
       "goes first with tenon-plan, elsewhere with --task",
       {"held", "environment", "goal", "starts"}},
      {FileKind::kCell, "a cell file", "goes with --cell", {"task_in_base", "tool_in_flange"}},
      {FileKind::kRobot, "a robot file", "is named by a cell file", {"urdf", "joints"}},
      {FileKind::kDrive, "a drive profile", "is named by a robot's joint", {"objects", "modes"}},
      {FileKind::kSensor,
       "a sensor profile",
       "is named by a robot's sensor",
       {"identifiers", "unverified", "force_per_count_N"}},
      {FileKind::kExperiment,
       "an experiment",
       "goes with tenon-evaluate --experiment",
       {"task_in_base_error_m", "sensor_noise_factor", "servo_stiffness_factor"}},
      {FileKind::kFriction,
       "a friction file",
       "is named by a cell's joint_torque",
       {"friction_of"}},
  }};
  return kKinds;
}

bool has_one_of(const Value& document, const std::vector<std::string_view>& keys) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](std::string_view key) { return document.peek(key).has_value(); });
}

}  // namespace

void expect_kind(const std::filesystem::path& file, const Value& document, FileKind wanted) {
  if (!document.is_mapping()) return;
  const auto own = std::find_if(kinds().begin(), kinds().end(),
                                [wanted](const Kind& kind) { return kind.kind == wanted; });
  if (has_one_of(document, own->telling)) return;
  for (const Kind& other : kinds()) {
    if (!has_one_of(document, other.telling)) continue;
    const std::string name(other.name);
    std::string line = file.string();
    line.append(": is ").append(name).append(", not ").append(own->name);
    throw InputError(line.append("; ").append(name).append(" ").append(other.where));
  }
}

void expect_no_plan(const std::filesystem::path& file, const std::string& text) {
  // Whatever else may be wrong with it.
  const DecodedPlan plan =
      decode_plan({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!text.starts_with("TNP") || plan.error == PlanError::kMagic) return;
  throw InputError(file.string() + ": is a plan (.tnp), which tenon-inspect reads and tenon-exec " +
                   "and tenon-evaluate take with --plan; here a YAML file is asked for");
}

}  // namespace tenon::config
