#pragma once
// What contact generation knows of a shape: how far any point is from its surface, and where its
// own surface is to be looked at. Private to sim; pure.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "shared/geometry/nearest_cells.h"
#include "shared/math/pose.h"
#include "shared/task/task.h"
#include "sim/physics/surfaces/mesh_distances.h"

namespace tenon::sim {

/// A closed surface in a frame of its own. Two of them meet where an outward edge of one is on the
/// other: what is sampled are the edges, straight and in pieces.
class Surface {
 public:
  virtual ~Surface() = default;

  struct Place {
    double distance_m = 0.0;  ///< negative inside
    Vector3 outwards;         ///< the gradient, a unit vector
    Vector3 nearest_m;        ///< on the surface
    std::uint32_t guess = 0;  ///< for a place nearby
  };
  /// The same numbers whatever the guess.
  [[nodiscard]] virtual Place place(const Vector3& point_m, std::uint32_t guess) const = 0;

  /// What is kept of a point that moves little from place to place, so that the next costs less.
  struct Track {
    std::uint32_t guess = 0;
    NearestCells::Known near;
  };
  /// The same numbers whatever is kept.
  [[nodiscard]] virtual Place next_place(const Vector3& point_m, Track& track) const {
    return place(point_m, track.guess);
  }

  /// Whether distances are true to the last bits, so that what touches is at none.
  [[nodiscard]] virtual bool exact() const { return true; }

  /// Where a place costs much: no more than its distance, for much less. Empty: ask for the place.
  [[nodiscard]] virtual std::optional<double> distance_at_least_m(
      const Vector3& /*point_m*/) const {
    return std::nullopt;
  }

  struct Piece {
    std::uint32_t from = 0;  ///< indices of points
    std::uint32_t to = 0;
  };
  [[nodiscard]] const std::vector<Vector3>& points_m() const { return points_m_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// Of a piece: as Solid::Edge::inwards.
  [[nodiscard]] const Vector3& inwards(std::uint32_t piece) const { return inwards_[piece]; }

  /// Whether no edge at the point leads farther along a direction, a unit vector: what is pressed
  /// that way touches there, and not beside.
  [[nodiscard]] bool foremost(std::uint32_t point, const Vector3& way) const;

  /// A ball around some pieces: those from first to first + count in order(), and two balls within
  /// it unless it is a leaf.
  struct Ball {
    Vector3 centre_m;
    double radius_m = 0.0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t child = 0;  ///< and the next; 0: none
  };
  [[nodiscard]] const std::vector<Ball>& balls() const { return balls_; }
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

 protected:
  Surface() = default;
  Surface(const Surface&) = default;
  Surface& operator=(const Surface&) = default;

  /// Cuts edges into pieces no longer than this, and puts balls around them.
  struct Edge {
    Vector3 from_m;
    Vector3 to_m;
    Vector3 inwards;
  };
  void sample(const std::vector<Edge>& edges, double piece_max_m);

 private:
  void split(std::size_t ball);

  std::vector<Vector3> points_m_;
  std::vector<Piece> pieces_;
  std::vector<Vector3> inwards_;               ///< of the pieces
  std::vector<std::vector<Vector3>> leading_;  ///< directions of the pieces at each point
  std::vector<Ball> balls_;
  std::vector<std::uint32_t> order_;
};

/// Of a shape as drawn, in the frame of its centre.
[[nodiscard]] std::shared_ptr<const Surface> surface_of(const Shape& shape,
                                                        MeshDistances distances);

}  // namespace tenon::sim
