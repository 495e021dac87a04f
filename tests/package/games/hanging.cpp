// What hangs: ties in pieces up to 0.94 of their yield force, chains of pinned links, a rope that was slack,
// and a drawbridge on its motor.
#include "game.h"

using namespace game;

namespace {

// A square steel tie of side d, 4 m long; its load comes on over 5 s and is nudged aside.
void tie(int pieces, double share, double hz) {
  constexpr double d = 0.03, L = 4, E = 210e9, fy = 355e6, A = d * d;
  b2World world({0, 0});
  world.SetAllowSleeping(false);
  Structure structure(world);
  int events = 0;
  structure.on_event([&](const JointEvent&) { ++events; });
  b2Body* last = box(world, 0, 0.5, 1, 1, 0);
  const double l = L / pieces, weight = share * fy * A;
  for (int i = 0; i <= pieces; ++i) {
    const bool load = i == pieces;
    b2Body* body =
        load ? box(world, 0, -L - 0.5, 1, 1, weight / 10) : box(world, 0, -(i + 0.5) * l, d, l, 7850 * A * l);
    ElasticPlasticJointDef def;
    def.Initialize(last, body, {0, static_cast<float>(-i * l)}, {0, -1});
    const double M = fy * d * d * d / 4;
    def.rows[axial] = {.stiffness = E * A / l, .damping_ratio = 0.05, .cap = fy * A, .cap_reverse = fy * A};
    def.rows[shear] = {
        .stiffness = E * A / 3 / l, .damping_ratio = 0.05, .cap = fy * A / 2, .cap_reverse = fy * A / 2};
    def.rows[rotation] = {.stiffness = E * A * A / 12 / l, .damping_ratio = 0.05, .cap = M, .cap_reverse = M};
    def.max_rotation = 0.5;
    structure.create_joint(def);
    last = body;
  }
  last->SetLinearVelocity({0.02f, 0});
  for (int i = 0; i < 15 * hz; ++i) {
    world.SetGravity({0, static_cast<float>(-10 * std::min(1.0, i / (5 * hz)))});
    world.Step(static_cast<float>(1 / hz), 8, 3);
    structure.update();
  }
  check(events == 0, "a tie hangs without a yield", events);
  const double stretched = (pieces + 1) * weight / (E * A / l);
  check_near(last->GetPosition().y, -L - 0.5 - stretched, 2e-3, "  its load is where Hooke has it");
}

// Eight links of 1 m under a load of 600 times a link's own.
void chain() {
  b2World world({0, -10});
  world.SetAllowSleeping(false);
  Structure structure(world);
  b2Body* last = box(world, 0, 0.5, 1, 1, 0);
  for (int i = 0; i <= 8; ++i) {
    b2Body* body = i < 8 ? box(world, 0, -i - 0.5, 0.04, 1, 12.56) : box(world, 0, -8.5, 1, 1, 8000);
    ElasticPlasticJointDef def;
    def.Initialize(last, body, {0, static_cast<float>(-i)}, {0, -1});
    def.rows[rotation] = RowDef::free();
    structure.create_joint(def);
    last = body;
  }
  last->SetLinearVelocity({0.1f, 0});
  run(world, structure, 20);
  check(std::abs(last->GetPosition().y + 8.5) < 1e-2, "a chain hangs", last->GetPosition().y);
  double spin = 0;
  for (const b2Body* b = world.GetBodyList(); b; b = b->GetNext())
    spin = std::max<double>(spin, std::abs(b->GetAngularVelocity()));
  check(spin < 1, "  and does not rattle", spin);
}

void rope() {
  b2World world({0, -10});
  Structure structure(world);
  b2Body *hook = box(world, 0, 0, 1, 1, 0), *load = box(world, 0, -2, 1, 1, 1000);
  ElasticPlasticJointDef def;
  def.InitializeLine(hook, load, {0, 0}, {0, -1.5f});
  def.rows[axial] = RowDef::rope(1e6);
  def.rows[axial].damping_ratio = 0.5;
  const ElasticPlasticJoint* rope = structure.create_joint(def);
  run(world, structure, 5);
  load->SetLinearVelocity({0, 5});
  run(world, structure, 0.5);
  check(rope->force(axial) == 0, "a rope is slack", rope->force(axial));
  run(world, structure, 8);
  check_near(load->GetPosition().y, -2 - 1000 * 10 / 1e6, 1e-5, "  and back at its length");
}

// 12 m of 314 kg/m: 314 · 9.81 · 12²/2 = 221.8 kN m on the motor of its hinge, in any number of pieces.
void drawbridge(int pieces) {
  b2World world({0, -9.81f});
  world.SetAllowSleeping(false);
  Structure structure(world);
  b2Body* last = box(world, -0.5, 0, 1, 1, 0);
  const double l = 12.0 / pieces, EI = 28e6;
  ElasticPlasticJoint* motor = nullptr;
  for (int i = 0; i < pieces; ++i) {
    b2Body* body = box(world, (i + 0.5) * l, 0, l, 0.2, 314 * l);
    ElasticPlasticJointDef def;
    def.Initialize(last, body, {static_cast<float>(i * l), 0}, {1, 0});
    def.rows[rotation] = i > 0 ? RowDef{.stiffness = EI / l, .damping = 0.2 * EI / l}
                               : RowDef{.cap = 2e6, .cap_reverse = 2e6, .drive = Drive{.speed = 0}};
    ElasticPlasticJoint* joint = structure.create_joint(def);
    if (i == 0) motor = joint;
    last = body;
  }
  run(world, structure, 10);
  constexpr double held = 314 * 9.81 * 72;
  check_near(motor->force(rotation), -held, 0.01 * held, "a drawbridge is held");
  motor->drive(rotation, {.target = 0.8, .speed = 0.2});
  run(world, structure, 10);
  check_near(motor->neutral(rotation), 0.8, 1e-6, "  and lifted");
  check_near(motor->force(rotation), -held * std::cos(0.8), 0.03 * held, "  with the moment of its weight");
}

}  // namespace

int main() {
  for (const int pieces : {1, 3, 4, 6, 12}) tie(pieces, 0.3, 60);
  for (const double share : {0.6, 0.94}) tie(4, share, 60);
  tie(4, 0.5, 30);
  chain();
  rope();
  for (const int pieces : {1, 4, 12, 24}) drawbridge(pieces);
  return failed;
}
