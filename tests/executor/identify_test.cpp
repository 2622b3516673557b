// The estimators alone, on readings and recordings whose truth is known.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "executor/identification/identify_contact.h"
#include "executor/identification/identify_payload.h"

namespace tenon::executor {
namespace {

constexpr double kG_mps2 = 9.80665;

Vector6 resting(double mass_kg, const Vector3& com_m, const Vector6& bias, const Vector3& g_S) {
  Vector6 wrench;
  wrench << mass_kg * g_S, com_m.cross(Vector3(mass_kg * g_S));
  return wrench + bias;
}

// Nine poses: the corners of three turns of 0.5 rad, and none.
std::vector<Vector3> gravity_in_nine_poses() {
  std::vector<Vector3> all = {Vector3(0.0, 0.0, kG_mps2)};
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto angle = [&](unsigned bit) { return (corner >> bit & 1U) != 0 ? 0.5 : -0.5; };
    const Eigen::Quaterniond turned = Eigen::AngleAxisd(angle(0), Vector3::UnitZ()) *
                                      Eigen::AngleAxisd(angle(1), Vector3::UnitY()) *
                                      Eigen::AngleAxisd(angle(2), Vector3::UnitZ());
    all.push_back(turned * Vector3(0.0, 0.0, kG_mps2));
  }
  return all;
}

TEST(IdentifyPayload, MassWithinAPercentAndCentreWithinAMillimetreUnderNoise) {
  constexpr int kSamples = 400;
  const Vector3 com_m(0.01, -0.02, 0.12);
  Vector6 bias;
  bias << 12.0, -7.0, 20.0, 0.3, -0.4, 0.2;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double worst_mass = 0.0;
  double worst_m = 0.0;
  for (const double mass_kg : {0.5, 1.0, 3.0}) {
    for (int run = 0; run < 50; ++run) {
      std::vector<RestReading> readings;
      for (const Vector3& g_S : gravity_in_nine_poses()) {
        RestReading reading{g_S, resting(mass_kg, com_m, bias, g_S)};
        for (int axis = 0; axis < 6; ++axis) {
          reading.wrench[axis] += (axis < 3 ? 0.2 : 0.01) / std::sqrt(kSamples) * normal(random);
        }
        readings.push_back(reading);
      }
      const PayloadIdentification found = identify_payload(readings);
      ASSERT_EQ(found.status, PayloadIdentification::Status::kIdentified);
      worst_mass = std::max(worst_mass, std::abs(found.mass_kg / mass_kg - 1.0));
      worst_m = std::max(worst_m, (found.com_m - com_m).norm());
      EXPECT_LT((found.force_bias_N - bias.head<3>()).norm(), 0.1);
      EXPECT_LT(std::abs(found.mass_kg - mass_kg), 5.0 * found.mass_deviation_kg);
    }
  }
  EXPECT_LT(worst_mass, 0.01);
  EXPECT_LT(worst_m, 1e-3);
}

TEST(IdentifyPayload, AnExactReadingLeavesNoResidual) {
  std::vector<RestReading> readings;
  const Vector3 com_m(0.03, 0.02, -0.05);
  for (const Vector3& g_S : gravity_in_nine_poses()) {
    readings.push_back({g_S, resting(0.7, com_m, Vector6::Ones(), g_S)});
  }
  const PayloadIdentification found = identify_payload(readings);
  EXPECT_NEAR(found.mass_kg, 0.7, 1e-12);
  EXPECT_LT((found.com_m - com_m).norm(), 1e-12);
  EXPECT_LT((found.torque_bias_Nm - Vector3::Ones()).norm(), 1e-12);
  EXPECT_LT(found.force_residual_N + found.torque_residual_Nm, 1e-12);
  EXPECT_NE(describe(found).find("payload: {mass_kg: 0.7000, com_m: [0.0300, 0.0200, -0.0500]}"),
            std::string::npos)
      << describe(found);
  EXPECT_NE(describe(found).find(
                "sensor_bias: {force_N: [1.00, 1.00, 1.00], torque_Nm: [1.000, 1.000, 1.000], "
                "force_tolerance_N: 0.05, torque_tolerance_Nm: 0.005}"),
            std::string::npos)
      << describe(found);
}

TEST(IdentifyPayload, AGantryIsToldThatOnlyTheWeightsProjectionIsSeen) {
  const Vector3 g_S(0.0, 0.0, -kG_mps2);
  const PayloadIdentification found =
      identify_payload({{g_S, resting(0.5, {0.0, 0.0, 0.1}, Vector6::Zero(), g_S)}});
  EXPECT_EQ(found.status, PayloadIdentification::Status::kNotTurned);
  EXPECT_NEAR(found.apparent_mass_kg, 0.5, 1e-12);
  EXPECT_NE(describe(found).find("does not turn its sensor"), std::string::npos);
  EXPECT_NE(describe(found).find("0.500 kg"), std::string::npos);
}

TEST(IdentifyPayload, TurningAboutOneAxisAloneIsRefused) {
  std::vector<RestReading> readings;
  for (const double angle : {0.0, 0.1, 0.2, -0.1, -0.2}) {
    const Vector3 g_S = kG_mps2 * Vector3(std::sin(angle), 0.0, std::cos(angle));
    readings.push_back({g_S, resting(1.0, Vector3::UnitZ(), Vector6::Zero(), g_S)});
  }
  EXPECT_EQ(identify_payload(readings).status, PayloadIdentification::Status::kTurnedTooLittle);
}

// depth   /\/\/\/\   force the same a delay later, k times as large
std::vector<PressSample> wave(double stiffness_Npm, double delay_s, double cycle_s,
                              double noise_N) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto depth_m = [&](double time_s) {
    const double phase = std::fmod(std::max(0.0, time_s), 0.8);
    return 15.0 / stiffness_Npm * (phase < 0.4 ? phase : 0.8 - phase) / 0.4;
  };
  std::vector<PressSample> samples;
  for (int i = 0; i * cycle_s < 5.0; ++i) {
    const double time_s = i * cycle_s;
    samples.push_back({depth_m(time_s),
                       5.0 + stiffness_Npm * depth_m(time_s - delay_s) + noise_N * normal(random),
                       true});
  }
  return samples;
}

TEST(IdentifyContact, StiffnessAndDelayOfADelayedSpringAreFound) {
  for (const double cycle_s : {2e-3, 10e-3}) {
    for (const double stiffness_Npm : {5e3, 3e4, 1e5}) {
      for (const double delay_s : {0.003, 0.011, 0.035}) {
        const ContactIdentification found =
            identify_contact(wave(stiffness_Npm, delay_s, cycle_s, 0.1), cycle_s);
        ASSERT_EQ(found.status, ContactIdentification::Status::kIdentified);
        EXPECT_NEAR(found.stiffness_Npm, stiffness_Npm, 0.01 * stiffness_Npm);
        EXPECT_NEAR(found.delay_s, delay_s, 3e-4);
        EXPECT_NEAR(found.delay_s, delay_s, 5.0 * found.delay_deviation_s + 1e-4);
        EXPECT_NEAR(found.lag_s, std::max(0.0, delay_s - 0.5 * cycle_s), 3e-4);
      }
    }
  }
}

TEST(IdentifyContact, TheFileGetsNoLagBelowTheTwoCyclesOfCanopen) {
  const std::string quick = describe(identify_contact(wave(3e4, 0.003, 2e-3, 0.1), 2e-3));
  EXPECT_NE(quick.find("response_lag_s: 0.0040}"), std::string::npos) << quick;
  const std::string slow = describe(identify_contact(wave(3e4, 0.013, 2e-3, 0.0), 2e-3));
  EXPECT_NE(slow.find("response_lag_s: 0.0120}"), std::string::npos) << slow;
}

TEST(IdentifyContact, AForceThatDoesNotFollowTheWayIsNoContact) {
  std::vector<PressSample> samples = wave(1e4, 0.005, 2e-3, 0.0);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (PressSample& sample : samples) sample.force_N = 0.1 * normal(random);
  EXPECT_EQ(identify_contact(samples, 2e-3).status, ContactIdentification::Status::kNoResponse);
}

TEST(IdentifyContact, AShortRecordingIsRefused) {
  std::vector<PressSample> samples = wave(1e4, 0.005, 2e-3, 0.0);
  samples.resize(100);
  EXPECT_EQ(identify_contact(samples, 2e-3).status, ContactIdentification::Status::kTooShort);
}

}  // namespace
}  // namespace tenon::executor
