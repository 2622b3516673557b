#pragma once
// The user's words while a plan runs, lines on standard input: "p" pauses the move, "r" lets it go
// on, Enter alone lets the step that waits begin.

#include <atomic>
#include <memory>

#include "executor/loop/controller.h"

namespace tenon::executor {

class UserWords {
 public:
  /// Listens until it ends. Where standard input ends while a step or a paused move needs a word,
  /// nobody can be asked any more: the run is stopped.
  /// @param step_by_step Enter counts  @param controller, stop outlive this
  UserWords(Controller& controller, std::atomic<bool>& stop, bool step_by_step);
  UserWords(const UserWords&) = delete;
  UserWords& operator=(const UserWords&) = delete;
  ~UserWords();

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace tenon::executor
