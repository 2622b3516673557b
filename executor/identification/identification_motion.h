#pragma once
// The task that moves the arm for an identification: something slow and watched where it stands. It
// has no start to go to; a stop, and whatever a joint cannot follow, ramps the joints down. Once
// all readings are taken it ends with kMeasured.
//
// Real-time but for the constructor: no allocation, no lock, no throw. One thread.

#include "executor/control_task.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

class IdentificationMotion : public ControlTask {
 public:
  /// Copies the cell. @throws InputError for a robot without joints
  explicit IdentificationMotion(const Cell& cell) : ControlTask(cell, {}) {}

 protected:
  /// The sensor is tared and the joints rest; run() comes next.
  virtual void begin() = 0;

  /// Joints or tool that cannot be followed end it.
  template <typename Target>
  void follow(const Target& target) {
    if (const auto refused = joints().follow(target)) end(*refused);
  }

 private:
  void on_enter(State state) final;
  void approach() final {}
  void ramp_down() final;
  [[nodiscard]] Vector6 move() final;
  void write_motion(CycleRecord& record) final;
};

}  // namespace tenon::executor
