// Contacts of a part that cannot rotate are solved without ODE's solver: as that would solve them.

#include "sim/physics/solver/locked_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "shared/base/random.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/solver/contact_joints.h"

namespace tenon::sim {
namespace {

constexpr double kFlight_s = 0.002;

Vector3 direction(Random& random) {
  return Vector3(random.normal(), random.normal(), random.normal()).normalized();
}

struct Case {
  Compliance compliance;
  ArmGive arm;
  ContactLaw law;
  std::vector<dContactGeom> points;
  GuardedMove::Setpoint before;  ///< of a step without contact, which gets the tool going
  GuardedMove::Setpoint now;
};

Case drawn(Random& random, std::uint8_t compliant_axes, const std::vector<Vector3>& normals) {
  Case one;
  one.compliance.compliant_axes = compliant_axes;
  one.law = {random.uniform(0.0, 0.8), random.uniform(1e4, 1e6)};
  if (random.uniform() < 0.5) one.arm.give_mpN = random.uniform(0.0, 1e-4);
  for (const Vector3& normal : normals) {
    dContactGeom& point = one.points.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      point.normal[axis] = normal[axis];
      point.pos[axis] = random.uniform(-0.1, 0.1);
    }
    point.depth = random.uniform(0.0, 1e-3);
  }
  for (int axis = 0; axis < 3; ++axis) {
    one.before.velocity[axis] = random.uniform(-0.2, 0.2);
    one.now.velocity[axis] = random.uniform(-0.2, 0.2);
    one.now.acceleration[axis] = random.uniform(-1.0, 1.0);
    one.now.pose.position_m[axis] = random.uniform(-0.01, 0.01);
  }
  return one;
}

/// Tool and part after a step, and the wrench on them.
struct End {
  Pose pose;
  Pose part;
  Vector6 wrench = Vector6::Zero();
  bool settled = true;
};

End by_ode(const Case& one) {
  OdeWorld world;
  CompliantTool tool(world, one.compliance);
  tool.set_compliance(one.compliance, /*turns=*/false, one.arm);
  tool.place({});
  tool.fly(one.before, kFlight_s);
  tool.show();
  dGeomID on_body = dCreateSphere(nullptr, 0.01);
  dGeomSetBody(on_body, tool.body());
  std::vector<dContactGeom> points = one.points;
  for (dContactGeom& point : points) point.g1 = on_body;
  ContactJoints joints;
  joints.make(world, points, one.law, kFlight_s);
  tool.drive(one.now, kFlight_s);
  world.step(kFlight_s);
  tool.follow();
  dGeomDestroy(on_body);
  return {tool.pose(), tool.part_pose(), joints.wrench(), true};
}

End by_sweeps(const Case& one) {
  OdeWorld world;
  CompliantTool tool(world, one.compliance);
  tool.set_compliance(one.compliance, /*turns=*/false, one.arm);
  tool.place({});
  tool.fly(one.before, kFlight_s);
  LockedContacts contacts;
  const bool settled =
      contacts.solve(one.points, one.law, tool.free_velocity_mps(one.now, kFlight_s),
                     tool.give_mpspN(kFlight_s), kFlight_s);
  const Vector6 wrench = contacts.wrench_about(tool.part_pose().position_m);
  tool.fly(one.now, kFlight_s, wrench);
  return {tool.pose(), tool.part_pose(), wrench, settled};
}

/// @return forces of the drawn cases, N, but for the few that do not settle
std::vector<double> compared(std::uint64_t seed, int cases, std::uint8_t compliant_axes,
                             const std::function<std::vector<Vector3>(Random&)>& normals) {
  Random random(seed);
  std::vector<double> forces_N;
  for (int i = 0; i < cases; ++i) {
    const Case one = drawn(random, compliant_axes, normals(random));
    const End a = by_ode(one);
    const End b = by_sweeps(one);
    if (!b.settled) continue;
    const double scale_N = 1.0 + a.wrench.head<3>().norm();
    // Which of several faces bears the friction that stops the part is nobody's to say; it would
    // show in the torque, which nothing yields to.
    const Vector3 force_N = a.wrench.head<3>() - b.wrench.head<3>();
    EXPECT_LT(force_N.norm(), 1e-5 * scale_N) << i;
    EXPECT_LT((a.pose.position_m - b.pose.position_m).norm(), 1e-8) << i;
    EXPECT_LT((a.part.position_m - b.part.position_m).norm(), 1e-8) << i;
    forces_N.push_back(a.wrench.head<3>().norm());
  }
  return forces_N;
}

void expect_both_kinds(const std::vector<double>& forces_N) {
  const auto none = std::count(forces_N.begin(), forces_N.end(), 0.0);
  EXPECT_GT(none, 0);
  EXPECT_LT(none, static_cast<std::ptrdiff_t>(forces_N.size() / 2));
}

TEST(LockedContacts, OneFaceInAnyDirection) {
  expect_both_kinds(
      compared(1, 2000, 0b000111, [](Random& r) { return std::vector{direction(r)}; }));
}

TEST(LockedContacts, FacesAlongTheAxesWhereOneIsHeld) {
  expect_both_kinds(compared(2, 2000, 0b000101, [](Random& r) {
    return std::vector{r.uniform() < 0.5 ? Vector3(-1.0, 0.0, 0.0) : Vector3(0.0, 0.0, 1.0)};
  }));
}

TEST(LockedContacts, ACornerOfTwoOrThreeFaces) {
  const auto corner = [](Random& r) {
    std::vector<Vector3> normals = {Vector3::UnitZ(), -Vector3::UnitX()};
    if (r.uniform() < 0.5) normals.emplace_back(Vector3::UnitY());
    return normals;
  };
  EXPECT_EQ(compared(3, 2000, 0b000111, corner).size(), 2000U);
}

TEST(LockedContacts, TheSidesOfARoundHole) {
  const auto sides = [](Random& r) {
    const double angle_rad = r.uniform(0.0, 6.0);
    std::vector<Vector3> normals;
    for (const double turn_rad : {0.0, 0.3927, -0.3927}) {
      normals.emplace_back(std::cos(angle_rad + turn_rad), std::sin(angle_rad + turn_rad), 0.0);
    }
    return normals;
  };
  EXPECT_GE(compared(4, 2000, 0b000111, sides).size(), 1980U);
}

}  // namespace
}  // namespace tenon::sim
