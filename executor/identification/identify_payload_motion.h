#pragma once
// The motion of a payload identification: rests in several poses around the first one, reached by
// turning the last three joints slowly, and takes the mean reading in each. It ends where it began.
// A robot that turns nothing takes one reading. Nothing may touch the part, and the poses must be
// free: it knows of no obstacle.

#include <vector>

#include "executor/identification/identification_motion.h"
#include "executor/identification/identify_payload.h"
#include "executor/motion/joint_move.h"
#include "executor/sensing/sensor_tare.h"

namespace tenon::executor {

class IdentifyPayloadMotion : public IdentificationMotion {
 public:
  struct Parameters {
    double turn_rad = 0.5;  ///< of each joint, to both sides where its limits allow
    int samples = 400;      ///< of one reading
    double settle_s = 0.5;
    SpeedLimits tool;  ///< its contact speeds bound the motion
  };

  IdentifyPayloadMotion(const Cell& cell, const Parameters& parameters);

  /// Of the poses so far.
  [[nodiscard]] const std::vector<RestReading>& readings() const { return readings_; }

 private:
  void begin() override;
  [[nodiscard]] Turn run(const ArmFeedback& feedback) override;
  void go_on();
  [[nodiscard]] RestReading reading() const;

  Parameters parameters_;
  std::vector<std::size_t> turning_;  ///< joints, outermost first
  std::vector<JointVector> poses_;    ///< the first pose last
  std::vector<RestReading> readings_;
  std::size_t pose_ = 0;
  JointMove move_;
  double since_s_ = 0.0;
  SensorTare reading_;
};

}  // namespace tenon::executor
