#include "shared/config/value_hints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "shared/base/did_you_mean.h"
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
// So are errors of angles beyond a radian in degrees.
constexpr std::array<Unit, 13> kUnits = {
    {{"_m2", "m^2", "mm^2", 1e6},
     {"_mps", "m/s", "mm/s", 1e3},
     {"_mps2", "m/s^2", "mm/s^2", 1e3},
     {"_Npm", "N/m", "N/mm", 1e-3},
     {"_m", "m", "mm", 1e3, 1.0},
     {"_s", "s", "ms", 1e3},
     {"_kg", "kg", "g", 1e3},
     {"_N", "N", "mN", 1e3},
     {"_Nm", "Nm", "Nmm", 1e3},
     {"_radps", "rad/s", "degrees/s", 180.0 / std::numbers::pi},
     {"sigma_rad", "rad", "degrees", 180.0 / std::numbers::pi, 1.0},
     {"uniform_rad", "rad", "degrees", 180.0 / std::numbers::pi, 1.0},
     {"_rad", "rad", "degrees", 180.0 / std::numbers::pi}}};

// What other formats call it, and what people say.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOtherWords = {
    {{"filename", "file"},
     {"path", "file"},
     {"mesh_file", "mesh"},
     {"height_m", "length_m"},
     {"height", "length_m"},
     {"xyz", "position_m"},
     {"translation", "position_m"}}};

// Rotations in ways that no pose here has.
constexpr std::array<std::string_view, 8> kOtherRotations = {
    "quaternion", "quat", "orientation", "rpy", "rpy_deg", "rpy_rad", "euler", "rotation_deg"};

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
  constexpr double kPercent = 100.0;
  const bool friction = path.find("friction.") != std::string_view::npos;
  if (friction && number > 2.0 * bounds.high && bounds.holds(number / kPercent)) {
    return "; is it in percent? then write " + format("%g", number / kPercent);
  }
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

std::string key_hint(std::string_view key, std::span<const std::string_view> known) {
  const bool digits = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isdigit(c) != 0;
  });
  if (digits) return "; a decimal comma ends a number here: write a decimal point";
  if (key.find("radius") != std::string_view::npos) {
    return "; a round shape's size is its diameter, twice the radius";
  }
  const auto is_known = [&](std::string_view word) {
    return std::find(known.begin(), known.end(), word) != known.end();
  };
  if (is_known("pose") && (key == "position_m" || key == "rotation_rad" || key == "position")) {
    return "; it stands in the pose: pose: {position_m: [0.1, 0, 0]}";
  }
  const bool rotation =
      std::find(kOtherRotations.begin(), kOtherRotations.end(), key) != kOtherRotations.end();
  if (rotation && is_known("rotation_rad")) {
    return "; rotations are rotation_rad, a rotation vector: axis times angle, in rad";
  }
  for (const auto& [word, meant] : kOtherWords) {
    if (key == word && is_known(meant)) return "; did you mean " + std::string(meant) + "?";
  }
  return did_you_mean(key, known);
}

std::string list_hint(std::size_t given, std::size_t wanted) {
  return wanted > 1 && given == 2 * wanted
             ? "; a decimal comma makes two of one number: write decimal points"
             : "";
}

namespace {

/// From 0; empty beyond the last.
std::string_view row_of(std::string_view text, int line) {
  for (int i = 0; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

struct Forgotten {
  std::string_view said;  ///< by yaml-cpp
  std::string_view hint;
};

constexpr std::array<Forgotten, 6> kForgotten = {
    {{"end of map flow",
      "; here or above, a {...} is not closed, or has no comma between two of its keys"},
     {"end of sequence flow",
      "; here or above, a [...] is not closed, or has no comma between two of its entries"},
     {"illegal flow end",
      "; here or above, a bracket or a brace is missing: a } or ] closes what none has opened"},
     {"end of map",
      "; here or above, a key is indented unlike its neighbours, a dash is missing before it, or a "
      "bracket is too many"},
     {"end of sequence",
      "; here or above, an entry of a list is indented unlike the others, or its dash is missing"},
     {"illegal map value",
      "; here or above, an indent differs, a comment lacks its #, a key has = for its colon, or a "
      "{ is missing"}}};

}  // namespace

std::string yaml_hint(std::string_view text, int line, std::string_view said) {
  for (const int at : {line - 1, line}) {
    if (at < 0) continue;
    const std::string_view row = row_of(text, at);
    const std::string_view margin = row.substr(0, row.find_first_not_of(" \t"));
    if (margin.find('\t') != std::string_view::npos) {
      return format("; line %d begins with a tab: indent with spaces", at + 1);
    }
    if (row.find("\u00a0") != std::string_view::npos) {
      return format("; line %d has a no-break space: write plain spaces", at + 1);
    }
  }
  const auto* found = std::find_if(kForgotten.begin(), kForgotten.end(), [&](const Forgotten& one) {
    return said.starts_with(one.said);
  });
  return found == kForgotten.end() ? "" : std::string(found->hint);
}

int last_line(std::string_view text) {
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace tenon::config
