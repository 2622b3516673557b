#include "sim/cell/faults/fault_spec.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>

#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/plan/plan.h"

namespace tenon::sim {
namespace {

/// What a kind takes beyond the keys of all.
struct Kind {
  FaultKind kind = FaultKind::kDrop;
  const char* name = "";
  bool needs_node = false;
  const char* value_key = nullptr;  ///< null: it has no value
  double value_min = 0.0;
  double value_max = 0.0;
  const char* meaning = "";
  const char* example = "";
};

constexpr std::array<Kind, 27> kKinds{{
    {FaultKind::kDrop, "drop", false, nullptr, 0, 0, "a frame is lost for all receivers",
     "drop:node=3,time_s=2,duration_s=0.5,probability=0.1,seed=7"},
    {FaultKind::kDelay, "delay", false, "delay_s", 1e-6, 10.0, "a frame arrives delay_s late",
     "delay:node=1,time_s=2,duration_s=1,delay_s=0.003"},
    {FaultKind::kDuplicate, "duplicate", false, nullptr, 0, 0, "a frame arrives twice",
     "duplicate:node=127,time_s=2,duration_s=1"},
    {FaultKind::kCorruptLength, "corrupt-length", false, nullptr, 0, 0,
     "a frame arrives one byte short", "corrupt-length:node=127,time_s=2,duration_s=0.1"},
    {FaultKind::kBusOff, "bus-off", false, nullptr, 0, 0,
     "the node's controller leaves the bus; without a node: every controller",
     "bus-off:node=2,time_s=3"},
    {FaultKind::kQueueFull, "queue-full", false, nullptr, 0, 0,
     "the node's transmit queue takes no frame", "queue-full:node=127,time_s=2,duration_s=0.01"},
    {FaultKind::kInterfaceDown, "interface-down", false, nullptr, 0, 0,
     "the interface is down, for all", "interface-down:time_s=2,duration_s=0.2"},
    {FaultKind::kNodeReset, "node-reset", true, nullptr, 0, 0,
     "the node restarts, as after a dip of its supply", "node-reset:node=2,time_s=3"},
    {FaultKind::kSilentNode, "silent-node", true, nullptr, 0, 0,
     "the node neither sends nor receives", "silent-node:node=2,time_s=3,duration_s=0.5"},
    {FaultKind::kEmergency, "emergency", true, "code", 1.0, 65535.0,
     "the node sends the emergency of that code; a drive faults with it",
     "emergency:node=1,time_s=3,code=0x3210"},
    {FaultKind::kEncoderJump, "encoder-jump", true, "jump_m|jump_rad", -10.0, 10.0,
     "the joint's position reads that much further from then on",
     "encoder-jump:node=1,time_s=3,jump_m=0.002"},
    {FaultKind::kBrakeFailure, "brake-failure", true, nullptr, 0, 0,
     "the joint's brake does not hold", "brake-failure:node=3"},
    {FaultKind::kStaleForce, "stale-force", false, nullptr, 0, 0,
     "the sensor repeats its last sample, counter included",
     "stale-force:time_s=3,duration_s=0.05"},
    {FaultKind::kTornForce, "torn-force", false, nullptr, 0, 0,
     "the halves of a wrench come from different samples",
     "torn-force:time_s=3,duration_s=1,probability=0.2"},
    {FaultKind::kSaturatedForce, "saturated-force", false, nullptr, 0, 0,
     "the sensor reads the end of its range", "saturated-force:time_s=3,duration_s=0.01"},
    {FaultKind::kTorqueLoss, "torque-loss", true, "share", 0.0, 0.999,
     "the joint's drive gives that share of its effort", "torque-loss:node=3,time_s=3,share=0.5"},
    {FaultKind::kFrozenDrive, "frozen-drive", true, nullptr, 0, 0,
     "the drive stands still under power and says that all is well",
     "frozen-drive:node=1,time_s=3,duration_s=1"},
    {FaultKind::kKeepsPower, "keeps-power", true, nullptr, 0, 0,
     "once its master is lost, the drive stays in quick stop active, under power",
     "keeps-power:node=3"},
    {FaultKind::kSlowBrake, "slow-brake", true, "brake_s", 0.0, 10.0,
     "the brake holds that long after its output; the drive switches off as if it were quick",
     "slow-brake:node=3,brake_s=0.05"},
    {FaultKind::kResumesStop, "resumes-stop", true, nullptr, 0, 0,
     "the drive leaves a quick stop for the last enable word from before it, once each",
     "resumes-stop:node=1"},
    {FaultKind::kFrozenForce, "frozen-force", false, nullptr, 0, 0,
     "the sensor's wrench stays as it was, its counter runs on",
     "frozen-force:at=contact,duration_s=0.5"},
    {FaultKind::kDriftingForce, "drifting-force", false, "rate_Nps", -1000.0, 1000.0,
     "the sensor's force along x moves away at that rate", "drifting-force:time_s=3,rate_Nps=0.5"},
    {FaultKind::kForgedForce, "forged-force", false, "force_N", -1000.0, 1000.0,
     "the sensor's force along x reads that much more",
     "forged-force:at=free,time_s=0.1,force_N=80,duration_s=0.01"},
    {FaultKind::kWrongUnits, "wrong-units", false, "factor", 1e-3, 1000.0,
     "the sensor reads factor times what it feels, as if in another unit",
     "wrong-units:factor=4.448"},
    {FaultKind::kWrongMatrix, "wrong-matrix", false, nullptr, 0, 0,
     "the sensor's x reads y, y reads z and z reads x, as by another sensor's calibration",
     "wrong-matrix:time_s=0"},
    {FaultKind::kOverrangeForce, "overrange-force", false, nullptr, 0, 0,
     "the sensor tells by its own means that it is loaded beyond its range",
     "overrange-force:at=contact,duration_s=0.01"},
    {FaultKind::kFrozenEffort, "frozen-effort", true, nullptr, 0, 0,
     "the effort that the drive reports stays as it was", "frozen-effort:node=3,time_s=3"},
}};

constexpr std::array<std::string_view, kFaultPhases> kPhaseNames = {"enabling", "free", "sliding",
                                                                    "contact", "stopping"};
// By the values of FrameKind, up to kSdo.
constexpr std::array<std::string_view, 7> kFrameNames = {"any",     "sync", "heartbeat", "emcy",
                                                         "answers", "rpdo", "sdo"};

const Kind& kind_of(FaultKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

constexpr bool in_order() {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (static_cast<std::size_t>(kKinds[i].kind) != i) return false;
  }
  return true;
}
static_assert(in_order());

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("fault \"" + text + "\": " + why + "; --fault help lists all");
}

std::string keys_of(const Kind& kind) {
  std::string keys = "node, time_s, duration_s, probability, seed, at";
  if (chooses_frames(kind.kind)) keys += ", id";
  if (kind.value_key != nullptr) keys += std::string(", ") + kind.value_key;
  return keys;
}

/// `key` is one of the names that a kind's value goes by.
bool names_value(const Kind& kind, std::string_view key) {
  std::string_view names = kind.value_key == nullptr ? "" : kind.value_key;
  while (!names.empty()) {
    const std::size_t bar = names.find('|');
    if (names.substr(0, bar) == key) return true;
    if (bar == std::string_view::npos) return false;
    names.remove_prefix(bar + 1);
  }
  return false;
}

std::string range_of(double low, double high) { return format("[%g, %g]", low, high); }

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  Fault parse() {
    std::string_view rest = text_;
    const std::size_t colon = rest.find(':');
    const Kind& kind = find_kind(rest.substr(0, colon));
    fault_.kind = kind.kind;
    std::size_t separator = colon;
    while (separator != std::string_view::npos) {
      rest.remove_prefix(separator + 1);
      separator = rest.find(',');
      take(kind, rest.substr(0, separator));
    }
    if (kind.needs_node && fault_.node == 0) refuse(text_, "node is missing, 1..127");
    if (kind.value_key != nullptr && !value_given_) {
      refuse(text_, std::string(kind.value_key) + " is missing");
    }
    return fault_;
  }

 private:
  const Kind& find_kind(std::string_view name) const {
    for (const Kind& kind : kKinds) {
      if (kind.name == name) return kind;
    }
    refuse(text_, "there is no kind '" + std::string(name) + "'");
  }

  void take(const Kind& kind, std::string_view item) {
    const std::size_t equals = item.find('=');
    const std::string key(item.substr(0, equals));
    if (equals == std::string_view::npos) {
      refuse(text_, "'" + key + "' has no value, KEY=VALUE expected");
    }
    if (seen_.find("," + key + ",") != std::string::npos)
      refuse(text_, key + " stands there twice");
    seen_ += "," + key + ",";
    const std::string_view value = item.substr(equals + 1);
    if (key == "node") {
      fault_.node = static_cast<std::uint8_t>(integer(key, value, kind.needs_node ? 1 : 0, 127));
    } else if (key == "at") {
      take_at(key, value);
    } else if (key == "id" && chooses_frames(kind.kind)) {
      take_id(key, value);
    } else if (key == "time_s") {
      fault_.time_s = number(key, value, 0.0, kTimeMax_s);
    } else if (key == "duration_s") {
      fault_.duration_s = number(key, value, 0.0, kTimeMax_s);
    } else if (key == "probability") {
      fault_.probability = number(key, value, 1e-9, 1.0);
    } else if (key == "seed") {
      fault_.seed = integer(key, value, 0, ~std::uint64_t{0});
    } else if (names_value(kind, key)) {
      fault_.value = kind.kind == FaultKind::kEmergency
                         ? static_cast<double>(integer(key, value, 1, 0xFFFF))
                         : number(key, value, kind.value_min, kind.value_max);
      value_given_ = true;
      if (key == "jump_m") fault_.unit = FaultUnit::kMetre;
      if (key == "jump_rad") fault_.unit = FaultUnit::kRadian;
    } else {
      refuse(text_, "there is no key '" + key + "'; " + kind.name + " takes " + keys_of(kind));
    }
  }

  /// The place of `value` among the names. @param besides what a refusal says may stand there too
  [[nodiscard]] std::size_t one_of(const std::string& key, std::string_view value,
                                   std::span<const std::string_view> names,
                                   const char* besides = "") const {
    const auto found = std::find(names.begin(), names.end(), value);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    std::string all;
    for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
    refuse(text_, key + " = '" + std::string(value) + "', must be one of " + all + besides);
  }

  void take_at(const std::string& key, std::string_view value) {
    if (!value.starts_with(kStepOf)) {
      fault_.at = static_cast<FaultPhase>(one_of(key, value, kPhaseNames, ", step:N"));
      return;
    }
    value.remove_prefix(kStepOf.size());
    fault_.at_step = static_cast<int>(integer(key, value, 0, kSuccessorDone - 1));
  }

  void take_id(const std::string& key, std::string_view value) {
    if (!value.empty() && value.front() >= '0' && value.front() <= '9') {
      fault_.frames = FrameKind::kOne;
      fault_.cob_id = static_cast<std::uint32_t>(integer(key, value, 0, 0x7FF));
    } else {
      fault_.frames = static_cast<FrameKind>(one_of(key, value, kFrameNames));
    }
  }

  /// Decimal, or hexadecimal with 0x.
  [[nodiscard]] std::uint64_t integer(const std::string& key, std::string_view value,
                                      std::uint64_t low, std::uint64_t high) const {
    const bool hex = value.starts_with("0x");
    const std::string_view digits = hex ? value.substr(2) : value;
    std::uint64_t result = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), result, hex ? 16 : 10);
    if (error != std::errc{} || end != digits.data() + digits.size() || result < low ||
        result > high) {
      refuse(text_, key + " = '" + std::string(value) + "', must be a whole number in [" +
                        std::to_string(low) + ", " + std::to_string(high) + "]");
    }
    return result;
  }

  [[nodiscard]] double number(const std::string& key, std::string_view value, double low,
                              double high) const {
    double result = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
    if (error != std::errc{} || end != value.data() + value.size() ||
        !(result >= low && result <= high)) {
      refuse(text_,
             key + " = '" + std::string(value) + "', must be a number in " + range_of(low, high));
    }
    return result;
  }

  static constexpr double kTimeMax_s = 1e6;
  static constexpr std::string_view kStepOf = "step:";

  const std::string& text_;
  Fault fault_;
  std::string seen_;
  bool value_given_ = false;
};

}  // namespace

Fault parse_fault(const std::string& text) { return Parser(text).parse(); }

std::string fault_help() {
  std::string help =
      "--fault KIND:KEY=VALUE,...   may be given several times\n"
      "  node          whose frames or which device, 1..127; the robot file's master_node for the\n"
      "                master; default 0: all\n"
      "  at            waits for what the cell does first: enabling, free, sliding, contact,\n"
      "                stopping, step:N of the plan, from 0 (sim/README.md says when each "
      "begins)\n"
      "  time_s        begin, in simulated seconds since switching on, or since that; default 0\n"
      "  duration_s    default 0: a single frame; where it is a state, to the end\n"
      "  probability   of each frame or sample while it lasts, (0, 1]; default 1\n"
      "  seed          of these draws; default 1\n"
      "  id            of drop, delay, duplicate, corrupt-length: which frames alone; sync, "
      "heartbeat,\n"
      "                emcy, answers (process data from node), rpdo (for node), sdo, or a number;\n"
      "                default any\n";
  for (const Kind& kind : kKinds) {
    const std::string name = kind.name;
    help += name + std::string(17 - name.size(), ' ') + kind.meaning;
    if (kind.value_key != nullptr && kind.kind != FaultKind::kEmergency) {
      help +=
          std::string(", ") + kind.value_key + " in " + range_of(kind.value_min, kind.value_max);
    }
    help += std::string("; ") + kind.example + "\n";
  }
  return help;
}

const char* to_string(FaultKind kind) { return kind_of(kind).name; }

const char* to_string(FaultPhase phase) {
  return kPhaseNames[static_cast<std::size_t>(phase)].data();
}

}  // namespace tenon::sim
