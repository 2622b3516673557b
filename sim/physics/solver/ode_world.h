#pragma once
// Owning wrappers around ODE, with the settings that physics in Tenon relies on. Private to sim.
//
// A world belongs to the thread that steps it. ODE itself is initialised once a process and once a
// thread, behind these constructors.

#include <ode/ode.h>

#include <cstdint>
#include <memory>

#include "shared/math/pose.h"

namespace tenon::sim {

/// Messages that ODE's solver gave on this thread so far. A step during which it grows has not
/// solved its constraints: parts may have passed through each other.
[[nodiscard]] std::uint64_t ode_messages();

/// A world without gravity that steps on the calling thread alone: results are the same bits in any
/// process, on any thread.
class OdeWorld {
 public:
  OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;
  ~OdeWorld();

  [[nodiscard]] dWorldID id() const { return world_; }
  [[nodiscard]] dJointGroupID contacts() const { return contacts_; }

  /// One step of dWorldStep; the contact joints of the step are gone afterwards, their feedback
  /// not.
  void step(double step_s);

 private:
  dWorldID world_;
  dThreadingImplementationID threading_;
  dJointGroupID contacts_;
};

/// ODE's own vectors.
[[nodiscard]] inline Vector3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

void set_pose(dBodyID body, const Pose& pose);
[[nodiscard]] Pose pose_of(dBodyID body);

/// Where a body is and how it moves, in the world.
struct BodyState {
  Pose pose;
  Vector3 velocity_mps;
  Vector3 omega_radps;
};
[[nodiscard]] BodyState state_of(dBodyID body);
void set_state(dBodyID body, const BodyState& state);

}  // namespace tenon::sim
