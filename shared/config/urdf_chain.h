#pragma once
// The mechanics of a robot out of its URDF: one chain of moving joints from base to flange. Fixed
// joints are folded into their neighbours, with the mass that stands behind them. Offline. Throws
// InputError with one line that names file and element, as in
//   hw/robots/x/x.urdf: joint "elbow": mimics joint "shoulder", must move by itself

#include <filesystem>
#include <vector>

#include "shared/cell/robot.h"

namespace tenon::config {

struct UrdfChain {
  std::vector<Joint> joints;  ///< base to flange; what drives and bus add is not set
  Pose flange;                ///< the last link's frame, in the last moving link's
};

/// Visual, collision, safety and calibration elements are ignored.
[[nodiscard]] UrdfChain read_urdf(const std::filesystem::path& file);

}  // namespace tenon::config
