#include "planner/html_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <vector>

#include "planner/heuristics.h"
#include "planner/report_canvas.h"
#include "planner/summary.h"
#include "planner/text.h"

namespace tenon::planner {
namespace {

constexpr std::array<const char*, 8> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd",
                                                 "#ff7f0e", "#17becf", "#8c564b", "#e377c2"};
// A direction counts as settled once its spread is below this part of what it was.
constexpr double kCollapsed = 0.2;
constexpr double kWorthTelling = 2e-3;  // m or rad
constexpr double kAboveFloor_m = 1e-3;  // where a section seen from above is cut, over the tip

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return safe;
}

std::string colour(std::size_t particle) { return kColours[particle % kColours.size()]; }

/// The belief after each number of steps.
struct Node {
  std::vector<Vector3> particles_m;
  Vector6 spread = Vector6::Zero();  ///< standard deviation an axis, m or rad
  double uncertainty_m2 = 0.0;
};

std::vector<Node> nodes_of(const std::vector<Chain>& chains, const Task& task) {
  std::vector<Node> nodes;
  if (chains.empty()) return nodes;
  std::size_t count = chains.front().moves.size();
  for (const Chain& chain : chains) count = std::min(count, chain.moves.size());
  for (std::size_t i = 0; i <= count; ++i) {
    Belief belief;
    Node node;
    for (const Chain& chain : chains) {
      belief.particles.push_back({i == 0 ? chain.start.pose : chain.moves[i - 1].pose, {}, {}});
      node.particles_m.push_back(belief.particles.back().pose.position_m);
    }
    const Pose mean = mean_pose(belief);
    for (const Particle& particle : belief.particles) {
      node.spread += displacement_between(mean, particle.pose).cwiseAbs2();
    }
    node.spread = (node.spread / static_cast<double>(chains.size())).cwiseSqrt();
    node.uncertainty_m2 = uncertainty(belief, metric_of(task));
    nodes.push_back(node);
  }
  return nodes;
}

/// The draws that went through the whole plan.
std::vector<Chain> finished(const Validation& validation) {
  std::vector<Chain> chains;
  for (const Draw& draw : validation.draws) {
    if (draw.chain.done) chains.push_back(draw.chain);
  }
  return chains;
}

std::string names_of(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + escaped(name);
  return text;
}

class Report {
 public:
  Report(const Plan& plan, const Task& task, const Certification& certification,
         const Validation& validation)
      : plan_(plan),
        task_(task),
        chains_(certification.runs.front().chains),
        certified_(certification.holds()),
        validation_(validation),
        // A single particle knows of no uncertainty; how uncertain it really is, draws tell.
        nodes_(nodes_of(is_baseline() ? finished(validation) : chains_, task)) {}

  [[nodiscard]] std::string html() const {
    const std::string title = escaped(plan_.task_name) + ", start " + escaped(plan_.start_name);
    std::string page =
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>" + title +
        "</title>\n<style>body{font:15px/1.45 sans-serif;max-width:1100px;margin:24px auto;"
        "padding:0 16px;color:#222}h1{font-size:24px;margin-bottom:4px}h2{font-size:18px;"
        "margin:28px 0 8px}table{border-collapse:collapse;font-size:13px}td,th{border-bottom:1px "
        "solid #ddd;padding:3px 9px;text-align:left;vertical-align:top}th{background:#f4f4f4}"
        "figure{display:inline-block;width:200px;margin:0 12px 14px 0;vertical-align:top;"
        "font-size:12px}svg{background:#fff;display:block;max-height:640px}.num{text-align:right}"
        "</style></head>\n<body>\n<h1>" +
        title + "</h1>\n" + verdict() + reasons();
    for (const View& view : views_of(plan_.coordinates)) {
      page += std::string("<h2>") + view.title + "</h2>\n" + overview(view);
    }
    page +=
        "<p>Blue: the part at its nominal start; green: at the goal. Coloured: the paths of the "
        "particles, from their hollow dots, as certified. Grey: " +
        std::to_string(validation_.draws.size()) + " random starts.</p>\n";
    page += "<h2>Uncertainty over the steps</h2>\n" + uncertainty_chart();
    page +=
        "<h2>What each step does</h2>\n<p>Hollow dots: particles before the step, filled: after "
        "it. Red: what is touched. Bold: a direction whose uncertainty the step removes.</p>\n" +
        frames();
    page += "<h2>Steps</h2>\n" + table();
    return page + "</body></html>\n";
  }

 private:
  [[nodiscard]] bool is_baseline() const { return plan_.method != PlanMethod::kMha; }

  [[nodiscard]] std::string verdict() const {
    std::string text = "<p>";
    if (is_baseline()) {
      text += format(
          "%zu steps by the baseline <b>%s</b>, which plans for the nominal start alone. It ends "
          "there within %.1f mm of the goal. ",
          plan_.steps.size(), to_string(plan_.method), 1e3 * plan_.goal_tolerance_m);
    } else {
      text += format("%zu steps bring the tool from an uncertainty of ", plan_.steps.size()) +
              spread_text(nodes_.front().spread) + " to " + spread_text(nodes_.back().spread) +
              format(" (standard deviations of the particles), within %.1f mm of the goal. ",
                     1e3 * plan_.goal_tolerance_m);
    }
    text += format("In validation %u of %u random starts ended there; repeated for this page: ",
                   plan_.draws_at_goal, plan_.draws) +
            estimate_text(validation_, task_) + ". ";
    return text + (certified_
                       ? "Certified again for this page: the chain holds.</p>\n"
                       : "<b>Certified again for this page: the chain does NOT hold.</b></p>\n");
  }

  /// Each direction that contact settles, and with what.
  [[nodiscard]] std::string reasons() const {
    std::string items;
    for (int axis = 0; axis < 6 && !is_baseline(); ++axis) {
      const double before = nodes_.front().spread[axis];
      const double after = nodes_.back().spread[axis];
      if (before < kWorthTelling || after > kCollapsed * before) continue;
      std::set<std::string> touched;
      std::string steps;
      for (std::size_t step = 0; step + 1 < nodes_.size(); ++step) {
        const double settled = nodes_[step].spread[axis] - nodes_[step + 1].spread[axis];
        if (settled < kWorthTelling) continue;
        touched.merge(found_or_lost(step));
        steps += format("%s%zu", steps.empty() ? "" : ", ", step);
      }
      items += "<li>" + std::string(axis_name(axis)) + " " + amount(before, axis) + " &rarr; " +
               amount(after, axis) + ": contact with " + names_of(touched) +
               " begins or ends, in steps " + steps + "</li>\n";
    }
    if (items.empty()) return {};
    return "<p>Why it works: wherever the tool starts, contact puts it at a known place "
           "(standard deviations at the start and at the end).</p>\n<ul>\n" +
           items + "</ul>\n";
  }

  [[nodiscard]] static std::string amount(double value, int axis) {
    return format(axis < 3 ? "%.1f mm" : "%.2f&deg;", shown(value, axis));
  }

  [[nodiscard]] std::string spread_text(const Vector6& spread) const {
    std::string text;
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(plan_.coordinates, axis)) continue;
      text += (text.empty() ? "" : ", ") + std::string(axis_name(axis)) + " " +
              amount(spread[axis], axis);
    }
    return text;
  }

  /// What the part stands on rather than bumps into.
  [[nodiscard]] bool is_floor(const Shape& shape) const {
    return shape.pose.position_m.z() + 0.5 * shape.size_m.z() <=
           plan_.goal.position_m.z() + kAboveFloor_m;
  }

  /// Filled where the plane through the goal cuts it; in outline what stands elsewhere.
  /// The nominal start, and wherever a step takes a particle.
  [[nodiscard]] std::vector<Vector3> tools_m() const {
    std::vector<Vector3> tools_m = {plan_.start.position_m};
    for (const Chain& chain : chains_) {
      for (const GuardedMove::Result& move : chain.moves) tools_m.push_back(move.pose.position_m);
    }
    return tools_m;
  }

  [[nodiscard]] std::string environment(const Canvas& canvas, const View& view,
                                        const std::set<std::string>& touched) const {
    double depth_m = plan_.goal.position_m[view.along];
    if (view.along == 2) depth_m += kAboveFloor_m;
    std::string elsewhere;
    std::string cut;
    for (const Shape& shape : task_.environment) {
      const bool red = touched.contains(shape.name);
      const std::string section =
          canvas.section(shape, depth_m, red ? "fill='#d33'" : "fill='#8a8172'");
      cut += section;
      if (!section.empty()) continue;
      const bool floor = view.along == 2 && is_floor(shape);
      elsewhere += canvas.shadow(shape, Pose{},
                                 floor ? "fill='#f3efe6'"
                                 : red ? "fill='#d33' fill-opacity='.25'"
                                       : "fill='#8a8172' fill-opacity='.12'");
    }
    return elsewhere + cut;
  }

  [[nodiscard]] std::string part_at(const Canvas& canvas, const Pose& pose,
                                    const char* style) const {
    std::string svg;
    for (const Shape& shape : task_.held) svg += canvas.shadow(shape, pose, style);
    return svg;
  }

  [[nodiscard]] static std::vector<Vector3> path_of(const Chain& chain) {
    std::vector<Vector3> path = {chain.start.pose.position_m};
    for (const GuardedMove::Result& move : chain.moves) path.push_back(move.pose.position_m);
    return path;
  }

  [[nodiscard]] std::string overview(const View& view) const {
    const Canvas canvas(view, task_, tools_m());
    std::string svg = canvas.open(1060) + environment(canvas, view, {});
    svg += part_at(canvas, plan_.start, "fill='#1f77b4' fill-opacity='.12' stroke='#1f77b4'");
    svg += part_at(canvas, plan_.goal, "fill='#2ca02c' fill-opacity='.2' stroke='#2ca02c'");
    for (const Draw& draw : validation_.draws) {
      svg += canvas.polyline(path_of(draw.chain), 1.3, "stroke='#000' stroke-opacity='.06'");
      svg += canvas.dot(draw.chain.end().position_m, 1.5, "fill='#000' fill-opacity='.35'");
    }
    for (std::size_t p = 0; p < chains_.size(); ++p) {
      const std::vector<Vector3> path = path_of(chains_[p]);
      svg += canvas.polyline(path, 2.5, "stroke='" + colour(p) + "' stroke-opacity='.8'");
      for (const Vector3& rest : path) svg += canvas.dot(rest, 3.5, "fill='" + colour(p) + "'");
      svg += canvas.dot(path.front(), 6.5, "fill='#fff' stroke='" + colour(p) + "'");
    }
    return svg + "</svg>\n";
  }

  [[nodiscard]] std::string uncertainty_chart() const {
    if (nodes_.empty()) return "<p>No random start went through all steps.</p>\n";
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
    return svg + "</svg>\n<p>Root of u of the " + (is_baseline() ? "random starts" : "particles") +
           " on a logarithmic scale; the dashed line is what the goal demands.</p>\n";
  }

  /// What a particle touches after its move, of what it may bump into.
  [[nodiscard]] std::set<std::string> touched_by(const Chain& chain, std::size_t move) const {
    std::set<std::string> names;
    for (const Shape& shape : task_.environment) {
      if (is_floor(shape) && (plan_.coordinates >> 2 & 1U) == 0) continue;
      for (const std::string& pair : chain.touching[move]) {
        if (pair.ends_with("-" + shape.name)) names.insert(shape.name);
      }
    }
    return names;
  }

  [[nodiscard]] std::set<std::string> touched_after(std::size_t step) const {
    std::set<std::string> names;
    for (const Chain& chain : chains_) names.merge(touched_by(chain, step));
    return names;
  }

  /// What some particle touches after the step and did not before, or the other way round.
  [[nodiscard]] std::set<std::string> found_or_lost(std::size_t step) const {
    std::set<std::string> names;
    for (const Chain& chain : chains_) {
      const std::set<std::string> now = touched_by(chain, step);
      const std::set<std::string> before =
          step == 0 ? std::set<std::string>{} : touched_by(chain, step - 1);
      std::set_symmetric_difference(now.begin(), now.end(), before.begin(), before.end(),
                                    std::inserter(names, names.end()));
    }
    return names;
  }

  [[nodiscard]] std::string displacement_text(std::size_t step) const {
    std::string text;
    for (int axis = 0; axis < 6; ++axis) {
      const double d = plan_.steps[step].displacement[axis];
      if (d == 0.0) continue;
      text += (text.empty() ? "" : ", ") +
              format(axis < 3 ? "%s %+.0f mm" : "%s %+.1f&deg;", axis_name(axis), shown(d, axis));
    }
    return text;
  }

  /// A direction that a step makes more certain.
  struct Shrinkage {
    std::string text;
    bool collapsed = false;
  };

  [[nodiscard]] std::vector<Shrinkage> shrinkages(std::size_t step) const {
    std::vector<Shrinkage> found;
    if (step + 1 >= nodes_.size()) return found;
    for (int axis = 0; axis < 6; ++axis) {
      const double before = nodes_[step].spread[axis];
      const double after = nodes_[step + 1].spread[axis];
      if (before - after < kWorthTelling) continue;
      found.push_back({std::string(axis_name(axis)) + " " + amount(before, axis) + " &rarr; " +
                           amount(after, axis),
                       after < kCollapsed * before});
    }
    return found;
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

  [[nodiscard]] std::string frame(const Canvas& canvas, const View& view, std::size_t step) const {
    std::string svg = canvas.open(200) + environment(canvas, view, touched_after(step));
    svg += part_at(canvas, plan_.goal, "fill='none' stroke='#2ca02c'");
    for (std::size_t p = 0; p < chains_.size(); ++p) {
      const Chain& chain = chains_[p];
      const Pose& from = step == 0 ? chain.start.pose : chain.moves[step - 1].pose;
      const Pose& to = chain.moves[step].pose;
      svg += part_at(canvas, to, "fill='#000' fill-opacity='.05' stroke='#555'");
      svg += canvas.polyline({from.position_m, to.position_m}, 7.0, "stroke='" + colour(p) + "'");
      svg += canvas.dot(from.position_m, 11.0, "fill='#fff' stroke='" + colour(p) + "'");
      svg += canvas.dot(to.position_m, 12.0, "fill='" + colour(p) + "'");
    }
    return svg + "</svg>";
  }

  [[nodiscard]] std::string frames() const {
    std::size_t steps = plan_.steps.size();
    for (const Chain& chain : chains_) steps = std::min(steps, chain.moves.size());
    std::string html;
    for (std::size_t step = 0; step < steps; ++step) {
      html += "<figure>";
      for (const View& view : views_of(plan_.coordinates)) {
        html += frame(Canvas(view, task_, tools_m()), view, step);
      }
      const std::set<std::string> touched = touched_after(step);
      html += format("<figcaption>step %zu: ", step) + displacement_text(step) + "<br>" +
              outcomes_text(step) + (touched.empty() ? "" : "<br>touches " + names_of(touched));
      for (const Shrinkage& shrinkage : shrinkages(step)) {
        html += "<br>" + (shrinkage.collapsed ? "<b>" + shrinkage.text + "</b>" : shrinkage.text);
      }
      html += "</figcaption></figure>\n";
    }
    return html;
  }

  [[nodiscard]] std::string envelope_text(const OutcomeRule& rule) const {
    if (!plan_.check_envelopes) return "not checked";
    std::string text;
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(plan_.coordinates, axis)) continue;
      text += format("%s%s %.1f to %.1f", text.empty() ? "" : ", ", axis_name(axis),
                     shown(rule.envelope.travelled_min[axis], axis),
                     shown(rule.envelope.travelled_max[axis], axis));
    }
    text += "; contacts " + to_string(rule.envelope.always);
    if (rule.envelope.possible != rule.envelope.always) {
      text += " (possible " + to_string(rule.envelope.possible) + ")";
    }
    return text;
  }

  [[nodiscard]] std::string table() const {
    std::string html =
        "<table><tr><th>Step</th><th>Displacement</th><th>Slow from (mm)</th>"
        "<th>Outcome</th><th>Expected travel (mm, deg) and contacts</th><th>Next</th></tr>\n";
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
      bool first = true;
      for (const Outcome outcome : kOutcomes) {
        const OutcomeRule& rule = plan_.steps[i].rule(outcome);
        if (rule.successor == kSuccessorFail) continue;
        html += first ? format("<tr><td>%zu</td><td>%s</td><td class='num'>%.0f</td>", i,
                               displacement_text(i).c_str(), 1e3 * plan_.steps[i].slow_from_m)
                      : "<tr><td></td><td></td><td></td>";
        html += format("<td>%s</td><td>", to_string(outcome)) + envelope_text(rule) + "</td><td>" +
                (rule.successor == kSuccessorDone ? std::string("done")
                                                  : std::to_string(rule.successor)) +
                "</td></tr>\n";
        first = false;
      }
    }
    return html + "</table>\n<p>Any other outcome" +
           (plan_.check_envelopes ? ", travel or contact" : "") + " stops the execution.</p>\n";
  }

  const Plan& plan_;
  const Task& task_;
  const std::vector<Chain>& chains_;
  bool certified_;
  const Validation& validation_;
  std::vector<Node> nodes_;  // empty where no chain went through
};

}  // namespace

std::string html_report(const Plan& plan, const Task& task, const Certification& certification,
                        const Validation& validation) {
  return Report(plan, task, certification, validation).html();
}

}  // namespace tenon::planner
