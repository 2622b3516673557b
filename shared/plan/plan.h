#pragma once
// A plan: guarded moves, and for every outcome of each where to go on. FORMAT.md has its bytes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/motion/move_parameters.h"
#include "shared/motion/outcome.h"
#include "shared/plan/axes.h"
#include "shared/plan/goal_axes.h"

namespace tenon {

/// Where an outcome leads: a step index, or one of the two ends.
using Successor = std::uint8_t;
inline constexpr Successor kSuccessorDone = 0xFE;
inline constexpr Successor kSuccessorFail = 0xFF;
inline constexpr std::size_t kMaxSteps = 200;
/// A decoded plan's numbers are floats: to be above a bound by no more than this factor is no
/// excess.
inline constexpr double kPlanRounding = 1.0 + 1e-6;

/// Which planner made a plan, and thereby what it was certified for.
enum class PlanMethod : std::uint8_t {
  kMha = 0,             ///< search over beliefs: every particle
  kSingleParticle = 1,  ///< baseline: the nominal start alone
  kContactGreedy = 2,   ///< baseline: the same, by way of the nearest contact
};
inline constexpr std::array kPlanMethods = {PlanMethod::kMha, PlanMethod::kSingleParticle,
                                            PlanMethod::kContactGreedy};
/// As on the command line: "mha", "single-particle", "contact-greedy".
[[nodiscard]] const char* to_string(PlanMethod method);

/// What validation saw of an outcome, widened by sensor and latency margins.
struct Envelope {
  Vector6 travelled_min = Vector6::Zero();  ///< m, rad; zero off the plan's coordinates
  Vector6 travelled_max = Vector6::Zero();
  /// Where the tool ended, as displacements from the plan's start in the task frame's axes; zero
  /// off the coordinates, and in a plan that checks no places. Errors do not add up in them from
  /// step to step.
  Vector6 place_min = Vector6::Zero();
  Vector6 place_max = Vector6::Zero();
  ContactSignature always;    ///< bits that every settled signature had
  ContactSignature possible;  ///< bits that some settled signature had
};

struct OutcomeRule {
  Successor successor = kSuccessorFail;
  /// Meaningful only where successor is not kSuccessorFail.
  Envelope envelope;
};

/// Parameters that steps share; stored once a set.
struct ParameterSet {
  SpeedLimits speeds;
  ContactThresholds thresholds;
  std::uint32_t timeout_us = 10'000'000;
  ContactSignature trigger_mask = kAllContacts;
  std::uint8_t sensed_axes = 0x3F;  ///< see MoveParameters
  /// The steps' axes turn with the tool, and are the task frame's at the goal's orientation.
  bool carried_axes = false;
  bool aligns = true;  ///< see MoveParameters

  friend bool operator==(const ParameterSet&, const ParameterSet&) = default;
};

struct Step {
  Vector6 displacement = Vector6::Zero();  ///< zero off the plan's coordinates
  double slow_from_m = 0.0;
  std::uint8_t parameter_set = 0;
  std::array<OutcomeRule, kOutcomes.size()> outcomes;  ///< by Outcome

  [[nodiscard]] const OutcomeRule& rule(Outcome outcome) const {
    return outcomes[static_cast<std::size_t>(outcome)];
  }
};

/// All doubles that the file holds as 32-bit floats come back as the value of the float. What is
/// planned, certified and executed is what was decoded.
struct Plan {
  std::string task_name;   ///< at most 63 bytes
  std::string start_name;  ///< at most 63 bytes
  std::uint64_t task_hash = 0;
  PlanMethod method = PlanMethod::kMha;
  CoordinateMask coordinates = 0;
  Pose start;  ///< nominal, tool in task frame
  Pose goal;
  double goal_tolerance_m = 0.0;  ///< d_tol of the task
  GoalAxes goal_axes;             ///< that do not count in it
  Compliance compliance;
  double force_limit_N = 20.0;
  double torque_limit_Nm = 2.0;
  double contact_stiffness_Npm = 5e4;  ///< that it was certified with
  double latency_max_s = 0.0;          ///< the plan holds for (n + 1/2) T + tau_arm up to this
  double cost = 0.0;
  double bound = 0.0;       ///< cost <= bound times the optimum of the searched graph; 0: none
  std::uint32_t draws = 0;  ///< of validation
  std::uint32_t draws_at_goal = 0;
  bool check_envelopes = true;  ///< false: outcomes alone decide (baseline planners)
  bool check_places = false;    ///< the envelopes' places too; only with envelopes
  std::vector<ParameterSet> parameter_sets;
  std::vector<Step> steps;
};

/// The guarded move of a step. Planner and executor both get their moves here.
[[nodiscard]] MoveParameters move_parameters(const Plan& plan, std::size_t step);

}  // namespace tenon
