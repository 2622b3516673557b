#pragma once
// The task that moves the arm for an identification: something slow and watched where it stands. It
// has no start to go to; a stop, and whatever a joint cannot follow, ramps the joints down. Once
// all readings are taken it ends with kMeasured.
//
// Real-time but for the constructor: no allocation, no lock, no throw. One thread.

#include <optional>

#include "executor/loop/control_task.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

class IdentificationMotion : public ControlTask {
 public:
  /// Copies the cell. @throws InputError for a robot without joints
  explicit IdentificationMotion(const Cell& cell) : ControlTask(cell, {}) {}

 protected:
  /// The sensor is tared and the joints rest; run() comes next.
  virtual void begin() = 0;

 private:
  [[nodiscard]] Turn on_enter(State state) final;
  [[nodiscard]] Turn approach() final { return {}; }
  [[nodiscard]] Turn ramp_down() final;
  /// run() has commanded them; once it is over they ramp down.
  [[nodiscard]] std::optional<Ending> command_joints() final;
  [[nodiscard]] Vector6 complete_motion() final;
  void write_motion(CycleRecord& record) final;
};

}  // namespace tenon::executor
