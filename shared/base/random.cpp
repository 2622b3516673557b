#include "shared/base/random.h"

#include "shared/base/fnv.h"

namespace tenon {
namespace {

constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15U;  // of splitmix64: the golden ratio's bits

/// splitmix64's finaliser.
std::uint64_t scrambled(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

}  // namespace

double Random::uniform() {
  state_ += kGamma;
  return static_cast<double>(scrambled(state_) >> 11U) * 0x1.0p-53;
}

bool Random::half_exponential() {
  // The length of a falling run of uniforms that starts below 1/2 is even with that probability.
  double last = 0.5;
  for (bool even = true;; even = !even) {
    const double u = uniform();
    if (!(u < last)) return even;
    last = u;
  }
}

bool Random::accept(int k, double x) {
  // The same with a run that goes on with probability (2k + x) / (2k + 2), and starts below x.
  const double go_on = (2.0 * k + x) / (2.0 * k + 2.0);
  double last = x;
  for (bool even = true;; even = !even) {
    const double u = uniform();
    if (!(u < last) || !(uniform() < go_on)) return even;
    last = u;
  }
}

double Random::normal() {
  while (true) {
    // The integer part k with probability proportional to exp(-k^2 / 2).
    int k = 0;
    while (half_exponential()) ++k;
    bool kept = true;
    for (int i = 0; kept && i < k * (k - 1); ++i) kept = half_exponential();
    if (!kept) continue;
    // The fraction x with probability proportional to exp(-x (2k + x) / 2): k + 1 equal factors.
    const double x = uniform();
    for (int i = 0; kept && i <= k; ++i) kept = accept(k, x);
    if (!kept) continue;
    return uniform() < 0.5 ? k + x : -(k + x);
  }
}

std::uint64_t stream_seed(std::uint64_t seed, std::uint64_t number) {
  return scrambled(scrambled(seed + kGamma) + number + kGamma);
}

std::uint64_t stream_seed(std::uint64_t seed, std::string_view name) {
  return stream_seed(seed, fnv1a_64(name));
}

}  // namespace tenon
