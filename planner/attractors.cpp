#include "planner/attractors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tenon::planner {
namespace {

// Guides take turns, so every further one multiplies the expansions.
constexpr std::size_t kMaxGuides = 2;
// How far beyond w2 times the anchor a guide may begin: not at all.
constexpr double kWithinAnchor = 0.98;

class GuideSearch {
 public:
  GuideSearch(const Task& task, const Belief& start, SuccessorEngine& succ)
      : task_(task),
        primitives_(long_primitives(task)),
        start_(start),
        seed_(summarise(start, task)),
        succ_(succ) {}

  /// Pushes along every axis that has not been pushed along yet, and on from there.
  void push_from(const Belief& belief, const std::vector<ContactAttractor>& before) {
    std::vector<Primitive> pushes = primitives_;
    std::erase_if(pushes, [&](const Primitive& push) { return contains(before, axis_of(push)); });
    const BeliefSummary from = summarise(belief, task_);
    const auto ends = succ_.successors(belief, pushes);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (!ends[i]) continue;
      const int axis = axis_of(pushes[i]);
      const BeliefSummary end = summarise(*ends[i], task_);
      const bool together = end.spread[axis] < task_.attractor_ratio * from.spread[axis];
      if (!together || end.uncertainty_m2 >= from.uncertainty_m2) continue;
      std::vector<ContactAttractor> contacts = before;
      contacts.push_back({axis, end.mean, end.spread[axis], end.uncertainty_m2});
      keep(contacts);
      if (end.uncertainty_m2 > task_.goal_uncertainty_m2) push_from(*ends[i], contacts);
    }
  }

  /// The start's spread about the goal; empty where the part would not fit there.
  [[nodiscard]] Belief spread_about_goal(Rollout& rollout) const {
    Belief belief;
    for (Particle particle : start_.particles) {
      particle.pose = displaced(task_.goal, displacement_between(seed_.mean, particle.pose));
      if (rollout.in_collision(particle.pose)) return {};
      belief.particles.push_back(particle);
    }
    return belief;
  }

  /// The nearest place where a certain tool that is drawn out of the goal along a contact loses it.
  /// The tool first presses against each side of the goal.
  [[nodiscard]] std::optional<Pose> mouth() {
    Particle certain = start_.particles.front();
    certain.pose = task_.goal;
    std::optional<Pose> nearest;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const auto& pressed : succ_.successors(Belief{{certain}}, primitives_)) {
      if (!pressed || pressed->particles.front().signature.count() == 0) continue;
      const ContactSignature before = pressed->particles.front().signature;
      const auto ends = succ_.successors(*pressed, primitives_);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        if (!ends[i] || pushes_along(primitives_[i], before)) continue;
        const Particle& end = ends[i]->particles.front();
        const double away_m = distance(end.pose, task_.goal, metric_of(task_));
        if (end.signature.count() >= before.count() || away_m >= nearest_m) continue;
        nearest = end.pose;
        nearest_m = away_m;
      }
    }
    return nearest;
  }

  /// The cheapest guides, scaled.
  [[nodiscard]] std::vector<Guide> take() {
    const auto cost = [&](const Guide& guide) { return foliated_heuristic(seed_, guide, task_); };
    const auto left_m2 = [](const Guide& guide) { return guide.contacts.back().uncertainty_m2; };
    double enough_m2 = std::numeric_limits<double>::infinity();
    for (const Guide& guide : found_) enough_m2 = std::min(enough_m2, left_m2(guide));
    enough_m2 = std::max(enough_m2, task_.goal_uncertainty_m2);
    std::erase_if(found_, [&](const Guide& guide) { return left_m2(guide) > enough_m2; });
    std::stable_sort(found_.begin(), found_.end(),
                     [&](const Guide& a, const Guide& b) { return cost(a) < cost(b); });
    if (found_.size() > kMaxGuides) found_.resize(kMaxGuides);
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
  /// The step labels count two directions an axis.
  [[nodiscard]] static int axis_of(const Primitive& push) { return push.label / 2; }

  [[nodiscard]] static bool contains(const std::vector<ContactAttractor>& contacts, int axis) {
    return std::any_of(contacts.begin(), contacts.end(),
                       [axis](const ContactAttractor& contact) { return contact.axis == axis; });
  }

  /// Unless the same faces are known in the same order.
  void keep(const std::vector<ContactAttractor>& contacts) {
    const auto same_face = [this](const ContactAttractor& a, const ContactAttractor& b) {
      const double apart = std::abs(displacement_between(a.mean, b.mean)[a.axis]);
      return a.axis == b.axis && apart < 0.5 * (a.axis < 3 ? task_.step_m : task_.step_rad);
    };
    for (const Guide& other : found_) {
      if (std::equal(contacts.begin(), contacts.end(), other.contacts.begin(), other.contacts.end(),
                     same_face)) {
        return;
      }
    }
    found_.push_back({contacts, {task_.goal}, 1.0});
  }

  /// Into a held contact or straight away from it.
  [[nodiscard]] static bool pushes_along(const Primitive& primitive, ContactSignature signature) {
    for (int axis = 0; axis < 6; ++axis) {
      if (signature.sign(axis) != 0 && primitive.displacement[axis] != 0.0) return true;
    }
    return false;
  }

  const Task& task_;
  std::vector<Primitive> primitives_;
  const Belief& start_;
  BeliefSummary seed_;
  SuccessorEngine& succ_;
  std::vector<Guide> found_;
};

}  // namespace

std::vector<Guide> find_guides(const Task& task, const Belief& start, SuccessorEngine& succ,
                               Rollout& rollout) {
  GuideSearch search(task, start, succ);
  search.push_from(start, {});
  const Belief about_goal = search.spread_about_goal(rollout);
  if (!about_goal.particles.empty()) search.push_from(about_goal, {});

  std::vector<Guide> guides = search.take();
  if (guides.empty()) return guides;
  if (const std::optional<Pose> mouth = search.mouth()) {
    Guide through = guides.front();
    through.goals.insert(through.goals.begin(), *mouth);
    guides.push_back(std::move(through));
  }
  return guides;
}

}  // namespace tenon::planner
