// A R.U.B.E. scene in a world of Box2D 2.4.1: all of it, whether a plan knows of it or not.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/box2d.h"
#include "rube.h"

namespace ductile::rube {

/// Makes a scene in worlds, as often as one likes. What can be refused is refused before.
class World {
 public:
  /// Throws InvalidInput on what Box2D does not take.
  World(Scene scene, const std::string& name);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Everything made, by its name in the scene.
  struct Names {
    std::multimap<std::string, b2Body*> bodies;
    std::multimap<std::string, b2Joint*> joints;
  };
  /// The scene with the joints of `plan`, which is that of the scene: in the structure, or as the stock
  /// joints of stock_def() where that is null.
  Built make(b2World& world, const Plan& plan, Structure* structure, Names* names = nullptr) const;

 private:
  using Shapes = std::vector<std::pair<const Fixture*, std::unique_ptr<b2Shape>>>;

  void check(const Body& body);
  void check(const Item& joint);
  b2Body* make_body(b2World& world, std::size_t index) const;

  Scene scene_;
  Problems problems_;  // none; values refer to it
  Item top_;
  std::vector<Body> bodies_;
  std::vector<Shapes> shapes_;  // of their fixtures
  std::vector<Item> joints_;
  std::vector<int> planned_;  // by joints: index into the plan's; −1: not ductile
};

/// As Box2D has them.
inline float single(double value) { return static_cast<float>(value); }
inline b2Vec2 single(Point p) { return {single(p.x), single(p.y)}; }

/// A stock joint as the scene has it; gears refer to `others`, by the scene's joints.
b2Joint* make_joint(b2World& world, const Item& item, const std::vector<b2Body*>& bodies,
                    const std::vector<b2Joint*>& others);

}  // namespace ductile::rube
