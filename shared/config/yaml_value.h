#pragma once
// Strict reading of YAML: every value knows its file, line and key path, and refuses what it is not
// asked for. Offline. Everything throws InputError with one line, as in
//   planner/tasks/x.yaml:14: starts[0].sigma_m[1] = -0.03, must be in (0, 1]

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/math/pose.h"

namespace tenon::config {

/// What a plan file can hold of a name, bytes.
inline constexpr std::size_t kNameMax = 63;

/// An interval; the upper end belongs to it, the lower one unless `open_low`.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
  bool open_low = false;

  [[nodiscard]] bool holds(double value) const {
    return (open_low ? value > low : value >= low) && value <= high;
  }
};
/// (0, high]
[[nodiscard]] constexpr Bounds positive_to(double high) { return {0.0, high, true}; }
/// [-magnitude, magnitude]
[[nodiscard]] constexpr Bounds within(double magnitude) { return {-magnitude, magnitude, false}; }
/// "(0, 1]"
[[nodiscard]] std::string to_string(const Bounds& bounds);

/// One value of a file. Cheap to copy; keeps the parsed file alive.
class Value {
 public:
  /// The only document of `text`. @param file for messages
  [[nodiscard]] static Value parse(const std::filesystem::path& file, const std::string& text);

  /// A finite number; quoted text, NaN and infinities are refused.
  [[nodiscard]] double number(const Bounds& bounds) const;
  /// A zero is written here.
  [[nodiscard]] bool is_zero() const;
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;
  /// 1 to 63 bytes of printable ASCII, which is what a plan file can hold.
  [[nodiscard]] std::string name() const;
  /// Any non-empty text.
  [[nodiscard]] std::string text() const;
  /// One of the words; gives its index.
  [[nodiscard]] std::size_t choice(const std::vector<std::string_view>& words) const;
  [[nodiscard]] std::vector<Value> list(std::size_t at_least, std::size_t at_most) const;
  [[nodiscard]] Vector3 vector(const Bounds& bounds) const;
  /// {position_m: [x, y, z], rotation_rad: [rx, ry, rz]}, the rotation vector optional.
  [[nodiscard]] Pose pose() const;

  /// This value with another laid over it. Mappings are merged key by key; over a list, a mapping
  /// changes the entries whose `name` is one of its keys; anything else takes this value's place.
  /// Everything keeps the line where it stands.
  [[nodiscard]] Value overlaid_with(const Value& other) const;

  /// The value of a key before the mapping as a whole is checked, where other keys depend on it.
  [[nodiscard]] std::optional<Value> peek(std::string_view key) const;
  [[nodiscard]] bool is_mapping() const { return node_.IsMap(); }
  /// Nothing stands behind the key.
  [[nodiscard]] bool is_empty() const { return node_.IsNull(); }
  /// Of a list; 0 of all else.
  [[nodiscard]] std::size_t entries_written() const {
    return node_.IsSequence() ? node_.size() : 0;
  }
  /// "has 1 entry", "has 3 entries".
  [[nodiscard]] static std::string entries_text(std::size_t count) {
    return "has " + std::to_string(count) + (count == 1 ? " entry" : " entries");
  }
  /// The keys of a mapping whose keys are names, each once, in the file's order.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// "FILE:LINE: PATH: what"
  [[noreturn]] void refuse(const std::string& what) const;
  /// "FILE:LINE: PATH = VALUE, must be ..."
  [[noreturn]] void refuse_value(const std::string& must_be) const;

 private:
  friend class Map;
  struct Entry;
  Value(std::shared_ptr<const std::string> file, std::string path, const YAML::Node& node);
  /// Of a mapping, with what is laid over it; a key given twice is refused.
  [[nodiscard]] std::vector<Entry> entries() const;
  [[nodiscard]] std::vector<Value> overlaid_by_name(const std::vector<Value>& values) const;
  [[nodiscard]] std::string place() const;
  [[nodiscard]] const std::string& scalar(const std::string& must_be) const;

  std::shared_ptr<const std::string> file_;
  std::string path_;
  YAML::Node node_;
  std::optional<int> key_line_;        ///< from 0, of a value that has a key
  std::shared_ptr<const Value> over_;  ///< a mapping laid over this mapping or list
};

struct Value::Entry {
  std::string key;
  Value key_value;  ///< the key itself, for messages
  Value value;
};

/// A mapping, none of whose keys is unknown or given twice.
class Map {
 public:
  /// @param keys all that may stand here
  Map(const Value& value, std::initializer_list<std::string_view> keys);

  /// The value of a required key.
  [[nodiscard]] Value at(std::string_view key) const;
  [[nodiscard]] std::optional<Value> find(std::string_view key) const;
  [[nodiscard]] double number(std::string_view key, const Bounds& bounds) const;
  /// Leaves `value` as it is where the key is missing.
  void optional_number(std::string_view key, const Bounds& bounds, double& value) const;
  [[nodiscard]] const Value& value() const { return value_; }

 private:
  Value value_;
  std::vector<Value::Entry> entries_;
};

}  // namespace tenon::config
