#pragma once
// The one source of randomness: seeded numbers that are the same on every machine, compiler and
// mathematics library, and how one seed becomes those of many independent streams. No allocation,
// no state but an object's own; an object belongs to one thread.

#include <cstdint>
#include <string_view>

namespace tenon {

/// splitmix64 (Steele, Lea, Flood 2014) under an exact sampler of the normal distribution that
/// needs nothing but comparisons and products of uniform numbers (Karney, Sampling exactly from the
/// normal distribution, ACM TOMS 42, 2016).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] double normal();   ///< mean 0, standard deviation 1
  [[nodiscard]] double uniform();  ///< in [0, 1), 53 bits
  [[nodiscard]] double uniform(double low, double high) { return low + uniform() * (high - low); }

 private:
  [[nodiscard]] bool half_exponential();       // true with probability exp(-1/2)
  [[nodiscard]] bool accept(int k, double x);  // true with probability exp(-x (2k + x) / (2k + 2))
  std::uint64_t state_;
};

/// The seed of one of many streams that a seed stands for: of a run by its number, of whoever draws
/// by its name. Neighbouring seeds and neighbouring numbers give unrelated streams, and the streams
/// of two seeds have nothing in common. For streams of streams, again:
///   Random noise(stream_seed(stream_seed(seed, run), "sensor_noise"));
/// splitmix64's finaliser over the seed, the sum with the number (of a name its FNV-1a), and the
/// finaliser again.
[[nodiscard]] std::uint64_t stream_seed(std::uint64_t seed, std::uint64_t number);
[[nodiscard]] std::uint64_t stream_seed(std::uint64_t seed, std::string_view name);

}  // namespace tenon
