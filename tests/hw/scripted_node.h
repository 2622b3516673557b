#pragma once
// A minimal CANopen node for tests of the master: an object dictionary in a map, NMT, heartbeat,
// expedited SDO, and a CiA 402 drive or a force/torque source behind it. Written from the standard
// with literal bytes, sharing nothing with the master. Steps with the caller; no thread, no clock.
// Its knobs make it misbehave.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

class ScriptedNode {
 public:
  enum class Kind : std::uint8_t { kDrive, kSensor };
  struct Object {
    std::uint8_t size_bytes = 4;
    std::uint32_t value = 0;
  };
  struct Write {
    std::uint32_t object = 0;  ///< index << 8 | sub
    std::uint32_t value = 0;
  };

  ScriptedNode(Kind kind, std::uint8_t node, CanBus& bus);

  /// Takes in everything that has arrived and answers it.
  void step(std::int64_t now_ns);
  void send(std::uint32_t id, std::vector<std::uint8_t> bytes);
  /// As after a power failure: everything is lost, a boot-up message leaves.
  void reboot();

  // What the test may look at and change.
  std::map<std::uint32_t, Object> objects;
  std::vector<Write> writes;  ///< in the order of arrival
  std::uint8_t nmt_state = 0x7F;
  std::uint16_t statusword = 0x0250;
  std::uint16_t controlword = 0;  ///< as it acts
  std::int32_t position_counts = 0;
  std::int32_t target_counts = 0;  ///< as it acts
  std::int16_t torque_permille = 0;
  std::array<std::int16_t, 6> wrench_counts{};
  std::uint16_t sample_counter = 0;
  int samples_per_sync = 1;
  std::vector<CanFrame> commands;  ///< RPDOs as they came, of both numbers

  // Knobs.
  bool dead = false;  ///< neither hears nor speaks
  bool heartbeats = true;
  bool answers_sync = true;
  bool ignores_start = false;
  bool stuck = false;                ///< the drive's state machine does not move
  bool stays_in_quick_stop = false;  ///< as with 605Ah = 6
  bool tears = false;                ///< a new sample between the two frames of a wrench
  bool follows = true;               ///< position := target at each SYNC
  std::uint8_t tpdo_bytes = 8;
  std::map<std::uint32_t, std::uint32_t> refuses;  ///< object to abort code
  std::map<std::uint32_t, std::uint32_t> keeps;    ///< object to the value that reading gives
  std::set<std::uint32_t> read_only;
  std::map<std::uint32_t, std::uint32_t> default_mapping;  ///< of PDOs, from the next reset on
  std::optional<std::uint32_t> mute_at;                    ///< object whose SDO is not answered

 private:
  void end_quick_stop();
  void on_nmt(const CanFrame& frame);
  void on_sdo(const CanFrame& frame);
  void on_rpdo(unsigned number, const CanFrame& frame);
  void act(unsigned number, const CanFrame& frame);
  void on_sync();
  void send_wrench();
  void send_feedback();
  void answer(std::uint8_t command, const CanFrame& request, std::uint32_t value);
  void obey(std::uint16_t before);
  [[nodiscard]] bool follows_targets() const;
  void reset_communication();

  Kind kind_;
  std::uint8_t node_;
  CanBus& bus_;
  int quick_stop_steps_ = 0;
  std::uint32_t syncs_ = 0;  ///< of a sensor, since its last wrench
  std::int64_t next_heartbeat_ns_ = 0;
  std::array<std::optional<CanFrame>, 2> pending_;  ///< synchronous RPDOs since the last SYNC
};

}  // namespace tenon::hw
