// Far beyond what is sensible, item by item, with either solver and any law: nothing becomes NaN or gains
// energy, hangs, aborts, is refused or hits the bound on rounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bodies.h"
#include "ductile/ledger.h"
#include "ductile/problem.h"
#include "ductile/simulation.h"

namespace ductile {
namespace {

enum class Law { rigid, elastic, plastic, interacting, breaking };

constexpr double sixtieths[] = {1.0 / 60}, long_steps[] = {1.0 / 15}, short_steps[] = {1.0 / 5000},
                 changing_steps[] = {1.0 / 15, 1.0 / 5000, 1.0 / 60, 1.0 / 240, 1.0 / 30},
                 some_of_no_time[] = {0, 1.0 / 60, 0, 0, 1.0 / 240};

// Of a beam that is joined to a wall at its left end.
struct GameDef {
  int pieces = 6;
  double length = 1, height = 0.5;  // m, of a piece
  double density = 1000;            // kg/m²
  double gravity = 10;
  double E = 210e9;        // Pa, of the laws that are neither rigid nor interacting
  double strength = 0.75;  // moment cap of the plastic laws, as a share of what the beam's weight asks for
  double x = 0, y = 0;     // of the root
  bool fixtures = true;
  std::span<const double> steps = sixtieths;  // s, again and again
  int velocity_iterations = 8, position_iterations = 3;
  int count = 200;  // steps
};

struct Game {
  Game(const GameDef& s, SolverKind k, Law l)
      : setup(s),
        kind(k),
        law(l),
        world(std::make_unique<b2World>(vec(0, -s.gravity))),
        structure(std::in_place, *world, StructureDef{.solver = k, .keep_ledger = k == SolverKind::direct}) {
    world->SetAllowSleeping(false);
    b2BodyDef ground;
    ground.position = vec(s.x, s.y);
    wall = world->CreateBody(&ground);
    b2Body* last = wall;
    for (int i = 0; i < s.pieces; ++i) {
      pieces.push_back(add_piece(s.x + (i + 0.5) * s.length, s.y));
      join(last, pieces.back(), vec(s.x + i * s.length, s.y));
      last = pieces.back();
    }
  }

  b2Body* add_piece(double x, double y, double mass = 1, short group = -1) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = vec(x, y);
    b2Body* piece = world->CreateBody(&def);
    const double m = mass * piece_mass();
    if (setup.fixtures) {
      b2PolygonShape box;
      box.SetAsBox(static_cast<float>(setup.length / 2), static_cast<float>(setup.height / 2));
      b2FixtureDef fixture;
      fixture.shape = &box;
      fixture.density = static_cast<float>(m / (setup.length * setup.height));
      fixture.friction = 0.6f;
      fixture.filter.groupIndex = group;
      piece->CreateFixture(&fixture);
    } else {
      const double i = m * (setup.length * setup.length + setup.height * setup.height) / 12;
      const b2MassData data{static_cast<float>(m), {0, 0}, static_cast<float>(i)};
      piece->SetMassData(&data);
    }
    return piece;
  }
  double piece_mass() const { return setup.density * setup.length * setup.height; }
  // Of the weight of all pieces, about the root.
  double root_moment() const {
    const double all = setup.pieces * setup.length;
    return setup.density * setup.height * std::max(setup.gravity, 1.0) * all * all / 2;
  }

  ElasticPlasticJointDef joint_def(b2Body* a, b2Body* b, const b2Vec2& at) const {
    ElasticPlasticJointDef def;
    def.Initialize(a, b, at, {1, 0});
    const double h = setup.height, l = setup.length;
    if (law != Law::rigid && law != Law::interacting) {
      def.rows[axial].stiffness = setup.E * h / l;
      def.rows[shear].stiffness = setup.E / 2.6 * 5 / 6 * h / l;
      def.rows[rotation] = {.stiffness = setup.E * h * h * h / 12 / l, .damping_ratio = 0.02};
      // Steel as built: what a step does not resolve must not ring on until the step or a body changes.
      for (RowDef& row : def.rows) row.damping = 0.01 * row.stiffness;
    }
    if (law >= Law::plastic) {
      const double M = setup.strength * root_moment(), N = M / h;
      def.rows[rotation].cap = def.rows[rotation].cap_reverse = M;
      def.rows[axial].cap = def.rows[axial].cap_reverse = 4 * N;  // of a rectangle: M = N h / 4
      def.rows[shear].cap = def.rows[shear].cap_reverse = 2 * N;
    }
    if (law == Law::interacting && setup.strength > 0) {
      const double M = def.rows[rotation].cap, N = def.rows[axial].cap;
      for (const double side : {1., -1.}) {
        for (double n = 1; n > -1; n -= 0.25)
          def.interaction.push_back({side * n * N, side * (1 - n * n) * M});
      }
    }
    if (law == Law::breaking) {
      def.max_rotation = 0.15;
      def.max_elongation = def.max_slip = 0.05 * l;
    }
    return def;
  }
  ElasticPlasticJoint* join(b2Body* a, b2Body* b, const b2Vec2& at) {
    return structure->create_joint(joint_def(a, b, at));
  }
  b2Vec2 tip() const { return vec(setup.x + setup.pieces * setup.length, setup.y); }

  const GameDef setup;
  const SolverKind kind;
  const Law law;
  std::unique_ptr<b2World> world;
  std::optional<Structure> structure;
  b2Body* wall;
  std::vector<b2Body*> pieces;
};

// What energies are held to, and why it is less than usual.
struct Judged {
  double nowhere = 1e-4, lost = 1e-3;  // shares of the turnover that may come from nowhere, or be lost there
  bool told = true;                    // Box2D tells what its joints exert
  bool moved = false;  // poses are set by hand, or corrected by stock joints: that lifts weights
};
struct Item {
  std::string name;
  GameDef setup = {};
  std::function<void(Game&)> build = {};             // adds to the beam
  std::function<void(Game&, int)> before_step = {};  // what the game does
  Judged judged = {};
};

std::vector<Item> make_items() {
  std::vector<Item> all;
  const auto resting = [](double mass) {
    return [=](Game& g) {
      const GameDef& s = g.setup;
      for (const int from_tip : {0, 2}) {
        g.add_piece(g.tip().x - (0.5 + from_tip) * s.length, s.y + s.height * 1.02, mass, 0);
      }
    };
  };
  const auto welded = [](double mass) {
    return [=](Game& g) {
      b2Body* end = g.add_piece(g.tip().x + g.setup.length / 2, g.setup.y, mass);
      ElasticPlasticJointDef weld;
      weld.Initialize(g.pieces.back(), end, g.tip(), {1, 0});
      g.structure->create_joint(weld);
    };
  };
  all.push_back({.name = "contact_mass_1e3", .build = resting(1e3)});
  all.push_back({.name = "welded_mass_1e6", .build = welded(1e6)});
  all.push_back({.name = "welded_mass_1e_6", .build = welded(1e-6)});
  all.push_back({.name = "five_centimetres",
                 .setup = {.pieces = 5, .length = 0.01, .height = 0.005, .fixtures = false}});
  all.push_back({.name = "one_kilometre", .setup = {.pieces = 10, .length = 100, .height = 50}});
  all.push_back({.name = "dt_15", .setup = {.steps = long_steps}, .build = resting(1)});
  all.push_back({.name = "dt_5000", .setup = {.steps = short_steps, .count = 500}, .build = resting(1)});
  all.push_back({.name = "dt_changing", .setup = {.steps = changing_steps}, .build = resting(1)});
  all.push_back({.name = "dt_0", .setup = {.steps = some_of_no_time}, .build = resting(1)});
  all.push_back({.name = "E_1e6", .setup = {.E = 210e15}, .build = resting(1)});
  all.push_back({.name = "E_1e_6", .setup = {.E = 210e3}, .build = resting(1)});
  all.push_back({.name = "caps_0", .setup = {.strength = 0}, .build = resting(1)});
  all.push_back({.name = "caps_tiny", .setup = {.strength = 1e-30}, .build = resting(1)});
  all.push_back({.name = "caps_huge", .setup = {.strength = 1e100}, .build = resting(1)});
  all.push_back({.name = "gravity_0", .setup = {.gravity = 0}, .build = resting(1)});
  // What contacts push beyond the speed limit after the joints have had their say is taken unseen.
  all.push_back(
      {.name = "gravity_1e4", .setup = {.gravity = 1e4}, .build = resting(1), .judged = {.lost = unlimited}});
  // 2 m and π/2 a step.
  all.push_back({.name = "speed_limit_thrown", .setup = {.gravity = 0}, .build = [](Game& g) {
                   g.world->DestroyJoint(g.structure->joints()[0]);
                   for (b2Body* b : g.pieces) b->SetLinearVelocity({1000, 300});
                 }});
  all.push_back({.name = "speed_limit_spinning", .setup = {.gravity = 0}, .build = [](Game& g) {
                   g.world->DestroyJoint(g.structure->joints()[0]);
                   for (b2Body* b : g.pieces) {
                     b->SetLinearVelocity(b2Cross(200.0f, b->GetPosition() - b2Vec2{3, 0}));
                     b->SetAngularVelocity(200);
                   }
                 }});
  all.push_back({.name = "speed_limit_struck", .setup = {.gravity = 0}, .build = [](Game& g) {
                   b2Body* shot = g.add_piece(5, 3, 1, 0);
                   shot->SetLinearVelocity({0, -500});
                   shot->SetAngularVelocity(90);
                   shot->SetBullet(true);
                 }});
  all.push_back({.name = "far_1e5", .setup = {.x = 1e5, .y = -1e5}, .build = resting(1)});
  all.push_back({.name = "shift_origin",
                 .setup = {.x = 1e5, .y = -1e5},
                 .build = resting(1),
                 .before_step = [](Game& g, int step) {
                   const b2Vec2 shifts[] = {{1e5f, -1e5f}, {-33.3f, 7.7f}, {33.3f, 0}, {-1e5f, 1e5f}};
                   if (step % 10 == 5) g.world->ShiftOrigin(shifts[step / 10 % 4]);
                 }});
  all.push_back({.name = "static_static", .build = [](Game& g) {
                   b2BodyDef def;
                   def.position = g.wall->GetPosition() - b2Vec2{1, 0};
                   b2Body* other = g.world->CreateBody(&def);
                   def.type = b2_kinematicBody;
                   b2Body* kinematic = g.world->CreateBody(&def);
                   g.join(other, g.wall, {-0.5f, 0});
                   g.join(kinematic, g.wall, {-0.5f, 0});
                   g.join(g.wall, kinematic, {-0.5f, 0});
                 }});
  all.push_back({.name = "parallel", .build = [](Game& g) {
                   b2Body* last = g.wall;
                   for (b2Body* b : g.pieces) {
                     const b2Vec2 at = b->GetPosition() - b2Vec2{0.5f, 0};
                     for (const float y : {-0.25f, 0.0f, 0.25f}) g.join(last, b, at + b2Vec2{0, y});
                     g.join(b, last, at);
                     last = b;
                   }
                 }});
  all.push_back({.name = "anchors_outside", .build = [](Game& g) {
                   while (!g.structure->joints().empty()) g.world->DestroyJoint(g.structure->joints().back());
                   b2Body* last = g.wall;
                   for (std::size_t i = 0; i < g.pieces.size(); ++i) {
                     g.join(last, g.pieces[i], vec(1.5 * static_cast<double>(i), i % 2 == 0 ? 2 : -3));
                     last = g.pieces[i];
                   }
                 }});
  all.push_back({.name = "fixed_rotation_all", .build = [](Game& g) {
                   for (b2Body* b : g.pieces) b->SetFixedRotation(true);
                 }});
  all.push_back({.name = "fixed_rotation_on_and_off", .before_step = [](Game& g, int step) {
                   b2Body* b = g.pieces[static_cast<std::size_t>(step / 10 % 6)];
                   if (step % 10 == 3) b->SetFixedRotation(!b->IsFixedRotation());
                 }});
  all.push_back({.name = "no_velocity_iterations", .setup = {.velocity_iterations = 0}, .build = resting(1)});
  all.push_back({.name = "no_position_iterations", .setup = {.position_iterations = 0}, .build = resting(1)});
  all.push_back({.name = "no_iterations",
                 .setup = {.velocity_iterations = 0, .position_iterations = 0},
                 .build = resting(1)});
  const auto shoot = [](Game& g, int step) {
    if (step % 30 != 5) return;
    b2Body* shot = g.add_piece(g.setup.x + 1.3 + step / 30 % 5, g.setup.y + 4, 0.3, 0);
    shot->SetBullet(true);
    shot->SetLinearVelocity({0, -60});
  };
  all.push_back({.name = "bullets", .before_step = shoot});
  // Without gravity: a step that is spread over several calls does its work in the first.
  all.push_back({.name = "sub_stepping",
                 .setup = {.gravity = 0},
                 .build = [](Game& g) { g.world->SetSubStepping(true); },
                 .before_step = shoot});
  all.push_back({.name = "kinematic_shaking",
                 .build = [](Game& g) { g.wall->SetType(b2_kinematicBody); },
                 .before_step =
                     [](Game& g, int step) {
                       g.wall->SetLinearVelocity(vec(0, 3 * std::sin(0.1 * step)));
                       g.wall->SetAngularVelocity(static_cast<float>(2 * std::cos(0.07 * step)));
                     }});
  all.push_back({.name = "kinematic_jerking",
                 .build = [](Game& g) { g.wall->SetType(b2_kinematicBody); },
                 .before_step =
                     [](Game& g, int step) {
                       g.wall->SetLinearVelocity(step / 20 % 2 == 0 ? b2Vec2{20, 0} : b2Vec2{-20, 5});
                     }});
  const auto stock = [&](const std::string& name, const std::function<void(Game&)>& build,
                         const Judged& judged = {.moved = true}) {
    all.push_back({.name = "stock_" + name, .build = build, .judged = judged});
  };
  stock("revolute", [](Game& g) {
    b2RevoluteJointDef def;
    def.Initialize(g.wall, g.pieces.back(), g.tip());
    g.world->CreateJoint(&def);
    def.Initialize(g.pieces[1], g.pieces[2], {2, 0});
    def.enableMotor = true, def.motorSpeed = 3, def.maxMotorTorque = 1e5f;
    g.world->CreateJoint(&def);
  });
  stock("prismatic", [](Game& g) {
    b2PrismaticJointDef def;
    def.Initialize(g.wall, g.pieces.back(), g.tip(), {0, 1});
    def.enableLimit = true, def.lowerTranslation = -0.3f, def.upperTranslation = 0.1f;
    g.world->CreateJoint(&def);
  });
  stock("distance", [](Game& g) {
    b2DistanceJointDef def;
    def.Initialize(g.wall, g.pieces.back(), g.tip() + b2Vec2{0, 4}, g.tip());
    g.world->CreateJoint(&def);
    def.Initialize(g.pieces[1], g.pieces[4], g.pieces[1]->GetPosition(), g.pieces[4]->GetPosition());
    b2LinearStiffness(def.stiffness, def.damping, 8, 0.3f, def.bodyA, def.bodyB);
    g.world->CreateJoint(&def);
  });
  stock("pulley_and_gear",
        [](Game& g) {
          b2Body* load = g.add_piece(g.tip().x + 3, -3);
          b2PulleyJointDef def;
          def.Initialize(g.pieces.back(), load, g.tip() + b2Vec2{0, 5}, g.tip() + b2Vec2{3, 5}, g.tip(),
                         load->GetPosition(), 1);
          g.world->CreateJoint(&def);
          b2RevoluteJointDef pin;
          pin.Initialize(g.wall, g.pieces[0], {0, 0});
          b2Joint* one = g.world->CreateJoint(&pin);
          pin.Initialize(g.wall, g.pieces[2], {2, 0});
          b2Joint* other = g.world->CreateJoint(&pin);
          b2GearJointDef gear;
          gear.bodyA = g.pieces[0], gear.bodyB = g.pieces[2];
          gear.joint1 = one, gear.joint2 = other, gear.ratio = -1;
          g.world->CreateJoint(&gear);
        },
        {.told = false, .moved = true});
  stock("weld", [](Game& g) {
    b2WeldJointDef def;
    def.Initialize(g.pieces[0], g.pieces[3], {2, 0});
    g.world->CreateJoint(&def);
    def.Initialize(g.wall, g.pieces[5], {6, 0});
    b2AngularStiffness(def.stiffness, def.damping, 5, 0.3f, def.bodyA, def.bodyB);
    g.world->CreateJoint(&def);
  });
  stock("wheel", [](Game& g) {
    b2Body* wheel = g.add_piece(g.tip().x, -1);
    b2WheelJointDef def;
    def.Initialize(g.pieces.back(), wheel, wheel->GetPosition(), {0, 1});
    def.enableMotor = true, def.motorSpeed = 20, def.maxMotorTorque = 1e4f;
    b2LinearStiffness(def.stiffness, def.damping, 4, 0.7f, def.bodyA, def.bodyB);
    g.world->CreateJoint(&def);
  });
  stock("friction", [](Game& g) {
    b2FrictionJointDef def;
    def.Initialize(g.wall, g.pieces.back(), g.tip());
    def.maxForce = 1e4f, def.maxTorque = 1e3f;
    g.world->CreateJoint(&def);
  });
  stock("motor", [](Game& g) {
    b2MotorJointDef def;
    def.Initialize(g.wall, g.pieces.back());
    def.maxForce = 1e6f, def.maxTorque = 1e5f;
    g.world->CreateJoint(&def);
  });
  stock(
      "mouse",
      [](Game& g) {
        b2MouseJointDef def;
        def.bodyA = g.wall, def.bodyB = g.pieces.back();
        def.target = g.pieces.back()->GetPosition();
        def.maxForce = 1e6f;
        b2LinearStiffness(def.stiffness, def.damping, 5, 0.7f, def.bodyA, def.bodyB);
        static_cast<b2MouseJoint*>(g.world->CreateJoint(&def))->SetTarget(def.target + b2Vec2{-2, 3});
      },
      {.lost = unlimited, .moved = true});  // b2MouseJoint takes 2 % of its body's turning in every iteration
  const auto piece = [](Game& g, int step) {
    return g.pieces[static_cast<std::size_t>(step) % g.pieces.size()];
  };
  all.push_back(
      {.name = "set_type", .before_step = [=](Game& g, int step) {
         const b2BodyType types[] = {b2_staticBody, b2_dynamicBody, b2_kinematicBody, b2_dynamicBody};
         if (step % 7 == 3) piece(g, step / 28 * 5)->SetType(types[step / 7 % 4]);
         if (step % 60 == 30) g.wall->SetType(step % 120 < 60 ? b2_dynamicBody : b2_staticBody);
       }});
  all.push_back({.name = "set_enabled", .before_step = [=](Game& g, int step) {
                   b2Body* b = step % 40 == 20 ? g.wall : piece(g, step / 8 * 5);
                   if (step % 4 == 0) b->SetEnabled(!b->IsEnabled());
                 }});
  all.push_back({.name = "create_fixture", .before_step = [=](Game& g, int step) {
                   if (step % 5 != 2) return;
                   b2Body* b = piece(g, step / 10 * 5);
                   if (step % 10 == 7) return b->DestroyFixture(b->GetFixtureList());
                   b2CircleShape disc;
                   disc.m_radius = 0.3f, disc.m_p = {0.2f, 0.5f};
                   b2FixtureDef fixture;
                   fixture.shape = &disc, fixture.density = 3e4f;
                   b->CreateFixture(&fixture);
                 }});
  all.push_back({.name = "set_transform",
                 .before_step =
                     [=](Game& g, int step) {
                       if (step % 10 != 3) return;
                       b2Body* b = piece(g, step / 10 * 5);
                       const float far = step % 30 == 3 ? 1e-3f : step % 30 == 13 ? 0.1f : 2;
                       b->SetTransform(b->GetPosition() + b2Vec2{far, -far / 2}, b->GetAngle() + far / 3);
                     },
                 .judged = {.moved = true}});
  all.push_back({.name = "set_transform_wall",
                 .before_step =
                     [=](Game& g, int step) {
                       if (step % 40 != 20) return;
                       g.wall->SetTransform(vec(step % 7, step % 5), static_cast<float>(step % 3));
                     },
                 .judged = {.moved = true}});
  all.push_back({.name = "destroy_body", .before_step = [=](Game& g, int step) {
                   if (step % 9 != 4) return;
                   // One from anywhere goes, one comes at the end.
                   const std::size_t i = static_cast<std::size_t>(step) * 5 / 9 % g.pieces.size();
                   g.world->DestroyBody(g.pieces[i]);
                   g.pieces.erase(g.pieces.begin() + static_cast<std::ptrdiff_t>(i));
                   b2Body* end = g.pieces.back();
                   const b2Vec2 at = end->GetWorldPoint({0.5f, 0}), next = end->GetWorldPoint({1, 0});
                   g.pieces.push_back(g.add_piece(next.x, next.y));
                   g.join(end, g.pieces.back(), at);
                 }});
  all.push_back({.name = "destroy_joint", .before_step = [=](Game& g, int step) {
                   if (step % 15 != 4) return;
                   const auto joints = g.structure->joints();
                   if (joints.empty()) return;
                   b2Joint* j = joints[static_cast<std::size_t>(step) % joints.size()];
                   b2Body *a = j->GetBodyA(), *b = j->GetBodyB();
                   const b2Vec2 at = j->GetAnchorA();
                   g.world->DestroyJoint(j);
                   if (step % 2 == 0) g.join(a, b, at);
                 }});
  return all;
}
const std::vector<Item> items = make_items();

constexpr SolverKind kinds[] = {SolverKind::direct, SolverKind::iterative};
constexpr Law laws[] = {Law::rigid, Law::elastic, Law::plastic, Law::interacting, Law::breaking};

// J that Box2D's floats tell of the bodies' heights.
double resolved(const Game& game) {
  double sum = 0;
  for (const b2Body* b = std::as_const(*game.world).GetBodyList(); b; b = b->GetNext()) {
    const b2Vec2 p = b->GetPosition();
    sum += b->GetMass() * game.setup.gravity * 1.2e-7 * std::max({std::abs(p.x), std::abs(p.y), 1.0f});
  }
  return sum;
}

class Extremes : public testing::TestWithParam<std::tuple<std::size_t, SolverKind, Law>> {};

TEST_P(Extremes, StayFiniteAndGainNothing) {
  const auto [index, kind, law] = GetParam();
  const Item& item = items[index];
  const GameDef& s = item.setup;
  Game game(s, kind, law);
  if (item.build) item.build(game);
  EnergyLedger ledger(*game.world);
  const double start = ledger.energy().kinetic;
  const bool direct = kind == SolverKind::direct;
  // Joint by joint no ledger is kept, and what kinematic bodies give is not known.
  const bool known = direct || game.wall->GetType() != b2_kinematicBody;
  // Box2D's way of stepping keeps the energy of a swing of frequency ω to a share of ωh at every moment.
  const double swing =
      *std::max_element(s.steps.begin(), s.steps.end()) * std::sqrt(s.gravity / (s.pieces * s.length));
  for (int i = 0; i < s.count; ++i) {
    if (item.before_step) item.before_step(game, i);
    const double dt = s.steps[static_cast<std::size_t>(i) % s.steps.size()];
    ledger.before_step(dt, {});
    game.world->Step(static_cast<float>(dt), s.velocity_iterations, s.position_iterations);
    ASSERT_EQ(game.structure->report().bounds_hit, 0) << i;
    ledger.after_step(&*game.structure);
    game.structure->update();
    ledger.after_update(&*game.structure);

    for (b2Body* b = game.world->GetBodyList(); b; b = b->GetNext()) ASSERT_TRUE(finite({&b, 1})) << i;
    double elastic = 0;
    for (const ElasticPlasticJoint* j : game.structure->joints()) {
      for (const Row row : {axial, shear, rotation}) {
        ASSERT_TRUE(std::isfinite(j->force(row)) && std::isfinite(j->plastic(row)) &&
                    std::isfinite(j->elastic(row)))
            << i;
      }
      ASSERT_TRUE(std::isfinite(j->GetReactionForce(60).Length()) && std::isfinite(j->GetReactionTorque(60)))
          << i;
      ASSERT_GE(j->dissipated(), 0) << i;
      elastic += j->elastic_energy();
    }

    const Energy& e = ledger.energy();
    const double turnover = ledger.turnover(), rounding = resolved(game);
    if (direct && item.judged.told) {
      ASSERT_LE(e.total_error, item.judged.nowhere * turnover + rounding) << i;
      ASSERT_GE(e.total_error, -item.judged.lost * turnover - rounding) << i;
    }
    // What can be seen to move, whatever the books say of plastic work and numerical loss: iterations that
    // end early book more of it than they take.
    // Velocities, and the elastic energy of the books, are those of the middle of a step. An energy that is
    // told a moment early or late swings by a share of ωh; one that grows shows at both moments.
    double middle = e.potential;
    for (const b2Body* b = game.world->GetBodyList(); b; b = b->GetNext())
      middle += dt / 2 * b->GetMass() * b->GetGravityScale() *
                b2Dot(game.world->GetGravity(), b->GetLinearVelocity());
    const double stored =
        e.kinetic + (direct ? std::min(middle + e.elastic, e.potential + elastic) : e.potential + elastic);
    const double given = item.judged.told ? e.external + e.contacts : 0;
    if (known && !item.judged.moved) {
      ASSERT_LE(stored - given - start, (1e-4 + swing) * turnover + rounding) << i;
    }
  }
}

std::string name_of(const testing::TestParamInfo<Extremes::ParamType>& info) {
  const auto [index, kind, law] = info.param;
  static const char* const names[] = {"rigid", "elastic", "plastic", "interacting", "breaking"};
  return items[index].name + (kind == SolverKind::direct ? "_direct_" : "_iterative_") +
         names[static_cast<int>(law)];
}
INSTANTIATE_TEST_SUITE_P(All, Extremes,
                         testing::Combine(testing::Range(std::size_t{0}, items.size()),
                                          testing::ValuesIn(kinds), testing::ValuesIn(laws)),
                         name_of);

// Wherever a collapse happens to be, events pending, joints broken.
TEST(Destruction, OfTheStructureBeforeTheWorldAndAfterIt) {
  for (const SolverKind kind : kinds) {
    for (const Law law : laws) {
      for (const int steps : {0, 1, 7, 20, 60, 150}) {
        for (const bool world_first : {false, true}) {
          Game game({}, kind, law);
          for (int i = 0; i < steps; ++i) {
            game.world->Step(1.0f / 60, 8, 3);
            if (i + 1 < steps) game.structure->update();
          }
          if (world_first) {
            game.world.reset();
            game.structure->update();
            EXPECT_TRUE(game.structure->joints().empty());
            continue;
          }
          game.structure.reset();
          for (int i = 0; i < 60; ++i) {
            game.world->Step(1.0f / 60, 8, 3);
            ASSERT_TRUE(finite(game.pieces)) << i;
          }
        }
      }
    }
  }
}

// Refused: pieces that Box2D would collide with nothing, when their fixtures are made.
TEST(SmallPieces, AreRefusedWhenFixturesAreMade) {
  for (const double height : {0.019, 0.021}) {
    SceneDef scene;
    scene.gravity = {0, -10};
    BodyDef beam;
    beam.name = "needle";
    beam.outline.outer = {{0, 0}, {0.05, 0}, {0.05, height}, {0, height}};
    beam.material = Material{.yield_stress = 350e6, .youngs_modulus = 210e9, .density = 7800};
    beam.pieces = 2;
    beam.along = {{{0, height / 2}, {0.05, height / 2}}};
    scene.bodies = {beam};
    std::string refusal;
    try {
      Simulation run(calibrate(scene));
      for (int i = 0; i < 60; ++i) run.step();
      EXPECT_NEAR(run.piece(0).velocity.y, -10, 1e-3);
    } catch (const InvalidInput& e) {
      refusal = e.what();
    }
    if (height < 0.02) {
      EXPECT_NE(refusal.find("needle"), std::string::npos) << refusal;
      EXPECT_NE(refusal.find("0.02 m"), std::string::npos) << refusal;
    } else {
      EXPECT_EQ(refusal, "");
    }
  }
}

}  // namespace
}  // namespace ductile
