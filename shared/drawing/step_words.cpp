#include "shared/drawing/step_words.h"

#include <cmath>

#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon::drawing {

std::string displacement_text(const Step& step) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    const double d = step.displacement[axis];
    // What the texts would round to nothing.
    if (std::abs(shown(d, axis)) < (axis < 3 ? 0.5 : 0.05)) continue;
    text += (text.empty() ? "" : ", ") +
            format(axis < 3 ? "%s %+.0f mm" : "%s %+.1f\u00b0", axis_name(axis), shown(d, axis));
  }
  return text;
}

}  // namespace tenon::drawing
