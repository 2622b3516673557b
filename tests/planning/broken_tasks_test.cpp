// tenon-plan --check on tasks that are wrong: its first line names the cause. The tasks stand in
// broken_tasks.yaml.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/config/load.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"

namespace tenon::tests {
namespace {

std::string changed(std::string task, const YAML::Node& changes) {
  for (const YAML::Node& change : changes) {
    const auto from = change[0].as<std::string>();
    const std::size_t at = task.find(from);
    EXPECT_NE(at, std::string::npos) << "the task has no " << from;
    if (at != std::string::npos) task.replace(at, from.size(), change[1].as<std::string>());
  }
  return task;
}

std::vector<std::string> check_command(const ScratchFolder& folder, const YAML::Node& broken,
                                       const std::string& task) {
  std::vector<std::string> command = {executable("tenon-plan")};
  if (!broken["without_check"]) command.emplace_back("--check");
  for (const YAML::Node& word : broken["before"]) command.push_back(word.as<std::string>());
  if (broken["file"]) {
    command.push_back(in_tree(broken["file"].as<std::string>()));
  } else if (broken["plan"]) {
    command.push_back(shared_plan(broken["plan"].as<std::string>()));
  } else {
    const bool whole = static_cast<bool>(broken["text"]);
    command.push_back(folder.put(
        "task.yaml", whole ? broken["text"].as<std::string>() : changed(task, broken["change"])));
  }
  if (broken["cell"]) {
    command.insert(command.end(), {"--cell", in_tree(broken["cell"].as<std::string>())});
  }
  for (const YAML::Node& option : broken["options"]) command.push_back(option.as<std::string>());
  return command;
}

std::string first_line(const Ended& ended) {
  const std::string text = ended.err + ended.out;
  return text.substr(0, text.find('\n'));
}

TEST(BrokenTasks, TheFirstLineOfTheCheckNamesTheCause) {
  const YAML::Node document = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"));
  const auto task = document["task"].as<std::string>();
  const ScratchFolder folder;
  for (const YAML::Node& broken : document["broken"]) {
    SCOPED_TRACE(broken["name"].as<std::string>());
    const Ended ended = run(folder, check_command(folder, broken, task));
    const std::string line = first_line(ended);
    std::printf("%s:\n    %s\n", broken["name"].as<std::string>().c_str(), line.c_str());
    EXPECT_TRUE(ended.status == 2 || ended.status == 0) << ended.status;
    EXPECT_EQ(line.find("nothing stands against"), std::string::npos) << line;
    for (const YAML::Node& word : broken["says"]) {
      EXPECT_NE(line.find(word.as<std::string>()), std::string::npos)
          << "no " << word << " in: " << line;
    }
  }
  EXPECT_GE(document["broken"].size(), 50U);
}

TEST(BrokenTasks, TheTaskThatTheyBreakIsWhole) {
  const YAML::Node document = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"));
  const ScratchFolder folder;
  const std::string file = folder.put("task.yaml", document["task"].as<std::string>());
  const Ended ended = run(folder, {executable("tenon-plan"), "--check", file});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(first_line(ended), file + ": nothing stands against planning it");
}

TEST(BrokenTasks, NothingStandsAgainstAnyTaskThatShips) {
  const ScratchFolder folder;
  for (const std::string& file : task_files()) {
    std::vector<std::string> names = {file};
    for (const std::string& variant : task_variants(file)) names.push_back(file + "#" + variant);
    for (const std::string& name : names) {
      const Ended ended = run(folder, {executable("tenon-plan"), "--check", name});
      EXPECT_EQ(ended.status, 0) << ended.err << ended.out;
      EXPECT_EQ(first_line(ended), name + ": nothing stands against planning it");
    }
  }
}

TEST(BrokenTasks, ThePageOfACheckHoldsAllThatItsLinesSay) {
  const YAML::Node document = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"));
  const ScratchFolder folder;
  const std::string file = folder.put("task.yaml", document["task"].as<std::string>());
  const std::string page = (folder.path() / "task.html").string();
  const Ended ended = run(folder, {executable("tenon-plan"), "--check", file, "--report", page});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::string html = folder.get("task.html");
  for (const char* part : {"peg", "left", "right", "front", "back", "bottom", "Start above"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("<script"), std::string::npos);
  const Ended over_itself =
      run(folder, {executable("tenon-plan"), "--check", file, "--report", file});
  EXPECT_EQ(over_itself.status, 2);
  EXPECT_EQ(folder.get("task.yaml"), document["task"].as<std::string>());
}

TEST(BrokenTasks, WhatIsOpenAndWhatLiesBehindTheStartIsToldInWords) {
  const ScratchFolder folder;
  const std::string planner = executable("tenon-plan");
  const Ended hole =
      run(folder, {planner, "--check", in_tree("planner/tasks/peg_in_hole_3d.yaml")});
  EXPECT_NE(hole.out.find("room along z: 9.96 towards -z, open towards +z\n"), std::string::npos)
      << hole.out;
  EXPECT_NE(hole.out.find("touches along +x: left, at (-140, 0, 10), behind the start: by way of "
                          "legs along x, z\n"),
            std::string::npos)
      << hole.out;
  auto far = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"))["task"].as<std::string>();
  far.replace(far.find("[0, 0, 0.005]"), std::string("[0, 0, 0.005]").size(), "[25, -15, 0.5]");
  const Ended alone = run(folder, {planner, "--check", folder.put("far.yaml", far)});
  EXPECT_NE(alone.out.find("goal      (25000, -15000, 500), to"), std::string::npos) << alone.out;
  EXPECT_NE(alone.out.find("room along x: open both ways\n"), std::string::npos) << alone.out;
}

// 0.45 m out the part is not in the pocket, whose sides are 1 mm away: it meets the block's outer
// side.
TEST(BrokenTasks, ASpreadThatIsLargerThanAPocketTouchesNothingInIt) {
  const ScratchFolder folder;
  auto wide = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"))["task"].as<std::string>();
  const auto put = [&wide](const std::string& what, const std::string& instead) {
    wide.replace(wide.find(what), what.size(), instead);
  };
  put("[0.01, -0.02, 0.10]", "[0, 0, 0.10]");
  put("[0.008, 0.008, 0.008]", "[0.15, 0.003, 0.002]");
  const Ended ended =
      run(folder, {executable("tenon-plan"), "--check", folder.put("wide.yaml", wide)});
  EXPECT_NE(ended.out.find("touches along +x: left, at (-120, 0, 5), behind the start"),
            std::string::npos)
      << ended.out;
}

TEST(BrokenTasks, ASmallSpreadIsNotBlamedForWhatLargeOnesHide) {
  const ScratchFolder folder;
  auto task = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"))["task"].as<std::string>();
  const std::string errors = "[0.01, -0.02, 0.10]}, sigma_m: [0.008, 0.008, 0.008]";
  task.replace(task.find(errors), errors.size(),
               "[0.01, -0.02, 0.10]}, uniform_m: [0.3, 0.3, 0.005]");
  const Ended ended =
      run(folder, {executable("tenon-plan"), "--check", folder.put("a.yaml", task)});
  for (const char* axis : {"x", "y"}) {
    EXPECT_NE(ended.out.find(std::string("nothing to touch along ") + axis), std::string::npos)
        << ended.out;
  }
  EXPECT_NE(ended.out.find("a smaller uniform_m there than 0.3 m"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("nothing to touch along z"), std::string::npos) << ended.out;
}

TEST(BrokenTasks, ARoomThatIsTooSmallToMeasureIsSaidToBe) {
  const ScratchFolder folder;
  auto task = YAML::LoadFile(in_tree("tests/planning/broken_tasks.yaml"))["task"].as<std::string>();
  task.replace(task.find("0.040, 0.040, 0.100"), 5, "0.042");
  const Ended ended =
      run(folder, {executable("tenon-plan"), "--check", folder.put("a.yaml", task)});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("room along x: below 0.01 towards -x, below 0.01 towards +x\n"),
            std::string::npos)
      << ended.out;
}

TEST(BrokenTasks, NoPushThatIsSaidToTouchGoesThroughAWall) {
  const ScratchFolder folder;
  const Ended ended = run(folder, {executable("tenon-plan"), "--check",
                                   in_tree("planner/tasks/box_on_table_2d.yaml"), "--start", "1"});
  EXPECT_EQ(ended.status, 0);
  // Outside of the wall wall_nx, at x = -600, is nearer, but in the plane no move leads there.
  EXPECT_NE(ended.out.find("touches along +x: wall_px, at (450, -200, 2)"), std::string::npos);
  EXPECT_NE(ended.out.find("touches along -x: wall_nx, at (-450, -200, 2)"), std::string::npos);
}

TEST(BrokenTasks, AFileByItsNameAloneIsSoughtWhereItShips) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "hw" / "cells");
  folder.put("hw/cells/bench.yaml", "name: bench\n");
  const Ended ended =
      run(folder, {"/bin/sh", "-c", "cd \"$0\" && exec \"$@\"", folder.path().string(),
                   executable("tenon-plan"), in_tree("planner/tasks/box_on_table_2d.yaml"),
                   "--cell", "bench", "--output", "plan.tnp"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.err.find("bench: cannot be read: No such file or directory; did you mean "
                           "hw/cells/bench.yaml?"),
            std::string::npos)
      << ended.err;
}

TEST(BrokenTasks, ARingIsOnePart) {
  const ScratchFolder folder;
  const Ended ended = run(
      folder, {executable("tenon-plan"), "--check", in_tree("planner/tasks/peg_in_hole_3d.yaml")});
  EXPECT_NE(ended.out.find("hole of 16 pieces"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("hole["), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace tenon::tests
