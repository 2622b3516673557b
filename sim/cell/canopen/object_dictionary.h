#pragma once
// The objects of a CANopen slave: typed integers and texts with name, rights, range, default and
// hooks. It is the one table of a device: SDO, PDO and the EDS file all come from it.
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

/// What an index holds: one value, or sub-indices alike or unlike, counted by sub-index 0.
enum class Structure : std::uint8_t { kVariable, kArray, kRecord };

/// Bytes on the wire; 0 for a text, whose length is its own.
[[nodiscard]] std::size_t size_bytes(DataType type);
[[nodiscard]] bool is_signed(DataType type);
[[nodiscard]] std::int64_t lowest(DataType type);
[[nodiscard]] std::int64_t highest(DataType type);

struct ObjectEntry {
  std::string name = {};
  DataType type = DataType::kU8;
  Access access = Access::kReadOnly;
  Mappable mappable = Mappable::kNo;
  std::int64_t value = 0;
  std::int64_t low = std::numeric_limits<std::int64_t>::min();   ///< narrowed to the type by add()
  std::int64_t high = std::numeric_limits<std::int64_t>::max();  ///< likewise
  std::string text = {};
  std::size_t text_bytes_max = 0;  ///< of a text that may be written
  bool contains_node = false;      ///< the default is a COB-ID that ends in the node's number
  bool is_command = false;         ///< a write acts, and leaves the value as it is
  /// Asked before the value is read from the bus; an SDO abort code refuses it.
  std::function<std::uint32_t()> on_read = {};
  /// Sees a value in range before it is stored; an SDO abort code refuses it, 0 lets it in.
  std::function<std::uint32_t(std::int64_t)> on_write = {};
  // What reset() brings back, and what restore_defaults() brings back for it; set by add().
  std::int64_t power_on_value = 0;
  std::int64_t factory_value = 0;
  std::string power_on_text = {};
  std::string factory_text = {};
};

class ObjectDictionary {
 public:
  struct Description {
    std::string name;
    Structure structure = Structure::kVariable;
  };

  /// @return the entry, for the device's own access without a search
  ObjectEntry& add(ObjectId id, ObjectEntry entry);
  /// Takes an entry off the bus: nobody finds it any more, and those who hold it keep it.
  void hide(ObjectId id);
  /// Names an index that has sub-indices. What is not described is a variable.
  void describe(std::uint16_t index, Description description);

  [[nodiscard]] ObjectEntry* find(ObjectId id);
  [[nodiscard]] const ObjectEntry* find(ObjectId id) const;
  /// Why find() found nothing: no such object, or no such sub-index of it.
  [[nodiscard]] std::uint32_t why_missing(ObjectId id) const;
  /// The data types (bit i: 0001h to 0007h) of which an RPDO may have gaps; all, unless told.
  void allow_dummies(std::uint8_t types) { dummies_ = types; }
  [[nodiscard]] bool allows_dummy(std::uint32_t type) const { return (dummies_ >> type & 1U) != 0; }

  /// In the order of their identifiers.
  [[nodiscard]] const std::map<ObjectId, ObjectEntry>& entries() const { return entries_; }
  [[nodiscard]] const Description* description(std::uint16_t index) const;

  /// A write from the bus. @return 0, or the SDO abort code of the refusal
  [[nodiscard]] std::uint32_t write(ObjectId id, std::int64_t value);
  [[nodiscard]] std::uint32_t write_text(ObjectId id, const std::string& text);

  /// The device's own access; the object must exist.
  [[nodiscard]] std::int64_t value(ObjectId id) const;
  void set(ObjectId id, std::int64_t value);

  /// Back to the values of power-on, for indices low..high.
  void reset(std::uint16_t low_index, std::uint16_t high_index);
  /// Settings (what may be read and written, process data excepted) as they are now survive a
  /// reset (1010h).
  void store_settings();
  /// From the next reset on, the defaults (1011h).
  void restore_defaults();

 private:
  std::map<ObjectId, ObjectEntry> entries_;
  std::map<std::uint16_t, Description> descriptions_;
  std::uint8_t dummies_ = 0xFF;
};

/// Within the bounds of its type.
void set(ObjectEntry& entry, std::int64_t value);
/// Before power-on: the default, and the value until then.
void set_default(ObjectEntry& entry, std::int64_t value);

/// Little-endian bytes of an entry's value or text.
[[nodiscard]] std::vector<std::uint8_t> to_bytes(const ObjectEntry& entry);
/// A little-endian integer of the type, sign-extended where it has one.
[[nodiscard]] std::int64_t from_bytes(DataType type, const std::uint8_t* bytes);

}  // namespace tenon::sim
