#pragma once
// Stiffness of a contact and the lag of the arm from a recording of presses and releases. Pure
// mathematics: the commanded way into the contact is a wave of ramps, and the force answers with
//   F(t) = k d(t - delay) + F_0,
// where a dead time and a first-order lag delay a ramp alike. For each delay the rest is linear
// least squares; the delay with the least residual is found by golden section. A contact with
// damping of its own answers early, by damping over stiffness: the delay is that of arm and contact
// together, as the admittance law meets it. Set-up code; allocates.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/identification/finding.h"

namespace tenon::executor {

/// One cycle of the recording, evenly spaced in time.
struct PressSample {
  double depth_m = 0.0;  ///< commanded into the contact in this cycle, any origin
  double force_N = 0.0;  ///< of the contact on the tool, against the way
  bool fresh = false;    ///< the force was measured in this cycle
};

struct ContactIdentification {
  enum class Status : std::uint8_t {
    kIdentified = 0,
    kTooShort = 1,     ///< fewer than kPressSamplesMin fresh samples
    kNoResponse = 2,   ///< the force does not grow with the way
    kDelayAtEdge = 3,  ///< no delay up to kPressDelayMax_s explains the force
  };
  Status status = Status::kTooShort;
  double stiffness_Npm = 0.0;  ///< k_e: force per commanded way, all in series
  double stiffness_deviation_Npm = 0.0;
  double delay_s = 0.0;  ///< from a setpoint to the force sample that shows it
  double delay_deviation_s = 0.0;
  double residual_N = 0.0;  ///< root mean square
  /// tau_arm: the delay less half a cycle, the mean age of a sample that averages its cycle. What a
  /// sensor adds to that counts as the arm's.
  double lag_s = 0.0;
  double cycle_s = 0.0;
};

inline constexpr std::size_t kPressSamplesMin = 50;
inline constexpr double kPressDelayMax_s = 0.15;

/// @param cycle_s between samples
[[nodiscard]] ContactIdentification identify_contact(const std::vector<PressSample>& samples,
                                                     double cycle_s);

/// Lines for people: values with deviations, then what robot and cell file should say, with a lag
/// of no less than the two cycles that CANopen drives take. Or why not.
[[nodiscard]] std::string describe(const ContactIdentification& contact);

[[nodiscard]] const char* to_string(ContactIdentification::Status status);
[[nodiscard]] Finding finding_of(const ContactIdentification& contact);

}  // namespace tenon::executor
