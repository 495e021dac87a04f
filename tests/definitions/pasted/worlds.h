#pragma once

#include <ductile/joint.h>

#include <string>
#include <utility>
#include <vector>

namespace pasted {

struct Level {
  ductile::Structure structure;
  std::vector<std::pair<std::string, b2Body*>> bodies;
  std::vector<std::pair<std::string, ductile::ElasticPlasticJoint*>> joints;
  std::vector<std::pair<std::string, b2WheelJoint*>> motors;
};

Level car(b2World& world);
Level harbour_crane(b2World& world);
Level crane_winch(b2World& world);

}  // namespace pasted
