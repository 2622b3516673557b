#pragma once
// A device of sim/ on a wire of its own, and the independent client at the other end, in virtual
// time. The drive's plant is where the demand is, unless it is stuck or the brake holds it.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "shared/ports/can_bus.h"
#include "sim/cell/devices/drive_402.h"
#include "sim/cell/devices/force_torque_node.h"
#include "tests/support/canopen_client.h"

namespace tenon::sim {

using tests::Bytes;
using tests::CanopenClient;
using tests::little_endian;
using tests::signed_of;
using tests::unsigned_of;
using tests::WireFrame;
using Transfer = CanopenClient::Transfer;
using Emergencies = std::vector<CanopenClient::Emergency>;

/// Object 2100h: what the tests call an object of a device, index and sub-index.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
};

class DeviceBench {
 public:
  static constexpr std::int64_t kStep_ns = 500'000;
  static constexpr std::uint8_t kNode = 5;

  DeviceBench() = default;
  DeviceBench(const DeviceBench&) = delete;
  DeviceBench& operator=(const DeviceBench&) = delete;
  virtual ~DeviceBench() = default;

  void tell(const WireFrame& wire) {
    CanFrame frame;
    frame.id = wire.id;
    frame.remote = wire.remote;
    frame.length = static_cast<std::uint8_t>(wire.data.size());
    std::copy(wire.data.begin(), wire.data.end(), frame.data.begin());
    node().receive(frame, now_ns);
    listen();
  }
  /// What the device has to say reaches the client, and its answers the device.
  void listen() {
    std::vector<CanFrame> frames;
    node().take(frames);
    for (const CanFrame& frame : frames) {
      const Bytes data(frame.data.begin(), frame.data.begin() + frame.length);
      if (const auto next = client.receive({frame.id, data, frame.remote}, now_ns)) tell(*next);
    }
  }
  void pass(double milliseconds) {
    const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(1e6 * milliseconds);
    while (now_ns < end_ns) {
      now_ns += kStep_ns;
      step();
      listen();
    }
  }
  void sync(int count = 1) {
    for (int i = 0; i < count; ++i) tell(CanopenClient::sync());
  }
  void start() { tell(client.nmt(0x01)); }

  CanopenClient::Answer read(ObjectAddress at) {
    tell(client.begin_read(at.index, at.sub, now_ns));
    return finish();
  }
  /// The abort code, 0 where it went well.
  std::uint32_t read_abort(ObjectAddress at) { return read(at).abort; }
  std::uint32_t write(ObjectAddress at, const Bytes& bytes,
                      Transfer transfer = Transfer::kExpedited) {
    tell(client.begin_write(at.index, at.sub, bytes, transfer, now_ns));
    return finish().abort;
  }
  std::uint32_t write_u8(ObjectAddress at, std::int64_t value) {
    return write(at, little_endian(value, 1));
  }
  std::uint32_t write_u16(ObjectAddress at, std::int64_t value) {
    return write(at, little_endian(value, 2));
  }
  std::uint32_t write_u32(ObjectAddress at, std::int64_t value) {
    return write(at, little_endian(value, 4));
  }
  std::uint64_t value(ObjectAddress at) { return unsigned_of(read(at).bytes); }
  std::int64_t signed_value(ObjectAddress at) { return signed_of(read(at).bytes); }

  /// What came since the last call.
  Emergencies emergencies() { return std::exchange(client.emergencies, {}); }
  std::vector<std::uint8_t> heartbeats() { return std::exchange(client.heartbeats, {}); }
  std::vector<Bytes> pdos(std::uint32_t id) { return std::exchange(client.others[id], {}); }

  [[nodiscard]] virtual SlaveNode& node() = 0;

  CanopenClient client{kNode};
  std::int64_t now_ns = 0;

 protected:
  virtual void step() = 0;

 private:
  /// The answer, or the client's abort after its time-out.
  CanopenClient::Answer finish() {
    while (!client.answer()) {
      pass(1);
      if (const auto abort = client.advance(now_ns)) tell(*abort);
    }
    return *client.answer();
  }
};

class DriveBench final : public DeviceBench {
 public:
  explicit DriveBench(const DriveParameters& parameters) : drive(parameters) {
    drive.node().power_on(0);
    pass(10);
  }
  explicit DriveBench(std::int8_t mode = 8)
      : DriveBench(DriveParameters{.node = kNode, .mode = mode}) {}

  [[nodiscard]] SlaveNode& node() override { return drive.node(); }

  /// Mode, 2 ms a cycle, the ramps of 1,000,000 counts/s^2, operational.
  void configure() {
    write_u8({0x6060}, drive_mode());
    write_u8({0x60C2, 1}, 2);
    write_u32({0x6084}, 1'000'000);
    write_u32({0x6085}, 1'000'000);
    start();
  }
  void control(int word) { write_u16({0x6040}, word); }
  std::uint16_t status() { return static_cast<std::uint16_t>(value({0x6041})); }
  /// By the masks of CiA 402's table: 6Fh where bit 5 tells, 4Fh where it does not.
  int long_state() { return status() & 0x6F; }
  int short_state() { return status() & 0x4F; }
  void enable() {
    control(0x06);
    control(0x07);
    control(enable_word());
    pass(25);  // the brake opens
  }
  /// Targets that advance evenly, one a SYNC.
  void run(int cycles, int counts_a_cycle) {
    for (int i = 0; i < cycles; ++i) {
      commanded += counts_a_cycle;
      if (drive_mode() == 8) {
        write_u32({0x607A}, commanded);
      } else {
        write_u32({0x60C1, 1}, commanded);
      }
      sync();
      pass(2);
    }
  }
  int enable_word() { return drive_mode() == 7 ? 0x1F : 0x0F; }
  /// The one that 6502h tells.
  int drive_mode() { return value({0x6502}) == 0x40 ? 7 : 8; }
  /// 100,000 counts/s.
  void run_fast() { run(25, 200); }

  Drive402 drive;
  Drive402::Demand demand;
  Drive402::Measurement plant;
  double torque_permille = 0.0;
  bool stuck = false;
  int commanded = 0;

 private:
  void step() override {
    demand = drive.demand(kStep_ns);
    plant.velocity_countsps = 0.0;
    if (demand.powered && !demand.brake && !stuck) {
      plant.position_counts = demand.position_counts;
      plant.velocity_countsps = demand.velocity_countsps;
    }
    plant.torque_permille = torque_permille;
    drive.measured(plant, kStep_ns);
    drive.advance(now_ns);
  }
};

class SensorBench final : public DeviceBench {
 public:
  explicit SensorBench(double noise_N = 0.0, std::uint64_t seed = 1,
                       const ForceTorqueNode::Imperfections& imperfections = {})
      : sensor(sheet(noise_N), seed, imperfections) {
    sensor.node().power_on(0);
    pass(1);
  }

  [[nodiscard]] SlaveNode& node() override { return sensor.node(); }

  /// 0.01 N and 0.001 Nm a count, ranges 300 N and 15 Nm.
  static ForceTorqueSensor sheet(double noise_N) {
    ForceTorqueSensor sheet;
    sheet.node = kNode;
    sheet.force_per_count_N = 0.01;
    sheet.torque_per_count_Nm = 0.001;
    sheet.force_range_N = 300.0;
    sheet.torque_range_Nm = 15.0;
    sheet.force_noise_N = noise_N;
    sheet.torque_noise_Nm = 0.0;
    return sheet;
  }

  ForceTorqueNode sensor;
  Vector6 wrench = Vector6::Zero();

 private:
  void step() override {
    sensor.measured(wrench, kStep_ns);
    sensor.advance(now_ns);
  }
};

}  // namespace tenon::sim
