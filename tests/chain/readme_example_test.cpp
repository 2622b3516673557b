// What sim/README.md tells people to type, typed.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/child_process.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

TEST(ReadmeExample, ThePythonSnippetPrintsWhatItsCommentSays) {
  // Its port is the one that everybody uses; a network namespace has all ports free.
  const ScratchFolder folder;
  const std::string source = TENON_SOURCE_DIR;
  ChildProcess example(
      folder.path(),
      {"unshare", "--net", "/usr/bin/python3", "-B", source + "/tests/python/readme_snippet.py",
       source + "/sim/README.md", TENON_SIM_EXE, gantry_cell_file(), box_task_file()});
  EXPECT_EQ(example.wait(), 0) << example.err() << example.out();
}

}  // namespace
}  // namespace tenon::tests
