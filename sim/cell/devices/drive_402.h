#pragma once
// A servo drive's firmware: CiA 402 power states (drive_state.h), cyclic synchronous position (mode
// 8) or interpolated position (mode 7, with halt), quick stop, holding brake with its delays,
// following error, torque limit, temperature, supply, loss of the master, and the faults that one
// may inject.
//
// A ramp down (quick stop, disabling, fault reaction, lost master) starts from the demand's own
// velocity. Operation is enabled when the brake is open. What turns the axis, and how far it really
// got, is the plant's: it reads demand() and writes measured(). One thread; time is an argument.

#include <cstdint>
#include <optional>

#include "shared/eds/device_file.h"
#include "sim/cell/canopen/slave_node.h"
#include "sim/cell/devices/active_faults.h"
#include "sim/cell/devices/drive_motion.h"
#include "sim/cell/devices/drive_objects.h"
#include "sim/cell/devices/drive_parameters.h"
#include "sim/cell/devices/drive_state.h"
#include "sim/cell/devices/virtual_drive.h"

namespace tenon::sim {

class Drive402 final : public VirtualDrive, private NodeApplication {
 public:
  using State = DriveState;
  using Parameters = DriveParameters;

  explicit Drive402(const Parameters& parameters);

  /// Before power-on: answers from now on with the objects, limits and access types of a device's
  /// own description, and does without what that lacks. Without 6007h it does nothing about a lost
  /// master.
  void become_twin(const DeviceFile& file);

  [[nodiscard]] SlaveNode& node() { return node_; }
  [[nodiscard]] const SlaveNode& node() const { return node_; }

  [[nodiscard]] std::uint8_t number() const override { return node_.node(); }
  void power_on(std::int64_t now_ns) override { node_.power_on(now_ns); }
  void receive(const CanFrame& frame, std::int64_t now_ns) override {
    node_.receive(frame, now_ns);
  }
  void take(std::vector<CanFrame>& frames) override { node_.take(frames); }
  /// Timers of node and drive.
  void advance(std::int64_t now_ns) override;

  [[nodiscard]] Demand demand(std::int64_t step_ns) override;
  void measured(const Measurement& measurement, std::int64_t step_ns) override;
  /// The voltage behind the power stage.
  void set_supply(double volts);

  /// Begins a fault now, that is at the time of the last advance(): node reset, silent node,
  /// emergency, encoder jump, brake failure, torque loss, frozen drive, frozen effort, and the ways
  /// in which a drive may be unkind. Whether it happens is drawn once. Others are not a drive's,
  /// and ignored.
  void inject(const Fault& fault) override;
  [[nodiscard]] bool can_have(const Fault& fault) const override;
  [[nodiscard]] Look look() const override;

  [[nodiscard]] State state() const { return state_; }
  /// The brake's output; it holds a little later.
  [[nodiscard]] bool brake_engaged() const { return motion_.brake().engaged(); }
  /// It ramps down under power, or its brake closes.
  [[nodiscard]] bool stopping() const {
    return motion_.phase() == DriveMotion::Phase::kRamping ||
           motion_.phase() == DriveMotion::Phase::kEngaging;
  }
  [[nodiscard]] std::uint16_t error_code() const {
    return static_cast<std::uint16_t>(objects_.error_code.value);
  }

 private:
  void on_reset(std::int64_t now_ns) override;
  void on_sample() override {}  // measured() keeps the objects up to date
  void on_sync() override;
  void on_connection_lost() override;
  [[nodiscard]] bool may_store() const override { return !motion_.powered(); }

  [[nodiscard]] std::uint32_t on_controlword(std::uint16_t word);
  [[nodiscard]] std::uint32_t on_mode(std::int64_t mode);
  void command(DriveCommand command);
  void apply(const DriveTransition& transition);
  void act(DriveAction action, bool brake_afterwards);
  void enter_state(State next);
  void fault(std::uint16_t code);
  void update_halt();
  void resume_stop();
  void watch_following_error(std::int64_t step_ns);
  void watch_power_stage(std::int64_t step_ns);
  void update_statusword();
  [[nodiscard]] bool interpolates() const;
  [[nodiscard]] bool cyclic() const;
  [[nodiscard]] bool supply_good() const;
  [[nodiscard]] double torque_max_permille() const;

  Parameters parameters_;
  SlaveNode node_;
  DriveObjects objects_;
  DriveMotion motion_;
  ActiveFaults faults_;
  State state_ = State::kNotReady;
  std::int64_t now_ns_ = 0;
  std::int64_t ready_ns_ = 0;
  std::uint16_t last_controlword_ = 0;
  bool enable_buffered_ = false;            ///< the last enable word has not been found yet
  std::optional<std::int64_t> stopped_ns_;  ///< when the quick stop under way began
  std::optional<State> afterwards_;         ///< entered when the motion is done
  bool halted_ = false;
  Measurement measurement_;              ///< as the encoder tells it
  double encoder_jump_counts_ = 0.0;     ///< of a fault
  std::optional<double> frozen_counts_;  ///< of a fault: where the axis is held meanwhile
  double temperature_degC_;
  std::int64_t outside_window_ns_ = 0;
};

}  // namespace tenon::sim
