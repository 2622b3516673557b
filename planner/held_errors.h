#pragma once
// How much of what calibration leaves a plan is to hold: less, where none holds all of it. Pure.

#include <vector>

#include "planner/belief/belief.h"
#include "planner/judge/judged_starts.h"
#include "shared/task/task.h"

namespace tenon::planner {

class HeldErrors {
 public:
  /// All that the task says. It must outlive this.
  explicit HeldErrors(const Task& task) : stated_(task), held_(task) {}

  void hold(const CalibrationErrors& errors) { held_ = holding(stated_, errors); }
  /// With the errors that are held.
  [[nodiscard]] const Task& task() const { return held_; }

  /// Guides that hold for all of the sensor's error are stricter than need be.
  [[nodiscard]] bool felt_less() const { return sensor_errors(held_) != sensor_errors(stated_); }
  /// The sensor's error, and nothing else, may be given up yet.
  [[nodiscard]] bool less_may_be_felt() const {
    return sensor_errors(held_).size() > 1 && tilted_axes(stated_).empty();
  }

 private:
  const Task& stated_;
  Task held_;
};

}  // namespace tenon::planner
