// A drive that does not answer, on a bus where the others do.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/bad_input.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

TEST(MissingDrive, IsNamedWithWhatWasExpected) {
  const ScratchFolder folder;
  const std::string elsewhere =
      cell_around(folder, "elsewhere.yaml",
                  edited(folder, "robot.yaml", robot_file(), "    node: 3\n", "    node: 30\n"));
  SimProcess sim(folder.path(), "4", {}, elsewhere);
  expect_refused(
      folder, {{executable("tenon-exec"), "--cell", gantry_cell_file(), "--plan",
                put_box_plan(folder, "4"), "--can", sim.uri(), "--rt", "off", "--lcm-url", "none"},
               {"node 3 (z)", "expected 0x703"}});
}

}  // namespace
}  // namespace tenon::tests
