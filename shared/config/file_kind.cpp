#include "shared/config/file_kind.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
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

const std::array<Kind, 10>& kinds() {
  static const std::array<Kind, 10> kKinds = {{
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
      {FileKind::kResult, "a run's result", "goes with tenon-inspect --run", {"disable_confirmed"}},
      {FileKind::kTruth,
       "a simulator's truth file",
       "is for people, and for tenon.read_truth in Python",
       {"frames_not_sent"}},
      {FileKind::kEvaluation,
       "an evaluation's result",
       "is for people and other programs",
       {"plans"}},
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

/// "is a part (STL); ..." of what a text begins like; nothing where it is like none of these.
std::string told_by_its_beginning(std::string_view text) {
  constexpr std::size_t kHeader_bytes = 80;
  constexpr std::size_t kTriangle_bytes = 50;
  const auto part = [](const char* format) {
    return std::string("is a part (") + format +
           "): a task file names it as mesh: {file: ..., scale: ...}, and tenon-plan --new-task "
           "PLUG SOCKET writes one from two";
  };
  std::string_view start = text.substr(0, text.find_first_of('\0'));
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  const auto has_line = [&](std::string_view word) {
    const std::size_t at = start.find(std::string("\n").append(word));
    return start.starts_with(word) || at != std::string_view::npos;
  };
  if (start.starts_with("solid") && start.find("facet") != std::string_view::npos) {
    return part("STL");
  }
  if (text.size() > kHeader_bytes + sizeof(std::uint32_t)) {
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, text.data() + kHeader_bytes, sizeof(triangles));
    const std::size_t rest = text.size() - kHeader_bytes - sizeof(triangles);
    if (triangles > 0 && rest == kTriangle_bytes * triangles) return part("STL");
  }
  if (has_line("v ") && has_line("f ")) return part("OBJ");
  if (start.starts_with("ISO-10303")) {
    return "is a STEP file: export the part as STL or OBJ, and name that in a task file";
  }
  if (!start.starts_with('<')) return "";
  return start.find("<robot") != std::string_view::npos
             ? "is a URDF, which a robot file names (urdf: ...)"
             : "is a page, for a browser, or other XML";
}

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
  if (const std::string told = told_by_its_beginning(text); !told.empty()) {
    throw InputError(file.string() + ": " + told + "; here a YAML file is asked for");
  }
  // Whatever else may be wrong with it.
  const DecodedPlan plan =
      decode_plan({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!text.starts_with("TNP") || plan.error == PlanError::kMagic) return;
  throw InputError(file.string() + ": is a plan (.tnp), which tenon-inspect reads and tenon-exec " +
                   "and tenon-evaluate take with --plan; here a YAML file is asked for");
}

}  // namespace tenon::config
