#include "sim/evaluation/quantity.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "shared/base/error.h"

namespace tenon::sim {
namespace {

constexpr double kNotDrawn = std::numeric_limits<double>::quiet_NaN();

struct Quantity {
  const char* name;
  double (*of)(const Trial&);
};

// Named as in an experiment's file.
constexpr std::array<Quantity, 19> kQuantities = {{
    {"distance", [](const Trial& t) { return t.distance; }},
    {"tilt_rad", [](const Trial& t) { return t.tilt_rad; }},
    {"friction", [](const Trial& t) { return t.world.friction.value_or(kNotDrawn); }},
    {"contact_stiffness_Npm",
     [](const Trial& t) { return t.world.contact_stiffness_Npm.value_or(kNotDrawn); }},
    {"clearance_m", [](const Trial& t) { return t.world.clearance_m; }},
    {"task_in_base_error_m",
     [](const Trial& t) { return t.world.task_in_base_error.head<3>().norm(); }},
    {"task_in_base_error_rad",
     [](const Trial& t) { return t.world.task_in_base_error.tail<3>().norm(); }},
    {"tool_in_flange_error_m",
     [](const Trial& t) { return t.world.tool_in_flange_error.head<3>().norm(); }},
    {"tool_in_flange_error_rad",
     [](const Trial& t) { return t.world.tool_in_flange_error.tail<3>().norm(); }},
    {"sensor_in_flange_error_m",
     [](const Trial& t) { return t.world.sensor_in_flange_error.head<3>().norm(); }},
    {"sensor_in_flange_error_rad",
     [](const Trial& t) { return t.world.sensor_in_flange_error.tail<3>().norm(); }},
    {"payload_mass_error_kg", [](const Trial& t) { return t.world.payload_mass_error_kg; }},
    {"payload_com_error_m", [](const Trial& t) { return t.world.payload_com_error_m.norm(); }},
    {"servo_stiffness_factor", [](const Trial& t) { return t.world.servo_stiffness_factor; }},
    {"extra_delay_s", [](const Trial& t) { return t.world.extra_delay_s; }},
    {"backlash_m", [](const Trial& t) { return t.world.backlash_m; }},
    {"backlash_rad", [](const Trial& t) { return t.world.backlash_rad; }},
    {"sensor_noise_factor", [](const Trial& t) { return t.world.sensor_noise_factor; }},
    {"force_drift_N_sqrts", [](const Trial& t) { return t.world.force_drift_N_sqrts; }},
}};

const Quantity* find_quantity(std::string_view name) {
  const auto found = std::find_if(kQuantities.begin(), kQuantities.end(),
                                  [&](const Quantity& q) { return q.name == name; });
  return found != kQuantities.end() ? &*found : nullptr;
}

template <typename Number>
bool read(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

Interval Bins::edges(std::size_t bin) const {
  const auto edge = [this](std::size_t i) {
    return low + (high - low) * static_cast<double>(i) / static_cast<double>(count);
  };
  return {edge(bin), edge(bin + 1)};
}

std::optional<std::size_t> Bins::bin_of(const Trial& trial) const {
  const double value = find_quantity(quantity)->of(trial);
  if (!(value >= low && value <= high)) return std::nullopt;
  for (std::size_t bin = 0; bin + 1 < count; ++bin) {
    if (value < edges(bin).high) return bin;
  }
  return count - 1;
}

Bins parse_bins(const std::string& text) {
  constexpr std::size_t kBinsMax = 100;
  const auto refuse = [&](const std::string& why) -> Bins {
    throw InputError("--by: \"" + text + "\" " + why + "; give it as friction=0.1:0.8:7");
  };
  Bins bins;
  const std::size_t equals = text.find('=');
  const std::size_t first = text.find(':', equals);
  const std::size_t second = text.find(':', first + 1);
  bins.quantity = text.substr(0, equals);
  if (find_quantity(bins.quantity) == nullptr) {
    std::string names;
    for (const std::string& name : quantity_names()) names += (names.empty() ? "" : " ") + name;
    return refuse("must name one of " + names);
  }
  if (equals == std::string::npos || first == std::string::npos || second == std::string::npos) {
    return refuse("must have a range and a number of bins");
  }
  const std::string_view rest = text;
  if (!read(rest.substr(equals + 1, first - equals - 1), bins.low) ||
      !read(rest.substr(first + 1, second - first - 1), bins.high) || !std::isfinite(bins.low) ||
      !std::isfinite(bins.high) || bins.low >= bins.high) {
    return refuse("must have a range from a lower number to a higher one");
  }
  if (!read(rest.substr(second + 1), bins.count) || bins.count < 1 || bins.count > kBinsMax) {
    return refuse("must have 1 to 100 bins");
  }
  return bins;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  names.reserve(std::size(kQuantities));
  for (const Quantity& quantity : kQuantities) names.emplace_back(quantity.name);
  return names;
}

}  // namespace tenon::sim
