// What sim/README.md tells people to type, typed.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/child_process.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

TEST(ReadmeExample, ThePythonSnippetPrintsWhatItsCommentSays) {
  // Its port is the one that everybody uses; a network namespace has all ports free.
  const ScratchFolder folder;
  ChildProcess example(
      folder.path(),
      {"unshare", "--net", "/usr/bin/python3", "-B", in_tree("tests/python/readme_snippet.py"),
       in_tree("sim/README.md"), executable("tenon-sim"), gantry_cell_file(), box_task_file()});
  EXPECT_EQ(example.wait(), 0) << example.err() << example.out();
}

}  // namespace
}  // namespace tenon::tests
