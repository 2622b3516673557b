#pragma once
// What there is to see of the virtual cell in a moment: the truth, for people who look on. Plain
// data, copied through a ring; nothing of it goes out over CAN.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tenon::sim {

/// All in the axes of the robot's base. What has a time lies between the moment before and this
/// one.
struct CellMoment {
  static constexpr std::size_t kPointsMax = 8;
  static constexpr std::size_t kTouchedMax = 16;

  double time_s = 0.0;  ///< since the cell was switched on
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1.0, 0.0, 0.0, 0.0};  ///< of the part, as the position is
  std::array<double, 3> force_N{};  ///< of the environment on the part, mean
  double force_N_max = 0.0;         ///< the largest of an instant
  /// Where it touched last, and what it touched since: indices of the environment's shapes. What
  /// does not fit is left out.
  std::array<std::array<double, 3>, kPointsMax> points_m{};
  std::array<std::uint16_t, kTouchedMax> touched{};
  std::uint8_t point_count = 0;
  std::uint8_t touched_count = 0;
  // Drives, how many:
  std::uint8_t enabled = 0;
  std::uint8_t braked = 0;
  std::uint8_t faulted = 0;
};

static_assert(std::is_trivially_copyable_v<CellMoment>);

}  // namespace tenon::sim
