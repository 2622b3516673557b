#include "sim/cell/virtual_arm/moment_maker.h"

#include <algorithm>
#include <vector>

#include "shared/base/time_units.h"

namespace tenon::sim {

void MomentMaker::look() {
  ++steps_;
  const Vector3 force_N = arm_.scene().wrench().head<3>();
  if (force_N.isZero(0.0)) return;
  force_sum_N_ += force_N;
  moment_.force_N_max = std::max(moment_.force_N_max, force_N.norm());
  look_at_contacts();
}

void MomentMaker::look_at_contacts() {
  const std::vector<dContactGeom>& points = arm_.scene().points();
  const std::size_t count = std::min(points.size(), CellMoment::kPointsMax);
  moment_.point_count = static_cast<std::uint8_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    moment_.points_m[i] = {points[i].pos[0], points[i].pos[1], points[i].pos[2]};
  }
  for (const Scene::Pair& pair : arm_.scene().pairs()) {
    const auto shape = static_cast<std::uint16_t>(pair.environment);
    const auto end = moment_.touched.begin() + moment_.touched_count;
    if (end == moment_.touched.end() || std::find(moment_.touched.begin(), end, shape) != end) {
      continue;
    }
    *end = shape;
    ++moment_.touched_count;
  }
}

CellMoment MomentMaker::take(std::int64_t time_ns) {
  CellMoment moment = moment_;
  moment.time_s = static_cast<double>(time_ns) / kNanosecondsPerSecond;
  const Pose tool = arm_.tool();
  const Eigen::Quaterniond& q = tool.orientation;
  moment.position_m = {tool.position_m.x(), tool.position_m.y(), tool.position_m.z()};
  moment.orientation_wxyz = {q.w(), q.x(), q.y(), q.z()};
  if (steps_ > 0) {
    const Vector3 mean_N = force_sum_N_ / steps_;
    moment.force_N = {mean_N.x(), mean_N.y(), mean_N.z()};
  }
  for (const auto& drive : drives_) {
    const VirtualDrive::Look look = drive->look();
    if (look.enabled) ++moment.enabled;
    if (look.brake_engaged) ++moment.braked;
    if (look.faulted) ++moment.faulted;
  }
  moment_ = {};
  force_sum_N_ = Vector3::Zero();
  steps_ = 0;
  return moment;
}

}  // namespace tenon::sim
