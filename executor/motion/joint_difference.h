#pragma once
// How far apart two positions of an arm are. Real-time.

#include <cmath>

#include "shared/ports/arm.h"

namespace tenon::executor {

/// The joint that differs most, and by how much, m or rad.
struct JointDifference {
  int joint = 0;
  double value = 0.0;
};

[[nodiscard]] inline JointDifference largest_difference(const JointVector& a,
                                                        const JointVector& b) {
  JointDifference largest;
  for (std::size_t i = 0; i < kMaxJoints; ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (difference > largest.value) largest = {static_cast<int>(i), difference};
  }
  return largest;
}

}  // namespace tenon::executor
