#include "hw/check/device_check.h"

#include <optional>
#include <set>
#include <string>
#include <utility>

#include "hw/arm/describe_fault.h"
#include "hw/arm/describe_sensor.h"
#include "hw/arm/drive_settings.h"
#include "hw/arm/node_settings.h"
#include "hw/arm/setting_runner.h"
#include "hw/bus_load/bus_load.h"
#include "hw/check/mapping_check.h"
#include "hw/check/motor_check.h"
#include "hw/check/object_names.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/canopen/robot_drives.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using Action = ObjectSetting::Action;
using Verdict = CheckLine::Verdict;

std::string shown(std::uint32_t value) { return format("0x%X", value); }

const char* access_text(DeviceObject::Access access) {
  switch (access) {
    case DeviceObject::Access::kReadOnly:
      return "ro";
    case DeviceObject::Access::kWriteOnly:
      return "wo";
    case DeviceObject::Access::kReadWrite:
      return "rw";
    case DeviceObject::Access::kReadWriteInput:
      return "rwr";
    case DeviceObject::Access::kReadWriteOutput:
      return "rww";
    case DeviceObject::Access::kConstant:
      return "const";
  }
  return "";
}

bool is_written(Action action) {
  return action == Action::kWrite || action == Action::kWriteOrTake ||
         action == Action::kWriteIfOther || action == Action::kTry;
}

bool is_mapping_entry(const ObjectSetting& setting) {
  const bool mapping = tenon::canopen::is_rpdo_mapping(setting.index) ||
                       tenon::canopen::is_tpdo_mapping(setting.index);
  return mapping && setting.sub != 0;
}

/// A device as its file describes it, while bring-up goes through it.
class Model {
 public:
  Model(const DeviceFile& file, std::uint8_t node) : file_(file), node_(node) {}

  CheckLine run(const ObjectSetting& setting) {
    CheckLine line{setting, "", Verdict::kGood};
    if (setting.action == Action::kWriteIfOther && same_) {
      line.device =
          absent_ ? "without the object nothing is to be done" : "is so already, left alone";
      comparing_ = false;
      return line;
    }
    if (setting.action == Action::kTry && gave_up_) {
      line.device = "not asked any more";
      line.verdict = Verdict::kOther;
      comparing_ = false;
      return line;
    }
    const DeviceObject* object = file_.find(setting.index, setting.sub);
    if (object == nullptr) {
      missing(line);
    } else if (setting.action == Action::kCompare) {
      compare(line, *object);
    } else if (is_written(setting.action)) {
      write(line, *object);
    } else {
      read(line, *object);
    }
    comparing_ = setting.action == Action::kCompare;
    return line;
  }

 private:
  void missing(CheckLine& line) {
    const bool index = file_.has_index(line.setting.index);
    line.device = index ? "has no such sub-index" : "has no such object";
    if (line.setting.action == Action::kCompare) {
      remember(line.setting.optional);
      absent_ = true;
    } else if (line.setting.action == Action::kTry) {
      give_up(line);
    } else if (line.setting.optional) {
      line.device += ", which its profile allows";
    } else {
      line.verdict = Verdict::kRefused;
      line.device += index ? " (abort 0x06090011)" : " (abort 0x06020000)";
    }
  }

  /// As bring-up does: it spares the node all others of these.
  void give_up(CheckLine& line) {
    gave_up_ = true;
    line.verdict = Verdict::kOther;
    line.device += ", brought up without";
  }

  void compare(CheckLine& line, const DeviceObject& object) {
    const auto held = value(line.setting, object);
    line.device = describe(object) + (held ? ", holds " + shown(*held) : "");
    remember(held && line.setting.matches(*held));
    absent_ = false;
  }

  void write(CheckLine& line, const DeviceObject& object) {
    line.device = describe(object);
    std::string refusal = why_refused(line.setting, object);
    if (refusal.empty() && is_mapping_entry(line.setting)) {
      const MappingAnswer answer = answer_to_mapping(file_, line.setting.index, line.setting.value);
      if (answer.kind == MappingAnswer::Kind::kRefused) refusal = answer.why;
      if (answer.kind == MappingAnswer::Kind::kUnknown) {
        line.verdict = Verdict::kUnknown;
        line.device += ": " + answer.why;
      }
    }
    if (refusal.empty()) {
      values_[line.setting.object()] = line.setting.value;
      return;
    }
    line.device += ": " + refusal;
    line.verdict = Verdict::kRefused;
    if (line.setting.action == Action::kTry) {
      give_up(line);
      return;
    }
    if (line.setting.action != Action::kWriteOrTake) return;
    const auto held = value(line.setting, object);
    line.verdict = !held                           ? Verdict::kUnknown
                   : line.setting.means_off(*held) ? Verdict::kRefused
                                                   : Verdict::kOther;
    if (held) line.device += "; keeps " + shown(*held);
  }

  void read(CheckLine& line, const DeviceObject& object) {
    line.device = describe(object);
    if (object.access == DeviceObject::Access::kWriteOnly) {
      line.device += ": cannot be read (abort 0x06010001)";
      line.verdict = Verdict::kRefused;
      return;
    }
    // A display follows the device; a default says nothing of it.
    if (line.setting.action == Action::kAwait || line.setting.action == Action::kRecord) return;
    const auto held = value(line.setting, object);
    if (!held) {
      line.verdict = Verdict::kUnknown;
      line.device += ", value not said";
      return;
    }
    line.device += ", holds " + shown(*held);
    if (line.setting.action == Action::kTake || line.setting.matches(*held)) return;
    line.verdict = Verdict::kRefused;
  }

  [[nodiscard]] static std::string why_refused(const ObjectSetting& setting,
                                               const DeviceObject& object) {
    using Access = DeviceObject::Access;
    if (object.access == Access::kReadOnly || object.access == Access::kConstant) {
      return "cannot be written (abort 0x06010002)";
    }
    if (object.access == Access::kWriteOnly) return "cannot be read back (abort 0x06010001)";
    const unsigned bits = data_type_bits(object.type);
    if (bits != 8u * setting.size_bytes) {
      return format("has %u bits where %u are written (abort 0x06070010)", bits,
                    8u * setting.size_bytes);
    }
    const std::int64_t wanted = as_type(setting, object);
    if (object.high && wanted > *object.high) {
      return format("at most %lld (abort 0x06090031)", static_cast<long long>(*object.high));
    }
    if (object.low && wanted < *object.low) {
      return format("at least %lld (abort 0x06090032)", static_cast<long long>(*object.low));
    }
    return "";
  }

  [[nodiscard]] static std::int64_t as_type(const ObjectSetting& setting,
                                            const DeviceObject& object) {
    const auto held = static_cast<std::int64_t>(setting.value & setting.size_mask());
    const std::int64_t span = std::int64_t{setting.size_mask()} + 1;
    return is_signed_type(object.type) && held >= span / 2 ? held - span : held;
  }

  [[nodiscard]] std::optional<std::uint32_t> value(const ObjectSetting& setting,
                                                   const DeviceObject& object) const {
    const auto written = values_.find(setting.object());
    if (written != values_.end()) return written->second;
    if (!object.value) return std::nullopt;
    const std::int64_t held = *object.value + (object.adds_node ? node_ : 0);
    return static_cast<std::uint32_t>(held) & setting.size_mask();
  }

  [[nodiscard]] static std::string describe(const DeviceObject& object) {
    return format("%s, %u bits", access_text(object.access), data_type_bits(object.type));
  }

  void remember(bool same) { same_ = same && (same_ || !comparing_); }

  const DeviceFile& file_;
  std::uint8_t node_;
  std::map<std::uint32_t, std::uint32_t> values_;  ///< that have been written
  bool same_ = false;
  bool comparing_ = false;
  bool absent_ = false;  ///< what was compared last
  bool gave_up_ = false;
};

/// Only some of its bits have to be so: "0x192 in bits 0xFFFF".
std::string wanted_text(const ObjectSetting& setting, const std::string& value) {
  const std::uint32_t mask = setting.compare_mask & setting.size_mask();
  return mask == setting.size_mask() ? value : value + " in bits " + shown(mask);
}

std::string action_text(const ObjectSetting& setting) {
  const std::string value = shown(setting.value & setting.size_mask());
  switch (setting.action) {
    case Action::kWrite:
      return "write " + value;
    case Action::kWriteOrTake:
      return "write " + value + " or take";
    case Action::kExpect:
      return "expect " + wanted_text(setting, value);
    case Action::kTake:
      return "take";
    case Action::kAwait:
      return "await " + value;
    case Action::kRecord:
      return "record";
    case Action::kCompare:
      return "compare " + wanted_text(setting, value);
    case Action::kWriteIfOther:
      return "write " + value + " if other";
    case Action::kTry:
      return "try " + value;
  }
  return "";
}

const char* verdict_text(const CheckLine& line) {
  switch (line.verdict) {
    case Verdict::kGood:
      return "good";
    case Verdict::kOther:
      return line.setting.action == Action::kTry ? "left out" : "taken";
    case Verdict::kUnknown:
      return "unknown";
    case Verdict::kRefused:
      return "REFUSED";
  }
  return "";
}

std::string line_text(const CheckLine& line) {
  std::string text =
      format("  %04Xh:%u  %-24s %-30s %-9s %s", static_cast<unsigned>(line.setting.index),
             static_cast<unsigned>(line.setting.sub), object_name(line.setting.index).c_str(),
             action_text(line.setting).c_str(), verdict_text(line), line.device.c_str());
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

struct JointVerdict {
  int refused = 0;
  int unknown = 0;            ///< with a file, which does not say
  bool stops_at_once = true;  ///< by the one frame for all drives
};

/// The joints' lines. Of joints with the same drive and file the first has all, the others what is
/// otherwise or refused: an arm's six drives say the same forty things.
class JointLines {
 public:
  explicit JointLines(const Robot& robot) : robot_(robot) {}

  JointVerdict append(std::size_t joint, const DeviceFile* file, std::string& text) {
    const Joint& it = robot_.joints[joint];
    const DriveProfile& drive = canopen_drive(it).profile;
    const std::string source = file == nullptr ? "no description file" : file->name;
    const auto [like, first] = told_.try_emplace({drive.name, source});
    Told& told = like->second;
    if (first) told.node = it.node;
    text += format("node %u (%s), drive %s, %s", static_cast<unsigned>(it.node), it.name.c_str(),
                   drive.name.c_str(), source.c_str());
    text += first ? "\n" : format(": as node %u, but for\n", static_cast<unsigned>(told.node));
    JointVerdict verdict{0, 0, takes_stop(drive)};
    for (const CheckLine& line : check_joint(robot_, joint, file)) {
      const bool is_refused = line.verdict == Verdict::kRefused;
      verdict.refused += is_refused ? 1 : 0;
      verdict.unknown += file != nullptr && line.verdict == Verdict::kUnknown ? 1 : 0;
      const bool gives_up = line.setting.action == Action::kTry && line.verdict == Verdict::kOther;
      if (gives_up) verdict.stops_at_once = false;
      const std::string shown = line_text(line);
      if (first) told.lines.insert(shown);
      if (first || is_refused || !told.lines.contains(shown)) text += shown;
    }
    return verdict;
  }

 private:
  struct Told {
    std::uint8_t node = 0;
    std::set<std::string> lines;
  };
  const Robot& robot_;
  std::map<std::pair<std::string, std::string>, Told> told_;  ///< by drive and file
};

}  // namespace

std::vector<CheckLine> check_joint(const Robot& robot, std::size_t joint, const DeviceFile* file) {
  std::vector<ObjectSetting> settings = joint_settings(robot, joint);
  settings.insert(settings.begin(), heartbeat_setting(robot));
  std::vector<CheckLine> lines;
  if (file == nullptr) {
    for (const ObjectSetting& setting : settings) lines.push_back({setting, "", Verdict::kUnknown});
    return lines;
  }
  Model model(*file, robot.joints[joint].node);
  for (const ObjectSetting& setting : settings) lines.push_back(model.run(setting));
  return lines;
}

CheckReport check_report(const Robot& robot, const std::map<std::uint8_t, DeviceFile>& files) {
  if (speaks_mit(robot)) {
    if (files.empty()) return motor_report(robot);
    throw InputError("robot '" + robot.name + "': --eds: its motors are no CANopen nodes");
  }
  check_robot(robot);
  CheckReport report;
  report.text = format("  %-7s  %-24s %-30s %-9s %s\n", "object", "what it is",
                       "what bring-up does", "verdict", "what the file says");
  JointLines lines(robot);
  int refused = 0;
  int unsaid = 0;
  std::size_t unknown = 0;
  std::string remarks;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const auto file = files.find(robot.joints[i].node);
    unknown += file == files.end() ? 1 : 0;
    const DeviceFile* described = file == files.end() ? nullptr : &file->second;
    const JointVerdict joint = lines.append(i, described, report.text);
    refused += joint.refused;
    unsaid += joint.unknown;
    const SettingNote no_stop{SettingNote::Kind::kNoStop, robot.joints[i].node};
    if (!joint.stops_at_once) remarks += describe(no_stop, robot) + "\n";
  }
  report.text += describe_start(robot.sensor);
  report.text += describe_loads(robot);
  for (const std::string& remark : drive_remarks(robot)) report.text += remark + "\n";
  report.text += remarks;
  try {
    check_bus_load(robot);
  } catch (const InputError& error) {
    report.good = false;
    report.text += std::string(error.what()) + "\n";
  }
  report.good = report.good && refused == 0;
  report.text += "verdict: ";
  if (refused > 0) {
    report.text +=
        format("refused, %d object%s; see the lines above, and the profiles in hw/drives", refused,
               plural(refused));
  } else if (!report.good) {
    report.text += "refused, the frames do not fit the bus";
  } else if (unknown > 0) {
    report.text += format("nothing refused; %zu joint%s without a description file (--eds)",
                          unknown, plural(unknown));
  } else if (unsaid > 0) {
    report.text +=
        format("nothing refused; of %d object%s the file does not say what bring-up needs", unsaid,
               plural(unsaid));
  } else {
    report.text += "would come up";
  }
  report.text += "\n";
  return report;
}

}  // namespace tenon::hw
