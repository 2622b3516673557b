#pragma once
// A cell: one robot, calibrated against one task frame. What hw/cells/NAME.yaml say.

#include <optional>
#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon {

/// What a sensor reads of itself, without payload and contact, in its own axes; and by how much a
/// tare may find it otherwise.
struct SensorBias {
  Vector6 wrench = Vector6::Zero();  ///< N, Nm
  double force_tolerance_N = 0.0;    ///< on any axis
  double torque_tolerance_Nm = 0.0;
};

/// What identification found of a drive's friction: N, N s/m and m, or Nm, Nm s/rad and rad.
struct JointFriction {
  double coulomb = 0.0;
  double viscous = 0.0;
  double offset = 0.0;  ///< what the drive reports without load, and what gravity's model misses
  double way = 1e-4;    ///< within which Coulomb friction turns after a reversal
  double hysteresis = 0.0;       ///< what turns within a longer way, a gear's
  double hysteresis_way = 1e-2;  ///< that way
  double residual = 0.0;         ///< the most that all that was off by
};

/// The force comes from the efforts of the joints.
struct JointTorque {
  std::vector<JointFriction> joints;  ///< empty: nothing has been identified
};

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
  double contact_stiffness_Nmpr =
      0.0;  ///< the same against a turn about the tool tip; 0: not known
  std::optional<SensorBias> sensor_bias;    ///< unset: a tare takes what it finds
  std::optional<JointTorque> joint_torque;  ///< unset: the robot's sensor measures the force
  double force_fault_N = 60.0;              ///< beyond: stop
  double torque_fault_Nm = 10.0;
  bool hold_if_brake_fails = false;  ///< a brake that slips after disabling: power again, and hold
};

}  // namespace tenon
