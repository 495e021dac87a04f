// Diagrams of what pieces carry, drawn on their lines.
#pragma once

#include "artist.h"
#include "labels.h"

namespace ductile::picture {

/// Of Panel::diagram: the ordinates of every strip, and each body's largest and smallest.
void draw_diagram(Node to, const Plan& plan, const Panel& panel, const Frame& frame, Labels& labels);

}  // namespace ductile::picture
