// What the window takes from the geometry of the plane.
#pragma once

#include "ductile/plane.h"

namespace ductile::viewer {

using Box = Bounds;

}  // namespace ductile::viewer
