// A part of a scene that is put elsewhere or once more: copied, pasted, mirrored, turned. Knows neither
// window nor pointer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/plane.h"

namespace ductile::viewer {

/// Around bodies as placed: of beams, around their axes.
Bounds box_of(const std::vector<BodyDef>& bodies);
/// The bodies, beams and others, that lie in a box wholly.
std::vector<std::string> bodies_in(const SceneDef& scene, const Bounds& box);

/// Those bodies, and all that are of an assembly with one of them.
std::vector<std::string> with_assemblies(const SceneDef& scene, std::vector<std::string> names);
/// Those bodies are an assembly, and of no other any more.
SceneDef with_assembly(SceneDef scene, const std::vector<std::string>& names);
/// Assemblies of which one of those bodies is a part are none any more.
SceneDef without_assemblies(SceneDef scene, const std::vector<std::string>& names);

/// Bodies of those names, with what holds and loads them and what joins them to each other.
SceneDef part_of(const SceneDef& scene, const std::vector<std::string>& names);
/// The point by which a part is taken: its lowest node, of several the leftmost; without nodes, the lower
/// left of its bodies.
Point grip_of(const SceneDef& part);
/// The part moved.
SceneDef shifted(SceneDef part, Point by);
/// The part as a mirror upright at x shows it.
SceneDef mirrored(SceneDef part, double x);
/// The part turned by an angle, rad, counter-clockwise, with what holds and loads it. Throws InvalidInput
/// where a support that does not hold x and y alike would have to hold along neither of them.
SceneDef turned(SceneDef part, Point about, double angle);

/// A scene with a part more, pinned where its beams meet others; the names of what has been added, which are
/// its own where nothing else has them. A beam, a support, a load or a line that would lie on one that is
/// there, as in the midst of a mirror, is that one.
struct Joined {
  SceneDef scene;
  std::vector<std::string> added;
};
Joined with_part(SceneDef scene, SceneDef part);

}  // namespace ductile::viewer
