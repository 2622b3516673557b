#pragma once
// What a refused value was probably meant to be. Pure; for messages. Each is a text that begins
// with
// "; ", or nothing where no likely mistake explains the value.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "shared/config/yaml_value.h"

namespace tenon::config {

/// Of a text that is no number: a decimal comma, a unit behind it, quotes around it.
[[nodiscard]] std::string writing_hint(std::string_view text);

/// Of a number out of its bounds that a unit a thousand times smaller, or degrees, would bring into
/// them. @param path whose last key ends in the unit, such as "starts[0].sigma_m[1]"
[[nodiscard]] std::string unit_hint(std::string_view path, double number, const Bounds& bounds);

/// Of an unknown key: the end of a number, since in {a: 0,002} the comma ends the value; another
/// word for a known one; one that stands a level too high; or one that is a few slips away.
[[nodiscard]] std::string key_hint(std::string_view key, std::span<const std::string_view> known);

/// Of a list of numbers twice as long as it must be: each decimal comma makes two of one.
[[nodiscard]] std::string list_hint(std::size_t given, std::size_t wanted);

/// Of a text that is no YAML: what people forget where the parser says this of a line (from 0).
/// @param said by the parser, yaml-cpp's words
[[nodiscard]] std::string yaml_hint(std::string_view text, int line, std::string_view said);

/// The last line of a text that holds more than blanks, from 0.
[[nodiscard]] int last_line(std::string_view text);

}  // namespace tenon::config
