#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "planner/check/task_check.h"
#include "planner/check/understood.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

constexpr std::size_t kListedParts = 12;

/// Plain digits, as many as four or as the number has.
std::string mm(double length_m) {
  const double length_mm = 1e3 * length_m;
  return format(std::abs(length_mm) < 9999.5 ? "%.4g" : "%.0f", length_mm);
}

std::string mm(const Vector3& v) {
  return "(" + mm(v.x()) + ", " + mm(v.y()) + ", " + mm(v.z()) + ")";
}

std::string shapes_text(const std::vector<Shape>& shapes) {
  const std::vector<Part> parts = parts_of(shapes);
  std::string text;
  for (std::size_t i = 0; i < parts.size() && i < kListedParts; ++i) {
    const Part& part = parts[i];
    text += (i == 0 ? "" : "\n          ") + part.name + " " + size_text(part) + " at " +
            mm(part.middle_m);
  }
  if (parts.size() > kListedParts) {
    text += format("\n          and %zu more", parts.size() - kListedParts);
  }
  return text;
}

std::string touches_text(const Task& task, const Start& start, const StartCheck& checked) {
  std::string text;
  for (const Direction& direction : directions_of(task, start, checked)) {
    text += format("\n          touches along %s%s: ", direction.sign > 0 ? "+" : "-",
                   axis_name(direction.axis));
    if (direction.touch == nullptr) {
      text += "nothing that the whole spread meets";
      continue;
    }
    text += direction.touch->shape + ", at " + mm(direction.touch->tool.position_m);
    text += way_text(*direction.touch, start);
  }
  return text;
}

std::string room_text(const GoalRoom& room) {
  if (!room.down_m && !room.up_m) return "open both ways";
  const auto side = [&](const char* sign, const std::optional<double>& way_m) {
    return (way_m ? way_mm_text(*way_m) : "open") + " towards " + sign + axis_name(room.axis);
  };
  return side("-", room.down_m) + ", " + side("+", room.up_m);
}

}  // namespace

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

std::string check_text(const std::string& file, const Task& task, const TaskCheck& check) {
  std::string text;
  if (check.findings.empty()) text += file + ": nothing stands against planning it\n";
  for (const Finding& finding : check.findings) {
    text += file + ": " + weight_text(finding.weight) + finding.text + "\n";
  }
  text += "\nWhat is understood, in mm:\n";
  text += "task      " + task.name + ", along " + axis_list(task.coordinates) + "\n";
  text += "held      " + shapes_text(task.held) + " in the tool frame\n";
  text += "around    " + shapes_text(task.environment) + "\n";
  text += "goal      " + mm(task.goal.position_m) + ", to within " +
          tolerance_text(task.goal_tolerance_m, task.goal_axes) +
          (task.inserted ? ", inserted" : "") + "\n";
  for (const GoalRoom& room : check.goal_room) {
    text += format("          room along %s: ", axis_name(room.axis)) + room_text(room) + "\n";
  }
  for (const StartCheck& checked : check.starts) {
    for (const Start& start : task.starts) {
      if (start.name != checked.name) continue;
      text += "start     '" + start.name + "' " + mm(start.pose.position_m);
      if (!checked.free) {
        text += ", in collision\n";
        continue;
      }
      text += format(", %zu particles ", checked.particles.size()) + reach_text(task) + ": " +
              spread_text(start, task) + touches_text(task, start, checked) + "\n";
    }
  }
  return text;
}

}  // namespace tenon::planner
