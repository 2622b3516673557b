#include "shared/config/yaml_value.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "shared/base/did_you_mean.h"
#include "shared/base/error.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/config/file_kind.h"
#include "shared/config/value_hints.h"
#include "shared/config/yaml_documents.h"

namespace tenon::config {
namespace {

constexpr double kPositionMax_m = 100.0;
constexpr double kRotationMax_rad = 3.1415926535897932;
constexpr std::size_t kShownMax = 80;  // of a value or a key in a message, bytes

const char* kind_of(const YAML::Node& node) {
  if (node.IsSequence() && node.size() == 0) return "empty";
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  return node.IsScalar() ? "a single value" : "empty";
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

/// @param base of an integer
template <typename Number, typename... Base>
std::optional<Number> parsed(const std::string& text, Base... base) {
  Number number{};
  const char* end = text.data() + text.size();
  // A sign that YAML allows and from_chars does not.
  const char* begin = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
  const auto [rest, error] = std::from_chars(begin, end, number, base...);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return number;
}

}  // namespace

std::string to_string(const Bounds& bounds) {
  return format("%c%g, %g]", bounds.open_low ? '(' : '[', bounds.low, bounds.high);
}

Value::Value(std::shared_ptr<const std::string> file, std::string path, const YAML::Node& node)
    : file_(std::move(file)), path_(std::move(path)), node_(node) {}

Value Value::parse(const std::filesystem::path& file, const std::string& text) {
  auto name = std::make_shared<const std::string>(file.string());
  expect_text(file, text);
  try {
    const int documents = yaml_documents(text);
    if (documents != 1) {
      throw InputError(*name + ": must hold one YAML document, holds " +
                       (documents == 0 ? "none" : "2 or more"));
    }
    return {name, "", YAML::Load(text)};
  } catch (const YAML::Exception& error) {
    const int line = std::min(error.mark.line, last_line(text));
    throw InputError(*name + ":" + std::to_string(line + 1) + ": is not YAML: " + error.msg +
                     yaml_hint(text, line, error.msg));
  }
}

std::string Value::place() const {
  // An empty value has the line of what comes next; one that the file does not spell out has none.
  const int at = key_line_ && node_.IsNull() ? *key_line_ : node_.Mark().line;
  const std::string line = node_.Mark().is_null() ? "" : ":" + std::to_string(at + 1);
  return *file_ + line + ": " + path_;
}

void Value::refuse(const std::string& what) const {
  throw InputError(place() + (path_.empty() ? "" : ": ") + what);
}

void Value::refuse_value(const std::string& must_be) const {
  const bool whole = path_.empty() && node_.IsScalar();
  const std::string value = whole ? "is text (" + shortened(node_.Scalar(), kShownMax) + ")"
                            : node_.IsScalar()
                                ? " = " + shortened(node_.Scalar(), kShownMax)
                                : (path_.empty() ? "is " : " is ") + std::string(kind_of(node_));
  throw InputError(place() + value + ", must be " + must_be);
}

const std::string& Value::scalar(const std::string& must_be) const {
  if (!node_.IsScalar()) refuse_value(must_be);
  return node_.Scalar();
}

bool Value::is_zero() const { return node_.IsScalar() && parsed<double>(node_.Scalar()) == 0.0; }

double Value::number(const Bounds& bounds) const {
  const std::string must_be = "a number in " + to_string(bounds);
  const std::string& text = scalar(must_be);
  constexpr const char* kQuoted = "!";
  const std::optional<double> number = parsed<double>(text);
  if (!number || node_.Tag() == kQuoted) refuse_value(must_be + writing_hint(text));
  if (!std::isfinite(*number) || !bounds.holds(*number)) {
    refuse_value("in " + to_string(bounds) + unit_hint(path_, *number, bounds));
  }
  return *number;
}

std::int64_t Value::integer(std::int64_t low, std::int64_t high) const {
  const std::string range = "[" + std::to_string(low) + ", " + std::to_string(high) + "]";
  const std::string& text = scalar("an integer in " + range);
  const std::optional<std::int64_t> number = text.starts_with("0x")
                                                 ? parsed<std::int64_t>(text.substr(2), 16)
                                                 : parsed<std::int64_t>(text);
  if (!number) refuse_value("an integer in " + range);
  if (*number < low || *number > high) refuse_value("in " + range);
  return *number;
}

std::string Value::name() const {
  const std::string must_be = "a name of 1 to 63 printable ASCII characters";
  std::string text = scalar(must_be);
  const bool printable =
      std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (text.empty() || text.size() > kNameMax || !printable) refuse_value(must_be);
  return text;
}

std::string Value::text() const {
  std::string text = scalar("text");
  if (text.empty()) refuse("must not be empty");
  return text;
}

std::size_t Value::choice(const std::vector<std::string_view>& words) const {
  const std::string must_be = "one of: " + joined(words);
  const auto found = std::find(words.begin(), words.end(), scalar(must_be));
  if (found == words.end()) refuse_value(must_be + did_you_mean(node_.Scalar(), words));
  return static_cast<std::size_t>(found - words.begin());
}

std::vector<Value> Value::list(std::size_t at_least, std::size_t at_most) const {
  const std::string count = at_least == at_most
                                ? std::to_string(at_least)
                                : std::to_string(at_least) + " to " + std::to_string(at_most);
  const bool empty = node_.size() == 0 && at_least > 0;  // by [] or by nothing at all
  if (!node_.IsSequence() || empty) refuse_value("a list of " + count);
  if (node_.size() < at_least || node_.size() > at_most) {
    refuse(entries_text(node_.size()) + ", must have " + count +
           (at_least == at_most ? list_hint(node_.size(), at_least) : ""));
  }
  std::vector<Value> values;
  values.reserve(node_.size());
  for (const YAML::Node& node : node_) {
    values.push_back({file_, path_ + "[" + std::to_string(values.size()) + "]", node});
  }
  return over_ == nullptr ? values : overlaid_by_name(values);
}

Vector3 Value::vector(const Bounds& bounds) const {
  const std::vector<Value> values = list(3, 3);
  return {values[0].number(bounds), values[1].number(bounds), values[2].number(bounds)};
}

Pose Value::pose() const {
  const Map map(*this, {"position_m", "rotation_rad"});
  Pose pose;
  pose.position_m = map.at("position_m").vector(within(kPositionMax_m));
  if (const auto rotation = map.find("rotation_rad")) {
    pose.orientation = rotation_of(rotation->vector(within(kRotationMax_rad)));
  }
  return pose;
}

Value Value::overlaid_with(const Value& other) const {
  assert(over_ == nullptr);
  const bool merges = other.node_.IsMap() && (node_.IsMap() || node_.IsSequence());
  if (!merges) return other;
  Value merged = *this;
  merged.over_ = std::make_shared<const Value>(other);
  return merged;
}

std::vector<Value> Value::overlaid_by_name(const std::vector<Value>& values) const {
  const auto named = [](const Value& value, const Entry& entry) {
    const std::optional<Value> name = value.peek("name");
    return name && name->node_.IsScalar() && name->node_.Scalar() == entry.key;
  };
  const std::vector<Entry> overs = over_->entries();
  for (const Entry& over : overs) {
    const bool found = std::any_of(values.begin(), values.end(),
                                   [&](const Value& value) { return named(value, over); });
    if (!found) over.key_value.refuse("is not a name in the list " + path_);
  }
  std::vector<Value> laid;
  for (const Value& value : values) {
    const auto over = std::find_if(overs.begin(), overs.end(),
                                   [&](const Entry& entry) { return named(value, entry); });
    laid.push_back(over == overs.end() ? value : value.overlaid_with(over->value));
  }
  return laid;
}

std::vector<Value::Entry> Value::entries() const {
  // Keys are looked up in sets: a file may hold so many that a search for each through all others
  // would never end.
  std::vector<Entry> own;
  std::set<std::string> given;
  for (const auto& pair : node_) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "?";
    const std::string path = (path_.empty() ? "" : path_ + ".") + shortened(key, kShownMax);
    const Value key_value(file_, path, pair.first);
    if (!given.insert(key).second) key_value.refuse("is given twice");
    // An empty value is refused by whoever reads it, at the line of its key.
    Value value(file_, path, pair.second);
    value.key_line_ = pair.first.Mark().line;
    own.push_back({key, key_value, std::move(value)});
  }
  if (over_ == nullptr) return own;
  // Built anew: assigning to a YAML::Node would change the file's node, aliases of it included.
  const std::vector<Entry> overs = over_->entries();
  std::map<std::string_view, const Entry*> over_of;
  for (const Entry& over : overs) over_of.emplace(over.key, &over);
  std::vector<Entry> merged;
  for (const Entry& under : own) {
    const auto over = over_of.find(under.key);
    merged.push_back(over == over_of.end() ? under
                                           : Entry{under.key, under.key_value,
                                                   under.value.overlaid_with(over->second->value)});
  }
  for (const Entry& over : overs) {
    if (!given.contains(over.key)) merged.push_back(over);
  }
  return merged;
}

std::vector<std::string> Value::keys() const {
  if (!node_.IsMap()) refuse_value("a mapping");
  std::vector<std::string> keys;
  for (const Entry& entry : entries()) keys.push_back(entry.key_value.name());
  return keys;
}

std::optional<Value> Value::peek(std::string_view key) const {
  if (!node_.IsMap()) return std::nullopt;
  for (const Entry& entry : entries()) {
    if (entry.key == key) return entry.value;
  }
  return std::nullopt;
}

Map::Map(const Value& value, std::initializer_list<std::string_view> keys) : value_(value) {
  if (!value.node_.IsMap()) {
    value.refuse_value("a mapping with the keys " + joined(keys));
  }
  entries_ = value.entries();
  for (const Value::Entry& entry : entries_) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::span<const std::string_view> known(keys.begin(), keys.size());
    entry.key_value.refuse("is an unknown key, known here: " + joined(keys) +
                           key_hint(entry.key, known));
  }
}

Value Map::at(std::string_view key) const {
  if (auto value = find(key)) return *std::move(value);
  value_.refuse("the required key " + std::string(key) + " is missing");
}

std::optional<Value> Map::find(std::string_view key) const {
  for (const Value::Entry& entry : entries_) {
    if (entry.key == key) return entry.value;
  }
  return std::nullopt;
}

double Map::number(std::string_view key, const Bounds& bounds) const {
  return at(key).number(bounds);
}

void Map::optional_number(std::string_view key, const Bounds& bounds, double& value) const {
  if (const auto found = find(key)) value = found->number(bounds);
}

}  // namespace tenon::config
