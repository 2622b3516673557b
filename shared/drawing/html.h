#pragma once
// Elements of HTML and SVG. Pure; any thread.

#include <string>
#include <string_view>
#include <vector>

#include "shared/drawing/view.h"

namespace tenon::drawing {

/// `&`, `<`, `>` and `'` as HTML and SVG have them.
[[nodiscard]] std::string escaped(std::string_view text);

/// A figure element on a line of its own.
[[nodiscard]] std::string figure(const std::string& svg, const std::string& caption);

/// A polygon element on a line of its own.
/// @param points in the picture's units, y downwards
/// @param decimals that are written
/// @param attributes of SVG, such as "fill='#fff'"
[[nodiscard]] std::string polygon(const std::vector<Point>& points, int decimals,
                                  std::string_view attributes);

/// "1.25,-3.00 " for each point: what polygons and polylines go along.
[[nodiscard]] std::string points_text(const std::vector<Point>& points, int decimals);

}  // namespace tenon::drawing
