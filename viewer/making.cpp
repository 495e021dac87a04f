#include "making.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ductile::viewer {
namespace {

bool is(Point a, Point b) { return length(a - b) < node_size; }

/// Distance of a point from a segment.
double distance(const Axis& axis, Point p) {
  const Point d = axis.to - axis.from;
  const double t = std::clamp(dot(p - axis.from, d) / dot(d, d), 0., 1.);
  return length(p - axis.from - t * d);
}

/// Whether a static body covers a point or has it on its edge.
bool covers(const BodyDef& body, Point p) {
  const Point local = Turn(body.angle).back(p - body.at);
  if (body.circle > 0) return length(local) <= body.circle + node_size;
  const Ring& ring = body.outline.outer;
  bool inside = false;
  for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
    const Point a = ring[last], b = ring[i];
    if (distance({a, b}, local) < node_size) return true;
    if ((a.y > local.y) != (b.y > local.y) && local.x < a.x + (local.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
      inside = !inside;
    }
  }
  return inside;
}

bool ends_at(const BodyDef& body, Point at) {
  const auto axis = axis_of(body);
  return axis && (is(axis->from, at) || is(axis->to, at));
}

bool passes(const BodyDef& body, Point at) {
  const auto axis = axis_of(body);
  return axis && distance(*axis, at) < node_size;
}

/// The beam at a point, one that ends there if there is one; else null.
const BodyDef* find_beam(const SceneDef& scene, Point at) {
  for (const auto there : {ends_at, passes}) {
    for (const BodyDef& body : scene.bodies) {
      if (there(body, at)) return &body;
    }
  }
  return nullptr;
}

std::string beam_at(const SceneDef& scene, Point at, const std::string& what) {
  if (const BodyDef* beam = find_beam(scene, at)) return beam->name;
  throw InvalidInput({{what, "there is no beam here", "put it on the axis of a beam, or at its end"}});
}

std::vector<std::string> bodies_of(const JointBetweenDef& joint) {
  std::vector<std::string> names{joint.a, joint.b};
  names.insert(names.end(), joint.others.begin(), joint.others.end());
  return names;
}

void set_bodies(JointBetweenDef& joint, const std::vector<std::string>& names) {
  joint.a = names[0];
  joint.b = names[1];
  joint.others.assign(names.begin() + 2, names.end());
}

/// The pin at a point as it is to be: of the static bodies and the beams there, and of what else it held
/// before. Beams that cross pass each other where none ends.
void pin(SceneDef& scene, Point at) {
  const auto old = std::find_if(scene.joints.begin(), scene.joints.end(),
                                [&](const JointBetweenDef& j) { return j.at && is(*j.at, at); });
  JointBetweenDef joint;
  std::vector<std::string> held;
  if (old != scene.joints.end()) {
    joint = *old;
    held = bodies_of(joint);
    scene.joints.erase(old);
  }
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

std::string unused_name(const SceneDef& scene) {
  for (int number = 1;; ++number) {
    std::string name = "beam" + std::to_string(number);
    const auto has = [&](const BodyDef& body) { return body.name == name; };
    if (std::none_of(scene.bodies.begin(), scene.bodies.end(), has)) return name;
  }
}

/// Half the height of a beam, m.
double half_height(const BodyDef& beam) { return beam.outline.outer[2].y; }

void lay(BodyDef& beam, const Axis& axis, double half) {
  const double span = length(axis.to - axis.from);
  if (!(span > 2 * half)) {
    throw InvalidInput({{"body '" + beam.name + "'", "is no longer than it is high", "draw it longer"}});
  }
  beam.outline.outer = {{0, -half}, {span, -half}, {span, half}, {0, half}};
  beam.at = axis.from;
  beam.angle = std::atan2(axis.to.y - axis.from.y, axis.to.x - axis.from.x);
}

}  // namespace

SceneDef empty_scene() {
  SceneDef scene;
  BodyDef floor;
  floor.name = "floor";
  floor.type = BodyType::static_body;
  floor.outline.outer = {{-10, -1}, {10, -1}, {10, 0}, {-10, 0}};
  scene.bodies = {floor};
  return scene;
}

std::optional<Axis> axis_of(const BodyDef& body) {
  const Ring& ring = body.outline.outer;
  if (body.type != BodyType::dynamic_body || body.circle > 0 || ring.size() != 4 ||
      !body.outline.holes.empty())
    return std::nullopt;
  const double span = ring[1].x, half = ring[2].y;
  const Ring beam{{0, -half}, {span, -half}, {span, half}, {0, half}};
  if (!(half > 0 && span > 0) || !std::equal(ring.begin(), ring.end(), beam.begin(), is)) return std::nullopt;
  return Axis{body.at, body.at + Turn(body.angle) * Point{span, 0}};
}

std::vector<Point> nodes(const SceneDef& scene) {
  std::vector<Point> all;
  const auto add = [&](Point p) {
    if (std::none_of(all.begin(), all.end(), [p](Point q) { return is(p, q); })) all.push_back(p);
  };
  for (const BodyDef& body : scene.bodies) {
    if (const auto axis = axis_of(body)) {
      add(axis->from);
      add(axis->to);
    }
  }
  for (const JointBetweenDef& joint : scene.joints) {
    if (joint.at) add(*joint.at);
  }
  for (const SupportDef& support : scene.supports) add(support.at);
  for (const LoadDef& load : scene.loads) add(load.at);
  return all;
}

SceneDef with_beam(SceneDef scene, const Axis& axis, const BeamStyle& style) {
  BodyDef beam;
  beam.name = unused_name(scene);
  beam.material = style.material;
  beam.depth = style.depth;
  beam.pieces = style.pieces;
  beam.group = -1;  // beams of one structure overlap where they meet
  lay(beam, axis, style.height / 2);
  scene.bodies.push_back(std::move(beam));
  pin(scene, axis.from);
  pin(scene, axis.to);
  return scene;
}

SceneDef with_next_support(SceneDef scene, Point at) {
  const auto old = std::find_if(scene.supports.begin(), scene.supports.end(),
                                [&](const SupportDef& s) { return is(s.at, at); });
  if (old == scene.supports.end()) {
    SupportDef hinge;
    hinge.body = beam_at(scene, at, "support");
    hinge.at = at;
    hinge.fix_x = hinge.fix_y = true;
    scene.supports.push_back(std::move(hinge));
  } else if (old->fix_angle) {
    scene.supports.erase(old);
  } else if (old->fix_x) {
    old->fix_x = false;
  } else {
    old->fix_x = old->fix_angle = true;
  }
  return scene;
}

SceneDef with_load(SceneDef scene, Point at, Point force) {
  std::erase_if(scene.loads, [&](const LoadDef& l) { return is(l.at, at); });
  if (force.x == 0 && force.y == 0) return scene;
  LoadDef load;
  load.body = beam_at(scene, at, "load");
  load.at = at;
  load.force = force;
  scene.loads.push_back(std::move(load));
  return scene;
}

SceneDef with_node_moved(SceneDef scene, Point from, Point to) {
  bool any = false;
  for (BodyDef& body : scene.bodies) {
    if (!ends_at(body, from)) continue;
    any = true;
    const Axis old = *axis_of(body);
    const Axis moved{is(old.from, from) ? to : old.from, is(old.to, from) ? to : old.to};
    lay(body, moved, half_height(body));
    // What holds or loads the beam stays where it is along it.
    const auto carry = [&](auto& of) {
      if (of.body != body.name || distance(old, of.at) >= node_size) return;
      const double share = length(of.at - old.from) / length(old.to - old.from);
      of.at = is(of.at, from)                            ? to
              : is(of.at, old.from) || is(of.at, old.to) ? of.at
                                                         : moved.from + share * (moved.to - moved.from);
    };
    std::for_each(scene.supports.begin(), scene.supports.end(), carry);
    std::for_each(scene.loads.begin(), scene.loads.end(), carry);
  }
  if (!any) throw InvalidInput({{"move", "no beam ends here", "drag the end of a beam"}});
  std::vector<Point> pins{to};
  for (const JointBetweenDef& joint : scene.joints) {
    if (joint.at) pins.push_back(*joint.at);
  }
  for (const Point at : pins) pin(scene, at);
  return scene;
}

SceneDef without_body(SceneDef scene, const std::string& name) {
  std::erase_if(scene.bodies, [&](const BodyDef& body) { return body.name == name; });
  // What another beam is there to carry stays.
  const auto gone = [&](auto& of) {
    if (of.body != name) return false;
    const BodyDef* other = find_beam(scene, of.at);
    if (other) of.body = other->name;
    return other == nullptr;
  };
  std::erase_if(scene.supports, gone);
  std::erase_if(scene.loads, gone);
  std::erase_if(scene.wheels, [&](const WheelDef& w) { return w.chassis == name || w.wheel == name; });
  std::erase_if(scene.joints, [&](JointBetweenDef& joint) {
    std::vector<std::string> left = bodies_of(joint);
    if (std::erase(left, name) == 0) return false;
    if (left.size() < 2) return true;
    set_bodies(joint, left);
    return false;
  });
  return scene;
}

SceneDef without(SceneDef scene, Point at) {
  if (std::erase_if(scene.loads, [&](const LoadDef& l) { return is(l.at, at); }) > 0) return scene;
  if (std::erase_if(scene.supports, [&](const SupportDef& s) { return is(s.at, at); }) > 0) return scene;
  const std::string name = beam_at(scene, at, "delete");
  return without_body(std::move(scene), name);
}

}  // namespace ductile::viewer
