#pragma once
// The user's words while a plan runs, lines on standard input: "p" pauses the move, "r" lets it go
// on, Enter alone lets the step that waits begin.

#include <memory>

#include "executor/loop/controller.h"
#include "executor/loop/stop_requests.h"

namespace tenon::executor {

class UserWords {
 public:
  /// Listens until it ends. Where standard input ends while a step or a paused move needs a word,
  /// nobody can be asked any more: the work ends, and an arm that is held is held on.
  /// @param step_by_step Enter counts  @param controller, stop outlive this
  UserWords(Controller& controller, StopRequests& stop, bool step_by_step);
  UserWords(const UserWords&) = delete;
  UserWords& operator=(const UserWords&) = delete;
  ~UserWords();

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace tenon::executor
