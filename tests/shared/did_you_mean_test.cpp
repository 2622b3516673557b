#include "shared/base/did_you_mean.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tenon {
namespace {

constexpr std::array<std::string_view, 5> kWords = {"environment", "tolerance_m", "held", "goal",
                                                    "starts"};

TEST(DidYouMean, TheNearestWordIsNamed) {
  EXPECT_EQ(nearest_word("enviroment", kWords), "environment");    // too few
  EXPECT_EQ(nearest_word("environnment", kWords), "environment");  // too many
  EXPECT_EQ(nearest_word("gaol", kWords), "goal");                 // exchanged: one slip
  EXPECT_EQ(nearest_word("stirts", kWords), "starts");             // another
  EXPECT_EQ(did_you_mean("helt", kWords), "; did you mean held?");
}

TEST(DidYouMean, AKeyWithoutItsUnitIsTheOneWithIt) {
  EXPECT_EQ(nearest_word("tolerance", kWords), "tolerance_m");
  EXPECT_EQ(nearest_word("tolerance_mm", kWords), "tolerance_m");
}

TEST(DidYouMean, WhatIsFarFromEveryWordIsNotGuessed) {
  for (const char* word : {"", "x", "colour", "compliance", "helium_n"}) {
    EXPECT_EQ(did_you_mean(word, kWords), "") << word;
  }
  EXPECT_EQ(nearest_word(std::string(1'000'000, 'g'), kWords), "");
}

TEST(DidYouMean, AnotherNumberIsNoSlip) {
  constexpr std::array<std::string_view, 3> kStarts = {"11", "12", "500000"};
  EXPECT_EQ(nearest_word("13", kStarts), "");
  EXPECT_EQ(nearest_word("600000", kStarts), "");
}

TEST(DidYouMean, OfOneLetterNothingIsLeftToKnowItBy) {
  constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
  EXPECT_EQ(nearest_word("w", kAxes), "");
}

}  // namespace
}  // namespace tenon
