#pragma once
// What a page shows of a body of triangles: its shadow, and where a plane cuts it. Pure; any
// thread.

#include <vector>

#include "shared/drawing/view.h"
#include "shared/geometry/solid.h"
#include "shared/math/pose.h"

namespace tenon::drawing {

/// Closed lines on the page, m, to be filled together.
using Loops = std::vector<std::vector<Point>>;

/// The rim of the faces that look at the reader. Filled by the rule "nonzero" it is the body's
/// shadow, through holes left out. @param pose of the solid
[[nodiscard]] Loops shadow_of(const Solid& solid, const Pose& pose, const View& view);

/// Where the plane across the view at a depth (along `view.along`) cuts the body; none where it
/// does not. To be filled by the rule "evenodd".
[[nodiscard]] Loops section_of(const Solid& solid, const Pose& pose, const View& view,
                               double depth_m);

}  // namespace tenon::drawing
