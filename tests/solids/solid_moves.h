#pragma once
// Drawn guarded moves of one body of triangles about another, in the planner's physics, each
// looked at by a witness that is not Tenon's.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "shared/geometry/solid.h"
#include "shared/math/pose.h"
#include "shared/motion/contact_signature.h"

namespace tenon::tests {

struct SolidPair {
  std::shared_ptr<const Solid> held;         ///< assembled as its file has it
  std::shared_ptr<const Solid> environment;  ///< the same
  Vector3 way_out = Vector3::UnitZ();        ///< unit; the held one is free to leave this way
  double depth_m = 0.0;                      ///< along it until it is free to move aside
  double play_m = 0.0;                       ///< the smaller one across, both ways together
};

struct SolidMovesOptions {
  std::size_t moves = 100;
  std::uint64_t seed = 1;
  std::size_t threads = 1;
  std::uint8_t compliant_axes = kAllAxes;
  /// All of it turned so inside the task frame.
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();

  static constexpr std::uint8_t kAllAxes = 0x3F;
};

struct SolidMovesSeen {
  std::size_t moves = 0;
  std::size_t contacts = 0;       ///< ended by one
  std::size_t meeting = 0;        ///< instants at which the witness saw the surfaces cross
  std::size_t instants = 0;       ///< that the witness looked at
  std::size_t invalid = 0;        ///< moves that the simulation gave up
  std::string first_invalid;      ///< why
  double depth_max_m = 0.0;       ///< by the witness
  std::uint64_t fingerprint = 0;  ///< of all end poses and outcomes, bit for bit
};

/// Chains of ten moves, each chain from a drawn place: inserted, half-way, or above. Speeds from 5
/// to 50 mm/s, friction from 0.1 to 0.6, up to 10 mm and a twentieth of a radian a move.
[[nodiscard]] SolidMovesSeen run_solid_moves(const SolidPair& pair,
                                             const SolidMovesOptions& options);

}  // namespace tenon::tests
