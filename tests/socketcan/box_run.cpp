#include "tests/socketcan/box_run.h"

#include <cstdint>
#include <cstdlib>

#include "shared/base/error.h"
#include "shared/config/load.h"

namespace tenon::socketcan {
namespace {

constexpr std::int64_t kPatience_ns = 100'000'000;
constexpr int kMoving_cycles = 200;

const Task& task() {
  static const Task task = load_task(TENON_SOURCE_DIR "/planner/tasks/box_on_table_2d.yaml");
  return task;
}

tests::Lockstep::Options options(sim::Link& link) {
  tests::Lockstep::Options options;
  options.start = "1";
  options.offset[0] = 0.02;
  options.offset[1] = 0.015;
  options.link = &link;
  return options;
}

}  // namespace

std::string box_plan_file() {
  const char* file = std::getenv("TENON_BOX_PLAN");
  if (file == nullptr) throw InputError("TENON_BOX_PLAN names no plan; run tests/guest/run.sh");
  return file;
}

BoxRun::BoxRun(CanBus& master, CanBus& devices)
    : link_(master, devices, kPatience_ns),
      lockstep_(load_cell(TENON_SOURCE_DIR "/hw/cells/gantry3.yaml"), task(),
                load_plan(box_plan_file()), options(link_)) {}

bool BoxRun::into_motion() {
  if (!lockstep_.prepare()) return false;
  for (int moving = 0; moving < kMoving_cycles;) {
    if (!lockstep_.cycle()) return false;
    moving += lockstep_.controller().state() == executor::State::kRunning;
  }
  return true;
}

}  // namespace tenon::socketcan
