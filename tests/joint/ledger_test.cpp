// Every joule is somewhere: kinetic, potential and elastic energy change by what the ledger's terms say, each
// of which is integrated on its own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

struct Balance {
  explicit Balance(Beam& b) : beam(b), start(mechanical()) {}
  double mechanical() const {
    double sum = 0;
    for (b2Body* p : beam.pieces) {
      const double v2 = p->GetLinearVelocity().LengthSquared(), w = p->GetAngularVelocity();
      sum += (p->GetMass() * v2 + p->GetInertia() * w * w) / 2 +
             p->GetMass() * beam.def.gravity * p->GetWorldCenter().y;
    }
    return sum;
  }
  void step(double dt) {
    // Gravity's own share of the numerical loss: it acts at the mean of the velocities before and after the
    // step, and moves bodies by another way.
    const auto moment = [this](double time) {
      double sum = 0;
      for (b2Body* p : beam.pieces)
        sum += p->GetMass() * (p->GetWorldCenter().y + time * p->GetLinearVelocity().y);
      return sum;
    };
    const double before = moment(dt / 2);
    beam.run(dt, dt);
    gravity_loss += beam.def.gravity * (before - moment(-dt / 2));
    turnover = std::max(turnover, std::abs(mechanical() - start) + beam.structure.energy().elastic);
    double kinetic = 0;
    for (b2Body* p : beam.pieces) kinetic += p->GetMass() * p->GetLinearVelocity().LengthSquared() / 2;
    turnover = std::max(turnover, kinetic);
  }
  double error() const {
    const JointEnergy e = beam.structure.energy();
    return mechanical() + e.elastic + e.dissipated + e.damping + e.numerical + e.clamped + gravity_loss -
           e.driven - start;
  }
  Beam& beam;
  double start, gravity_loss = 0, turnover = 0;
};

void expect_balanced(Beam& beam, double seconds, double dt, const char* what) {
  Balance balance(beam);
  for (int i = 0; i < std::lround(seconds / dt); ++i) balance.step(dt);
  const JointEnergy e = beam.structure.energy();
  EXPECT_LE(std::abs(balance.error()), 1e-4 * balance.turnover)
      << what << ": elastic " << e.elastic << ", dissipated " << e.dissipated << ", damping " << e.damping
      << ", numerical " << e.numerical << ", turnover " << balance.turnover;
}

// Off the wall, about the point `middle` m from it, as a rigid body turns.
void let_spin(Beam& beam, float speed, float middle) {
  beam.world.DestroyJoint(beam.joints[0]);
  for (b2Body* p : beam.pieces) {
    p->SetAngularVelocity(speed);
    p->SetLinearVelocity(b2Cross(speed, p->GetWorldCenter() - b2Vec2(middle, 0)));
  }
}

TEST(Ledger, ElasticCantileverSwingsToRest) {
  Beam beam({.pieces = 10, .youngs_modulus = 210e9});
  for (auto* joint : beam.joints) joint->set_stiffness(rotation, 210e9 / 12 / 2, 0.02);
  expect_balanced(beam, 3, 1.0 / 60, "elastic");
  EXPECT_GT(beam.structure.energy().damping, 0);
}

TEST(Ledger, RigidPlasticFall) {
  for (const int pieces : {1, 10}) {
    const double moment = 7800 * 10 * 20.0 * 20.0 / 2;
    Beam beam({.pieces = pieces, .moment_cap = moment / 1.5});
    expect_balanced(beam, 6, 1.0 / 60, "plastic");
    EXPECT_GT(beam.structure.energy().dissipated, 0);
  }
}

TEST(Ledger, BreakingAndReforming) {
  const double moment = 7800 * 10 * 20.0 * 20.0 / 2;
  Beam beam({.pieces = 10, .youngs_modulus = 210e9, .moment_cap = moment / 1.5});
  beam.joints[0]->set_limits(0.3, unlimited, unlimited, unlimited);
  expect_balanced(beam, 2, 1.0 / 60, "breaking");
  EXPECT_EQ(beam.structure.joints().size(), 9u);
}

TEST(Ledger, SpinWithAPlasticSet) {
  Beam beam({.pieces = 10, .length = 10, .youngs_modulus = 210e9, .gravity = 0});
  let_spin(beam, 5, 5);
  // The middle is pulled with ρhω²L²/8 = 2.4e6 N at first.
  for (ElasticPlasticJoint* j : beam.structure.joints()) j->set_caps(axial, 2e6, 2e6);
  expect_balanced(beam, 5, 1.0 / 60, "spin");
  EXPECT_GT(beam.structure.joints()[4]->elongation(), 0.01);
}

// A step along the tangent parts what turns by r θ²/2. Dampers must not let that grow from step to step, as
// strain of their springs; what it costs otherwise is of the order of θ².
TEST(Ledger, SpinOfHeavilyDampedJoints) {
  Beam beam({.pieces = 4, .length = 40, .youngs_modulus = 210e9, .gravity = 0});
  const float speed = 3, turn = speed / 60;
  let_spin(beam, speed, 20);
  for (ElasticPlasticJoint* j : beam.structure.joints()) {
    for (const Row row : {axial, shear, rotation}) j->set_stiffness(row, 1e9, 30);
  }
  Balance balance(beam);
  for (int i = 0; i < 300; ++i) {
    balance.step(1.0 / 60);
    const double energy = balance.mechanical() + beam.structure.energy().elastic;
    ASSERT_LE(energy, balance.start * (1 + turn * turn)) << "step " << i;
  }
  EXPECT_LE(std::abs(balance.error()), 1e-4 * balance.turnover);
}

// Steel that is made to spin has parted by nothing yet, and by r θ²/2 a step later, which no spring may
// store.
TEST(Ledger, SpinOfSteelThatBeginsGainsNothing) {
  for (const int pieces : {5, 20}) {
    Beam beam({.pieces = pieces, .length = 20, .youngs_modulus = 210e9, .gravity = 0});
    let_spin(beam, 3, 10);
    Balance balance(beam);
    for (int i = 0; i < 240; ++i) {
      balance.step(1.0 / 60);
      const double energy = balance.mechanical() + beam.structure.energy().elastic;
      ASSERT_LE(energy, balance.start * (1 + 1e-6)) << pieces << ", step " << i;
    }
  }
}

// Steps of 1/170 to 1/21 s in any order: what a long one parts, a short one finds. Energy is up by no more
// than the square of the turn in the longest.
TEST(Ledger, SpinsInStepsOfAnyLength) {
  for (const double axial_stiffness : {1e8, 6.3e9, rigid}) {
    for (const double span : {2., 8.}) {
      Beam beam({.pieces = 8, .length = 8, .youngs_modulus = 210e9, .gravity = 0});
      const float speed = 2;
      let_spin(beam, speed, 4);
      for (ElasticPlasticJoint* j : beam.structure.joints())
        for (const Row row : {axial, shear}) j->set_stiffness(row, axial_stiffness, 0);
      Balance balance(beam);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> part(-0.5, 0.5);
      const double turn = speed / 60 * std::sqrt(span);
      for (int i = 0; i < 1000; ++i) {
        balance.step(std::pow(span, part(random)) / 60);
        const double energy = balance.mechanical() + beam.structure.energy().elastic;
        ASSERT_LE(energy, balance.start * (1 + turn * turn)) << axial_stiffness << ", step " << i;
      }
    }
  }
}

// What a turn has parted in a step of 1/60 s is taken back in as long, be it in steps of 1/5000 s, also where
// a joint that goes meanwhile has the structure formed anew. At once it would be a blow of 28 m/s.
TEST(Ledger, AJointThatGoesBetweenALongAndAShortStepOfASpin) {
  Beam beam({.pieces = 3, .length = 60, .gravity = 0});
  const float speed = 2, turn = speed / 60;
  let_spin(beam, speed, 30);
  Balance balance(beam);
  for (int i = 0; i < 20; ++i) balance.step(1.0 / 60);
  beam.world.DestroyJoint(beam.joints[2]);
  for (int i = 0; i < 200; ++i) {
    balance.step(1.0 / 5000);
    const double energy = balance.mechanical() + beam.structure.energy().elastic;
    ASSERT_LE(energy, balance.start * (1 + turn * turn)) << "step " << i;
  }
}

// What turning has parted is taken back in the next step; a second joint between the same two, made
// meanwhile, holds them as they are. They must not strain each other: rigid, they would with megajoules.
TEST(Ledger, AParallelJointMadeInASpin) {
  Beam beam({.pieces = 2, .length = 40, .gravity = 0});
  let_spin(beam, 2, 20);
  Balance balance(beam);
  for (int i = 0; i < 20; ++i) balance.step(1.0 / 60);
  ElasticPlasticJointDef second;
  second.Initialize(beam.pieces[0], beam.pieces[1],
                    0.5f * (beam.pieces[0]->GetPosition() + beam.pieces[1]->GetPosition()));
  beam.structure.create_joint(second);
  for (int i = 0; i < 20; ++i) {
    balance.step(1.0 / 60);
    EXPECT_LE(balance.mechanical() + beam.structure.energy().elastic, (1 + 1e-4) * balance.start) << i;
  }
}

// A vibration that its damper ends leaves all of its energy there, and to the integration what δ cannot damp
// as the damper would: less with each shorter step, also where δ > 1.
TEST(Ledger, DampersTakeTheEnergyOfAVibration) {
  const double omega = 11;
  for (const double ratio : {0.05, 0.2}) {
    for (const double hz : {60., 144., 480., 2000., 8000.}) {
      b2World world({0, 0});
      world.SetAllowSleeping(false);
      Structure structure(world, {.keep_ledger = true});
      b2Body* bar = add_box(world, {.x = 1, .width = 2, .height = 0.2, .mass = 1000});
      const double inertia = double{bar->GetInertia()} + bar->GetMass(), k = inertia * omega * omega;
      ElasticPlasticJointDef def;
      def.Initialize(add_box(world, {.x = -0.5, .type = b2_staticBody}), bar, {0, 0}, {1, 0});
      def.rows[rotation] = {.stiffness = k};
      def.rows[rotation].damping = 2 * ratio / omega * k;
      structure.create_joint(def);
      bar->SetAngularVelocity(0.5f);
      bar->SetLinearVelocity({0, 0.5f});
      for (int i = 0; i < 10 * hz; ++i) {
        world.Step(static_cast<float>(1 / hz), 8, 3);
        structure.update();
      }
      const double energy = inertia * 0.25 / 2, left = std::exp(-2 * ratio * omega * 10);
      EXPECT_NEAR(structure.energy().damping / energy, 1 - left, 0.01 * left + 0.25 * omega / hz)
          << ratio << ", " << hz;
    }
  }
}

// A bar that swings on a pin from level pulls by N = 5/2 m g sin α at the angle α, and turns by α'² = 3 g sin
// α/l: its axial damper takes τ/k ∫ N'² dt, however far it turns in a step.
TEST(Ledger, DampersOfASwingTakeWhatItsPullStrainsThemBy) {
  const double gravity = 10, tau = 0.003, pull = 2.5 * 150 * gravity;
  for (const double k : {2.1e7, 2.1e9}) {
    for (const double hz : {30., 60., 240.}) {
      b2World world({0, static_cast<float>(-gravity)});
      world.SetAllowSleeping(false);
      Structure structure(world, {.keep_ledger = true});
      b2Body* bar = add_box(world, {.x = 1, .width = 2, .height = 0.01f, .mass = 150});
      ElasticPlasticJointDef def;
      def.Initialize(add_box(world, {.x = -0.5, .type = b2_staticBody}), bar, {0, 0}, {1, 0});
      def.axisFollow = 1;
      def.rows[axial] = {.stiffness = k};
      def.rows[axial].damping = tau * k;
      def.rows[rotation] = RowDef::free();
      structure.create_joint(def);
      double taken = 0;
      for (int i = 0; i < 10 * hz; ++i) {
        world.Step(static_cast<float>(1 / hz), 8, 3);
        structure.update();
        const double speed = bar->GetAngularVelocity(), rate = pull * std::cos(bar->GetAngle()) * speed / k;
        taken += tau * k * rate * rate / hz;
      }
      EXPECT_NEAR(structure.energy().damping, taken, 0.3 * taken + 1e-3) << k << ", " << hz;
    }
  }
}

// Implicit Euler damps a vibration as a damper k h would. Of that a damper c takes c/kh, and the rest is
// numerical; all of it at steps that resolve the specks at both ends of the spring.
TEST(Ledger, DampersOfImplicitRowsTakeTheirShare) {
  const double mass = 1000, omega = 6, k = mass * omega * omega, time = 10;
  for (const double hz : {60., 4000.}) {
    for (const double c : {0.25 * k / 60, k / 60, 2 * k / 60}) {
      b2World world({0, 0});
      world.SetAllowSleeping(false);
      Structure structure(world, {.keep_ledger = true});
      b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody});
      b2Body* specks[2];
      for (int i : {0, 1}) specks[i] = add_box(world, {.x = 0.5 + i, .mass = 5e-5f});
      b2Body* block = add_box(world, {.x = 2.5, .mass = static_cast<float>(mass)});
      ElasticPlasticJointDef def;
      def.Initialize(wall, specks[0], {0, 0}, {1, 0});
      structure.create_joint(def);
      def.Initialize(specks[1], block, {2, 0}, {1, 0});
      structure.create_joint(def);
      def.Initialize(specks[0], specks[1], {1, 0}, {1, 0});
      def.rows[axial] = {.stiffness = k};
      def.rows[axial].damping = c;
      structure.create_joint(def);
      for (b2Body* b : {specks[1], block}) b->SetLinearVelocity({0.1f, 0});
      for (int i = 0; i < time * hz; ++i) {
        world.Step(static_cast<float>(1 / hz), 8, 3);
        structure.update();
      }
      const double of_step = hz == 60 ? k / hz : c, start = mass * 0.01 / 2;
      const double lost = start * (1 - std::exp(-of_step * time / mass));
      EXPECT_NEAR(structure.energy().damping, std::min(c, of_step) / of_step * lost, 0.02 * start)
          << c << ", " << hz;
      EXPECT_GE(structure.energy().numerical, -0.002 * start) << c << ", " << hz;
    }
  }
}

// Nor may parallel joints that wait for what a long step parted strain each other: all by the same share.
TEST(Ledger, ParallelJointsInShorterStepsOfASpin) {
  Beam beam({.pieces = 2, .length = 40, .gravity = 0});
  for (const float angle : {0.7f, 2.0f}) {
    ElasticPlasticJointDef more;
    more.Initialize(beam.pieces[0], beam.pieces[1], {20 + 10 * std::cos(angle), 10 * std::sin(angle)},
                    {std::cos(2 * angle), std::sin(2 * angle)});
    beam.structure.create_joint(more);
  }
  let_spin(beam, 3, 20);
  Balance balance(beam);
  for (int i = 0; i < 60; ++i) {
    balance.step(i % 6 == 0 ? 1.0 / 15 : i % 6 < 3 ? 1.0 / 240 : 1.0 / 100);
    EXPECT_LE(beam.structure.energy().elastic, 1e-4 * balance.start) << i;
  }
}

// A ball on a long rope parts from its circle by r(ωh)²/2 in a step of 1/30 s. Where the blow's parts wait
// for that, stiff rows of what it strikes must not wait for strains of their own: they had ten times all
// energy.
TEST(Ledger, ABallOnARopeStrikesInPartsOfALongStep) {
  for (const double hz : {30., 60.}) {
    Beam beam({.pieces = 3,
               .length = 4,
               .height = 0.15,
               .youngs_modulus = 210e9,
               .damping_time = 0,
               .moment_cap = 235e6 * 0.15 * 0.15 / 4,
               .angle = std::numbers::pi / 2});
    for (ElasticPlasticJoint* joint : beam.joints) {
      joint->set_caps(axial, 235e6 * 0.15, 235e6 * 0.15);
      joint->set_stiffness(shear, rigid, 0);
    }
    b2Body* ball = add_box(beam.world, {.x = -0.775, .y = 2.8});
    ball->DestroyFixture(ball->GetFixtureList());
    b2CircleShape circle;
    circle.m_radius = 0.5f;
    ball->CreateFixture(&circle, static_cast<float>(200 / 0.15 / (b2_pi * 0.25)));
    ElasticPlasticJointDef rope;
    rope.InitializeLine(beam.wall, ball, vec(-0.775, 12), vec(-0.775, 2.8));
    rope.rows[axial] = RowDef::rope(1.3e8);
    beam.structure.create_joint(rope);
    ball->SetLinearVelocity(vec(7.75, 0));
    const auto energy = [&] {
      double sum = beam.structure.energy().elastic + beam.structure.energy().dissipated;
      for (const b2Body* b = beam.world.GetBodyList(); b != nullptr; b = b->GetNext())
        sum += (b->GetMass() * b->GetLinearVelocity().LengthSquared() +
                b->GetInertia() * b->GetAngularVelocity() * b->GetAngularVelocity()) /
                   2 +
               b->GetMass() * 10 * b->GetWorldCenter().y;
      return sum;
    };
    const double first = energy(), kinetic = ball->GetMass() * 7.75 * 7.75 / 2;
    for (int i = 0; i < 1.5 * hz; ++i) {
      beam.run(1 / hz, 1 / hz);
      EXPECT_LE(energy(), first + 0.02 * kinetic) << hz << ", " << i;
    }
  }
}

// Likewise bodies that may not move any more: what lies between them stays parted, in each of the islands
// that they make of one.
void hold_in_a_spin(int pieces, std::initializer_list<std::size_t> held) {
  Beam beam({.pieces = pieces, .length = 20.0 * pieces, .gravity = 0});
  let_spin(beam, 2, 10.0f * static_cast<float>(pieces));
  Balance balance(beam);
  for (int i = 0; i < 20; ++i) balance.step(1.0 / 60);
  for (const std::size_t i : held) beam.pieces[i]->SetType(b2_staticBody);
  for (int i = 0; i < 20; ++i) {
    balance.step(1.0 / 60);
    EXPECT_LE(balance.mechanical() + beam.structure.energy().elastic, balance.start) << i;
  }
}

TEST(Ledger, BodiesHeldInASpin) {
  hold_in_a_spin(3, {0, 2});
  hold_in_a_spin(5, {0, 2, 4});
}

// What a moving wall does to the beam, while it holds, and in the step in which it breaks.
TEST(Ledger, AWallThatMovesDrivesTheBeam) {
  for (const double capacity : {unlimited, 1e7}) {
    Beam beam({.pieces = 5, .length = 10, .youngs_modulus = 210e9, .moment_cap = capacity});
    beam.joints[0]->set_limits(0.1, unlimited, unlimited, unlimited);
    beam.wall->SetType(b2_kinematicBody);
    Balance balance(beam);
    for (int i = 0; i < 240; ++i) {
      beam.wall->SetLinearVelocity({0, static_cast<float>(3 * std::sin(0.1 * i))});
      beam.wall->SetAngularVelocity(static_cast<float>(2 * std::cos(0.07 * i)));
      balance.step(1.0 / 60);
      ASSERT_LE(std::abs(balance.error()), 1e-4 * balance.turnover) << i;
    }
    EXPECT_GT(std::abs(beam.structure.energy().driven), 1e5);
    EXPECT_EQ(beam.structure.joints().size(), capacity < unlimited ? 4u : 5u);
  }
}

// A tip of a million times a piece's weight is thrown faster than Box2D lets it.
TEST(Ledger, SlowedByTheSpeedLimit) {
  Beam beam(
      {.pieces = 6, .length = 6, .height = 0.5, .density = 1000, .youngs_modulus = 210e9, .damping_time = 0});
  beam.pieces.push_back(add_box(beam.world, {.x = 6.5, .height = 0.5, .mass = 5e8}));
  ElasticPlasticJointDef weld;
  weld.Initialize(beam.pieces[5], beam.pieces[6], {6, 0}, {1, 0});
  beam.structure.create_joint(weld);
  beam.pieces[6]->SetLinearVelocity({0, 300});
  expect_balanced(beam, 5, 1.0 / 60, "slowed");
  EXPECT_GT(beam.structure.energy().clamped, 1e9);
}

// A slowed step leaves gaps of metres, of bodies that were to turn far in it: a short step that closed them
// at once would be a blow of many times the energy that there was.
TEST(Ledger, GapsThatASlowedStepLeavesAreNoBlowToAShortOne) {
  for (const double length : {60.0, 200.0, 600.0}) {
    Beam beam({.pieces = 2, .length = length, .gravity = 0});
    let_spin(beam, 20, static_cast<float>(length / 3));
    Balance balance(beam);
    for (int i = 0; i < 5; ++i) balance.step(1.0 / 5000);
    balance.step(1.0 / 60);
    ASSERT_GT(beam.structure.report().slowed, 0.1);
    for (int i = 0; i < 100; ++i) {
      balance.step(1.0 / 5000);
      ASSERT_LE(balance.mechanical(), balance.start) << length << ", step " << i;
    }
  }
}

// A spring with a damper beside it, too, goes only as far as the bodies do, not as far as was solved for.
TEST(Ledger, DamperSlowedByTheSpeedLimit) {
  Beam beam({.pieces = 2, .length = 2, .gravity = 0});
  let_spin(beam, 0, 0);
  beam.joints[1]->set_stiffness(axial, 1000, 200);
  beam.pieces[1]->SetLinearVelocity({8000, 0});
  Balance balance(beam);
  balance.step(1.0 / 60);
  const float apart = beam.pieces[1]->GetWorldCenter().x - beam.pieces[0]->GetWorldCenter().x - 1;
  EXPECT_NEAR(beam.joints[1]->elastic(axial), apart, 1e-6);
  EXPECT_GT(apart, 3.9f);  // 2 m each
  balance.step(1.0 / 60);
  EXPECT_LE(std::abs(balance.error()), 1e-4 * balance.turnover);
}

// What short steps part is not to be taken back as late as if the long one before them had parted it.
TEST(Ledger, SpinThatBeginsAfterALongStep) {
  Beam beam({.pieces = 2, .length = 72, .gravity = 0});
  beam.run(1.0 / 60, 1.0 / 60);
  const float speed = 22, turn = speed / 1000;
  let_spin(beam, speed, 36);
  const double start = kinetic_energy(beam.pieces);
  for (int i = 0; i < 40; ++i) {
    beam.run(0.001, 0.001);
    EXPECT_LE(std::abs(kinetic_energy(beam.pieces) / start - 1), turn * turn) << "step " << i;
  }
}

// Rigid joints over a light piece stop a block of 1000 t at 0.1 m/s, in short steps with 1e8 N. That force is
// no load: a step that is 333 times as long must not take it over.
TEST(Ledger, FlungApartInStepsOfChangingLength) {
  for (const double light : {0.001, 0.006, 0.1}) {
    for (const int stopping : {1, 2, 5}) {
      b2World world({0, 0});
      Structure structure(world, {.keep_ledger = true});
      b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody, .group = -1});
      b2Body* piece = add_box(world, {.x = 0.5, .mass = light, .group = -1});
      b2Body* block = add_box(world, {.x = 1.5, .mass = 1e6, .group = -1});
      ElasticPlasticJointDef def;
      def.Initialize(wall, piece, vec(0, 0), {1, 0});
      structure.create_joint(def);
      def.Initialize(piece, block, vec(1, 0), {1, 0});
      structure.create_joint(def);
      block->SetLinearVelocity({-0.1f, 0});
      const std::vector<b2Body*> moving{piece, block};
      const auto energy = [&] { return kinetic_energy(moving) + structure.energy().elastic; };
      for (int i = 0; i < stopping; ++i) {
        world.Step(1 / 5000.0f, 8, 3);
        structure.update();
      }
      const double stopped = energy();
      world.Step(1 / 15.0f, 8, 3);
      structure.update();
      EXPECT_LE(energy(), stopped * (1 + 1e-4)) << light << " kg, " << stopping << " steps";
    }
  }
}

// Springs that were implicit, as each step was of another length, become Newmark's where a mass changes and
// the component is formed anew.
TEST(Ledger, ImplicitSpringsBecomeNewmarks) {
  for (const double stiffness : {0.5, 2.0, 8.0}) {  // of m/h², the longer step's
    for (int stopping = 1; stopping < 12; ++stopping) {
      b2World world({0, 0});
      Structure structure(world, {.keep_ledger = true});
      b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody, .group = -1});
      b2Body* block = add_box(world, {.x = 0.5, .mass = 1, .group = -1});
      ElasticPlasticJointDef def;
      def.Initialize(wall, block, vec(0, 0), {1, 0});
      def.rows[axial].stiffness = stiffness * 900;
      structure.create_joint(def);
      block->SetLinearVelocity({1, 0});
      const std::vector<b2Body*> moving{block};
      const auto energy = [&] { return kinetic_energy(moving) + structure.energy().elastic; };
      const auto step = [&](float dt) {
        world.Step(dt, 8, 3);
        structure.update();
      };
      for (int i = 0; i < stopping; ++i) step(i % 2 == 0 ? 1 / 120.0f : 1 / 30.0f);
      const double before = energy();
      b2MassData mass;
      block->GetMassData(&mass);
      mass.mass *= 1 + 1e-6f;
      block->SetMassData(&mass);
      for (int i = 0; i < 5; ++i) {
        step(1 / 30.0f);
        EXPECT_LE(energy(), before * (1 + 1e-4)) << stiffness << ", " << stopping << " steps, " << i;
      }
    }
  }
}

TEST(Ledger, StepsOfChangingLength) {
  Beam beam({.pieces = 5});
  Balance balance(beam);
  for (int i = 0; i < 300; ++i) balance.step(i % 3 == 0 ? 1.0 / 60 : 1.0 / 90);
  EXPECT_LE(std::abs(balance.error()), 1e-4 * balance.turnover);
}

}  // namespace
}  // namespace ductile
