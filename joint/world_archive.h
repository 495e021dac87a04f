// What b2World keeps, in a document: bodies, fixtures, stock joints, contacts and the broad phase, each in
// the order of creation, which the order of Box2D's lists is the reverse of. Written against Box2D 2.4.1.
//
// Steps are the same to the bit where these orders, the broad phase's tree and the contacts' impulses are the
// same; addresses do not matter.
#pragma once

#include <box2d/box2d.h>

#include <vector>

#include "archive.h"

namespace ductile {

/// A number of a game's; its own user data (B2_USER_SETTINGS) may have none.
template <class UserData>
void user_data(Archive& archive, UserData& data) {
  if constexpr (requires { data.pointer; }) archive("user", data.pointer);
}

class WorldArchive {
 public:
  /// Writes the world, or reads into it: then it has nothing but watches.
  explicit WorldArchive(b2World& world);

  // In this order; joints between contacts and motion.
  void settings(Archive& archive);
  void bodies(Archive& archive);
  /// Must come before the joints, which may keep bodies from colliding.
  void contacts(Archive& archive);
  /// A joint of Box2D's, as number `index`; made where it is read.
  void stock_joint(Archive& archive, b2Joint* joint);
  /// What making the rest changed: masses, velocities, sleep, flags of contacts; and the broad phase.
  void motion(Archive& archive);

  b2World& world() { return world_; }
  /// Destroys all bodies but watches, without calling a listener.
  static void clear(b2World& world);
  std::vector<b2Body*> all_bodies;
  std::vector<b2Joint*> all_joints;
  /// A body or joint by its number.
  void body(Archive& archive, const char* key, b2Body*& body);

 private:
  void fixture(Archive& archive, b2Body& body, b2Fixture* fixture);
  void contact(Archive& archive, b2Contact& contact);
  void proxy(Archive& archive, const char* key, b2FixtureProxy*& proxy);
  void broad_phase(Archive& archive);

  struct Proxy {
    b2FixtureProxy* at;
    b2AABB box;  // as they stand in the document
    std::int32_t id;
  };

  b2World& world_;
  std::vector<Proxy> proxies_;
  std::vector<b2Contact*> contacts_;
};

}  // namespace ductile
