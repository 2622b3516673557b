#include "planner/search/attractors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "planner/search/contact_pushes.h"
#include "planner/search/goal_attractors.h"
#include "shared/base/random.h"

namespace tenon::planner {
namespace {

// Guides take turns, so every further one multiplies the expansions.
constexpr std::size_t kMaxGuides = 2;
// How far beyond w2 times the anchor a guide may begin: not at all.
constexpr double kWithinAnchor = 0.98;
constexpr std::uint64_t kSampleSeed = 1;

class GuideSearch {
 public:
  GuideSearch(const Task& task, const Belief& start, ContactPushes& pushes,
              const std::function<bool()>& stop)
      : task_(task), start_(start), seed_(summarise(start, task)), pushes_(pushes), stop_(stop) {}

  /// Pushes along every axis that has not been pushed along yet, and on from there.
  void push_from(const Belief& belief, const std::vector<ContactAttractor>& before) {
    if (stopped()) return;
    CoordinateMask made = 0;
    for (const ContactAttractor& contact : before) {
      made |= static_cast<CoordinateMask>(1U << contact.axis);
    }
    const double before_m2 = summarise(belief, task_).uncertainty_m2;
    for (const ContactPushes::Pushed& pushed : pushes_.together(belief, made)) {
      if (pushed.contact.uncertainty_m2 >= before_m2) continue;
      std::vector<ContactAttractor> contacts = before;
      contacts.push_back(pushed.contact);
      keep(contacts);
      if (pushed.contact.uncertainty_m2 > task_.goal_uncertainty_m2)
        push_from(pushed.end, contacts);
    }
  }

  /// Whether the guides found so far lead to the goal's certainty.
  [[nodiscard]] bool certain() const { return certain_of(found_); }
  [[nodiscard]] bool certain_of(const std::vector<Guide>& guides) const {
    return std::any_of(guides.begin(), guides.end(), [this](const Guide& guide) {
      return guide.contacts.back().uncertainty_m2 <= task_.goal_uncertainty_m2;
    });
  }

  /// And no tilt puts off what they touch.
  [[nodiscard]] bool holds() const {
    return std::any_of(found_.begin(), found_.end(), [this](const Guide& guide) {
      return left_m2(guide) <= task_.goal_uncertainty_m2 && tilt_off_m(guide) <= 0.0;
    });
  }

  /// Pushes from opposite every face that stands across an axis, and from drawn places, with the
  /// start's spread, then guides that go from one of the contacts to the next: for parts that a
  /// push from the start does not meet.
  void look_around() {
    KnownContacts known;
    for (const Guide& guide : found_) {
      const ContactAttractor& contact = guide.contacts.front();
      auto& of_axis = known[static_cast<std::size_t>(contact.axis)];
      if (pushes_.find_known(contact, of_axis) == of_axis.end()) of_axis.push_back(contact);
    }
    if (task_.guide_moves) {
      pushes_.against_faces(known);
      combine(known, seed_.uncertainty_m2, {});
      if (certain()) return;
    }
    Random random(kSampleSeed);
    for (std::size_t i = 0; i < task_.attractor_samples && !stopped(); ++i) {
      pushes_.from_drawn(random, known);
    }
    combine(known, seed_.uncertainty_m2, {});
  }

  /// Whether guides have to settle rotations, and their moves are not the task's own.
  [[nodiscard]] bool turned() const {
    return task_.guide_moves && seed_.spread.tail<3>().maxCoeff() > 0.0;
  }

  /// In place of those that were found.
  void take_over(std::vector<Guide> guides) { found_ = std::move(guides); }

  /// See Attractors::unsettled; before take().
  [[nodiscard]] CoordinateMask unsettled() const {
    CoordinateMask mask = 0;
    for (int axis = 0; axis < 6; ++axis) {
      const bool known = std::any_of(found_.begin(), found_.end(), [axis](const Guide& guide) {
        return contains(guide.contacts, axis);
      });
      if (is_open(axis) && !known) mask |= static_cast<CoordinateMask>(1U << axis);
    }
    return mask;
  }

  /// Those to whose contacts straight legs lead, then those that leave no more than the goal's
  /// uncertainty, or as little as any, then those that a tilt puts off least, then the cheapest.
  /// Who makes the contacts one after the other, and again, may know more in the end than was left
  /// after each.
  void sort() {
    const double enough_m2 = least_left_m2();
    const auto key = [&](const Guide& guide) {
      return std::tuple(far(guide), left_m2(guide) > enough_m2, edges(guide), tilt_off_m(guide),
                        foliated_heuristic(seed_, guide, task_));
    };
    std::stable_sort(found_.begin(), found_.end(),
                     [&](const Guide& a, const Guide& b) { return key(a) < key(b); });
  }
  [[nodiscard]] std::vector<Guide> candidates() const {
    std::vector<Guide> first = found_;
    if (first.size() > kCandidatesMax) first.resize(kCandidatesMax);
    return first;
  }

  /// The first of those that leave no more than that, scaled.
  [[nodiscard]] std::vector<Guide> take() {
    const double enough_m2 = least_left_m2();
    std::erase_if(found_, [&](const Guide& guide) { return left_m2(guide) > enough_m2; });
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
  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

  [[nodiscard]] static double left_m2(const Guide& guide) {
    return guide.contacts.back().uncertainty_m2;
  }

  /// The goal's uncertainty, or the least that any guide leaves.
  [[nodiscard]] double least_left_m2() const {
    double least_m2 = std::numeric_limits<double>::infinity();
    for (const Guide& guide : found_) least_m2 = std::min(least_m2, left_m2(guide));
    return std::max(least_m2, task_.goal_uncertainty_m2);
  }

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

  /// What a tilt makes of a guide's contacts.
  [[nodiscard]] static double tilt_off_m(const Guide& guide) {
    double sum_m = 0.0;
    for (const ContactAttractor& contact : guide.contacts) sum_m += contact.tilt_off_m;
    return sum_m;
  }

  [[nodiscard]] static bool contains(const std::vector<ContactAttractor>& contacts, int axis) {
    return std::any_of(contacts.begin(), contacts.end(), [axis](const ContactAttractor& contact) {
      return contact.axis == axis || has(contact.flat, axis);
    });
  }

  /// Unless the same faces are known in the same order, from where straight legs lead.
  void keep(const std::vector<ContactAttractor>& contacts) {
    const auto same_face = [this](const ContactAttractor& a, const ContactAttractor& b) {
      const double apart = std::abs(displacement_between(a.mean, b.mean)[a.axis]);
      return a.axis == b.axis && apart < 0.5 * (a.axis < 3 ? task_.step_m : task_.step_rad) &&
             a.via.has_value() == b.via.has_value();
    };
    const Guide guide{contacts, {task_.goal}, 1.0};
    for (Guide& other : found_) {
      if (!std::equal(contacts.begin(), contacts.end(), other.contacts.begin(),
                      other.contacts.end(), same_face)) {
        continue;
      }
      const auto cost = [](const Guide& of) { return std::pair(far(of), tilt_off_m(of)); };
      if (cost(guide) < cost(other)) other = guide;
      return;
    }
    found_.push_back(guide);
  }

  /// Every order of one contact for every axis that is uncertain.
  void combine(const KnownContacts& known, double uncertainty_m2,
               const std::vector<ContactAttractor>& before) {
    bool last = true;
    for (int axis = 0; axis < 6; ++axis) {
      if (!is_open(axis) || contains(before, axis)) continue;
      for (ContactAttractor contact : known[static_cast<std::size_t>(axis)]) {
        if (!all_settled(contact.after, before)) continue;
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

  [[nodiscard]] bool all_settled(CoordinateMask axes,
                                 const std::vector<ContactAttractor>& by) const {
    for (int axis = 0; axis < 6; ++axis) {
      if (has(axes, axis) && is_open(axis) && !contains(by, axis)) return false;
    }
    return true;
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

  [[nodiscard]] double weight_of(int axis) const { return metric_of(task_).variance_weight(axis); }

  /// Uncertain, and not free at the goal.
  [[nodiscard]] bool is_open(int axis) const {
    return seed_.spread[axis] > 0.0 && !has(task_.goal_axes.free, axis);
  }

  const Task& task_;
  const Belief& start_;
  BeliefSummary seed_;
  ContactPushes& pushes_;
  const std::function<bool()>& stop_;
  std::vector<Guide> found_;
};

}  // namespace

Attractors find_attractors(const Task& task, const Belief& start, SuccessorEngine& succ,
                           Rollout& rollout, const std::function<bool()>& stop,
                           const std::function<std::vector<Guide>()>& in_turn) {
  std::vector<Pose> goals = goal_attractors(task, start, succ);
  ContactPushes pushes(task, start, goals.back(), succ, rollout, stop);
  GuideSearch search(task, start, pushes, stop);
  search.push_from(start, {});
  const Belief about_goal = pushes.spread_about(task.goal);
  if (!about_goal.particles.empty()) search.push_from(about_goal, {});
  std::vector<Guide> turns;
  if (!search.holds()) {
    if (in_turn && search.turned()) turns = in_turn();
    if (!search.certain_of(turns)) search.look_around();
  }
  if (search.certain_of(turns)) {
    search.take_over(turns);
  } else {
    search.sort();
  }

  const CoordinateMask unsettled = search.unsettled();
  std::vector<Guide> candidates = search.candidates();
  Attractors found{search.take(), std::move(candidates), std::move(goals), unsettled,
                   std::move(turns)};
  if (found.goals.size() > 1 && !found.guides.empty()) {
    Guide through = found.guides.front();
    through.goals.insert(through.goals.begin(), found.goals.back());
    found.guides.push_back(std::move(through));
  }
  return found;
}

}  // namespace tenon::planner
