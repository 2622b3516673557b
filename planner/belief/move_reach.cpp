#include "planner/belief/move_reach.h"

#include <algorithm>

#include "shared/base/text.h"

namespace tenon::planner {

std::shared_ptr<const ArmPlace> MoveReach::place_of(const Belief& belief) {
  if (belief.arm) return belief.arm;
  std::string why;
  auto place = start_->elsewhere(mean_pose(belief), why);
  if (!place) note(why, false);
  return place;
}

std::shared_ptr<const ArmPlace> MoveReach::after(const ArmPlace& from, const Vector6& displacement,
                                                 ContactSignature contacts, const Travel& travel,
                                                 bool touches) {
  std::string why;
  auto place = from.after(step_of(displacement, travel), contacts, why);
  if (!place) note(why, touches);
  return place;
}

/// Draws lie as much farther out as their errors; but none goes farther than it is told to.
Step MoveReach::step_of(const Vector6& displacement, const Travel& travel) const {
  Step step;
  step.displacement = displacement;
  OutcomeRule& rule = step.outcomes[static_cast<std::size_t>(Outcome::kReached)];
  rule.successor = kSuccessorDone;
  rule.envelope.possible = kAllContacts;
  for (int axis = 0; axis < 6; ++axis) {
    const double least = travel.way.least[axis];
    const double most = travel.way.most[axis];
    const double beyond = 0.5 * (parameters_.draws_over_particles - 1.0);
    const double further = beyond * (most - least);
    double low = least - further;
    double high = most + further;
    const double told = displacement[axis];
    if (told != 0.0) {
      low = std::max(low, std::min({least, told, 0.0}));
      high = std::min(high, std::max({most, told, 0.0}));
    }
    rule.envelope.travelled_min[axis] = low - parameters_.margins[axis];
    rule.envelope.travelled_max[axis] = high + parameters_.margins[axis];
    if (parameters_.margins[axis] == 0.0) continue;  // off the coordinates, where no place is told
    const Range& place = travel.place;
    const double room = beyond * (place.most[axis] - place.least[axis]) + parameters_.margins[axis];
    rule.envelope.place_min[axis] = place.least[axis] - room;
    rule.envelope.place_max[axis] = place.most[axis] + room;
  }
  return step;
}

void MoveReach::note(const std::string& why, bool touches) {
  ++refused_;
  if (!first_.empty() && (first_touches_ || !touches)) return;
  first_ = why;
  first_touches_ = touches;
}

std::string MoveReach::refused_text() const {
  if (refused_ == 0) return {};
  return format("%llu moves are out of the arm's reach, the first%s: ",
                static_cast<unsigned long long>(refused_),
                first_touches_ ? " that would touch" : "") +
         first_;
}

}  // namespace tenon::planner
