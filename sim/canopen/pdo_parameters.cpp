#include "sim/canopen/pdo_parameters.h"

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

constexpr std::uint8_t kEntriesMax = 8;
constexpr std::size_t kFrameBits = 64;
constexpr std::uint32_t kExtended = 0x20000000;
constexpr std::uint32_t kIdMask = 0x7FF;

/// Identifiers that no PDO may take (CiA 301, table of restricted COB-IDs).
bool restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
         (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

/// Objects 0002h to 0007h: bits that a receiver skips (CiA 301, 7.4.7.1).
std::size_t dummy_bits(std::uint32_t index) {
  switch (index) {
    case 0x0002:
    case 0x0005:
      return 8;
    case 0x0003:
    case 0x0006:
      return 16;
    case 0x0004:
    case 0x0007:
      return 32;
    default:
      return 0;
  }
}

}  // namespace

PdoParameters::PdoParameters(ObjectDictionary& dictionary, PdoDirection direction,
                             std::uint8_t number, const PdoDefaults& defaults)
    : dictionary_(dictionary),
      direction_(direction),
      communication_(static_cast<std::uint16_t>((direction == PdoDirection::kReceive
                                                     ? canopen::kRpdoCommunication
                                                     : canopen::kTpdoCommunication) +
                                                number)),
      mapping_(static_cast<std::uint16_t>(
          (direction == PdoDirection::kReceive ? canopen::kRpdoMapping : canopen::kTpdoMapping) +
          number)) {
  add_communication(defaults);
  add_mapping(defaults);
}

void PdoParameters::add_communication(const PdoDefaults& defaults) {
  dictionary_.add(object_id(communication_, 0), {.type = DataType::kU8, .value = 5});
  dictionary_.add(object_id(communication_, 1),
                  {.type = DataType::kU32,
                   .access = Access::kReadWrite,
                   .value = defaults.cob_id,
                   .on_write = [this](std::int64_t value) { return check_cob_id(value); }});
  dictionary_.add(object_id(communication_, 2),
                  {.type = DataType::kU8,
                   .access = Access::kReadWrite,
                   .value = defaults.transmission_type,
                   .on_write = [](std::int64_t value) {
                     return value > 240 && value < 254 ? canopen::kAbortValue : 0;
                   }});
  dictionary_.add(
      object_id(communication_, 3),
      {.type = DataType::kU16, .access = Access::kReadWrite, .on_write = [this](std::int64_t) {
         return valid() ? canopen::kAbortDeviceState : 0;
       }});
  dictionary_.add(object_id(communication_, 5),
                  {.type = DataType::kU16, .access = Access::kReadWrite});
}

void PdoParameters::add_mapping(const PdoDefaults& defaults) {
  dictionary_.add(object_id(mapping_, 0),
                  {.type = DataType::kU8,
                   .access = Access::kReadWrite,
                   .value = static_cast<std::int64_t>(defaults.mapping.size()),
                   .on_write = [this](std::int64_t count) { return check_count(count); }});
  for (std::uint8_t sub = 1; sub <= kEntriesMax; ++sub) {
    const std::uint32_t entry = sub <= defaults.mapping.size() ? defaults.mapping[sub - 1U] : 0;
    dictionary_.add(object_id(mapping_, sub),
                    {.type = DataType::kU32,
                     .access = Access::kReadWrite,
                     .value = entry,
                     .on_write = [this](std::int64_t value) { return check_entry(value); }});
  }
}

std::uint32_t PdoParameters::check_cob_id(std::int64_t value) const {
  const std::uint32_t wanted = static_cast<std::uint32_t>(value);
  const bool stays_valid = valid() && (wanted & canopen::kPdoInvalid) == 0;
  if (stays_valid && (wanted & kIdMask) != cob_id()) return canopen::kAbortDeviceState;
  if ((wanted & kExtended) != 0) return canopen::kAbortValue;
  if ((wanted & canopen::kPdoInvalid) == 0 && restricted(wanted & ~canopen::kPdoNoRtr)) {
    return canopen::kAbortValue;
  }
  return 0;
}

std::uint32_t PdoParameters::check_count(std::int64_t count) const {
  if (valid()) return canopen::kAbortDeviceState;
  if (count > kEntriesMax) return canopen::kAbortMappingTooLong;
  std::size_t bits = 0;
  for (std::int64_t sub = 1; sub <= count; ++sub) {
    const std::int64_t entry =
        dictionary_.value(object_id(mapping_, static_cast<std::uint8_t>(sub)));
    if (entry == 0) return canopen::kAbortNotMappable;
    bits += static_cast<std::size_t>(entry & 0xFF);
  }
  return bits > kFrameBits ? canopen::kAbortMappingTooLong : 0;
}

std::uint32_t PdoParameters::check_entry(std::int64_t mapping) const {
  if (mapped_count() != 0) return canopen::kAbortDeviceState;
  const ObjectId id = static_cast<ObjectId>(mapping >> 8);
  const std::size_t bits = static_cast<std::size_t>(mapping & 0xFF);
  if (direction_ == PdoDirection::kReceive && dummy_bits(id >> 8) != 0) {
    return bits == dummy_bits(id >> 8) ? 0 : canopen::kAbortLength;
  }
  const ObjectEntry* entry = dictionary_.find(id);
  if (entry == nullptr) return dictionary_.why_missing(id);
  const Mappable wanted =
      direction_ == PdoDirection::kReceive ? Mappable::kReceive : Mappable::kTransmit;
  if (entry->mappable != wanted) return canopen::kAbortNotMappable;
  return bits == 8 * size_bytes(entry->type) ? 0 : canopen::kAbortLength;
}

bool PdoParameters::valid() const {
  return (dictionary_.value(object_id(communication_, 1)) & canopen::kPdoInvalid) == 0;
}

std::uint32_t PdoParameters::cob_id() const {
  return static_cast<std::uint32_t>(dictionary_.value(object_id(communication_, 1))) & kIdMask;
}

std::uint8_t PdoParameters::transmission_type() const {
  return static_cast<std::uint8_t>(dictionary_.value(object_id(communication_, 2)));
}

std::int64_t PdoParameters::inhibit_ns() const {
  return dictionary_.value(object_id(communication_, 3)) * 100'000;
}

std::int64_t PdoParameters::event_timer_ns() const {
  return dictionary_.value(object_id(communication_, 5)) * 1'000'000;
}

std::size_t PdoParameters::mapped_count() const {
  return static_cast<std::size_t>(dictionary_.value(object_id(mapping_, 0)));
}

ObjectId PdoParameters::mapped_id(std::size_t i) const {
  const auto sub = static_cast<std::uint8_t>(i + 1);
  return static_cast<ObjectId>(dictionary_.value(object_id(mapping_, sub)) >> 8);
}

ObjectEntry* PdoParameters::mapped(std::size_t i) const { return dictionary_.find(mapped_id(i)); }

std::size_t PdoParameters::bytes(std::size_t i) const {
  const auto sub = static_cast<std::uint8_t>(i + 1);
  return static_cast<std::size_t>(dictionary_.value(object_id(mapping_, sub)) & 0xFF) / 8;
}

std::size_t PdoParameters::total_bytes() const {
  std::size_t total = 0;
  for (std::size_t i = 0; i < mapped_count(); ++i) total += bytes(i);
  return total;
}

}  // namespace tenon::sim
