#include "hw/main_can_motors.h"

#include <cstddef>
#include <cstdio>

#include "hw/mit/motor_scan.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {

Robot load_motors(const std::string& robot_file) {
  Robot robot = load_robot(robot_file);
  if (speaks_mit(robot)) return robot;
  throw InputError("--robot " + robot_file +
                   ": has CANopen drives, which scan and state find without it");
}

int look_at_motors(CanBus& bus, const Robot& robot, bool state) {
  mit::MotorScan scan(robot);
  while (!scan.done()) {
    scan.update(monotonic_now_ns(), bus);
    bus.wait(1'000'000);
    ReceivedFrame received;
    while (bus.receive(received)) scan.process(received.frame);
  }
  std::size_t well = 0;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const mit::MotorScan::Found& found = scan.found(i);
    const std::string line =
        state ? describe_state(robot, i, found) : describe_registers(robot, i, found);
    std::fprintf(found.answers_on ? stdout : stderr, "%s\n", line.c_str());
    const std::string refusal = refusal_of(robot, i, found);
    if (!refusal.empty()) std::fprintf(stderr, "%s\n", refusal.c_str());
    const bool good = state ? is_well(robot, i, found) : found.answers_on.has_value();
    well += refusal.empty() && good ? 1 : 0;
  }
  std::printf("%zu of %zu motors as the robot file says%s\n", well, robot.joints.size(),
              state ? ", without error" : "");
  return well == robot.joints.size() ? 0 : 1;
}

}  // namespace tenon::hw
