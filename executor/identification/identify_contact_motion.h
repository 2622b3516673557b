#pragma once
// The motion of a contact identification. Slowly along one axis until something is met, a first
// slow press that tells how stiff it is, then a wave of presses and releases between two forces at
// a speed to match, and back to where it began. The tool is commanded rigidly, without compliance:
// what answers is the arm and the contact.
//
//   force   ............................/\../\/\/\/\/\/\..............   kForceHigh_N
//   phase          approach      first press     wave        retreat

#include <optional>
#include <vector>

#include "executor/identification/identification_motion.h"
#include "executor/identification/identify_contact.h"
#include "shared/motion/motion_profile.h"

namespace tenon::executor {

class IdentifyContactMotion : public IdentificationMotion {
 public:
  struct Parameters {
    int axis = 0;           ///< x y z of the task frame
    int sign = 1;           ///< which way along it
    double reach_m = 0.05;  ///< gives up where nothing has been met
    double approach_mps = 2e-3;
    double press_mps = 5e-4;  ///< of the first press
    double force_low_N = 6.0;
    double force_high_N = 20.0;
    double half_wave_s = 0.4;
    int half_waves = 16;
  };

  enum class Phase : std::uint8_t {
    kApproaching = 0,
    kPressing = 1,
    kWaving = 2,
    kRetreating = 3,
  };

  IdentifyContactMotion(const Cell& cell, const Parameters& parameters);

  /// The recorded wave.
  [[nodiscard]] const std::vector<PressSample>& samples() const { return samples_; }
  /// False: nothing was met within reach, and it ends with kNothingMet.
  [[nodiscard]] bool met() const { return met_; }

 private:
  void begin() override;
  [[nodiscard]] Turn run(const ArmFeedback& feedback) override;
  [[nodiscard]] Turn approach_contact();
  [[nodiscard]] Turn press();
  [[nodiscard]] Turn wave();
  void start_retreat();
  [[nodiscard]] Turn retreat();
  /// @return why the joints cannot follow
  [[nodiscard]] std::optional<Ending> advance(double speed_mps);
  /// Of the contact, positive against the way.
  [[nodiscard]] double force_N() const;

  Parameters parameters_;
  Phase phase_ = Phase::kApproaching;
  bool met_ = false;
  Pose first_;
  double depth_m_ = 0.0;  ///< commanded way from first_
  double low_m_ = -1.0;   ///< depth at which the first press passed force_low
  double wave_mps_ = 0.0;
  double direction_ = 1.0;
  int half_waves_ = 0;
  MotionProfile back_;
  double retreat_from_m_ = 0.0;
  double retreat_s_ = 0.0;
  std::vector<PressSample> samples_;
};

}  // namespace tenon::executor
