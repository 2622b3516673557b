#pragma once
// A figure in SVG: a frame with ticks, and marks in the units of what is plotted. Private to
// sim/evaluation.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shared/drawing/view.h"

namespace tenon::sim {

using drawing::Point;

class Plot {
 public:
  struct Axis {
    double low = 0.0;
    double high = 1.0;
    std::string label;
    bool powers_of_ten = false;  ///< low and high are exponents, and ticks stand at whole ones
  };

  /// Both axes to their own scale.
  Plot(int width_px, int height_px, const Axis& right, const Axis& up);
  /// One scale for both: the width decides, and the height follows, up to a bound beyond which the
  /// figure is narrowed instead.
  static Plot to_scale(int width_px, int height_max_px, const Axis& right, const Axis& up);

  [[nodiscard]] double px_per_unit() const { return scale_.x(); }

  // Styles are SVG attributes.
  void polygon(const std::vector<Point>& corners, std::string_view style);
  void line(const Point& from, const Point& to, std::string_view style);
  /// Many at once.
  void lines(const std::vector<std::pair<Point, Point>>& lines, std::string_view style);
  void dots(const std::vector<Point>& at, double diameter_px, std::string_view colour);
  /// Reaches in units: an ellipse where the axes' scales differ.
  void circle(const Point& centre, const Point& reach, std::string_view style);
  /// Each with what a pointer over it shows.
  void crosses(const std::vector<std::pair<Point, std::string>>& at, double size_px,
               std::string_view colour);
  void rectangle(const Point& low, const Point& high, std::string_view style,
                 std::string_view title = {});
  void text(const Point& at, std::string_view text, std::string_view style);

  /// Everything with frame, ticks and labels. @param title what it shows, for who cannot see it
  [[nodiscard]] std::string svg(const std::string& title) const;

 private:
  Plot(Axis right, Axis up, const Point& scale);
  [[nodiscard]] Point px(const Point& point) const;
  [[nodiscard]] std::string ticks() const;

  Axis right_;
  Axis up_;
  Point scale_;  ///< px per unit
  Point size_px_;
  std::string marks_;
};

}  // namespace tenon::sim
