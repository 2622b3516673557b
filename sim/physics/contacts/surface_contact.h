#pragma once
// Where two surfaces of any kind touch, from exact distances. Private to sim; one thread.

#include <ode/ode.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "sim/physics/surfaces/surface.h"

namespace tenon::sim {

/// The edges of either surface against the other. Remembers which of their pieces are near, and how
/// far the two may still move before a piece has to be looked at again: what it finds is the same
/// as if it looked at everything.
class SurfaceContact {
 public:
  SurfaceContact(const Surface& held, const Surface& environment);

  /// How the two stand now.
  struct Stand {
    Pose X_WH;  ///< in the world
    Pose X_WE;
    double offset_m = 0.0;  ///< by this much both surfaces together stand out farther than drawn
    double moved_m = 0.0;   ///< no point has moved farther, since forget(), against the other
  };
  /// Appends the points that touch; normals are towards the held one, `g1` and `g2` are left open.
  /// @param enough_m where something is deeper, the rest need not be found
  /// @return a gap, m: nothing touches before the two have moved so far; 0 where something does
  double find(const Stand& stand, std::vector<dContactGeom>& points,
              double enough_m = std::numeric_limits<double>::infinity());

  /// How deep the two are in each other at edges that lie on each other's surface, as those of
  /// faces side by side do, which tell no depth (common_depth.h); nothing that is remembered has a
  /// part in it. @param known_m of their depth, which is returned where no such edge tells more
  /// @param enough_m where one tells more, the others are not looked at  @return m
  [[nodiscard]] double common_depth_m(const Stand& stand, double known_m, double enough_m) const;

  /// The two may have moved anywhere.
  void forget();

 private:
  /// One surface's edges against the other surface.
  struct Side {
    const Surface* edges = nullptr;
    const Surface* surface = nullptr;
    std::vector<std::uint32_t> near;    ///< pieces
    double complete_until_m = 0.0;      ///< what is not in `near` touches nothing before
    std::vector<double> apart_until_m;  ///< of every piece: not to be looked at before
    /// Of every piece: what its distance is no less than was not too little the last time. What
    /// touches, touches on: asking had been in vain 199 times of 200.
    std::vector<bool> at_least_tells;
    /// What is known of a ball around pieces.
    struct Ball {
      double far_until_m = 0.0;   ///< what is in it touches nothing before
      double near_until_m = 0.0;  ///< it may, all that time
      std::uint32_t guess = 0;
    };
    std::vector<Ball> balls;
    struct Point {
      Surface::Place place;  ///< in the surface's frame
      Surface::Track track;
      std::uint64_t time = 0;           ///< when it was
      double at_least_m = 0.0;          ///< of its distance
      std::uint64_t at_least_time = 0;  ///< likewise
    };
    std::vector<Point> points;          ///< of the edges
    std::optional<std::uint32_t> deep;  ///< the piece that was last as deep as was asked for
  };
  /// The edges of a side in the frame of its surface.
  [[nodiscard]] Pose edges_in_surface(const Side& side, const Stand& stand) const;
  void gather(Side& side, const Pose& X_SE, const Stand& stand);
  const Surface::Place& place(Side& side, std::uint32_t point, const Pose& X_SE) const;
  /// What a piece's distance is no less than, m; of its ends and its middle alone, so that it may
  /// be little. Empty where only places tell.
  std::optional<double> distance_at_least_m(Side& side, std::uint32_t piece,
                                            const Pose& X_SE) const;
  /// Whether a piece is. It looks at nothing else, and finds its points anew.
  bool deeper(Side& side, std::uint32_t piece, const Stand& stand, double enough_m);
  /// @return a gap, m
  double look_at(Side& side, std::uint32_t piece, const Pose& X_SE, const Stand& stand);

  /// Of one side's pieces.
  [[nodiscard]] static double common_depth_m(const Side& side, const Pose& X_SE, double offset_m,
                                             double known_m, double enough_m);

  /// In the frame of the surface that is touched.
  struct Found {
    Vector3 at_m;
    Vector3 outwards;
    double depth_m = 0.0;
    bool held = false;      ///< an edge of the held one touches the environment
    bool foremost = false;  ///< where it is pressed against the surface, not beside
  };
  /// A piece on a face that its body goes into: beside that face it may be in another.
  struct Beside {
    bool held = false;
    std::uint32_t piece = 0;
    Vector3 outwards;  ///< of that face
  };
  /// Keeps a piece that is such. @param at one of its ends
  void note_beside(const Side& side, std::uint32_t piece, const Pose& X_SE,
                   const Surface::Place& at);
  /// Which ways what was found pushes a side's edges, in the frame of its surface, each once.
  [[nodiscard]] std::vector<Vector3> ways_apart(const Side& side, const Pose& X_SE) const;
  /// Where nothing else was found that holds the two apart across such a piece: the faces that do.
  void look_beside(const Stand& stand);
  void add(const Found& found, const Stand& stand, std::vector<dContactGeom>& points) const;
  /// Where an edge that lies on a face passes the face's rim, it is nearer to the side than to the
  /// face, and would be pushed off: what is not foremost counts only where it is deeper than all
  /// that is.
  void choose(const Stand& stand, std::vector<dContactGeom>& points) const;

  Side held_;
  Side environment_;
  bool exact_;  ///< the distances of both; others say of nothing that it is flush
  std::uint64_t time_ = 0;
  std::vector<Found> found_;
  std::vector<Beside> beside_;
};

}  // namespace tenon::sim
