#include "sim/cell/canopen/twin.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <string>
#include <vector>

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

constexpr std::array kMandatory = {
    object_id(canopen::kDeviceType),  object_id(canopen::kErrorRegister),
    object_id(canopen::kIdentity, 0), object_id(canopen::kIdentity, 1),
    object_id(canopen::kControlword), object_id(canopen::kStatusword),
};

constexpr std::uint16_t kReal32 = 0x0008;  // of CiA 301, as its bits

bool is_makers_own(ObjectId id) { return id >> 8 >= 0x2000 && id >> 8 <= 0x5FFF; }

bool is_cob_id_of_pdo(ObjectId id) {
  const ObjectId index = id >> 8;
  const bool communication =
      (index >= canopen::kRpdoCommunication && index < canopen::kRpdoMapping) ||
      (index >= canopen::kTpdoCommunication && index < canopen::kTpdoMapping);
  return communication && (id & 0xFF) == 1;
}

DataType type_of(std::uint16_t type) {
  switch (type) {
    case 0x0002:
      return DataType::kI8;
    case 0x0003:
      return DataType::kI16;
    case 0x0004:
    case 0x0010:  // INTEGER24
      return DataType::kI32;
    case 0x0001:  // BOOLEAN
    case 0x0005:
      return DataType::kU8;
    case 0x0006:
      return DataType::kU16;
    case 0x0007:
    case kReal32:
    case 0x0016:  // UNSIGNED24
      return DataType::kU32;
    default:
      return DataType::kText;
  }
}

Access access_of(DeviceObject::Access access) {
  switch (access) {
    case DeviceObject::Access::kReadOnly:
    case DeviceObject::Access::kConstant:
      return Access::kReadOnly;
    case DeviceObject::Access::kWriteOnly:
      return Access::kWriteOnly;
    case DeviceObject::Access::kReadWrite:
    case DeviceObject::Access::kReadWriteInput:
    case DeviceObject::Access::kReadWriteOutput:
      return Access::kReadWrite;
  }
  return Access::kReadOnly;
}

Mappable mappable_of(const DeviceObject& object) {
  if (object.goes_into_rpdo()) return Mappable::kReceive;
  return object.goes_into_tpdo() ? Mappable::kTransmit : Mappable::kNo;
}

/// As the drive has it, where its file allows that direction.
Mappable mappable_as(Mappable own, const DeviceObject& object) {
  if (own == Mappable::kReceive && !object.goes_into_rpdo()) return Mappable::kNo;
  if (own == Mappable::kTransmit && !object.goes_into_tpdo()) return Mappable::kNo;
  return own == Mappable::kNo ? mappable_of(object) : own;
}

void adapt(ObjectEntry& entry, const DeviceObject& object, std::uint8_t node) {
  const DataType type = type_of(object.type);
  const bool measured = entry.access == Access::kReadOnly && entry.mappable == Mappable::kTransmit;
  entry.access = access_of(object.access);
  entry.mappable = mappable_as(entry.mappable, object);
  if (type == DataType::kText || entry.type == DataType::kText) {
    if (entry.type == DataType::kText)
      entry.text = entry.factory_text = entry.power_on_text = object.text;
    return;
  }
  entry.type = type;
  entry.low = std::max(lowest(type), object.low.value_or(lowest(type)));
  entry.high = std::min(highest(type), object.high.value_or(highest(type)));
  entry.contains_node = object.adds_node;
  if (!object.value || measured) return;
  set_default(entry, *object.value + (object.adds_node ? node : 0));
}

/// The bits of what an EDS writes for a type that is no integer of 32 bits or less, the lowest byte
/// first.
std::string wide_value(const DeviceObject& object, std::uint8_t node) {
  constexpr std::uint16_t kReal64 = 0x0011;
  std::uint64_t bits = 0;
  if (object.type == kReal64) {
    bits = std::bit_cast<std::uint64_t>(std::strtod(object.text.c_str(), nullptr));
  } else {
    bits = static_cast<std::uint64_t>(object.value.value_or(0) + (object.adds_node ? node : 0));
  }
  std::string bytes(data_type_bits(object.type) / 8, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(bits >> 8 * i & 0xFF);
  return bytes;
}

ObjectEntry stored(const DeviceObject& object, std::uint8_t node) {
  ObjectEntry entry;
  entry.name = object.name;
  entry.type = type_of(object.type);
  entry.access = access_of(object.access);
  entry.mappable = mappable_of(object);
  if (entry.type == DataType::kText) {
    constexpr std::size_t kTextMax = 64;
    const unsigned bits = data_type_bits(object.type);
    entry.text = bits != 0 ? wide_value(object, node) : object.text;
    entry.text_bytes_max = std::max(kTextMax, entry.text.size());
    return entry;
  }
  entry.low = object.low.value_or(entry.low);
  entry.high = object.high.value_or(entry.high);
  entry.value = object.value.value_or(0) + (object.adds_node ? node : 0);
  if (object.type == kReal32) {
    entry.value = std::bit_cast<std::uint32_t>(std::strtof(object.text.c_str(), nullptr));
  }
  return entry;
}

/// A default mapping of what the device cannot carry ends before it: files say what they like.
void cut_mapping(ObjectDictionary& dictionary, std::uint16_t index, bool transmit) {
  ObjectEntry* count = dictionary.find(object_id(index));
  if (count == nullptr) return;
  constexpr std::int64_t kEntriesMax = 8;
  constexpr std::int64_t kBitsMax = 64;
  std::int64_t bits = 0;
  std::int64_t good = 0;
  for (; good < std::min(count->value, kEntriesMax); ++good) {
    const ObjectEntry* entry =
        dictionary.find(object_id(index, static_cast<std::uint8_t>(good + 1)));
    if (entry == nullptr) break;
    const ObjectEntry* mapped = dictionary.find(static_cast<ObjectId>(entry->value >> 8));
    const std::int64_t width = entry->value & 0xFF;
    const bool dummy = !transmit && mapped == nullptr && width % 8 == 0;
    const bool fits =
        mapped != nullptr && width == 8 * static_cast<std::int64_t>(size_bytes(mapped->type));
    bits += width;
    if ((!dummy && !fits) || width == 0 || bits > kBitsMax) break;
  }
  set_default(*count, good);
}

}  // namespace

void make_twin(ObjectDictionary& dictionary, const DeviceFile& file, std::uint8_t node) {
  if (file.dummies) dictionary.allow_dummies(*file.dummies);
  std::vector<ObjectId> ids;
  for (const auto& [id, entry] : dictionary.entries()) ids.push_back(id);
  for (const ObjectId id : ids) {
    const auto found = file.objects.find(id);
    const bool mandatory = std::find(kMandatory.begin(), kMandatory.end(), id) != kMandatory.end();
    ObjectEntry& entry = *dictionary.find(id);
    if (found != file.objects.end() && !is_makers_own(id)) {
      adapt(entry, found->second, node);
    } else if (!mandatory) {
      if (is_cob_id_of_pdo(id)) set_default(entry, entry.value | canopen::kPdoInvalid);
      dictionary.hide(id);
    }
  }
  for (const auto& [id, object] : file.objects) {
    if (dictionary.find(id) == nullptr) dictionary.add(id, stored(object, node));
  }
  for (std::uint16_t number = 0; number < 4; ++number) {
    cut_mapping(dictionary, static_cast<std::uint16_t>(canopen::kRpdoMapping + number), false);
    cut_mapping(dictionary, static_cast<std::uint16_t>(canopen::kTpdoMapping + number), true);
  }
}

}  // namespace tenon::sim
