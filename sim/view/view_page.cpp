#include "sim/view/view_page.h"

#include <nlohmann/json.hpp>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/page.h"
#include "shared/drawing/scene_json.h"
#include "shared/task/find_start.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Pose& pose) { return Json::parse(drawing::pose_json(pose)); }

Vector3 vector_of(const std::array<double, 3>& values) { return Vector3(values.data()); }

/// "[x,y,z]", m or N, to so many decimals.
std::string numbers(const Vector3& v, int decimals) {
  return format("[%.*f,%.*f,%.*f]", decimals, v.x(), decimals, v.y(), decimals, v.z());
}

/// Its environment and goal where they really stand.
Task displaced_task(const Task& task, const Pose& X_TE) {
  Task moved = task;
  for (Shape& shape : moved.environment) shape.pose = compose(X_TE, shape.pose);
  moved.goal = compose(X_TE, task.goal);
  return moved;
}

Json data_of(const ViewedWorld& world) {
  const Pose X_TE = compose(inverse(world.X_BT), world.X_BE);
  const Task task = displaced_task(world.task, X_TE);
  Json json = {{"kind", "live"},
               {"run_id", world.run_id},
               {"task", task.name},
               {"drives", world.drives},
               {"scene", Json::parse(drawing::scene_json(task))},
               {"views", Json::parse(drawing::views_json(task.coordinates))},
               {"coordinates", Json::array()},
               {"start", json_of(start_or_first(task, world.start).pose)},
               {"goal", json_of(task.goal)},
               {"goal_tolerance_m", task.goal_tolerance_m},
               {"nominal", json_of(inverse(X_TE))}};
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis)) json["coordinates"].push_back(axis);
  }
  return json;
}

/// Where the environment really stands, in words.
std::string offset_text(const ViewedWorld& world) {
  const Vector6 off = displacement_between(world.X_BT, world.X_BE);
  const double way_m = off.head<3>().norm();
  const double turn_rad = off.tail<3>().norm();
  if (way_m < 1e-9 && turn_rad < 1e-9) return "It stands where the robot believes it to be.";
  std::string text =
      format("Its origin stands %.1f mm from where the robot believes it to be", shown(way_m, 0));
  if (turn_rad > 1e-9) text += format(", turned by %.2f&deg;", shown(turn_rad, 3));
  return text + "; the robot does not know that.";
}

}  // namespace

std::string view_page(const ViewedWorld& world) {
  const std::string task = drawing::escaped(world.task.name);
  drawing::LivePage page;
  page.title = task + ": live";
  page.heading = "<p class='kicker'>Virtual arm, live</p><h1>" + task + " <span>on cell " +
                 drawing::escaped(world.cell) + "</span></h1>\n<p class='lead'>" +
                 offset_text(world) + "</p>\n";
  page.body =
      "<section class='stage' aria-label='The part among its environment' data-part='stage'>"
      "</section>\n<section data-part='forces' aria-labelledby='forces'><h2 id='forces'>Contact "
      "force</h2></section>\n<noscript><p>This page is drawn by scripts.</p></noscript>\n";
  page.json = data_of(world).dump();
  page.asks_its_server = true;
  return drawing::live_document(page);
}

Vector3 position_m(const CellMoment& moment, const Pose& X_BT) {
  const Pose X_BP{vector_of(moment.position_m), Eigen::Quaterniond::Identity()};
  return compose(inverse(X_BT), X_BP).position_m;
}

std::string moment_json(const CellMoment& moment, const Pose& X_BT, std::size_t dropped) {
  const Pose X_TB = inverse(X_BT);
  const auto& q = moment.orientation_wxyz;
  const Pose X_BP{vector_of(moment.position_m), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
  std::string points;
  for (std::size_t i = 0; i < moment.point_count; ++i) {
    const Pose X_BC{vector_of(moment.points_m[i]), Eigen::Quaterniond::Identity()};
    points += (i == 0 ? "" : ",") + numbers(compose(X_TB, X_BC).position_m, 5);
  }
  std::string touched;
  for (std::size_t i = 0; i < moment.touched_count; ++i) {
    touched += format("%s%u", i == 0 ? "" : ",", static_cast<unsigned>(moment.touched[i]));
  }
  return format(R"({"time_s":%.3f,"tool":)", moment.time_s) +
         drawing::pose_json(compose(X_TB, X_BP)) + R"(,"force_N":)" +
         numbers(X_TB.orientation * vector_of(moment.force_N), 2) +
         format(R"(,"force_N_max":%.2f,"points":[)", moment.force_N_max) + points +
         R"(],"touched":[)" + touched +
         format(R"(],"enabled":%u,"braked":%u,"faulted":%u,"dropped":%zu})",
                static_cast<unsigned>(moment.enabled), static_cast<unsigned>(moment.braked),
                static_cast<unsigned>(moment.faulted), dropped);
}

}  // namespace tenon::sim
