#include "planner/new_task/part_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "planner/new_task/part_frame.h"
#include "planner/new_task/solid_gap.h"

namespace tenon::planner {
namespace {

// The way out is tried at so many places.
constexpr int kPlaces = 80;
// A part that can go aside by this, and by its play besides, is out of the other.
constexpr double kAside_m = 1e-3;
constexpr double kPlayStep_m = 50e-6;  // while the parts touch: less than any wall
constexpr double kPlayResolution_m = 5e-6;
constexpr double kTurnStep_rad = 2e-3;
constexpr double kRounding_m = 1e-9;
// How many of the plug's largest flat directions are tried beside the axes of the file.
constexpr std::size_t kDirectionsMax = 6;
constexpr double kSameDirection = 0.9994;  // 2 degrees

double extent_m(const Solid& solid, const Eigen::Quaterniond& orientation, const Vector3& way) {
  double most_m = -1e9;
  for (const Vector3& point : solid.mesh().points_m) {
    most_m = std::max(most_m, way.dot(orientation * point));
  }
  return most_m;
}

class Fitting {
 public:
  Fitting(const std::shared_ptr<const Solid>& plug, const std::shared_ptr<const Solid>& socket,
          const Pose& X_SP)
      : plug_(*plug), socket_(*socket), gap_(plug, socket) {
    const Pose middle = compose(X_SP, {plug->centre_m(), Eigen::Quaterniond::Identity()});
    X_EH_ = {middle.position_m - socket->centre_m(), middle.orientation};
  }

  [[nodiscard]] double gap_m() const { return gap_.gap_m(X_EH_, kAside_m); }

  [[nodiscard]] bool free_at(const Vector3& off_m) const { return free(off_m, X_EH_.orientation); }

  /// Along a way until nothing of the one is above the lowest of the other.
  [[nodiscard]] double clear_m(const Vector3& way) const {
    const double top_m = extent_m(socket_, Eigen::Quaterniond::Identity(), way);
    const double bottom_m = -extent_m(plug_, X_EH_.orientation, -way);
    return std::max(0.0, top_m - bottom_m - way.dot(X_EH_.position_m));
  }

  [[nodiscard]] bool leads_out(const Vector3& way) const {
    const double clear_m = this->clear_m(way);
    for (int i = 1; i <= kPlaces; ++i) {
      if (!free_at(clear_m * i / kPlaces * way)) return false;
    }
    return true;
  }

  /// Both ways together, from a place, until the parts touch, or overlap more than they did there.
  /// Beyond what stops it the plug may be free again, so it goes outwards, by what is free at a
  /// time.
  [[nodiscard]] double play_m(const Vector3& from_m, const Vector3& aside) const {
    const auto gap_at = [&](const Vector3& off_m) {
      return gap_.gap_m({X_EH_.position_m + off_m, X_EH_.orientation}, kAside_m);
    };
    const double least_m = std::min(0.0, gap_at(from_m)) - kRounding_m;
    const double far_m = plug_.size_m().maxCoeff();
    double play_m = 0.0;
    for (const double sign : {1.0, -1.0}) {
      double free_m = 0.0;
      double next_m = 0.0;
      for (double gap_m = gap_at(from_m); gap_m >= least_m && free_m < far_m;
           gap_m = gap_at(from_m + sign * next_m * aside)) {
        free_m = next_m;
        next_m = free_m + std::max(gap_m, kPlayStep_m);
      }
      while (next_m - free_m > kPlayResolution_m && free_m < far_m) {
        const double middle_m = 0.5 * (free_m + next_m);
        (gap_at(from_m + sign * middle_m * aside) >= least_m ? free_m : next_m) = middle_m;
      }
      play_m += std::min(free_m, far_m);
    }
    return play_m;
  }

  /// Where the plug is first free to move to all four sides.
  [[nodiscard]] double depth_m(const Eigen::Quaterniond& frame, double clear_m,
                               double aside_m) const {
    const Vector3 way = frame * Vector3::UnitZ();
    const auto held = [&](double out_m) {
      for (int i = 0; i < 4; ++i) {
        const double angle_rad = 0.5 * std::numbers::pi * i;
        const Vector3 aside(std::cos(angle_rad), std::sin(angle_rad), 0.0);
        if (!free_at(out_m * way + aside_m * (frame * aside))) return true;
      }
      return false;
    };
    int last = kPlaces;
    while (last > 0 && !held(clear_m * (last - 1) / kPlaces)) --last;
    return clear_m * last / kPlaces;
  }

  /// Whether the plug, turned by any of some angles about a way through its middle, overlaps.
  [[nodiscard]] bool held_about(const Vector3& way, const Vector3& from_m) const {
    constexpr int kTurns = 24;
    for (int i = 1; i < kTurns; ++i) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.0 * std::numbers::pi * i / kTurns, way));
      if (!free(from_m, turn * X_EH_.orientation)) return true;
    }
    return false;
  }

  /// About a way through its middle, from a place: the mean of both ways until the parts touch, or
  /// overlap more than they did there.
  [[nodiscard]] double turn_rad(const Vector3& way, const Vector3& from_m) const {
    const auto gap_at = [&](double angle_rad) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle_rad, way));
      return gap_.gap_m({X_EH_.position_m + from_m, turn * X_EH_.orientation}, kAside_m);
    };
    const double least_m = std::min(0.0, gap_at(0.0)) - kRounding_m;
    double both_rad = 0.0;
    for (const double sign : {1.0, -1.0}) {
      double free_rad = 0.0;
      while (free_rad < kMostTurn_rad && gap_at(sign * (free_rad + kTurnStep_rad)) >= least_m) {
        free_rad += kTurnStep_rad;
      }
      both_rad += free_rad;
    }
    return std::min(kMostTurn_rad, 0.5 * both_rad);
  }

  [[nodiscard]] Eigen::Quaterniond frame_along(const Vector3& way) const {
    return part_frame(way, plug_.mesh(), X_EH_.orientation, socket_.mesh());
  }

  /// The file's axes, up first, and those in which the plug has its largest flat faces.
  [[nodiscard]] std::vector<Vector3> directions() const {
    std::vector<Vector3> ways = {Vector3::UnitZ(),  -Vector3::UnitZ(), Vector3::UnitX(),
                                 -Vector3::UnitX(), Vector3::UnitY(),  -Vector3::UnitY()};
    struct Flat {
      Vector3 way;
      double area_m2;
    };
    std::vector<Flat> flats;
    for (std::size_t i = 0; i < plug_.mesh().triangles.size(); ++i) {
      const std::array<Vector3, 3> c = plug_.mesh().corners_m(i);
      const Vector3 twice_m2 = (c[1] - c[0]).cross(c[2] - c[0]);
      const Vector3 way = X_EH_.orientation * twice_m2.normalized();
      const auto same = std::find_if(flats.begin(), flats.end(), [&](const Flat& flat) {
        return flat.way.dot(way) > kSameDirection;
      });
      if (same == flats.end()) {
        flats.push_back({way, 0.5 * twice_m2.norm()});
      } else {
        same->area_m2 += 0.5 * twice_m2.norm();
      }
    }
    std::stable_sort(flats.begin(), flats.end(),
                     [](const Flat& a, const Flat& b) { return a.area_m2 > b.area_m2; });
    for (std::size_t i = 0; i < std::min(flats.size(), kDirectionsMax); ++i) {
      const bool known = std::any_of(ways.begin(), ways.end(), [&](const Vector3& way) {
        return way.dot(flats[i].way) > kSameDirection;
      });
      if (!known) ways.push_back(flats[i].way);
    }
    return ways;
  }

 private:
  [[nodiscard]] bool free(const Vector3& off_m, const Eigen::Quaterniond& orientation) const {
    return gap_.gap_m({X_EH_.position_m + off_m, orientation}, 0.0) >= -kTouching_m;
  }

  const Solid& plug_;
  const Solid& socket_;
  SolidGap gap_;
  Pose X_EH_;  ///< assembled, between the solids' middles
};

}  // namespace

PartFit fit_of(const std::shared_ptr<const Solid>& plug, const std::shared_ptr<const Solid>& socket,
               const Pose& X_SP) {
  const Fitting fitting(plug, socket, X_SP);
  PartFit fit;
  fit.overlap_m = std::max(0.0, -fitting.gap_m());
  if (fit.overlap_m > kTouching_m) return fit;
  for (const Vector3& way : fitting.directions()) {
    if (fit.way_out && fitting.clear_m(way) >= fit.clear_m) continue;
    if (!fitting.leads_out(way)) continue;
    fit.way_out = way;
    fit.clear_m = fitting.clear_m(way);
  }
  if (!fit.way_out) return fit;
  const Vector3& way = *fit.way_out;
  fit.frame = fitting.frame_along(way);
  // The play half-way in depends on the depth, the depth on the play: a part that is out has some
  // millimetres of it at once, so that a first depth with the least will do.
  const double first_m = fitting.depth_m(fit.frame, fit.clear_m, kAside_m);
  for (std::size_t axis = 0; axis < fit.play_m.size(); ++axis) {
    const Vector3 aside = fit.frame * Vector3::Unit(static_cast<int>(axis));
    fit.play_m[axis] = fitting.play_m(0.5 * first_m * way, aside);
  }
  const double most_m = *std::max_element(fit.play_m.begin(), fit.play_m.end());
  const bool loose = most_m > plug->size_m().maxCoeff();
  fit.depth_m = loose ? first_m : fitting.depth_m(fit.frame, fit.clear_m, most_m + kAside_m);
  const Vector3 half_way_m = 0.5 * fit.depth_m * way;
  fit.yaw_matters = fitting.held_about(way, half_way_m);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    fit.turn_rad[axis] = std::min(kMostTurn_rad, fit.play_m[1 - axis] / fit.depth_m);
  }
  fit.turn_rad[2] = fitting.turn_rad(way, half_way_m);
  return fit;
}

}  // namespace tenon::planner
