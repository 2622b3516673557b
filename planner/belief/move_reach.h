#pragma once
// Whether the arm of a cell can make a belief's moves: poses that it cannot reach do not exist for
// the search. A move is asked for as the plan's file will allow it, so wider than its particles go:
// out to the draws that validation adds, and by an envelope's margins. Simulates nothing. One
// thread.

#include <cstdint>
#include <memory>
#include <string>

#include "planner/belief/belief.h"
#include "shared/ports/arm_reach.h"
#include "shared/task/task.h"

namespace tenon::planner {

class MoveReach {
 public:
  struct Parameters {
    Pose start;                         ///< of the plan: what places are told from
    Vector6 margins = Vector6::Zero();  ///< of an envelope, m and rad; 0 off the coordinates
    double draws_over_particles = 1.0;  ///< how much farther out draws are than particles, >= 1
  };

  struct Range {
    Vector6 least = Vector6::Zero();
    Vector6 most = Vector6::Zero();

    void include(const Vector6& value) {
      least = least.cwiseMin(value);
      most = most.cwiseMax(value);
    }
  };

  /// Of the particles, m and rad.
  struct Travel {
    Range way;    ///< by axis of the move
    Range place;  ///< where they end, from the plan's start
  };

  MoveReach(std::shared_ptr<const ArmPlace> start, const Parameters& parameters)
      : start_(std::move(start)), parameters_(parameters) {}

  /// Where the plan begins.
  [[nodiscard]] const std::shared_ptr<const ArmPlace>& start() const { return start_; }
  /// A pose as places are told.
  [[nodiscard]] Vector6 place_at(const Pose& tool) const {
    return displacement_between(parameters_.start, tool);
  }

  /// Where the arm is with a belief; of one that was put somewhere, at its mean. Null: it cannot be
  /// there.
  [[nodiscard]] std::shared_ptr<const ArmPlace> place_of(const Belief& belief);

  /// @param from not null  @param contacts that some particle holds as the move begins
  /// @param touches whether a particle ends in contact: of what is refused such moves are told
  /// first  @return null where the arm cannot make the move
  [[nodiscard]] std::shared_ptr<const ArmPlace> after(const ArmPlace& from,
                                                      const Vector6& displacement,
                                                      ContactSignature contacts,
                                                      const Travel& travel, bool touches);

  /// Moves and places that were refused so far, for people; empty where none was.
  [[nodiscard]] std::string refused_text() const;

 private:
  [[nodiscard]] Step step_of(const Vector6& displacement, const Travel& travel) const;
  void note(const std::string& why, bool touches);

  std::shared_ptr<const ArmPlace> start_;
  Parameters parameters_;
  std::uint64_t refused_ = 0;
  std::string first_;  ///< why, of the first one that would touch, else of the first
  bool first_touches_ = false;
};

}  // namespace tenon::planner
