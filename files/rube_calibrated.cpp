// A calibrated plan written back into the R.U.B.E. scene that it was read from.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "built_plan.h"
#include "rube_reader.h"

namespace ductile::rube {

int Reader::piece_at(int body, Point at) const {
  int nearest = -1;
  double least = unlimited;
  for (std::size_t i = 0; i < scene_.plan.pieces.size(); ++i) {
    const Piece& piece = scene_.plan.pieces[i];
    if (body_of_def_[static_cast<std::size_t>(piece.body)] != body) continue;
    const double away = distance(at, piece.outline, piece.circle, piece.center);
    if (nearest >= 0 && away >= least) continue;
    nearest = static_cast<int>(i);
    least = away;
  }
  return nearest;
}

/// The parts of a body that do not touch are one rigid body all the same, carried by the first.
void Reader::unite_parts() {
  std::vector<Piece>& pieces = scene_.plan.pieces;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto body = [&](std::size_t k) { return body_of_def_[static_cast<std::size_t>(pieces[k].body)]; };
    if (pieces[i].part_of >= 0 || bodies_[static_cast<std::size_t>(body(i))].type != BodyType::dynamic_body)
      continue;
    Piece& whole = pieces[i];
    double mass = whole.mass, inertia = whole.inertia;
    Point first = whole.mass * whole.center;
    bool united = false;
    for (std::size_t k = i + 1; k < pieces.size() && body(k) == body(i); ++k) {
      if (pieces[k].body == whole.body) continue;  // a piece of its own
      pieces[k].part_of = static_cast<int>(i);
      united = true;
      mass += pieces[k].mass;
      first = first + pieces[k].mass * pieces[k].center;
    }
    if (!united) continue;
    const Point centre = (1 / mass) * first;
    for (std::size_t k = i; k < pieces.size() && body(k) == body(i); ++k) {
      const Piece& part = pieces[k];
      const Point arm = part.center - centre;
      inertia += (k > i ? part.inertia : 0) + part.mass * dot(arm, arm);
    }
    whole.mass = mass;
    whole.inertia = inertia;
    whole.center = centre;
  }
}

/// Bodies that are not split keep what they have, but for their mass where a joint takes their material. The
/// first piece of a split one takes its place, the others come last; all keep its frame, so that every anchor
/// on it stays as it is.
void Reader::write_bodies() {
  Plan& plan = scene_.plan;
  if (plan.pieces.empty()) return;
  const BuiltPlan built(plan);
  Json& list = scene_.json["body"];
  int number = 0;  // of the piece in its body
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    Piece& piece = plan.pieces[i];
    const BodyDef& def = plan.bodies[static_cast<std::size_t>(piece.body)];
    const int index = body_of_def_[static_cast<std::size_t>(piece.body)];
    const Body& body = bodies_[static_cast<std::size_t>(index)];
    const Item item(body.value);
    number = i > 0 && plan.pieces[i - 1].body == piece.body ? number + 1 : 0;
    scene_.bodies.push_back(number == 0 ? index : static_cast<int>(list.size()));
    if (def.pieces > 1 || def.automatic) {
      Json copy = body.value.json();
      copy["name"] = (body.name.empty() ? def.name : body.name) + "/" + std::to_string(number);
      for (const char* done : {"ductile.pieces", "ductile.outline", "ductile.loads"})
        remove_custom(copy, done);
      write_piece(copy, plan, static_cast<int>(i), *built.built.bodies[i], body.frame);
      write_loads(copy, plan, static_cast<int>(i), body.frame);
      if (number == 0)
        list[static_cast<std::size_t>(index)] = std::move(copy);
      else
        list.push_back(std::move(copy));
      continue;
    }
    if (piece.part_of >= 0) continue;
    if (!body.name.empty() && names_.insert("/" + body.name).second) piece.name = body.name;
    if (def.type != BodyType::dynamic_body) continue;
    const auto calibrated = [&](const Between& pair) { return pair.a == index || pair.b == index; };
    if (names_material(item) && std::any_of(between_.begin(), between_.end(), calibrated)) {
      write_mass(list[static_cast<std::size_t>(index)], *built.built.bodies[i], body.frame);
    } else {
      const Point c = body.mass_center;
      piece.mass = body.mass > 0 ? body.mass : 1;  // as Box2D has it
      piece.center = body.frame.world(c);
      piece.inertia = std::max(0.0, body.inertia - piece.mass * (c.x * c.x + c.y * c.y));
    }
    if (item.boolean("fixedRotation")) piece.inertia = 0;  // as in Box2D, a body of no inertia does not turn
  }
}

/// What was fixed to a body that is in pieces now is fixed to the piece under it.
void Reader::redirect() {
  const Item top(Value(original_, "top level", problems_));
  const auto follow = [&](Json& item, const char* key, const char* anchor, const Value& value) {
    const Item of(value);
    if (!of.has(key)) return;
    const int body = of.integer(key, -1, static_cast<int>(bodies_.size()) - 1, -1);
    const int piece =
        body < 0 ? -1
                 : piece_at(body, bodies_[static_cast<std::size_t>(body)].frame.world(of.vector(anchor)));
    if (piece >= 0) item[key] = scene_.bodies[static_cast<std::size_t>(piece)];
  };
  const auto joints = top.list("joint"), images = top.list("image");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    follow(scene_.json["joint"][i], "bodyA", "anchorA", joints[i]);
    follow(scene_.json["joint"][i], "bodyB", "anchorB", joints[i]);
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].json().is_object()) follow(scene_.json["image"][i], "body", "center", images[i]);
  }
}

/// The first joint between two bodies takes the place of the one that was there; further ones come last.
void Reader::write_joints() {
  Plan& plan = scene_.plan;
  const auto body_of = [&](int piece) {
    return body_of_def_[static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body)];
  };
  const auto frame_of = [&](int piece) { return bodies_[static_cast<std::size_t>(body_of(piece))].frame; };
  std::map<std::pair<int, int>, std::vector<int>> places;  // of the joints between two bodies, the last first
  for (auto pair = between_.rbegin(); pair != between_.rend(); ++pair)
    places[{pair->a, pair->b}].push_back(pair->joint);
  for (PlannedJoint& j : plan.joints) {
    Json& list = scene_.json["joint"];
    int index = static_cast<int>(list.size());
    if (auto& free = places[{body_of(j.a), body_of(j.b)}]; !free.empty()) {
      index = free.back();
      free.pop_back();
    } else {
      list.push_back(Json::object());
    }
    Json& item = list[static_cast<std::size_t>(index)];
    if (const std::string name = item.value("name", ""); !name.empty()) j.name = name;
    write_joint(item, plan, j, as_, scene_.bodies[static_cast<std::size_t>(j.a)],
                scene_.bodies[static_cast<std::size_t>(j.b)], frame_of(j.a), frame_of(j.b));
    scene_.joints.push_back(index);
  }
  for (std::size_t i = 0; i < given_.size(); ++i) {
    PlannedJoint j = given_[i];
    j.a = is_ground(j.a) ? -1 : piece_at(j.a, j.anchor);
    j.b = piece_at(j.b, j.anchor);
    if (j.name.empty()) j.name = "joint[" + std::to_string(given_at_[i]) + "]";
    const auto reason = std::find(plan.reasons.begin(), plan.reasons.end(), given_reasons_[i]);
    j.governed_by = static_cast<int>(reason - plan.reasons.begin());
    if (reason == plan.reasons.end()) plan.reasons.push_back(given_reasons_[i]);
    plan.joints.push_back(std::move(j));
    scene_.joints.push_back(given_at_[i]);
  }
}

}  // namespace ductile::rube
