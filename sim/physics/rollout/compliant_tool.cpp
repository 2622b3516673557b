#include "sim/physics/rollout/compliant_tool.h"

namespace tenon::sim {
namespace {

// No contact turns a body of this inertia by anything that a double can hold.
constexpr double kLockedInertia_kgm2 = 1e12;

// The body is that of the part, whose mass counts as the tool's: the motors carry that too.
constexpr double kBodyOfMass = 1e-3;

// ODE numbers the parameters of a motor's second and third axis by group.
int of_axis(int parameter, int axis) { return parameter + dParamGroup * axis; }

struct AxisDrive {
  double velocity = 0.0;  ///< Vel = (K e + D xs') / (h K + D)
  double softness = 0.0;  ///< CFM = 1 / (h K + D)
};

/// Towards a velocity, from which each newton takes it away by so much; the body's mass, which
/// moves with that velocity before the step, has a part in that.
AxisDrive towards(double velocity_mps, double give_mpspN, double mass_kg, double step_s) {
  return {velocity_mps, 1.0 / (1.0 / give_mpspN - mass_kg / step_s)};
}

AxisDrive soft(double error, double speed, double stiffness, double damping, double step_s) {
  const double impedance = step_s * stiffness + damping;
  return {(stiffness * error + damping * speed) / impedance, 1.0 / impedance};
}

AxisDrive rigid(double error, double step_s) { return {error / step_s, 1e-12}; }

}  // namespace

CompliantTool::CompliantTool(OdeWorld& world, const Compliance& compliance)
    : tool_(compliance),
      body_(dBodyCreate(world.id())),
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

void CompliantTool::set_compliance(const Compliance& compliance, bool turns, const ArmGive& arm) {
  compliance_ = compliance;
  arm_ = arm;
  tool_ = Admittance(compliance);
  turns_ = turns;
  const double inertia_kgm2 = turns ? compliance.inertia_kgm2 : kLockedInertia_kgm2;
  dMass mass;
  dMassSetParameters(&mass, kBodyOfMass * compliance.mass_kg, 0.0, 0.0, 0.0, inertia_kgm2,
                     inertia_kgm2, inertia_kgm2, 0.0, 0.0, 0.0);
  dBodySetMass(body_, &mass);
  (turns ? dJointEnable : dJointDisable)(rotation_);
}

void CompliantTool::place(const Pose& pose, const Vector3& force_N) {
  tool_.reset({pose, Vector6::Zero()});
  for (int axis = 0; axis < 3; ++axis) {
    bent_m_[axis] = tool_.yields(axis) ? arm_.give_mpN * force_N[axis] : 0.0;
  }
  shown_ = false;
  show();
}

void CompliantTool::return_to(const State& state) {
  tool_.reset(state.tool);
  bent_m_ = state.bent_m;
  shown_ = false;
}

void CompliantTool::fly(const GuardedMove::Setpoint& setpoint, double step_s,
                        const Vector6& wrench) {
  tool_.update(setpoint, wrench, step_s);
  bend(wrench.head<3>(), step_s);
  shown_ = false;
}

void CompliantTool::bend(const Vector3& force_N, double step_s) {
  // bent + relaxation bent' = give force, solved for what the step leaves.
  for (int axis = 0; axis < 3; ++axis) {
    const double whole_m = tool_.yields(axis) ? arm_.give_mpN * force_N[axis] : 0.0;
    bent_m_[axis] += (whole_m - bent_m_[axis]) * step_s / (step_s + arm_.relaxation_s);
  }
}

Vector3 CompliantTool::free_velocity_mps(const GuardedMove::Setpoint& setpoint,
                                         double step_s) const {
  const Vector6 of_tool = tool_.next_velocity(setpoint, Vector6::Zero(), step_s);
  return of_tool.head<3>() - bent_m_ / (step_s + arm_.relaxation_s);
}

Vector3 CompliantTool::give_mpspN(double step_s) const {
  const double give = 1.0 / (compliance_.mass_kg / step_s + compliance_.damping_Nspm +
                             compliance_.stiffness_Npm * step_s) +
                      arm_.give_mpN / (step_s + arm_.relaxation_s);
  return {tool_.yields(0) ? give : 0.0, tool_.yields(1) ? give : 0.0, tool_.yields(2) ? give : 0.0};
}

void CompliantTool::show() {
  if (shown_) return;
  shown_ = true;
  const Vector6& v = tool_.state().velocity;
  const Pose part = part_pose();
  if (shown_orientation_ && shown_orientation_->coeffs() == part.orientation.coeffs()) {
    dBodySetPosition(body_, part.position_m.x(), part.position_m.y(), part.position_m.z());
  } else {
    set_pose(body_, part);
    shown_orientation_ = part.orientation;
  }
  dBodySetLinearVel(body_, v[0], v[1], v[2]);
  dBodySetAngularVel(body_, v[3], v[4], v[5]);
  dBodySetForce(body_, 0.0, 0.0, 0.0);
  dBodySetTorque(body_, 0.0, 0.0, 0.0);
}

void CompliantTool::drive(const GuardedMove::Setpoint& setpoint, double step_s,
                          const Vector3& torque_Nm) {
  drive_ = {setpoint, step_s, free_velocity_mps(setpoint, step_s), give_mpspN(step_s)};
  dBodySetLinearVel(body_, drive_.free_mps.x(), drive_.free_mps.y(), drive_.free_mps.z());
  const Vector6 error = displacement_between(pose(), setpoint.pose);
  for (int axis = 0; axis < (turns_ ? 6 : 3); ++axis) {
    const bool linear = axis < 3;
    const AxisDrive drive =
        !tool_.yields(axis) ? rigid(error[axis], step_s)
        : linear            ? towards(drive_.free_mps[axis], drive_.give_mpspN[axis],
                                      kBodyOfMass * compliance_.mass_kg, step_s)
                            : soft(error[axis], setpoint.velocity[axis], compliance_.stiffness_Nmpr,
                                   compliance_.damping_Nmspr, step_s);
    const auto set = linear ? dJointSetLMotorParam : dJointSetAMotorParam;
    const dJointID motor = linear ? translation_ : rotation_;
    set(motor, of_axis(dParamVel, axis % 3), drive.velocity);
    set(motor, of_axis(dParamCFM, axis % 3), drive.softness);
  }
  if (!turns_) return;
  const Vector3 torque = compliance_.inertia_kgm2 * setpoint.acceleration.tail<3>() + torque_Nm;
  dBodyAddTorque(body_, torque.x(), torque.y(), torque.z());
}

void CompliantTool::follow() {
  const dReal* linear = dBodyGetLinearVel(body_);
  const dReal* angular = dBodyGetAngularVel(body_);
  Vector6 wrench = Vector6::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (!tool_.yields(axis)) continue;
    wrench[axis] = (linear[axis] - drive_.free_mps[axis]) / drive_.give_mpspN[axis];
  }
  const Eigen::Quaterniond before = pose().orientation;
  Admittance::State state = tool_.update(drive_.setpoint, wrench, drive_.step_s);
  bend(wrench.head<3>(), drive_.step_s);
  state.pose.orientation = turns_ ? pose_of(body_).orientation : before;
  state.velocity.tail<3>() << angular[0], angular[1], angular[2];
  tool_.reset(state);
  shown_ = false;
  shown_orientation_.reset();
}

}  // namespace tenon::sim
