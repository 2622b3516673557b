#pragma once
// Whether a joint can have moved as its encoder says. From one answer to the next a joint goes as
// it was commanded, or stays behind and makes up for some lost commands; whatever pushes it besides
// does not push it faster than its full speed. What is further off is no motion: the encoder
// jumped. Real-time, one thread, no allocation.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class EncoderWatch {
 public:
  struct Jump {
    int joint = 0;
    double moved = 0.0;  ///< m or rad since its last answer
    double bound = 0.0;  ///< that it can have moved in this direction at the most
  };

  /// Copies what it needs of the robot. A speed_max of 0 is none.
  explicit EncoderWatch(const Robot& robot);

  /// Once a cycle, after update(): m or rad.
  void commanded(const JointVector& position);
  /// Once a cycle. @param fresh bit i: joint i has answered in this cycle; others are not judged
  /// @param sync_ns when the answers were asked for
  /// @return the first joint that jumped
  [[nodiscard]] std::optional<Jump> update(const JointVector& measured, std::uint32_t fresh,
                                           std::int64_t sync_ns);

 private:
  static constexpr std::size_t kWindowMost = 64;
  struct Answer {
    double position = 0.0;
    std::int64_t sync_ns = 0;
    int cycles = 0;  ///< ago
    bool known = false;
  };

  [[nodiscard]] std::optional<Jump> judge(std::size_t joint, double position,
                                          std::int64_t sync_ns) const;

  std::size_t joint_count_;
  double cycle_s_;
  JointVector speed_max_{};   ///< m/s or rad/s
  JointVector resolution_{};  ///< m or rad
  std::size_t window_;        ///< cycles whose commands a joint may still follow
  std::array<JointVector, kWindowMost> changes_{};
  std::size_t newest_ = 0;
  std::optional<JointVector> commanded_;
  std::array<Answer, kMaxJoints> last_{};
};

}  // namespace tenon::executor
