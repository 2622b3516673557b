#include "sim/cell/virtual_arm/environment_offset.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "shared/base/error.h"
#include "shared/base/random.h"
#include "shared/base/text.h"

namespace tenon::sim {
namespace {

[[noreturn]] void refuse(const std::string& item, const std::string& why) {
  throw InputError("--offset: \"" + item + "\" " + why + "; give it as x_m=0.02,y_m=-0.01");
}

}  // namespace

Vector6 draw_offset(const Task& task, const Start& start, std::uint64_t seed) {
  Random source(stream_seed(seed, "environment_offset"));
  Vector6 offset = Vector6::Zero();
  for (int axis = 0; axis < 6; ++axis) {
    // Every axis takes a number, so that an axis more leaves the draws of the others alone.
    const double value = task.errors == Distribution::kUniform
                             ? std::numbers::sqrt3 * (2.0 * source.uniform() - 1.0)
                             : source.normal();
    if (has(task.coordinates, axis)) offset[axis] = start.sigma[axis] * value;
  }
  return offset;
}

Vector6 parse_offset(const std::string& text, CoordinateMask coordinates) {
  Vector6 offset = Vector6::Zero();
  CoordinateMask seen = 0;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    const std::size_t equals = item.find('=');
    int axis = 0;
    while (axis < 6 && axis_key(axis) != item.substr(0, equals)) ++axis;
    if (equals == std::string_view::npos || axis == 6) {
      refuse(std::string(item), "must name one of x_m y_m z_m rx_rad ry_rad rz_rad and a value");
    }
    const auto bit = static_cast<CoordinateMask>(1U << axis);
    if ((coordinates & bit) == 0) refuse(std::string(item), "is no search coordinate of the task");
    if ((seen & bit) != 0) refuse(std::string(item), "stands there twice");
    seen |= bit;
    const std::string_view number = item.substr(equals + 1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc{} || end != number.data() + number.size() || !(std::abs(value) <= 1.0)) {
      refuse(std::string(item), "must have a number in [-1, 1]");
    }
    offset[axis] = value;
    if (comma == std::string_view::npos) return offset;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace tenon::sim
