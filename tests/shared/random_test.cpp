// The source of randomness: published numbers, its distributions, and streams that have nothing
// to do with each other.

#include "shared/base/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>

#include "shared/base/fnv.h"

namespace tenon {
namespace {

// The first outputs of splitmix64 for the seed 1234567, as its authors' reference gives them.
TEST(Random, UniformNumbersAreSplitmixsUpper53Bits) {
  Random random(1234567);
  for (const std::uint64_t output :
       {6457827717110365317U, 3203168211198807973U, 9817491932198370423U, 4593380528125082431U}) {
    EXPECT_EQ(random.uniform(), static_cast<double>(output >> 11U) * 0x1p-53);
  }
}

// Plans follow from these: another number is another plan.
TEST(Random, NormalNumbersStayWhatTheyWere) {
  Random random(1);
  for (const double expected : {-0x1.be6db6b9bd314p-2, -0x1.990cd70b12c5dp+0, -0x1.a58c3dd64f442p-1,
                                -0x1.dc3320bb97ca6p+0, 0x1.79e6b6db6be77p-1, -0x1.31a1fe87c2e7p-1})
    EXPECT_EQ(random.normal(), expected);
}

TEST(Random, NormalNumbersHaveTheMomentsAndTailsOfTheNormalDistribution) {
  Random random(42);
  constexpr int kCount = 200000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  int beyond_one = 0, beyond_two = 0, beyond_three = 0;
  for (int i = 0; i < kCount; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
    beyond_one += std::abs(z) > 1.0 ? 1 : 0;
    beyond_two += std::abs(z) > 2.0 ? 1 : 0;
    beyond_three += std::abs(z) > 3.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(fourth / kCount, 3.0, 0.12);
  const auto expected = [](double sigmas) { return kCount * std::erfc(sigmas / std::sqrt(2.0)); };
  EXPECT_NEAR(beyond_one, expected(1.0), 4.0 * std::sqrt(expected(1.0)));
  EXPECT_NEAR(beyond_two, expected(2.0), 4.0 * std::sqrt(expected(2.0)));
  EXPECT_NEAR(beyond_three, expected(3.0), 4.0 * std::sqrt(expected(3.0)));
}

TEST(Random, AStreamsSeedIsSplitmixOverSplitmix) {
  // The first output for the seed 0 is E220A8397B1DCDAFh; this is the first for that seed.
  EXPECT_EQ(stream_seed(0, 0), 0xA706DD2F4D197E6FU);
  EXPECT_EQ(stream_seed(7, "a"), stream_seed(7, 0xAF63DC4C8601EC8C));
}

TEST(Random, NeighbouringSeedsNumbersAndNamesGiveSeedsThatDifferInHalfTheirBits) {
  std::set<std::uint64_t> seeds;
  double bits = 0.0;
  constexpr int kCount = 1000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const std::uint64_t one = stream_seed(i, i);
    const std::string name = "stream " + std::to_string(i);
    for (const std::uint64_t other :
         {stream_seed(i + 1, i), stream_seed(i, i + 1), stream_seed(i, name)}) {
      seeds.insert(other);
      bits += std::popcount(one ^ other);
    }
  }
  EXPECT_EQ(seeds.size(), 3U * kCount);
  // Of 64 bits each differs with probability 1/2; five standard deviations.
  EXPECT_NEAR(bits / (3.0 * kCount), 32.0, 5.0 * 4.0 / std::sqrt(3.0 * kCount));
}

TEST(Random, StreamsOfOneSeedAreNotCorrelated) {
  constexpr int kCount = 20000;
  Random one(stream_seed(5, "sensor_noise"));
  Random two(stream_seed(5, "environment_offset"));
  double products = 0.0;
  for (int i = 0; i < kCount; ++i) products += one.normal() * two.normal();
  EXPECT_NEAR(products / kCount, 0.0, 5.0 / std::sqrt(kCount));
}

TEST(Hash, GivesThePublishedValuesOfFnv1a) {
  EXPECT_EQ(fnv1a_64({}), 0xCBF29CE484222325);
  EXPECT_EQ(fnv1a_64("a"), 0xAF63DC4C8601EC8C);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171F73967E8);
  EXPECT_EQ(fnv1a_64("bar", fnv1a_64("foo")), 0x85944171F73967E8) << "in two parts";
}

}  // namespace
}  // namespace tenon
