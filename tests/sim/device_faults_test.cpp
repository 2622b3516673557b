// Faults injected into devices, as seen on the wire by the independent client.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

TEST(DeviceFaultsTest, ANodeResetIsABootUpWithEverythingForgotten) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x1017}, 100), 0U);
  bench.enable();
  bench.run_fast();
  bench.heartbeats();
  bench.drive.inject({.kind = FaultKind::kNodeReset});
  bench.listen();
  EXPECT_EQ(bench.heartbeats(), std::vector<std::uint8_t>{0x00});
  EXPECT_EQ(bench.value({0x1017}), 0U);
  EXPECT_EQ(bench.node().state(), NmtState::kPreOperational);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.pass(10);
  EXPECT_EQ(bench.short_state(), 0x40);
}

TEST(DeviceFaultsTest, ASilentNodeNeitherHearsNorSpeaksUntilItsTimeIsOver) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u16({0x1017}, 10), 0U);
  bench.pass(10);
  bench.heartbeats();
  bench.drive.inject({.kind = FaultKind::kSilentNode, .duration_s = 0.1});
  bench.tell(bench.client.nmt(0x01));
  bench.pass(99);
  EXPECT_TRUE(bench.heartbeats().empty());
  bench.pass(20);
  EXPECT_FALSE(bench.heartbeats().empty());
  EXPECT_EQ(bench.node().state(), NmtState::kPreOperational) << "it did not hear the start";
}

TEST(DeviceFaultsTest, ADriveThatIsSilentStillWatchesItsMaster) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x6007}, 3), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.enable();
  bench.tell(CanopenClient::heartbeat(127));
  bench.drive.inject({.kind = FaultKind::kSilentNode});
  for (int i = 0; i < 4; ++i) {
    bench.tell(CanopenClient::heartbeat(127));
    bench.pass(50);
  }
  EXPECT_EQ(bench.drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(DeviceFaultsTest, AnEmergencyOfADriveIsAFault) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  bench.drive.inject({.kind = FaultKind::kEmergency, .value = 0x2310});
  bench.listen();
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x2310, 0x03}}));
  bench.pass(20);
  EXPECT_EQ(bench.short_state(), 0x08);
  EXPECT_EQ(bench.value({0x603F}), 0x2310U);
}

TEST(DeviceFaultsTest, AFrozenEffortIsReportedAgainAndAgainWhileTheDriveGoesOn) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  bench.torque_permille = 100.0;
  bench.pass(1);
  bench.drive.inject({.kind = FaultKind::kFrozenEffort, .duration_s = 0.1});
  bench.torque_permille = 250.0;
  bench.run_fast();
  EXPECT_EQ(bench.value({0x6077}), 100U);
  EXPECT_EQ(bench.drive.state(), DriveState::kOperationEnabled);
  bench.pass(100);
  EXPECT_EQ(bench.value({0x6077}), 250U);
}

// Noise is the current sensor's, which is under power with its drive; what else the drive does goes
// by the true torque.
TEST(DeviceFaultsTest, ADriveUnderPowerMisreadsItsEffortByItsNoise) {
  DriveBench bench;
  bench.plant.torque_off_permille = 3.0;
  bench.pass(1);
  EXPECT_EQ(bench.value({0x6077}), 0U);
  bench.configure();
  bench.enable();
  bench.torque_permille = 100.0;
  bench.pass(1);
  EXPECT_EQ(bench.value({0x6077}), 103U);
}

// The encoder jumps by +2 mm (1,000 counts a mm): the servo sees itself ahead and pulls back.
TEST(DeviceFaultsTest, AnEncoderJumpReadsFurtherAndTheServoFollowsItsEncoder) {
  DriveBench bench({.node = 5, .counts_per_unit = 1e6});
  bench.configure();
  bench.enable();
  bench.stuck = true;
  bench.drive.inject({.kind = FaultKind::kEncoderJump, .value = 0.002});
  bench.pass(1);
  EXPECT_EQ(bench.signed_value({0x6064}), 2000);
  EXPECT_EQ(bench.signed_value({0x60F4}), -2000);
  bench.stuck = false;
  bench.pass(1);
  EXPECT_EQ(bench.plant.position_counts, -2000.0);
  EXPECT_EQ(bench.signed_value({0x6064}), 0);
}

TEST(DeviceFaultsTest, AnEncoderJumpBeyondTheWindowIsAFollowingError) {
  DriveBench bench({.node = 5, .counts_per_unit = 1e6});
  bench.configure();
  EXPECT_EQ(bench.write_u32({0x6065}, 1000), 0U);
  bench.enable();
  bench.stuck = true;
  bench.drive.inject({.kind = FaultKind::kEncoderJump, .value = 0.002});
  bench.pass(2);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8611, 0x21}}));
}

TEST(DeviceFaultsTest, ABrakeThatFailedIsOnByItsOutputAndHoldsNothing) {
  DriveBench bench;
  bench.drive.inject({.kind = FaultKind::kBrakeFailure, .duration_s = 0.01});
  bench.pass(1);
  EXPECT_TRUE(bench.drive.brake_engaged());
  EXPECT_FALSE(bench.demand.brake);
  EXPECT_FALSE(bench.demand.powered);
  bench.pass(15);
  EXPECT_TRUE(bench.demand.brake);
}

/// An enabled drive that stops by 6085h, and then closes its brake (605Ah = 2, 6007h = 3), watching
/// node 127 for 100 ms.
void enable_watching(DriveBench& bench) {
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x605A}, 2), 0U);
  EXPECT_EQ(bench.write_u16({0x6007}, 3), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.enable();
  bench.tell(CanopenClient::heartbeat(127));
}

TEST(DeviceFaultsTest, ADriveThatKeepsPowerStaysInItsQuickStopOnceTheMasterIsLost) {
  for (const bool unkind : {false, true}) {
    DriveBench bench;
    if (unkind) bench.drive.inject({.kind = FaultKind::kKeepsPower});
    enable_watching(bench);
    bench.pass(300);
    EXPECT_EQ(bench.drive.state(),
              unkind ? DriveState::kQuickStopActive : DriveState::kSwitchOnDisabled);
    EXPECT_EQ(bench.demand.powered, unkind);
    EXPECT_EQ(bench.demand.brake, !unkind);
  }
}

// The output closes, 10 ms later the drive switches off, 40 ms after that the brake holds.
TEST(DeviceFaultsTest, ABrakeThatIsSlowerThanItsDriveKnowsLeavesTheAxisFree) {
  DriveBench bench;
  bench.drive.inject({.kind = FaultKind::kSlowBrake, .value = 0.05});
  enable_watching(bench);
  bench.control(0x02);
  bench.pass(9);
  EXPECT_TRUE(bench.demand.powered);
  bench.pass(3);
  EXPECT_FALSE(bench.demand.powered);
  EXPECT_FALSE(bench.demand.brake);
  bench.pass(36);
  EXPECT_FALSE(bench.demand.brake);
  bench.pass(4);
  EXPECT_TRUE(bench.demand.brake);
}

TEST(DeviceFaultsTest, ADriveByTheBookHoldsItsAxisUntilItsSlowBrakeDoes) {
  DriveBench bench({.node = 5, .brake_engage_s = 0.05});
  enable_watching(bench);
  bench.control(0x02);
  for (int i = 0; i < 200; ++i) {
    bench.pass(0.5);
    EXPECT_TRUE(bench.demand.powered || bench.demand.brake) << i;
  }
  EXPECT_FALSE(bench.demand.powered);
}

TEST(DeviceFaultsTest, ADriveThatResumesLeavesAQuickStopForTheLastEnableWordOnce) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u8({0x60C2, 1}, 2), 0U);
  bench.drive.inject({.kind = FaultKind::kResumesStop});
  enable_watching(bench);
  bench.run_fast();
  bench.control(0x02);
  bench.pass(1);
  EXPECT_EQ(bench.drive.state(), DriveState::kQuickStopActive);
  bench.pass(2);
  EXPECT_EQ(bench.drive.state(), DriveState::kOperationEnabled);
  bench.control(0x02);
  bench.pass(200);
  EXPECT_EQ(bench.drive.state(), DriveState::kSwitchOnDisabled) << "the word is used up";
}

TEST(DeviceFaultsTest, ALossOfTorqueLeavesItsPart) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  bench.drive.inject({.kind = FaultKind::kTorqueLoss, .value = 0.25});
  bench.pass(1);
  EXPECT_EQ(bench.demand.torque_max_permille, 750.0);
}

TEST(DeviceFaultsTest, ProbabilityAndSeedDecideWhetherItHappens) {
  int resets = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    DriveBench bench;
    bench.heartbeats();
    bench.drive.inject({.kind = FaultKind::kNodeReset, .probability = 0.25, .seed = seed});
    bench.listen();
    resets += static_cast<int>(bench.heartbeats().size());
  }
  EXPECT_NEAR(resets, 100, 35);  // four standard deviations
}

TEST(DeviceFaultsTest, FaultsOfTheOtherKindsOfDeviceAreIgnored) {
  DriveBench drive;
  drive.drive.inject({.kind = FaultKind::kStaleForce});
  drive.pass(10);
  EXPECT_EQ(drive.short_state(), 0x40);
  SensorBench sensor;
  sensor.sensor.inject({.kind = FaultKind::kBrakeFailure});
  sensor.sensor.inject({.kind = FaultKind::kEncoderJump, .value = 1.0});
  sensor.start();
  sensor.sync();
  EXPECT_EQ(sensor.pdos(0x185).size(), 1U);
}

/// Both halves of a sample: counter of the forces, counter of the torques.
std::pair<int, int> counters(SensorBench& bench) {
  bench.sync();
  const std::vector<Bytes> forces = bench.pdos(0x185);
  const std::vector<Bytes> torques = bench.pdos(0x285);
  EXPECT_EQ(forces.size(), 1U);
  EXPECT_EQ(torques.size(), 1U);
  return {forces[0][6] | forces[0][7] << 8, torques[0][6] | torques[0][7] << 8};
}

TEST(DeviceFaultsTest, AStaleSensorRepeatsItsSampleCounterIncluded) {
  SensorBench bench;
  bench.start();
  bench.wrench[0] = 1.0;
  bench.pass(1);
  EXPECT_EQ(counters(bench), std::pair(1, 1));
  bench.sensor.inject({.kind = FaultKind::kStaleForce, .duration_s = 0.01});
  bench.wrench[0] = 2.0;
  bench.pass(5);
  EXPECT_EQ(counters(bench), std::pair(1, 1));
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 100);
  bench.pass(6);
  EXPECT_EQ(counters(bench), std::pair(2, 2));
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 200);
}

TEST(DeviceFaultsTest, AFrozenSensorsCounterRunsOn) {
  SensorBench bench;
  bench.start();
  bench.wrench[0] = 1.0;
  bench.pass(1);
  EXPECT_EQ(counters(bench), std::pair(1, 1));
  bench.sensor.inject({.kind = FaultKind::kFrozenForce, .duration_s = 0.01});
  bench.wrench[0] = 2.0;
  bench.pass(5);
  EXPECT_EQ(counters(bench), std::pair(2, 2));
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 100);
  bench.pass(6);
  EXPECT_EQ(counters(bench), std::pair(3, 3));
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 200);
}

TEST(DeviceFaultsTest, AForgedForceIsAddedAlongXAndADriftGrows) {
  SensorBench bench;
  bench.start();
  bench.sensor.inject({.kind = FaultKind::kForgedForce, .duration_s = 0.01, .value = 80.0});
  bench.pass(5);
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 8000);
  EXPECT_EQ(bench.signed_value({0x6401, 2}), 0);
  bench.pass(6);
  bench.sensor.inject({.kind = FaultKind::kDriftingForce, .value = -20.0});
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 0);
  bench.pass(100);
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), -200);
}

TEST(DeviceFaultsTest, WrongUnitsAndAWrongMatrixChangeTheWholeReading) {
  SensorBench bench;
  bench.start();
  bench.wrench << 1.0, 2.0, 3.0, 0.1, 0.2, 0.3;
  bench.sensor.inject({.kind = FaultKind::kWrongMatrix});
  bench.pass(1);
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 200);
  EXPECT_EQ(bench.signed_value({0x6401, 3}), 100);
  EXPECT_EQ(bench.signed_value({0x6401, 4}), 200);
  bench.sensor.inject({.kind = FaultKind::kWrongUnits, .value = 10.0});
  bench.pass(1);
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 2000);
}

TEST(DeviceFaultsTest, ATornWrenchHasHalvesOfDifferentSamples) {
  SensorBench bench;
  bench.start();
  EXPECT_EQ(counters(bench), std::pair(1, 1));
  bench.sensor.inject({.kind = FaultKind::kTornForce, .duration_s = 0.01});
  EXPECT_EQ(counters(bench), std::pair(2, 1));
  bench.pass(11);
  EXPECT_EQ(counters(bench), std::pair(3, 3));
}

TEST(DeviceFaultsTest, ATornWrenchByChanceIsTornThatOften) {
  SensorBench bench;
  bench.start();
  static_cast<void>(counters(bench));
  bench.sensor.inject({.kind = FaultKind::kTornForce, .probability = 0.2, .seed = 3});
  int torn = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto [force, torque] = counters(bench);
    torn += force == torque ? 0 : 1;
  }
  EXPECT_NEAR(torn, 200, 51);  // four standard deviations
}

TEST(DeviceFaultsTest, ASaturatedSensorReadsItsRangeAndSaysSo) {
  SensorBench bench;
  bench.start();
  bench.sensor.inject({.kind = FaultKind::kSaturatedForce});
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 1}), 30000);
  EXPECT_EQ(bench.signed_value({0x6401, 6}), 15000);
  EXPECT_EQ(bench.value({0x2002}), 1U);
}

TEST(DeviceFaultsTest, AnOverloadedSensorSaysSoInAnEmergencyAndWhenItIsOver) {
  SensorBench bench;
  bench.start();
  bench.sensor.inject({.kind = FaultKind::kOverrangeForce, .duration_s = 0.01});
  bench.sync(2);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0xFF01, 0x81}}));
  EXPECT_EQ(bench.value({0x2002}), 1U);
  bench.pass(11);
  bench.sync();
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
  EXPECT_EQ(bench.value({0x2002}), 0U);
}

}  // namespace
}  // namespace tenon::sim
