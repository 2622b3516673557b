#include "executor/export/value.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tenon::executor {
namespace {

template <typename Number>
void add_number(Number number, std::string& text) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

/// True where the value was a truth, a count or a number.
bool add_plain(const Value& value, std::string& text) {
  if (const auto* truth = std::get_if<bool>(&value)) {
    text += *truth ? "true" : "false";
  } else if (const auto* count = std::get_if<std::int64_t>(&value)) {
    add_number(*count, text);
  } else if (const auto* number = std::get_if<double>(&value)) {
    add_number(*number, text);
  } else {
    return false;
  }
  return true;
}

}  // namespace

bool is_known(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return std::isfinite(*number);
  return !std::holds_alternative<std::monostate>(value);
}

void add_csv(const Value& value, std::string& text) {
  if (!is_known(value) || add_plain(value, text)) return;
  const auto& words = std::get<std::string>(value);
  if (words.find_first_of(",\"\r\n") == std::string::npos) {
    text += words;
    return;
  }
  text += '"';
  for (const char c : words) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  text += '"';
}

void add_json(const Value& value, std::string& text) {
  if (!add_plain(value, text)) text += json_text(std::get<std::string>(value));
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace tenon::executor
