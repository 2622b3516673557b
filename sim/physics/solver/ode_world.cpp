#include "sim/physics/solver/ode_world.h"

#include <cstdarg>

#include "sim/physics/solver/contact_row.h"

namespace tenon::sim {
namespace {

thread_local std::uint64_t messages = 0;

void count_message(int /*number*/, const char* /*text*/, va_list /*arguments*/) { ++messages; }

// ODE wants one initialisation a process and its collision caches allocated on every thread.
void initialise() {
  static const bool process = [] {
    dInitODE2(0);
    dSetMessageHandler(&count_message);
    return true;
  }();
  thread_local const bool thread = [] {
    return dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  }();
  (void)process;
  (void)thread;
}

}  // namespace

std::uint64_t ode_messages() { return messages; }

OdeWorld::OdeWorld() {
  initialise();
  world_ = dWorldCreate();
  // Without an implementation of its own, two worlds stepped by two threads abort.
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_),
                                       threading_);
  dWorldSetGravity(world_, 0.0, 0.0, 0.0);
  dWorldSetERP(world_, 0.2);
  dWorldSetCFM(world_, kFrictionSoftness);
  dWorldSetAutoDisableFlag(world_, 0);
  contacts_ = dJointGroupCreate(0);
}

OdeWorld::~OdeWorld() {
  dJointGroupDestroy(contacts_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

void OdeWorld::step(double step_s) {
  dWorldStep(world_, step_s);
  dJointGroupEmpty(contacts_);
}

void set_pose(dBodyID body, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  const dQuaternion raw = {q.w(), q.x(), q.y(), q.z()};
  dBodySetQuaternion(body, raw);
  dBodySetPosition(body, pose.position_m.x(), pose.position_m.y(), pose.position_m.z());
}

Pose pose_of(dBodyID body) {
  const dReal* p = dBodyGetPosition(body);
  const dReal* q = dBodyGetQuaternion(body);
  return {{p[0], p[1], p[2]}, Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

BodyState state_of(dBodyID body) {
  return {pose_of(body), vector_of(dBodyGetLinearVel(body)), vector_of(dBodyGetAngularVel(body))};
}

void set_state(dBodyID body, const BodyState& state) {
  const Vector3& v = state.velocity_mps;
  const Vector3& w = state.omega_radps;
  set_pose(body, state.pose);
  dBodySetLinearVel(body, v.x(), v.y(), v.z());
  dBodySetAngularVel(body, w.x(), w.y(), w.z());
}

}  // namespace tenon::sim
