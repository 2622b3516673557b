// How a plan was found, as it is written, read back, and told.

#include "planner/report/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "planner/report/html_report.h"
#include "planner/report/search_section.h"
#include "tests/planner/room_plan.h"
#include "tests/support/refusal.h"

namespace tenon::planner {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// A ledge stops some starts short, which refutes paths.
PlanReport refuted_and_planned() {
  WallRollout::World world = room();
  world.ledge_m = 0.05;
  world.ledge_from_y_m = -0.095;
  world.ledge_to_y_m = -0.065;
  return planned(room_task(), world);
}

SearchStory story_of(const PlanReport& report) {
  return read_statistics("stats.json", statistics_json(report, room_task()), report.bytes);
}

std::size_t sum(const std::vector<std::size_t>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), std::size_t{0});
}

TEST(Statistics, ReadBackTheyTellOfEverySearch) {
  const PlanReport report = refuted_and_planned();
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  ASSERT_GE(report.refusals.size(), 1U);
  const SearchStory story = story_of(report);
  EXPECT_EQ(story.heuristics.size(), report.guides + 1);
  EXPECT_EQ(story.heuristics.front(), "anchor");
  ASSERT_EQ(story.rounds.size(), report.refusals.size() + 1);
  std::size_t expansions = 0;
  for (const SearchRound& round : story.rounds) {
    EXPECT_EQ(round.expansions.size(), story.heuristics.size());
    EXPECT_LE(round.lower_bound, round.cost);
    expansions += sum(round.expansions);
  }
  EXPECT_EQ(expansions, report.expansions);
  EXPECT_EQ(sum(story.rounds.front().expansions), report.expansions_first);
  for (std::size_t i = 0; i < report.refusals.size(); ++i) {
    EXPECT_EQ(story.rounds[i].outcome, "refuted: " + report.refusals[i]);
  }
  EXPECT_EQ(story.rounds.back().outcome, "the plan");
  EXPECT_EQ(story.rounds.back().steps, report.plan->steps.size());
  EXPECT_EQ(story.bound, report.plan->bound);
  EXPECT_EQ(story.states, report.states);
  ASSERT_EQ(story.phases.size(), 5U);
  EXPECT_EQ(story.phases[1].moves, report.search_moves.rollouts);
  EXPECT_EQ(story.phases[3].moves, report.judging.corners.moves);
  EXPECT_EQ(story.phases[4].moves, report.judging.validation.moves);
}

TEST(Statistics, TheCourseEndsAtTheCostAndBoundOfTheSearchHoweverLongItWas) {
  PlanReport report = planned(room_task());
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  for (const std::size_t expansions : {1U, 2U, 199U, 200U, 201U, 5000U}) {
    report.search.lower_bounds.assign(expansions, 0.25 * report.search.lower_bound);
    report.search.costs.assign(expansions, std::numeric_limits<double>::infinity());
    const SearchStory story = story_of(report);
    EXPECT_LE(story.costs.size(), 201U);
    EXPECT_TRUE(std::is_sorted(story.expansions.begin(), story.expansions.end()));
    EXPECT_EQ(story.expansions.back(), expansions);
    EXPECT_FALSE(std::isfinite(story.costs.front()));
    EXPECT_EQ(story.costs.back(), report.search.cost);
    EXPECT_EQ(story.lower_bounds.back(), report.search.lower_bound);
  }
}

TEST(Statistics, AnotherPlansAreRefused) {
  const PlanReport report = planned(room_task());
  const std::string text = statistics_json(report, room_task());
  std::vector<std::uint8_t> other = report.bytes;
  other[40] ^= 1;
  EXPECT_THAT(tests::refusal([&] { (void)read_statistics("stats.json", text, other); }),
              HasSubstr("stats.json: it is of another plan"));
}

// Where a number belongs, lists within lists, as deep as a file of 200 kB holds them.
TEST(Statistics, ListsWithinListsAreRefusedHoweverDeep) {
  constexpr std::size_t kDeep = 100'000;
  const std::string nested = std::string(kDeep, '[') + std::string(kDeep, ']');
  for (const std::string& text : {R"({"status":"planned","bytes":)" + nested + "}", nested}) {
    EXPECT_THAT(tests::refusal([&] { (void)read_statistics("stats.json", text, {}); }),
                HasSubstr("give the file that tenon-plan wrote"));
  }
}

// Each of them looked for among all others would take a quarter of an hour.
TEST(Statistics, SixHundredThousandKeysThatAreNoneOfThemAreRefused) {
  std::string text = "{";
  for (int i = 0; i < 600'000; ++i) text += "\"k" + std::to_string(i) + "\":1,";
  text.back() = '}';
  EXPECT_THAT(tests::refusal([&] { (void)read_statistics("stats.json", text, {}); }),
              HasSubstr("key 'status' not found"));
}

TEST(Statistics, WhatIsMissingOrWrongIsRefusedInALine) {
  const PlanReport report = planned(room_task());
  const json whole = json::parse(statistics_json(report, room_task()));
  const auto refusal_of = [&](const json& changed) {
    return tests::refusal(
        [&] { (void)read_statistics("stats.json", changed.dump(), report.bytes); });
  };
  for (const char* key :
       {"/status", "/bytes", "/crc32c", "/bound", "/guide", "/states", "/heuristics",
        "/heuristics/0", "/searches", "/searches/0/w1", "/searches/0/expansions",
        "/searches/0/cost", "/searches/0/outcome", "/course", "/course/cost",
        "/course/expansions/1", "/moves/search", "/moves/search/simulated", "/time_s/validation"}) {
    for (const json& wrong : {json("x\ny"), json(-1), json(nullptr), json::array({1}), json()}) {
      json changed = whole;
      json& value = changed[json::json_pointer(key)];
      const bool text = value.is_string();
      if (text && wrong.is_string() && std::string(key) != "/status") continue;
      value = wrong;
      const std::string said = refusal_of(changed);
      EXPECT_THAT(said, HasSubstr("stats.json: ")) << key << " = " << wrong;
      EXPECT_THAT(said, HasSubstr("give the file that tenon-plan wrote")) << key << " = " << wrong;
      EXPECT_THAT(said, Not(HasSubstr("\n"))) << key;
    }
  }
  EXPECT_THAT(tests::refusal([&] { (void)read_statistics("stats.json", "no", report.bytes); }),
              HasSubstr("stats.json: "));
}

TEST(SearchSection, NamesQueuesPathsBoundAndPhases) {
  const PlanReport report = refuted_and_planned();
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  SearchStory story = story_of(report);
  story.heuristics.back() = "a <b> & 'c'";
  const std::string html = search_section(story);
  for (const char* words :
       {"<h2 id='search'>The search</h2>", "role='img' aria-label='", "times the optimum",
        "a &lt;b&gt; &amp;", "missed the goal", "the plan", "Looking for guides", "Validating"}) {
    EXPECT_THAT(html, HasSubstr(words));
  }
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  const std::string text = search_text(story);
  EXPECT_THAT(text, HasSubstr("expansions by anchor\n"));
  EXPECT_THAT(text, HasSubstr(" moves: validation\n"));
}

TEST(SearchSection, OfAFollowedGuideClaimsNoBound) {
  SearchStory story = story_of(planned(room_task()));
  story.guide = "+x to a face";
  story.rounds.clear();
  story.expansions.clear();
  const std::string text = search_text(story);
  EXPECT_THAT(text,
              HasSubstr("follows the guide +x to a face to the letter. Nothing was searched"));
  EXPECT_THAT(text, HasSubstr("No bound is proven."));
  EXPECT_THAT(text, Not(HasSubstr("expansions by")));
}

TEST(SearchSection, StandsOnThePageOnlyWhereItIsKnown) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  const SearchStory story = story_of(report);
  const auto page = [&](const SearchStory* told) {
    return html_report(*report.plan, task, report.certification, report.validation, told);
  };
  EXPECT_THAT(page(&story), HasSubstr("id='search'"));
  EXPECT_THAT(page(nullptr), Not(HasSubstr("id='search'")));
}

}  // namespace
}  // namespace tenon::planner
