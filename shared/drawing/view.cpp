#include "shared/drawing/view.h"

namespace tenon::drawing {

std::vector<View> views_of(CoordinateMask coordinates) {
  const View above{0, 1, 2, "Seen from above"};
  const View side{0, 2, 1, "Seen from the side, along y"};
  const View front{1, 2, 0, "Seen from the front, along x"};
  if (!has(coordinates, 2)) return {above};
  if (!has(coordinates, 1)) return {side};
  if (!has(coordinates, 0)) return {front};
  return {above, side};
}

}  // namespace tenon::drawing
