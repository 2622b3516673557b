#pragma once
// What a stop left behind, by the virtual arm's truth: whether power is off and the brakes are on,
// and how far a joint moved after its brake's output had closed. Of a robot without brakes
// only the power counts.

#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/virtual_arm/truth.h"

namespace tenon::tests {

class RestWatch {
 public:
  /// Keeps a reference.
  explicit RestWatch(const Robot& robot) : robot_(robot) {}

  /// Again and again, until all rests.
  void look(const sim::Truth& truth);

  /// No drive of the last truth has power, all brakes are on.
  [[nodiscard]] bool off() const;
  /// Under power or not, no joint has moved in the last kStandingLooks looks by more than a tenth
  /// of a brake's play.
  [[nodiscard]] bool stands() const;
  static constexpr int kStandingLooks = 50;
  /// No joint has moved further than a brake's play (0.5 mm, 2 mrad) since its brake closed.
  [[nodiscard]] bool held() const;
  /// What is not as it should be, of each drive; empty: all is.
  /// @param forged by which an encoder deceives its servo until the brake holds, m or rad
  [[nodiscard]] std::string complaints(double forged = 0.0) const;

 private:
  struct Axis {
    double closed_at = 0.0;  ///< position when the output closed
    double slip = 0.0;       ///< since then, at most
    double stands_at = 0.0;  ///< for so many looks
    int stood = 0;
    bool closed = false;
    bool powered = true;
    std::string state;
  };

  const Robot& robot_;
  std::vector<Axis> axes_;
};

}  // namespace tenon::tests
