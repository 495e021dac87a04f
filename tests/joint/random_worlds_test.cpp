// Random worlds in which everything happens at once: rows of pieces that yield and break, ropes, a motor,
// guests and bullets that come and go. Whenever one is saved, what is loaded of it runs on as it does, to the
// bit.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../world_state.h"
#include "bodies.h"
#include "ductile/save.h"

namespace ductile {
namespace {

class RandomWorld {
 public:
  explicit RandomWorld(unsigned seed) : random_(seed) {
    world.SetAllowSleeping(one_of(2));
    b2Body* ground = add_box(world, {.y = -3.5, .width = 200, .type = b2_staticBody, .group = 0});
    for (int rows = 1 + static_cast<int>(random_() % 3); rows > 0; --rows)
      add_row(one_of(3) ? nullptr : ground);
    add_rope(ground);
    add_motor();
    for (int i = 0; i < 8; ++i) add_guest(0.2, 1);
  }

  void step() {
    if (one_of(30)) {
      guests_.push_back(add_guest(0.3, 0.6));
      guests_.back()->SetBullet(one_of(2));
      guests_.back()->SetLinearVelocity(vec(within(-20, 20), within(-40, 0)));
    }
    if (one_of(40) && !guests_.empty()) {
      world.DestroyBody(guests_.back());
      guests_.pop_back();
    }
    go_on(world, structure);
  }

  static void go_on(b2World& world, Structure& structure) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }

  bool one_of(unsigned n) { return random_() % n == 0; }
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() % 10001) / 10000;
  }

  b2World world{{0, -10}};
  Structure structure{world, {.keep_ledger = true}};

 private:
  b2Body* add_guest(double least, double most) {
    return add_box(world, {.x = within(-9, 9),
                           .y = within(2, 10),
                           .width = within(least, most),
                           .height = within(least, most),
                           .mass = within(100, 5000),
                           .group = 0});
  }

  void add_row(b2Body* last) {
    const double x = within(-8, 8), y = within(-2, 6), cap = std::pow(10, within(3.5, 6));
    const short group = one_of(2) ? 0 : -1;
    for (int i = 0; i < 8; ++i) {
      b2Body* piece = add_box(world, {.x = x + i + 0.5,
                                      .y = y,
                                      .width = within(0.6, 1),
                                      .height = within(0.1, 0.4),
                                      .mass = within(20, 1500),
                                      .group = group});
      pieces_.push_back(piece);
      if (last != nullptr) {
        ElasticPlasticJointDef def;
        def.Initialize(last, piece, vec(x + i, y), {1, 0});
        def.rows[axial].cap = def.rows[axial].cap_reverse = 5 * cap;
        def.rows[rotation] = {.stiffness = one_of(3) ? rigid : std::pow(10, within(5, 9)),
                              .damping_ratio = one_of(2) ? 0 : 0.05,
                              .cap = cap,
                              .cap_reverse = cap};
        def.max_rotation = within(0.05, 0.8);
        if (one_of(4)) def.interaction = {{5 * cap, 0}, {0, cap}, {-5 * cap, 0}, {0, -cap}};
        structure.create_joint(def);
      }
      last = piece;
    }
  }

  void add_rope(b2Body* ground) {
    ElasticPlasticJointDef def;
    def.bodyA = ground;
    def.bodyB = pieces_[random_() % pieces_.size()];
    def.line = true;
    def.localAnchorA = vec(within(-9, 9), 0.5);
    def.rows[axial] = one_of(2) ? RowDef::rope(1e6, 1e5) : RowDef::strut(1e6, 1e5);
    if (one_of(2)) def.rows[axial].drive = Drive{within(0.5, 3), within(0.1, 2)};
    def.rows[shear] = def.rows[rotation] = RowDef::free();
    structure.create_joint(def);
  }

  void add_motor() {
    b2Body* on = pieces_[random_() % pieces_.size()];
    const b2Vec2 at = on->GetPosition() + b2Vec2{0, 0.4f};
    b2Body* arm = add_box(world, {.x = at.x, .y = at.y, .width = 2, .height = 0.2, .mass = 120, .group = 0});
    ElasticPlasticJointDef def;
    def.Initialize(on, arm, at, {1, 0});
    def.rows[rotation] = {.cap = 1e4, .cap_reverse = 1e4, .drive = Drive{unlimited, within(1, 5)}};
    structure.create_joint(def);
  }

  std::mt19937 random_;
  std::vector<b2Body*> pieces_, guests_;
};

TEST(RandomWorlds, AreSavedAndRunOn) {
  int saves = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    RandomWorld scene(seed);
    for (int i = 0; i < 240; ++i) {
      scene.step();
      if (!scene.one_of(60)) continue;
      ++saves;
      b2World world({0, 0});
      Structure structure(world);
      const std::vector<std::uint8_t> bytes = save_bytes(scene.structure);
      load_bytes(structure, bytes);
      ASSERT_TRUE(save_bytes(structure) == bytes) << seed << ", step " << i;
      Snapshot before;
      before.save(scene.world);
      for (int k = 0; k < 40; ++k) {
        RandomWorld::go_on(world, structure);
        RandomWorld::go_on(scene.world, scene.structure);
        ASSERT_EQ(world_state(world), world_state(scene.world)) << seed << ", step " << i << ", " << k;
      }
      ASSERT_TRUE(save_bytes(structure) == save_bytes(scene.structure)) << seed << ", step " << i;
      before.restore(scene.world);
    }
  }
  EXPECT_GT(saves, 30);
}

}  // namespace
}  // namespace ductile
