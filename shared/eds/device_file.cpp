#include "shared/eds/device_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string_view>
#include <utility>

#include "shared/base/text.h"
#include "shared/eds/eds_text.h"
#include "shared/eds/ini_file.h"

namespace tenon {
namespace {

constexpr std::size_t kObjectsMax = 100'000;
constexpr std::int64_t kSubMax = 254;
constexpr std::uint16_t kUnsigned8 = 0x0005;
constexpr unsigned kObjectDomain = 2;
constexpr unsigned kObjectVariable = 7;
constexpr unsigned kObjectArray = 8;
constexpr unsigned kObjectRecord = 9;

/// What decides about an object: doubles of these may not differ.
constexpr std::array<std::string_view, 10> kDeciding = {
    "objecttype", "datatype",  "accesstype", "defaultvalue",  "parametervalue",
    "lowlimit",   "highlimit", "pdomapping", "compactsubobj", "nodeid"};

class Reader {
 public:
  Reader(const std::string& name, const std::string& text) : ini_(name, text, kDeciding) {
    file_.name = name;
  }

  DeviceFile read() {
    read_device();
    read_dummies();
    read_lists();
    for (const auto& [name, section] : ini_.sections()) {
      const auto id = object_of_section(name);
      if (!id || name.find("sub") != std::string::npos) continue;
      read_index(static_cast<std::uint16_t>(*id >> 8), section);
    }
    for (const auto& [name, section] : ini_.sections()) {
      const auto id = object_of_section(name);
      if (id && name.find("sub") != std::string::npos) read_stray_sub(*id, section);
    }
    if (file_.objects.empty()) ini_.refuse(1, "describes no object; is it an EDS or DCF file?");
    file_.slips = ini_.take_slips();
    return std::move(file_);
  }

 private:
  void read_device();
  void read_dummies();
  void read_lists();
  void read_index(std::uint16_t index, const IniSection& section);
  [[nodiscard]] std::int64_t guessed_kind(std::uint16_t index, const IniSection& section) const;
  void read_subs(std::uint16_t index, const IniSection& section);
  void read_compact(std::uint16_t index, const IniSection& section, std::int64_t count);
  void read_stray_sub(DeviceObjectId id, const IniSection& section);
  void read_object(DeviceObjectId id, const IniSection& section);
  bool read_type(const IniSection& section, DeviceObject& object);
  void read_access(const IniSection& section, DeviceObject& object);
  void read_value(const IniSection& section, DeviceObject& object);
  [[nodiscard]] std::optional<std::int64_t> read_limit(const IniSection& section,
                                                       const std::string& key,
                                                       const DeviceObject& object);
  void add(DeviceObjectId id, DeviceObject object);

  /// A number of a section; unset where it is missing or empty.
  [[nodiscard]] std::optional<std::int64_t> number(const IniSection& section,
                                                   const std::string& key) const;
  /// Unset, and said: the value is none of its type.
  [[nodiscard]] std::optional<std::int64_t> fitted(const DeviceObject& object,
                                                   const IniSection& section, const IniValue& from,
                                                   const std::string& text);

  IniFile ini_;
  DeviceFile file_;
  std::set<DeviceObjectId> described_;  ///< sub-indices whose sections have been seen
};

std::optional<std::int64_t> Reader::number(const IniSection& section,
                                           const std::string& key) const {
  const IniValue* value = section.find(key);
  if (value == nullptr || value->text.empty()) return std::nullopt;
  const std::string text = without_comment(value->text);
  const auto number = parsed_number(text);
  if (!number && !text.empty()) {
    ini_.refuse(value->line, "[" + section.name + "] " + key + " = " + value->text +
                                 ", must be a number such as 8, 0x6040 or 010");
  }
  return number;
}

void Reader::read_device() {
  if (const IniSection* info = ini_.find("deviceinfo")) {
    if (const IniValue* vendor = info->find("vendorname")) file_.vendor = vendor->text;
    if (const IniValue* product = info->find("productname")) file_.product = product->text;
    if (number(*info, "compactpdo").value_or(0) != 0) {
      ini_.slip(info->find("compactpdo")->line,
                "CompactPDO describes PDOs without sections of their own; those are taken as "
                "missing, so write sections 14xx, 16xx, 18xx and 1Axx for them");
    }
  } else {
    ini_.slip(1, "has no section [DeviceInfo]");
  }
  // The standard spells it with one m; many files do not.
  for (const char* name : {"devicecomissioning", "devicecommissioning"}) {
    const IniSection* section = ini_.find(name);
    const auto node = section == nullptr ? std::nullopt : number(*section, "nodeid");
    if (!node) continue;
    if (*node == 0) {
      ini_.slip(section->line, "NodeID = 0 is no node's; taken as not set");
      continue;
    }
    if (*node < 1 || *node > 127) {
      ini_.refuse(section->line, "NodeID = " + std::to_string(*node) + ", must be in [1, 127]");
    }
    file_.node = static_cast<std::uint8_t>(*node);
  }
}

void Reader::read_dummies() {
  const IniSection* usage = ini_.find("dummyusage");
  if (usage == nullptr) return;
  file_.dummies = 0;
  for (unsigned type = 1; type <= 7; ++type) {
    const auto used = number(*usage, "dummy000" + std::to_string(type)).value_or(0) != 0;
    if (used) *file_.dummies = static_cast<std::uint8_t>(*file_.dummies | 1U << type);
  }
}

/// What the lists name must be described; an object without a list is one all the same.
void Reader::read_lists() {
  for (const char* name : {"mandatoryobjects", "optionalobjects", "manufacturerobjects"}) {
    const IniSection* list = ini_.find(name);
    if (list == nullptr) {
      ini_.slip(1, std::string("has no section [") + name + "]");
      continue;
    }
    for (const auto& [key, value] : list->values) {
      if (!digits(key, 10) || value.text.empty()) continue;
      const auto index = parsed_number(without_comment(value.text));
      if (!index || *index < 0 || *index > 0xFFFF) {
        ini_.refuse(value.line, "[" + list->name + "] " + key + " = " + value.text +
                                    ", must be an index such as 0x6040");
      }
      if (ini_.find(lower_case(format("%04X", static_cast<unsigned>(*index)))) == nullptr) {
        ini_.slip(value.line, "[" + list->name + "] lists " + value.text +
                                  ", which no section describes; taken as missing");
      }
    }
  }
}

void Reader::read_index(std::uint16_t index, const IniSection& section) {
  const auto id = static_cast<DeviceObjectId>(index) << 8;
  const std::int64_t kind = number(section, "objecttype").value_or(guessed_kind(index, section));
  const auto compact = number(section, "compactsubobj");
  if (compact.value_or(0) != 0) {
    if (*compact < 0 || *compact > kSubMax) {
      ini_.refuse(section.find("compactsubobj")->line,
                  "[" + section.name + "] CompactSubObj = " + std::to_string(*compact) +
                      ", must be in [0, 254]");
    }
    return read_compact(index, section, *compact);
  }
  if (kind == kObjectArray || kind == kObjectRecord) return read_subs(index, section);
  if (kind != kObjectVariable && kind != kObjectDomain) {
    return;  // types and the like: nothing that is read or written
  }
  if (kind == kObjectDomain && section.find("datatype") == nullptr) {
    return add(id, {.name = "", .type = 0x000F, .line = section.line});
  }
  read_object(id, section);
}

/// Of an index without ObjectType: sub-indices and no type of its own make a record.
std::int64_t Reader::guessed_kind(std::uint16_t index, const IniSection& section) const {
  const std::string prefix = sub_prefix(index);
  const auto next = ini_.sections().lower_bound(prefix);
  const bool has_subs = next != ini_.sections().end() && next->first.starts_with(prefix);
  return has_subs && section.find("datatype") == nullptr ? kObjectRecord : kObjectVariable;
}

void Reader::read_subs(std::uint16_t index, const IniSection& section) {
  const auto announced = number(section, "subnumber");
  std::int64_t found = 0;
  const std::string prefix = sub_prefix(index);
  for (auto entry = ini_.sections().lower_bound(prefix);
       entry != ini_.sections().end() && entry->first.starts_with(prefix); ++entry) {
    const auto id = object_of_section(entry->first);
    if (!id) continue;
    if (described_.insert(*id).second) {
      ++found;
      read_object(*id, entry->second);
    } else {
      ini_.slip(entry->second.line, "[" + entry->second.name + "] is described already; ignored");
    }
  }
  if (!announced) {
    ini_.slip(section.line, "[" + section.name + "] lacks SubNumber; its sections are counted");
  } else if (*announced != found) {
    ini_.slip(section.line, "[" + section.name + "] SubNumber = " + std::to_string(*announced) +
                                ", but " + std::to_string(found) +
                                " sub-indices are described; those are taken");
  }
}

/// One section for an array: sub-index 0 counts, the others are alike but for [xxxxValue].
void Reader::read_compact(std::uint16_t index, const IniSection& section, std::int64_t count) {
  const auto id = static_cast<DeviceObjectId>(index) << 8;
  DeviceObject count_object{.name = "Highest sub-index supported",
                            .type = kUnsigned8,
                            .access = DeviceObject::Access::kReadOnly,
                            .line = section.line};
  // Of a mapping sub-index 0 is what switches it off to be written.
  const bool mapping = (index >= 0x1600 && index < 0x1800) || (index >= 0x1A00 && index < 0x1C00);
  if (mapping) read_access(section, count_object);
  count_object.value = count;
  add(id, count_object);
  const IniSection* values =
      ini_.find(lower_case(format("%04X", static_cast<unsigned>(index))) + "value");
  for (std::int64_t sub = 1; sub <= count; ++sub) {
    const auto sub_id = id | static_cast<DeviceObjectId>(sub);
    described_.insert(sub_id);
    read_object(sub_id, section);
    const auto entry = file_.objects.find(sub_id);
    if (values == nullptr || entry == file_.objects.end()) continue;
    const IniValue* value = values->find(std::to_string(sub));
    if (value == nullptr) continue;
    IniSection one{values->name, values->line, {{"defaultvalue", *value}}};
    read_value(one, entry->second);
  }
}

void Reader::read_stray_sub(DeviceObjectId id, const IniSection& section) {
  if (!described_.insert(id).second) return;
  ini_.slip(section.line, "[" + section.name + "] has no section of its index; read all the same");
  read_object(id, section);
}

void Reader::read_object(DeviceObjectId id, const IniSection& section) {
  DeviceObject object;
  object.line = section.line;
  if (const IniValue* name = section.find("parametername")) object.name = name->text;
  if (!read_type(section, object)) return;
  read_access(section, object);
  object.mappable = number(section, "pdomapping").value_or(0) != 0;
  object.low = read_limit(section, "lowlimit", object);
  object.high = read_limit(section, "highlimit", object);
  if (object.low && object.high && *object.low > *object.high) {
    ini_.slip(section.line, "[" + section.name + "] LowLimit is above HighLimit; both are ignored");
    object.low.reset();
    object.high.reset();
  }
  read_value(section, object);
  add(id, std::move(object));
}

bool Reader::read_type(const IniSection& section, DeviceObject& object) {
  const auto type = number(section, "datatype");
  if (!type) {
    ini_.slip(section.line, "[" + section.name + "] lacks DataType; taken as missing");
    return false;
  }
  if (*type < 1 || *type > 0xFFFF) {
    ini_.refuse(
        section.find("datatype")->line,
        "[" + section.name + "] DataType = " + std::to_string(*type) + ", must be in [1, 65535]");
  }
  object.type = static_cast<std::uint16_t>(*type);
  return true;
}

void Reader::read_access(const IniSection& section, DeviceObject& object) {
  using Access = DeviceObject::Access;
  static constexpr std::array<std::pair<std::string_view, Access>, 6> kWords = {
      {{"ro", Access::kReadOnly},
       {"wo", Access::kWriteOnly},
       {"rw", Access::kReadWrite},
       {"rwr", Access::kReadWriteInput},
       {"rww", Access::kReadWriteOutput},
       {"const", Access::kConstant}}};
  const IniValue* value = section.find("accesstype");
  if (value == nullptr || value->text.empty()) {
    return ini_.slip(section.line, "[" + section.name + "] lacks AccessType; taken as rw");
  }
  const std::string word = lower_case(without_comment(value->text));
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const auto& each) { return each.first == word; });
  if (found == kWords.end()) {
    ini_.refuse(value->line, "[" + section.name + "] AccessType = " + value->text +
                                 ", must be one of ro, wo, rw, rwr, rww, const");
  }
  object.access = found->second;
}

/// The value that a type's bits hold: FFFFh of an INTEGER16 is -1, and -1 of an UNSIGNED16 FFFFh.
std::optional<std::int64_t> Reader::fitted(const DeviceObject& object, const IniSection& section,
                                           const IniValue& from, const std::string& text) {
  const auto ignored = [&](const std::string& why) {
    ini_.slip(from.line,
              "[" + section.name + "] value = " + from.text + " " + why + "; taken as not given");
    return std::nullopt;
  };
  const auto value = parsed_sum(text);
  if (!value) return ignored("is no number, nor $NODEID and one");
  const unsigned bits = data_type_bits(object.type);
  if (bits > 62) return value;
  const std::int64_t span = std::int64_t{1} << bits;
  const std::int64_t low = is_signed_type(object.type) ? -span / 2 : 0;
  const std::int64_t high = low + span - 1;
  if (*value >= low && *value <= high) return value;
  const bool movable = *value >= -span && *value < span;
  const std::int64_t moved = !movable ? *value : *value < low ? *value + span : *value - span;
  if (moved >= low && moved <= high) return moved;
  return ignored("does not fit the " + std::to_string(bits) + " bits of its data type");
}

std::optional<std::int64_t> Reader::read_limit(const IniSection& section, const std::string& key,
                                               const DeviceObject& object) {
  if (!is_integer_type(object.type)) return std::nullopt;
  const IniValue* value = section.find(key);
  if (value == nullptr) return std::nullopt;
  const auto ignored = [&](const std::string& why) {
    ini_.slip(value->line, "[" + section.name + "] " + key + " = " + value->text + " " + why +
                               "; there is no such limit");
    return std::nullopt;
  };
  if (lower_case(value->text).find("$nodeid") != std::string::npos) {
    return ignored("depends on the node, which limits do not");
  }
  const std::string text = without_comment(value->text);
  if (text.empty()) return std::nullopt;
  const auto limit = fitted(object, section, *value, text);
  // 65535 for "no limit" of an INTEGER16 is -1 by the letter.
  if (key == "highlimit" && limit && *limit < 0 && !text.starts_with('-')) {
    return ignored("is negative in its data type");
  }
  return limit;
}

void Reader::read_value(const IniSection& section, DeviceObject& object) {
  const IniValue* value = section.find("parametervalue");
  if (value == nullptr || value->text.empty()) value = section.find("defaultvalue");
  if (value == nullptr || value->text.empty()) return;
  object.text = value->text;
  if (!is_integer_type(object.type)) return;
  // $NODEID, $NODEID+0x180 or 0x180+$NODEID, with spaces and in any case.
  std::string text;
  for (const char c : lower_case(without_comment(value->text))) {
    if (c != ' ' && c != '\t') text += c;
  }
  if (text.empty()) return;
  constexpr std::string_view kNode = "$nodeid";
  const std::size_t at = text.find(kNode);
  const bool adds_node = at != std::string::npos;
  if (adds_node) text.replace(at, kNode.size(), "0");
  object.value = fitted(object, section, *value, text);
  object.adds_node = adds_node && object.value;
}

void Reader::add(DeviceObjectId id, DeviceObject object) {
  if (file_.objects.size() >= kObjectsMax) {
    ini_.refuse(object.line, "describes more than " + std::to_string(kObjectsMax) + " objects");
  }
  file_.objects[id] = std::move(object);
}

}  // namespace

DeviceFile parse_device_file(const std::string& name, const std::string& text) {
  return Reader(name, text).read();
}

}  // namespace tenon
