#pragma once
// An executor and a virtual cell in virtual time, in one thread, each cycle to quiescence: SYNC
// leaves, the cell answers when SYNC has arrived, feedback comes in frame by frame, the decision
// falls with the last one (computing takes no time), and the setpoints travel while time goes on to
// the next SYNC. A lost frame is a lost frame and no hang: the decision then falls at the deadline,
// as on the clock.
//
//   due    SYNC ──> cell samples ──> feedback ... last one: decision ──> setpoints ──> due + cycle
//   bus    ▇▇       ▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇▇                    ▇▇▇▇▇▇▇▇▇▇
//
// It knows the executor by the arm port and by its loop's begin() and finish() alone, so that mains
// and tests may compose it. Refers to all that it is given, which must outlive it.

#include <cstdint>

#include "shared/ports/arm.h"
#include "sim/cell/lockstep/link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"

namespace tenon::sim {

class Lockstep {
 public:
  struct Parameters {
    std::int64_t cycle_ns = 2'000'000;
    double feedback_deadline = 0.7;  ///< share of the cycle, as in the executor's loop
    std::int64_t prepare_max_ns = 20'000'000'000;
  };

  struct Statistics {
    std::int64_t cycles = 0;
    std::int64_t incomplete_cycles = 0;   ///< decided at the deadline
    std::int64_t missed_cycles = 0;       ///< frames of the master still waited at the next SYNC
    std::int64_t latest_feedback_ns = 0;  ///< from SYNC to the last feedback, of complete cycles
  };

  Lockstep(Arm& arm, VirtualCell& cell, Link& link, const Parameters& parameters);

  /// Brings the arm up. False: it failed, see the arm's fault, or took too long.
  bool prepare();

  /// One control cycle. False once the run is over.
  /// @param loop has begin(now_ns), and finish(now_ns) that says whether there is more to come
  template <typename Loop>
  bool cycle(Loop& loop) {
    run_to_sync();
    loop.begin(now_ns_);
    await_feedback();
    return loop.finish(now_ns_);
  }

  /// Time goes on without the executor: what a killed process looks like from the bus.
  void leave_alone(std::int64_t duration_ns) { run_until(now_ns_ + duration_ns); }

  // For a loop that runs by itself (virtual_clock.h).
  void run_until(std::int64_t until_ns);
  /// Until something waits at the master's end, at most so long.
  void await_master(std::int64_t until_ns);

  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }

 private:
  void step(std::int64_t until_ns);
  void run_to_sync();
  void await_feedback();

  Arm& arm_;
  VirtualCell& cell_;
  Link& link_;
  const Parameters parameters_;
  std::int64_t now_ns_ = 0;
  std::int64_t next_sync_ns_ = 0;
  std::int64_t next_tick_ns_ = 0;
  Statistics statistics_;
};

}  // namespace tenon::sim
