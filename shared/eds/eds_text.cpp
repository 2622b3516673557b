#include "shared/eds/eds_text.h"

#include <charconv>
#include <cstddef>
#include <system_error>

#include "shared/base/text.h"
#include "shared/eds/ini_file.h"

namespace tenon {

std::optional<std::uint64_t> digits(std::string_view text, int base) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, base);
  if (text.empty() || error != std::errc{} || rest != end) return std::nullopt;
  return number;
}

std::optional<std::int64_t> parsed_number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  std::optional<std::uint64_t> number;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    number = digits(text.substr(2), 16);
  } else {
    const bool octal = text.size() > 1 && text.front() == '0' &&
                       text.find_first_of("89") == std::string_view::npos;
    number = digits(text, octal ? 8 : 10);
  }
  if (!number) return std::nullopt;
  return static_cast<std::int64_t>(negative ? 0 - *number : *number);
}

std::optional<std::int64_t> parsed_sum(std::string_view text) {
  std::uint64_t sum = 0;
  while (true) {
    const std::size_t end = text.find('+', 1);
    const auto term = parsed_number(text.substr(0, end));
    if (!term) return std::nullopt;
    sum += static_cast<std::uint64_t>(*term);
    if (end == std::string_view::npos) return static_cast<std::int64_t>(sum);
    text.remove_prefix(end + 1);
  }
}

std::string without_comment(const std::string& text) {
  return std::string(trimmed(std::string_view(text).substr(0, text.find(';'))));
}

std::optional<DeviceObjectId> object_of_section(const std::string& name) {
  const std::size_t sub_at = name.find("sub");
  const std::string_view index_text = trimmed(std::string_view(name).substr(0, sub_at));
  if (index_text.size() != 4) return std::nullopt;
  const auto index = digits(index_text, 16);
  if (!index) return std::nullopt;
  if (sub_at == std::string::npos) return static_cast<DeviceObjectId>(*index << 8);
  const auto sub = digits(trimmed(std::string_view(name).substr(sub_at + 3)), 16);
  if (!sub || *sub > 0xFF) return std::nullopt;
  return static_cast<DeviceObjectId>(*index << 8 | *sub);
}

std::string sub_prefix(std::uint16_t index) {
  return lower_case(format("%04X", static_cast<unsigned>(index))) + "sub";
}

}  // namespace tenon
