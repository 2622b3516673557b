#include "planner/new_task/task_text.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "planner/new_task/push_middle.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

// The tip stands still so far from what it goes against, so that it is free there.
constexpr double kFreeMax_m = 1e-3;
constexpr double kFreeOfDepth = 0.1;
// How near to the assembled place is inserted.
constexpr double kToleranceMax_m = 2e-3;
constexpr double kToleranceOfDepth = 0.2;
constexpr double kToleranceMin_m = 5e-4;
// So many times as far as it may stand turned in its place: half of it is the arm's.
constexpr double kTurnsOfPlay = 2.0;
constexpr double kTurnMin_rad = 0.01;
constexpr double kTurnMax_rad = 0.1;
// A part that is pressed against a wall turns about the tool's origin until it lies flat, for which
// the origin has to be above what the tip's chamfer leaves out of the wall.
constexpr double kOriginMax_m = 5e-3;
constexpr double kOriginOfDepth = 0.2;
// The plug starts so far above everything, whatever its error.
constexpr double kAbove_m = 5e-3;

/// Rounded to a micrometre: rests of rounding are no part of a task.
std::string list(const Vector3& v, double unit = 1e-6) {
  const auto tidy = [&](double x) { return unit * std::round(x / unit) + 0.0; };
  return format("[%.9g, %.9g, %.9g]", tidy(v.x()), tidy(v.y()), tidy(v.z()));
}

std::string pose_text(const Pose& pose) {
  const Vector3 turn_rad = rotation_vector(pose.orientation);
  const std::string position = "{position_m: " + list(pose.position_m);
  if (turn_rad.norm() < 1e-9) return position + "}";
  return position + ", rotation_rad: " + list(turn_rad, 1e-9) + "}";
}

/// How far above the plug's tip the tool's origin is.
double above_tip_m(const NewTask& task) {
  if (task.uniform_rad == 0.0) return 0.0;
  return std::min(kOriginMax_m, kOriginOfDepth * task.fit.depth_m);
}

/// Where the tool's origin is in the socket's file: above the plug's lowest place along the way
/// that it goes in, amid the plug's box, or, where it turns, where pushes do not turn it.
Vector3 origin_m(const NewTask& task) {
  const Eigen::Quaterniond& frame = task.fit.frame;
  const Pose X_FP = compose(inverse({Vector3::Zero(), frame}), task.X_SP);
  TriangleMesh plug = task.plug.solid->mesh();
  Eigen::AlignedBox3d box;
  for (Vector3& point : plug.points_m) {
    point = X_FP.position_m + X_FP.orientation * (point + task.plug.solid->centre_m());
    box.extend(point);
  }
  Vector3 origin = box.center();
  origin.z() = box.min().z() + above_tip_m(task);
  if (task.uniform_rad > 0.0) {
    if (const auto middle = push_middle_m(plug, origin.z())) origin.head<2>() = *middle;
  }
  return frame * origin;
}

/// What the file says in numbers.
struct Numbers {
  Pose X_TS;  ///< the socket's file in the task's frame
  Pose X_GP;  ///< the plug's file in the tool's
  double goal_z_m = 0.0;
  double start_z_m = 0.0;
  double tolerance_m = 0.0;
};

Numbers numbers_of(const NewTask& task) {
  const Eigen::Quaterniond& frame = task.fit.frame;
  Numbers n;
  n.X_TS = inverse({origin_m(task), frame});
  n.X_GP = compose(n.X_TS, task.X_SP);
  n.goal_z_m = std::min(kFreeMax_m, kFreeOfDepth * task.fit.depth_m);
  n.tolerance_m =
      std::clamp(kToleranceOfDepth * task.fit.depth_m, kToleranceMin_m, kToleranceMax_m);
  // A turned part reaches deeper by its own size.
  const double turned_m = task.uniform_rad * task.plug.solid->size_m().maxCoeff();
  n.start_z_m = task.fit.clear_m + task.uniform_m + turned_m + kAbove_m;
  return n;
}

std::string part_line(const char* what, const NewPart& part) {
  return format(
      "%s: %s, taken to be in %s (its longest side is %.4g), %.4g x %.4g x %.4g mm, "
      "%zu triangles, closed\n",
      what, part.file.c_str(), part.scale_m == 1.0 ? "metres" : "millimetres", part.longest_raw,
      1e3 * part.solid->size_m().x(), 1e3 * part.solid->size_m().y(),
      1e3 * part.solid->size_m().z(), part.solid->mesh().triangles.size());
}

std::string commented(const std::string& lines) {
  std::string text = "# ";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += lines[i];
    if (lines[i] == '\n' && i + 1 < lines.size()) text += "# ";
  }
  return text;
}

std::string shapes_text(const NewTask& task, const Numbers& n) {
  const auto shape = [](const char* name, const NewPart& part, const Pose& pose) {
    return format("  - name: %s\n    mesh: {file: \"%s\", scale: %g}\n    pose: %s\n", name,
                  part.file.c_str(), part.scale_m, pose_text(pose).c_str());
  };
  const std::string tip =
      task.uniform_rad == 0.0
          ? "the tip of the plug"
          : format("%.3g mm above the tip of the plug, about which the part turns as it is pressed",
                   1e3 * above_tip_m(task));
  return "# In the tool's frame: its origin is " + tip + ".\nheld:\n" +
         shape("plug", task.plug, n.X_GP) +
         "\n# In the task's frame: z is the way out, its origin where the tool's stands "
         "assembled.\nenvironment:\n" +
         shape("socket", task.socket, n.X_TS);
}

std::string start_text(const NewTask& task, const Numbers& n) {
  const bool turns = task.uniform_rad > 0.0;
  std::string text = format(
      "\n# The start, above everything. Any error within these bounds is as likely.\n"
      "starts:\n  - name: \"1\"\n    pose: %s\n    uniform_m: [%.6g, %.6g, %.6g]\n",
      pose_text({{0.0, 0.0, n.start_z_m}, {1.0, 0.0, 0.0, 0.0}}).c_str(), task.uniform_m,
      task.uniform_m, task.uniform_m);
  if (turns) {
    text += format("    uniform_rad: [%.6g, %.6g, %.6g]\n", task.uniform_rad, task.uniform_rad,
                   task.uniform_rad);
  }
  return text;
}

/// The goal's angles: whatever the place that the part goes into leaves it.
std::string turns_text(const NewTask& task) {
  if (task.uniform_rad == 0.0) return "";
  constexpr std::array<const char*, 3> kNames = {"rx_rad", "ry_rad", "rz_rad"};
  std::string axes;
  for (std::size_t axis = 0; axis < (task.fit.yaw_matters ? 3U : 2U); ++axis) {
    const double turn_rad =
        std::clamp(kTurnsOfPlay * task.fit.turn_rad[axis], kTurnMin_rad, kTurnMax_rad);
    axes += format("%s%s: %.3g", axis == 0 ? "" : ", ", kNames[axis], turn_rad);
  }
  return "  # Twice what it may stand askew by where it goes in.\n  tolerances: {" + axes + "}\n" +
         (task.fit.yaw_matters ? ""
                               : "  # However it is turned about its way, it goes in.\n"
                                 "  free: [rz]\n");
}

std::string goal_text(const NewTask& task, const Numbers& n) {
  const double aside_m =
      2.0 * n.tolerance_m + *std::max_element(task.fit.play_m.begin(), task.fit.play_m.end());
  return format(
             "\n# Clear of the bottom by %.3g mm.\ngoal:\n  pose: {position_m: [0, 0, %.6g]}\n"
             "  tolerance_m: %.6g\n",
             1e3 * n.goal_z_m, n.goal_z_m, n.tolerance_m) +
         turns_text(task) +
         format(
             "  # The tip is as deep as assembled, within the tolerance.\n"
             "  inserted: {box_m: [%.6g, %.6g, %.6g], pose: {position_m: [0, 0, %.6g]}}\n",
             aside_m, aside_m, 2.0 * n.tolerance_m, n.goal_z_m);
}

constexpr const char* kRotations = ", rx, ry, rz";

constexpr const char* kMotion = R"(
# tenon-plan --cell lowers the speeds to what the cell's arm can stop from.
speeds:
  approach_mps: 0.10
  contact_mps: 0.05

# A contact counts above force_on_N, is held with force_keep_N, and is gone below force_off_N.
contact:
  force_on_N: 9.0
  force_keep_N: 3.0
  force_off_N: 1.5
  debounce_s: 0.006
  force_limit_N: 20.0
)";

constexpr const char* kPhysics = R"(
# The stiffness is that of contact, sensor and arm in series; --cell puts the cell's in its place. A contact
# may give way by up to so much more: an edge, or a thin wall.
physics:
  friction: {low: 0.1, nominal: 0.3, high: 0.6}
  contact_stiffness_Npm: 5e4
  contact_give_mpN: 3e-5

# Parts from files take longer than boxes do.
search:
  time_limit_s: 300
)";

std::string compliance_text(bool turns, bool yaw_matters) {
  std::string text = "\n# How the arm yields.";
  if (turns && !yaw_matters) text += " Not in yaw, which touches need not find.";
  text += "\ncompliance:\n  axes: [x, y, z";
  if (turns) text += yaw_matters ? kRotations : ", rx, ry";
  text += "]\n  mass_kg: 2.0\n  damping_Nspm: 1500.0\n  stiffness_Npm: 1000.0\n";
  if (turns) text += "  inertia_kgm2: 0.02\n  damping_Nmspr: 1.0\n  stiffness_Nmpr: 5.0\n";
  return text;
}

}  // namespace

std::string findings(const NewTask& task) {
  const PartFit& fit = task.fit;
  std::string text = part_line("plug", task.plug) + part_line("socket", task.socket);
  if (!fit.way_out) return text;
  const Vector3 in = -*fit.way_out;
  text += format("insertion: along (%.3g, %.3g, %.3g) of the socket's file, %.2f mm deep\n",
                 in.x() + 0.0, in.y() + 0.0, in.z() + 0.0, 1e3 * fit.depth_m);
  text += format(
      "clearance: the plug can move by %.3f mm along x and %.3f mm along y, half-way "
      "in\n",
      1e3 * fit.play_m[0], 1e3 * fit.play_m[1]);
  text += fit.yaw_matters ? "yaw: matters, turned about the way in the plug does not fit\n"
                          : "yaw: does not matter\n";
  return text;
}

std::string task_text(const NewTask& task) {
  const Numbers n = numbers_of(task);
  const bool turns = task.uniform_rad > 0.0;
  return "# Written by tenon-plan --new-task from two parts. Measured:\n#\n" +
         commented(findings(task)) + "\nname: " + task.name + "\ncoordinates: [x, y, z" +
         (turns ? kRotations : "") + "]\n\n" + shapes_text(task, n) + start_text(task, n) +
         goal_text(task, n) + kMotion + compliance_text(turns, task.fit.yaw_matters) + kPhysics;
}

}  // namespace tenon::planner
