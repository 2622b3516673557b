#pragma once
// As many runs as a page can show. Pure; allocates.

#include <cstddef>

#include "sim/evaluation/evaluation.h"

namespace tenon::sim {

/// The candidate with at most `most` of its runs: those that are recorded, failures up to two
/// thirds, then runs that succeeded; of either an even choice by number.
[[nodiscard]] Candidate sample_of(const Candidate& candidate, std::size_t most);

}  // namespace tenon::sim
