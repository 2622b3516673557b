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

const Kind* kind_of(const Value& document) {
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) {
    return has_one_of(document, kind.telling);
  });
  return found == kinds().end() ? nullptr : &*found;
}

std::string mistaken(const Kind& kind, const std::string& wanted) {
  const std::string name(kind.name);
  return "is " + name + ", not " + wanted + "; " + name + " " + std::string(kind.where);
}

/// The sync word that every event of LCM's log format begins with.
bool is_lcm_log(const std::string& text) { return text.starts_with("\xED\xA1\xDA\x01"); }

constexpr const char* kIsLog =
    "is a log of messages, which tenon-inspect reads with --log and tenon-monitor with export";

}  // namespace

void expect_kind(const std::filesystem::path& file, const Value& document, FileKind wanted) {
  if (!document.is_mapping()) return;
  const auto own = std::find_if(kinds().begin(), kinds().end(),
                                [wanted](const Kind& kind) { return kind.kind == wanted; });
  if (has_one_of(document, own->telling)) return;
  if (const Kind* other = kind_of(document)) {
    throw InputError(file.string() + ": " + mistaken(*other, std::string(own->name)));
  }
}

std::string kind_told(const std::filesystem::path& file, const std::string& text) {
  if (is_lcm_log(text)) return kIsLog;
  try {
    const Value document = Value::parse(file, text);
    const Kind* kind = document.is_mapping() ? kind_of(document) : nullptr;
    return kind == nullptr ? std::string() : mistaken(*kind, "a plan file");
  } catch (const InputError&) {
    return {};
  }
}

void expect_text(const std::filesystem::path& file, const std::string& text) {
  if (is_lcm_log(text)) {
    throw InputError(file.string() + ": " + kIsLog + "; here a YAML file is asked for");
  }
  // Whatever else may be wrong with it.
  const DecodedPlan plan =
      decode_plan({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!text.starts_with("TNP") || plan.error == PlanError::kMagic) return;
  throw InputError(file.string() + ": is a plan (.tnp), which tenon-inspect reads and tenon-exec " +
                   "and tenon-evaluate take with --plan; here a YAML file is asked for");
}

}  // namespace tenon::config
