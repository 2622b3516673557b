#include <Eigen/Geometry>
#include <string>

#include "planner/check/task_check.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

constexpr std::size_t kListedShapes = 12;

std::string mm(const Vector3& v) {
  return format("(%.4g, %.4g, %.4g)", 1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z());
}

std::string size_text(const Shape& shape) {
  return shape.name + format(" %.4g x %.4g x %.4g", 1e3 * shape.size_m.x(), 1e3 * shape.size_m.y(),
                             1e3 * shape.size_m.z());
}

std::string shapes_text(const std::vector<Shape>& shapes, bool places) {
  std::string text;
  for (std::size_t i = 0; i < shapes.size() && i < kListedShapes; ++i) {
    text += (i == 0 ? "" : "\n          ") + size_text(shapes[i]) +
            (places ? " at " + mm(shapes[i].pose.position_m) : "");
  }
  if (shapes.size() > kListedShapes) {
    text += format("\n          and %zu more", shapes.size() - kListedShapes);
  }
  return text;
}

std::string spread_text(const Start& start, const Task& task) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (start.sigma[axis] <= 0.0) continue;
    text +=
        format("%s%s +-%.3g %s", text.empty() ? "" : ", ", axis_name(axis),
               shown(task.particle_sigmas * start.sigma[axis], axis), axis < 3 ? "mm" : "degrees");
  }
  return text.empty() ? "nothing uncertain" : text;
}

std::string touches_text(const StartCheck& start) {
  std::string text;
  for (const Touch& touch : start.touches) {
    text += format("\n          touches along %s%s: ", touch.sign > 0 ? "+" : "-",
                   axis_name(touch.axis)) +
            touch.shape + ", at " + mm(touch.tool.position_m);
  }
  return text;
}

std::string room_text(const std::optional<double>& way_m) {
  return way_m ? format("%.3g", 1e3 * *way_m) : "open";
}

const char* weight_text(Finding::Weight weight) {
  switch (weight) {
    case Finding::Weight::kRefused:
      return "wrong: ";
    case Finding::Weight::kDoubt:
      return "doubtful: ";
    case Finding::Weight::kAdvice:
      return "advice: ";
  }
  return "";
}

}  // namespace

std::string check_text(const std::string& file, const Task& task, const TaskCheck& check) {
  std::string text;
  if (check.findings.empty()) text += file + ": nothing stands against planning it\n";
  for (const Finding& finding : check.findings) {
    text += file + ": " + weight_text(finding.weight) + finding.text + "\n";
  }
  text += "\nWhat is understood, in mm:\n";
  text += "task      " + task.name + ", along " + axis_list(task.coordinates) + "\n";
  text += "held      " + shapes_text(task.held, true) + " in the tool frame\n";
  text += "around    " + shapes_text(task.environment, true) + "\n";
  text += "goal      " + mm(task.goal.position_m) +
          format(", to within %.3g", 1e3 * task.goal_tolerance_m) +
          (task.inserted ? ", inserted" : "") + "\n";
  for (const GoalRoom& room : check.goal_room) {
    text += format("          room along %s: -%s, +%s\n", axis_name(room.axis),
                   room_text(room.down_m).c_str(), room_text(room.up_m).c_str());
  }
  for (const StartCheck& checked : check.starts) {
    for (const Start& start : task.starts) {
      if (start.name != checked.name) continue;
      text += "start     '" + start.name + "' " + mm(start.pose.position_m) +
              format(", %zu particles %g standard deviations out: ", checked.particles,
                     task.particle_sigmas) +
              spread_text(start, task) + touches_text(checked) + "\n";
    }
  }
  return text;
}

}  // namespace tenon::planner
