// A game that pasted what `ductile calibrate --to cpp` wrote.
#include "worlds.h"

#include "pasted/car.h"
#include "pasted/harbour_crane.h"

namespace pasted {
ductile::Structure car(b2World& world) { return build_car(world); }
ductile::Structure harbour_crane(b2World& world) { return build_harbour_crane(world); }
}  // namespace pasted
