#pragma once
// What came of an identification, for people and for result.json.

#include <string>
#include <utility>
#include <vector>

namespace tenon::executor {

struct Finding {
  bool found = false;
  std::string status;  ///< "identified", or why not in a word
  std::string report;  ///< lines for people, with what the files should say; or why not
  /// Name with unit, and one value, three, or one a joint; empty unless found.
  std::vector<std::pair<std::string, std::vector<double>>> values;
  std::string file{};  ///< what goes into a file of its own; empty: nothing does
};

}  // namespace tenon::executor
