// Drawn moves of bodies of triangles about each other: nothing tunnels, the solver has nothing to
// say, nothing sinks in deeper than a tenth of the clearance, turned or not, on any number of
// threads. The judge of depth is another library.

#include "tests/solids/solid_moves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/new_task/part_fit.h"
#include "tests/solids/fcl_witness.h"
#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"

namespace tenon::tests {
namespace {

SolidPair keyed_pair() {
  const auto solid = [](const char* file) {
    return std::make_shared<const Solid>(example_parts().at(file));
  };
  SolidPair pair{solid("keyed_peg.stl"), solid("keyed_socket.stl")};
  pair.depth_m = 30e-3;
  pair.play_m = 1e-3;
  return pair;
}

double depth_allowed_m(const SolidPair& pair) { return std::max(0.1 * pair.play_m, 50e-6); }

Eigen::Quaterniond turned(double rad) { return rotation_of(Vector3(1, 2, 3).normalized() * rad); }

SolidMovesSeen expect_sound(const SolidPair& pair, const SolidMovesOptions& options) {
  const SolidMovesSeen seen = run_solid_moves(pair, options);
  EXPECT_GE(seen.moves, options.moves * 9 / 10);
  EXPECT_EQ(seen.invalid, 0u) << seen.first_invalid;
  EXPECT_LE(seen.depth_max_m, depth_allowed_m(pair));
  EXPECT_GT(seen.contacts, options.moves / 10);
  EXPECT_GT(seen.meeting, options.moves / 10);
  testing::Test::RecordProperty("depth_max_um", std::to_string(1e6 * seen.depth_max_m));
  return seen;
}

TEST(FclWitness, KnowsApartCrossingAndInside) {
  const FclWitness witness(box_mesh({0.01, 0.01, 0.01}), box_mesh({0.1, 0.1, 0.1}));
  const auto at_x = [&](double x_m) {
    return witness.at({Vector3(x_m, 0, 0), Eigen::Quaterniond::Identity()});
  };
  EXPECT_FALSE(at_x(0.0551).surfaces_meet);
  EXPECT_EQ(at_x(0.0551).depth_m, 0.0);
  EXPECT_TRUE(at_x(0.0549).surfaces_meet);
  EXPECT_NEAR(at_x(0.0549).depth_m, 1e-4, 1e-9);
  EXPECT_FALSE(at_x(0.0).surfaces_meet);
  EXPECT_TRUE(std::isinf(at_x(0.0).depth_m));
}

TEST(SolidMoves, AreSoundAndTheSameOnOneThreadAndOnTwo) {
  SolidMovesOptions options;
  options.moves = 20;
  const SolidMovesSeen one = expect_sound(keyed_pair(), options);
  options.threads = 2;
  EXPECT_EQ(run_solid_moves(keyed_pair(), options).fingerprint, one.fingerprint);
}

TEST(SolidMoves, AreSoundTurnedBy30And45Degrees) {
  SolidMovesOptions options;
  options.moves = 10;
  for (const double degrees : {30.0, 45.0}) {
    options.turned = turned(degrees * std::numbers::pi / 180.0);
    expect_sound(keyed_pair(), options);
  }
}

TEST(SolidMovesStudy, SixHundredAreSound) {
  SolidMovesOptions options;
  options.moves = 200;
  options.threads = 2;
  for (const double degrees : {0.0, 30.0, 45.0}) {
    options.turned = turned(degrees * std::numbers::pi / 180.0);
    expect_sound(keyed_pair(), options);
  }
}

}  // namespace
}  // namespace tenon::tests
