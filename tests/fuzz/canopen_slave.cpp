// The virtual arm's CANopen nodes under arbitrary traffic, injected faults, supply and load: a
// drive in mode 8 or 7, or the force/torque sensor. Nothing that arrives may take an object out of
// its range, make the node send what is no frame, or leave a drive without brake where it has no
// power.
//
// Input: one byte that picks the device, then operations, each a byte and its arguments.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"
#include "sim/cell/devices/drive_402.h"
#include "sim/cell/devices/force_torque_node.h"
#include "tests/fuzz/support/must.h"

namespace {

using namespace tenon;
using namespace tenon::sim;
using fuzz::must;

constexpr std::uint8_t kNode = 1;
constexpr std::uint8_t kMaster = 127;
constexpr std::int64_t kStep_ns = 500'000;
constexpr int kOperationsMax = 400;
constexpr int kFaultKinds = 16;

ForceTorqueSensor sensor() {
  ForceTorqueSensor sensor;
  sensor.node = kNode;
  sensor.force_per_count_N = 0.01;
  sensor.torque_per_count_Nm = 0.0005;
  sensor.force_range_N = 300.0;
  sensor.torque_range_Nm = 15.0;
  sensor.force_noise_N = 0.1;
  sensor.torque_noise_Nm = 0.001;
  return sensor;
}

/// Every object that the node has; their addresses are stable.
std::vector<ObjectId> ids_of(const ObjectDictionary& dictionary) {
  std::vector<ObjectId> ids;
  for (std::uint32_t index = 0x1000; index < 0x7000; ++index) {
    for (std::uint32_t sub = 0; sub <= 8; ++sub) {
      const ObjectId id = index << 8U | sub;
      if (dictionary.find(id) != nullptr) ids.push_back(id);
    }
  }
  return ids;
}

class Bench {
 public:
  explicit Bench(std::uint8_t device) {
    if (device % 3 == 2) {
      sensor_ = std::make_unique<ForceTorqueNode>(sensor(), 1);
    } else {
      const std::int8_t mode = device % 3 == 0 ? canopen::kModeCyclicSynchronousPosition
                                               : canopen::kModeInterpolatedPosition;
      drive_ = std::make_unique<Drive402>(Drive402::Parameters{.node = kNode, .mode = mode});
    }
    static const std::vector<ObjectId> drive_ids = ids_of(Drive402({}).node().dictionary());
    static const std::vector<ObjectId> sensor_ids =
        ids_of(ForceTorqueNode(sensor(), 1).node().dictionary());
    for (const ObjectId id : drive_ ? drive_ids : sensor_ids) {
      objects_.push_back(node().dictionary().find(id));
    }
    node().power_on(0);
  }

  void run(ByteReader& in) {
    for (int i = 0; i < kOperationsMax && in.remaining() > 0; ++i) {
      operate(in);
      check();
    }
  }

 private:
  [[nodiscard]] SlaveNode& node() { return drive_ ? drive_->node() : sensor_->node(); }

  void operate(ByteReader& in) {
    const auto operation = in.read<std::uint8_t>();
    switch (operation & 7U) {
      case 0: {  // any frame
        CanFrame frame;
        frame.id = in.read<std::uint16_t>() & 0x7FFU;
        frame.extended = (operation & 0x80U) != 0;
        frame.remote = (operation & 0x40U) != 0;
        return receive(frame, in.read<std::uint8_t>() % 9, in);
      }
      case 1:
        return receive({.id = canopen::kSdoRequest + kNode}, 8, in);
      case 2:
        return receive({.id = canopen::kNmt}, 2, in);
      case 3:
        return receive({.id = canopen::kSync}, 0, in);
      case 4:
        return receive({.id = canopen::kRpdo1 + kNode}, (operation >> 3U) % 9, in);
      case 5:
        return pass((operation >> 3U) + 1);
      case 6:
        return receive({.id = canopen::kHeartbeat + kMaster}, 1, in);
      default:
        return disturb(operation, in);
    }
  }

  void receive(CanFrame frame, unsigned length, ByteReader& in) {
    frame.length = static_cast<std::uint8_t>(length);
    for (unsigned i = 0; i < length; ++i) frame.data[i] = in.read<std::uint8_t>();
    node().receive(frame, now_ns_);
  }

  /// Physics and timers. The plant is where the demand is, unless it is stuck.
  void pass(int steps) {
    for (int i = 0; i < steps; ++i) {
      now_ns_ += kStep_ns;
      if (sensor_) {
        sensor_->advance(now_ns_);
        continue;
      }
      const Drive402::Demand demand = drive_->demand(kStep_ns);
      must(std::isfinite(demand.position_counts) && std::isfinite(demand.velocity_countsps),
           "a demand is finite");
      must(demand.powered || drive_->brake_engaged(), "without power the brake's output is on");
      must(demand.torque_max_permille >= 0.0, "a torque limit is no less than 0");
      plant_.velocity_countsps = 0.0;
      if (demand.powered && !demand.brake && !stuck_) {
        plant_.position_counts = demand.position_counts;
        plant_.velocity_countsps = demand.velocity_countsps;
      }
      drive_->measured(plant_, kStep_ns);
      drive_->advance(now_ns_);
    }
  }

  /// Bits of the operation: 3 stuck, 4 a fault, 5 a supply, 6 a load; a sensor gets a wrench too.
  void disturb(std::uint8_t operation, ByteReader& in) {
    stuck_ = (operation & 0x08U) != 0;
    if ((operation & 0x10U) != 0) inject(in);
    if (drive_) {
      if ((operation & 0x20U) != 0) drive_->set_supply(in.read<std::uint8_t>());
      if ((operation & 0x40U) != 0) plant_.torque_permille = in.read<std::int16_t>();
      return;
    }
    Vector6 wrench;
    for (int axis = 0; axis < 6; ++axis) wrench[axis] = 0.05 * in.read<std::int16_t>();
    sensor_->measured(wrench, kStep_ns);
  }

  void inject(ByteReader& in) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(in.read<std::uint8_t>() % kFaultKinds);
    fault.value = in.read<std::int16_t>();
    fault.duration_s = 0.001 * in.read<std::uint8_t>();
    fault.probability = in.read<std::uint8_t>() / 255.0;
    if (fault.kind == FaultKind::kTorqueLoss) fault.value = std::abs(fault.value) / 32768.0;
    if (drive_) {
      drive_->inject(fault);
    } else {
      sensor_->inject(fault);
    }
  }

  void check() {
    for (const ObjectEntry* entry : objects_) {
      must(entry->value >= entry->low && entry->value <= entry->high,
           "an object is within its range");
    }
    std::vector<CanFrame> sent;
    node().take(sent);
    for (const CanFrame& frame : sent) {
      must(frame.length <= 8 && frame.id <= 0x7FF && !frame.extended && !frame.remote,
           "a node sends data frames of 11 bits");
    }
    if (drive_) check_drive();
  }

  void check_drive() {
    const auto word = static_cast<std::uint16_t>(
        drive_->node().dictionary().value(object_id(canopen::kStatusword)));
    // CiA 402, states by statusword, in the order of Drive402::State: mask, value, whether the
    // brake must be on. Where it need not be, it opens or closes, or the axis is under power.
    struct Row {
      std::uint16_t mask;
      std::uint16_t value;
      bool brake;
    };
    static constexpr std::array<Row, 8> kRows = {{{0x4F, 0x00, true},
                                                  {0x4F, 0x40, true},
                                                  {0x6F, 0x21, true},
                                                  {0x6F, 0x23, false},
                                                  {0x6F, 0x27, false},
                                                  {0x6F, 0x07, false},
                                                  {0x4F, 0x0F, false},
                                                  {0x4F, 0x08, true}}};
    const Row& row = kRows[static_cast<std::size_t>(drive_->state())];
    must((word & row.mask) == row.value, "the statusword tells the state");
    must(drive_->brake_engaged() || !row.brake, "the brake is on in a state without power");
  }

  std::unique_ptr<Drive402> drive_;
  std::unique_ptr<ForceTorqueNode> sensor_;
  std::vector<const ObjectEntry*> objects_;
  Drive402::Measurement plant_;
  bool stuck_ = false;
  std::int64_t now_ns_ = 0;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader in(std::span(data, size));
  Bench(in.read<std::uint8_t>()).run(in);
  return 0;
}
