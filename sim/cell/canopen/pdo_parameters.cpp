#include "sim/cell/canopen/pdo_parameters.h"

#include <string>
#include <utility>

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

constexpr std::size_t kFrameBits = 64;
constexpr std::uint32_t kExtended = 0x20000000;

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

bool is_restricted_cob_id(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
         (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

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
  using enum DataType;
  constexpr Access kReadWrite = Access::kReadWrite;
  const bool sent = direction_ == PdoDirection::kTransmit;
  const auto add = [this](std::uint8_t sub, ObjectEntry entry) {
    return &dictionary_.add(object_id(communication_, sub), std::move(entry));
  };
  dictionary_.describe(
      communication_,
      {sent ? "TPDO communication parameter" : "RPDO communication parameter", Structure::kRecord});
  add(0, {.name = "Highest sub-index supported", .value = sent ? 6 : 5});
  cob_id_ = add(1, {.name = sent ? "COB-ID used by TPDO" : "COB-ID used by RPDO",
                    .type = kU32,
                    .access = kReadWrite,
                    .value = defaults.cob_id,
                    .contains_node = true,
                    .on_write = [this](std::int64_t value) { return check_cob_id(value); }});
  transmission_type_ = add(2, {.name = "Transmission type",
                               .type = kU8,
                               .access = kReadWrite,
                               .value = defaults.transmission_type,
                               .on_write = [](std::int64_t value) {
                                 return value > 240 && value < 254 ? canopen::kAbortValue : 0;
                               }});
  inhibit_ = add(3, {.name = "Inhibit time",
                     .type = kU16,
                     .access = kReadWrite,
                     .on_write = [this](std::int64_t) { return check_invalid(); }});
  event_timer_ = add(5, {.name = "Event timer", .type = kU16, .access = kReadWrite});
  if (!sent) return;
  sync_start_ = add(6, {.name = "SYNC start value",
                        .type = kU8,
                        .access = kReadWrite,
                        .high = 240,
                        .on_write = [this](std::int64_t) { return check_invalid(); }});
}

void PdoParameters::add_mapping(const PdoDefaults& defaults) {
  dictionary_.describe(mapping_, {direction_ == PdoDirection::kTransmit ? "TPDO mapping parameter"
                                                                        : "RPDO mapping parameter",
                                  Structure::kRecord});
  count_ =
      &dictionary_.add(object_id(mapping_, 0),
                       {.name = "Number of mapped application objects",
                        .type = DataType::kU8,
                        .access = Access::kReadWrite,
                        .value = static_cast<std::int64_t>(defaults.mapping.size()),
                        .on_write = [this](std::int64_t count) { return check_count(count); }});
  for (std::uint8_t sub = 1; sub <= kEntriesMax; ++sub) {
    const std::uint32_t entry = sub <= defaults.mapping.size() ? defaults.mapping[sub - 1U] : 0;
    entries_[sub - 1U] =
        &dictionary_.add(object_id(mapping_, sub),
                         {.name = "Application object " + std::to_string(sub),
                          .type = DataType::kU32,
                          .access = Access::kReadWrite,
                          .value = entry,
                          .on_write = [this](std::int64_t value) { return check_entry(value); }});
  }
}

std::uint32_t PdoParameters::check_cob_id(std::int64_t value) const {
  const std::uint32_t wanted = static_cast<std::uint32_t>(value);
  const bool stays_valid = valid() && (wanted & canopen::kPdoInvalid) == 0;
  if (stays_valid && (wanted & canopen::kIdMask) != cob_id()) return canopen::kAbortDeviceState;
  if ((wanted & kExtended) != 0) return canopen::kAbortValue;
  if ((wanted & canopen::kPdoInvalid) == 0 && is_restricted_cob_id(wanted & ~canopen::kPdoNoRtr)) {
    return canopen::kAbortValue;
  }
  return 0;
}

std::uint32_t PdoParameters::check_invalid() const {
  return valid() ? canopen::kAbortDeviceState : 0;
}

std::uint32_t PdoParameters::check_count(std::int64_t count) const {
  if (valid()) return canopen::kAbortDeviceState;
  if (count > static_cast<std::int64_t>(kEntriesMax)) return canopen::kAbortMappingTooLong;
  std::size_t bits = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (entries_[i]->value == 0) return canopen::kAbortNotMappable;
    bits += static_cast<std::size_t>(entries_[i]->value & 0xFF);
  }
  return bits > kFrameBits ? canopen::kAbortMappingTooLong : 0;
}

std::uint32_t PdoParameters::check_entry(std::int64_t mapping) const {
  if (mapped_count() != 0) return canopen::kAbortDeviceState;
  const ObjectId id = static_cast<ObjectId>(mapping >> 8);
  const std::size_t bits = static_cast<std::size_t>(mapping & 0xFF);
  if (direction_ == PdoDirection::kReceive && dummy_bits(id >> 8) != 0) {
    if (!dictionary_.allows_dummy(id >> 8)) return canopen::kAbortNotMappable;
    return bits == dummy_bits(id >> 8) ? 0 : canopen::kAbortLength;
  }
  const ObjectEntry* entry = dictionary_.find(id);
  if (entry == nullptr) return dictionary_.why_missing(id);
  const Mappable wanted =
      direction_ == PdoDirection::kReceive ? Mappable::kReceive : Mappable::kTransmit;
  if (entry->mappable != wanted) return canopen::kAbortNotMappable;
  return bits == 8 * size_bytes(entry->type) ? 0 : canopen::kAbortLength;
}

bool PdoParameters::valid() const { return (cob_id_->value & canopen::kPdoInvalid) == 0; }

bool PdoParameters::remote_allowed() const { return (cob_id_->value & canopen::kPdoNoRtr) == 0; }

std::uint32_t PdoParameters::cob_id() const {
  return static_cast<std::uint32_t>(cob_id_->value) & canopen::kIdMask;
}

std::uint8_t PdoParameters::transmission_type() const {
  return static_cast<std::uint8_t>(transmission_type_->value);
}

std::int64_t PdoParameters::inhibit_ns() const { return inhibit_->value * 100'000; }

std::int64_t PdoParameters::event_timer_ns() const { return event_timer_->value * 1'000'000; }

std::uint8_t PdoParameters::sync_start() const {
  return sync_start_ == nullptr ? 0 : static_cast<std::uint8_t>(sync_start_->value);
}

std::size_t PdoParameters::mapped_count() const { return static_cast<std::size_t>(count_->value); }

ObjectId PdoParameters::mapped_id(std::size_t i) const {
  return static_cast<ObjectId>(entries_[i]->value >> 8);
}

ObjectEntry* PdoParameters::mapped(std::size_t i) const { return dictionary_.find(mapped_id(i)); }

std::size_t PdoParameters::bytes(std::size_t i) const {
  return static_cast<std::size_t>(entries_[i]->value & 0xFF) / 8;
}

std::size_t PdoParameters::total_bytes() const {
  std::size_t total = 0;
  for (std::size_t i = 0; i < mapped_count(); ++i) total += bytes(i);
  return total;
}

}  // namespace tenon::sim
