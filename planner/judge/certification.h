#pragma once
// The plan as written, replayed as one chain for every particle under several physics.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planner/belief/rollout_pool.h"
#include "planner/judge/chain.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// One physics that the chain has to survive.
struct CertificationVariant {
  std::string name;
  std::optional<double> friction;    ///< of every particle; empty: each its own
  std::optional<double> oversize_m;  ///< likewise
  std::optional<double> latency_s;   ///< likewise
  std::int64_t step_us = 0;
};

/// As planned (with the held part as large as it may be), at half the integration step, at the
/// friction extremes, with the part as drawn, and at the extremes of latency. A baseline, which
/// knows of no uncertainty, has planned for the first two alone.
[[nodiscard]] std::vector<CertificationVariant> certification_variants(const Task& task,
                                                                       const Plan& plan);

/// Where and why a variant does not hold.
struct Disagreement {
  std::size_t step = 0;
  std::size_t particle = 0;
  std::string why;
};

struct VariantRun {
  CertificationVariant variant;
  std::vector<Chain> chains;  ///< by particle
  bool holds = false;
  Disagreement disagreement;  ///< meaningful where it does not hold: the earliest step
};

struct Certification {
  std::vector<VariantRun> runs;
  double cost = 0.0;  ///< of the chain as planned (first variant), by the task's weights

  [[nodiscard]] bool holds() const;
  /// The run with the earliest disagreement; null where all hold.
  [[nodiscard]] const VariantRun* refuting() const;
};

enum class CertificationExtent : std::uint8_t {
  kAll,
  kToFirstRefutation,  ///< nothing else is run where the plan does not even hold as planned
};

/// Decodes the bytes and runs the plan's own transitions, for the particles that its method plans
/// for. A variant holds where every particle's chain is done at the goal, all of them within its
/// tolerances. At half the integration step every chain must also end as in the first variant,
/// within 0.5 mm and 0.2 degrees. On the way a move may end otherwise, as long as the plan goes on
/// from there to the goal.
/// @throws InputError where the bytes are no plan, or not one of this task
[[nodiscard]] Certification certify(std::span<const std::uint8_t> bytes, const Task& task,
                                    RolloutPool& pool,
                                    CertificationExtent extent = CertificationExtent::kAll);

/// The start of the task that a plan was made for.
/// @throws InputError where there is none of that name, or it moved
[[nodiscard]] const Start& start_of(const Plan& plan, const Task& task);

}  // namespace tenon::planner
