#pragma once
// Contacts in which long pushes bring a belief together: from where it is, from opposite the faces
// of what can be touched, and from drawn places. Offline; one thread.

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/belief/primitives.h"
#include "planner/belief/successor.h"
#include "planner/search/guide.h"
#include "planner/search/touch_places.h"
#include "shared/base/random.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Of each axis the contacts that are known, at most eight: the guides are their orders.
using KnownContacts = std::array<std::vector<ContactAttractor>, 6>;

class ContactPushes {
 public:
  /// @param start, succ, rollout, stop must outlive it; as for find_attractors()
  /// @param mouth of the goal, or the goal: see goal_attractors.h
  ContactPushes(const Task& task, const Belief& start, const Pose& mouth, SuccessorEngine& succ,
                Rollout& rollout, const std::function<bool()>& stop);

  struct Pushed {
    ContactAttractor contact;  ///< with no via
    Belief end;
  };

  /// Of pushes along the task's axes those after which the particles stand together along theirs.
  /// @param but no push along an axis of these
  [[nodiscard]] std::vector<Pushed> together(const Belief& belief, CoordinateMask but);

  /// The start's spread about another place; empty where the part would not fit there.
  [[nodiscard]] Belief spread_about(const Pose& place) const { return about(place, whole_); }

  /// From opposite each side of each shape: with the start's spread, then, for translations to
  /// whose contacts no straight legs lead, with what is left when the others are settled, and from
  /// where a rim is, for those that a tilt puts off on the way to the goal's mouth.
  void against_faces(KnownContacts& known);

  /// From a place drawn near what can be touched.
  void from_drawn(Random& random, KnownContacts& known);

  /// The contact's face, if it is among the others: met from where a step more or less makes no
  /// difference.
  [[nodiscard]] std::vector<ContactAttractor>::iterator find_known(
      const ContactAttractor& contact, std::vector<ContactAttractor>& others) const;

 private:
  /// What a push begins with: the start's spread, or what is left of it.
  struct Spread {
    Belief start;
    BeliefSummary seed;
    CoordinateMask settled = 0;  ///< coordinates that nothing is left of
    int over_rim = -1;           ///< see PartBefore
  };

  [[nodiscard]] Belief about(const Pose& place, const Spread& from) const;
  [[nodiscard]] Spread settled_but(CoordinateMask open) const;
  [[nodiscard]] CoordinateMask without_legs(const KnownContacts& known) const;
  [[nodiscard]] std::vector<Pushed> together(const Belief& belief,
                                             const std::vector<Primitive>& pushes);
  [[nodiscard]] bool any_off(const KnownContacts& known) const;
  void over_rims(KnownContacts& known);
  void against_faces(const Spread& from, KnownContacts& known);
  [[nodiscard]] Belief opposite(const TouchPlace& side, const Primitive& push,
                                const Eigen::AlignedBox3d& part, const Spread& from) const;
  [[nodiscard]] bool legs_lead(const Spread& from, const Pose& to) const;
  [[nodiscard]] Belief drawn(Random& random) const;
  void push_once(const Belief& belief, const std::vector<Primitive>& pushes, const Spread& from,
                 KnownContacts& known);
  void remember(const ContactAttractor& contact, KnownContacts& known) const;
  [[nodiscard]] bool out_of_reach(const Pose& from, const Pose& to) const;
  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

  const Task& task_;
  std::vector<Primitive> primitives_;
  Spread whole_;
  Pose mouth_;
  SuccessorEngine& succ_;
  Rollout& rollout_;
  const std::function<bool()>& stop_;
};

}  // namespace tenon::planner
