#include "planner/report/report_words.h"

#include <algorithm>
#include <cmath>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"

namespace tenon::planner {

std::string names_of(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + drawing::escaped(name);
  return text;
}

std::string amount(double value, int axis) {
  const double told = shown(value, axis);
  if (std::abs(told) < (axis < 3 ? 0.5e-3 : 0.5e-4)) return axis < 3 ? "0 mm" : "0\u00b0";
  if (axis < 3) return format(told < 0.1 ? "%.3f mm" : "%.1f mm", told);
  return format(told < 0.01 ? "%.4f\u00b0" : "%.2f\u00b0", told);
}

std::string contacts_text(const Envelope& envelope) {
  const ContactSignature sometimes{
      static_cast<std::uint16_t>(envelope.possible.bits & ~envelope.always.bits)};
  const std::string always = to_string(envelope.always);
  return sometimes.count() > 0 ? always + ", possible " + to_string(sometimes) : always;
}

std::string spread_text(const Plan& plan, const Vector6& spread) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    text += (text.empty() ? "" : ", ") + std::string(axis_name(axis)) + " " +
            amount(spread[axis], axis);
  }
  return text;
}

std::string outcomes_text(const ReportData& data, std::size_t step) {
  std::string text;
  for (const Outcome outcome : kOutcomes) {
    const auto count =
        std::count_if(data.chains.begin(), data.chains.end(), [&](const Chain& chain) {
          return step < chain.moves.size() && chain.moves[step].outcome == outcome;
        });
    if (count == 0) continue;
    text +=
        (text.empty() ? "" : ", ") + format("%d %s", static_cast<int>(count), to_string(outcome));
  }
  return text;
}

}  // namespace tenon::planner
