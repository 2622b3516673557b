#include "planner/html_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "planner/heuristics.h"
#include "planner/text.h"

namespace tenon::planner {
namespace {

constexpr std::array<const char*, 8> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                                 "#ff7f0e", "#17becf", "#8c564b", "#e377c2"};
// A direction counts as settled once its spread is below this part of what it was.
constexpr double kCollapsed = 0.2;
constexpr double kWorthTelling_m = 2e-3;

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return safe;
}

/// The belief after each number of steps, of the chain as planned.
struct Node {
  std::vector<Vector3> particles_m;
  Vector3 spread_m = Vector3::Zero();  ///< standard deviation an axis
  double uncertainty_m2 = 0.0;
};

std::vector<Node> nodes_of(const std::vector<Chain>& chains, const Task& task) {
  std::size_t count = chains.front().moves.size();
  for (const Chain& chain : chains) count = std::min(count, chain.moves.size());
  std::vector<Node> nodes;
  for (std::size_t i = 0; i <= count; ++i) {
    Belief belief;
    Node node;
    for (const Chain& chain : chains) {
      belief.particles.push_back({i == 0 ? chain.start.pose : chain.moves[i - 1].pose, {}, {}});
      node.particles_m.push_back(belief.particles.back().pose.position_m);
    }
    const Vector3 mean = mean_pose(belief).position_m;
    for (const Vector3& p : node.particles_m) node.spread_m += (p - mean).cwiseAbs2();
    node.spread_m = (node.spread_m / static_cast<double>(chains.size())).cwiseSqrt();
    node.uncertainty_m2 = uncertainty(belief, metric_of(task));
    nodes.push_back(node);
  }
  return nodes;
}

/// The plane that the page shows: x to the right, y up, in millimetres.
class Canvas {
 public:
  explicit Canvas(const Task& task, const Vector3& start) {
    grow(start);
    grow(task.goal.position_m);
    for (const Shape& shape : task.environment) {
      for (const Vector3& corner : footprint(shape, Pose{})) grow(corner);
    }
    low_ -= Eigen::Vector2d::Constant(0.02);
    high_ += Eigen::Vector2d::Constant(0.02);
  }

  [[nodiscard]] std::string open(int width_px) const {
    const Eigen::Vector2d size = 1e3 * (high_ - low_);
    return format("<svg width='%d' viewBox='%.1f %.1f %.1f %.1f'>\n", width_px, 1e3 * low_.x(),
                  -1e3 * high_.y(), size.x(), size.y());
  }

  /// Corners of a box, or a ring about a cylinder, as seen from above.
  static std::vector<Vector3> footprint(const Shape& shape, const Pose& frame) {
    std::vector<Vector3> corners;
    const Pose pose = compose(frame, shape.pose);
    const int count = shape.kind == Shape::Kind::kBox ? 4 : 24;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * M_PI * (i + 0.5) / count;
      const double reach = shape.kind == Shape::Kind::kBox ? std::sqrt(2.0) : 1.0;
      const Vector3 local(0.5 * reach * std::cos(angle) * shape.size_m.x(),
                          0.5 * reach * std::sin(angle) * shape.size_m.y(), 0.0);
      corners.push_back(pose.position_m + pose.orientation * local);
    }
    return corners;
  }

  static std::string point(const Vector3& p) {
    return format("%.2f,%.2f ", 1e3 * p.x(), -1e3 * p.y());
  }

  static std::string polygon(const std::vector<Vector3>& corners, const char* style) {
    std::string text = "<polygon points='";
    for (const Vector3& corner : corners) text += point(corner);
    return text + "' " + style + "/>\n";
  }

  static std::string polyline(const std::vector<Vector3>& points, const std::string& style) {
    std::string text = "<polyline fill='none' points='";
    for (const Vector3& p : points) text += point(p);
    return text + "' " + style + "/>\n";
  }

  static std::string dot(const Vector3& p, double radius_mm, const std::string& style) {
    return format("<circle cx='%.2f' cy='%.2f' r='%.1f' ", 1e3 * p.x(), -1e3 * p.y(), radius_mm) +
           style + "/>\n";
  }

 private:
  void grow(const Vector3& p) {
    low_ = low_.cwiseMin(p.head<2>());
    high_ = high_.cwiseMax(p.head<2>());
  }
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high_ = Eigen::Vector2d::Constant(-1e9);
};

class Report {
 public:
  Report(const Plan& plan, const Task& task, const Certification& certification,
         const Validation& validation)
      : plan_(plan),
        task_(task),
        chains_(certification.runs.front().chains),
        certified_(certification.holds()),
        validation_(validation),
        nodes_(nodes_of(chains_, task)),
        canvas_(task, plan.start.position_m) {}

  [[nodiscard]] std::string html() const {
    const std::string title = escaped(plan_.task_name) + ", start " + escaped(plan_.start_name);
    std::string page =
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>" + title +
        "</title>\n<style>body{font:15px/1.45 sans-serif;max-width:1100px;margin:24px auto;"
        "padding:0 16px;color:#222}h1{font-size:24px;margin-bottom:4px}h2{font-size:18px;"
        "margin:28px 0 8px}table{border-collapse:collapse;font-size:13px}td,th{border-bottom:1px "
        "solid #ddd;padding:3px 9px;text-align:left;vertical-align:top}th{background:#f4f4f4}"
        "figure{display:inline-block;width:200px;margin:0 12px 14px 0;vertical-align:top;"
        "font-size:12px}figcaption b{color:#b00}svg{background:#fff;display:block}"
        ".num{text-align:right}</style></head>\n<body>\n<h1>" +
        title + "</h1>\n" + verdict();
    page += "<h2>Seen from above</h2>\n" + overview();
    page += "<h2>Uncertainty over the steps</h2>\n" + uncertainty_chart();
    page +=
        "<h2>What each step does</h2>\n<p>Hollow dots: particles before the step, filled: after "
        "it. Red: a part that is touched. Bold: a direction whose uncertainty the step "
        "removes.</p>\n" +
        frames();
    page += "<h2>Steps</h2>\n" + table();
    return page + "</body></html>\n";
  }

 private:
  [[nodiscard]] std::string verdict() const {
    const Vector3 before = nodes_.front().spread_m;
    const Vector3 after = nodes_.back().spread_m;
    std::string text =
        format("<p>%zu steps bring the tool from an uncertainty of ", plan_.steps.size());
    text += spread_text(before) + " to " + spread_text(after) +
            format(" (standard deviations of the particles), within %.1f mm of the goal. ",
                   1e3 * plan_.goal_tolerance_m);
    text += format("In validation %u of %u random starts ended there. ", plan_.draws_at_goal,
                   plan_.draws);
    text += certified_ ? "Certified again for this report: the chain holds.</p>\n"
                       : "<b>Certified again for this report: the chain does NOT hold.</b></p>\n";
    return text;
  }

  [[nodiscard]] std::string spread_text(const Vector3& spread_m) const {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
      if ((plan_.coordinates >> axis & 1U) == 0) continue;
      text +=
          format("%s%s %.1f mm", text.empty() ? "" : ", ", axis_name(axis), 1e3 * spread_m[axis]);
    }
    return text;
  }

  /// What the part stands on rather than bumps into.
  [[nodiscard]] bool is_floor(const Shape& shape) const {
    return shape.pose.position_m.z() + 0.5 * shape.size_m.z() <= plan_.start.position_m.z() + 1e-3;
  }

  [[nodiscard]] std::string environment(const std::set<std::string>& touched) const {
    std::string svg;
    for (const bool floor : {true, false}) {
      for (const Shape& shape : task_.environment) {
        if (is_floor(shape) != floor) continue;
        const char* style = floor                          ? "fill='#f3efe6'"
                            : touched.contains(shape.name) ? "fill='#d33'"
                                                           : "fill='#8a8172'";
        svg += Canvas::polygon(Canvas::footprint(shape, Pose{}), style);
      }
    }
    return svg;
  }

  [[nodiscard]] std::string part_at(const Pose& pose, const char* style) const {
    std::string svg;
    for (const Shape& shape : task_.held) {
      svg += Canvas::polygon(Canvas::footprint(shape, pose), style);
    }
    return svg;
  }

  [[nodiscard]] static std::vector<Vector3> path_of(const Chain& chain) {
    std::vector<Vector3> path = {chain.start.pose.position_m};
    for (const GuardedMove::Result& move : chain.moves) path.push_back(move.pose.position_m);
    return path;
  }

  [[nodiscard]] std::string overview() const {
    std::string svg = canvas_.open(1060) + environment({});
    svg +=
        part_at(plan_.start, "fill='#1f77b4' fill-opacity='.12' stroke='#1f77b4' stroke-width='2'");
    svg +=
        part_at(plan_.goal, "fill='#2ca02c' fill-opacity='.2' stroke='#2ca02c' stroke-width='3'");
    for (const Draw& draw : validation_.draws) {
      svg += Canvas::polyline(path_of(draw.chain),
                              "stroke='#000' stroke-opacity='.08' stroke-width='1.5'");
    }
    for (std::size_t p = 0; p < chains_.size(); ++p) {
      const std::string colour = kColours[p % kColours.size()];
      const std::vector<Vector3> path = path_of(chains_[p]);
      svg += Canvas::polyline(path, "stroke='" + colour + "' stroke-width='3' stroke-opacity='.8'");
      for (const Vector3& rest : path) svg += Canvas::dot(rest, 4.0, "fill='" + colour + "'");
      svg += Canvas::dot(path.front(), 8.0, "fill='#fff' stroke-width='3' stroke='" + colour + "'");
    }
    svg += "</svg>\n";
    return svg +
           "<p>Blue: the part at its nominal start; green: at the goal. Coloured: the paths of "
           "the particles, from their hollow dots, as certified. Grey: " +
           std::to_string(validation_.draws.size()) + " random starts.</p>\n";
  }

  [[nodiscard]] std::string uncertainty_chart() const {
    // One bar a node, logarithmic from a hundredth of the goal's tolerance up.
    const double floor_m2 = 1e-2 * task_.goal_uncertainty_m2;
    const auto height = [&](double u_m2) {
      const double range =
          std::log10(std::max(nodes_.front().uncertainty_m2, 10.0 * floor_m2) / floor_m2);
      return 150.0 * std::clamp(std::log10(std::max(u_m2, floor_m2) / floor_m2) / range, 0.01, 1.0);
    };
    const double bar = 1000.0 / static_cast<double>(nodes_.size());
    std::string svg = "<svg width='1060' viewBox='0 0 1060 205'>\n";
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double u = nodes_[i].uncertainty_m2;
      const double x = 30.0 + bar * static_cast<double>(i);
      svg += format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='%s'/>", x,
                    170.0 - height(u), 0.7 * bar, height(u),
                    u <= task_.goal_uncertainty_m2 ? "#2ca02c" : "#c44");
      svg += format("<text x='%.1f' y='187' font-size='12'>%s</text>", x,
                    i == 0 ? "start" : format("step %zu", i - 1).c_str());
      svg += format("<text x='%.1f' y='%.1f' font-size='11'>%.1f mm</text>\n", x, 165.0 - height(u),
                    1e3 * std::sqrt(u));
    }
    svg += format(
        "<line x1='20' x2='1050' y1='%.1f' y2='%.1f' stroke='#2ca02c' "
        "stroke-dasharray='6 4'/>",
        170.0 - height(task_.goal_uncertainty_m2), 170.0 - height(task_.goal_uncertainty_m2));
    return svg +
           "</svg>\n<p>Root of u on a logarithmic scale; the dashed line is what the goal "
           "demands.</p>\n";
  }

  /// The environment's shapes that any particle touches after the step.
  [[nodiscard]] std::set<std::string> touched_after(std::size_t step) const {
    std::set<std::string> names;
    for (const Shape& shape : task_.environment) {
      if (is_floor(shape)) continue;
      for (const Chain& chain : chains_) {
        for (const std::string& pair : chain.touching[step]) {
          if (pair.ends_with("-" + shape.name)) names.insert(shape.name);
        }
      }
    }
    return names;
  }

  [[nodiscard]] std::string displacement_text(std::size_t step) const {
    std::string text;
    for (int axis = 0; axis < 6; ++axis) {
      const double d = plan_.steps[step].displacement[axis];
      if (d == 0.0) continue;
      text += (text.empty() ? "" : ", ") +
              (axis < 3 ? format("%s %+.0f mm", axis_name(axis), 1e3 * d)
                        : format("%s %+.1f deg", axis_name(axis), shown(d, axis)));
    }
    return text;
  }

  [[nodiscard]] std::string collapse_text(std::size_t step) const {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
      const double before = nodes_[step].spread_m[axis];
      const double after = nodes_[step + 1].spread_m[axis];
      if (before - after < kWorthTelling_m) continue;
      const std::string shrink =
          format("%s %.1f &rarr; %.1f mm", axis_name(axis), 1e3 * before, 1e3 * after);
      text += "<br>" + (after < kCollapsed * before ? "<b>" + shrink + "</b>" : shrink);
    }
    return text;
  }

  [[nodiscard]] std::string outcomes_text(std::size_t step) const {
    std::string text;
    for (const Outcome outcome : kOutcomes) {
      const auto count = std::count_if(chains_.begin(), chains_.end(), [&](const Chain& chain) {
        return chain.moves[step].outcome == outcome;
      });
      if (count == 0) continue;
      text +=
          (text.empty() ? "" : ", ") + format("%d %s", static_cast<int>(count), to_string(outcome));
    }
    return text;
  }

  [[nodiscard]] std::string frames() const {
    std::string html;
    for (std::size_t step = 0; step + 1 < nodes_.size(); ++step) {
      std::string svg = canvas_.open(200) + environment(touched_after(step));
      svg += part_at(plan_.goal, "fill='none' stroke='#2ca02c' stroke-width='5'");
      for (std::size_t p = 0; p < chains_.size(); ++p) {
        const std::string colour = kColours[p % kColours.size()];
        const Vector3& from = nodes_[step].particles_m[p];
        const Vector3& to = nodes_[step + 1].particles_m[p];
        svg += part_at(chains_[p].moves[step].pose,
                       "fill='#000' fill-opacity='.05' stroke='#555' stroke-width='2'");
        svg += Canvas::polyline({from, to}, "stroke-width='8' stroke='" + colour + "'");
        svg += Canvas::dot(from, 12.0, "fill='#fff' stroke-width='5' stroke='" + colour + "'");
        svg += Canvas::dot(to, 13.0, "fill='" + colour + "'");
      }
      std::string touched;
      for (const std::string& name : touched_after(step)) {
        touched += (touched.empty() ? "" : ", ") + escaped(name);
      }
      html += "<figure>" + svg + "</svg><figcaption>" + format("step %zu: ", step) +
              displacement_text(step) + "<br>" + outcomes_text(step) +
              (touched.empty() ? "" : "<br>touches " + touched) + collapse_text(step) +
              "</figcaption></figure>\n";
    }
    return html;
  }

  [[nodiscard]] std::string rule_text(const OutcomeRule& rule) const {
    std::string text;
    for (int axis = 0; axis < 6; ++axis) {
      if ((plan_.coordinates >> axis & 1U) == 0) continue;
      text += format("%s %.1f to %.1f ", axis_name(axis),
                     shown(rule.envelope.travelled_min[axis], axis),
                     shown(rule.envelope.travelled_max[axis], axis));
    }
    text += "; contacts " + to_string(rule.envelope.always);
    if (rule.envelope.possible != rule.envelope.always) {
      text += " (possible " + to_string(rule.envelope.possible) + ")";
    }
    return text + (rule.successor == kSuccessorDone
                       ? "; done"
                       : format("; to step %d", static_cast<int>(rule.successor)));
  }

  [[nodiscard]] std::string table() const {
    std::string html =
        "<table><tr><th>Step</th><th>Displacement</th><th>Slow from (mm)</th>"
        "<th>Outcome</th><th>Expected travel (mm, deg), contacts, next</th></tr>\n";
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
      bool first = true;
      for (const Outcome outcome : kOutcomes) {
        const OutcomeRule& rule = plan_.steps[i].rule(outcome);
        if (rule.successor == kSuccessorFail) continue;
        html += first ? format("<tr><td>%zu</td><td>%s</td><td class='num'>%.0f</td>", i,
                               displacement_text(i).c_str(), 1e3 * plan_.steps[i].slow_from_m)
                      : "<tr><td></td><td></td><td></td>";
        html += format("<td>%s</td><td>", to_string(outcome)) + rule_text(rule) + "</td></tr>\n";
        first = false;
      }
    }
    return html + "</table>\n<p>Any other outcome, travel or contact stops the execution.</p>\n";
  }

  const Plan& plan_;
  const Task& task_;
  const std::vector<Chain>& chains_;
  bool certified_;
  const Validation& validation_;
  std::vector<Node> nodes_;
  Canvas canvas_;
};

}  // namespace

std::string html_report(const Plan& plan, const Task& task, const Certification& certification,
                        const Validation& validation) {
  return Report(plan, task, certification, validation).html();
}

}  // namespace tenon::planner
