#include "sim/physics/rollout/compliant_tool.h"

namespace tenon::sim {
namespace {

// ODE numbers the parameters of a motor's second and third axis by group.
int of_axis(int parameter, int axis) { return parameter + dParamGroup * axis; }

struct AxisDrive {
  double velocity = 0.0;  ///< Vel = (K e + D xs') / (h K + D)
  double softness = 0.0;  ///< CFM = 1 / (h K + D)
};

AxisDrive soft(double error, double speed, double stiffness, double damping, double step_s) {
  const double impedance = step_s * stiffness + damping;
  return {(stiffness * error + damping * speed) / impedance, 1.0 / impedance};
}

AxisDrive rigid(double error, double speed, double step_s) {
  constexpr double kCorrection = 0.5;  // of the error a step
  return {speed + kCorrection * error / step_s, 1e-12};
}

}  // namespace

CompliantTool::CompliantTool(OdeWorld& world, const Compliance& compliance)
    : body_(dBodyCreate(world.id())),
      translation_(dJointCreateLMotor(world.id(), nullptr)),
      rotation_(dJointCreateAMotor(world.id(), nullptr)) {
  dBodySetGyroscopicMode(body_, 0);
  dJointAttach(translation_, body_, nullptr);
  dJointAttach(rotation_, body_, nullptr);
  dJointSetLMotorNumAxes(translation_, 3);
  dJointSetAMotorMode(rotation_, dAMotorUser);
  dJointSetAMotorNumAxes(rotation_, 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 e = Vector3::Unit(axis);
    dJointSetLMotorAxis(translation_, axis, 0, e.x(), e.y(), e.z());
    dJointSetAMotorAxis(rotation_, axis, 0, e.x(), e.y(), e.z());
    dJointSetLMotorParam(translation_, of_axis(dParamFMax, axis), dInfinity);
    dJointSetAMotorParam(rotation_, of_axis(dParamFMax, axis), dInfinity);
  }
  set_compliance(compliance);
}

CompliantTool::~CompliantTool() {
  dJointDestroy(translation_);
  dJointDestroy(rotation_);
  dBodyDestroy(body_);
}

void CompliantTool::set_compliance(const Compliance& compliance) {
  compliance_ = compliance;
  dMass mass;
  dMassSetParameters(&mass, compliance.mass_kg, 0.0, 0.0, 0.0, compliance.inertia_kgm2,
                     compliance.inertia_kgm2, compliance.inertia_kgm2, 0.0, 0.0, 0.0);
  dBodySetMass(body_, &mass);
}

void CompliantTool::place(const Pose& pose) {
  set_pose(body_, pose);
  dBodySetLinearVel(body_, 0.0, 0.0, 0.0);
  dBodySetAngularVel(body_, 0.0, 0.0, 0.0);
  dBodySetForce(body_, 0.0, 0.0, 0.0);
  dBodySetTorque(body_, 0.0, 0.0, 0.0);
}

void CompliantTool::drive(const GuardedMove::Setpoint& setpoint, double step_s) {
  const Vector6 error = displacement_between(pose(), setpoint.pose);
  for (int axis = 0; axis < 6; ++axis) {
    const bool linear = axis < 3;
    const bool yields = (compliance_.compliant_axes >> axis & 1U) != 0;
    const AxisDrive drive =
        !yields ? rigid(error[axis], setpoint.velocity[axis], step_s)
                : soft(error[axis], setpoint.velocity[axis],
                       linear ? compliance_.stiffness_Npm : compliance_.stiffness_Nmpr,
                       linear ? compliance_.damping_Nspm : compliance_.damping_Nmspr, step_s);
    const auto set = linear ? dJointSetLMotorParam : dJointSetAMotorParam;
    const dJointID motor = linear ? translation_ : rotation_;
    set(motor, of_axis(dParamVel, axis % 3), drive.velocity);
    set(motor, of_axis(dParamCFM, axis % 3), drive.softness);
  }
  const Vector3 force = compliance_.mass_kg * setpoint.acceleration.head<3>();
  const Vector3 torque = compliance_.inertia_kgm2 * setpoint.acceleration.tail<3>();
  dBodyAddForce(body_, force.x(), force.y(), force.z());
  dBodyAddTorque(body_, torque.x(), torque.y(), torque.z());
}

}  // namespace tenon::sim
