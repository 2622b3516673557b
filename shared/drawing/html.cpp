#include "shared/drawing/html.h"

#include "shared/base/text.h"

namespace tenon::drawing {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '>') {
      safe += "&gt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else if (c == '\'') {
      safe += "&#39;";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string figure(const std::string& svg, const std::string& caption) {
  return "<figure>" + svg + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string polygon(const std::vector<Point>& points, int decimals, std::string_view attributes) {
  return "<polygon points='" + points_text(points, decimals) + "' " + std::string(attributes) +
         "/>\n";
}

std::string points_text(const std::vector<Point>& points, int decimals) {
  std::string text;
  for (const Point& p : points) text += format("%.*f,%.*f ", decimals, p.x(), decimals, p.y());
  return text;
}

}  // namespace tenon::drawing
