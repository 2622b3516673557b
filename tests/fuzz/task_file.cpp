// A task file of arbitrary bytes, and each of its variants.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/config/load.h"
#include "tests/fuzz/support/refused.h"

namespace {

using namespace tenon;
using fuzz::must;

void check(const std::string& name) {
  Task task;
  if (!fuzz::accepted([&] { task = load_task(name); })) return;
  must(!task.starts.empty() && !task.held.empty() && !task.environment.empty(),
       "a task has starts and shapes");
  must(task.goal.position_m.allFinite() && task.goal.orientation.coeffs().allFinite(),
       "a goal is made of numbers");
  for (const Start& start : task.starts) {
    must(start.pose.position_m.allFinite() && start.sigma.allFinite(), "so is a start");
  }
  for (const std::vector<Shape>* shapes : {&task.held, &task.environment}) {
    for (const Shape& shape : *shapes) {
      must(shape.size_m.allFinite() && (shape.size_m.array() > 0.0).all(), "a shape has a size");
    }
  }
  must(task.step_m > 0.0 && task.rollout_step_us > 0 && task.motion.timeout_us > 0,
       "steps take their time");
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const std::string file = folder.put("task.yaml", fuzz::text_of(data, size));
  check(file);
  std::vector<std::string> variants;
  fuzz::accepted([&] { variants = task_variants(file); });
  for (std::size_t i = 0; i < variants.size() && i < 3; ++i) check(file + "#" + variants[i]);
  return 0;
}
