#pragma once
// Text for messages. Allocates; not for real time.

#include <cstdio>
#include <string>

namespace tenon {

/// printf into a string, as long as it gets.
template <typename... Values>
[[nodiscard]] std::string format(const char* pattern, Values... values) {
  const int length = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::snprintf(text.data(), text.size() + 1, pattern, values...);
  return text;
}

/// x y z rx ry rz for 0..5, else "?".
[[nodiscard]] constexpr const char* axis_name(int axis) {
  switch (axis) {
    case 0:
      return "x";
    case 1:
      return "y";
    case 2:
      return "z";
    case 3:
      return "rx";
    case 4:
      return "ry";
    case 5:
      return "rz";
  }
  return "?";
}

}  // namespace tenon
