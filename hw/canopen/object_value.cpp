#include "hw/canopen/object_value.h"

#include <algorithm>

#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon::hw::canopen {
namespace {

struct Type {
  const char* name;
  unsigned bytes;
  bool is_signed;
};
constexpr Type kTypes[] = {{"u8", 1, false}, {"u16", 2, false}, {"u32", 4, false},
                           {"i8", 1, true},  {"i16", 2, true},  {"i32", 4, true}};

std::int64_t number_of(const std::string& value) {
  try {
    std::size_t used = 0;
    const std::int64_t number = std::stoll(value, &used, 0);
    if (used == value.size()) return number;
  } catch (const std::exception&) {
    // Falls through to the one message for everything that is no number.
  }
  throw InputError("value '" + value + "' is no number; give decimal or 0x..");
}

[[noreturn]] void refuse_number(const std::string& value, const Type& type, std::int64_t low,
                                std::int64_t high) {
  throw InputError("value " + value + " does not fit " + type.name + ", must be in [" +
                   std::to_string(low) + ", " + std::to_string(high) + "]");
}

}  // namespace

std::vector<std::uint8_t> object_bytes(const std::string& type, const std::string& value) {
  if (type == "str") {
    if (value.empty()) throw InputError("value of type str must not be empty");
    return {value.begin(), value.end()};
  }
  for (const Type& known : kTypes) {
    if (type != known.name) continue;
    const std::int64_t number = number_of(value);
    const unsigned bits = 8 * known.bytes;
    const std::int64_t low = known.is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
    const std::int64_t high = (std::int64_t{1} << (known.is_signed ? bits - 1 : bits)) - 1;
    if (number < low || number > high) {
      refuse_number(value, known, low, high);
    }
    std::vector<std::uint8_t> bytes;
    for (unsigned i = 0; i < known.bytes; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
    return bytes;
  }
  throw InputError("type '" + type + "' is unknown; use u8 u16 u32 i8 i16 i32 or str");
}

std::string object_text(std::span<const std::uint8_t> bytes) {
  const std::size_t size = bytes.size();
  if (size == 1 || size == 2 || size == 4) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
    const auto unused_bits = static_cast<unsigned>(32 - 8 * size);
    const auto as_signed =
        static_cast<std::int32_t>(value << unused_bits) >> static_cast<int>(unused_bits);
    const std::string negative = as_signed < 0 ? " or " + std::to_string(as_signed) : "";
    return format("0x%0*X = %u", static_cast<int>(2 * size), value, value) + negative + " (" +
           std::to_string(size) + (size == 1 ? " byte)" : " bytes)");
  }
  const bool printable =
      std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; });
  if (printable && size > 0) {
    return "\"" + std::string(bytes.begin(), bytes.end()) + "\"";
  }
  std::string hex;
  for (const std::uint8_t byte : bytes) hex += format("%02X ", static_cast<unsigned>(byte));
  return hex + "(" + std::to_string(size) + " bytes)";
}

}  // namespace tenon::hw::canopen
