#include "hw/check/motor_check.h"

#include "hw/arm/describe_sensor.h"
#include "hw/bus_load/bus_load.h"
#include "hw/bus_load/response_times.h"
#include "hw/mit/describe_motor.h"
#include "hw/mit/mit_arm.h"
#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon::hw {

CheckReport motor_report(const Robot& robot) {
  mit::check_robot(robot);
  CheckReport report;
  report.text =
      mit::describe_settings(robot) + describe_start(robot.sensor) + describe_loads(robot);
  try {
    check_bus_load(robot);
    check_response_times(robot);
    report.text += "verdict: bring-up asks for nothing else\n";
  } catch (const InputError& error) {
    report.good = false;
    report.text += std::string("verdict: ") + error.what() + "\n";
  }
  return report;
}

}  // namespace tenon::hw
