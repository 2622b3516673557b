#pragma once
// How the plan was found, for people. Pure; any thread.

#include <string>

#include "planner/report/statistics.h"

namespace tenon::planner {

/// A section of the page: which queue led, cost against bound, every path, and what it took.
[[nodiscard]] std::string search_section(const SearchStory& story);

/// The same in a few lines.
[[nodiscard]] std::string search_text(const SearchStory& story);

}  // namespace tenon::planner
