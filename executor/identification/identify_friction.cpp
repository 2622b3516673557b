#include "executor/identification/identify_friction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "shared/base/text.h"
#include "shared/joint_torque/friction_memory.h"

namespace tenon::executor {
namespace {

constexpr std::size_t kSamplesLeast = 200;
// Ways from a micrometre to a decimetre, or as many rad.
constexpr double kWayLeast = 1e-6;
constexpr double kWayMost = 1e-1;
constexpr int kWays = 31;
// Moves that were not made meet other states of the gear than those that were.
constexpr double kMargin = 1.1;
constexpr double kCount = 1e-3;  // of the rated effort, which 6077h counts in thousandths

// Of a sample: z of each way that may be, then velocity, 1, and the effort that they explain.
constexpr int kVelocity = kWays;
constexpr int kOne = kWays + 1;
constexpr int kEffort = kWays + 2;
using Row = Eigen::Matrix<double, kEffort + 1, 1>;
using Products = Eigen::Matrix<double, kEffort + 1, kEffort + 1>;

double way_of(int k) { return kWayLeast * std::pow(kWayMost / kWayLeast, double(k) / (kWays - 1)); }

std::vector<Row> rows_of(const std::vector<RubSample>& samples) {
  std::vector<Row> rows;
  rows.reserve(samples.size());
  Row row = Row::Zero();
  row[kOne] = 1.0;
  double before = samples.front().position;
  for (const RubSample& sample : samples) {
    for (int k = 0; k < kWays; ++k) {
      row[k] = friction_after(row[k], sample.position - before, way_of(k));
    }
    before = sample.position;
    row[kVelocity] = sample.velocity;
    row[kEffort] = sample.effort;
    rows.push_back(row);
  }
  return rows;
}

struct FrictionFit {
  std::vector<int> columns;  ///< of a row: short way, perhaps long way, velocity, 1
  Eigen::VectorXd values;
  double squares = 0.0;

  [[nodiscard]] double explains(const Row& row) const {
    double effort = 0.0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      effort += values[static_cast<int>(i)] * row[columns[i]];
    }
    return effort;
  }
};

/// Least squares out of the sums of products.
FrictionFit fit_of(const Products& products, std::vector<int> columns) {
  const auto n = static_cast<int>(columns.size());
  Eigen::MatrixXd normal(n, n);
  Eigen::VectorXd right(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) normal(i, j) = products(columns[i], columns[j]);
    right[i] = products(columns[i], kEffort);
  }
  FrictionFit fit;
  fit.values = normal.ldlt().solve(right);
  fit.squares = products(kEffort, kEffort) - right.dot(fit.values);
  fit.columns = std::move(columns);
  return fit;
}

std::vector<RubSample> samples_of(const std::vector<RubSample>& samples, std::size_t joint) {
  std::vector<RubSample> own;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(own),
               [joint](const RubSample& sample) { return sample.joint == joint; });
  return own;
}

/// One way, or two: a drive may have bristles alone.
FrictionFit best_fit(const Products& products) {
  std::optional<FrictionFit> best;
  const auto consider = [&](std::vector<int> columns) {
    FrictionFit fit = fit_of(products, std::move(columns));
    const auto shares = fit.values.head(fit.values.size() - 2);
    // Nothing rubs backwards; of one way alone, noise may say so.
    if (shares.size() > 1 && shares.minCoeff() < 0.0) return;
    if (!best || fit.squares < best->squares) best = std::move(fit);
  };
  for (int k = 0; k < kWays; ++k) {
    consider({k, kVelocity, kOne});
    for (int more = k + 1; more < kWays; ++more) consider({k, more, kVelocity, kOne});
  }
  return *best;
}

JointFriction friction_from(const std::vector<RubSample>& samples, const Joint& joint) {
  const std::vector<Row> rows = rows_of(samples);
  Products products = Products::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (samples[i].counts) products += rows[i] * rows[i].transpose();
  }
  const FrictionFit fit = best_fit(products);
  const auto last = fit.values.size() - 1;
  JointFriction friction;
  friction.coulomb = std::max(0.0, fit.values[0]);
  friction.way = way_of(fit.columns[0]);
  friction.hysteresis = last > 2 ? fit.values[1] : 0.0;
  friction.hysteresis_way = way_of(fit.columns[last > 2 ? 1 : 0]);
  friction.viscous = std::max(0.0, fit.values[last - 1]);
  friction.offset = fit.values[last];
  // Smoothed as the wrench is.
  double off = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!samples[i].counts) {
      off = 0.0;
      continue;
    }
    off += (rows[i][kEffort] - fit.explains(rows[i]) - off) / (1.0 + kEffortFilterCycles);
    friction.residual = std::max(friction.residual, std::abs(off));
  }
  friction.residual = kMargin * friction.residual + 0.5 * kCount * joint.rated_effort;
  return friction;
}

bool explained(const std::vector<RubSample>& samples, const JointFriction& friction,
               const Joint& joint) {
  const auto [low, high] =
      std::minmax_element(samples.begin(), samples.end(),
                          [](const auto& a, const auto& b) { return a.effort < b.effort; });
  const double spread = high->effort - low->effort;
  const double few_counts = 3.0 * kCount * joint.rated_effort;
  return friction.residual < std::max(few_counts, spread);
}

std::string line_of(const Joint& joint, const JointFriction& f) {
  const bool turns = joint.kind == Joint::Kind::kRevolute;
  const char* unit = turns ? "Nm" : "N";
  return format(
      "friction of %s: Coulomb %.4g %s, turns within %.2g %s; hysteresis %.4g %s, within %.2g %s; "
      "viscous %.4g %s, offset %.3g %s, %.3g %s unexplained\n",
      joint.name.c_str(), f.coulomb, unit, f.way, joint_unit(joint), f.hysteresis, unit,
      f.hysteresis_way, joint_unit(joint), f.viscous, turns ? "Nm s/rad" : "N s/m", f.offset, unit,
      f.residual, unit);
}

}  // namespace

FrictionIdentification identify_friction(const Robot& robot,
                                         const std::vector<RubSample>& samples) {
  using Status = FrictionIdentification::Status;
  FrictionIdentification found;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    found.joint = static_cast<int>(i);
    const std::vector<RubSample> own = samples_of(samples, i);
    const auto counted = std::count_if(own.begin(), own.end(),
                                       [](const RubSample& sample) { return sample.counts; });
    if (static_cast<std::size_t>(counted) < kSamplesLeast) return found;
    found.joints.push_back(friction_from(own, robot.joints[i]));
    if (!explained(own, found.joints.back(), robot.joints[i])) {
      found.status = Status::kNoFriction;
      return found;
    }
  }
  found.status = Status::kIdentified;
  return found;
}

std::string friction_file(const Robot& robot, const FrictionIdentification& friction) {
  std::string text =
      "# Written by tenon-exec --identify-friction. After a repair, with another\n"
      "# temperature or another payload than the cell knows, let it be written again.\n\n"
      "friction_of: " +
      robot.name + "\njoints:\n";
  for (std::size_t i = 0; i < friction.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const JointFriction& f = friction.joints[i];
    const bool turns = joint.kind == Joint::Kind::kRevolute;
    const char* unit = turns ? "Nm" : "N";
    text += format(
        "  - {name: %s, coulomb_%s: %.6g, way_%s: %.6g, hysteresis_%s: %.6g, hysteresis_way_%s: "
        "%.6g, viscous_%s: %.6g, offset_%s: %.6g, residual_%s: %.6g}\n",
        joint.name.c_str(), unit, f.coulomb, joint_unit(joint), f.way, unit, f.hysteresis,
        joint_unit(joint), f.hysteresis_way, turns ? "Nmspr" : "Nspm", f.viscous, unit, f.offset,
        unit, f.residual);
  }
  return text;
}

std::string describe(const Robot& robot, const FrictionIdentification& friction) {
  using Status = FrictionIdentification::Status;
  const Joint& joint = robot.joints[static_cast<std::size_t>(friction.joint)];
  switch (friction.status) {
    case Status::kIdentified: {
      std::string text;
      for (std::size_t i = 0; i < friction.joints.size(); ++i) {
        text += line_of(robot.joints[i], friction.joints[i]);
      }
      return text;
    }
    case Status::kTooShort:
      return "friction: not identified: joint " + joint.name +
             " has no room to move to both sides; start where it has\n";
    case Status::kNoFriction:
      return "friction: not identified: the effort of joint " + joint.name +
             " does not follow its motion; check 6077h of its drive, and that nothing touches\n";
  }
  return "?";
}

const char* to_string(FrictionIdentification::Status status) {
  switch (status) {
    case FrictionIdentification::Status::kIdentified:
      return "identified";
    case FrictionIdentification::Status::kTooShort:
      return "too_short";
    case FrictionIdentification::Status::kNoFriction:
      return "no_friction";
  }
  return "?";
}

Finding finding_of(const Robot& robot, const FrictionIdentification& friction) {
  const bool found = friction.status == FrictionIdentification::Status::kIdentified;
  Finding finding{found, to_string(friction.status), describe(robot, friction), {}, {}};
  if (!found) return finding;
  finding.file = friction_file(robot, friction);
  const auto of_all = [&](const char* name, double JointFriction::*value) {
    std::vector<double> values;
    for (const JointFriction& joint : friction.joints) values.push_back(joint.*value);
    finding.values.emplace_back(name, values);
  };
  of_all("coulomb", &JointFriction::coulomb);
  of_all("hysteresis", &JointFriction::hysteresis);
  of_all("hysteresis_way", &JointFriction::hysteresis_way);
  of_all("viscous", &JointFriction::viscous);
  of_all("offset", &JointFriction::offset);
  of_all("way", &JointFriction::way);
  of_all("residual", &JointFriction::residual);
  return finding;
}

}  // namespace tenon::executor
