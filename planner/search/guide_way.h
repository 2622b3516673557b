#pragma once
// A guide followed to the letter: through free space to where a push begins, the push, and on to
// the next; then over the goal and in. No search: what a person would do who knew the guide. One
// thread at a time.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/belief/successor.h"
#include "planner/search/guide.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct GuideWay {
  std::vector<Vector6> moves;      ///< each value as a plan holds it
  std::vector<std::size_t> plain;  ///< those of them that are plain touches, see Primitive
};

/// The moves that bring a belief to the goal by way of a guide's contacts; empty where one of them
/// fails, or all of them do not lead there. Contacts that were met while another coordinate was
/// still uncertain are met once more where that takes it.
/// @param clear a pose known to be free, above or beside everything
/// @param rollout asked for collisions only
/// @param left where not null: set to where the guide could not be followed on, and why
[[nodiscard]] std::optional<GuideWay> follow_guide(const Guide& guide, const Task& task,
                                                   const Belief& start, const Pose& clear,
                                                   SuccessorEngine& succ, Rollout& rollout,
                                                   std::string* left = nullptr);

/// Whether a belief gets to each of a guide's touches in turn, wherever that leads to.
[[nodiscard]] bool can_touch(const Guide& guide, const Task& task, const Belief& start,
                             const Pose& clear, SuccessorEngine& succ, Rollout& rollout);

}  // namespace tenon::planner
