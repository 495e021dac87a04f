#include "bullets.h"

#include <algorithm>
#include <utility>

#include "frames.h"
#include "guests.h"
#include "island.h"

namespace ductile::dynamics {

namespace {

float central_inertia(const b2Body& body) {
  return body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared();
}

/// A body at the end of a step in which nothing changed its velocity, with its way there.
void set_on_way(b2Body& body, const b2Position& at, const b2Velocity& v, float h) {
  b2Sweep& sweep = of(body, b2Body_m_sweep{});
  body.SetTransform(transform_of(body, at).p, at.a);
  sweep.c = at.c;
  sweep.c0 = at.c - h * v.v;
  sweep.a0 = at.a - h * v.w;
  sweep.alpha0 = 0;
  body.SetLinearVelocity(v.v);
  body.SetAngularVelocity(v.w);
}

/// Whether Box2D let the piece meet a bullet alone in the last step: as the two that it knew to meet, or
/// beside those. What only touched then may not do so any more; unless it met something else, that is why it
/// has moved.
bool met_alone(const b2Contact& contact, const Mirror& piece, b2Body& guest) {
  if (same(piece.left, pose_of(*piece.body))) return false;
  if (of(contact, b2Contact_m_toiCount{}) > 0) return true;
  if (!guest.IsBullet() || !(of(guest, b2Body_m_sweep{}).alpha0 > 0)) return false;
  if (contact.IsTouching()) return true;
  for (b2ContactEdge* e = piece.body->GetContactList(); e != nullptr; e = e->next)
    if (e->other != &guest && of(*e->contact, b2Contact_m_toiCount{}) > 0) return false;
  return true;
}

// The bullet goes on to the end of the step as if it had met none. What pieces have of its impacts it has the
// other way, whenever these were and however often: their momenta, their moments and, as an impact moves both
// for the rest of the step, their ways. Only how it is turned is that of the last one. Before each Box2D puts
// the two apart, and the impulses act there: a bullet that is farther off its way has bounced in between.
void undo_impacts(Alone& alone, float h) {
  b2Body& guest = *alone.guest;
  const b2Sweep met = of(guest, b2Body_m_sweep{});
  const float mass = guest.GetMass(), inertia = central_inertia(guest);
  b2Vec2 momentum(0, 0), way(0, 0);
  float moment = 0, pieces = 0;
  for (const Mirror* piece : alone.pieces) {
    const b2Body& body = *piece->body;
    const b2Vec2 at = of(*piece->body, b2Body_m_sweep{}).c, v = body.GetLinearVelocity();
    const float m = body.GetMass();
    pieces += m;
    momentum += m * (v - piece->given.v);
    way += m * (at - piece->left.c);
    moment += central_inertia(body) * (body.GetAngularVelocity() - piece->given.w) +
              m * (b2Cross(at - met.c, v) - b2Cross(piece->left.c - met.c, piece->given.v));
  }
  const float left = (1 - met.alpha0) * h;
  b2Velocity v{guest.GetLinearVelocity() + 1 / mass * momentum, guest.GetAngularVelocity()};
  const b2Vec2 end = met.c + 1 / mass * way;
  if (inertia > 0 && !alone.pieces.empty()) {
    b2Vec2 put_apart = met.c0 - (end - left * v.v);
    const float most = 3 * b2_linearSlop * pieces / (pieces + mass), length = put_apart.Length();
    if (length > most) put_apart *= most / length;
    v.w += (moment - b2Cross(way, v.v) - mass * b2Cross(put_apart, v.v - alone.pieces.front()->given.v)) /
           inertia;
  }
  alone.share = met.alpha0;
  set_on_way(guest, {end, met.a0 + left * v.w}, v, h);
}

}  // namespace

// Of all bullets that met pieces alone. Of several that met the same piece the first has it all.
std::vector<Alone> undo_impacts_alone(std::span<const Pool::Owned<Component>> components, const b2World& in) {
  std::vector<Alone> all;
  const b2Contact* met_in_a_sub_step = in.GetContactList();
  while (met_in_a_sub_step != nullptr && of(*met_in_a_sub_step, b2Contact_m_toiCount{}) == 0)
    met_in_a_sub_step = met_in_a_sub_step->GetNext();
  if (met_in_a_sub_step == nullptr) return all;
  std::vector<const Mirror*> met;
  for (const auto& c : components) {
    if (!c->stepped()) continue;
    each_near(*c, [&](const b2Contact& contact, const Mirror& piece, b2Body& body) {
      if (is_joined(body) || !met_alone(contact, piece, body)) return;
      auto at = std::find_if(all.begin(), all.end(), [&](const Alone& a) { return a.guest == &body; });
      if (at == all.end()) at = all.insert(at, {&body, {}, 0});
      if (std::find(met.begin(), met.end(), &piece) != met.end()) return;  // at another point, or by another
      at->pieces.push_back(&piece);
      met.push_back(&piece);
    });
  }
  if (all.empty()) return all;
  const float h = 1 / of(in, b2World_m_inv_dt0{});
  for (Alone& a : all) undo_impacts(a, h);
  for (const Mirror* m : met) set_on_way(*m->body, m->left, m->given, h);
  return all;
}

void Island::hold_bullets() {
  if (!direct() || world().GetSubStepping()) return;
  for (const Component* c : active_) {
    each_near(*c, [this](const b2Contact&, const Mirror&, b2Body& guest) {
      if (!guest.IsBullet() || is_joined(guest)) return;
      guest.SetBullet(false);
      of(guest, b2Body_m_flags{}) |= held_bullet;
      holds_bullets_ = true;
    });
  }
}

void Island::let_bullets_go(b2World& in) {
  if (!std::exchange(holds_bullets_, false)) return;
  for (b2Body* b = in.GetBodyList(); b != nullptr; b = b->GetNext()) {
    uint16& flags = of(*b, b2Body_m_flags{});
    if ((flags & held_bullet) == 0) continue;
    flags = static_cast<uint16>(flags & ~held_bullet);
    b->SetBullet(true);
  }
}

}  // namespace ductile::dynamics
