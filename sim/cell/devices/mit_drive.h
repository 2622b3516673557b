#pragma once
// A motor in MIT mode: it obeys the stiffness, damping and torque of the last command, answers
// every frame that it is sent, and goes off by itself when none has come for its TIMEOUT.
//
//   Off ── enable ──> On ── disable ──> Off
//   On ── TIMEOUT, or an injected error ──> Error ── clear error ──> Off
//
// It has no brake. Until it has obeyed for the first time a stand holds the joint, as somebody has
// to hold a real one; from then on a motor that is off lets it go. What turns the axis is the
// plant's. One thread; time is an argument.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/devices/active_faults.h"
#include "sim/cell/devices/virtual_drive.h"
#include "sim/cell/mit/motor_codec.h"

namespace tenon::sim {

class MitDrive final : public VirtualDrive {
 public:
  /// As the joint's file describes it, but for what bring-up has to write: another mode, no
  /// TIMEOUT.
  explicit MitDrive(const Joint& joint);

  [[nodiscard]] std::uint8_t number() const override { return number_; }
  void power_on(std::int64_t now_ns) override;
  void receive(const CanFrame& frame, std::int64_t now_ns) override;
  void take(std::vector<CanFrame>& frames) override;
  void advance(std::int64_t now_ns) override;
  [[nodiscard]] Demand demand(std::int64_t step_ns) override;
  void measured(const Measurement& measurement, std::int64_t step_ns) override;

  /// Node reset, silence, encoder jump, torque loss, a motor that stands still under power, a
  /// torque that it reports again and again, and an "emergency" whose code is an error of its own,
  /// 8 to Eh. It has no brake that could fail.
  [[nodiscard]] bool can_have(const Fault& fault) const override;
  void inject(const Fault& fault) override;
  [[nodiscard]] Look look() const override;

 private:
  void on_register(const CanFrame& frame);
  void on_special(std::uint8_t what);
  void enter_state(std::uint8_t state);
  void answer();
  [[nodiscard]] MotorRanges ranges() const;
  [[nodiscard]] double real(std::uint8_t number) const;
  [[nodiscard]] double counts_per_rad() const;

  std::uint8_t number_;
  double rated_effort_;
  double counts_per_unit_;
  std::map<std::uint8_t, std::uint32_t> defaults_;  ///< registers that it keeps without power
  std::map<std::uint8_t, std::uint32_t> registers_;
  std::uint8_t state_;
  bool silent_ = false;
  bool let_go_ = false;  ///< by the stand
  std::int64_t now_ns_ = 0;
  std::int64_t heard_ns_ = 0;         ///< the last command
  std::optional<MotorOrder> order_;   ///< since it is on
  std::optional<double> frozen_rad_;  ///< of a fault
  double jump_rad_ = 0.0;             ///< of a fault, in the motor's direction
  Measurement measurement_;
  double torque_permille_ = 0.0;  ///< as it reports it
  ActiveFaults faults_;
  std::vector<CanFrame> outbox_;
};

}  // namespace tenon::sim
