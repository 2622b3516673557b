// A robot's sensor by a profile: what it takes from there, what its own file says otherwise, and
// how slips are told.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

#include "shared/config/load.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::kSlideRobot;
using tests::refusal;

/// The slide's robot file, cycle 4 ms, with another sensor.
std::string with_sensor(const std::string& sensor) {
  const std::string robot = kSlideRobot;
  return robot.substr(0, robot.find("sensor:")) + "sensor: {" + sensor + "}\n";
}

class SensorFile : public testing::Test {
 protected:
  SensorFile() {
    folder.put("robots/slide/slide.urdf", tests::kSlideUrdf);
    for (const char* name : {"robotous_rft.yaml", "canopen_node.yaml", "ati_netcanoem.yaml"}) {
      std::ostringstream text;
      text << std::ifstream(tests::in_tree(std::string("hw/sensors/") + name)).rdbuf();
      folder.put(std::string("sensors/") + name, text.str());
    }
  }
  ForceTorqueSensor loaded(const std::string& sensor) {
    return load_robot(folder.put("robots/slide/robot.yaml", with_sensor(sensor))).sensor;
  }
  /// Without the file's name.
  std::string refused(const std::string& sensor) {
    const auto file = folder.put("robots/slide/robot.yaml", with_sensor(sensor));
    const std::string line = refusal([&] { (void)load_robot(file); });
    return line.substr(line.find(".yaml:") == std::string::npos ? 0 : line.find(".yaml:") + 5);
  }

  tests::ScratchFolder folder;
};

TEST_F(SensorFile, TheProfileOfAnRftIsAsItIsSold) {
  const ForceTorqueSensor sensor = loaded("profile: robotous_rft");
  EXPECT_EQ(sensor.protocol, SensorProtocol::kRobotousRft);
  EXPECT_EQ(sensor.profile, "robotous_rft");
  EXPECT_EQ(sensor.node, 0);
  EXPECT_EQ(sensor.request_id, 0x64U);
  EXPECT_EQ(sensor.sample_ids, (std::array<std::uint32_t, 2>{1, 2}));
  EXPECT_EQ(sensor.rate_hz, 200);
  EXPECT_DOUBLE_EQ(sensor.force_per_count_N, 1.0 / 50);
  EXPECT_DOUBLE_EQ(sensor.torque_per_count_Nm, 1.0 / 2000);
  EXPECT_EQ(sensor.cycles_per_sample, 2);  // 5 ms in cycles of 4 ms
  EXPECT_FALSE(sensor.unverified.empty());
}

TEST_F(SensorFile, ABaseIsSixteenIdentifiers) {
  const ForceTorqueSensor sensor = loaded("profile: ati_netcanoem, period_us: 8000");
  EXPECT_EQ(sensor.protocol, SensorProtocol::kAtiNetcanoem);
  EXPECT_EQ(sensor.node, 0);
  EXPECT_EQ(sensor.request_id, 0x170U);
  EXPECT_EQ(sensor.sample_ids, (std::array<std::uint32_t, 2>{0x170, 0x171}));
  EXPECT_EQ(sensor.cycles_per_sample, 2);
  EXPECT_EQ(refused("profile: ati_netcanoem, force_per_count_N: 0.1"),
            ":23: sensor.force_per_count_N: means nothing to a sensor ati_netcanoem");
  EXPECT_EQ(refused("profile: ati_netcanoem, identifiers: {command: 1}"),
            ":23: sensor.identifiers.command: means nothing to a sensor ati_netcanoem");
  EXPECT_EQ(refused("profile: ati_netcanoem, identifiers: {base: 0x80}"),
            ":23: sensor.identifiers.base = 0x80, must be in [1, 127]");
  EXPECT_EQ(refused("profile: robotous_rft, identifiers: {base: 0x17}"),
            ":23: sensor.identifiers.base: means nothing to a sensor robotous_rft");
}

TEST_F(SensorFile, TheRobotsFileGoesFirst) {
  const ForceTorqueSensor sensor =
      loaded("profile: robotous_rft, force_range_N: 100, rate_hz: 50, identifiers: {first: 0x11}");
  EXPECT_DOUBLE_EQ(sensor.force_range_N, 100.0);
  EXPECT_EQ(sensor.cycles_per_sample, 5);
  EXPECT_EQ(sensor.sample_ids, (std::array<std::uint32_t, 2>{0x11, 2}));
}

TEST_F(SensorFile, ABusOfItsOwnHasABitRate) {
  EXPECT_EQ(loaded("profile: ati_netcanoem, period_us: 8000").bus(), kArmBus);
  const ForceTorqueSensor sensor =
      loaded("profile: ati_netcanoem, period_us: 8000, bus: {bitrate_bps: 250000}");
  EXPECT_EQ(sensor.bus(), kSensorBus);
  EXPECT_EQ(sensor.own_bitrate_bps, 250'000U);
  EXPECT_EQ(refused("profile: robotous_rft, bus: {bitrate_bps: 300000}"),
            ":23: sensor.bus.bitrate_bps = 300000, must be one of: 20000, 50000, 125000, 250000, "
            "500000, 800000, 1000000");
}

TEST_F(SensorFile, ACanopenNodeIsTheSameWithItsProfileAsWithoutOne) {
  const std::string keys =
      "node: 4, force_per_count_N: 0.01, torque_per_count_Nm: 0.0005, force_range_N: 300, "
      "torque_range_Nm: 15, force_noise_N: 0.1, torque_noise_Nm: 0.005";
  for (const auto& sensor : {loaded(keys), loaded("profile: canopen_node, " + keys)}) {
    EXPECT_EQ(sensor.protocol, SensorProtocol::kNode);
    EXPECT_EQ(sensor.profile, "canopen_node");
    EXPECT_EQ(sensor.node, 4);
    EXPECT_DOUBLE_EQ(sensor.force_range_N, 300.0);
  }
}

TEST_F(SensorFile, RefusesEachSlipWithItsPlace) {
  EXPECT_EQ(refused("profile: robotous_rft, node: 4"),
            ":23: sensor.node: means nothing to a sensor robotous_rft");
  EXPECT_EQ(refused("profile: robotous_rft, period_us: 8000"),
            ":23: sensor.period_us: means nothing to a sensor robotous_rft");
  EXPECT_EQ(refused("profile: robotous_rft, rate_hz: 250"),
            ":23: sensor.rate_hz = 250, must be 10, 20, 50, 100, 200, 300, 500 or 1000");
  EXPECT_EQ(refused("profile: robotous_rft, rate_hz: 10"),
            ":23: sensor: rate_hz = 10 brings no sample within 20 cycles of 4000 us");
  EXPECT_EQ(
      refused("profile: robotous_rft, identifiers: {second: 0x64}"),
      ":23: sensor.identifiers.second = 0x64, must be another identifier than command and first");
  EXPECT_EQ(refused("profile: robotous_rft, identifiers: {first: 0x800}"),
            ":23: sensor.identifiers.first = 0x800, must be in [1, 2047]");
  EXPECT_EQ(refused("profile: robotous_rft, force_noise_N: 300"),
            ":23: sensor.force_noise_N = 300, must be in [0, 200]");
  EXPECT_NE(
      refused("profile: robotous").find("sensor.profile = robotous, must be a sensor profile: "),
      std::string::npos);
  EXPECT_NE(refused("profile: robotous_rft, protocol: canopen_node").find("is an unknown key"),
            std::string::npos);
  folder.put("sensors/odd.yaml", "name: odd\nprotocol: canfd\nunverified: []\n");
  EXPECT_EQ(refused("profile: odd"),
            ":2: protocol = canfd, must be one of: canopen_node, robotous_rft, ati_netcanoem");
}

}  // namespace
}  // namespace tenon
