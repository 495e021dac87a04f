#include "beam.h"

#include <algorithm>
#include <cmath>

#include "ductile/rolled.h"

namespace ductile::viewer {

Point Axis::nearest(Point p) const {
  const Point d = to - from;
  const double square = dot(d, d);
  return square > 0 ? from + std::clamp(dot(p - from, d) / square, 0., 1.) * d : from;
}

std::optional<Axis> axis_of(const BodyDef& body) {
  const Ring& ring = body.outline.outer;
  if (body.type != BodyType::dynamic_body || body.circle > 0 || ring.size() != 4 ||
      !body.outline.holes.empty())
    return std::nullopt;
  const double span = ring[1].x, half = ring[2].y;
  const Ring beam{{0, -half}, {span, -half}, {span, half}, {0, half}};
  if (!(half > 0 && span > 0) || !std::equal(ring.begin(), ring.end(), beam.begin(), is_same))
    return std::nullopt;
  return Axis{body.at, body.at + Rotation(body.angle) * Point{span, 0}};
}

namespace {

double height_of(const BodyDef& beam) { return 2 * beam.outline.outer[2].y; }

void lay(BodyDef& beam, const Axis& axis, double height) {
  const double span = axis.length(), half = height / 2;
  if (!(span > height)) {
    throw InvalidInput({{"body '" + beam.name + "'", "is no longer than it is high", "draw it longer"}});
  }
  beam.outline.outer = {{0, -half}, {span, -half}, {span, half}, {0, half}};
  beam.at = axis.from;
  beam.angle = std::atan2(axis.to.y - axis.from.y, axis.to.x - axis.from.x);
}

}  // namespace

BeamStyle style_of(const BodyDef& beam) {
  return {.material = beam.material.value_or(materials::S355),
          .height = height_of(beam),
          .depth = beam.depth,
          .profile = beam.profile_name,
          .pieces = beam.pieces,
          .solid = beam.collides,
          .price = beam.price};
}

void lay(BodyDef& beam, const Axis& axis, const BeamStyle& style) {
  double height = style.height;
  beam.profile.clear();
  beam.profile_name.clear();
  if (!style.profile.empty()) {
    const Rolled profile = rolled(style.profile);
    height = profile.h;
    beam.profile = {{draw(profile).outline, style.material}};
    beam.profile_name = profile.name;
  }
  beam.material = style.material;
  beam.depth = style.depth;
  beam.pieces = style.pieces;
  beam.collides = style.solid;
  beam.price = style.price;
  lay(beam, axis, height);
}

void lay(BodyDef& beam, const Axis& axis) { lay(beam, axis, height_of(beam)); }

bool ends_at(const BodyDef& body, Point at) {
  const auto axis = axis_of(body);
  return axis && axis->ends_at(at);
}

bool passes(const BodyDef& body, Point at) {
  const auto axis = axis_of(body);
  return axis && axis->distance(at) < node_size;
}

bool covers(const BodyDef& body, Point at) {
  const Point local = Rotation(body.angle).inverse(at - body.at);
  if (body.circle > 0) return length(local) <= body.circle + node_size;
  const auto is_on = [&](const Ring& ring) {
    for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
      if (distance(local, ring[last], ring[i]) < node_size) return true;
    }
    return false;
  };
  const auto& [outer, holes] = body.outline;
  return is_on(outer) || std::any_of(holes.begin(), holes.end(), is_on) || contains(body.outline, local);
}

const BodyDef* body_at(const SceneDef& scene, Point at) {
  for (const auto there : {ends_at, passes}) {
    for (const BodyDef& body : scene.bodies) {
      if (there(body, at)) return &body;
    }
  }
  for (const bool moves : {true, false}) {
    for (auto body = scene.bodies.rbegin(); body != scene.bodies.rend();
         ++body) {  // the last is drawn on top
      if ((body->type == BodyType::dynamic_body) == moves && covers(*body, at)) return &*body;
    }
  }
  return nullptr;
}

const BodyDef* body_named(const SceneDef& scene, const std::string& name) {
  for (const BodyDef& body : scene.bodies) {
    if (body.name == name) return &body;
  }
  return nullptr;
}

}  // namespace ductile::viewer
