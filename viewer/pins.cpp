#include "pins.h"

#include <algorithm>
#include <utility>

#include "beam.h"
#include "making.h"

namespace ductile::viewer {

void set_bodies(JointBetweenDef& joint, const std::vector<std::string>& names) {
  joint.a = names[0];
  joint.b = names[1];
  joint.others.assign(names.begin() + 2, names.end());
}

void pin(SceneDef& scene, Point at) {
  JointBetweenDef joint;
  std::vector<std::string> held;
  std::erase_if(scene.joints, [&](const JointBetweenDef& old) {
    if (!old.at || !is_same(*old.at, at)) return false;
    if (held.empty()) joint = old;
    for (const std::string& name : old.bodies()) held.push_back(name);
    return true;
  });
  std::vector<std::string> names;
  bool is_end = false;
  for (const bool fixed : {true, false}) {  // the first is the hub
    for (const BodyDef& body : scene.bodies) {
      if ((body.type == BodyType::static_body) != fixed) continue;
      const bool was = !axis_of(body) && std::count(held.begin(), held.end(), body.name) > 0;
      if (was || (fixed && covers(body, at)) || passes(body, at)) names.push_back(body.name);
      is_end |= was || ends_at(body, at);
    }
  }
  if (names.size() < 2 || !is_end) return;
  joint.at = at;
  set_bodies(joint, names);
  scene.joints.push_back(std::move(joint));
}

SceneDef with_weld_or_pin(SceneDef scene, Point at) {
  for (JointBetweenDef& joint : scene.joints) {
    if (!joint.at || !is_same(*joint.at, at)) continue;
    // A weld outlasts the beams, which yield beside it.
    std::optional<double>& moment = joint.overrides.moment;
    moment = moment || joint.welded ? std::nullopt : std::optional(unlimited);
    joint.overrides.moment_reverse.reset();
    joint.welded = false;
    return scene;
  }
  std::vector<std::string> touching;
  bool moves = false;
  for (const BodyDef& body : scene.bodies) {
    if (!covers(body, at)) continue;
    touching.push_back(body.name);
    moves |= body.type == BodyType::dynamic_body;
  }
  if (touching.size() != 2 || !moves)
    throw InvalidInput({{"node", "nothing is pinned here, and no two bodies touch",
                         "put it where beams meet, or on the edge that two bodies share"}});
  const auto is_same_pair = [&](const JointBetweenDef& joint) {
    return !joint.at && !joint.line && joint.others.empty() &&
           ((joint.a == touching[0] && joint.b == touching[1]) ||
            (joint.a == touching[1] && joint.b == touching[0]));
  };
  if (std::erase_if(scene.joints, is_same_pair) > 0) return scene;
  JointBetweenDef joint;
  joint.a = touching[0];
  joint.b = touching[1];
  scene.joints.push_back(std::move(joint));
  return scene;
}

}  // namespace ductile::viewer
