#include "tests/support/sensor_faults.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "executor/faults/fault_table.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

constexpr std::int64_t kBegin_ns = 4'000'000'000;

void expect_fault(const Cell& cell, const Planned& planned, const SensorFault& fault) {
  SCOPED_TRACE(fault.spec);
  WholeRun::Options options;
  options.start = "1";
  options.faults = {sim::parse_fault(fault.spec + ":time_s=4")};
  WholeRun run(cell, planned.task, planned.plan, options);
  ASSERT_TRUE(run.prepare()) << run.result().reason;
  std::int64_t took = 0;
  while (run.cycle()) {
    ASSERT_LT(run.now_ns(), 10 * kBegin_ns);
    const bool named = run.controller().ending().reason != executor::EndReason::kNone;
    if (!named && run.now_ns() > kBegin_ns) ++took;
  }
  const auto result = run.result();
  const executor::FaultRow* row =
      executor::fault_row(result.ending.reason, result.ending.arm_fault.kind);
  ASSERT_NE(row, nullptr) << result.reason;
  EXPECT_EQ(executor::full_name(*row), fault.name) << result.reason;
  EXPECT_NE(result.reason.find(fault.says), std::string::npos) << result.reason;
  EXPECT_LT(took, executor::bound_cycles(*row, cell.robot).value()) << result.reason;
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

}  // namespace

void expect_sensor_faults(const Cell& cell, const std::vector<SensorFault>& faults) {
  const Planned planned = planned_box(cell, "1");
  for (const SensorFault& fault : faults) expect_fault(cell, planned, fault);
}

}  // namespace tenon::tests
