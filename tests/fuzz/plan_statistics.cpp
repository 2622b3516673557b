// The statistics of a planning of arbitrary text (tenon-plan --json), as tenon-inspect reads them
// back and tells them: in lines, and as a section of the plan's page.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "planner/plan_report.h"
#include "planner/report/search_section.h"
#include "planner/report/statistics.h"
#include "tests/fuzz/support/refused.h"

namespace {

using namespace tenon;
using fuzz::must;

// In place of a plan's bytes: the digits by whose checksum CRC-32C is known, 0xE3069283. The seeds
// have it.
constexpr std::array<std::uint8_t, 9> kPlan = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

void check(const planner::SearchStory& story) {
  must(story.lower_bounds.size() == story.expansions.size() &&
           story.costs.size() == story.expansions.size(),
       "a course has as many values of each kind");
  must(std::is_sorted(story.expansions.begin(), story.expansions.end()),
       "expansions are counted up");
  for (const double bound : story.lower_bounds) {
    must(std::isfinite(bound) && bound >= 0.0, "a bound is a number");
  }
  for (const double cost : story.costs) must(cost >= 0.0, "a cost is one, or is infinite");
  for (const planner::SearchRound& round : story.rounds) {
    must(round.expansions.size() == story.heuristics.size(), "a search has all queues");
    must(fuzz::obeys_nothing(round.outcome), "what came of it is a line");
  }
}

/// Of texts whose line breaks are ours alone.
std::string without_breaks(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  return text;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  planner::SearchStory story;
  if (!fuzz::accepted([&] { story = planner::read_statistics("stats.json", text, kPlan); })) {
    return 0;
  }
  check(story);
  for (const std::string& told : {planner::search_text(story), planner::search_section(story)}) {
    must(fuzz::obeys_nothing(without_breaks(told)), "no control byte is shown");
    must(told.find("nan") == std::string::npos || text.find("nan") != std::string::npos,
         "what is told are numbers");
  }
  return 0;
}
