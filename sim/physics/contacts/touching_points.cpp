#include "sim/physics/contacts/touching_points.h"

namespace tenon::sim {

std::span<const dContactGeom> touching_points(const ShapeGeometry& held,
                                              const ShapeGeometry& environment, PairPoints& found) {
  const int count = dCollide(held.id(), environment.id(), static_cast<int>(kPointsAPair),
                             found.data(), sizeof(dContactGeom));
  return {found.data(), static_cast<std::size_t>(count)};
}

}  // namespace tenon::sim
