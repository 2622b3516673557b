#include "shared/base/printable.h"

#include <array>
#include <cstdint>
#include <cstdio>

namespace tenon {
namespace {

/// Separators of lines and paragraphs, and what turns the direction of writing: U+2028 to U+202E,
/// and U+2066 to U+2069.
bool rearranges(std::uint8_t first, std::uint8_t second, std::uint8_t third) {
  if (first != 0xE2) return false;
  return (second == 0x80 && third >= 0xA8 && third <= 0xAE) ||
         (second == 0x81 && third >= 0xA6 && third <= 0xA9);
}

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
}

bool continues(std::uint8_t byte) { return (byte & 0xC0U) == 0x80U; }

/// Bytes of the UTF-8 character that begins here and is none of control; 0 where none does.
std::size_t character_at(std::string_view text, std::size_t i) {
  const std::uint8_t first = byte_at(text, i);
  if (first >= 0x20 && first < 0x7F) return 1;
  // C2 80 to C2 9F are the control characters of 8-bit terminals.
  const std::uint8_t second = byte_at(text, i + 1);
  if (first < 0xC2 || first > 0xF4 || !continues(second)) return 0;
  if (first < 0xE0) return first == 0xC2 && second < 0xA0 ? 0 : 2;
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90)) {
    return 0;
  }
  if (!continues(byte_at(text, i + 2))) return 0;
  if (rearranges(first, second, byte_at(text, i + 2))) return 0;
  if (first < 0xF0) return 3;
  return continues(byte_at(text, i + 3)) ? 4 : 0;
}

std::string escaped(std::uint8_t byte) {
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  std::array<char, 5> text{};
  std::snprintf(text.data(), text.size(), "\\x%02X", static_cast<unsigned>(byte));
  return text.data();
}

}  // namespace

std::string printable(std::string_view text) {
  std::string all;
  all.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_at(text, i);
    if (size == 0) {
      all += escaped(byte_at(text, i++));
    } else {
      all += text.substr(i, size);
      i += size;
    }
  }
  return all;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  // No character is cut in two.
  std::size_t head = most - most / 3;
  std::size_t tail = text.size() - most / 3;
  while (head > 0 && continues(byte_at(text, head))) --head;
  while (tail < text.size() && continues(byte_at(text, tail))) ++tail;
  return std::string(text.substr(0, head)) + "... (" + std::to_string(tail - head) + " bytes) ..." +
         std::string(text.substr(tail));
}

}  // namespace tenon
