#pragma once

#include <ductile/joint.h>

namespace pasted {
ductile::Structure car(b2World& world);
ductile::Structure harbour_crane(b2World& world);
}  // namespace pasted
