// One contact in closed form is what ODE's solver finds for it.

#include "sim/physics/solver/one_contact.h"

#include <gtest/gtest.h>

#include "shared/base/random.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/solver/contact_joints.h"

namespace tenon::sim {
namespace {

constexpr double kStep_s = 0.002;

double between(Random& random, double low, double high) {
  return low + random.uniform() * (high - low);
}

Vector3 direction(Random& random) {
  return Vector3(random.normal(), random.normal(), random.normal()).normalized();
}

struct Case {
  Compliance compliance;
  ContactLaw law;
  dContactGeom point{};
  GuardedMove::Setpoint before;  ///< of a step without contact, which gets the tool going
  GuardedMove::Setpoint now;
};

Case drawn(Random& random, std::uint8_t compliant_axes, const Vector3& normal) {
  Case one;
  one.compliance.compliant_axes = compliant_axes;
  one.law = {between(random, 0.0, 0.8), between(random, 1e4, 1e6)};
  for (int axis = 0; axis < 3; ++axis) {
    one.point.normal[axis] = normal[axis];
    one.point.pos[axis] = between(random, -0.1, 0.1);
    one.before.velocity[axis] = between(random, -0.2, 0.2);
    one.now.velocity[axis] = between(random, -0.2, 0.2);
    one.now.acceleration[axis] = between(random, -1.0, 1.0);
    one.now.pose.position_m[axis] = between(random, -0.01, 0.01);
  }
  one.point.depth = between(random, 0.0, 1e-3);
  return one;
}

/// The tool and the wrench after the step, through ODE's solver.
Vector6 solved(const Case& one, Pose& end) {
  OdeWorld world;
  CompliantTool tool(world, one.compliance);
  tool.set_compliance(one.compliance, /*turns=*/false);
  tool.place({});
  tool.fly(one.before, kStep_s);
  tool.show();
  ContactJoints joints;
  dContactGeom point = one.point;
  dGeomID on_body = dCreateSphere(nullptr, 0.01);
  dGeomSetBody(on_body, tool.body());
  point.g1 = on_body;
  joints.make(world, {point}, one.law, kStep_s);
  tool.drive(one.now, kStep_s);
  world.step(kStep_s);
  tool.follow();
  dGeomDestroy(on_body);
  end = tool.pose();
  return joints.wrench();
}

void expect_what_the_solver_finds(Random& random, std::uint8_t compliant_axes,
                                  const Vector3& normal, int& pushing, int& sticking) {
  const Case one = drawn(random, compliant_axes, normal);
  OdeWorld world;
  CompliantTool tool(world, one.compliance);
  tool.set_compliance(one.compliance, /*turns=*/false);
  tool.place({});
  tool.fly(one.before, kStep_s);
  const auto force = one_contact_force(one.point, one.law, tool.free_velocity_mps(one.now, kStep_s),
                                       tool.give_mpspN(kStep_s), kStep_s);
  ASSERT_TRUE(force.has_value());
  Vector6 wrench = Vector6::Zero();
  wrench.head<3>() = *force;
  tool.fly(one.now, kStep_s, wrench);

  Pose end;
  const Vector6 reference = solved(one, end);
  const double scale_N = 1.0 + reference.head<3>().norm();
  EXPECT_LT((reference.head<3>() - *force).norm(), 1e-6 * scale_N);
  EXPECT_LT((end.position_m - tool.pose().position_m).norm(), 1e-10);
  const double push_N = force->dot(normal);
  pushing += push_N > 0.0;
  sticking += push_N > 0.0 && (*force - push_N * normal).norm() < 0.5 * one.law.friction * push_N;
}

TEST(OneContact, IsWhatTheSolverFindsInAnyDirection) {
  Random random(1);
  int pushing = 0;
  int sticking = 0;
  for (int i = 0; i < 2000; ++i) {
    expect_what_the_solver_finds(random, 0b000111, direction(random), pushing, sticking);
  }
  EXPECT_GT(pushing, 500);
  EXPECT_LT(pushing, 1900);
  EXPECT_GT(sticking, 3);
}

TEST(OneContact, AndOnFacesAlongTheAxesWhereSomeAreHeld) {
  Random random(2);
  int pushing = 0;
  int sticking = 0;
  for (int i = 0; i < 1000; ++i) {
    expect_what_the_solver_finds(random, 0b000101, -Vector3::UnitX(), pushing, sticking);
    expect_what_the_solver_finds(random, 0b000101, Vector3::UnitZ(), pushing, sticking);
  }
  EXPECT_GT(pushing, 500);
}

TEST(OneContact, AFaceAskewToAnAxisThatIsHeldIsTheSolversWork) {
  dContactGeom point{};
  point.normal[0] = point.normal[2] = std::sqrt(0.5);
  const Vector3 give(1e-4, 1e-4, 0.0);
  EXPECT_FALSE(one_contact_force(point, {}, Vector3::Zero(), give, kStep_s).has_value());
  EXPECT_TRUE(one_contact_force(point, {}, Vector3::Zero(), Vector3::Constant(1e-4), kStep_s));
}

}  // namespace
}  // namespace tenon::sim
