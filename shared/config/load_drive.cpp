#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/canopen/constants.h"
#include "shared/canopen/drive_profile.h"
#include "shared/config/drive_file.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/config/yaml_value.h"

namespace tenon {
namespace {

using config::Map;
using config::Value;

constexpr std::size_t kExtraMax = 64;
constexpr std::size_t kWarningsMax = 64;

/// "605Ah" as everybody writes it in manuals.
std::optional<std::uint16_t> hex_word(std::string_view text) {
  if (text.empty() || (text.back() != 'h' && text.back() != 'H')) return std::nullopt;
  text.remove_suffix(1);
  std::uint16_t word = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), word, 16);
  if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
  return word;
}

Presence read_presence(const Value& value) {
  return static_cast<Presence>(value.choice({"required", "optional", "absent"}));
}

Treatment read_treatment(const Value& value) {
  return static_cast<Treatment>(value.choice({"write", "clamp", "check", "accept"}));
}

std::string known_objects() {
  std::string text;
  for (const DriveObjectRow& row : kDriveObjectRows)
    text += (text.empty() ? "" : ", ") + std::string(row.key);
  return text;
}

/// "absent", or {presence: .., how: ..}, of which what is missing is by the book.
void read_object(const Value& value, const DriveObjectRow& row, DriveProfile::Object& object) {
  if (!value.is_mapping()) {
    object.presence = read_presence(value);
    return;
  }
  const Map map(value, {"presence", "how"});
  if (const auto presence = map.find("presence")) object.presence = read_presence(*presence);
  const auto treatment = map.find("how");
  if (!treatment) return;
  object.treatment = read_treatment(*treatment);
  const bool written =
      object.treatment == Treatment::kWrite || object.treatment == Treatment::kClamp;
  if (row.object == DriveObject::kSupportedModes && written) {
    treatment->refuse_value("check or accept: nobody writes what a drive supports");
  }
}

void read_objects(const Value& value, DriveProfile& profile) {
  for (const std::string& key : value.keys()) {
    const auto row = std::find_if(kDriveObjectRows.begin(), kDriveObjectRows.end(),
                                  [&](const DriveObjectRow& each) { return each.key == key; });
    const Value entry = value.peek(key).value();
    if (row == kDriveObjectRows.end()) {
      entry.refuse("is no object that a profile tells of, known here: " + known_objects() +
                   "; the device's own stand under extra");
    }
    read_object(entry, *row, profile.objects[static_cast<std::size_t>(row->object)]);
  }
}

/// What bring-up sets by rules of its own.
bool is_ours(std::uint16_t index) {
  using namespace tenon::canopen;
  constexpr std::array kOurs = {
      kDeviceType,  kHeartbeatProducer, kStoreParameters, kControlword,  kStatusword,       kMode,
      kModeDisplay, kTargetPosition,    kPositionActual,  kTorqueActual, kInterpolationData};
  const bool pdo = index >= kRpdoCommunication && index < kTpdoMapping + 0x200;
  return pdo || std::find(kOurs.begin(), kOurs.end(), index) != kOurs.end() ||
         std::any_of(kDriveObjectRows.begin(), kDriveObjectRows.end(),
                     [&](const DriveObjectRow& row) { return row.index == index; });
}

void read_extra_object(const Value& value, DriveProfile::Extra& extra) {
  const std::string text = value.text();
  const std::size_t colon = text.find(':');
  const auto index = hex_word(std::string_view(text).substr(0, colon));
  unsigned sub = 0;
  bool good = index.has_value();
  if (colon != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, sub);
    good = good && error == std::errc{} && rest == end && sub <= 254;
  }
  if (!good) value.refuse_value("an object such as 2010h or 2010h:1");
  if (*index < 0x1000) value.refuse_value("from 1000h on");
  if (is_ours(*index)) value.refuse("is set by the master itself; see objects, pdos and modes");
  extra.index = *index;
  extra.sub = static_cast<std::uint8_t>(sub);
}

void read_extra_value(const Value& type, const Value& value, DriveProfile::Extra& extra) {
  constexpr std::array<std::pair<std::int64_t, std::int64_t>, 6> kRanges = {
      {{0, 0xFF},
       {0, 0xFFFF},
       {0, 0xFFFFFFFF},
       {-128, 127},
       {-32768, 32767},
       {-2147483648LL, 2147483647}}};
  constexpr std::array<std::uint8_t, 6> kSizes = {1, 2, 4, 1, 2, 4};
  const std::size_t which = type.choice({"u8", "u16", "u32", "i8", "i16", "i32"});
  extra.size_bytes = kSizes[which];
  const auto [low, high] = kRanges[which];
  extra.value = static_cast<std::uint32_t>(value.integer(low, high));
}

DriveProfile::Extra read_extra(const Value& entry, const std::vector<DriveProfile::Extra>& others) {
  const Map map(entry, {"object", "type", "value", "presence", "how"});
  DriveProfile::Extra extra;
  read_extra_object(map.at("object"), extra);
  read_extra_value(map.at("type"), map.at("value"), extra);
  if (const auto presence = map.find("presence")) extra.how.presence = read_presence(*presence);
  if (const auto how = map.find("how")) extra.how.treatment = read_treatment(*how);
  const bool again = std::any_of(others.begin(), others.end(), [&](const auto& other) {
    return other.index == extra.index && other.sub == extra.sub;
  });
  if (again) map.at("object").refuse_value("listed once");
  return extra;
}

DriveProfile::CodeRange read_warning(const Value& value) {
  const std::string text = value.text();
  const std::size_t dash = text.find('-');
  const auto first = hex_word(std::string_view(text).substr(0, dash));
  const auto last =
      dash == std::string::npos ? first : hex_word(std::string_view(text).substr(dash + 1));
  if (!first || !last || *first > *last) {
    value.refuse_value("an error code such as 4210h or a range such as FF00h-FFFFh");
  }
  return {*first, *last};
}

void read_pdos(const Value& value, DriveProfile& profile) {
  const Map map(value, {"mapping", "identifiers", "transmission_types"});
  const auto fixed = [&](const char* key) {
    const auto found = map.find(key);
    return found && found->choice({"free", "fixed"}) == 1;
  };
  profile.fixed_mapping = fixed("mapping");
  profile.fixed_identifiers = fixed("identifiers");
  profile.fixed_transmission_types = fixed("transmission_types");
}

}  // namespace

DriveProfile load_drive(const std::filesystem::path& file) {
  const Value document = Value::parse(file, config::read_file(file));
  config::expect_kind(file, document, config::FileKind::kDrive);
  const Map map(document, {"name", "objects", "extra", "pdos", "modes", "boot_s", "warnings"});
  DriveProfile profile;
  profile.name = map.at("name").name();
  if (const auto objects = map.find("objects")) read_objects(*objects, profile);
  if (const auto extra = map.find("extra")) {
    for (const Value& entry : extra->list(0, kExtraMax)) {
      profile.extra.push_back(read_extra(entry, profile.extra));
    }
  }
  if (const auto pdos = map.find("pdos")) read_pdos(*pdos, profile);
  if (const auto modes = map.find("modes")) {
    profile.modes.clear();
    for (const Value& mode : modes->list(1, 2)) {
      profile.modes.push_back(mode.choice({"7", "8"}) == 0 ? 7 : 8);
    }
  }
  map.optional_number("boot_s", config::positive_to(DriveProfile::kBootMax_s), profile.boot_s);
  if (const auto warnings = map.find("warnings")) {
    profile.warnings.clear();
    for (const Value& code : warnings->list(0, kWarningsMax)) {
      profile.warnings.push_back(read_warning(code));
    }
  }
  return profile;
}

}  // namespace tenon
