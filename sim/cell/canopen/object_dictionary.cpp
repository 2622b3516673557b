#include "sim/cell/canopen/object_dictionary.h"

#include <algorithm>
#include <cassert>

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

/// Settings are kept by 1010h; what a PDO brings is process data, and no command has a value.
bool is_setting(const ObjectEntry& entry) {
  return entry.access == Access::kReadWrite && entry.mappable != Mappable::kReceive &&
         !entry.is_command;
}

bool is_printable(char c) { return c >= 0x20 && c <= 0x7E; }

}  // namespace

std::size_t size_bytes(DataType type) {
  switch (type) {
    case DataType::kI8:
    case DataType::kU8:
      return 1;
    case DataType::kI16:
    case DataType::kU16:
      return 2;
    case DataType::kI32:
    case DataType::kU32:
      return 4;
    case DataType::kText:
      return 0;
  }
  return 0;
}

bool is_signed(DataType type) {
  return type == DataType::kI8 || type == DataType::kI16 || type == DataType::kI32;
}

std::int64_t lowest(DataType type) {
  return is_signed(type) ? -(std::int64_t{1} << (8 * size_bytes(type) - 1)) : 0;
}

std::int64_t highest(DataType type) {
  const std::size_t bits = 8 * size_bytes(type) - (is_signed(type) ? 1 : 0);
  return type == DataType::kText ? 0 : (std::int64_t{1} << bits) - 1;
}

ObjectEntry& ObjectDictionary::add(ObjectId id, ObjectEntry entry) {
  entry.low = std::max(entry.low, lowest(entry.type));
  entry.high = std::min(entry.high, highest(entry.type));
  entry.power_on_value = entry.factory_value = entry.value;
  entry.power_on_text = entry.factory_text = entry.text;
  const auto [added, fresh] = entries_.emplace(id, std::move(entry));
  assert(fresh);
  static_cast<void>(fresh);
  return added->second;
}

void ObjectDictionary::hide(ObjectId id) {
  constexpr ObjectId kBeyondTheBus = 0x80000000;
  auto handle = entries_.extract(id);
  if (handle.empty()) return;
  handle.key() = id | kBeyondTheBus;
  entries_.insert(std::move(handle));
}

void ObjectDictionary::describe(std::uint16_t index, Description description) {
  descriptions_[index] = std::move(description);
}

const ObjectDictionary::Description* ObjectDictionary::description(std::uint16_t index) const {
  const auto found = descriptions_.find(index);
  return found == descriptions_.end() ? nullptr : &found->second;
}

ObjectEntry* ObjectDictionary::find(ObjectId id) {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second;
}

const ObjectEntry* ObjectDictionary::find(ObjectId id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second;
}

std::uint32_t ObjectDictionary::why_missing(ObjectId id) const {
  const auto next = entries_.lower_bound(id & ~ObjectId{0xFF});
  const bool index_exists = next != entries_.end() && next->first >> 8 == id >> 8;
  return index_exists ? canopen::kAbortSubIndex : canopen::kAbortNoObject;
}

std::uint32_t ObjectDictionary::write(ObjectId id, std::int64_t value) {
  ObjectEntry* entry = find(id);
  if (entry == nullptr) return why_missing(id);
  if (entry->access == Access::kReadOnly) return canopen::kAbortReadOnly;
  if (value > entry->high) return canopen::kAbortValueHigh;
  if (value < entry->low) return canopen::kAbortValueLow;
  if (entry->on_write) {
    if (const std::uint32_t abort = entry->on_write(value); abort != 0) return abort;
  }
  if (!entry->is_command) entry->value = value;
  return 0;
}

std::uint32_t ObjectDictionary::write_text(ObjectId id, const std::string& text) {
  ObjectEntry* entry = find(id);
  if (entry == nullptr) return why_missing(id);
  if (entry->access == Access::kReadOnly) return canopen::kAbortReadOnly;
  if (text.size() > entry->text_bytes_max) return canopen::kAbortLengthHigh;
  if (!std::all_of(text.begin(), text.end(), is_printable)) return canopen::kAbortValue;
  entry->text = text;
  return 0;
}

std::int64_t ObjectDictionary::value(ObjectId id) const {
  const ObjectEntry* entry = find(id);
  assert(entry != nullptr);
  return entry->value;
}

void ObjectDictionary::set(ObjectId id, std::int64_t value) {
  ObjectEntry* entry = find(id);
  assert(entry != nullptr);
  sim::set(*entry, value);
}

void ObjectDictionary::reset(std::uint16_t low_index, std::uint16_t high_index) {
  const auto end = entries_.upper_bound(object_id(high_index, 0xFF));
  for (auto entry = entries_.lower_bound(object_id(low_index)); entry != end; ++entry) {
    entry->second.value = entry->second.power_on_value;
    entry->second.text = entry->second.power_on_text;
  }
}

void ObjectDictionary::store_settings() {
  for (auto& [id, entry] : entries_) {
    if (!is_setting(entry)) continue;
    entry.power_on_value = entry.value;
    entry.power_on_text = entry.text;
  }
}

void ObjectDictionary::restore_defaults() {
  for (auto& [id, entry] : entries_) {
    entry.power_on_value = entry.factory_value;
    entry.power_on_text = entry.factory_text;
  }
}

void set(ObjectEntry& entry, std::int64_t value) {
  entry.value = std::clamp(value, lowest(entry.type), highest(entry.type));
}

void set_default(ObjectEntry& entry, std::int64_t value) {
  set(entry, value);
  entry.power_on_value = entry.factory_value = entry.value;
}

std::vector<std::uint8_t> to_bytes(const ObjectEntry& entry) {
  if (entry.type == DataType::kText) return {entry.text.begin(), entry.text.end()};
  std::vector<std::uint8_t> bytes(size_bytes(entry.type));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(entry.value) >> (8 * i));
  }
  return bytes;
}

std::int64_t from_bytes(DataType type, const std::uint8_t* bytes) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < size_bytes(type); ++i) {
    value |= static_cast<std::int64_t>(bytes[i]) << (8 * i);
  }
  return value > highest(type) ? value + 2 * lowest(type) : value;
}

}  // namespace tenon::sim
