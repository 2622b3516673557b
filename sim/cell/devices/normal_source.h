#pragma once
// Normally distributed numbers from a seed. The standard's own distributions differ between
// libraries; this gives the same numbers everywhere (Marsaglia's polar method on mt19937_64).

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

namespace tenon::sim {

class NormalSource {
 public:
  explicit NormalSource(std::uint64_t seed) : engine_(seed) {}

  /// Mean 0, standard deviation 1.
  [[nodiscard]] double next() {
    if (spare_) {
      const double value = *spare_;
      spare_.reset();
      return value;
    }
    double u = 0.0;
    double v = 0.0;
    double square = 0.0;
    do {
      u = 2.0 * uniform() - 1.0;
      v = 2.0 * uniform() - 1.0;
      square = u * u + v * v;
    } while (square >= 1.0 || square == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = v * scale;
    return u * scale;
  }

  /// [0, 1), 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
  std::optional<double> spare_;
};

}  // namespace tenon::sim
