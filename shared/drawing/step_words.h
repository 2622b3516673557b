#pragma once
// A step of a plan in words. Pure; any thread.

#include <string>

#include "shared/plan/plan.h"

namespace tenon::drawing {

/// "x +100 mm, rz -2.0°": the axes along which it would show. As it is in HTML.
[[nodiscard]] std::string displacement_text(const Step& step);

}  // namespace tenon::drawing
