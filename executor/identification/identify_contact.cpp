#include "executor/identification/identify_contact.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "shared/base/text.h"
#include "shared/cell/robot.h"

namespace tenon::executor {
namespace {

// Depth a delay before a sample, straight between the cycles.
double depth_before(const std::vector<PressSample>& samples, std::size_t at, double delay_cycles) {
  const double when = static_cast<double>(at) - delay_cycles;
  if (when <= 0.0) return samples.front().depth_m;
  const auto before = static_cast<std::size_t>(when);
  if (before + 1 >= samples.size()) return samples.back().depth_m;
  const double share = when - static_cast<double>(before);
  return samples[before].depth_m + share * (samples[before + 1].depth_m - samples[before].depth_m);
}

struct Line {
  double slope = 0.0;
  double slope_deviation = 0.0;
  double mean_square = 0.0;  ///< of what the line leaves
  double count = 0.0;
};

// Force over delayed depth; the first samples, whose past is not recorded, are left out.
Line line_for(const std::vector<PressSample>& samples, double delay_cycles, std::size_t from) {
  double n = 0.0;
  double d_mean = 0.0;
  double f_mean = 0.0;
  double dd = 0.0;
  double df = 0.0;
  double ff = 0.0;
  for (std::size_t i = from; i < samples.size(); ++i) {
    if (!samples[i].fresh) continue;
    n += 1.0;
    const double d = depth_before(samples, i, delay_cycles) - d_mean;
    const double f = samples[i].force_N - f_mean;
    d_mean += d / n;
    f_mean += f / n;
    dd += d * (d - d / n);
    df += d * (f - f / n);
    ff += f * (f - f / n);
  }
  Line line;
  line.count = n;
  if (n < 3.0 || dd <= 0.0) return line;
  line.slope = df / dd;
  line.mean_square = std::max(0.0, ff - df * line.slope) / n;
  line.slope_deviation = std::sqrt(line.mean_square * n / (n - 2.0) / dd);
  return line;
}

// Where f is least in [low, high], for an f with one minimum there.
template <typename Function>
double least_at(double low, double high, Function f) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double f_a = f(a);
  double f_b = f(b);
  for (int i = 0; i < 40; ++i) {
    if (f_a < f_b) {
      high = b;
      b = a;
      f_b = f_a;
      a = high - golden * (high - low);
      f_a = f(a);
    } else {
      low = a;
      a = b;
      f_a = f_b;
      b = low + golden * (high - low);
      f_b = f(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

ContactIdentification identify_contact(const std::vector<PressSample>& samples, double cycle_s) {
  ContactIdentification contact;
  const double delay_max_cycles = kPressDelayMax_s / cycle_s;
  const auto from = static_cast<std::size_t>(std::ceil(delay_max_cycles));
  const auto left = [&](double delay_cycles) {
    return line_for(samples, delay_cycles, from).mean_square;
  };
  if (line_for(samples, 0.0, from).count < static_cast<double>(kPressSamplesMin)) return contact;

  const double delay_cycles = least_at(0.0, delay_max_cycles, left);
  const Line line = line_for(samples, delay_cycles, from);
  contact.stiffness_Npm = line.slope;
  contact.stiffness_deviation_Npm = line.slope_deviation;
  contact.residual_N = std::sqrt(line.mean_square);
  contact.cycle_s = cycle_s;
  contact.delay_s = delay_cycles * cycle_s;
  contact.lag_s = std::max(0.0, contact.delay_s - 0.5 * cycle_s);
  // The residual's curvature over the delay says how sharp its minimum is.
  const double step_cycles = std::max(0.5, 0.1 * delay_cycles);
  const double curvature =
      (left(delay_cycles + step_cycles) + left(std::max(0.0, delay_cycles - step_cycles)) -
       2.0 * line.mean_square) /
      (step_cycles * step_cycles);
  if (curvature > 0.0) {
    contact.delay_deviation_s =
        cycle_s * std::sqrt(2.0 * line.mean_square / (curvature * line.count));
  }
  contact.status =
      line.slope <= 3.0 * line.slope_deviation ? ContactIdentification::Status::kNoResponse
      : delay_cycles > 0.98 * delay_max_cycles ? ContactIdentification::Status::kDelayAtEdge
                                               : ContactIdentification::Status::kIdentified;
  return contact;
}

std::string describe(const ContactIdentification& c) {
  switch (c.status) {
    case ContactIdentification::Status::kIdentified:
      return format(
                 "contact: stiffness %.0f N/m (deviation %.0f), %.2f ms from a setpoint to its "
                 "force (deviation %.2f), residual %.2f N\n",
                 c.stiffness_Npm, c.stiffness_deviation_Npm, 1e3 * c.delay_s,
                 1e3 * c.delay_deviation_s, c.residual_N) +
             format("for the cell file:\ncontact_stiffness_Npm: %.3g\n", c.stiffness_Npm) +
             format(
                 "for the robot file (measured %.4f, at least two cycles):\n"
                 "arm: {response_lag_s: %.4f}\n",
                 c.lag_s, std::max(c.lag_s, protocol_lag_s(c.cycle_s)));
    case ContactIdentification::Status::kTooShort:
      return format("contact: not identified, needs %d samples of the force\n",
                    static_cast<int>(kPressSamplesMin));
    case ContactIdentification::Status::kNoResponse:
      return format(
          "contact: not identified: the force does not grow with the way into the "
          "contact (%.0f N/m, deviation %.0f)\n",
          c.stiffness_Npm, c.stiffness_deviation_Npm);
    case ContactIdentification::Status::kDelayAtEdge:
      return format("contact: not identified: the force comes more than %g s after the way\n",
                    kPressDelayMax_s);
  }
  return "?";
}

const char* to_string(ContactIdentification::Status status) {
  switch (status) {
    case ContactIdentification::Status::kIdentified:
      return "identified";
    case ContactIdentification::Status::kTooShort:
      return "too_short";
    case ContactIdentification::Status::kNoResponse:
      return "no_response";
    case ContactIdentification::Status::kDelayAtEdge:
      return "delay_at_edge";
  }
  return "?";
}

Finding finding_of(const ContactIdentification& c) {
  const bool found = c.status == ContactIdentification::Status::kIdentified;
  Finding finding{found, to_string(c.status), describe(c), {}};
  if (!found) return finding;
  finding.values = {{"stiffness_Npm", {c.stiffness_Npm}},
                    {"stiffness_deviation_Npm", {c.stiffness_deviation_Npm}},
                    {"delay_s", {c.delay_s}},
                    {"delay_deviation_s", {c.delay_deviation_s}},
                    {"response_lag_s", {c.lag_s}},
                    {"force_residual_N", {c.residual_N}}};
  return finding;
}

}  // namespace tenon::executor
