// Caps that grow with the rate of flow, against Cowper and Symonds' law integrated by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "ductile/joint.h"
#include "ductile/save.h"

namespace {
using namespace ductile;

constexpr double length = 2, mass = 500, inertia = mass * length * length / 3;  // about its end
constexpr double M = 4000;                                                      // N m

// A bar that turns about a joint at its end, without weight, and is stopped by the joint's moment.
struct Stopped {
  b2World world{{0, 0}};
  Structure structure;
  ElasticPlasticJoint* joint;
  b2Body* bar;
  double dt;

  Stopped(const std::optional<RateLaw>& rate, double stiffness, double turns, double step)
      : structure(world, {.keep_ledger = true}), dt(step) {
    world.SetAllowSleeping(false);
    b2BodyDef def;
    b2Body* wall = world.CreateBody(&def);
    def.type = b2_dynamicBody;
    def.position = {static_cast<float>(length / 2), 0};
    bar = world.CreateBody(&def);
    b2PolygonShape shape;
    shape.SetAsBox(static_cast<float>(length / 2), 0.05f);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;
    bar->CreateFixture(&fixture);
    const b2MassData slender{
        static_cast<float>(mass), {0, 0}, static_cast<float>(mass * length * length / 12)};
    bar->SetMassData(&slender);
    ElasticPlasticJointDef j;
    j.Initialize(wall, bar, {0, 0}, {1, 0});
    j.rows[rotation] = {.stiffness = stiffness, .damping_ratio = 0.05, .cap = M, .cap_reverse = M};
    j.rate = rate;
    joint = structure.create_joint(j);
    bar->SetAngularVelocity(static_cast<float>(turns));
    bar->SetLinearVelocity({0, static_cast<float>(turns * length / 2)});
  }
  void run(double seconds) {
    for (long i = 0, steps = std::lround(seconds / dt); i < steps; ++i) {
      world.Step(static_cast<float>(dt), 8, 3);
      structure.update();
    }
  }
};

RateLaw of_bending(double D, double q) {
  RateLaw law{.exponent = q};
  law.doubling[rotation] = D;
  return law;
}

// θ = ∫ I ω dω / M (1 + (ω/D)^(1/q)) from 0 to ω₀, by Simpson's rule in ω^(1/q)·D^(−1/q) = o.
double stops_after(double turns, double D, double q) {
  const double end = std::pow(turns / D, 1 / q);
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double o = end * i / n, omega = D * std::pow(o, q),
                 slope = i == 0 && q > 1 ? 0 : D * q * std::pow(o, q - 1);
    sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * inertia * omega * slope / (M * (1 + o));
  }
  return sum * end / n / 3;
}

// With q = 1, a damper beside the slider, the integral is I D (ω₀ − D ln(1 + ω₀/D)) / M.
TEST(Rate, TheIntegralOfADamperIsItsClosedForm) {
  const double turns = 6, D = 2;
  EXPECT_NEAR(stops_after(turns, D, 1) / (inertia * D / M * (turns - D * std::log(1 + turns / D))), 1, 1e-9);
}

struct Law {
  double D, q, stiffness, dt, allowed;
};
class RateLaws : public testing::TestWithParam<Law> {};

// The raise is that of the rate after a step: of first order, by half of what the rate changes in one, 0.4 of
// 6 rad/s at 60 Hz where q = 1, and a qth of that elsewhere.
TEST_P(RateLaws, ABarStopsWhereTheirIntegralSays) {
  const auto [D, q, stiffness, dt, allowed] = GetParam();
  const double turns = 6;
  Stopped stopped(of_bending(D, q), stiffness, turns, dt);
  stopped.run(5);
  const double expected = stops_after(turns, D, q), plain = inertia * turns * turns / 2 / M;
  EXPECT_LT(expected, 0.9 * plain);
  EXPECT_NEAR(stopped.joint->accumulated_rotation() / expected, 1, allowed);
  EXPECT_NEAR(stopped.joint->plastic(rotation) / expected, 1, allowed);
  const JointEnergy e = stopped.structure.energy();
  const double given = inertia * turns * turns / 2;
  EXPECT_NEAR((e.dissipated + e.elastic + e.damping + e.numerical) / given, 1, 1e-4);
  EXPECT_NEAR(e.dissipated / given, 1, 0.03);
  EXPECT_LT(std::abs(e.numerical) / given, allowed + 0.01);
}

INSTANTIATE_TEST_SUITE_P(Cases, RateLaws,
                         testing::Values(Law{2, 1, rigid, 1. / 60, 0.035}, Law{2, 1, rigid, 1. / 960, 0.0025},
                                         Law{20, 5, rigid, 1. / 60, 0.01}, Law{20, 5, rigid, 1. / 960, 0.001},
                                         Law{200, 5, rigid, 1. / 240, 0.005}, Law{20, 4, 2e5, 1. / 240, 0.02},
                                         Law{1, 10, 1e6, 1. / 240, 0.02}));

// A soft spring in series: I θ'' = −k e, e' = ω − D (k e/M − 1)^q beyond M, by Runge and Kutta. As the rate
// falls, so does the cap, and the spring gives back what it holds beyond it instead of flowing it away.
double sets_by(double turns, double D, double q, double k, double seconds) {
  struct State {
    double omega, e, p;
  };
  const auto rate = [&](const State& s) {
    const double over = std::abs(k * s.e) / M - 1;
    const double linear = std::pow(1e-4, 1 / q);  // below 1e-4 D (rate.h)
    const double flow = over <= 0       ? 0
                        : over < linear ? std::copysign(1e-4 * D * over / linear, s.e)
                                        : std::copysign(D * std::pow(over, q), s.e);
    return State{-k * s.e / inertia, s.omega - flow, flow};
  };
  const auto on = [](const State& s, double h, const State& r) {
    return State{s.omega + h * r.omega, s.e + h * r.e, s.p + h * r.p};
  };
  constexpr double h = 1e-5;
  State s{turns, 0, 0};
  for (long i = 0, steps = std::lround(seconds / h); i < steps; ++i) {
    const State a = rate(s), b = rate(on(s, h / 2, a)), c = rate(on(s, h / 2, b)), d = rate(on(s, h, c));
    s = on(s, h / 6,
           {a.omega + 2 * (b.omega + c.omega) + d.omega, a.e + 2 * (b.e + c.e) + d.e,
            a.p + 2 * (b.p + c.p) + d.p});
  }
  return s.p;
}

TEST(Rate, ASoftSpringInSeries) {
  // It swings at 0.87 Hz, ω = 5.5 rad/s, and yields at 0.2 rad: of first order in the step, by about ω dt.
  const double D = 5, q = 5, k = 2e4, turns = 6;
  const double expected = sets_by(turns, D, q, k, 0.7);
  for (const double dt : {1. / 60, 1. / 240}) {
    Stopped stopped(of_bending(D, q), k, turns, dt);
    stopped.joint->set_stiffness(rotation, k, 0);
    stopped.run(0.7);
    EXPECT_NEAR(stopped.joint->plastic(rotation) / expected, 1, 5 * dt) << dt;
  }
}

// A damper c beside a soft spring, both in series with the slider, whose law of q = 1 is a line: beyond M
// k e + c e' = R = M (1 + (ω − e')/D) by Runge and Kutta, and ½Iω² goes where R ω does.
TEST(Rate, ADamperBesideASoftSpring) {
  constexpr double D = 5, k = 2e4, turns = 6, ratio = 0.05;
  const double c = 2 * ratio * std::sqrt(k * inertia / 4);  // of the bar about its centre
  struct State {
    double omega, e, p;
  };
  const auto rate = [&](const State& s) {
    const double held = k * s.e + c * s.omega, over = std::abs(held) - M;
    const double flow = over > 0 ? std::copysign(over / (M / D + c), held) : 0;
    return State{-(k * s.e + c * (s.omega - flow)) / inertia, s.omega - flow, flow};
  };
  const auto on = [](const State& s, double h, const State& r) {
    return State{s.omega + h * r.omega, s.e + h * r.e, s.p + h * r.p};
  };
  constexpr double h = 1e-5, seconds = 0.7;
  State s{turns, 0, 0};
  for (int i = 0; i < std::lround(seconds / h); ++i) {
    const State a = rate(s), b = rate(on(s, h / 2, a)), d = rate(on(s, h / 2, b)), f = rate(on(s, h, d));
    s = on(s, h / 6,
           {a.omega + 2 * (b.omega + d.omega) + f.omega, a.e + 2 * (b.e + d.e) + f.e,
            a.p + 2 * (b.p + d.p) + f.p});
  }
  for (const double dt : {1. / 60, 1. / 240, 1. / 960, 1. / 3840}) {
    Stopped stopped(of_bending(D, 1), k, turns, dt);
    stopped.joint->set_stiffness(rotation, k, ratio);
    stopped.run(seconds);
    const JointEnergy e = stopped.structure.energy();
    const double speed = stopped.bar->GetAngularVelocity(), start = inertia * turns * turns / 2;
    EXPECT_NEAR(stopped.joint->plastic(rotation) / s.p, 1, 5 * dt) << dt;
    EXPECT_NEAR((inertia * speed * speed / 2 + e.elastic + e.dissipated + e.damping) / start, 1, 2 * dt)
        << dt;
  }
}

TEST(Rate, NoneWhereItIsSlow) {
  Stopped with(of_bending(1e12, 5), rigid, 6, 1. / 60), without({}, rigid, 6, 1. / 60);
  with.run(5);
  without.run(5);
  EXPECT_NEAR(with.joint->plastic(rotation) / without.joint->plastic(rotation), 1, 1e-3);
}

TEST(Rate, ASaveGoesOnBitByBit) {
  Stopped scene(of_bending(20, 5), 1e6, 6, 1. / 60);
  scene.run(0.5);
  ASSERT_GT(scene.joint->plastic(rotation), 0);
  b2World other({0, 0});
  Structure back(other);
  load_bytes(back, save_bytes(scene.structure));
  ASSERT_TRUE(back.joints()[0]->def().rate);
  EXPECT_EQ(back.joints()[0]->def().rate->doubling[rotation], 20);
  for (int i = 0; i < 30; ++i) {
    scene.run(scene.dt);
    other.Step(static_cast<float>(scene.dt), 8, 3);
    back.update();
  }
  EXPECT_EQ(back.joints()[0]->plastic(rotation), scene.joint->plastic(rotation));
}

TEST(Rate, WhatItDoesNotGoWithIsRefused) {
  b2World world({0, 0});
  Structure structure(world), iterative(world, {.solver = SolverKind::iterative});
  b2BodyDef body;
  b2Body* a = world.CreateBody(&body);
  body.type = b2_dynamicBody;
  body.position = {1, 0};
  b2Body* b = world.CreateBody(&body);
  ElasticPlasticJointDef good;
  good.Initialize(a, b, {0.5f, 0});
  good.rate = of_bending(20, 5);
  for (RowDef& row : good.rows) row.cap = row.cap_reverse = 1e3;
  EXPECT_TRUE(structure.problems(good).empty());
  EXPECT_FALSE(iterative.problems(good).empty());
  const auto refused = [&](auto&& change) {
    ElasticPlasticJointDef bad = good;
    change(bad);
    return !structure.problems(bad).empty();
  };
  EXPECT_TRUE(refused([](auto& d) { d.rate->exponent = 0.5; }));
  EXPECT_TRUE(refused([](auto& d) { d.rate->doubling[axial] = 0; }));
  EXPECT_TRUE(refused([](auto& d) { d.rate->doubling[axial] = NAN; }));
  EXPECT_TRUE(refused([](auto& d) { d.rows[rotation].stiffness = 1e6, d.rows[rotation].hardening = 1e3; }));
  EXPECT_TRUE(refused([](auto& d) { d.rows[axial].drive = Drive{1, 1}; }));
  EXPECT_TRUE(refused([](auto& d) { d.interaction = {{-1e3, 0}, {0, -1e3}, {1e3, 0}, {0, 1e3}}; }));
}

}  // namespace
