#pragma once
// The executables as a user runs them.

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace tenon::tests {

/// What a command left behind.
struct Ended {
  int status = 0;  ///< minus the signal where one ended it
  std::string out;
  std::string err;
};

/// Runs a command to its end, or for so long at most.
[[nodiscard]] Ended run(const ScratchFolder& folder, const std::vector<std::string>& command,
                        std::chrono::seconds most = std::chrono::minutes(2));

/// The shared plan for a start of the box task on the gantry, as start_NAME.tnp in `folder`.
/// @return that file
[[nodiscard]] std::string put_box_plan(const ScratchFolder& folder, const std::string& start);

}  // namespace tenon::tests
