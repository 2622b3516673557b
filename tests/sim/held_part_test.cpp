// The part in an arm's hand bends while it is pushed, and is the link's own otherwise.

#include "sim/cell/virtual_arm/held_part.h"

#include <gtest/gtest.h>

#include <optional>

namespace tenon::sim {
namespace {

constexpr double kHandStep_s = 0.0005;
constexpr double kHandMass_kg = 5.0;
constexpr double kHandGive_mpN = 2e-5;

struct Hand {
  Hand() : link(dBodyCreate(world.id())) {
    dMass mass;
    dMassSetSphereTotal(&mass, kHandMass_kg, 0.1);
    dBodySetMass(link, &mass);
    dBodySetLinearVel(link, 0.1, 0.0, 0.0);
    dBodySetAngularVel(link, 0.0, 0.0, 0.3);
    part.emplace(world, link, kHandGive_mpN);
  }
  /// @param push_N along y, on the part; 0: nothing touches it  @param pull_N on the link along x
  void step(double push_N, double pull_N) {
    dBodyAddForce(link, pull_N, 0.0, 0.0);
    if (push_N == 0.0 && part->there()) {
      BodyState moved = state_of(link);
      moved.velocity_mps.x() += kHandStep_s * pull_N / kHandMass_kg;
      moved.pose.position_m += kHandStep_s * moved.velocity_mps;
      set_state(link, moved);
      dBodySetForce(link, 0.0, 0.0, 0.0);
      part->ride(moved);
      return;
    }
    part->load(kHandStep_s, push_N != 0.0);
    if (push_N != 0.0) dBodyAddForce(part->body(), 0.0, push_N, 0.0);
    world.step(kHandStep_s);
    part->look();
  }

  OdeWorld world;
  dBodyID link;
  std::optional<HeldPart> part;
};

TEST(HeldPart, BendsWhileItIsPushedAndThenGoesBackAndWithTheLink) {
  Hand hand;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 200; ++i) hand.step(10.0, 0.0);
    EXPECT_NEAR(hand.part->bent_m().y(), 10.0 * kHandGive_mpN, 1e-6) << round;

    hand.step(0.0, 0.0);
    EXPECT_GT(hand.part->bent_m().y(), 0.5 * 10.0 * kHandGive_mpN) << "not in one step";
    for (int i = 0; i < 200; ++i) hand.step(0.0, 20.0);
    for (int i = 0; i < 200; ++i) {
      hand.step(0.0, i % 2 == 0 ? 20.0 : -20.0);
      ASSERT_EQ(hand.part->bent_m(), Vector3::Zero());
      const BodyState link = state_of(hand.link);
      const BodyState part = state_of(hand.part->body());
      ASSERT_EQ(part.velocity_mps, link.velocity_mps);
      ASSERT_EQ(part.omega_radps, link.omega_radps);
      ASSERT_LT(part.pose.orientation.angularDistance(link.pose.orientation), 1e-7);
    }
  }
}

}  // namespace
}  // namespace tenon::sim
