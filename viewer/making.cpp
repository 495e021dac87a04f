#include "making.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "pins.h"

namespace ductile::viewer {
namespace {

/// What can be held, loaded or pulled at a point.
const BodyDef* moving_at(const SceneDef& scene, Point at) {
  const BodyDef* body = body_at(scene, at);
  return body && body->type == BodyType::dynamic_body ? body : nullptr;
}

std::string need(const BodyDef* body, const std::string& what, const std::string& remedy) {
  if (body) return body->name;
  throw InvalidInput({{what, "there is nothing here that could be held or pulled", remedy}});
}

std::string need_moving(const SceneDef& scene, Point at, const std::string& what) {
  return need(moving_at(scene, at), what,
              "put it on the axis of a beam, at its end, or on a body that moves");
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

std::vector<Point> nodes(const SceneDef& scene) {
  std::vector<Point> all;
  for (const BodyDef& body : scene.bodies) {
    if (const auto axis = axis_of(body)) all.insert(all.end(), {axis->from, axis->to});
  }
  for (const JointBetweenDef& joint : scene.joints) {
    if (joint.at) all.push_back(*joint.at);
    if (joint.line) all.insert(all.end(), joint.line->begin(), joint.line->end());
  }
  for (const SupportDef& support : scene.supports) all.push_back(support.at);
  for (const LoadDef& load : scene.loads) all.push_back(load.at);
  // Points of one node are close to each other in x, and then in y.
  std::sort(all.begin(), all.end(), [](Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Point> once;
  std::size_t near = 0;  // the first of `once` that may be the same as the next
  for (const Point p : all) {
    while (near < once.size() && once[near].x < p.x - node_size) ++near;
    const auto close = once.begin() + static_cast<std::ptrdiff_t>(near);
    if (std::none_of(close, once.end(), [p](Point q) { return is_same(p, q); })) once.push_back(p);
  }
  return once;
}

std::string unused_name(const SceneDef& scene, std::string stem) {
  while (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem.pop_back();
  for (int number = 1;; ++number) {
    std::string name = stem + std::to_string(number);
    if (!body_named(scene, name)) return name;
  }
}

SceneDef with_beam(SceneDef scene, const Axis& axis, const BeamStyle& style) {
  BodyDef beam;
  beam.name = unused_name(scene, "beam");
  beam.group = -1;  // beams of one structure overlap where they meet
  lay(beam, axis, style);
  scene.bodies.push_back(std::move(beam));
  pin(scene, axis.from);
  pin(scene, axis.to);
  return scene;
}

SceneDef with_block(SceneDef scene, const Ring& corners, const BlockStyle& style) {
  BodyDef block;
  block.name = unused_name(scene, "block");
  block.outline.outer = corners;
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += cross(corners[i], corners[(i + 1) % corners.size()]);
  if (area < 0) std::reverse(block.outline.outer.begin(), block.outline.outer.end());
  block.depth = style.depth;
  block.price = style.fixed ? 0 : style.price;
  block.material = style.material;
  if (style.fixed) block.type = BodyType::static_body;
  scene.bodies.push_back(block);
  if (!style.fixed) return scene;
  for (const Point node : nodes(scene)) {
    if (covers(block, node)) pin(scene, node);
  }
  return scene;
}

SceneDef with_line(SceneDef scene, const Axis& axis, const LineStyle& style) {
  JointBetweenDef joint;
  const std::string remedy = "begin and end it on beams, bodies or the ground";
  joint.a = need(body_at(scene, axis.from), "line", remedy);
  joint.b = need(body_at(scene, axis.to), "line", remedy);
  if (joint.a == joint.b) throw InvalidInput({{"line", "begins and ends on one body", remedy}});
  joint.line = {axis.from, axis.to};
  using Kind = LineStyle::Kind;
  const bool winch = style.kind == Kind::winch;
  joint.carries = style.kind == Kind::rope || winch ? Carries::tension
                  : style.kind == Kind::strut       ? Carries::compression
                                                    : Carries::both;
  if (style.kind == Kind::spring) joint.overrides.stiffness_axial = style.stiffness;
  if (style.kind == Kind::jack || winch) {
    const double length = axis.length() + style.stroke;
    if (!(length > 0))
      throw InvalidInput(
          {{winch ? "winch" : "jack", "shortens to nothing", "draw it longer than its stroke"}});
    joint.drive = DriveDef{.row = axial, .position = length, .speed = style.speed, .cap = style.force};
  }
  scene.joints.push_back(std::move(joint));
  return scene;
}

SceneDef with_cut(SceneDef scene, const Axis& across) {
  const std::string name = need_moving(scene, 0.5 * (across.from + across.to), "cut");
  BodyDef& body = *std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                [&](const BodyDef& other) { return other.name == name; });
  const auto local = [&](Point p) { return Rotation(body.angle).inverse(p - body.at); };
  body.pieces = 1;
  body.automatic = false;
  body.cuts.push_back({local(across.from), local(across.to)});
  // In the order of the pieces that they leave.
  const Point size = bounds_of(body.outline.outer).size();
  const auto along = [&](const std::array<Point, 2>& cut) {
    const Point middle = 0.5 * (cut[0] + cut[1]);
    return size.x < size.y ? middle.y : middle.x;
  };
  std::sort(body.cuts.begin(), body.cuts.end(),
            [&](const auto& a, const auto& b) { return along(a) < along(b); });
  return scene;
}

SceneDef with_next_support(SceneDef scene, Point at, double stiffness) {
  const auto old = std::find_if(scene.supports.begin(), scene.supports.end(),
                                [&](const SupportDef& s) { return is_same(s.at, at); });
  if (old == scene.supports.end()) {
    SupportDef hinge;
    hinge.body = need_moving(scene, at, "support");
    hinge.at = at;
    hinge.fix_x = hinge.fix_y = true;
    scene.supports.push_back(std::move(hinge));
  } else if (old->fix_angle) {
    old->fix_x = old->fix_y = old->fix_angle = false;
    old->stiffness_x = old->stiffness_y = stiffness;
  } else if (old->fix_x) {
    old->fix_x = false;
  } else if (old->fix_y) {
    old->fix_x = old->fix_angle = true;
  } else {
    scene.supports.erase(old);
  }
  return scene;
}

Point LoadStyle::vector() const {
  Point along = Rotation(direction * std::numbers::pi / 180) * Point{1, 0};
  for (double* component : {&along.x, &along.y})
    if (std::abs(*component) < 1e-12) *component = 0;  // straight down is that
  return force * along;
}

SceneDef with_load(SceneDef scene, Point at, Point force, double ramp) {
  bool same = force.x == 0 && force.y == 0;
  std::erase_if(scene.loads, [&](const LoadDef& l) {
    if (!is_same(l.at, at)) return false;
    same |= l.force == force && l.ramp == ramp;
    return true;
  });
  if (same) return scene;
  LoadDef load;
  load.body = need_moving(scene, at, "load");
  load.at = at;
  load.force = force;
  load.ramp = ramp;
  scene.loads.push_back(std::move(load));
  return scene;
}

SceneDef with_style(SceneDef scene, const std::string& beam, const BeamStyle& style) {
  const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const BodyDef& b) { return b.name == beam; });
  const auto axis = body == scene.bodies.end() ? std::nullopt : axis_of(*body);
  if (!axis) throw InvalidInput({{"body '" + beam + "'", "is no beam", "choose one"}});
  lay(*body, *axis, style);
  return scene;
}

SceneDef without_body(SceneDef scene, const std::string& name) {
  std::erase_if(scene.bodies, [&](const BodyDef& body) { return body.name == name; });
  // What another body is there to carry stays.
  const auto gone = [&](auto& of) {
    if (of.body != name) return false;
    const BodyDef* other = moving_at(scene, of.at);
    if (other) of.body = other->name;
    return other == nullptr;
  };
  std::erase_if(scene.supports, gone);
  std::erase_if(scene.loads, gone);
  std::erase_if(scene.wheels, [&](const WheelDef& w) { return w.chassis == name || w.wheel == name; });
  std::erase_if(scene.joints, [&](JointBetweenDef& joint) {
    std::vector<std::string> left = joint.bodies();
    if (std::erase(left, name) == 0) return false;
    if (joint.line) {
      const bool first = joint.a == name;
      std::string& end = first ? joint.a : joint.b;
      const BodyDef* other = moving_at(scene, (*joint.line)[first ? 0 : 1]);
      if (!other || other->name == (first ? joint.b : joint.a)) return true;
      end = other->name;
      return false;
    }
    if (left.size() < 2) return true;
    set_bodies(joint, left);
    return false;
  });
  return scene;
}

SceneDef without(SceneDef scene, Point at) {
  const auto here = [&](const auto& of) { return is_same(of.at, at); };
  if (std::erase_if(scene.loads, here) > 0 || std::erase_if(scene.supports, here) > 0) return scene;
  const auto line = [&](bool ends) {
    const auto found =
        std::find_if(scene.joints.begin(), scene.joints.end(), [&](const JointBetweenDef& joint) {
          if (!joint.line) return false;
          const Axis axis{(*joint.line)[0], (*joint.line)[1]};
          return axis.distance(at) < node_size && axis.ends_at(at) == ends;
        });
    if (found == scene.joints.end()) return false;
    scene.joints.erase(found);
    return true;
  };
  if (line(false)) return scene;
  if (const BodyDef* body = body_at(scene, at)) {
    const std::string name = body->name;
    return without_body(std::move(scene), name);
  }
  if (line(true)) return scene;
  throw InvalidInput({{"delete", "there is nothing here", "put the cursor on what is to go"}});
}

}  // namespace ductile::viewer
