// Where the joints stand at a start, and which of several solutions that is.

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <random>

#include "shared/base/error.h"
#include "shared/kinematics/serial_chain.h"
#include "sim/cell/virtual_arm/start_joints.h"
#include "tests/sim/literal_cell.h"
#include "tests/sim/six_axis_cell.h"
#include "tests/support/refusal.h"

namespace tenon::sim {
namespace {

double room_times_dexterity(const Robot& robot, const JointVector& position) {
  double room = 1.0;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const double middle = 0.5 * (robot.joints[i].upper + robot.joints[i].lower);
    const double half = 0.5 * (robot.joints[i].upper - robot.joints[i].lower);
    room = std::min(room, 1.0 - std::abs(position[i] - middle) / half);
  }
  const Eigen::Matrix<double, 6, 6> jacobian = SerialChain(robot).jacobian(position).leftCols<6>();
  return room * Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>>(jacobian).singularValues()[5];
}

TEST(StartJointsTest, TheToolReachesTheStartWithinTheLimitsFurtherFromTroubleThanOtherSolutions) {
  const Cell cell = six_axis_cell();
  const SerialChain chain(cell.robot);
  std::mt19937_64 random(8);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto anywhere = [&] {
    JointVector position{};
    for (std::size_t i = 0; i < 6; ++i) {
      const Joint& joint = cell.robot.joints[i];
      position[i] = joint.lower + uniform() * (joint.upper - joint.lower);
    }
    return position;
  };
  for (int pose = 0; pose < 10; ++pose) {
    const Pose X_BF = chain.flange(anywhere());
    const Pose X_TP = compose(inverse(cell.X_BT), compose(X_BF, cell.X_FP));
    const JointVector found = start_joints(cell, X_TP);
    EXPECT_EQ(found, start_joints(cell, X_TP));
    const Vector6 error = displacement_between(chain.flange(found), X_BF);
    EXPECT_LT(error.lpNorm<Eigen::Infinity>(), 1e-8) << pose;
    const double worth = room_times_dexterity(cell.robot, found);
    EXPECT_GE(worth, 0.0) << "outside a limit at " << pose;
    for (int i = 0; i < 100; ++i) {
      SerialChain::InverseParameters parameters;
      parameters.iterations_max = 100;
      const auto other = chain.inverse(X_BF, anywhere(), parameters);
      if (other.status != SerialChain::InverseStatus::kSolved) continue;
      EXPECT_LE(room_times_dexterity(cell.robot, other.position), worth + 1e-5) << pose;
    }
  }
}

TEST(StartJointsTest, AStartOutOfReachIsRefusedWithWhatIsMissing) {
  Pose far;
  far.position_m.x() = 5.0;
  EXPECT_THROW(static_cast<void>(start_joints(six_axis_cell(), far)), InputError);
  const std::string line =
      tests::refusal([&] { static_cast<void>(start_joints(gantry_cell(), far)); });
  EXPECT_NE(line.find("joint x must stay in [-0.8, 0.8]"), std::string::npos) << line;
}

}  // namespace
}  // namespace tenon::sim
