// What demo.sh makes of a machine that stands still, shown with programs that only say they did
// something.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// demo.sh with programs of which the executor's n-th run ends by the reason that is the n-th line
/// of `reasons`.
Ended demo(const ScratchFolder& folder, const std::string& reasons) {
  const auto put = [&](const std::string& name, const std::string& text) {
    namespace fs = std::filesystem;
    // An option's value is the word behind it.
    const std::string value =
        "value() { while [ \"$1\" != \"$2\" ]; do set -- \"$1\" \"${@:3}\"; done; echo \"$3\"; }\n";
    fs::permissions(folder.put("bin/" + name, "#!/bin/bash\n" + value + text),
                    fs::perms::owner_all);
  };
  folder.put("reasons", reasons);
  put("tenon-plan", "");
  put("tenon-inspect", "");
  put("tenon-sim",
      "echo 'listening on 127.0.0.1:1'; echo 'the part ended'\n"
      "[ ! -e \"${0%/bin/*}/broken\" ] || exit 1\n"
      "printf '{\\n  \"within_tolerance\": true,\\n  \"clock\": {\\n    \"late_max_ms\": 29.6\\n  "
      "}\\n}\\n' >"
      "\"$(value --json \"$@\")\"\n");
  put("tenon-exec",
      "here=${0%/bin/*}\nreason=$(head -n 1 \"$here/reasons\")\nsed -i 1d \"$here/reasons\"\n"
      "printf '{\\n  \"reason\": \"%s\",\\n  \"cycle\": {\\n    \"wakeup_late\": {\\n      "
      "\"max_us\": 1234.5\\n    }\\n  }\\n}\\n' "
      "\"$reason\" >\"$(value --json \"$@\")\"\n"
      "[ \"$reason\" = plan_done ]\n");
  return run(folder, {in_tree("demo.sh"), "--bin", folder.path() / "bin", "--output",
                      folder.path() / "output"});
}

TEST(DemoScript, ARunThatAMachineBrokeOffByStandingStillIsMadeAgain) {
  const ScratchFolder folder;
  const Ended ended = demo(folder, "bus_silent\noverruns\nplan_done\n");
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("stands still or is busy (tenon-exec woke up at most 1 ms late, "
                                   "tenon-sim 30 ms); once more."));
  EXPECT_EQ(folder.get("reasons"), "");
}

TEST(DemoScript, ThreeSuchRunsAreEnough) {
  const ScratchFolder folder;
  const Ended ended = demo(folder, "blind\nfeedback_missing\nfeedback_poor\nplan_done\n");
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("tenon-sim 30 ms).\n"));
  EXPECT_EQ(folder.get("reasons"), "plan_done\n");
}

TEST(DemoScript, AnArmWhoseProgramBrokeDownIsNoMachinesFault) {
  const ScratchFolder folder;
  folder.put("broken", "");
  const Ended ended = demo(folder, "bus_silent\nplan_done\n");
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_THAT(ended.out, Not(HasSubstr("stands still")));
  EXPECT_EQ(folder.get("reasons"), "plan_done\n");
}

TEST(DemoScript, WhateverElseEndsARunIsNoMachinesFault) {
  const ScratchFolder folder;
  const Ended ended = demo(folder, "deviation\nplan_done\n");
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_THAT(ended.out, Not(HasSubstr("stands still")));
  EXPECT_EQ(folder.get("reasons"), "plan_done\n");
}

}  // namespace
}  // namespace tenon::tests
