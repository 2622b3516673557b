// Goals whose axes differ, in the plan file.

#include <gtest/gtest.h>

#include <algorithm>

#include "shared/base/error.h"
#include "shared/plan/codec.h"
#include "tests/shared/example_plans.h"
#include "tests/shared/plan_bytes.h"

namespace tenon {
namespace {

using tests::Bytes;
using tests::decoded;
using tests::documented_plan;
using tests::long_plan;
using tests::reseal;

TEST(PlanGoalAxes, AxesOfAGoalThatDifferMakeItVersionFourAndComeBack) {
  for (const bool places : {false, true}) {
    Plan plan = long_plan(0b100011, 3, {Outcome::kReached, Outcome::kContact});
    plan.check_places = places;
    const std::size_t without = encode_plan(plan).size();
    plan.goal_axes.tolerance[1] = 0.005;
    plan.goal_axes.free = 0b100000;
    const Bytes bytes = encode_plan(plan);
    EXPECT_EQ(bytes[4], 4);
    EXPECT_EQ(bytes[6], places ? 0x09 : 0x01);
    // The sets grow by the two bytes of version 2, the header by a mask and three tolerances.
    EXPECT_EQ(bytes.size(), without + (places ? 0 : 2 * plan.parameter_sets.size()) + 1 + 3 * 4);
    const Plan back = decoded(bytes);
    EXPECT_EQ(back.check_places, places);
    EXPECT_EQ(back.goal_axes.free, 0b100000);
    EXPECT_EQ(back.goal_axes.tolerance[1], static_cast<double>(0.005F));
    EXPECT_EQ(back.goal_axes.tolerance[0], 0.0);
    EXPECT_EQ(encode_plan(back), bytes);

    const std::size_t at = 205 + plan.task_name.size() + plan.start_name.size();
    const auto changed = [&](std::size_t offset, const Bytes& to) {
      Bytes other = bytes;
      std::copy(to.begin(), to.end(), other.begin() + static_cast<std::ptrdiff_t>(offset));
      reseal(other);
      return decode_plan(other);
    };
    EXPECT_EQ(changed(at, {0x24}).field, "goal_free_axes") << "z is no coordinate";
    EXPECT_EQ(changed(at, {0x22}).field, "goal_axis_tolerance") << "y has a tolerance";
    EXPECT_EQ(changed(at + 1, Bytes{0, 0, 0x80, 0xBF}).field, "goal_axis_tolerance");
    EXPECT_EQ(changed(at + 1, Bytes{0, 0, 0xC0, 0x7F}).error, PlanError::kNotFinite);
    const DecodedPlan lower = changed(at, {0, 0, 0, 0, 0, 0, 0, 0, 0});
    EXPECT_EQ(lower.error, PlanError::kVersion) << "a lower one says as much";
  }
}

TEST(PlanGoalAxes, AGoalHasNoToleranceBesideThePlansCoordinates) {
  Plan plan = documented_plan();
  plan.goal_axes.free = 0b000100;
  EXPECT_THROW((void)encode_plan(plan), InputError);
  plan.goal_axes.free = 0;
  plan.goal_axes.tolerance[2] = 0.01;
  EXPECT_THROW((void)encode_plan(plan), InputError);
}

}  // namespace
}  // namespace tenon
