// How the master takes what real devices and other tools on the bus do. Every line that it says
// names node, joint, object and what to check.

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "hw/arm/describe_fault.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/sdo.h"
#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

class AbortCode : public ::testing::TestWithParam<std::tuple<std::uint32_t, const char*>> {};

TEST_P(AbortCode, IsToldAsAnAbortAndNotAsAValue) {
  const auto [code, text] = GetParam();
  GantryOnBus gantry;
  gantry.nodes[0]->refuses[0x606000] = code;
  char hex[16];
  std::snprintf(hex, sizeof hex, "0x%08X", code);
  EXPECT_EQ(gantry.refused(), "node 1 (x): refused 6060h:0 = 0x8: " + std::string(text) +
                                  " (abort " + hex +
                                  "); check the device's manual and firmware, and the profile of "
                                  "its drive");
}

INSTANTIATE_TEST_SUITE_P(OfDevices, AbortCode,
                         ::testing::Values(std::tuple{0x05040002u, "invalid block size"},
                                           std::tuple{0x05040003u, "invalid sequence number"},
                                           std::tuple{0x05040004u, "checksum wrong"},
                                           std::tuple{0x060A0023u, "resource not available"},
                                           std::tuple{0x08000024u, "no data available"},
                                           std::tuple{0x0F00FFC0u,
                                                      "for a reason of its maker's own"}));

TEST(MastersManners, AnAbortCodeThatIsAlsoAValueIsToldApart) {
  GantryOnBus gantry;
  gantry.nodes[0]->keeps[0x100000] = 0x06020000;  // a value like an abort code
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): is no CiA 402 drive (1000h = 0x06020000, low half must be 402); check "
            "the node id");
}

TEST(MastersManners, AnIdentityThatCannotBeReadIsNoFailure) {
  for (const std::uint32_t code :
       {0x06020000u, 0x06090011u, 0x06010001u, 0x08000024u, 0x0F00FFC0u}) {
    GantryOnBus gantry;
    gantry.nodes[1]->refuses[0x101801] = code;
    gantry.nodes[1]->refuses[0x101802] = code;
    EXPECT_TRUE(gantry.prepare()) << std::hex << code;
  }
  GantryOnBus gantry;
  gantry.nodes[1]->mute_at = 0x101801;
  EXPECT_TRUE(gantry.prepare(5000));
}

TEST(MastersManners, TwoDevicesOfOneNumberAreNamed) {
  GantryOnBus gantry;
  ScriptedNode twin(ScriptedNode::Kind::kDrive, 2, gantry.bus.attach());
  for (int i = 0; i < 3000 && gantry.arm.state() != ArmState::kFault; ++i) {
    EXPECT_FALSE(gantry.arm.prepare(gantry.now_ns));
    gantry.step_nodes();
    twin.step(gantry.now_ns);
    gantry.now_ns += 1'000'000;
    gantry.bus.advance(gantry.now_ns);
  }
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 2 (y): 2 devices answered to one request; give each its own node id (with one "
            "of them connected at a time)");
}

TEST(MastersManners, FeedbackOfAnotherLengthIsNamed) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->tpdo_bytes = 6;
  for (int i = 0; i < 6; ++i) gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 1 (x): its process data come with 6 bytes where 8 are mapped; check that nobody "
            "else maps its TPDO1 and TPDO2 (1A00h, 1A01h), or sends on their identifiers");
}

TEST(MastersManners, AnAnswerToNodeGuardingIsASignOfLifeAndNoReset) {
  EXPECT_EQ(canopen::decode_heartbeat({0x701, false, false, 1, {0x85}}),
            (canopen::Heartbeat{1, 0x05}));
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  CanBus& tool = gantry.bus.attach();
  for (int i = 0; i < 10; ++i) {
    (void)tool.send({0x701, false, true, 1, {}});                                    // asks
    gantry.nodes[0]->send(0x701, {static_cast<std::uint8_t>(i % 2 ? 0x85 : 0x05)});  // answers
    gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  }
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
}

TEST(MastersManners, LssOfSomebodyElseIsLeftInPeace) {
  GantryOnBus gantry;
  CanBus& tool = gantry.bus.attach();
  EXPECT_FALSE(gantry.prepare(100));
  (void)tool.send({0x7E5, false, false, 8, {0x04, 0x01}});
  (void)tool.send({0x7E4, false, false, 8, {0x51}});
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  (void)tool.send({0x7E5, false, false, 8, {0x04, 0x00}});
  (void)tool.send({0x7E4, false, false, 8, {0x51}});
  for (int i = 0; i < 10; ++i) gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
}

TEST(MastersManners, NothingIsStoredInADeviceUnasked) {
  GantryOnBus gantry;
  for (std::size_t i = 0; i < 3; ++i) gantry.nodes[i]->objects[0x101001] = {4, 1};
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& write : gantry.nodes[i]->writes) EXPECT_NE(write.object >> 8, 0x1010u);
  }
}

}  // namespace
}  // namespace tenon::hw
