// Plans to bytes and back, and everything that must not come back.

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "shared/base/error.h"
#include "shared/plan/codec.h"
#include "tests/shared/example_plans.h"
#include "tests/shared/plan_bytes.h"
#include "tests/support/refusal.h"

namespace tenon {
namespace {

using tests::Bytes;
using tests::decoded;
using tests::documented_plan;
using tests::long_plan;
using tests::reseal;

double rounded(double value) { return static_cast<float>(value); }

TEST(PlanCodec, EveryFieldComesBackAsTheValueOfItsFloat) {
  const Plan plan =
      long_plan(0b011011, 15, {Outcome::kReached, Outcome::kContact, Outcome::kTimeout});
  const Plan back = decoded(encode_plan(plan));

  EXPECT_EQ(back.task_name, plan.task_name);
  EXPECT_EQ(back.start_name, plan.start_name);
  EXPECT_EQ(back.task_hash, plan.task_hash);
  EXPECT_EQ(back.coordinates, plan.coordinates);
  EXPECT_EQ(back.start, plan.start);
  EXPECT_EQ(back.goal, plan.goal);
  EXPECT_EQ(back.goal_tolerance_m, rounded(plan.goal_tolerance_m));
  EXPECT_EQ(back.compliance.inertia_kgm2, rounded(plan.compliance.inertia_kgm2));
  EXPECT_EQ(back.compliance.damping_Nspm, plan.compliance.damping_Nspm);
  EXPECT_EQ(back.compliance.compliant_axes, plan.compliance.compliant_axes);
  EXPECT_EQ(back.force_limit_N, plan.force_limit_N);
  EXPECT_EQ(back.torque_limit_Nm, plan.torque_limit_Nm);
  EXPECT_EQ(back.contact_stiffness_Npm, plan.contact_stiffness_Npm);
  EXPECT_EQ(back.latency_max_s, rounded(plan.latency_max_s));
  EXPECT_EQ(back.cost, plan.cost);
  EXPECT_EQ(back.bound, plan.bound);
  EXPECT_EQ(back.draws, plan.draws);
  EXPECT_EQ(back.draws_at_goal, plan.draws_at_goal);
  EXPECT_EQ(back.check_envelopes, plan.check_envelopes);
  ASSERT_EQ(back.parameter_sets.size(), 2U);
  EXPECT_EQ(back.parameter_sets[1].speeds.approach_mps, rounded(0.05));
  EXPECT_EQ(back.parameter_sets[1].thresholds.torque_on_Nm, rounded(0.6));
  EXPECT_EQ(back.parameter_sets[1].thresholds.debounce_us, 6000U);
  EXPECT_EQ(back.parameter_sets[1].timeout_us, 10'000'000U);
  EXPECT_EQ(back.parameter_sets[1].trigger_mask, ContactSignature{0x000F});

  ASSERT_EQ(back.steps.size(), plan.steps.size());
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    EXPECT_EQ(back.steps[i].parameter_set, plan.steps[i].parameter_set);
    EXPECT_EQ(back.steps[i].slow_from_m, rounded(plan.steps[i].slow_from_m));
    for (int axis = 0; axis < 6; ++axis) {
      EXPECT_EQ(back.steps[i].displacement[axis], rounded(plan.steps[i].displacement[axis]));
    }
    for (const Outcome outcome : kOutcomes) {
      EXPECT_EQ(back.steps[i].rule(outcome).successor, plan.steps[i].rule(outcome).successor);
    }
    EXPECT_EQ(back.steps[i].rule(Outcome::kContact).envelope.always, ContactSignature{0x0001});
    EXPECT_EQ(back.steps[i].rule(Outcome::kContact).envelope.possible, ContactSignature{0x0005});
  }
}

TEST(PlanCodec, EveryMethodComesBackBesideTheFlagForEnvelopes) {
  for (const bool check_envelopes : {false, true}) {
    for (const PlanMethod method : kPlanMethods) {
      Plan plan = documented_plan();
      plan.method = method;
      plan.check_envelopes = check_envelopes;
      const Bytes bytes = encode_plan(plan);
      EXPECT_EQ(bytes[6], 2 * static_cast<int>(method) + (check_envelopes ? 1 : 0));
      EXPECT_EQ(decoded(bytes).method, method);
      EXPECT_EQ(decoded(bytes).check_envelopes, check_envelopes);
    }
  }
}

TEST(PlanCodec, WhatASetSaysOfItsAxesMakesItVersionTwoAndComesBack) {
  Plan plan = long_plan(0b100011, 3, {Outcome::kReached});
  EXPECT_EQ(encode_plan(plan)[4], 1);
  plan.parameter_sets[1].sensed_axes = 0b011111;
  plan.parameter_sets[1].carried_axes = true;
  plan.parameter_sets[1].aligns = false;
  const Bytes bytes = encode_plan(plan);
  EXPECT_EQ(bytes[4], 2);
  const Plan back = decoded(bytes);
  EXPECT_TRUE(back.parameter_sets[0].aligns);
  EXPECT_FALSE(back.parameter_sets[1].aligns);
  EXPECT_EQ(back.parameter_sets[0].sensed_axes, 0x3F);
  EXPECT_FALSE(back.parameter_sets[0].carried_axes);
  EXPECT_EQ(back.parameter_sets[1].sensed_axes, 0b011111);
  EXPECT_TRUE(back.parameter_sets[1].carried_axes);
  EXPECT_FALSE(move_parameters(back, 0).carried_from.has_value());
  EXPECT_EQ(encode_plan(back), bytes);
}

TEST(PlanCodec, WhereStepsEndMakesItVersionThreeAndComesBack) {
  Plan plan = long_plan(0b100011, 3, {Outcome::kReached, Outcome::kContact});
  plan.check_places = true;
  for (Step& step : plan.steps) {
    for (const Outcome outcome : {Outcome::kReached, Outcome::kContact}) {
      Envelope& envelope = step.outcomes[static_cast<std::size_t>(outcome)].envelope;
      envelope.place_min = envelope.travelled_min * 1.1;
      envelope.place_max = envelope.travelled_max * 1.1;
    }
  }
  const Bytes bytes = encode_plan(plan);
  EXPECT_EQ(bytes[4], 3);
  EXPECT_EQ(bytes[6], 0x09);
  const Plan back = decoded(bytes);
  EXPECT_TRUE(back.check_places);
  const Envelope& before = plan.steps[1].rule(Outcome::kContact).envelope;
  const Envelope& after = back.steps[1].rule(Outcome::kContact).envelope;
  for (const int axis : {0, 1, 5}) {
    EXPECT_LE(after.place_min[axis], before.place_min[axis]);
    EXPECT_GE(after.place_max[axis], before.place_max[axis]);
    EXPECT_NEAR(after.place_min[axis], before.place_min[axis], 1e-7);
    EXPECT_NEAR(after.place_max[axis], before.place_max[axis], 1e-7);
  }
  EXPECT_EQ(encode_plan(back), bytes);
  for (const std::uint8_t flags : std::initializer_list<std::uint8_t>{0x01, 0x08, 0x0F, 0x19}) {
    Bytes other = bytes;
    other[6] = flags;
    reseal(other);
    EXPECT_EQ(decode_plan(other).field, "flags");
  }
  plan.check_envelopes = false;
  EXPECT_THROW((void)encode_plan(plan), InputError);
}

// What version 1 can hold has no other encoding.
TEST(PlanCodec, AVersionTwoThatSaysNothingNewIsRefused) {
  Plan plan = documented_plan();
  plan.parameter_sets[0].carried_axes = true;
  Bytes bytes = encode_plan(plan);
  const std::size_t flags = 0xDD + 66 + 1;
  ASSERT_EQ(bytes[flags], 1);
  bytes[flags] = 0;
  reseal(bytes);
  EXPECT_EQ(decode_plan(bytes).error, PlanError::kVersion);
  bytes[flags] = 4;
  reseal(bytes);
  EXPECT_EQ(decode_plan(bytes).error, PlanError::kRange);
  EXPECT_EQ(decode_plan(bytes).field, "axes");
  bytes[flags] = 1;
  bytes[flags - 1] = 0x40;
  reseal(bytes);
  EXPECT_EQ(decode_plan(bytes).field, "sensed_axes");
}

TEST(PlanCodec, AnEnvelopeOnlyGrows) {
  const Plan plan = long_plan(0b111111, 15, {Outcome::kContact});
  const Plan back = decoded(encode_plan(plan));
  int grown = 0;
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const Envelope& before = plan.steps[i].rule(Outcome::kContact).envelope;
    const Envelope& after = back.steps[i].rule(Outcome::kContact).envelope;
    for (int axis = 0; axis < 6; ++axis) {
      EXPECT_LE(after.travelled_min[axis], before.travelled_min[axis]);
      EXPECT_GE(after.travelled_max[axis], before.travelled_max[axis]);
      // By less than one unit in the last place of a float.
      EXPECT_NEAR(after.travelled_min[axis], before.travelled_min[axis], 1e-7);
      EXPECT_NEAR(after.travelled_max[axis], before.travelled_max[axis], 1e-7);
      grown += after.travelled_min[axis] < before.travelled_min[axis] ? 1 : 0;
    }
  }
  EXPECT_GT(grown, 40);
}

TEST(PlanCodec, WhatWasDecodedEncodesToTheSameBytes) {
  for (const Plan& plan :
       {documented_plan(), long_plan(0b000011, 15, {Outcome::kReached, Outcome::kContact}),
        long_plan(0b111111, 200, {Outcome::kRelease, Outcome::kBlocked})}) {
    const Bytes bytes = encode_plan(plan);
    EXPECT_EQ(encode_plan(decoded(bytes)), bytes);
  }
}

TEST(PlanCodec, FifteenStepsFitInTwoKilobytes) {
  EXPECT_LE(encode_plan(long_plan(0b000011, 15, {Outcome::kReached, Outcome::kContact})).size(),
            1200U);
  EXPECT_LE(encode_plan(long_plan(0b111111, 15, {Outcome::kContact})).size(), 1700U);
}

TEST(PlanCodec, EveryTruncationIsRefused) {
  const Bytes bytes = encode_plan(long_plan(0b000011, 15, {Outcome::kReached, Outcome::kContact}));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const DecodedPlan result = decode_plan(std::span(bytes).first(size));
    EXPECT_FALSE(result.plan.has_value());
    EXPECT_EQ(result.error, size < 209 ? PlanError::kTooShort : PlanError::kLength) << size;
  }
}

TEST(PlanCodec, EverySingleFlippedBitIsRefused) {
  Bytes bytes = encode_plan(long_plan(0b000011, 15, {Outcome::kReached, Outcome::kContact}));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1U << bit % 8);
    bytes[bit / 8] ^= mask;
    const DecodedPlan result = decode_plan(bytes);
    bytes[bit / 8] ^= mask;
    EXPECT_FALSE(result.plan.has_value()) << "bit " << bit;
    PlanError expected = PlanError::kChecksum;
    if (bit / 8 < 4) expected = PlanError::kMagic;
    const bool other_version = bit != 33;  // 1 becomes 3, which there is
    if ((bit / 8 == 4 || bit / 8 == 5) && other_version) expected = PlanError::kVersion;
    if (bit / 8 >= 8 && bit / 8 < 12) expected = PlanError::kLength;
    EXPECT_EQ(result.error, expected) << "bit " << bit;
  }
}

TEST(PlanCodec, TruncationIsNamedEvenUnderARightLengthAndChecksum) {
  const Bytes whole = encode_plan(documented_plan());
  for (std::size_t size = 209; size < whole.size(); ++size) {
    Bytes bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    reseal(bytes);
    EXPECT_NE(decode_plan(bytes).error, PlanError::kNone) << size;
  }
  Bytes longer = whole;
  longer.push_back(0);
  reseal(longer);
  EXPECT_EQ(decode_plan(longer).error, PlanError::kTrailing);
  EXPECT_EQ(decode_plan(longer).offset, whole.size() - 4);
}

// Offsets as FORMAT.md's dump gives them.
struct Mutation {
  std::size_t offset;
  Bytes bytes;
  PlanError error;
  const char* field;
};

const Bytes kNan = {0x00, 0x00, 0xC0, 0x7F};
const Bytes kInfinity = {0x00, 0x00, 0x80, 0x7F};
const Bytes kMinusOne = {0x00, 0x00, 0x80, 0xBF};
const Bytes kZero = {0x00, 0x00, 0x00, 0x00};
const Bytes kHundred = {0x00, 0x00, 0xC8, 0x42};

void expect_named(const std::vector<Mutation>& mutations) {
  const Bytes whole = encode_plan(documented_plan());
  for (const Mutation& mutation : mutations) {
    Bytes bytes = whole;
    std::copy(mutation.bytes.begin(), mutation.bytes.end(),
              bytes.begin() + static_cast<std::ptrdiff_t>(mutation.offset));
    reseal(bytes);
    const DecodedPlan result = decode_plan(bytes);
    EXPECT_FALSE(result.plan.has_value()) << mutation.field;
    EXPECT_STREQ(to_string(result.error), to_string(mutation.error)) << mutation.field;
    EXPECT_EQ(result.field, mutation.field);
  }
}

TEST(PlanCodec, EveryBadValueOfTheHeaderIsNamedWithItsFieldAndByte) {
  expect_named({
      {0x06, {0x06}, PlanError::kRange, "flags"},
      {0x06, {0x09}, PlanError::kRange, "flags"},
      {0x07, {0x00}, PlanError::kRange, "coordinates"},
      {0x07, {0x40}, PlanError::kRange, "coordinates"},
      {0x14, {0, 0, 0, 0, 0, 0, 0xF8, 0x7F}, PlanError::kNotFinite, "start_position_m"},
      {0x14, {0, 0, 0, 0, 0, 0x88, 0xC3, 0x40}, PlanError::kRange, "start_position_m"},
      {0x2C, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F}, PlanError::kRange, "start_orientation"},
      {0x84, kZero, PlanError::kRange, "goal_tolerance_m"},
      {0x88, kNan, PlanError::kNotFinite, "mass_kg"},
      {0x8C, kMinusOne, PlanError::kRange, "damping_Nspm"},
      {0xA0, {0x40}, PlanError::kRange, "compliant_axes"},
      {0xA1, kInfinity, PlanError::kNotFinite, "force_limit_N"},
      {0xA1, kMinusOne, PlanError::kRange, "force_limit_N"},
      {0xAD, kHundred, PlanError::kRange, "latency_max_s"},
      {0xB1, {0, 0, 0, 0, 0, 0, 0xF0, 0xBF}, PlanError::kRange, "cost"},
      {0xB9, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F}, PlanError::kRange, "bound"},
      {0xC5, {0xC9}, PlanError::kRange, "draws_at_goal"},
      {0xC9, {0x40}, PlanError::kText, "task_name"},
      {0xCA, {0x0A}, PlanError::kText, "task_name"},
  });
}

TEST(PlanCodec, EveryBadValueOfSetsAndStepsIsNamedWithItsFieldAndByte) {
  expect_named({
      {0xDB, {0x00}, PlanError::kCount, "parameter_set_count"},
      {0xDB, {0xC9}, PlanError::kCount, "parameter_set_count"},
      {0xDB, {0xC8}, PlanError::kTruncated, "step_count"},
      {0xDC, {0x00}, PlanError::kCount, "step_count"},
      {0xDC, {0xC9}, PlanError::kCount, "step_count"},
      {0xDC, {0xC8}, PlanError::kTruncated, "step_count"},
      {0xDC, {0x04}, PlanError::kTruncated, "parameter_set"},
      {0xDC, {0x02}, PlanError::kSuccessor, "successor"},
      {0xDD, kHundred, PlanError::kRange, "approach_mps"},
      {0xFD, kHundred, PlanError::kRange, "thresholds"},
      {0x101, kZero, PlanError::kRange, "force_keep_N"},
      {0x101, {0x00, 0x00, 0xE0, 0x40}, PlanError::kRange, "thresholds"},
      {0x118, {0x01}, PlanError::kRange, "debounce_us"},
      {0x119, kZero, PlanError::kRange, "timeout_us"},
      {0x11D, {0xFF, 0x1F}, PlanError::kRange, "trigger_mask"},
      {0x11F, {0x01}, PlanError::kIndex, "parameter_set"},
      {0x120, {0x22}, PlanError::kRange, "outcomes"},
      {0x121, kMinusOne, PlanError::kRange, "slow_from_m"},
      {0x125, kNan, PlanError::kNotFinite, "displacement"},
      {0x125, kHundred, PlanError::kRange, "displacement"},
      {0x12D, {0x00}, PlanError::kSuccessor, "successor"},
      {0x12D, {0x03}, PlanError::kSuccessor, "successor"},
      {0x12D, {0xFF}, PlanError::kSuccessor, "successor"},
      {0x150, {0x01}, PlanError::kSuccessor, "successor"},
      {0x12E, {0x00, 0x10}, PlanError::kRange, "always"},
      {0x12E, {0x03}, PlanError::kRange, "possible"},
      {0x132, kInfinity, PlanError::kNotFinite, "travelled_min"},
      {0x136, kMinusOne, PlanError::kRange, "travelled_max"},
  });
}

TEST(PlanCodec, RandomDamageUnderARightChecksumIsRefusedOrHasOneEncoding) {
  std::mt19937 random(7);
  const Bytes whole = encode_plan(documented_plan());
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = whole;
    for (int i = 0; i <= round % 3; ++i) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    reseal(bytes);
    const DecodedPlan result = decode_plan(bytes);
    EXPECT_EQ(result.plan.has_value(), result.error == PlanError::kNone);
    if (!result.plan) continue;
    ++accepted;
    EXPECT_EQ(encode_plan(*result.plan), bytes);
  }
  EXPECT_GT(accepted, 1000);  // most bytes are harmless digits of a float
}

std::string refusal(const Plan& plan) {
  return tests::refusal([&] { (void)encode_plan(plan); });
}

TEST(PlanCodec, EncodingRefusesWhatCannotBeRepresented) {
  const auto changed = [](auto change) {
    Plan plan = documented_plan();
    change(plan);
    return refusal(plan);
  };
  const std::string prefix = "plan cannot be encoded: ";
  EXPECT_EQ(changed([](Plan&) {}), "accepted");
  EXPECT_EQ(changed([](Plan& p) { p.task_name = std::string(64, 'a'); }),
            prefix + "a name is longer than 63 bytes");
  EXPECT_EQ(changed([](Plan& p) { p.steps.resize(201, p.steps.front()); }),
            prefix + "201 steps, at most 200");
  EXPECT_EQ(changed([](Plan& p) { p.parameter_sets.resize(201); }),
            prefix + "201 parameter sets, at most 200");
  EXPECT_EQ(changed([](Plan& p) { p.steps[1].displacement[2] = 1e-6; }),
            prefix +
                "step 1 has a displacement or an envelope along axis 2, which is not one of "
                "the plan's coordinates");
  EXPECT_EQ(changed([](Plan& p) { p.steps.clear(); }),
            prefix + "step_count: a count outside its range (byte 220)");
  EXPECT_EQ(changed([](Plan& p) { p.steps[2].displacement[0] = std::nan(""); }),
            prefix + "displacement: not a finite number (byte 363)");
  EXPECT_EQ(changed([](Plan& p) { p.cost = std::numeric_limits<double>::infinity(); }),
            prefix + "cost: not a finite number (byte 177)");
  EXPECT_EQ(changed([](Plan& p) { p.goal_tolerance_m = 1e-60; }),  // no float but 0
            prefix + "goal_tolerance_m: a value outside its range (byte 132)");
  EXPECT_EQ(changed([](Plan& p) { p.steps[0].outcomes[1].successor = 0; }),
            prefix + "successor: a successor that is neither a later step nor done (byte 301)");
  EXPECT_EQ(changed([](Plan& p) { p.start_name = "\xC3\xA9"; }),
            prefix +
                "start_name: a name that is not at most 63 printable ASCII characters "
                "(byte 218)");
}

}  // namespace
}  // namespace tenon
