#pragma once
// The objects of a CANopen slave: typed integers and constant texts with rights, ranges and a hook.
//
// It knows neither frames nor time. One thread; it owns its entries, whose addresses are stable.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace tenon::sim {

/// index << 8 | sub-index.
using ObjectId = std::uint32_t;
[[nodiscard]] constexpr ObjectId object_id(std::uint16_t index, std::uint8_t sub_index = 0) {
  return static_cast<ObjectId>(index) << 8 | sub_index;
}

enum class DataType : std::uint8_t { kI8, kI16, kI32, kU8, kU16, kU32, kText };
enum class Access : std::uint8_t { kReadOnly, kReadWrite, kWriteOnly };
/// Which PDOs may carry the object.
enum class Mappable : std::uint8_t { kNo, kReceive, kTransmit };

/// Bytes on the wire; 0 for a text, whose length is its own.
[[nodiscard]] std::size_t size_bytes(DataType type);
[[nodiscard]] std::int64_t lowest(DataType type);
[[nodiscard]] std::int64_t highest(DataType type);

struct ObjectEntry {
  DataType type = DataType::kU8;
  Access access = Access::kReadOnly;
  Mappable mappable = Mappable::kNo;
  std::int64_t value = 0;
  std::int64_t low = std::numeric_limits<std::int64_t>::min();   ///< narrowed to the type by add()
  std::int64_t high = std::numeric_limits<std::int64_t>::max();  ///< likewise
  std::string text = {};
  /// Sees a value in range before it is stored; an SDO abort code refuses it, 0 lets it in.
  std::function<std::uint32_t(std::int64_t)> on_write = {};
  std::int64_t power_on_value = 0;  ///< set by add()
};

class ObjectDictionary {
 public:
  void add(ObjectId id, ObjectEntry entry);

  [[nodiscard]] ObjectEntry* find(ObjectId id);
  [[nodiscard]] const ObjectEntry* find(ObjectId id) const;
  /// Why find() found nothing: no such object, or no such sub-index of it.
  [[nodiscard]] std::uint32_t why_missing(ObjectId id) const;

  /// A write from the bus. @return 0, or the SDO abort code of the refusal
  [[nodiscard]] std::uint32_t write(ObjectId id, std::int64_t value);

  /// The device's own access; the object must exist.
  [[nodiscard]] std::int64_t value(ObjectId id) const;
  void set(ObjectId id, std::int64_t value);

  /// Back to the values of power-on, for indices low..high.
  void reset(std::uint16_t low_index, std::uint16_t high_index);

 private:
  std::map<ObjectId, ObjectEntry> entries_;
};

/// Little-endian bytes of an entry's value or text.
[[nodiscard]] std::vector<std::uint8_t> to_bytes(const ObjectEntry& entry);
/// A little-endian integer of the type, sign-extended where it has one.
[[nodiscard]] std::int64_t from_bytes(DataType type, const std::uint8_t* bytes);

}  // namespace tenon::sim
