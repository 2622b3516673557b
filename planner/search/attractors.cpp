#include "planner/search/attractors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "planner/search/free_legs.h"
#include "planner/search/goal_attractors.h"
#include "planner/search/guide_moves.h"
#include "planner/search/push_places.h"
#include "planner/search/touch_places.h"
#include "shared/base/random.h"

namespace tenon::planner {
namespace {

// Guides take turns, so every further one multiplies the expansions.
constexpr std::size_t kMaxGuides = 2;
// How far beyond w2 times the anchor a guide may begin: not at all.
constexpr double kWithinAnchor = 0.98;
// A sample that collides is drawn again, this often.
constexpr int kAttempts = 20;
// Every order of contacts is tried, so there are not to be too many.
constexpr std::size_t kMaxContactsAnAxis = 8;
constexpr std::uint64_t kSampleSeed = 1;

/// Corners of a box, along the task's axes, around everything that can be touched.
Eigen::AlignedBox3d around(const std::vector<Shape>& shapes) {
  Eigen::AlignedBox3d box;
  for (const Shape& shape : shapes) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                         (corner & 4) != 0 ? 0.5 : -0.5);
      box.extend(shape.pose.position_m +
                 shape.pose.orientation * shape.size_m.cwiseProduct(sign).eval());
    }
  }
  return box;
}

/// All of a belief's particles are in contact against a push.
bool on_face(const Belief& belief, const Primitive& push) {
  return std::all_of(belief.particles.begin(), belief.particles.end(), [&](const Particle& p) {
    return p.signature.sign(axis_of(push)) == -sign_of(push);
  });
}

class GuideSearch {
 public:
  GuideSearch(const Task& task, const Belief& start, SuccessorEngine& succ,
              const std::function<bool()>& stop)
      : task_(task),
        primitives_(long_primitives(task)),
        start_(start),
        seed_(summarise(start, task)),
        succ_(succ),
        stop_(stop) {}

  /// Pushes along every axis that has not been pushed along yet, and on from there.
  void push_from(const Belief& belief, const std::vector<ContactAttractor>& before) {
    if (stopped()) return;
    std::vector<Primitive> pushes = primitives_;
    std::erase_if(pushes, [&](const Primitive& push) { return contains(before, axis_of(push)); });
    const double before_m2 = summarise(belief, task_).uncertainty_m2;
    for (const Pushed& pushed : push_together(belief, pushes)) {
      if (pushed.contact.uncertainty_m2 >= before_m2) continue;
      std::vector<ContactAttractor> contacts = before;
      contacts.push_back(pushed.contact);
      keep(contacts);
      if (pushed.contact.uncertainty_m2 > task_.goal_uncertainty_m2)
        push_from(pushed.end, contacts);
    }
  }

  /// Whether the guides found so far lead to the goal's certainty.
  [[nodiscard]] bool certain() const {
    return std::any_of(found_.begin(), found_.end(), [this](const Guide& guide) {
      return guide.contacts.back().uncertainty_m2 <= task_.goal_uncertainty_m2;
    });
  }

  /// The start's spread about another place; empty where the part would not fit there.
  [[nodiscard]] Belief spread_about(const Pose& place, Rollout& rollout) const {
    Belief belief;
    for (Particle particle : start_.particles) {
      const Pose tool = displaced(place, displacement_between(seed_.mean, particle.tool()));
      if (rollout.in_collision(tool)) return {};
      particle.pose = seen_as(particle.environment, tool);
      belief.particles.push_back(particle);
    }
    return belief;
  }

  /// Pushes from opposite every face that stands across an axis, and from drawn places, with the
  /// start's spread, then guides that go from one of the contacts to the next: for parts that a
  /// push from the start does not meet.
  void look_around(Rollout& rollout) {
    std::array<std::vector<ContactAttractor>, 6> known;
    for (const Guide& guide : found_) {
      const ContactAttractor& contact = guide.contacts.front();
      auto& of_axis = known[static_cast<std::size_t>(contact.axis)];
      if (find_known(contact, of_axis) == of_axis.end()) of_axis.push_back(contact);
    }
    if (task_.guide_moves) {
      push_against_faces(rollout, known);
      combine(known, seed_.uncertainty_m2, {});
      if (certain()) return;
    }
    Random random(kSampleSeed);
    for (std::size_t i = 0; i < task_.attractor_samples && !stopped(); ++i) {
      const Belief belief = drawn(random, rollout);
      if (!belief.particles.empty()) push_once(belief, primitives_, known, rollout);
    }
    combine(known, seed_.uncertainty_m2, {});
  }

  /// See Attractors::unsettled; before take().
  [[nodiscard]] CoordinateMask unsettled() const {
    CoordinateMask mask = 0;
    for (int axis = 0; axis < 6; ++axis) {
      const bool known = std::any_of(found_.begin(), found_.end(), [axis](const Guide& guide) {
        return contains(guide.contacts, axis);
      });
      if (seed_.spread[axis] > 0.0 && !known) mask |= static_cast<CoordinateMask>(1U << axis);
    }
    return mask;
  }

  /// Those that leave no more than the goal's uncertainty, or as little as any; the cheapest first.
  void sort() {
    const auto cost = [&](const Guide& guide) { return foliated_heuristic(seed_, guide, task_); };
    const auto left_m2 = [](const Guide& guide) { return guide.contacts.back().uncertainty_m2; };
    double enough_m2 = std::numeric_limits<double>::infinity();
    for (const Guide& guide : found_) enough_m2 = std::min(enough_m2, left_m2(guide));
    enough_m2 = std::max(enough_m2, task_.goal_uncertainty_m2);
    std::erase_if(found_, [&](const Guide& guide) { return left_m2(guide) > enough_m2; });
    std::stable_sort(found_.begin(), found_.end(), [&](const Guide& a, const Guide& b) {
      return std::tuple(far(a), edges(a), cost(a)) < std::tuple(far(b), edges(b), cost(b));
    });
    if (found_.size() > kCandidatesMax) found_.resize(kCandidatesMax);
  }
  [[nodiscard]] const std::vector<Guide>& found() const { return found_; }

  /// The cheapest of the sorted guides, scaled.
  [[nodiscard]] std::vector<Guide> take() {
    if (found_.size() > kMaxGuides) found_.resize(kMaxGuides);
    const auto cost = [&](const Guide& guide) { return foliated_heuristic(seed_, guide, task_); };
    const double allowed = kWithinAnchor * task_.w2 * anchor_heuristic(seed_, task_);
    for (Guide& guide : found_) {
      const double whole = cost(guide);
      guide.contact_scale = 0.0;
      const double way = cost(guide);
      guide.contact_scale = std::clamp((allowed - way) / (whole - way), 0.0, 1.0);
    }
    return std::move(found_);
  }

 private:
  struct Pushed {
    ContactAttractor contact;  ///< with no via
    Belief end;
  };

  /// Those of the pushes after which the particles stand together along their axis.
  [[nodiscard]] std::vector<Pushed> push_together(const Belief& belief,
                                                  const std::vector<Primitive>& pushes) {
    const BeliefSummary from = summarise(belief, task_);
    const auto ends = succ_.successors(belief, pushes);
    std::vector<Pushed> together;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (!ends[i]) continue;
      const int axis = axis_of(pushes[i]);
      const BeliefSummary end = summarise(*ends[i], task_);
      if (end.spread[axis] >= task_.attractor_ratio * from.spread[axis]) continue;
      if (out_of_reach(from.mean, end.mean)) continue;
      together.push_back({{axis, sign_of(pushes[i]), end.mean, end.spread[axis], end.uncertainty_m2,
                           on_face(*ends[i], pushes[i]), std::nullopt},
                          *ends[i]});
    }
    return together;
  }

  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

  /// How many of a guide's contacts are edges, which hold less well than faces. The lattice alone
  /// has no moves to choose by that.
  [[nodiscard]] std::ptrdiff_t edges(const Guide& guide) const {
    if (!task_.guide_moves) return 0;
    return std::count_if(guide.contacts.begin(), guide.contacts.end(),
                         [](const ContactAttractor& contact) { return !contact.face; });
  }

  /// How many of a guide's contacts no straight legs lead to from the start.
  [[nodiscard]] static std::ptrdiff_t far(const Guide& guide) {
    return std::count_if(guide.contacts.begin(), guide.contacts.end(),
                         [](const ContactAttractor& contact) { return !contact.in_legs; });
  }

  /// Along some axis, of a single move.
  [[nodiscard]] bool out_of_reach(const Pose& from, const Pose& to) const {
    if (!task_.guide_moves) return false;
    const Vector6 way = displacement_between(from, to);
    for (int axis = 0; axis < 6; ++axis) {
      if (std::abs(way[axis]) > longest_move(task_, axis)) return true;
    }
    return false;
  }

  [[nodiscard]] static bool contains(const std::vector<ContactAttractor>& contacts, int axis) {
    return std::any_of(contacts.begin(), contacts.end(),
                       [axis](const ContactAttractor& contact) { return contact.axis == axis; });
  }

  /// Unless the same faces are known in the same order.
  void keep(const std::vector<ContactAttractor>& contacts) {
    const auto same_face = [this](const ContactAttractor& a, const ContactAttractor& b) {
      const double apart = std::abs(displacement_between(a.mean, b.mean)[a.axis]);
      return a.axis == b.axis && apart < 0.5 * (a.axis < 3 ? task_.step_m : task_.step_rad) &&
             a.via.has_value() == b.via.has_value();
    };
    for (const Guide& other : found_) {
      if (std::equal(contacts.begin(), contacts.end(), other.contacts.begin(), other.contacts.end(),
                     same_face)) {
        return;
      }
    }
    found_.push_back({contacts, {task_.goal}, 1.0});
  }

  /// The start's spread about a place near what can be touched; empty where no free one was drawn.
  [[nodiscard]] Belief drawn(Random& random, Rollout& rollout) const {
    Eigen::AlignedBox3d box = around(task_.environment);
    const Vector3 reach = around(task_.held).sizes() + Vector3::Constant(task_.step_m);
    box.min() -= reach;
    box.max() += reach;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      Pose place = seed_.mean;
      for (int axis = 0; axis < 3; ++axis) {
        if (!has(task_.coordinates, axis)) continue;
        place.position_m[axis] = box.min()[axis] + random.uniform() * box.sizes()[axis];
      }
      if (out_of_reach(seed_.mean, place)) continue;
      Belief belief = spread_about(place, rollout);
      if (!belief.particles.empty()) return belief;
    }
    return {};
  }

  /// Against each side of each shape, with the middle of the part.
  void push_against_faces(Rollout& rollout, std::array<std::vector<ContactAttractor>, 6>& known) {
    const Eigen::AlignedBox3d part = around(task_.held);
    const Vector3 start_m = seed_.mean.position_m + part.center();
    for (const Shape& shape : task_.environment) {
      for (const Primitive& push : primitives_) {
        if (stopped()) return;
        const int axis = axis_of(push);
        Vector3 size_m = part.sizes();
        size_m[axis] = 0.0;
        const double enough_m = 0.5 * size_m.norm() + seed_.spread.head<3>().maxCoeff();
        for (const TouchPlace& side : touch_places(shape, axis, sign_of(push), enough_m, start_m)) {
          const Belief belief = opposite(side, push, part, rollout);
          if (!belief.particles.empty()) push_once(belief, {push}, known, rollout);
        }
      }
    }
  }

  /// The start's spread before a place on a side, with the part's middle or one of its ends over
  /// it: the nearest to which a way leads, else the middle. Empty where the part would not fit
  /// there.
  [[nodiscard]] Belief opposite(const TouchPlace& side, const Primitive& push,
                                const Eigen::AlignedBox3d& part, Rollout& rollout) const {
    FreeLegs legs(task_, seed_.mean, rollout);
    const PartBefore before{part, seed_, axis_of(push), sign_of(push)};
    for (const Pose& place : places_before(side, before, task_)) {
      if (out_of_reach(seed_.mean, place) || !legs.to(seed_, place)) continue;
      Belief belief = spread_about(place, rollout);
      if (!belief.particles.empty()) return belief;
    }
    const Pose middle = middle_before(side, before, task_);
    return out_of_reach(seed_.mean, middle) ? Belief{} : spread_about(middle, rollout);
  }

  /// Adds the contacts that each of these pushes makes.
  void push_once(const Belief& belief, const std::vector<Primitive>& pushes,
                 std::array<std::vector<ContactAttractor>, 6>& known, Rollout& rollout) {
    const Pose via = summarise(belief, task_).mean;
    const bool in_legs = FreeLegs(task_, seed_.mean, rollout).to(seed_, via).has_value();
    for (Pushed& pushed : push_together(belief, pushes)) {
      ContactAttractor& contact = pushed.contact;
      contact.via = via;
      contact.in_legs = in_legs;
      auto& of_axis = known[static_cast<std::size_t>(contact.axis)];
      const auto same = find_known(contact, of_axis);
      if (same != of_axis.end()) {
        const auto worth = [](const ContactAttractor& of) {
          return std::pair(!of.in_legs, of.spread);
        };
        if (worth(contact) < worth(*same)) *same = contact;
      } else if (of_axis.size() < kMaxContactsAnAxis) {
        of_axis.push_back(contact);
      }
    }
  }

  /// The same face, met from where a step more or less makes no difference.
  [[nodiscard]] std::vector<ContactAttractor>::iterator find_known(
      const ContactAttractor& contact, std::vector<ContactAttractor>& others) const {
    return std::find_if(others.begin(), others.end(), [&](const ContactAttractor& other) {
      const Vector6 apart = displacement_between(contact.mean, other.mean);
      return std::abs(apart[contact.axis]) < 0.1 * task_.step_m &&
             (!other.via || apart.head<3>().norm() < task_.step_m);
    });
  }

  /// Every order of one contact for every axis that is uncertain.
  void combine(const std::array<std::vector<ContactAttractor>, 6>& known, double uncertainty_m2,
               const std::vector<ContactAttractor>& before) {
    bool last = true;
    for (int axis = 0; axis < 6; ++axis) {
      if (seed_.spread[axis] <= 0.0 || contains(before, axis)) continue;
      for (ContactAttractor contact : known[static_cast<std::size_t>(axis)]) {
        const double left_m2 = weight_of(axis) * contact.spread * contact.spread;
        contact.uncertainty_m2 = std::max(0.0, uncertainty_m2 - share_of(axis)) + left_m2;
        std::vector<ContactAttractor> contacts = before;
        contacts.push_back(contact);
        combine(known, contact.uncertainty_m2, contacts);
        last = false;
      }
    }
    if (last && !before.empty()) keep(before);
  }

  /// What an axis contributes to the start's uncertainty, m^2.
  [[nodiscard]] double share_of(int axis) const {
    double sum = 0.0;
    for (const Particle& particle : start_.particles) {
      const double off = displacement_between(seed_.mean, particle.tool())[axis];
      sum += off * off;
    }
    return weight_of(axis) * sum / static_cast<double>(start_.particles.size());
  }

  [[nodiscard]] double weight_of(int axis) const {
    return axis < 3 ? 1.0 : task_.orientation_weight;
  }

  const Task& task_;
  std::vector<Primitive> primitives_;
  const Belief& start_;
  BeliefSummary seed_;
  SuccessorEngine& succ_;
  const std::function<bool()>& stop_;
  std::vector<Guide> found_;
};

}  // namespace

Attractors find_attractors(const Task& task, const Belief& start, SuccessorEngine& succ,
                           Rollout& rollout, const std::function<bool()>& stop) {
  GuideSearch search(task, start, succ, stop);
  search.push_from(start, {});
  const Belief about_goal = search.spread_about(task.goal, rollout);
  if (!about_goal.particles.empty()) search.push_from(about_goal, {});
  if (!search.certain()) search.look_around(rollout);

  const CoordinateMask unsettled = search.unsettled();
  search.sort();
  std::vector<Guide> candidates = search.found();
  Attractors found{search.take(), std::move(candidates), goal_attractors(task, start, succ),
                   unsettled};
  if (found.goals.size() > 1 && !found.guides.empty()) {
    Guide through = found.guides.front();
    through.goals.insert(through.goals.begin(), found.goals.back());
    found.guides.push_back(std::move(through));
  }
  return found;
}

}  // namespace tenon::planner
