#pragma once
// A value of a run's log as other tools get it, and its text in their formats. Numbers keep every
// bit: as few digits as give the same number back. Pure; allocates.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace tenon::executor {

/// Not known, a truth, a count, a number, a text. What is no finite number counts as not known.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

[[nodiscard]] bool is_known(const Value& value);

/// As a field of CSV (RFC 4180): empty where it is not known, quoted where it has to be.
void add_csv(const Value& value, std::string& text);
/// As JSON. A value must be known: JSON has no number for what is not.
void add_json(const Value& value, std::string& text);
/// @param text UTF-8
[[nodiscard]] std::string json_text(std::string_view text);

/// ns as s, the nearest number: 1e-9 times it would have a last digit of its own.
[[nodiscard]] constexpr double seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

}  // namespace tenon::executor
