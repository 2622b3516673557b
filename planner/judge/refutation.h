#pragma once
// What speaks against a path: the chain that shows it, and why. Pure; any thread.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/judge/certification.h"
#include "planner/judge/chain.h"
#include "planner/judge/validation.h"

namespace tenon::planner {

struct Refutation {
  Chain chain;
  std::optional<std::size_t> step;  ///< at which the chain went wrong, where that is known
  std::string why;                  ///< one line
  std::vector<Particle> others{};   ///< starts that the path has missed, the chain's among them
  bool by_calibration = false;  ///< one of these would not have missed without calibration errors
};

/// The earliest disagreement. @param certification one that does not hold
[[nodiscard]] Refutation refutation_of(const Certification& certification);

/// A draw that missed the goal, with the physics that it had and what stopped it.
[[nodiscard]] Refutation refutation_of(const Draw& missed, const Task& task, const Start& start);

/// "step 4: outcome contact has no successor", "ended 2.31 mm and 0.00 degrees from the goal, not
/// inserted": of a chain that was run and has missed it.
[[nodiscard]] std::string miss_text(const Chain& missed, const Task& task);

/// "friction 0.6, latency 7.0 ms, the part 0.5 mm larger than drawn, tilted by 0.17 degrees", for
/// people.
[[nodiscard]] std::string corner_name(const Particle& particle, const Task& task,
                                      const Start& start);

}  // namespace tenon::planner
