#include "planner/report/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "planner/report/touched.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

constexpr std::array<const char*, 8> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                                 "#ff7f0e", "#17becf", "#8c564b", "#e377c2"};

std::string colour(std::size_t particle) { return kColours[particle % kColours.size()]; }

std::vector<Vector3> path_of(const Chain& chain) {
  std::vector<Vector3> path;
  for (std::size_t i = 0; i <= chain.moves.size(); ++i) path.push_back(chain.tool(i).position_m);
  return path;
}

/// The nominal start, and wherever a step takes a particle.
std::vector<Vector3> tools_m(const ReportData& data) {
  std::vector<Vector3> tools_m = {data.plan.start.position_m};
  for (const Chain& chain : data.chains) {
    for (const Vector3& tool_m : path_of(chain)) tools_m.push_back(tool_m);
  }
  return tools_m;
}

/// Filled where the plane through the goal cuts it; in outline what stands elsewhere.
std::string environment(const ReportData& data, const Canvas& canvas, const drawing::View& view,
                        const std::set<std::string>& touched) {
  double depth_m = data.plan.goal.position_m[view.along];
  if (view.along == 2) depth_m += kAboveFloor_m;
  std::string elsewhere;
  std::string cut;
  for (const Shape& shape : data.task.environment) {
    const bool red = touched.contains(shape.name);
    const std::string section =
        canvas.section(shape, depth_m, red ? "fill='#d33'" : "fill='#8a8172'");
    cut += section;
    if (!section.empty()) continue;
    const bool floor = view.along == 2 && is_floor(shape, data.plan);
    elsewhere += canvas.shadow(shape, Pose{},
                               floor ? "fill='#f3efe6'"
                               : red ? "fill='#d33' fill-opacity='.25'"
                                     : "fill='#8a8172' fill-opacity='.12'");
  }
  return elsewhere + cut;
}

std::string part_at(const Task& task, const Canvas& canvas, const Pose& pose, const char* style) {
  std::string svg;
  for (const Shape& shape : task.held) svg += canvas.shadow(shape, pose, style);
  return svg;
}

}  // namespace

std::string overview(const ReportData& data, const drawing::View& view) {
  const Canvas canvas(view, data.task, tools_m(data));
  std::string svg = canvas.open(1060) + environment(data, canvas, view, {});
  svg += part_at(data.task, canvas, data.plan.start,
                 "fill='#1f77b4' fill-opacity='.12' stroke='#1f77b4'");
  svg += part_at(data.task, canvas, data.plan.goal,
                 "fill='#2ca02c' fill-opacity='.2' stroke='#2ca02c'");
  for (const Draw& draw : data.validation.draws) {
    svg += canvas.polyline(path_of(draw.chain), 1.3, "stroke='#000' stroke-opacity='.06'");
    svg += canvas.dot(draw.chain.end().position_m, 1.5, "fill='#000' fill-opacity='.35'");
  }
  for (std::size_t p = 0; p < data.chains.size(); ++p) {
    const std::vector<Vector3> path = path_of(data.chains[p]);
    svg += canvas.polyline(path, 2.5, "stroke='" + colour(p) + "' stroke-opacity='.8'");
    for (const Vector3& rest : path) svg += canvas.dot(rest, 3.5, "fill='" + colour(p) + "'");
    svg += canvas.dot(path.front(), 6.5, "fill='#fff' stroke='" + colour(p) + "'");
  }
  return svg + "</svg>\n";
}

std::string step_picture(const ReportData& data, const drawing::View& view, std::size_t step) {
  const Canvas canvas(view, data.task, tools_m(data));
  std::string svg = canvas.open(200) + environment(data, canvas, view, touched_after(data, step));
  svg += part_at(data.task, canvas, data.plan.goal, "fill='none' stroke='#2ca02c'");
  for (std::size_t p = 0; p < data.chains.size(); ++p) {
    const Chain& chain = data.chains[p];
    const Pose from = chain.tool(step);
    const Pose to = chain.tool(step + 1);
    svg += part_at(data.task, canvas, to, "fill='#000' fill-opacity='.05' stroke='#555'");
    svg += canvas.polyline({from.position_m, to.position_m}, 7.0, "stroke='" + colour(p) + "'");
    svg += canvas.dot(from.position_m, 11.0, "fill='#fff' stroke='" + colour(p) + "'");
    svg += canvas.dot(to.position_m, 12.0, "fill='" + colour(p) + "'");
  }
  return svg + "</svg>";
}

std::string uncertainty_chart(const ReportData& data) {
  const std::vector<BeliefNode>& nodes = data.nodes;
  if (nodes.empty()) return "<p>No random start went through all steps.</p>\n";
  // One bar a node, logarithmic from a hundredth of the goal's tolerance up.
  const double wanted_m2 = data.task.goal_uncertainty_m2;
  const double floor_m2 = 1e-2 * wanted_m2;
  const auto height = [&](double u_m2) {
    const double range =
        std::log10(std::max(nodes.front().uncertainty_m2, 10.0 * floor_m2) / floor_m2);
    return 150.0 * std::clamp(std::log10(std::max(u_m2, floor_m2) / floor_m2) / range, 0.01, 1.0);
  };
  const double bar = 1000.0 / static_cast<double>(nodes.size());
  std::string svg = "<svg width='1060' viewBox='0 0 1060 205'>\n";
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double u = nodes[i].uncertainty_m2;
    const double x = 30.0 + bar * static_cast<double>(i);
    svg += format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='%s'/>", x,
                  170.0 - height(u), 0.7 * bar, height(u), u <= wanted_m2 ? "#2ca02c" : "#c44");
    svg += format("<text x='%.1f' y='187' font-size='12'>%s</text>", x,
                  i == 0 ? "start" : format("step %zu", i - 1).c_str());
    svg += format("<text x='%.1f' y='%.1f' font-size='11'>%.1f mm</text>\n", x, 165.0 - height(u),
                  1e3 * std::sqrt(u));
  }
  svg += format(
      "<line x1='20' x2='1050' y1='%.1f' y2='%.1f' stroke='#2ca02c' "
      "stroke-dasharray='6 4'/>",
      170.0 - height(wanted_m2), 170.0 - height(wanted_m2));
  return svg + "</svg>\n<p>Root of u of the " +
         (data.is_baseline() ? "random starts" : "particles") +
         " on a logarithmic scale; the dashed line is what the goal demands.</p>\n";
}

}  // namespace tenon::planner
