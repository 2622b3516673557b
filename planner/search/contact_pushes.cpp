#include "planner/search/contact_pushes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/search/free_legs.h"
#include "planner/search/guide_moves.h"
#include "planner/search/placing.h"
#include "planner/search/push_places.h"
#include "planner/search/tilt_offset.h"

namespace tenon::planner {
namespace {

// A sample that collides is drawn again, this often.
constexpr int kAttempts = 20;
// Every order of contacts is tried, so there are not to be too many.
constexpr std::size_t kMaxContactsAnAxis = 8;

/// All of a belief's particles are in contact against a push.
bool on_face(const Belief& belief, const Primitive& push) {
  return std::all_of(belief.particles.begin(), belief.particles.end(), [&](const Particle& p) {
    return p.signature.sign(axis_of(push)) == -sign_of(push);
  });
}

}  // namespace

ContactPushes::ContactPushes(const Task& task, const Belief& start, const Pose& mouth,
                             SuccessorEngine& succ, Rollout& rollout,
                             const std::function<bool()>& stop)
    : task_(task),
      primitives_(long_primitives(task)),
      whole_{start, summarise(start, task), 0},
      mouth_(mouth),
      succ_(succ),
      rollout_(rollout),
      stop_(stop) {}

std::vector<ContactPushes::Pushed> ContactPushes::together(const Belief& belief,
                                                           CoordinateMask but) {
  std::vector<Primitive> pushes = primitives_;
  std::erase_if(pushes, [&](const Primitive& push) { return has(but, axis_of(push)); });
  return together(belief, pushes);
}

void ContactPushes::against_faces(KnownContacts& known) {
  against_faces(whole_, known);
  const CoordinateMask open = without_legs(known);
  if (open != 0) against_faces(settled_but(open), known);
  over_rims(known);
}

/// The part may be met beside a face anywhere along an axis. Where a tilt would put off what it is
/// told there, each side is pushed against once more with the part over one of its two rims along
/// that axis, the nearest to the start that it can get to, the axis being settled. Which of the
/// contacts then serve is left to the order of the guides, where a tilt puts off least first.
void ContactPushes::over_rims(KnownContacts& known) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto& of_axis = known[static_cast<std::size_t>(axis)];
    if (of_axis.empty() || whole_.seed.spread[axis] <= 0.0 || !any_off(known)) continue;
    Spread over = settled_but(task_.coordinates & ~static_cast<CoordinateMask>(1U << axis));
    over.over_rim = axis;
    against_faces(over, known);
  }
}

bool ContactPushes::any_off(const KnownContacts& known) const {
  return std::any_of(known.begin(), known.end(), [](const auto& of_axis) {
    return !of_axis.empty() &&
           std::none_of(of_axis.begin(), of_axis.end(), [](const ContactAttractor& contact) {
             return contact.in_legs && contact.tilt_off_m <= 0.0;
           });
  });
}

void ContactPushes::from_drawn(Random& random, KnownContacts& known) {
  const Belief belief = drawn(random);
  if (!belief.particles.empty()) push_once(belief, primitives_, whole_, known);
}

Belief ContactPushes::about(const Pose& place, const Spread& from) const {
  return planner::spread_about(place, from.start, from.seed.mean, rollout_);
}

/// The start's spread along `open` alone.
ContactPushes::Spread ContactPushes::settled_but(CoordinateMask open) const {
  Spread left{whole_.start, whole_.seed, static_cast<CoordinateMask>(task_.coordinates & ~open)};
  for (Particle& particle : left.start.particles) {
    Vector6 off = displacement_between(whole_.seed.mean, particle.tool());
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(open, axis)) off[axis] = 0.0;
    }
    particle.pose = seen_as(particle.environment, displaced(whole_.seed.mean, off));
  }
  left.seed = summarise(left.start, task_);
  return left;
}

/// Uncertain translations with no contact to which straight legs lead, where another has one.
CoordinateMask ContactPushes::without_legs(const KnownContacts& known) const {
  CoordinateMask with = 0;
  CoordinateMask without = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (whole_.seed.spread[axis] <= 0.0) continue;
    const auto& of_axis = known[static_cast<std::size_t>(axis)];
    const bool any = std::any_of(of_axis.begin(), of_axis.end(),
                                 [](const ContactAttractor& contact) { return contact.in_legs; });
    (any ? with : without) |= static_cast<CoordinateMask>(1U << axis);
  }
  return with == 0 ? CoordinateMask{0} : without;
}

/// Those of the pushes after which the particles stand together along their axis.
std::vector<ContactPushes::Pushed> ContactPushes::together(const Belief& belief,
                                                           const std::vector<Primitive>& pushes) {
  const BeliefSummary from = summarise(belief, task_);
  const auto ends = succ_.successors(belief, pushes);
  std::vector<Pushed> found;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!ends[i]) continue;
    const int axis = axis_of(pushes[i]);
    const BeliefSummary end = summarise(*ends[i], task_);
    if (end.spread[axis] >= task_.attractor_ratio * from.spread[axis]) continue;
    if (out_of_reach(from.mean, end.mean)) continue;
    Pushed pushed{{axis, sign_of(pushes[i]), end.mean, end.spread[axis], end.uncertainty_m2,
                   on_face(*ends[i], pushes[i]), std::nullopt},
                  *ends[i]};
    pushed.contact.tilt_off_m = tilt_offset_m(task_, axis, end.mean, mouth_);
    found.push_back(std::move(pushed));
  }
  return found;
}

/// Along some axis, of a single move.
bool ContactPushes::out_of_reach(const Pose& from, const Pose& to) const {
  if (!task_.guide_moves) return false;
  const Vector6 way = displacement_between(from, to);
  for (int axis = 0; axis < 6; ++axis) {
    if (std::abs(way[axis]) > longest_move(task_, axis)) return true;
  }
  return false;
}

/// The start's spread about a place near what can be touched; empty where no free one was drawn.
Belief ContactPushes::drawn(Random& random) const {
  Eigen::AlignedBox3d box = around(task_.environment);
  const Vector3 reach = around(task_.held).sizes() + Vector3::Constant(task_.step_m);
  box.min() -= reach;
  box.max() += reach;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Pose place = whole_.seed.mean;
    for (int axis = 0; axis < 3; ++axis) {
      if (!has(task_.coordinates, axis)) continue;
      place.position_m[axis] = box.min()[axis] + random.uniform() * box.sizes()[axis];
    }
    if (out_of_reach(whole_.seed.mean, place)) continue;
    Belief belief = about(place, whole_);
    if (!belief.particles.empty()) return belief;
  }
  return {};
}

/// Against each side of each shape, along what is not settled.
void ContactPushes::against_faces(const Spread& from, KnownContacts& known) {
  const Eigen::AlignedBox3d part = around(task_.held);
  const Vector3 start_m = whole_.seed.mean.position_m + part.center();
  for (const Shape& shape : task_.environment) {
    for (const Primitive& push : primitives_) {
      if (stopped()) return;
      const int axis = axis_of(push);
      if (has(from.settled, axis)) continue;
      Vector3 size_m = part.sizes();
      size_m[axis] = 0.0;
      const double enough_m = 0.5 * size_m.norm() + from.seed.spread.head<3>().maxCoeff();
      for (const TouchPlace& side : touch_places(shape, axis, sign_of(push), enough_m, start_m)) {
        const Belief belief = opposite(side, push, part, from);
        if (!belief.particles.empty()) push_once(belief, {push}, from, known);
      }
    }
  }
}

/// The start's spread before a place on a side, with the part's middle or one of its ends over
/// it: the nearest to which a way leads, else the middle. Empty where the part would not fit
/// there.
Belief ContactPushes::opposite(const TouchPlace& side, const Primitive& push,
                               const Eigen::AlignedBox3d& part, const Spread& from) const {
  const PartBefore before{part, from.seed, axis_of(push), sign_of(push), from.over_rim};
  for (const Pose& place : places_before(side, before, task_)) {
    if (out_of_reach(whole_.seed.mean, place) || !legs_lead(from, place)) continue;
    Belief belief = about(place, from);
    if (!belief.particles.empty()) return belief;
  }
  if (from.over_rim >= 0) return {};
  const Pose middle = middle_before(side, before, task_);
  return out_of_reach(whole_.seed.mean, middle) ? Belief{} : about(middle, from);
}

/// From where the plan begins.
bool ContactPushes::legs_lead(const Spread& from, const Pose& to) const {
  return FreeLegs(task_, whole_.seed.mean, rollout_, succ_.reach())
      .to(from.seed, to, whole_.start.arm.get())
      .has_value();
}

/// Adds the contacts that each of these pushes makes.
void ContactPushes::push_once(const Belief& belief, const std::vector<Primitive>& pushes,
                              const Spread& from, KnownContacts& known) {
  const Pose via = summarise(belief, task_).mean;
  const bool in_legs = legs_lead(from, via);
  for (Pushed& pushed : together(belief, pushes)) {
    ContactAttractor& contact = pushed.contact;
    contact.via = via;
    contact.in_legs = in_legs;
    contact.after = from.settled;
    remember(contact, known);
  }
}

void ContactPushes::remember(const ContactAttractor& contact, KnownContacts& known) const {
  auto& of_axis = known[static_cast<std::size_t>(contact.axis)];
  const auto same = find_known(contact, of_axis);
  if (same != of_axis.end()) {
    const auto worth = [](const ContactAttractor& of) { return std::pair(!of.in_legs, of.spread); };
    if (worth(contact) < worth(*same)) *same = contact;
  } else if (of_axis.size() < kMaxContactsAnAxis) {
    of_axis.push_back(contact);
  } else {
    const auto cost = [](const ContactAttractor& of) {
      return std::pair(!of.in_legs, of.tilt_off_m);
    };
    const auto worst = std::max_element(
        of_axis.begin(), of_axis.end(),
        [&](const ContactAttractor& a, const ContactAttractor& b) { return cost(a) < cost(b); });
    if (cost(contact) < cost(*worst)) *worst = contact;
  }
}

std::vector<ContactAttractor>::iterator ContactPushes::find_known(
    const ContactAttractor& contact, std::vector<ContactAttractor>& others) const {
  return std::find_if(others.begin(), others.end(), [&](const ContactAttractor& other) {
    const Vector6 apart = displacement_between(contact.mean, other.mean);
    return other.after == contact.after && std::abs(apart[contact.axis]) < 0.1 * task_.step_m &&
           (!other.via || apart.head<3>().norm() < task_.step_m);
  });
}

}  // namespace tenon::planner
