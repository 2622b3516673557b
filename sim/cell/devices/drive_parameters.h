#pragma once
// What distinguishes one virtual drive from another. Plain data.

#include <cstdint>
#include <string>

#include "shared/canopen/constants.h"

namespace tenon::sim {

struct DriveParameters {
  std::uint8_t node = 1;
  std::string name = "tenon virtual drive";
  std::int8_t mode = canopen::kModeCyclicSynchronousPosition;  ///< the one that it supports
  double counts_per_unit = 1.0;                                ///< per m or rad, signed
  std::uint32_t quick_stop_counts_ps2 = 5'000'000;             ///< default of 6084h and 6085h
  std::uint32_t rated_effort_mNm = 1'000;     ///< 6076h; of a prismatic joint in mN
  std::uint16_t effort_max_permille = 3'000;  ///< default of 6072h
  // The holding brake: from its output to its opening, or to its holding.
  double brake_release_s = 0.020;
  double brake_engage_s = 0.010;
  // The power stage. Its temperature rises by `rise_K` in the long run under rated effort, with the
  // square of the effort.
  double ambient_degC = 25.0;
  double rise_K = 45.0;
  double thermal_time_constant_s = 300.0;
  double warning_degC = 80.0;  ///< default of 2031h
  double fault_degC = 95.0;    ///< default of 2032h
  double supply_V = 48.0;
  double supply_min_V = 36.0;  ///< default of 2033h
};

}  // namespace tenon::sim
