#pragma once
// The motion of a friction identification: each joint by itself goes slowly to both sides of where
// it stands, at several speeds, and back. Nothing may touch the part, and the ways must be free: it
// knows of no obstacle, and since friction is not known, of no force either.

#include <array>
#include <vector>

#include "executor/identification/identification_motion.h"
#include "executor/identification/identify_friction.h"
#include "executor/motion/joint_move.h"

namespace tenon::executor {

class IdentifyFrictionMotion : public IdentificationMotion {
 public:
  struct Parameters {
    double way_m = 0.04;    ///< to each side, of a prismatic joint, where its limits allow
    double way_rad = 0.08;  ///< of a revolute one
    std::array<double, 3> tool_mps = {0.01, 0.03, 0.1};
    double settle_s = 0.2;
    double acceleration_most = 0.3;  ///< m/s^2 or rad/s^2 in samples that count
  };

  /// @throws InputError for a cell without joint_torque
  IdentifyFrictionMotion(const Cell& cell, const Parameters& parameters);

  [[nodiscard]] const std::vector<RubSample>& samples() const { return samples_; }

 private:
  struct Leg {
    std::size_t joint = 0;
    double to = 0.0;
    double tool_mps = 0.0;
    bool counts = true;
  };

  void begin() override;
  [[nodiscard]] Turn run(const ArmFeedback& feedback) override;
  void plan_legs();
  void go_on();
  void record(const ArmFeedback& feedback);

  Parameters parameters_;
  std::vector<Leg> legs_;
  std::size_t leg_ = 0;
  JointMove move_;
  double since_s_ = 0.0;
  double velocity_ = 0.0;  ///< commanded to the joint in the last cycle
  std::vector<RubSample> samples_;
};

}  // namespace tenon::executor
