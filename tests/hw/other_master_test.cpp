// Somebody else commands our drives while we do: every frame that only a master sends is a fault in
// the cycle in which it comes, and who only reads is left in peace. Literal frames.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

struct Spoken {
  const char* what;
  std::uint32_t id;
  std::vector<std::uint8_t> bytes;
};

void speak(GantryOnBus& gantry, const Spoken& spoken) {
  CanFrame frame;
  frame.id = spoken.id;
  frame.length = static_cast<std::uint8_t>(spoken.bytes.size());
  for (std::size_t i = 0; i < spoken.bytes.size(); ++i) frame.data[i] = spoken.bytes[i];
  (void)gantry.bus.attach().send(frame);
}

// The gantry's nodes are 1, 2, 3 and the sensor 4, the master is 127.
TEST(OtherMaster, EachFrameThatOnlyAMasterSendsIsAFaultInItsCycle) {
  for (const Spoken& spoken : {
           Spoken{"SYNC", 0x080, {}},
           Spoken{"NMT command", 0x000, {0x01, 0x00}},
           Spoken{"heartbeat of the master's node", 0x77F, {0x05}},
           Spoken{"setpoint of a drive", 0x202, {0x0F, 0x00, 0x00, 0x00, 0x10, 0x00}},
           Spoken{"setpoint of a drive", 0x303, {0x00, 0x00}},
           Spoken{"stop of all drives", 0x183, {0x02, 0x00}},
           Spoken{"SDO download", 0x601, {0x2B, 0x40, 0x60, 0x00, 0x06, 0x00, 0x00, 0x00}},
           Spoken{"SDO download", 0x604, {0x21, 0x10, 0x10, 0x01, 0x14, 0x00, 0x00, 0x00}},
           Spoken{"SDO download", 0x602, {0xC2, 0x10, 0x10, 0x01, 0x14, 0x00, 0x00, 0x00}},
       }) {
    GantryOnBus gantry;
    ASSERT_TRUE(gantry.prepare_and_enable());
    speak(gantry, spoken);
    gantry.cycle(ArmRequest::kEnabled);
    EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kOtherMaster) << spoken.what;
    EXPECT_EQ(gantry.arm.fault().code, spoken.id);
    const std::string line = describe(gantry.arm.fault(), gantry.robot);
    EXPECT_NE(line.find(std::string("(") + spoken.what + ")"), std::string::npos) << line;
    gantry.cycle(ArmRequest::kEnabled);
    EXPECT_EQ(gantry.nodes[1]->controlword, 0x02) << spoken.what << ": the drives stop";
  }
}

TEST(OtherMaster, WhoReadsAlongOrTalksToOthersIsWelcome) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (const Spoken& spoken : {
           Spoken{"SDO upload", 0x601, {0x40, 0x41, 0x60, 0x00, 0, 0, 0, 0}},
           Spoken{"its segments", 0x601, {0x60, 0, 0, 0, 0, 0, 0, 0}},
           Spoken{"block upload", 0x601, {0xA4, 0x41, 0x60, 0x00, 0, 0, 0, 0}},
           Spoken{"abort of an upload", 0x601, {0x80, 0x41, 0x60, 0x00, 0, 0, 0x04, 0x05}},
           Spoken{"download to a stranger", 0x620, {0x2B, 0x40, 0x60, 0x00, 0x06, 0, 0, 0}},
           Spoken{"setpoint of a stranger", 0x220, {0x0F, 0x00}},
           Spoken{"heartbeat of a stranger", 0x720, {0x05}},
           Spoken{"LSS", 0x7E5, {0x04, 0x01, 0, 0, 0, 0, 0, 0}},
       }) {
    speak(gantry, spoken);
    gantry.cycle(ArmRequest::kEnabled);
    EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled) << spoken.what;
  }
}

}  // namespace
}  // namespace tenon::hw
