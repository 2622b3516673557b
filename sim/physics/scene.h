#pragma once
// The held part among its environment: which of their shapes touch, and the forces between them.
// Surfaces, contact points and solver each have a folder of their own; the scene puts them in
// order. Private to sim; one thread.

#include <ode/ode.h>

#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/task/task.h"
#include "sim/physics/contacts/contact_law.h"
#include "sim/physics/contacts/surface_contact.h"
#include "sim/physics/contacts/touching_points.h"
#include "sim/physics/solver/contact_joints.h"
#include "sim/physics/solver/ode_world.h"
#include "sim/physics/surfaces/shape_geometry.h"

namespace tenon::sim {

/// Contact geometry of the held part against the environment. Pairs are collided in a fixed order,
/// so that the solver sees the same constraints in the same order whatever happened before.
class Scene {
 public:
  /// @param X_WT where the environment's task frame stands in the world
  Scene(const std::vector<Shape>& held, const std::vector<Shape>& environment,
        const Pose& X_WT = {}, MeshDistances distances = MeshDistances::kExact);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Hangs the held shapes on a body. @param X_BP the tool frame in the body's frame
  void attach(dBodyID body, const Pose& X_BP = {});

  /// Where the environment's task frame stands in the world.
  void place_environment(const Pose& X_WT);
  /// Every size of the held part as drawn and this much more.
  void set_oversize(double oversize_m);

  struct Contacts {
    std::size_t points = 0;
    double depth_max_m = 0.0;
  };
  /// Finds where the shapes touch, looking only at those that may have come near since they were
  /// last seen apart. @param turns whether the held part can rotate
  Contacts find_contacts(bool turns);
  /// Makes the joints of the contacts that were found. Call before OdeWorld::step().
  void make_joints(OdeWorld& world, double step_s, const ContactLaw& law);
  /// Whether any shape is a solid.
  [[nodiscard]] bool has_solids() const { return solids_; }
  /// The contact points that were found.
  [[nodiscard]] const std::vector<dContactGeom>& points() const { return points_; }

  /// A distance that the held part may still move, in any way, before any two shapes can touch, m.
  /// 0 where that has to be looked at.
  [[nodiscard]] double clearance_m() const { return clear_until_m_ - moved_m_; }
  /// No point of the held part has moved farther than this since it was last told.
  void moved(double at_most_m) { moved_m_ += at_most_m; }
  /// It may be anywhere now, and touches nothing that is known of.
  void moved_anywhere();
  /// The same where what it is attached to has been put somewhere: from there it is found out how
  /// far that is, and what is known of surfaces near by goes on to hold.
  void placed();
  /// No point of the held part is farther than this from its body's origin.
  [[nodiscard]] double reach_m() const;

  /// After the step: force and torque of the environment on the attached body, world axes, about
  /// the body's origin.
  [[nodiscard]] Vector6 wrench() const { return joints_.wrench(); }

  /// Deepest overlap at the body's present pose, m; 0 where nothing touches.
  /// @param enough_m no matter how much deeper than this
  [[nodiscard]] double overlap_m(double enough_m = std::numeric_limits<double>::infinity());

  /// Indices of two shapes that touch.
  struct Pair {
    std::size_t held = 0;
    std::size_t environment = 0;
  };
  /// Of the last contacts, each pair once.
  [[nodiscard]] const std::vector<Pair>& pairs() const { return touching_; }
  /// "held-environment"
  [[nodiscard]] std::string name(const Pair& pair) const;
  /// The names of all pairs.
  [[nodiscard]] std::vector<std::string> touching() const;

 private:
  std::deque<ShapeGeometry> held_;
  std::deque<ShapeGeometry> environment_;
  Pose X_WT_;
  struct Watched {
    Pair pair;
    double apart_until_m = 0.0;                ///< on the way that the held part has moved
    bool met = false;                          ///< when last looked at, on this move
    std::unique_ptr<SurfaceContact> surfaces;  ///< where one of the two is a solid
  };
  void forget_meetings();
  /// Looks how far the body has come from where it was last looked at.
  void look_where();
  /// Of the held part; its own where it hangs on none.
  [[nodiscard]] Pose body_pose() const;
  /// Adds the points of two shapes that are near. @return whether there are any
  bool touch(Watched& watched, bool turns, PairPoints& buffer);
  /// How the surfaces of two shapes stand to each other.
  [[nodiscard]] SurfaceContact::Stand stand(const Pair& pair) const;
  /// The same from their surfaces. @param points to which those that touch are added
  /// @return a gap, m, as SurfaceContact::find()
  double touch_surfaces(const Watched& watched, std::vector<dContactGeom>& points,
                        double enough_m = std::numeric_limits<double>::infinity()) const;

  std::vector<Watched> watched_;  // all pairs
  bool solids_ = false;           // among the shapes
  double moved_m_ = 0.0;
  Pose seen_;            ///< where the held part's body was last looked at
  double seen_m_ = 0.0;  ///< the way until then
  double clear_until_m_ = 0.0;
  double oversize_m_ = 0.0;
  std::vector<dContactGeom> points_;  // of the last contacts, thinned out
  ContactJoints joints_;
  std::vector<Pair> touching_;
};

}  // namespace tenon::sim
