#pragma once
// Seeded normal numbers that are the same on every machine, compiler and mathematics library.

#include <cstdint>

namespace tenon::planner {

/// splitmix64 (Steele, Lea, Flood 2014) under an exact sampler of the normal distribution that
/// needs nothing but comparisons and products of uniform numbers (Karney, Sampling exactly from the
/// normal distribution, ACM TOMS 42, 2016).
class NormalDraws {
 public:
  explicit NormalDraws(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] double normal();   ///< mean 0, standard deviation 1
  [[nodiscard]] double uniform();  ///< in [0, 1), 53 bits

 private:
  [[nodiscard]] bool half_exponential();       // true with probability exp(-1/2)
  [[nodiscard]] bool accept(int k, double x);  // true with probability exp(-x (2k + x) / (2k + 2))
  std::uint64_t state_;
};

}  // namespace tenon::planner
