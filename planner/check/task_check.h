#pragma once
// What a task says, as far as it can be told without simulating a move: for people who have just
// written one. Reads no clock; one thread at a time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/check/probe.h"
#include "planner/check/touchable.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct Finding {
  enum class Weight : std::uint8_t {
    kRefused,  ///< planning would refuse the task
    kDoubt,    ///< planning would probably come to nothing
    kAdvice,   ///< it may be meant so
  };
  Weight weight = Weight::kAdvice;
  std::string text;  ///< one line: what, where, how much, what to do
};

/// Where the tool may begin.
struct CheckedParticle {
  Pose tool;
  bool free = true;
};

/// A start and its surroundings.
struct StartCheck {
  std::string name;
  bool free = true;                        ///< where it is nominally
  std::vector<CheckedParticle> particles;  ///< none where it is not free
  std::vector<Touch> touches;              ///< none where a particle is not free
};

/// How far the part can go from the goal until it touches, m; none: farther than a push gets.
struct GoalRoom {
  int axis = 0;
  std::optional<double> down_m;  ///< towards smaller coordinates
  std::optional<double> up_m;
};

struct TaskCheck {
  std::vector<Finding> findings;  ///< in the order in which they should be looked at
  std::vector<StartCheck> starts;
  std::vector<GoalRoom> goal_room;
  bool goal_free = true;

  [[nodiscard]] bool refused() const;
  /// Adds what else planning would refuse, behind what is refused already.
  void refuse(std::string text);
};

/// @param starts of the task, each looked at
[[nodiscard]] TaskCheck check_task(const Task& task, const std::vector<Start>& starts,
                                   const MakeRollout& make);

/// "wrong: " and so on.
[[nodiscard]] const char* weight_text(Finding::Weight weight);

/// The check's lines. The first is the first finding, or says that there is none.
/// @param file as the user gave it
[[nodiscard]] std::string check_text(const std::string& file, const Task& task,
                                     const TaskCheck& check);

}  // namespace tenon::planner
