#pragma once
// The planned box task on a virtual gantry, in lockstep over two ends of a bus of the kernel.

#include "shared/ports/can_bus.h"
#include "sim/cell/lockstep/foreign_link.h"
#include "tests/support/whole_run.h"

namespace tenon::socketcan {

class BoxRun {
 public:
  BoxRun(CanBus& master, CanBus& devices);

  [[nodiscard]] tests::WholeRun& lockstep() { return lockstep_; }
  [[nodiscard]] const sim::ForeignLink& link() const { return link_; }
  /// Until a move has been under way for a while. False: the run ended before.
  [[nodiscard]] bool into_motion();

 private:
  sim::ForeignLink link_;
  tests::WholeRun lockstep_;
};

}  // namespace tenon::socketcan
