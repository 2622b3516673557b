#pragma once
// The planned box task on a virtual gantry, in lockstep over two ends of a bus of the kernel.

#include <string>

#include "shared/ports/can_bus.h"
#include "sim/lockstep/foreign_link.h"
#include "tests/support/lockstep.h"

namespace tenon::socketcan {

/// What TENON_BOX_PLAN names; tests/guest/run.sh makes it. @throws InputError where it names
/// nothing
[[nodiscard]] std::string box_plan_file();

class BoxRun {
 public:
  BoxRun(CanBus& master, CanBus& devices);

  [[nodiscard]] tests::Lockstep& lockstep() { return lockstep_; }
  [[nodiscard]] const sim::ForeignLink& link() const { return link_; }
  /// Until a move has been under way for a while. False: the run ended before.
  [[nodiscard]] bool into_motion();

 private:
  sim::ForeignLink link_;
  tests::Lockstep lockstep_;
};

}  // namespace tenon::socketcan
