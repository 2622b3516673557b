#pragma once
// Brings the settings of several nodes about, one SDO transfer after the other. No clock: frames
// and time are arguments, what it sends leaves by the bus. Not real-time, one thread.
//
//   kRunning --every setting is as asked--> kDone
//       +------ refusal, another value, silence ----> kFailed, see fault()
//
// What a device lacks or makes of a value, where its profile allows that, is kept as a note.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hw/canopen/object_setting.h"
#include "hw/canopen/sdo_client.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

struct SettingTask {
  std::uint8_t node = 0;
  canopen::ObjectSetting setting;
};

/// What a device is like beyond what was asked of it.
struct SettingNote {
  enum class Kind : std::uint8_t {
    kAbsent,  ///< it has no such object
    kOther,   ///< it made another value of the one written
    kTaken,   ///< its value was taken as it is
    kNoStop,  ///< it has no RPDO by which all drives are stopped at once
  };
  Kind kind = Kind::kAbsent;
  std::uint8_t node = 0;
  std::uint32_t object = 0;  ///< index << 8 | sub-index
  std::uint32_t found = 0;
  std::uint32_t wanted = 0;
};

/// What a node says of itself; all 0 where it has no such object.
struct NodeIdentity {
  std::uint8_t node = 0;
  std::uint32_t device_type = 0;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
};

class SettingRunner {
 public:
  enum class State : std::uint8_t { kRunning, kDone, kFailed };
  static constexpr std::int64_t kAwaitTimeout_ns = 500'000'000;

  /// Forgets notes and identities. @param notes what is known before any device is asked
  void reset(std::vector<SettingNote> notes = {});
  /// @param tasks outlive the run
  void start(std::span<const SettingTask> tasks);
  void process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus);
  /// Goes on as far as it can.
  State update(std::int64_t now_ns, CanBus& bus);

  [[nodiscard]] const ArmFault& fault() const { return fault_; }
  [[nodiscard]] const std::vector<SettingNote>& notes() const { return notes_; }
  [[nodiscard]] const std::vector<NodeIdentity>& identities() const { return identities_; }

 private:
  enum class Transfer : std::uint8_t { kNone, kWriting, kReading };

  void start_transfer(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void start_writing(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void start_reading(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void finish_transfer(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void finish_refused(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void finish_reading(const SettingTask& task, std::int64_t now_ns, CanBus& bus);
  void finish_comparing(bool same);
  void next_task();
  void give_up(const SettingTask& task);
  [[nodiscard]] bool is_spared(const SettingTask& task) const;
  void note(SettingNote::Kind kind, const SettingTask& task, std::uint32_t found);
  void record(const SettingTask& task, std::uint32_t value);
  void send(const CanFrame& frame, CanBus& bus);
  void fail(const ArmFault& fault);

  std::span<const SettingTask> tasks_;
  canopen::SdoClient sdo_;
  State state_ = State::kDone;
  ArmFault fault_;
  std::vector<SettingNote> notes_;
  std::vector<NodeIdentity> identities_;
  std::size_t task_ = 0;
  Transfer transfer_ = Transfer::kNone;
  std::uint32_t refusal_ = 0;  ///< of the write before the reading; 0: there was none
  bool comparing_ = false;     ///< the task before this one was a comparison
  bool same_ = false;          ///< what was compared last is as wanted
  std::int64_t task_started_ns_ = 0;
};

}  // namespace tenon::hw
