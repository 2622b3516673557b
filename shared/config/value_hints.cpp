#include "shared/config/value_hints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "shared/base/text.h"

namespace tenon::config {
namespace {

/// How many bytes at the text's beginning are a number; 0: none.
std::size_t number_length(std::string_view text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} ? static_cast<std::size_t>(rest - text.data()) : 0;
}

struct Unit {
  std::string_view end;    ///< of the key
  std::string_view name;   ///< what the key says
  std::string_view other;  ///< what people write
  double per_unit;         ///< of the other
  double beyond = 2.0;     ///< as many times the bound and more is no longer too much of the unit
};

// The longer ends first: what ends in _mps does not end in _s. Bounds of lengths are metres that no
// hand or arm reaches, so that whatever is beyond them is in millimetres.
constexpr std::array<Unit, 10> kUnits = {
    {{"_m2", "m^2", "mm^2", 1e6},
     {"_mps", "m/s", "mm/s", 1e3},
     {"_mps2", "m/s^2", "mm/s^2", 1e3},
     {"_Npm", "N/m", "N/mm", 1e-3},
     {"_m", "m", "mm", 1e3, 1.0},
     {"_s", "s", "ms", 1e3},
     {"_kg", "kg", "g", 1e3},
     {"_Nm", "Nm", "Nmm", 1e3},
     {"_radps", "rad/s", "degrees/s", 180.0 / std::numbers::pi},
     {"_rad", "rad", "degrees", 180.0 / std::numbers::pi}}};

const Unit* unit_of(std::string_view path) {
  while (path.ends_with(']')) path = path.substr(0, path.rfind('['));
  const auto found = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const Unit& unit) { return path.ends_with(unit.end); });
  return found == kUnits.end() ? nullptr : found;
}

}  // namespace

std::string writing_hint(std::string_view text) {
  std::string point(text);
  const std::size_t comma = point.find(',');
  if (comma != std::string::npos) point[comma] = '.';
  if (comma != std::string::npos && number_length(point) == point.size()) {
    return "; write a decimal point: " + point;
  }
  for (const std::string_view dash : {"\u2212", "\u2013", "\u2010", "\u2011"}) {
    if (text.starts_with(dash)) return "; its minus is another character: write -";
  }
  const std::size_t length = number_length(text);
  if (length == 0) return {};
  if (text.find('/') != std::string_view::npos) return "; write the quotient as a number";
  if (length == text.size()) return "; leave the quotes out";
  const std::size_t rest = text.find_first_not_of(' ', length);
  if (rest != std::string_view::npos && std::isalpha(static_cast<unsigned char>(text[rest])) != 0) {
    return "; write the number alone: its unit stands in the key";
  }
  return {};
}

std::string unit_hint(std::string_view path, double number, const Bounds& bounds) {
  const Unit* unit = unit_of(path);
  if (unit == nullptr || !std::isfinite(number)) return {};
  const double meant = number / unit->per_unit;
  // Nobody writes a fraction of a small unit. Of a large one, few.
  const double bound = std::max(std::abs(bounds.low), std::abs(bounds.high));
  const bool other_unit = unit->per_unit < 1.0
                              ? number < bounds.low
                              : std::abs(number) >= std::max(unit->beyond * bound, 1.0);
  if (!other_unit || !bounds.holds(meant)) return {};
  return "; is it in " + std::string(unit->other) + "? then write " + format("%.4g", meant) + " " +
         std::string(unit->name);
}

std::string key_hint(std::string_view key) {
  const bool digits = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  if (digits) return "; a decimal comma ends a number here: write a decimal point";
  const bool radius = key.find("radius") != std::string_view::npos;
  return radius ? "; a round shape's size is its diameter, twice the radius" : "";
}

std::string tab_hint(std::string_view text, int line) {
  std::size_t at = 0;
  for (int i = 0; at < text.size() && i <= line; ++i) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view row = text.substr(at, end - at);
    const std::string_view margin = row.substr(0, row.find_first_not_of(" \t"));
    if (i + 1 >= line && margin.find('\t') != std::string_view::npos) {
      return format("; line %d begins with a tab: indent with spaces", i + 1);
    }
    at = end + 1;
  }
  return {};
}

}  // namespace tenon::config
