#pragma once
// The guarded move: the one piece of code that plans and executes are made of.
//
// Planner rollouts step it against simulated wrenches, the executor against measured ones. What it
// does depends on nothing but its arguments: a recorded trace of inputs replayed into a new
// GuardedMove gives the same outputs bit for bit.
//
//            candidate bit                candidate gone
//   kMoving ----------------> kProbing ------------------> kMoving (the rest of the path)
//      |                          |
//      |  outcome                 | bit confirmed: contact
//      +-----------+--------------+
//                  v
//             kSettling -- at rest, or bounded --> kDone
//
// A candidate that was no contact costs nothing: the path goes on from where the stop and the press
// have brought a tool that nothing touches. Contacts that are held already are kept while another
// is made, since that may push the tool off them for a while; when it is at rest shows which are
// left.
//
// A tool that can rotate is turned by what it is pressed against. After a contact it presses with
// the force of a probe until it is at rest, its setpoint creeping after the pose, which is what
// lets a part align flat; only then it rests with the keep force. Torque below torque_off_Nm turns
// it by the spring's give alone: without that bound whatever the sensor is wrong by would turn it
// for as long as it presses. Nor does a press turn it about its own direction.
//
// The plant between setpoint and pose (an ODE rollout, or an admittance law in front of drives)
// realises Compliance; the move itself never looks at the spring's own force. It bounds what the
// plant can pull with, spring and feed-forward together, where something holds the tool back: also
// where nobody watches for that contact.

#include <cstdint>
#include <optional>

#include "shared/math/pose.h"
#include "shared/motion/admittance.h"
#include "shared/motion/contact_detector.h"
#include "shared/motion/motion_profile.h"
#include "shared/motion/move_parameters.h"
#include "shared/motion/outcome.h"
#include "shared/motion/recent_poses.h"
#include "shared/motion/setpoint.h"

namespace tenon {

/// Real-time: no allocation, no clock, no lock; bounded work an update.
class GuardedMove {
 public:
  struct Input {
    std::int64_t time_ns = 0;          ///< strictly increasing
    Pose pose;                         ///< measured tool pose
    Vector6 wrench = Vector6::Zero();  ///< external, task axes at the tool, N and Nm
    bool wrench_fresh = true;          ///< a new sensor sample, not the last one again
  };

  using Setpoint = tenon::Setpoint;

  struct Result {
    Outcome outcome = Outcome::kTimeout;
    ContactSignature signature;           ///< settled
    Pose pose;                            ///< settled
    Vector6 travelled = Vector6::Zero();  ///< from the first pose to the settled one
    std::int64_t decided_ns = 0;          ///< when the outcome fired, since the start
    std::int64_t duration_ns = 0;         ///< settling included
    double peak_force_N = 0.0;            ///< largest |force| over fresh samples
  };

  enum class Phase : std::uint8_t { kMoving, kProbing, kSettling, kDone };

  struct Output {
    Setpoint setpoint;
    Phase phase = Phase::kMoving;
  };

  /// @param parameters must satisfy check_thresholds() (shared/motion/rules.h)
  /// @param signature the contacts that the tool holds as the move starts
  /// @param held the setpoint as the move before left it; without it the move begins from the tool,
  /// which a force or torque that counts for none has moved by the spring's give
  GuardedMove(const MoveParameters& parameters, ContactSignature signature,
              const std::optional<Pose>& held = std::nullopt);

  /// One step. The first call sets the start pose and time. After kDone the setpoint holds.
  Output update(const Input& input);

  [[nodiscard]] Phase phase() const { return phase_; }
  /// Set once, when the phase becomes kDone.
  [[nodiscard]] const std::optional<Result>& result() const { return result_; }
  /// The contacts as they stand now.
  [[nodiscard]] ContactSignature signature() const { return detector_.signature(); }

  /// The setpoint that a tool at rest has: its pose, pressed by the keep force into every contact
  /// that the signature holds.
  [[nodiscard]] static Pose rest_setpoint(const Pose& pose, ContactSignature signature,
                                          const MoveParameters& parameters);

 private:
  /// One step in the move's own axes.
  void advance(const Input& input);
  [[nodiscard]] Input in_own_axes(const Input& input) const;
  [[nodiscard]] Setpoint in_task_axes(const Setpoint& own) const;
  void start(const Input& input);
  void plan_path(std::int64_t time_ns, double from);
  void enter_probing(const Input& input);
  void enter_settling(const Input& input, Outcome outcome);
  void move(const Input& input);
  /// How far along the path a pose is, in path units; the part off the path does not count.
  [[nodiscard]] double path_at(const Pose& pose) const;
  void probe(const Input& input);
  void resume(const Input& input);
  void settle(const Input& input);
  /// The setpoint of a tool that rotates follows it, pressing on.
  void creep(const Pose& pose);
  /// The setpoint of a tool that is left where it is. What moves it without being a contact would
  /// move it on from move to move if the setpoint followed.
  [[nodiscard]] Pose resting(const Pose& pose, ContactSignature signature) const;
  /// `pose` with what another one has of its position along axes where less than force_off_N keeps
  /// the two apart.
  [[nodiscard]] Pose with_position_of(const Pose& held, Pose pose) const;
  void finish(const Input& input);
  /// @param limited out: bit a: the spring's pull is at its limit on axis a
  [[nodiscard]] Pose clamped(const Pose& setpoint, const Pose& pose, std::uint8_t& limited) const;
  [[nodiscard]] bool turns_only() const;
  void watch_resistance(const Vector6& wrench);
  void ease(const Pose& pose, std::uint8_t axes);
  [[nodiscard]] ContactSignature watched(ContactSignature bits) const;
  /// While a contact is being made the tool presses on into those that it holds already; which of
  /// them are left shows when it is at rest.
  [[nodiscard]] ContactSignature kept() const;

  MoveParameters parameters_;
  std::optional<Pose> held_;                ///< as the move begins, in its own axes
  std::optional<Eigen::Quaterniond> axes_;  ///< the move's, in the task frame, where they differ
  bool rotates_ = false;                    ///< something may turn the tool
  bool aligns_ = false;                     ///< what it meets is to
  ContactDetector detector_;
  ContactSignature initial_;
  /// Bits that the move pushes away from: they neither trigger by going nor by coming back.
  ContactSignature leaving_;
  Vector6 displacement_ = Vector6::Zero();  ///< without what would push into a held contact
  double length_ = 0.0;                     ///< of displacement_, m (rad if it only rotates)
  Vector6 along_ = Vector6::Zero();         ///< displacement_ over length_

  Phase phase_ = Phase::kMoving;
  bool started_ = false;
  RecentPoses::Moment first_;
  Pose rest_;  ///< setpoint at the first pose
  Setpoint setpoint_;
  MotionProfile profile_;
  std::int64_t profile_start_ns_ = 0;
  double profile_from_ = 0.0;                ///< path already behind the profile's start
  double path_ = 0.0;                        ///< path covered by the command
  Vector6 path_velocity_ = Vector6::Zero();  ///< of the command, before anything is eased
  std::uint8_t resisted_ = 0;  ///< bit a: something pushes back against the command on axis a
  Admittance free_tool_;       ///< while probing: the tool if nothing touches it
  std::int64_t pressed_since_ns_ = -1;
  std::int64_t decided_ns_ = 0;
  std::int64_t settling_since_ns_ = 0;
  int settling_samples_ = 0;
  bool aligning_ = false;      ///< not at rest yet under the force of a probe
  ContactSignature pressing_;  ///< the contacts that the settling setpoint presses into
  Outcome outcome_ = Outcome::kTimeout;
  double peak_force_N2_ = 0.0;  ///< squared
  std::optional<Result> result_;

  /// The last poses, to tell rest from motion through encoder quantisation.
  RecentPoses recent_;
};

}  // namespace tenon
