#include "tests/socketcan/box_run.h"

#include <cstdint>

#include "shared/config/load.h"
#include "tests/support/places.h"

namespace tenon::socketcan {
namespace {

constexpr std::int64_t kPatience_ns = 100'000'000;
constexpr int kMoving_cycles = 200;

const Task& task() {
  static const Task task = load_task(tests::in_tree("planner/tasks/box_on_table_2d.yaml"));
  return task;
}

Cell cell_of(std::uint32_t sensor_bitrate_bps) {
  Cell cell = load_cell(tests::in_tree("hw/cells/gantry3.yaml"));
  cell.robot.sensor.own_bitrate_bps = sensor_bitrate_bps;
  return cell;
}

tests::WholeRun::Options options(sim::Link& link) {
  tests::WholeRun::Options options;
  options.start = "1";
  options.offset[0] = 0.02;
  options.offset[1] = 0.015;
  options.link = &link;
  return options;
}

}  // namespace

BoxRun::BoxRun(CanBus& master, CanBus& devices, std::uint32_t sensor_bitrate_bps)
    : link_(master, devices, kPatience_ns),
      lockstep_(cell_of(sensor_bitrate_bps), task(), load_plan(tests::shared_plan("box_1_gantry3")),
                options(link_)) {}

bool BoxRun::into_motion() {
  if (!lockstep_.prepare()) return false;
  for (int moving = 0; moving < kMoving_cycles;) {
    if (!lockstep_.cycle()) return false;
    moving += lockstep_.controller().state() == executor::State::kRunning;
  }
  return true;
}

}  // namespace tenon::socketcan
