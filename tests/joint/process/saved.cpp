// saved FILE TEXT, then loaded FILE TEXT in another process: what 300 steps make of a tower that is hit while
// it collapses, run on and loaded. Prints every number of every body, and how many joints are left.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "../../world_state.h"
#include "bodies.h"
#include "ductile/save.h"

using namespace ductile;

namespace {

void run_on(b2World& world, Structure& structure) {
  for (int i = 0; i < 300; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }
  for (const float number : world_state(world)) std::printf("%.9g\n", number);
  std::printf("%zu joints\n", structure.joints().size());
}

// Two columns and floors of boxes, joined where they touch; ropes to the ground, and a motor on the roof.
void build_tower(b2World& world, Structure& structure) {
  b2Body* ground = add_box(world, {.y = -0.5, .width = 200, .type = b2_staticBody, .group = 0});
  b2Body* below[2] = {};
  for (int storey = 0; storey < 6; ++storey) {
    const double y = 2.0 * storey;
    const auto join = [&](b2Body* a, b2Body* b, b2Vec2 at, b2Vec2 axis) {
      ElasticPlasticJointDef def;
      def.Initialize(a, b, at, axis);
      for (RowDef& row : def.rows) row.cap = row.cap_reverse = 4e5;
      def.rows[rotation] = {.stiffness = 2e7, .damping_ratio = 0.05, .cap = 6e4, .cap_reverse = 6e4};
      def.max_rotation = 0.15, def.max_slip = def.max_elongation = 0.02;
      structure.create_joint(def);
    };
    b2Body* column[2];
    for (const int side : {0, 1}) {
      const double x = 4.0 * side;
      column[side] =
          add_box(world, {.x = x, .y = y + 0.75, .width = 0.4, .height = 1.5, .mass = 600, .group = 0});
      if (below[side] != nullptr) join(below[side], column[side], vec(x, y), {0, 1});
    }
    b2Body* floor =
        add_box(world, {.x = 2, .y = y + 1.75, .width = 5, .height = 0.5, .mass = 2500, .group = 0});
    for (const int side : {0, 1}) {
      join(column[side], floor, vec(4.0 * side, y + 1.5), {0, 1});
      below[side] = floor;
    }
  }
  for (const int side : {-1, 1}) {
    ElasticPlasticJointDef rope;
    rope.bodyA = ground, rope.bodyB = below[0];
    rope.localAnchorA = {2 + 12.0f * static_cast<float>(side), 0.5f};
    rope.localAnchorB = {2.5f * static_cast<float>(side), 0};
    rope.line = true;
    rope.rows[axial] = RowDef::rope(1e6, 2e5);
    rope.rows[shear] = rope.rows[rotation] = RowDef::free();
    rope.max_elongation = 1;
    structure.create_joint(rope);
  }
  b2Body* arm = add_box(world, {.x = 2, .y = 12.6, .width = 3, .height = 0.2, .mass = 200, .group = 0});
  ElasticPlasticJointDef axle;
  axle.Initialize(below[0], arm, {2, 12.6f}, {1, 0});
  axle.rows[rotation] = {.cap = 2e4, .cap_reverse = 2e4, .drive = Drive{unlimited, 3}};
  structure.create_joint(axle);
  for (int i = 0; i < 4; ++i)
    add_box(world, {.x = 0.8 * i, .y = 3.3, .width = 0.5, .height = 0.5, .mass = 300, .group = 0});
  // One ball before the save, one after it.
  add_box(world, {.x = -6, .y = 5, .mass = 9000, .group = 0})->SetLinearVelocity({25, 2});
  add_box(world, {.x = 26, .y = 4, .mass = 9000, .group = 0})->SetLinearVelocity({-20, 6});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  b2World world({0, -10});
  Structure structure(world);
  if (std::strcmp(arguments[1], "saved") == 0) {
    build_tower(world, structure);
    const std::size_t joints = structure.joints().size();
    for (int i = 0; i < 30; ++i) {
      world.Step(1 / 60.0f, 8, 3);
      structure.update();
    }
    const std::size_t left = structure.joints().size();
    const std::vector<std::uint8_t> bytes = save_bytes(structure);
    std::ofstream(arguments[2], std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    std::ofstream(arguments[3]) << save_json(structure);
    run_on(world, structure);
    // In the middle: some have gone, and more go.
    return left < joints && structure.joints().size() < left ? 0 : 1;
  }
  std::ifstream file(arguments[std::strcmp(arguments[1], "json") == 0 ? 3 : 2], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (std::strcmp(arguments[1], "json") == 0) {
    load_json(structure, text);
  } else {
    load_bytes(structure, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  run_on(world, structure);
}
