#pragma once
// Text for messages. Allocates; not for real time.

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace tenon {

/// printf into a string, as long as it gets. The compiler holds the values against the pattern.
[[nodiscard, gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

inline constexpr std::array<const char*, 6> kAxisNames = {"x", "y", "z", "rx", "ry", "rz"};

/// x y z rx ry rz for 0..5, else "?".
[[nodiscard]] constexpr const char* axis_name(int axis) {
  if (axis < 0 || axis >= 6) return "?";
  return kAxisNames.at(static_cast<std::size_t>(axis));
}

/// "m" for 0..2, "rad" for 3..5.
[[nodiscard]] constexpr const char* axis_unit(int axis) { return axis < 3 ? "m" : "rad"; }

/// x_m y_m z_m rx_rad ry_rad rz_rad: what files and options call a displacement along an axis.
[[nodiscard]] inline std::string axis_key(int axis) {
  return std::string(axis_name(axis)) + '_' + axis_unit(axis);
}

/// "x y rz" for a bit mask of axes, or "none".
[[nodiscard]] inline std::string axis_list(unsigned axes) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) != 0) text += (text.empty() ? "" : " ") + std::string(axis_name(axis));
  }
  return text.empty() ? "none" : text;
}

/// What makes a noun agree with a count: "s", or nothing of one.
[[nodiscard]] constexpr const char* plural(auto count) { return count == 1 ? "" : "s"; }

/// As one word of a POSIX shell: quoted where it has to be.
[[nodiscard]] inline std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./:=,+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace tenon
