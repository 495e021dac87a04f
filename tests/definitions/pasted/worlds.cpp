// A game that pasted what `ductile calibrate --to cpp` wrote.
#include "worlds.h"

#include "pasted/car.h"
#include "pasted/crane_winch.h"
#include "pasted/harbour_crane.h"

namespace pasted {
namespace {
template <class Made>
Level level(Made made) {
  return {std::move(made.structure), std::move(made.bodies), std::move(made.joints), std::move(made.motors)};
}
}  // namespace

Level car(b2World& world) { return level(build_car(world)); }
Level harbour_crane(b2World& world) { return level(build_harbour_crane(world)); }
Level crane_winch(b2World& world) { return level(build_crane_winch(world)); }
}  // namespace pasted
