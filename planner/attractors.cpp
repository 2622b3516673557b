#include "planner/attractors.h"

#include <algorithm>

namespace tenon::planner {
namespace {

constexpr std::size_t kMaxAttractors = 8;

struct Candidate {
  BeliefSummary end;
  double detour_m = 0.0;  // start to attractor to goal
};

class AttractorSearch {
 public:
  AttractorSearch(const Task& task, const Belief& start, SuccessorEngine& succ)
      : task_(task),
        metric_(metric_of(task)),
        primitives_(long_primitives(task)),
        start_(start),
        seed_(summarise(start, task)),
        succ_(succ) {}

  /// Pushes from `belief`, then once more from whatever became more certain.
  void push_from(const Belief& belief, int depth) {
    for (const auto& end : succ_.successors(belief, primitives_)) {
      if (!end) continue;
      const BeliefSummary summary = summarise(*end, task_);
      if (!(summary.uncertainty_m2 < task_.attractor_ratio * seed_.uncertainty_m2)) continue;
      keep(summary);
      if (depth > 1) push_from(*end, depth - 1);
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

  /// Where a certain tool that is drawn out of the goal along a contact loses it: the mouth of a
  /// hole. The tool first presses against each side of the goal.
  [[nodiscard]] std::vector<Pose> mouths() {
    Particle certain = start_.particles.front();
    certain.pose = task_.goal;
    std::vector<Pose> poses;
    for (const auto& pressed : succ_.successors(Belief{{certain}}, primitives_)) {
      if (!pressed || pressed->particles.front().signature.count() == 0) continue;
      const auto ends = succ_.successors(*pressed, primitives_);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const ContactSignature before = pressed->particles.front().signature;
        if (!ends[i] || pushes_along(primitives_[i], before)) continue;
        const Particle& end = ends[i]->particles.front();
        if (end.signature.count() < before.count()) add_apart(end.pose, poses);
      }
    }
    return poses;
  }

  [[nodiscard]] std::vector<Candidate> take() {
    std::stable_sort(found_.begin(), found_.end(), [](const Candidate& a, const Candidate& b) {
      return a.detour_m < b.detour_m;
    });
    if (found_.size() > kMaxAttractors) found_.resize(kMaxAttractors);
    return std::move(found_);
  }

 private:
  void keep(const BeliefSummary& end) {
    for (const Candidate& other : found_) {
      if (distance(other.end.mean, end.mean, metric_) < 0.5 * task_.step_m) return;
    }
    found_.push_back(
        {end, distance(seed_.mean, end.mean, metric_) + distance(end.mean, task_.goal, metric_)});
  }

  /// Into a held contact or straight away from it.
  [[nodiscard]] static bool pushes_along(const Primitive& primitive, ContactSignature signature) {
    for (int axis = 0; axis < 6; ++axis) {
      if (signature.sign(axis) != 0 && primitive.displacement[axis] != 0.0) return true;
    }
    return false;
  }

  void add_apart(const Pose& pose, std::vector<Pose>& poses) const {
    for (const Pose& other : poses) {
      if (distance(other, pose, metric_) < 0.5 * task_.step_m) return;
    }
    poses.push_back(pose);
  }

  const Task& task_;
  Metric metric_;
  std::vector<Primitive> primitives_;
  const Belief& start_;
  BeliefSummary seed_;
  SuccessorEngine& succ_;
  std::vector<Candidate> found_;
};

}  // namespace

std::vector<Attractor> find_attractors(const Task& task, const Belief& start, SuccessorEngine& succ,
                                       Rollout& rollout) {
  AttractorSearch search(task, start, succ);
  search.push_from(start, 2);
  const Belief about_goal = search.spread_about_goal(rollout);
  if (!about_goal.particles.empty()) search.push_from(about_goal, 1);

  std::vector<Attractor> attractors;
  for (const Candidate& candidate : search.take()) {
    attractors.push_back({candidate.end.mean, task.goal});
  }
  if (attractors.empty()) return attractors;
  const Pose nearest = attractors.front().contact;
  for (const Pose& mouth : search.mouths()) attractors.push_back({nearest, mouth});
  return attractors;
}

}  // namespace tenon::planner
