#pragma once
// A cell: one robot, calibrated against one task frame. What hw/cells/NAME.yaml say.

#include <string>

#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon {

struct Cell {
  std::string name;
  Robot robot;
  Vector3 up_B = Vector3::UnitZ();  ///< against gravity, in base axes; unit length
  Pose X_BT;                        ///< task frame in the robot's base frame
  Pose X_FP;                        ///< tool frame (tip of the held part) in the flange frame
  Pose X_FS;                        ///< sensor frame in the flange frame
  double payload_mass_kg = 0.0;     ///< beyond the sensor
  Vector3 payload_com_m = Vector3::Zero();  ///< in the sensor frame
  double contact_stiffness_Npm = 5e4;       ///< k_e, in series with arm and sensor
  double force_fault_N = 60.0;              ///< beyond: stop
  double torque_fault_Nm = 10.0;
  bool hold_if_brake_fails = false;  ///< a brake that slips after disabling: power again, and hold
};

}  // namespace tenon
