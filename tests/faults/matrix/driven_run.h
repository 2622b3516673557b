#pragma once
// A whole run in which a fault of a kind strikes in a phase, driven cycle by cycle.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/faults/fault_table.h"
#include "shared/eds/device_file.h"
#include "sim/cell/faults/fault_phases.h"
#include "tests/faults/matrix/fault_kind.h"
#include "tests/faults/matrix/fault_watch.h"
#include "tests/support/planned.h"
#include "tests/support/rest_watch.h"
#include "tests/support/twins.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {

/// A robot, its plan, and where a run without faults is when a phase begins and a little later.
struct Ground {
  /// @param twin what every drive answers like, a file of tests/twins; empty: by the book
  /// @param plan_of the cell of the same mechanics that the plan was made for; empty: this one
  explicit Ground(const std::string& cell_name, const std::string& twin = {},
                  const std::string& plan_of = {});

  /// What a stop on force may come to: the bound, and what the stiffest contact adds at the plan's
  /// greatest speed until it is noticed and acted on.
  /// @param blind_s for so long nobody looks
  [[nodiscard]] double force_most_N(double blind_s = 0.0) const;

  struct Moment {
    JointVector joints{};
    Vector3 tool_m = Vector3::Zero();  ///< task frame, of the environment as it stands
    JointVector lowest{};              ///< of the run until then
    JointVector highest{};
  };
  /// A joint that comes in a phase to where it never was, and half of how far.
  struct WayOn {
    std::size_t joint = 0;
    bool up = false;
    double half = 0.0;   ///< m or rad
    double limit = 0.0;  ///< halfway
  };
  /// Of all such joints the one that comes furthest; unset: none does.
  [[nodiscard]] std::optional<WayOn> way_on(sim::FaultPhase phase) const;

  Cell cell;
  std::map<std::uint8_t, DeviceFile> twins;
  Planned planned;
  executor::DryRun dry_run;
  JointVector start{};
  std::array<Moment, sim::kFaultPhases> begins{};
  std::array<Moment, sim::kFaultPhases> later{};  ///< 0.4 s after that, and a centimetre away
};

/// Where and when a fault strikes.
struct Strike {
  sim::FaultPhase phase = sim::FaultPhase::kFree;
  double after_s = 0.02;       ///< from when the phase began
  executor::FaultMask mask{};  ///< of detectors that are off
  std::uint64_t seed = 1;      ///< of the sensor's noise
  Vector6 offset = (Vector6() << 0.01, -0.01, 0.0, 0.0, 0.0, 0.0).finished();
};

/// Use it on one thread. Ground and kind must outlive it.
class DrivenRun {
 public:
  DrivenRun(const Ground& ground, const FaultKind& kind, const Strike& strike);

  /// To the run's end, and until all rests.
  void drive();

  [[nodiscard]] const FaultWatch& watch() const { return watch_; }
  [[nodiscard]] const RestWatch& rest() const { return rest_; }
  [[nodiscard]] WholeRun::Result result() const { return run_.result(); }
  /// The black box's last record tells the run's end, and none is missing before it.
  [[nodiscard]] bool black_box_is_whole();

 private:
  [[nodiscard]] WholeRun::Options options(const Ground& ground);
  /// Stops, strikes. @return by how much the loop wakes up late, ns
  std::int64_t before_a_cycle();

  /// The cell and the task that the run meets where the fault is one of them.
  struct Altered {
    Cell cell;
    Task task;
  };

  [[nodiscard]] static Altered altered(const Ground& ground, const FaultKind& kind,
                                       sim::FaultPhase phase);

  const FaultKind& kind_;
  Strike strike_;
  Altered world_;
  FaultWatch watch_;
  WholeRun run_;
  CanBus& third_;
  RestWatch rest_;
};

}  // namespace tenon::tests
