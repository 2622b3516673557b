#pragma once
// What the executables do with input that is wrong, and files that are wrong in one place.

#include <string>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace tenon::tests {

struct BadInput {
  std::vector<std::string> command;
  std::vector<std::string> named;  ///< all of it stands in the line
};

/// Exit status 2, and one line that begins with the program's name.
void expect_refused(const ScratchFolder& folder, const BadInput& bad);

/// A copy of a file in which the first place where one text stands holds another.
[[nodiscard]] std::string edited(const ScratchFolder& folder, const std::string& name,
                                 const std::string& source, const std::string& piece,
                                 const std::string& instead);

/// The gantry's cell around another robot file, which finds the gantry's URDF beside itself.
[[nodiscard]] std::string cell_around(const ScratchFolder& folder, const std::string& name,
                                      const std::string& robot_file);

/// The gantry's.
[[nodiscard]] std::string robot_file();

}  // namespace tenon::tests
