#include "sim/evaluation/plot.h"

#include <array>
#include <cmath>
#include <utility>

#include "shared/base/text.h"
#include "shared/drawing/html.h"

namespace tenon::sim {
namespace {

constexpr double kLeft_px = 74.0;
constexpr double kRight_px = 20.0;
constexpr double kTop_px = 10.0;
constexpr double kBottom_px = 42.0;
constexpr double kTick_px = 70.0;  ///< from one to the next, about

Point extent(const Plot::Axis& right, const Plot::Axis& up) {
  return {right.high - right.low, up.high - up.low};
}

int ticks_on(const Plot::Axis& axis, double step) {
  return static_cast<int>(std::floor(axis.high / step + 1e-9) - std::ceil(axis.low / step - 1e-9)) +
         1;
}

/// 1, 2 or 5 times a power of ten: the least that is wide enough, or so many as tell a scale.
double tick_step(const Plot::Axis& axis, double px_per_unit) {
  constexpr int kTicksMin = 3;
  constexpr std::array<double, 7> kFactors = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};
  if (axis.powers_of_ten) return 1.0;
  const double wanted = kTick_px / px_per_unit;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  double step = kFactors.front() * power;
  for (const double factor : kFactors) {
    if (ticks_on(axis, factor * power) < kTicksMin) break;
    step = factor * power;
    if (step >= wanted) break;
  }
  return step;
}

std::string tick_text(const Plot::Axis& axis, double value) {
  return format("%.6g", axis.powers_of_ten ? std::pow(10.0, value) : value + 0.0);  // no -0
}

}  // namespace

Plot::Plot(Axis right, Axis up, const Point& scale)
    : right_(std::move(right)),
      up_(std::move(up)),
      scale_(scale),
      size_px_(extent(right_, up_).cwiseProduct(scale_)) {}

Plot::Plot(int width_px, int height_px, const Axis& right, const Axis& up)
    : Plot(right, up,
           Point(width_px - kLeft_px - kRight_px, height_px - kTop_px - kBottom_px)
               .cwiseQuotient(extent(right, up))) {}

Plot Plot::to_scale(int width_px, int height_max_px, const Axis& right, const Axis& up) {
  const Point room(width_px - kLeft_px - kRight_px, height_max_px - kTop_px - kBottom_px);
  const double scale = room.cwiseQuotient(extent(right, up)).minCoeff();
  return {right, up, Point::Constant(scale)};
}

Point Plot::px(const Point& point) const {
  return {kLeft_px + scale_.x() * (point.x() - right_.low),
          kTop_px + scale_.y() * (up_.high - point.y())};
}

void Plot::polygon(const std::vector<Point>& corners, std::string_view style) {
  std::vector<Point> on_page;
  on_page.reserve(corners.size());
  for (const Point& corner : corners) on_page.push_back(px(corner));
  marks_ += drawing::polygon(on_page, 1, style);
}

void Plot::line(const Point& from, const Point& to, std::string_view style) {
  lines({{from, to}}, style);
}

void Plot::lines(const std::vector<std::pair<Point, Point>>& lines, std::string_view style) {
  if (lines.empty()) return;
  marks_ += "<path fill='none' d='";
  const Point* last = nullptr;
  for (const auto& [from, to] : lines) {
    const Point a = px(from);
    const Point b = px(to);
    if (last == nullptr || *last != from) marks_ += format("M%.1f %.1f", a.x(), a.y());
    marks_ += format("L%.1f %.1f", b.x(), b.y());
    last = &to;
  }
  marks_ += "' " + std::string(style) + "/>\n";
}

void Plot::dots(const std::vector<Point>& at, double diameter_px, std::string_view colour) {
  if (at.empty()) return;
  marks_ += "<path d='";  // lines without length, with round ends
  for (const Point& point : at) {
    const Point p = px(point);
    marks_ += format("M%.1f %.1fh0", p.x(), p.y());
  }
  marks_ += format("' stroke-linecap='round' stroke-width='%.1f' stroke='", diameter_px) +
            std::string(colour) + "'/>\n";
}

void Plot::circle(const Point& centre, const Point& reach, std::string_view style) {
  const Point p = px(centre);
  const Point r = reach.cwiseProduct(scale_);
  marks_ +=
      format("<ellipse cx='%.1f' cy='%.1f' rx='%.1f' ry='%.1f' ", p.x(), p.y(), r.x(), r.y()) +
      std::string(style) + "/>\n";
}

void Plot::crosses(const std::vector<std::pair<Point, std::string>>& at, double size_px,
                   std::string_view colour) {
  if (at.empty()) return;
  marks_ += "<g stroke-width='2' stroke='" + std::string(colour) + "'>\n";
  for (const auto& [point, title] : at) {
    const Point p = px(point) - Point::Constant(0.5 * size_px);
    marks_ += format("<path d='M%.1f %.1fl%.1f %.1fm0 %.1fl%.1f %.1f'>", p.x(), p.y(), size_px,
                     size_px, -size_px, -size_px, size_px) +
              "<title>" + drawing::escaped(title) + "</title></path>\n";
  }
  marks_ += "</g>\n";
}

void Plot::rectangle(const Point& low, const Point& high, std::string_view style,
                     std::string_view title) {
  const Point a = px({low.x(), high.y()});
  const Point size = (high - low).cwiseProduct(scale_);
  marks_ += format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' ", a.x(), a.y(), size.x(),
                   size.y()) +
            std::string(style) + "><title>" + drawing::escaped(title) + "</title></rect>\n";
}

void Plot::text(const Point& at, std::string_view text, std::string_view style) {
  const Point p = px(at);
  marks_ += format("<text x='%.1f' y='%.1f' ", p.x(), p.y()) + std::string(style) + ">" +
            drawing::escaped(text) + "</text>\n";
}

std::string Plot::ticks() const {
  std::string svg;
  const auto each = [](const Axis& axis, double px_per_unit, const auto& draw) {
    const double step = tick_step(axis, px_per_unit);
    for (double i = std::ceil(axis.low / step - 1e-9); i * step <= axis.high + 1e-9 * step; ++i) {
      draw(i * step);
    }
  };
  const double right = kLeft_px + size_px_.x();
  const double bottom = kTop_px + size_px_.y();
  each(right_, scale_.x(), [&](double value) {
    const double x = px({value, 0.0}).x();
    svg += format(
               "<path class='tick' d='M%.1f %.1fv5'/><text x='%.1f' y='%.1f' "
               "text-anchor='middle'>",
               x, bottom, x, bottom + 18.0) +
           tick_text(right_, value) + "</text>\n";
  });
  each(up_, scale_.y(), [&](double value) {
    const double y = px({0.0, value}).y();
    svg += format(
               "<path class='tick' d='M%.1f %.1fh-5'/><text x='%.1f' y='%.1f' "
               "text-anchor='end'>",
               kLeft_px, y, kLeft_px - 8.0, y + 4.0) +
           tick_text(up_, value) + "</text>\n";
  });
  svg += format("<text class='label' x='%.1f' y='%.1f' text-anchor='middle'>",
                0.5 * (kLeft_px + right), bottom + 36.0) +
         drawing::escaped(right_.label) + "</text>\n";
  const double middle = 0.5 * (kTop_px + bottom);
  svg += format(
             "<text class='label' x='14' y='%.1f' text-anchor='middle' "
             "transform='rotate(-90 14 %.1f)'>",
             middle, middle) +
         drawing::escaped(up_.label) + "</text>\n";
  return svg;
}

std::string Plot::svg(const std::string& title) const {
  const double width = kLeft_px + size_px_.x() + kRight_px;
  const double height = kTop_px + size_px_.y() + kBottom_px;
  const std::string frame = format("x='%.1f' y='%.1f' width='%.1f' height='%.1f'", kLeft_px,
                                   kTop_px, size_px_.x(), size_px_.y());
  // The page's style sheet asks for the width where it shows the plot narrower.
  return format(
             "<svg width='%.0f' height='%.0f' viewBox='0 0 %.1f %.1f' role='img' "
             "style='--drawn-width:%.0f'>\n",
             width, height, width, height, width) +
         "<title>" + drawing::escaped(title) + "</title>\n<rect class='ground' " + frame + "/>\n" +
         format(
             "<svg x='%.1f' y='%.1f' width='%.1f' height='%.1f' viewBox='%.1f %.1f %.1f %.1f'>\n",
             kLeft_px, kTop_px, size_px_.x(), size_px_.y(), kLeft_px, kTop_px, size_px_.x(),
             size_px_.y()) +
         marks_ + "</svg>\n<rect class='frame' " + frame + "/>\n" + ticks() + "</svg>\n";
}

}  // namespace tenon::sim
