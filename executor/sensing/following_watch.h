#pragma once
// Whether the joints are where they are commanded to be. A joint on its way lies between the
// positions that were commanded within the arm's lag: one that is further from all of them than its
// following error allows (6065h of its drive), for longer than the drive itself would wait before
// it says so, does not follow, whatever its statusword tells. At rest the same. Real-time, one
// thread, no allocation.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class FollowingWatch {
 public:
  struct Excess {
    int joint = 0;
    double error = 0.0;  ///< m or rad, from the nearest of the positions commanded
    double bound = 0.0;
  };

  /// Copies what it needs of the robot. A following_error_max of 0 is none.
  explicit FollowingWatch(const Robot& robot);

  /// Nothing is commanded: the joints are where they should be.
  void rest_at(const JointVector& position);
  /// Once a cycle, after update().
  void commanded(const JointVector& position);
  /// Once a cycle. @param fresh bit i: joint i has answered in this cycle; others are not judged
  /// @return the first joint that has been too far off in more than cycles_max() cycles in a row
  [[nodiscard]] std::optional<Excess> update(const JointVector& measured, std::uint32_t fresh);

  /// The joint that was furthest off in terms of its bound within the last tenth of a second, if
  /// that was more than a quarter: it need not be too far off to be what another fault comes from,
  /// and a servo that makes up for it at once pushes hardest when it is back.
  [[nodiscard]] std::optional<Excess> laggard() const;

  [[nodiscard]] int cycles_max() const { return cycles_max_; }

 private:
  static constexpr std::size_t kWindowMost = 64;

  void remember(std::size_t joint, double error);
  [[nodiscard]] double error_of(std::size_t joint, double position) const;

  std::size_t joint_count_;
  JointVector bound_{};
  std::size_t window_;  ///< cycles whose commands a joint may still be on the way to
  int cycles_max_;
  std::array<JointVector, kWindowMost> commands_{};
  std::size_t newest_ = 0;
  std::array<int, kMaxJoints> cycles_off_{};
  JointVector furthest_{};  ///< of the last cycles
  std::array<int, kMaxJoints> furthest_age_{};
  int remembered_cycles_ = 0;
};

}  // namespace tenon::executor
