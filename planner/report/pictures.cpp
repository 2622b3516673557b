#include "planner/report/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "planner/report/touched.h"
#include "shared/base/text.h"
#include "shared/task/touched.h"

namespace tenon::planner {
namespace {

// Told apart by the colour-blind, too (Okabe and Ito, "Color universal design", 2008).
constexpr std::array<const char*, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                 "#cc79a7", "#e69f00", "#56b4e9"};

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

std::vector<Vector3> positions_m(const std::vector<Pose>& tools) {
  std::vector<Vector3> positions_m;
  positions_m.reserve(tools.size());
  for (const Pose& tool : tools) positions_m.push_back(tool.position_m);
  return positions_m;
}

std::string particle_paths(const ReportData& data, const Canvas& canvas) {
  std::string svg;
  for (std::size_t p = 0; p < data.chains.size(); ++p) {
    const std::vector<Vector3> path = path_of(data.chains[p]);
    svg += canvas.polyline(path, 2.5, "stroke='" + colour(p) + "' stroke-opacity='.8'");
    for (const Vector3& rest : path) svg += canvas.dot(rest, 3.5, "fill='" + colour(p) + "'");
    svg += canvas.dot(path.front(), 6.5, "fill='#fff' stroke='" + colour(p) + "'");
  }
  return svg;
}

}  // namespace

std::string surroundings(const Task& task, const Canvas& canvas, const drawing::View& view) {
  double depth_m = task.goal.position_m[view.along];
  if (view.along == 2) depth_m += kAboveFloor_m;
  std::string elsewhere;
  std::string cut;
  for (const Shape& shape : task.environment) {
    const std::string section = canvas.section(shape, depth_m, "fill='#8a8172'");
    cut += section;
    if (!section.empty()) continue;
    const bool floor = view.along == 2 && is_floor(shape, task.goal);
    elsewhere += canvas.shadow(shape, Pose{},
                               floor ? "fill='#f3efe6'" : "fill='#8a8172' fill-opacity='.12'");
  }
  return elsewhere + cut;
}

std::string part_at(const Task& task, const Canvas& canvas, const Pose& pose, const char* style) {
  std::string svg;
  for (const Shape& shape : task.held) svg += canvas.shadow(shape, pose, style);
  return svg;
}

std::string part_at_goal(const Task& task, const Canvas& canvas, const Pose& goal) {
  return part_at(task, canvas, goal, "fill='#009e73' fill-opacity='.2' stroke='#009e73'");
}

std::string overview(const ReportData& data, const drawing::View& view) {
  const Canvas canvas(view, data.task, tools_m(data));
  std::string svg =
      canvas.open("The plan, " + std::string(view.title)) + surroundings(data.task, canvas, view);
  svg += part_at(data.task, canvas, data.plan.start,
                 "fill='#0072b2' fill-opacity='.12' stroke='#0072b2'");
  svg += part_at_goal(data.task, canvas, data.plan.goal);
  for (const Draw& draw : data.validation.draws) {
    svg += canvas.polyline(path_of(draw.chain), 1.3, "stroke='#000' stroke-opacity='.06'");
    svg += canvas.dot(draw.chain.end().position_m, 1.5, "fill='#000' fill-opacity='.35'");
  }
  return svg + particle_paths(data, canvas) + "</svg>\n";
}

std::string run_overview(const ReportData& data, const std::vector<Pose>& tools,
                         const drawing::View& view) {
  std::vector<Vector3> way = positions_m(tools);
  std::vector<Vector3> all = tools_m(data);
  all.insert(all.end(), way.begin(), way.end());
  const Canvas canvas(view, data.task, all);
  return canvas.open("The run, " + std::string(view.title)) +
         surroundings(data.task, canvas, view) + part_at_goal(data.task, canvas, data.plan.goal) +
         part_at(data.task, canvas, tools.back(),
                 "fill='#0072b2' fill-opacity='.12' stroke='#0072b2'") +
         particle_paths(data, canvas) + canvas.polyline(way, 3.5, "stroke='#000'") + "</svg>\n";
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
  std::string svg =
      "<svg role='img' aria-label='Uncertainty after each step' width='1060' viewBox='0 0 1060 "
      "205'>\n";
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double u = nodes[i].uncertainty_m2;
    const double x = 30.0 + bar * static_cast<double>(i);
    svg += format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='%s'/>", x,
                  170.0 - height(u), 0.7 * bar, height(u), u <= wanted_m2 ? "#009e73" : "#d55e00");
    svg += format("<text x='%.1f' y='187' font-size='12'>%s</text>", x,
                  i == 0 ? "start" : format("step %zu", i - 1).c_str());
    svg += format("<text x='%.1f' y='%.1f' font-size='11'>%.1f mm</text>\n", x, 165.0 - height(u),
                  1e3 * std::sqrt(u));
  }
  svg += format(
      "<line x1='20' x2='1050' y1='%.1f' y2='%.1f' stroke='#009e73' "
      "stroke-dasharray='6 4'/>",
      170.0 - height(wanted_m2), 170.0 - height(wanted_m2));
  return svg + "</svg>\n<p>Root of u of the " +
         (data.is_baseline() ? "random starts" : "particles") +
         " on a logarithmic scale; the dashed line is what the goal demands.</p>\n";
}

}  // namespace tenon::planner
