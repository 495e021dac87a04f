// A scene as a user makes it.
#pragma once

#include "making.h"

namespace ductile::viewer {

/// Two posts on the floor that carry a beam of 4 m, all pinned.
inline SceneDef gate() {
  const BeamStyle style;
  SceneDef scene = with_beam(empty_scene(), {{-2, 0}, {-2, 3}}, style);
  scene = with_beam(scene, {{2, 0}, {2, 3}}, style);
  return with_beam(scene, {{-2, 3}, {2, 3}}, style);
}

}  // namespace ductile::viewer
