// A robot's URDF: what is read from it, and that each flaw is refused with file and element.

#include "shared/config/urdf_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/shared/slide_robot.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using config::UrdfChain;
using tests::kSlideUrdf;
using tests::refusal;
using tests::replaced;
using tests::ScratchFolder;

UrdfChain slide() {
  const ScratchFolder folder;
  return config::read_urdf(folder.put("slide.urdf", kSlideUrdf));
}

TEST(UrdfChain, ReadsKindsFramesAndLimits) {
  const UrdfChain chain = slide();
  ASSERT_EQ(chain.joints.size(), 2U);
  const Joint& x = chain.joints[0];
  EXPECT_EQ(x.name, "x");
  EXPECT_EQ(x.kind, Joint::Kind::kPrismatic);
  EXPECT_EQ(x.axis, Vector3::UnitX());  // URDF's default
  EXPECT_EQ(x.lower, -0.8);
  EXPECT_EQ(x.upper, 0.8);
  EXPECT_EQ(x.speed_max, 1.0);
  EXPECT_EQ(x.effort_max, 400.0);
  const Joint& turn = chain.joints[1];
  EXPECT_EQ(turn.kind, Joint::Kind::kRevolute);
  EXPECT_EQ(turn.axis, Vector3::UnitZ());
  EXPECT_EQ(turn.upper, 2.5);
  EXPECT_EQ(turn.origin.position_m, Vector3(0, 0, 0.1));
  EXPECT_NEAR(turn.origin.orientation.x(), std::sin(0.25), 1e-15);
}

TEST(UrdfChain, FoldsFixedJointsIntoTheirNeighbours) {
  const UrdfChain chain = slide();
  // The foot under the first joint, the plate behind the last.
  EXPECT_TRUE(chain.joints[0].origin.position_m.isApprox(Vector3(0.2, 0, 0.5)));
  EXPECT_TRUE(chain.flange.position_m.isApprox(Vector3(0.3, 0, 0)));
  EXPECT_NEAR(chain.flange.orientation.z(), std::sin(0.125), 1e-15);
}

TEST(UrdfChain, InertiasAreAboutTheCentreOfMassInTheLinksAxes) {
  const LinkInertia carriage = slide().joints[0].link;
  EXPECT_EQ(carriage.mass_kg, 12.0);
  EXPECT_EQ(carriage.com_m, Vector3(0, 0, 0.1));
  EXPECT_TRUE(carriage.inertia_kgm2.diagonal().isApprox(Vector3(0.3, 0.2, 0.1)));
}

TEST(UrdfChain, AFixedLinksMassJoinsTheLinkThatCarriesIt) {
  const LinkInertia swing = slide().joints[1].link;
  EXPECT_EQ(swing.mass_kg, 4.0);
  // 2 kg at x = 0.1 and 2 kg at x = 0.3.
  EXPECT_TRUE(swing.com_m.isApprox(Vector3(0.2, 0, 0)));
  // The swing's own axes x and y are exchanged by a quarter turn; each 2 kg is 0.1 m off the
  // middle: 2 * 2 * 0.1^2 = 0.04 about y and z.
  EXPECT_NEAR(swing.inertia_kgm2(0, 0), 0.02 + 0.01, 1e-15);
  EXPECT_NEAR(swing.inertia_kgm2(1, 1), 0.01 + 0.01 + 0.04, 1e-15);
  EXPECT_NEAR(swing.inertia_kgm2(2, 2), 0.025 + 0.01 + 0.04, 1e-15);
  EXPECT_NEAR(swing.inertia_kgm2(0, 1), 0.0, 1e-15);
}

TEST(UrdfChain, RefusesEachFlawWithFileAndElement) {
  struct Flaw {
    const char* what;
    const char* by;
    const char* message;
  };
  constexpr const char* kTurn = R"(<limit lower="-2" upper="2.5" velocity="1.5" effort="40"/>)";
  const std::vector<Flaw> flaws = {
      {"</robot>", "", ": is not URDF: "},
      {"<robot name=\"slide\">", "<robot>", ": is not URDF: No name given for the robot."},
      {"<mass value=\"12\"/>", "<mass value=\"twelve\"/>", ": is not URDF: "},
      {"<mass value=\"12\"/>", "<mass value=\"nan\"/>", ": is not URDF: "},
      {"<child link=\"swing\"/>", "<child link=\"nowhere\"/>", ": is not URDF: "},
      {kTurn, "", ": is not URDF: Joint [turn] is of type REVOLUTE but it does not specify limits"},
      {"type=\"revolute\"", "type=\"continuous\"",
       ": joint \"turn\": its type must be revolute or prismatic (with limits) or fixed"},
      {"type=\"revolute\"", "type=\"planar\"",
       ": joint \"turn\": its type must be revolute or prismatic (with limits) or fixed"},
      {"upper=\"2.5\"", "upper=\"-2\"", ": joint \"turn\": limit upper = -2, must be in (-2, 100]"},
      {"lower=\"-2\" upper=\"2.5\" ", "", ": joint \"turn\": limit upper = 0, must be in (0, 100]"},
      {"velocity=\"1.5\"", "velocity=\"0\"",
       ": joint \"turn\": limit velocity = 0, must be in (0, 100]"},
      {"effort=\"40\"", "effort=\"-40\"",
       ": joint \"turn\": limit effort = -40, must be in (0, 100000]"},
      {"<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>",
       ": joint \"turn\": axis of length 0, must be 1"},
      {"<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/> <mimic joint=\"x\"/>",
       ": joint \"turn\": mimics joint \"x\", must move by itself"},
      {"<parent link=\"swing\"/>", "<parent link=\"carriage\"/>",
       ": link \"carriage\": branches into joints \"screws\" and \"turn\", must be one chain from "
       "base to flange"},
      {"<mass value=\"12\"/>", "<mass value=\"-12\"/>",
       ": link \"carriage\": mass -12 kg, must be in (0, 1000]"},
      {"<mass value=\"12\"/>", "<mass value=\"0\"/>",
       ": link \"carriage\": mass 0 kg, must be in (0, 1000]"},
      {"izz=\"0.1\"", "izz=\"-0.1\"",
       ": link \"carriage\": inertia has the principal moments -0.1, 0.2, 0.3 kg m^2, all must be "
       "positive"},
      {"ixy=\"0\"", "ixy=\"0.3\"",
       ": link \"carriage\": inertia has the principal moments -0.0541381, 0.1, 0.554138 kg m^2, "
       "all must be positive"},
      {"ixx=\"0.3\"", "ixx=\"0.4\"",
       ": link \"carriage\": inertia has the principal moments 0.1, 0.2, 0.4 kg m^2, none may "
       "exceed the sum of the other two"},
  };
  for (const Flaw& flaw : flaws) {
    const ScratchFolder folder;
    const auto file = folder.put("bad.urdf", replaced(kSlideUrdf, flaw.what, flaw.by));
    const std::string line = refusal([&] { (void)config::read_urdf(file); });
    EXPECT_TRUE(line.starts_with(file.string() + flaw.message)) << flaw.by << "\n" << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_GT(line.size(), (file.string() + ": is not URDF: ").size()) << "says no reason";
  }
}

TEST(UrdfChain, EveryMovingLinkNeedsAMass) {
  const std::string text = kSlideUrdf;
  const std::size_t from = text.find("<inertial>");
  const std::size_t to = text.find("</inertial>") + std::string("</inertial>").size();
  const ScratchFolder folder;
  const auto file = folder.put("bad.urdf", text.substr(0, from) + text.substr(to));
  EXPECT_EQ(refusal([&] { (void)config::read_urdf(file); }),
            file.string() + ": link \"carriage\": has no <inertial>: every moving link needs one");
}

std::string chain_of(int joints) {
  std::string text = R"(<robot name="long"><link name="l0"/>)";
  for (int i = 1; i <= joints; ++i) {
    const std::string here = "l" + std::to_string(i);
    text += "<link name=\"" + here +
            R"("><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
        ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j)" +
            std::to_string(i) + R"(" type="revolute"><parent link="l)" + std::to_string(i - 1) +
            "\"/><child link=\"" + here +
            R"("/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>)";
  }
  return text + "</robot>";
}

TEST(UrdfChain, HoldsOneToSevenMovingJoints) {
  const ScratchFolder folder;
  EXPECT_EQ(config::read_urdf(folder.put("seven.urdf", chain_of(7))).joints.size(), 7U);
  for (const int joints : {0, 8}) {
    const auto file = folder.put("bad.urdf", chain_of(joints));
    EXPECT_EQ(refusal([&] { (void)config::read_urdf(file); }),
              file.string() + ": has " + std::to_string(joints) +
                  " revolute and prismatic joints, must have 1 to 7");
  }
}

// The parser would descend until the stack ends.
TEST(UrdfChain, ElementsWithoutBottomAreRefusedByTheirDepth) {
  const ScratchFolder folder;
  std::string deep = "<robot name=\"r\"><!-- <a> --><a b='>'/>";
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  const auto file = folder.put("deep.urdf", deep);
  EXPECT_EQ(refusal([&] { (void)config::read_urdf(file); }),
            file.string() + ": has elements 200001 deep in each other, must be at most 64");
  const auto large = folder.put("large.urdf", std::string(1'100'000, ' '));
  EXPECT_EQ(refusal([&] { (void)config::read_urdf(large); }),
            large.string() + ": is 1100000 bytes long, must be at most 1048576");
}

// The parser would look for each of their 100,000 attributes among the others, for a minute.
TEST(UrdfChain, TagsWithoutEndAreRefusedByTheirLength) {
  const ScratchFolder folder;
  const std::string head = "<robot name=\"r\"";
  const auto file = folder.put("long.urdf", head + std::string(4097 - head.size(), ' ') + ">");
  EXPECT_EQ(refusal([&] { (void)config::read_urdf(file); }),
            file.string() + ": has a tag of 4097 bytes, must be at most 4096");
  std::string many = head;
  for (int i = 0; i < 100'000; ++i) many += " a" + std::to_string(i) + "=''";
  const auto endless = folder.put("endless.urdf", many + "/>");
  EXPECT_EQ(refusal([&] { (void)config::read_urdf(endless); }),
            endless.string() + ": has a tag of " + std::to_string(many.size() + 1) +
                " bytes, must be at most 4096");
}

TEST(UrdfChain, AMissingFileIsNamed) {
  EXPECT_EQ(refusal([] { (void)config::read_urdf("nowhere/x.urdf"); }),
            "nowhere/x.urdf: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace tenon
