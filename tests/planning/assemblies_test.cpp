// The script that plans and evaluates a folder of pairs of parts.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/commands.h"
#include "tests/support/meshes.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

class Assemblies : public ::testing::Test {
 protected:
  Ended assemblies(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), in_tree("sim/experiments/assemblies.sh"));
    arguments.insert(arguments.end(),
                     {"--bin", std::filesystem::path(executable("tenon-plan")).parent_path(),
                      "--output", folder.path() / "out", "-n", "5"});
    return run(folder, arguments);
  }
  void put_pair(const std::string& name, const TriangleMesh& plug,
                const TriangleMesh& socket) const {
    std::filesystem::create_directories(folder.path() / "parts" / name);
    folder.put("parts/" + name + "/plug.stl", binary_stl(plug, 1e-3));
    folder.put("parts/" + name + "/socket.obj", obj(socket, 1.0));
  }

  ScratchFolder folder;
};

TEST_F(Assemblies, EachPairIsARowOfItsOwnAndMadeOnce) {
  const TriangleMesh table = box_mesh({0.06, 0.06, 0.02}, {0.0, 0.0, -0.01});
  put_pair("1_in_each_other", box_mesh({0.02, 0.02, 0.02}), table);
  std::filesystem::create_directories(folder.path() / "parts" / "2_no_pair");
  put_pair("3_open", box_mesh({0.02, 0.02, 0.02}, {0.0, 0.0, 0.011}), table);
  folder.put("parts/3_open/socket.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Ended ended = assemblies({folder.path() / "parts"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("0 of 2 planned"), std::string::npos) << ended.out;
  const auto all = nlohmann::json::parse(folder.get("out/assemblies.json"));
  ASSERT_EQ(all.at("pairs").size(), 2U);
  for (const auto& pair : all["pairs"]) EXPECT_EQ(pair.at("outcome"), "no task");
  const std::string why = all["pairs"][0].at("why");
  EXPECT_NE(why.find("overlap"), std::string::npos) << why;
  EXPECT_NE(folder.get("out/assemblies.html").find("1_in_each_other"), std::string::npos);

  // What is there is not made again.
  folder.put("out/1_in_each_other/task.txt", "as it was\n");
  ASSERT_EQ(assemblies({folder.path() / "parts", "--shard", "1/2"}).status, 0);
  EXPECT_EQ(folder.get("out/1_in_each_other/task.txt"), "as it was\n");
}

TEST_F(Assemblies, WhatCannotBeIsSaidInALine) {
  put_pair("pair", box_mesh({0.02, 0.02, 0.02}), box_mesh({0.06, 0.06, 0.02}));
  std::filesystem::create_directories(folder.path() / "empty");
  const std::string parts = folder.path() / "parts";
  const std::vector<std::vector<std::string>> cases = {
      {folder.path() / "nowhere"}, {folder.path() / "empty"},        {parts, "--shard", "3/2"},
      {parts, "--shard", "one"},   {parts, "--cell", "nowhere.yml"}, {parts, "--nothing", "1"},
  };
  for (const auto& arguments : cases) {
    const Ended ended = assemblies(arguments);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(ended.err.find("assemblies.sh: "), 0U) << ended.err;
    EXPECT_EQ(ended.err.find('\n'), ended.err.size() - 1) << ended.err;
  }
  ASSERT_EQ(assemblies({parts}).status, 0);
  const Ended other = assemblies({parts, "--uniform-mm", "3"});
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("another setting"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace tenon::tests
