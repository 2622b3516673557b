#include "executor/plan_check.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include "executor/tool_kinematics.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr int kSeeds = 24;
// A tool motion that the joints reproduce this well is one that they can make.
constexpr double kAxisError = 1e-6;
// Decoded plans carry floats: equality up to their rounding is no excess.
constexpr double kRounding = 1.0 + 1e-6;

std::string axis_list(std::uint8_t axes) {
  std::string text;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) == 0) continue;
    text += text.empty() ? "" : " ";
    text += axis_name(static_cast<int>(axis));
  }
  return text.empty() ? "none" : text;
}

const char* unit(const Joint& joint) { return joint.kind == Joint::Kind::kPrismatic ? "m" : "rad"; }

// Where the tool can be, as a displacement from the plan's start.
struct Box {
  Vector6 low = Vector6::Zero();
  Vector6 high = Vector6::Zero();

  void include(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] Box moved(const Vector6& least, const Vector6& most) const {
    return {low + least, high + most};
  }
};

// The plan's graph walked once, successors only grow: where each step can begin and end.
struct Reach {
  std::vector<std::optional<Box>> begin;  ///< empty: no way leads there
  std::vector<Box> swept;                 ///< from begin on, along the whole command too
};

Reach reach_of(const Plan& plan) {
  Reach reach;
  reach.begin.resize(plan.steps.size());
  reach.swept.resize(plan.steps.size());
  if (!plan.steps.empty()) reach.begin[0].emplace();
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    if (!reach.begin[i]) continue;
    const Step& step = plan.steps[i];
    const Vector6 back = step.displacement.cwiseMin(0.0);
    const Vector6 forth = step.displacement.cwiseMax(0.0);
    reach.swept[i] = reach.begin[i]->moved(back, forth);
    for (const OutcomeRule& rule : step.outcomes) {
      if (rule.successor == kSuccessorFail) continue;
      const Box end = plan.check_envelopes ? reach.begin[i]->moved(rule.envelope.travelled_min,
                                                                   rule.envelope.travelled_max)
                                           : reach.swept[i];
      reach.swept[i].include(end);
      if (rule.successor >= plan.steps.size()) continue;
      auto& next = reach.begin[rule.successor];
      if (next) {
        next->include(end);
      } else {
        next = end;
      }
    }
  }
  return reach;
}

class Checker {
 public:
  Checker(const Plan& plan, const Cell& cell) : plan_(plan), cell_(cell), kinematics_(cell) {}

  std::vector<std::string> run() {
    check_latency();
    check_compliance();
    for (std::size_t i = 0; i < plan_.parameter_sets.size(); ++i) check_set(i);
    if (find_start()) {
      check_axes();
      if (check_speeds(start_, "start")) check_reach();
    }
    return refusals_;
  }

 private:
  template <typename... Values>
  void refuse(const char* pattern, Values... values) {
    refusals_.push_back(format(pattern, values...));
  }

  void check_latency() {
    const Robot& robot = cell_.robot;
    const double tau_s = latency_s(robot);
    if (tau_s <= plan_.latency_max_s * kRounding) return;
    refuse(
        "latency (n + 1/2) T + tau_arm = (%d + 0.5) * %g + %g = %g s, the plan allows at most %g s",
        robot.measurement_delay_cycles, 1e-6 * robot.cycle_us, robot.response_lag_s, tau_s,
        plan_.latency_max_s);
  }

  void check_compliance() {
    const Compliance& c = plan_.compliance;
    const double tau_s = latency_s(cell_.robot);
    const double damping_least = 1.5 * cell_.contact_stiffness_Npm * tau_s;
    if (c.damping_Nspm * kRounding < damping_least) {
      refuse("damping D = %g Ns/m, must be at least 1.5 k_e tau = 1.5 * %g * %g = %g Ns/m",
             c.damping_Nspm, cell_.contact_stiffness_Npm, tau_s, damping_least);
    }
    if (c.mass_kg > c.damping_Nspm * tau_s * kRounding) {
      refuse("mass M = %g kg, must be at most D tau = %g * %g = %g kg", c.mass_kg, c.damping_Nspm,
             tau_s, c.damping_Nspm * tau_s);
    }
    if (plan_.force_limit_N > cell_.force_fault_N) {
      refuse("force_limit = %g N, must be at most the cell's force_fault_N = %g N",
             plan_.force_limit_N, cell_.force_fault_N);
    }
  }

  void check_set(std::size_t index) {
    const ParameterSet& set = plan_.parameter_sets[index];
    const Robot& robot = cell_.robot;
    const double peak_N = peak_force_N(cell_, plan_.compliance, set);
    if (!(peak_N <= cell_.force_fault_N)) {
      const double cycle_s = 1e-6 * robot.cycle_us;
      refuse(
          "parameter set %d: peak force F_on + k_e v ((n + 1) T + tau_arm + M / D) = %g + %g * %g "
          "* "
          "(%g + %g + %g) = %g N, must be at most force_fault_N = %g N",
          static_cast<int>(index), set.thresholds.force_on_N, cell_.contact_stiffness_Npm,
          set.speeds.contact_mps, (robot.measurement_delay_cycles + 1) * cycle_s,
          robot.response_lag_s, plan_.compliance.mass_kg / plan_.compliance.damping_Nspm, peak_N,
          cell_.force_fault_N);
    }
    const double noise_N = robot.sensor.force_noise_N;
    if (set.thresholds.force_on_N * kRounding < 5.0 * noise_N) {
      refuse("parameter set %d: force_on = %g N, must be at least 5 sigma = 5 * %g = %g N",
             static_cast<int>(index), set.thresholds.force_on_N, noise_N, 5.0 * noise_N);
    }
  }

  // Positions that hold the start within the limits; tries several seeds, always the same.
  bool find_start() {
    std::mt19937 random(1);
    JointVector seed = kinematics_.middle();
    for (int attempt = 0; attempt < kSeeds; ++attempt) {
      const auto found = kinematics_.joints(plan_.start, seed, kJointMargin);
      const bool solved = found.status == SerialChain::InverseStatus::kSolved;
      if (solved && right_orientation(found.position)) {
        start_ = found.position;
        return true;
      }
      for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
        const Joint& joint = cell_.robot.joints[i];
        seed[i] = std::uniform_real_distribution<double>(joint.lower, joint.upper)(random);
      }
    }
    refuse_pose(plan_.start, kinematics_.middle(), "start '" + plan_.start_name + "'");
    return false;
  }

  // A robot without some freedom must hold the rest of the pose as it is built.
  bool right_orientation(const JointVector& position) {
    const Vector6 off = displacement_between(kinematics_.tool(position), plan_.start);
    const double angle_rad = off.tail<3>().norm();
    constexpr double kAngle_rad = 1e-3;
    if (angle_rad <= kAngle_rad && off.head<3>().norm() <= kAxisError) return true;
    wrong_angle_rad_ = std::max(angle_rad, kAngle_rad);
    return false;
  }

  void refuse_pose(const Pose& pose, const JointVector& seed, const std::string& what) {
    if (wrong_angle_rad_ > 0.0) {
      refuse("%s: the robot's tool is turned by %g rad against it, and the robot moves only %s",
             what.c_str(), wrong_angle_rad_, axis_list(kinematics_.axes()).c_str());
      return;
    }
    const auto free = kinematics_.joints(pose, seed, 0.0, false);
    if (free.status == SerialChain::InverseStatus::kSolved) {
      for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
        const Joint& joint = cell_.robot.joints[i];
        const double q = free.position[i];
        if (q >= joint.lower + kJointMargin && q <= joint.upper - kJointMargin) continue;
        refuse("%s: joint %s would be at %.4f %s, must be in [%g, %g] less %g margin", what.c_str(),
               joint.name.c_str(), q, unit(joint), joint.lower, joint.upper, kJointMargin);
        return;
      }
    }
    refuse("%s: %s, off by %g m or rad", what.c_str(), to_string(free.status), free.error);
  }

  void check_axes() {
    const SerialChain::Jacobian J = kinematics_.jacobian(start_);
    const Eigen::CompleteOrthogonalDecomposition<SerialChain::Jacobian> solver(J);
    std::uint8_t can = 0;
    for (int axis = 0; axis < 6; ++axis) {
      const Vector6 unit_twist = Vector6::Unit(axis);
      const Vector6 made = J * solver.solve(unit_twist);
      if ((made - unit_twist).norm() < kAxisError) can |= static_cast<std::uint8_t>(1U << axis);
    }
    const auto refuse_axes = [&](const char* what, std::uint8_t axes) {
      if ((axes & ~can) == 0) return;
      refuse("%s axes %s: the robot can move the tool along %s only", what, axis_list(axes).c_str(),
             axis_list(can).c_str());
    };
    refuse_axes("compliant", plan_.compliance.compliant_axes);
    refuse_axes("moved", plan_.coordinates);
  }

  // Joint speeds that the plan's fastest translation can ask for in its worst direction.
  bool check_speeds(const JointVector& position, const std::string& where) {
    double fastest_mps = 0.0;
    for (const ParameterSet& set : plan_.parameter_sets) {
      fastest_mps = std::max({fastest_mps, set.speeds.approach_mps, set.speeds.contact_mps});
    }
    const SerialChain::Jacobian J = kinematics_.jacobian(position);
    const Eigen::CompleteOrthogonalDecomposition<SerialChain::Jacobian> solver(J);
    const Eigen::Matrix<double, 6, 3> translations =
        Eigen::Matrix<double, 6, 6>::Identity().leftCols<3>();
    const Eigen::Matrix<double, static_cast<int>(kMaxJoints), 3> per_mps =
        solver.solve(translations);
    for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
      const Joint& joint = cell_.robot.joints[i];
      const double speed = fastest_mps * per_mps.row(static_cast<int>(i)).norm();
      if (speed <= joint.speed_max * kRounding) continue;
      refuse("%s: %g m/s of the tool can ask joint %s for %g %s/s, its speed_max is %g",
             where.c_str(), fastest_mps, joint.name.c_str(), speed, unit(joint), joint.speed_max);
      return false;
    }
    return true;
  }

  void check_reach() {
    const Reach reach = reach_of(plan_);
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
      if (!reach.begin[i]) continue;
      if (!check_box(reach.swept[i], format("step %d", static_cast<int>(i)))) return;
    }
  }

  // Every corner of the box; along axes without extent the corners coincide and are taken once.
  bool check_box(const Box& box, const std::string& what) {
    for (unsigned corner = 0; corner < 64; ++corner) {
      Vector6 off = box.low;
      bool twice = false;
      for (int axis = 0; axis < 6; ++axis) {
        if ((corner >> axis & 1U) == 0) continue;
        twice = twice || box.high[axis] == box.low[axis];
        off[axis] = box.high[axis];
      }
      if (twice) continue;
      const Pose pose = displaced(plan_.start, off);
      const auto found = kinematics_.joints(pose, start_, kJointMargin);
      if (found.status == SerialChain::InverseStatus::kSolved) {
        if (!check_speeds(found.position, what)) return false;
        continue;
      }
      refuse_pose(pose, start_, what);
      return false;
    }
    return true;
  }

  const Plan& plan_;
  const Cell& cell_;
  ToolKinematics kinematics_;
  JointVector start_{};
  double wrong_angle_rad_ = 0.0;
  std::vector<std::string> refusals_;
};

}  // namespace

double peak_force_N(const Cell& cell, const Compliance& compliance, const ParameterSet& set) {
  const Robot& robot = cell.robot;
  const double blind_s = (robot.measurement_delay_cycles + 1) * 1e-6 * robot.cycle_us +
                         robot.response_lag_s + compliance.mass_kg / compliance.damping_Nspm;
  return set.thresholds.force_on_N + cell.contact_stiffness_Npm * set.speeds.contact_mps * blind_s;
}

std::vector<std::string> check_plan(const Plan& plan, const Cell& cell) {
  return Checker(plan, cell).run();
}

}  // namespace tenon::executor
