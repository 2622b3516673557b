#pragma once
// What a refused value was probably meant to be. Pure; for messages. Each is a text that begins
// with
// "; ", or nothing where no likely mistake explains the value.

#include <cstddef>
#include <string>
#include <string_view>

#include "shared/config/yaml_value.h"

namespace tenon::config {

/// Of a text that is no number: a decimal comma, a unit behind it, quotes around it.
[[nodiscard]] std::string writing_hint(std::string_view text);

/// Of a number out of its bounds that a unit a thousand times smaller, or degrees, would bring into
/// them. @param path whose last key ends in the unit, such as "starts[0].sigma_m[1]"
[[nodiscard]] std::string unit_hint(std::string_view path, double number, const Bounds& bounds);

/// Of a key that is the end of a number: in {a: 0,002} the comma ends the value.
[[nodiscard]] std::string key_hint(std::string_view key);

/// Of a text that is no YAML: a tab in the margin of the line (from 0) or of the one before it.
[[nodiscard]] std::string tab_hint(std::string_view text, int line);

}  // namespace tenon::config
