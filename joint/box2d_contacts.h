// The contacts of the island that b2World is solving: where Box2D's contact solver keeps them, which of them
// are rows of a structure's problem, and how their impulses are handed back. Written against Box2D 2.4.1.
//
// Between b2Joint::InitVelocityConstraints and the first b2Joint::SolveVelocityConstraints the world's stack
// allocator holds the island (bodies, contacts, joints, velocities, positions), the search stack, and the
// constraints of positions and of velocities, in this order. All that is assumed of them is checked; where
// it is not so, no contact is a row, and contacts push pieces as they do any body.
//
// What Box2D is left with gets its impulse and infinite masses: its own iterations then change neither, and
// StoreImpulses, PostSolve and the next warm start find the impulse that the structure's problem has.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace ductile::dynamics {

/// A point of b2ContactVelocityConstraint.
struct PointConstraint {
  b2Vec2 ra, rb;  // from the centres of mass, world axes
  float normal_impulse, tangent_impulse, normal_mass, tangent_mass, bounce;
};

/// Laid out as b2ContactVelocityConstraint.
struct VelocityConstraint {
  PointConstraint points[b2_maxManifoldPoints];
  b2Vec2 normal;  // from A to B
  b2Mat22 normal_mass, K;
  int32 a, b;  // indices in the island
  float inverse_mass_a, inverse_mass_b, inverse_inertia_a, inverse_inertia_b;
  float friction, restitution, threshold, conveyor;
  int32 count, index;
};

/// Laid out as b2ContactPositionConstraint.
struct PositionConstraint {
  b2Vec2 points[b2_maxManifoldPoints], normal, point;
  int32 a, b;
  float inverse_mass_a, inverse_mass_b;
  b2Vec2 center_a, center_b;
  float inverse_inertia_a, inverse_inertia_b;
  b2Manifold::Type type;
  float radius_a, radius_b;
  int32 count;
};

/// One contact of the island, or points of one that a blow's bodies may meet within the step
/// (near_contacts.cpp).
struct Touch {
  b2Contact* contact;
  const b2Manifold* manifold;  // its own, or that of near points
  VelocityConstraint* velocity;
  PositionConstraint* position;
  int in_a = -1, in_b = -1;  // its bodies in a component
  bool at_seam = false;      // of joined pieces (seams.h): it presses nothing

  b2Body* a() const { return contact->GetFixtureA()->GetBody(); }
  b2Body* b() const { return contact->GetFixtureB()->GetBody(); }
  /// Whether it does not touch yet.
  bool is_near() const { return manifold != contact->GetManifold(); }
};

/// Of a point, with the velocities at the step's start, m/s; below 0 it closes.
float closing_speed(const Touch& touch, const PointConstraint& at);

/// A contact of a blow, and what pressed at its points in the last part of the step, N s, where that was
/// over.
struct Struck {
  const b2Contact* contact;
  std::array<float, b2_maxManifoldPoints> normal{}, tangent{};
};

/// The contacts of the island that is being solved; none where an assumption does not hold.
class IslandContacts {
 public:
  void read(b2World& world, const b2SolverData& data);
  /// Forgets what is reached.
  void begin(const b2World& world);
  /// Leaves those that touch a reached body or one for which is_piece is true, of bodies that may_take; and
  /// where all that can be reached of these by contacts are few points, these too. `follow(body)` is called
  /// for each body that is reached, and may reach() more.
  template <class IsPiece, class MayTake, class Follow>
  void choose(const IsPiece& is_piece, const MayTake& may_take, const Follow& follow);
  /// Adds the points that a contact of one of this touch's bodies may have within the step of h seconds and
  /// has not yet, where they face the way that the touch does; without a touch, where they strike in the
  /// step, or a blow may drive them together by `driven` m/s. Its body B slides so far against A until then.
  void add_near(b2Contact& contact, const Touch* touch, float h, float driven = 0,
                const b2Vec2& slide = b2Vec2_zero);
  /// Leaves out what was added since `first` of a kinematic body and does not face the way in which that
  /// strikes first, in a step of h seconds.
  void keep_first_ways(std::size_t first, float h);
  /// A body that something which is solved with the structure holds.
  void reach(b2Body& body);
  /// The index of a body that can move in the island that is being solved.
  static std::size_t place_of(const b2Body& body);
  /// Whether what holds the body was looked for: `follow` was called.
  bool is_followed(const b2Body& body) const;
  std::span<const Touch> touches() const { return touches_; }
  /// Those that choose() left out, as their bodies share a neighbour.
  std::span<const Touch> corners() const { return corners_; }
  void clear() {
    near_count_ = 0;
    touches_.clear();
    corners_.clear();
  }
  /// Of so many contacts nothing is allocated in a step.
  void make_room(std::size_t contacts) {
    touches_.reserve(contacts + few);
    chosen_.reserve(contacts + few);
    corners_.reserve(contacts);
    taken_.reserve(contacts);
  }

 private:
  static constexpr std::size_t few = 40;  // points

  // What Box2D's contact solver would have of points that do not touch yet.
  struct Near {
    b2Manifold manifold;
    VelocityConstraint velocity;
    PositionConstraint position;
  };

  enum Mark : char { unknown, reached, followed };
  Mark& mark(const b2Body& body);
  template <class Follow>
  void follow_front(const Follow& follow);

  std::vector<Touch> touches_, chosen_, corners_;
  std::array<Near, few> near_;
  std::size_t near_count_ = 0;
  std::vector<char> taken_;
  std::vector<Mark> marks_;     // of the island's bodies
  std::vector<b2Body*> front_;  // reached, but not followed
};

/// Whether a contact is a sensor's: Box2D makes no manifold of it.
inline bool is_sensor(const b2Contact& c) {
  return c.GetFixtureA()->IsSensor() || c.GetFixtureB()->IsSensor();
}

/// How far a contact's body B slides along A in h seconds, where that is more than Box2D's slop and than half
/// of what they come nearer; else 0.
b2Vec2 slide(const Touch& touch, float h);

/// PostSolve of points that did not touch when the step began.
void tell_of_near(const Touch& touch);

/// Whether a point of a manifold is an end of the face that its normal is of: a corner of that face's body,
/// on the other's face.
bool is_end_of_face(const b2Manifold& manifold, const b2ManifoldPoint& point);

/// From where to where a polygon and its skin reach in a direction.
std::pair<float, float> extent(const b2PolygonShape& polygon, const b2Vec2& along);

/// Whether two bodies that move are joined to the same third, which moves: at a corner pieces on both sides
/// of a hinge touch as it turns. Non-penetration there, exact to the last bit, would be a moment beside the
/// joint's own. A wall does not move: a piece that strikes the one which its neighbour hangs on does so away
/// from the joints of both.
bool share_a_neighbour(const b2Body& a, const b2Body& b);

/// Takes the impulses that a constraint's points hold as they are: no iteration changes them or a velocity.
void settle(VelocityConstraint& constraint);

/// The island's body moves by no contact in the iterations of positions.
inline void hold_a(PositionConstraint& p) { p.inverse_mass_a = p.inverse_inertia_a = 0; }
inline void hold_b(PositionConstraint& p) { p.inverse_mass_b = p.inverse_inertia_b = 0; }

/// In the iterations of positions only what overlaps by more than two polygons' skins is too deep.
inline void let_skins_overlap(PositionConstraint& p) { p.radius_a -= 2 * b2_polygonRadius - b2_linearSlop; }

/// The least distance at a contact's points, m: below 0 shapes overlap.
float separation_of(const b2Contact& contact);

/// In the iterations of positions nothing is too deep that is no deeper than now.
inline void let_stay(const Touch& touch) {
  touch.position->radius_a -= std::max(0.0f, -separation_of(*touch.contact) - b2_linearSlop);
}

/// The contact presses nothing in this step, moves no body, and keeps no island awake, however deep it is.
void silence(const Touch& touch);

template <class Follow>
void IslandContacts::follow_front(const Follow& follow) {
  for (std::size_t k = 0; k < front_.size(); ++k) {
    b2Body& body = *front_[k];
    mark(body) = followed;
    follow(body);
  }
  front_.clear();
}

template <class IsPiece, class MayTake, class Follow>
void IslandContacts::choose(const IsPiece& is_piece, const MayTake& may_take, const Follow& follow) {
  chosen_.clear();
  taken_.assign(touches_.size(), 0);
  follow_front(follow);
  const auto moves = [](const b2Body* body) { return body->GetType() == b2_dynamicBody; };
  std::size_t points = 0;
  // Hop by hop: contacts of pieces, and of what is tied to them, then of what these touch.
  for (bool first = true;; first = false) {
    const std::size_t before = chosen_.size(), points_before = points;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& t = touches_[k];
      b2Body *a = t.a(), *b = t.b();
      const auto from = [&](b2Body* body) {
        return moves(body) && (mark(*body) != unknown || (first && is_piece(body)));
      };
      if (taken_[k] != 0 || !(from(a) || from(b))) continue;
      taken_[k] = 1;
      if (!may_take(a) || !may_take(b)) continue;
      if (share_a_neighbour(*a, *b)) {
        corners_.push_back(t);
        continue;
      }
      chosen_.push_back(t);
      points += static_cast<std::size_t>(t.velocity->count);
    }
    if (!first && points > few) {
      chosen_.resize(before);
      points = points_before;
      break;
    }
    if (chosen_.size() == before) break;
    for (std::size_t k = before; k < chosen_.size(); ++k) {
      for (b2Body* body : {chosen_[k].a(), chosen_[k].b()})
        if (moves(body) && !is_piece(body)) reach(*body);
    }
    follow_front(follow);
  }
  touches_.swap(chosen_);
}

}  // namespace ductile::dynamics
