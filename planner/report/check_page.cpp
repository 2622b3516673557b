#include "planner/report/check_page.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/check/understood.h"
#include "planner/report/pictures.h"
#include "planner/report/report_canvas.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/page.h"
#include "shared/drawing/view.h"
#include "shared/task/find_start.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

std::string mm(const Vector3& v) {
  return format("(%.4g, %.4g, %.4g)", 1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z());
}

std::string row(const std::vector<std::string>& cells) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    html += (i == 0 ? "<th scope='row'>" : "<td>") + cells[i] + (i == 0 ? "</th>" : "</td>");
  }
  return html + "</tr>\n";
}

/// @param titles, rows HTML
std::string titled_table(const std::vector<std::string>& titles, const std::string& rows) {
  std::string html = "<div class='wide'><table><thead><tr>";
  for (const std::string& title : titles) html += "<th>" + title + "</th>";
  return html + "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string findings(const TaskCheck& check) {
  if (check.findings.empty()) {
    return "<ul class='badges'><li class='good'>Nothing stands against planning it</li></ul>\n";
  }
  std::string html = "<ul class='badges'>\n";
  for (const Finding& finding : check.findings) {
    html += "<li class='bad'>" + drawing::escaped(weight_text(finding.weight) + finding.text) +
            "</li>\n";
  }
  return html + "</ul>\n";
}

std::vector<Vector3> places_of(const Start& start, const StartCheck& checked) {
  std::vector<Vector3> places_m = {start.pose.position_m};
  for (const CheckedParticle& particle : checked.particles) {
    places_m.push_back(particle.tool.position_m);
  }
  for (const Touch& touch : checked.touches) {
    if (touch.in_legs) places_m.push_back(touch.tool.position_m);
  }
  return places_m;
}

// Turned light on a dark page as the pictures are (shared/drawing/page/page.css), it becomes pink.
// Chosen to be far from the other colours on either, and for eyes without red or without green.
constexpr const char* kInSomething = "fill='#770022' fill-opacity='.35' stroke='#770022'";

std::string picture(const Task& task, const Start& start, const StartCheck& checked, bool goal_free,
                    const drawing::View& view) {
  const Canvas canvas(view, task, places_of(start, checked));
  std::string svg = canvas.open("Start " + drawing::escaped(start.name) + ", " + view.title) +
                    surroundings(task, canvas, view);
  for (const CheckedParticle& particle : checked.particles) {
    svg += part_at(
        task, canvas, particle.tool,
        particle.free ? "fill='#d08a00' fill-opacity='.06' stroke='#d08a00'" : kInSomething);
  }
  svg +=
      part_at(task, canvas, start.pose,
              checked.free ? "fill='#0072b2' fill-opacity='.12' stroke='#0072b2'" : kInSomething);
  svg += goal_free ? part_at_goal(task, canvas, task.goal)
                   : part_at(task, canvas, task.goal, kInSomething);
  for (const Touch& touch : checked.touches) {
    if (!touch.in_legs || touch.axis == view.along) continue;
    svg += part_at(task, canvas, touch.tool, "fill='none' stroke='#d55e00' stroke-dasharray='8 5'");
  }
  for (const CheckedParticle& particle : checked.particles) {
    svg += canvas.dot(particle.tool.position_m, 4.5, "fill='#fff' stroke='#d08a00'");
  }
  return drawing::figure(svg + "</svg>\n", view.title);
}

std::string touch_rows(const Task& task, const Start& start, const StartCheck& checked) {
  std::string rows;
  for (const Direction& direction : directions_of(task, start, checked)) {
    const std::string way = std::string(direction.sign > 0 ? "+" : "-") + axis_name(direction.axis);
    if (direction.touch == nullptr) {
      rows += row({way, "nothing that the whole spread meets", ""});
      continue;
    }
    const Touch& touch = *direction.touch;
    rows += row(
        {way, drawing::escaped(touch.shape), mm(touch.tool.position_m) + way_text(touch, start)});
  }
  return rows;
}

std::string start_section(const Task& task, const StartCheck& checked, bool goal_free) {
  const Start* start = find_start(task, checked.name);
  if (start == nullptr) return {};
  std::string html = "<section class='picture'><h2>Start " + drawing::escaped(start->name) +
                     "</h2>\n<p>At " + mm(start->pose.position_m) + " mm; the particles, " +
                     reach_text(task) + ": " + drawing::escaped(spread_text(*start, task)) +
                     ".</p>\n";
  for (const drawing::View& view : drawing::views_of(task.coordinates)) {
    html += picture(task, *start, checked, goal_free, view);
  }
  const std::string rows = touch_rows(task, *start, checked);
  if (!rows.empty()) html += titled_table({"Push along", "touches", "with the tool at (mm)"}, rows);
  return html + "</section>\n";
}

std::string room_text(const std::optional<double>& way_m) {
  return way_m ? way_mm_text(*way_m) + " mm" : "open";
}

std::string goal_section(const Task& task, const TaskCheck& check) {
  const std::string tolerance = "the goal's tolerance is " +
                                tolerance_text(task.goal_tolerance_m, task.goal_axes) + ".</p>\n";
  if (!check.goal_free) {
    return "<section><p>How much room the part has at the goal is not told, for there it stands in "
           "something; " +
           tolerance + "</section>\n";
  }
  std::string rows;
  for (const GoalRoom& way : check.goal_room) {
    rows += row({axis_name(way.axis), room_text(way.down_m), room_text(way.up_m)});
  }
  const std::string table =
      rows.empty() ? "" : titled_table({"Along", "towards -", "towards +"}, rows);
  return format(
      "<section><h2>Room at the goal</h2>\n<p>How far the part can go from %s mm until it touches; "
      "%s%s</section>\n",
      mm(task.goal.position_m).c_str(), tolerance.c_str(), table.c_str());
}

std::string understood(const Task& task, const TaskCheck& check) {
  std::string parts;
  const auto add = [&](const std::vector<Shape>& shapes, const char* where) {
    for (const Part& part : parts_of(shapes)) {
      parts += row({drawing::escaped(part.name), size_text(part), mm(part.middle_m), where});
    }
  };
  add(task.held, "held, in the tool frame");
  add(task.environment, "environment, in the task frame");
  return goal_section(task, check) + "<section><h2>Parts</h2>\n" +
         titled_table({"Name", "Size (mm)", "Middle (mm)", ""}, parts) + "</section>\n";
}

}  // namespace

std::string check_page(const std::string& file, const Task& task, const TaskCheck& check) {
  drawing::StillPage page;
  const std::string name = drawing::escaped(task.name);
  page.title = name + ": task";
  page.heading = "<p class='kicker'>Assembly task, checked before planning</p><h1>" + name +
                 " <span>" + drawing::escaped(file) + "</span></h1>\n" + findings(check);
  page.body =
      "<section><p>Blue: the part at its nominal start; yellow: where it may be instead; green: at "
      "the goal; dark red, on a dark page pink: where it stands in something. Orange and dashed: "
      "where pushes touch, wherever in its spread the part begins.</p></section>\n";
  for (const StartCheck& start : check.starts)
    page.body += start_section(task, start, check.goal_free);
  page.body += understood(task, check);
  return drawing::still_document(page);
}

}  // namespace tenon::planner
