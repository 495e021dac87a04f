#include "part.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "making.h"
#include "pins.h"

namespace ductile::viewer {
namespace {

Bounds box_of(const BodyDef& body) {
  Bounds box;
  if (const auto axis = axis_of(body)) {
    box.add(axis->from);
    box.add(axis->to);
  } else if (body.circle > 0) {
    box.add(body.at - Point{body.circle, body.circle});
    box.add(body.at + Point{body.circle, body.circle});
  } else {
    for (const Point p : body.outline.outer) box.add(body.at + Rotation(body.angle) * p);
  }
  return box;
}

/// A name that no assembly has: that one, or its stem with the next number.
std::string unused_assembly(const SceneDef& scene, std::string name) {
  const auto is_used = [&](const std::string& one) {
    return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                       [&](const BodyDef& body) { return body.assembly == one; });
  };
  if (!is_used(name)) return name;
  while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.pop_back();
  int number = 1;
  while (is_used(name + std::to_string(number))) ++number;
  return name + std::to_string(number);
}

/// Every point of a part that is not of a body's own outline, in world axes.
template <class F>
void each_point(SceneDef& part, const F& f) {
  for (BodyDef& body : part.bodies) f(body.at);
  for (SupportDef& support : part.supports) f(support.at);
  for (LoadDef& load : part.loads) f(load.at);
  for (WheelDef& wheel : part.wheels) f(wheel.at);
  for (JointBetweenDef& joint : part.joints) {
    if (joint.at) f(*joint.at);
    for (auto* ends : {&joint.across, &joint.line}) {
      if (*ends) std::for_each((*ends)->begin(), (*ends)->end(), f);
    }
  }
}

// A body's own axes are mirrored too: x to −x, and what was in order along x is in the order against it.
void mirror(BodyDef& body) {
  const auto flip = [](Point& p) { p.x = -p.x; };
  const auto flip_ring = [&](Ring& ring) {
    std::for_each(ring.begin(), ring.end(), flip);
    std::reverse(ring.begin(), ring.end());
  };
  flip_ring(body.outline.outer);
  std::for_each(body.outline.holes.begin(), body.outline.holes.end(), flip_ring);
  const auto turn_round = [&](std::array<Point, 2>& line) {
    std::for_each(line.begin(), line.end(), flip);
    std::swap(line[0], line[1]);
  };
  if (body.along[0] != body.along[1]) turn_round(body.along);
  for (auto& cut : body.cuts) turn_round(cut);
  std::reverse(body.cuts.begin(), body.cuts.end());
  flip(body.velocity);
  std::for_each(body.velocities.begin(), body.velocities.end(), flip);
  std::reverse(body.velocities.begin(), body.velocities.end());
  body.angle = -body.angle;
  body.angular_velocity = -body.angular_velocity;
}

/// A mirrored beam of that length has its origin at its other end, so that it is a beam again.
void begin_at_end(BodyDef& beam, double length) {
  const auto shift = [&](Point& p) { p.x += length; };
  std::for_each(beam.outline.outer.begin(), beam.outline.outer.end(), shift);
  std::rotate(beam.outline.outer.begin(), beam.outline.outer.begin() + 2, beam.outline.outer.end());
  if (beam.along[0] != beam.along[1]) std::for_each(beam.along.begin(), beam.along.end(), shift);
  for (auto& cut : beam.cuts) std::for_each(cut.begin(), cut.end(), shift);
  beam.at = beam.at + Rotation(beam.angle) * Point{-length, 0};
}

/// Positive M turns b counter-clockwise against a: in a mirror, clockwise.
void mirror(JointBetweenDef& joint) {
  JointOverrides& o = joint.overrides;
  if (o.moment_reverse) std::swap(o.moment, o.moment_reverse);
  if (!joint.drive || joint.drive->row != rotation) return;
  for (auto* value : {&joint.drive->position, &joint.drive->speed}) {
    if (*value) **value = -**value;
  }
}

}  // namespace

Bounds box_of(const std::vector<BodyDef>& bodies) {
  Bounds box;
  for (const BodyDef& body : bodies) {
    const Bounds own = box_of(body);
    box.add(own.low);
    box.add(own.high);
  }
  return box;
}

std::vector<std::string> with_assemblies(const SceneDef& scene, std::vector<std::string> names) {
  std::set<std::string> assemblies;
  for (const std::string& name : names) {
    if (const BodyDef* body = body_named(scene, name)) assemblies.insert(body->assembly);
  }
  assemblies.erase("");
  for (const BodyDef& body : scene.bodies) {
    if (assemblies.contains(body.assembly) && std::find(names.begin(), names.end(), body.name) == names.end())
      names.push_back(body.name);
  }
  return names;
}

SceneDef with_assembly(SceneDef scene, const std::vector<std::string>& names) {
  const std::string assembly = unused_assembly(scene, "group1");
  for (BodyDef& body : scene.bodies) {
    if (std::find(names.begin(), names.end(), body.name) != names.end()) body.assembly = assembly;
  }
  return scene;
}

SceneDef without_assemblies(SceneDef scene, const std::vector<std::string>& names) {
  const std::vector<std::string> all = with_assemblies(scene, names);
  for (BodyDef& body : scene.bodies) {
    if (std::find(all.begin(), all.end(), body.name) != all.end()) body.assembly.clear();
  }
  return scene;
}

std::vector<std::string> bodies_in(const SceneDef& scene, const Bounds& box) {
  std::vector<std::string> names;
  for (const BodyDef& body : scene.bodies) {
    const Bounds own = box_of(body);
    if (box.contains(own.low) && box.contains(own.high)) names.push_back(body.name);
  }
  return names;
}

SceneDef part_of(const SceneDef& scene, const std::vector<std::string>& names) {
  const auto chosen = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  SceneDef part = scene;
  std::erase_if(part.bodies, [&](const BodyDef& body) { return !chosen(body.name); });
  std::erase_if(part.supports, [&](const SupportDef& s) { return !chosen(s.body); });
  std::erase_if(part.loads, [&](const LoadDef& l) { return !chosen(l.body); });
  std::erase_if(part.wheels, [&](const WheelDef& w) { return !chosen(w.chassis) || !chosen(w.wheel); });
  std::erase_if(part.joints, [&](JointBetweenDef& joint) {
    std::vector<std::string> left = joint.bodies();
    const auto gone = std::erase_if(left, [&](const std::string& name) { return !chosen(name); });
    if (left.size() < 2 || (gone > 0 && !joint.at)) return true;
    if (gone > 0) set_bodies(joint, left);
    return false;
  });
  return part;
}

Point grip_of(const SceneDef& part) {
  std::vector<Point> all = nodes(part);
  if (all.empty()) {
    const Bounds box = box_of(part.bodies);
    return box.empty() ? Point{} : box.low;
  }
  return *std::min_element(all.begin(), all.end(), [](Point a, Point b) {
    return std::abs(a.y - b.y) < node_size ? a.x < b.x : a.y < b.y;
  });
}

SceneDef shifted(SceneDef part, Point by) {
  each_point(part, [by](Point& p) { p = p + by; });
  return part;
}

SceneDef mirrored(SceneDef part, double x) {
  each_point(part, [x](Point& p) { p.x = 2 * x - p.x; });
  for (BodyDef& body : part.bodies) {
    const auto axis = axis_of(body);
    mirror(body);
    if (axis) begin_at_end(body, axis->length());
  }
  for (JointBetweenDef& joint : part.joints) mirror(joint);
  for (SupportDef& support : part.supports) {
    support.displacement[0] = -support.displacement[0];
    support.displacement[2] = -support.displacement[2];
  }
  for (LoadDef& load : part.loads) {
    load.force.x = -load.force.x;
    load.moment = -load.moment;
  }
  for (WheelDef& wheel : part.wheels) {
    wheel.axis.x = -wheel.axis.x;
    wheel.motor_speed = -wheel.motor_speed;
  }
  return part;
}

SceneDef turned(SceneDef part, Point about, double angle) {
  Point x = Rotation(angle) * Point{1, 0};  // where the world's x goes
  for (double* component : {&x.x, &x.y})
    if (std::abs(*component) < 1e-12) *component = 0;  // a quarter is one
  const bool quarters = x.x == 0 || x.y == 0;
  const auto turn = [&](Point& p) { p = p.x * x + p.y * left(x); };
  each_point(part, [&](Point& p) {
    p = p - about;
    turn(p);
    p = p + about;
  });
  for (BodyDef& body : part.bodies) {
    body.angle += angle;
    turn(body.velocity);
    std::for_each(body.velocities.begin(), body.velocities.end(), turn);
  }
  for (SupportDef& support : part.supports) {
    if (x.x == 0) {
      std::swap(support.fix_x, support.fix_y);
      std::swap(support.stiffness_x, support.stiffness_y);
    }
    if (!quarters && (support.fix_x != support.fix_y || support.stiffness_x != support.stiffness_y)) {
      throw InvalidInput({{"support of " + support.body,
                           "holds one of x and y alone, and turned it would hold along neither",
                           "turn by quarters, or hold both"}});
    }
    Point moved{support.displacement[0], support.displacement[1]};
    turn(moved);
    support.displacement = {moved.x, moved.y, support.displacement[2]};
  }
  for (LoadDef& load : part.loads) turn(load.force);
  for (WheelDef& wheel : part.wheels) turn(wheel.axis);
  return part;
}

Joined with_part(SceneDef scene, SceneDef part) {
  Joined result;
  std::map<std::string, std::string> names;
  const auto rename = [&](std::string& name) { name = names.at(name); };
  const auto same_beam = [](const BodyDef& body) {
    return [axis = axis_of(body)](const BodyDef& other) {
      const auto its = axis_of(other);
      return axis && its && its->ends_at(axis->from) && its->ends_at(axis->to);
    };
  };
  std::map<std::string, std::string> assemblies{{"", ""}};  // a copy's are its own
  for (const BodyDef& body : part.bodies)
    assemblies.emplace(body.assembly, unused_assembly(scene, body.assembly));
  for (BodyDef& body : part.bodies) {
    const auto there = std::find_if(scene.bodies.begin(), scene.bodies.end(), same_beam(body));
    if (there != scene.bodies.end()) {
      names[body.name] = there->name;
      continue;
    }
    const std::string name = names[body.name] =
        body_named(scene, body.name) ? unused_name(scene, body.name) : body.name;
    body.name = name;
    body.assembly = assemblies.at(body.assembly);
    result.added.push_back(name);
    scene.bodies.push_back(body);
  }
  const auto add = [&](auto& list, auto& more) {
    for (auto& item : more) {
      const auto same = [&](const auto& other) { return is_same(other.at, item.at); };
      rename(item.body);
      if (std::none_of(list.begin(), list.end(), same)) list.push_back(item);
    }
  };
  add(scene.supports, part.supports);
  add(scene.loads, part.loads);
  for (WheelDef& wheel : part.wheels) {
    rename(wheel.chassis);
    rename(wheel.wheel);
    scene.wheels.push_back(wheel);
  }
  for (JointBetweenDef& joint : part.joints) {
    std::vector<std::string> held = joint.bodies();
    std::for_each(held.begin(), held.end(), rename);
    set_bodies(joint, held);
    const auto same_line = [&](const JointBetweenDef& other) {
      const auto ends = [&](std::size_t i) {
        return Axis{(*other.line)[0], (*other.line)[1]}.ends_at((*joint.line)[i]);
      };
      return other.line && ends(0) && ends(1);
    };
    if (!joint.line || std::none_of(scene.joints.begin(), scene.joints.end(), same_line))
      scene.joints.push_back(joint);
  }
  for (const std::string& name : result.added) {
    if (const auto axis = axis_of(*body_named(scene, name))) {
      pin(scene, axis->from);
      pin(scene, axis->to);
    }
  }
  result.scene = std::move(scene);
  return result;
}

}  // namespace ductile::viewer
