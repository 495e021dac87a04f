// N, Q and M on one yield surface.
#include "../../joint/yield_surface.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "beam.h"

namespace ductile::dynamics {
namespace {

// |m| = 1 − n² of a rectangle, as a polygon of 2k points.
std::vector<AxialMoment> rectangle(double N, double M, int k) {
  std::vector<AxialMoment> points;
  for (int i = 0; i < 2 * k; ++i) {
    const bool upper = i < k;
    const double n = upper ? 1 - 2.0 * i / k : -1 + 2.0 * (i - k) / k;
    points.push_back({n * N, (upper ? 1 : -1) * (1 - n * n) * M});
  }
  return points;
}

double distance(const Rows& G, const Rows& a, const Rows& b) {
  double sum = 0;
  for (unsigned i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]) / G[i];
  return sum;
}

class Projection : public testing::TestWithParam<double> {};

// The nearest point of a convex body is the one from which everything else in it lies behind the plane
// through it.
void expect_nearest(const YieldSurface& surface, double spread, double far) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    const Rows G{std::exp(spread * normal(random)), std::exp(spread * normal(random)),
                 std::exp(spread * normal(random))};
    const double h = 0.1;
    const Rows from{far * normal(random), far * normal(random), far * normal(random)};
    Rows s = from;
    if (!surface.project(G, h, s)) {
      EXPECT_EQ(s, from);
      continue;
    }
    EXPECT_NEAR(surface.usage({s[0] / h, s[1] / h, s[2] / h}), 1, 1e-11);
    for (int other = 0; other < 50; ++other) {
      Rows inside{normal(random), normal(random), normal(random)};
      const double usage = surface.usage({inside[0] / h, inside[1] / h, inside[2] / h});
      for (double& value : inside) value /= std::max(usage, 1e-9);
      double behind = 0, size = 0;  // (from − s)ᵀ G⁻¹ (inside − s) ≤ 0
      for (unsigned i = 0; i < 3; ++i) {
        const double term = (from[i] - s[i]) * (inside[i] - s[i]) / G[i];
        behind += term;
        size += (std::abs(from[i]) + std::abs(s[i])) * (std::abs(inside[i]) + std::abs(s[i])) / G[i];
      }
      EXPECT_LE(behind, 1e-12 * distance(G, from, s) + 1e-14 * size);
    }
  }
}

TEST_P(Projection, IsTheNearestPointInTheMetric) {
  expect_nearest(YieldSurface(rectangle(2, 3, 12), GetParam()), 2, 1);
}

// From far beyond, in metrics that see the surface as a needle.
TEST_P(Projection, IsTheNearestPointOfFewFacets) {
  const std::vector<AxialMoment> kite{{2, 0}, {0.6, 3}, {-2, 0}, {0.4, -3}},
      triangle{{1, -1}, {0, 2}, {-1, -1}}, sliver{{3, 3}, {-0.1, 0.2}, {-3, -3}, {0.2, -0.1}};
  for (const auto& polygon : {kite, triangle, sliver, rectangle(2, 3, 3)}) {
    for (const double spread : {2, 8}) {
      for (const double far : {1.0, 1e3, 1e6}) expect_nearest(YieldSurface(polygon, GetParam()), spread, far);
    }
  }
}

// A pin in a yield surface, and a roller: what a free row leaves to the others.
TEST_P(Projection, OfAFreeRowStaysOnItsRay) {
  const double h = 0.1, shear = GetParam();
  const YieldSurface surface(std::vector<AxialMoment>{{2, 0}, {0.6, 3}, {-2, 0}, {0.4, -3}}, shear);
  // Through the origin its sides are at N = ±2 and, on the line from (0.6, 3) to (−2, 0), at M = 6/2.6.
  for (const double far : {1.0, 1e6, 1e13}) {
    Rows s{0, 0, far};
    ASSERT_TRUE(surface.project({0, 3, 5}, h, s));
    EXPECT_NEAR(s[2], 6 / 2.6 * h, 1e-12);
    s = {-far, 0, 0};
    ASSERT_TRUE(surface.project({4, 3, 0}, h, s));
    EXPECT_NEAR(s[0], -2 * h, 1e-12);
    if (std::isinf(shear)) continue;
    s = {0, -far, far};
    ASSERT_TRUE(surface.project({0, 1e-3, 1e13}, h, s));
    EXPECT_NEAR(surface.usage({s[0] / h, s[1] / h, s[2] / h}), 1, 1e-12);
    EXPECT_EQ(s[0], 0);
    s = {0, far, 0};
    ASSERT_TRUE(surface.project({0, 2, 0}, h, s));
    EXPECT_NEAR(s[1], shear * h, 1e-12);
  }
}

TEST_P(Projection, TangentIsItsDerivative) {
  const YieldSurface surface(rectangle(2, 3, 12), GetParam());
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int compared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Rows G{std::exp(normal(random)), std::exp(normal(random)), std::exp(normal(random))};
    const Rows x{normal(random), normal(random), normal(random)};
    const double h = 0.1, step = 1e-6;
    const auto s_of = [&](Rows at) {
      for (unsigned i = 0; i < 3; ++i) at[i] *= G[i];
      surface.project(G, h, at);
      return at;
    };
    Rows t{G[0] * x[0], G[1] * x[1], G[2] * x[2]};
    if (!(surface.usage({t[0] / h, t[1] / h, t[2] / h}) > 1.01)) continue;
    const Coupling c = surface.tangent(G, h, t);
    const double D[3][3] = {{c.nn, c.nq, c.nm}, {c.nq, c.qq, c.qm}, {c.nm, c.qm, c.mm}};
    double worst = 0, kink = 0;
    for (unsigned k = 0; k < 3; ++k) {
      Rows up = x, down = x;
      up[k] += step;
      down[k] -= step;
      const Rows su = s_of(up), sd = s_of(down), s0 = s_of(x);
      for (unsigned i = 0; i < 3; ++i) {
        kink = std::max(kink, std::abs(su[i] - 2 * s0[i] + sd[i]) / step);  // between two facets
        worst = std::max(worst, std::abs((su[i] - sd[i]) / (2 * step) - D[i][k]));
      }
    }
    if (kink > 1e-3) continue;
    EXPECT_LT(worst, 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}
INSTANTIATE_TEST_SUITE_P(Shear, Projection, testing::Values(1.5, unlimited));

TEST(YieldSurface, RefusesWhatIsNotConvexOrMissesTheOrigin) {
  const std::vector<AxialMoment> away{{1, 1}, {2, 1}, {1, 2}};
  EXPECT_THROW(YieldSurface(away, 1), std::invalid_argument);
  const std::vector<AxialMoment> dented{{1, 0}, {0.1, 0.1}, {0, 1}, {-1, 0}, {0, -1}};
  EXPECT_THROW(YieldSurface(dented, 1), std::invalid_argument);
  EXPECT_THROW(YieldSurface(rectangle(1, 1, 8), 0), std::invalid_argument);
}

// A cantilever that leans down by 60° hangs partly in tension: its root yields at m = 1 − n², well before m
// = 1.
TEST(YieldSurface, AxialForceLowersTheMomentThatTheRootCarries) {
  for (const auto& [share, flows] : {std::pair{0.98, false}, std::pair{1.02, true}}) {
    Beam beam({.pieces = 4, .length = 10, .angle = -std::acos(0.5)});
    const double weight = beam.mass() * 10, N = weight * std::sin(std::acos(0.5)), M = weight * 5 * 0.5;
    // n = 0.6 and m = share·(1 − 0.36)
    const auto curve = rectangle(N / 0.6, M / (0.64 * share), 400);
    ElasticPlasticJointDef def;
    def.Initialize(beam.wall, beam.pieces[0], beam.point(0),
                   {0.5f, -static_cast<float>(std::sin(std::acos(0.5)))});
    def.interaction = curve;
    beam.world.DestroyJoint(beam.joints[0]);
    ElasticPlasticJoint* root = beam.structure.create_joint(def);
    // Gravity grows slowly, so that nothing overshoots.
    for (int i = 0; i < 600; ++i) {
      beam.world.SetGravity({0, -10 * std::min(1.0f, static_cast<float>(i) / 400)});
      beam.run(1.0 / 60);
    }
    EXPECT_EQ(std::abs(root->plastic(rotation)) > 1e-3, flows) << share;
    if (!flows) {
      EXPECT_NEAR(std::abs(root->force(rotation)), M, 1e-3 * M);
    }
    EXPECT_EQ(beam.bounds_hit, 0);
    // Normality: on m = 1 − n² the slip along the axis goes with the rotation as dm/dn = −2n.
    if (flows) {
      const double n = root->force(axial) / (N / 0.6), ratio = 2 * n * (M / (0.64 * share)) / (N / 0.6);
      EXPECT_NEAR(root->plastic(axial) / std::abs(root->plastic(rotation)), ratio, 0.1 * ratio);
      EXPECT_GT(root->dissipated(), 0);
    }
  }
}

TEST(YieldSurface, TakesNoOtherCaps) {
  Beam beam({.pieces = 1});
  ElasticPlasticJointDef def;
  def.Initialize(beam.wall, beam.pieces[0], beam.point(0), {1, 0});
  def.interaction = rectangle(1e6, 1e6, 8);
  ElasticPlasticJoint* joint = beam.structure.create_joint(def);
  for (const Row row : {axial, shear, rotation})
    EXPECT_THROW(joint->set_caps(row, 1e5, 1e5), std::invalid_argument);
  EXPECT_NO_THROW(beam.joints[0]->set_caps(axial, 1e5, 1e5));
}

// Rigid joints, all of them on their surfaces by and by.
TEST(YieldSurface, ACollapsingChainIsSolvedInTime) {
  Beam beam({.pieces = 6, .length = 6, .height = 0.5, .density = 1000});
  const double M = 0.75 * beam.mass() * 10 * 3, N = 4 * M / 0.5;
  for (ElasticPlasticJoint*& j : beam.joints) {
    ElasticPlasticJointDef def;
    def.Initialize(j->GetBodyA(), j->GetBodyB(), j->GetAnchorA(), {1, 0});
    def.rows[shear].cap = def.rows[shear].cap_reverse = N / 2;
    def.interaction = rectangle(N, M, 16);
    beam.world.DestroyJoint(j);
    j = beam.structure.create_joint(def);
  }
  beam.run(5);
  EXPECT_EQ(beam.bounds_hit, 0);
  EXPECT_GT(beam.joints[0]->accumulated_rotation(), 0.5);
}

// A portal of rigid pieces, 3 m high and 6 m wide, that a block of 20 pieces' mass strikes at 20 m/s, 60 Hz.
// What flows goes on flowing from part to part of the blow, and what rubs does within one: to find that anew
// each time took ten times as many factorisations with surfaces as with caps.
int factorisations_of_struck_portal(std::span<const AxialMoment> interaction) {
  constexpr int pieces = 6;
  constexpr float l = 0.5f, mass = 30, high = pieces * l, wide = 2 * high;
  b2World world({0, -10});
  Structure structure(world);
  const auto box = [&world](b2BodyType type, float x, float y, float hx, float hy, float density) {
    b2BodyDef def;
    def.type = type;
    def.position.Set(x, y);
    b2Body* body = world.CreateBody(&def);
    b2PolygonShape shape;
    shape.SetAsBox(hx, hy);
    body->CreateFixture(&shape, density);
    return body;
  };
  const auto join = [&](b2Body* a, b2Body* b, float x, float y, b2Vec2 axis) {
    ElasticPlasticJointDef def;
    def.Initialize(a, b, {x, y}, axis);
    for (const auto& [row, cap] : {std::pair{axial, 2e6}, {shear, 1e6}, {rotation, 2e5}})
      def.rows[row] = {.stiffness = rigid, .cap = cap, .cap_reverse = cap};
    def.interaction.assign(interaction.begin(), interaction.end());
    structure.create_joint(def);
  };
  b2Body* ground = box(b2_staticBody, 0, -5, 50, 0.5f, 0);
  const auto column = [&](float x) {
    b2Body* last = ground;
    for (int i = 0; i < pieces; ++i) {
      const float foot = static_cast<float>(i) * l;
      b2Body* piece = box(b2_dynamicBody, x, foot + l / 2, 0.15f, l / 2, mass / (0.3f * l));
      join(last, piece, x, foot, {0, 1});
      last = piece;
    }
    return last;
  };
  b2Body *left = column(0), *right = column(wide), *beam = nullptr;
  for (int i = 0; i < 2 * pieces; ++i) {
    const float start = static_cast<float>(i) * l;
    b2Body* piece = box(b2_dynamicBody, start + l / 2, high + 0.15f, l / 2, 0.15f, mass / (0.3f * l));
    if (i == 0) {
      join(left, piece, 0, high, {0, 1});
    } else {
      join(beam, piece, start, high + 0.15f, {1, 0});
    }
    beam = piece;
  }
  join(right, beam, wide, high, {0, 1});
  for (int i = 0; i < 120; ++i) world.Step(1 / 60.0f, 8, 3), structure.update();
  b2Body* block = box(b2_dynamicBody, high + 0.3f, high + 1.8f, 0.5f, 0.5f, 20 * mass);
  block->SetLinearVelocity({0, -20});
  int sum = 0;
  for (int i = 0; i < 120; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
    sum += structure.report().factorisations;
    EXPECT_EQ(structure.report().bounds_hit, 0);
  }
  return sum;
}

TEST(YieldSurface, ABlowIsSolvedAsWithCaps) {
  std::vector<AxialMoment> curve;
  for (int i = 0; i < 16; ++i) {
    const double t = i * std::numbers::pi / 8, c = std::cos(t), s = std::sin(t);
    const double to = 1 / std::pow(std::pow(std::abs(c), 1.5) + std::pow(std::abs(s), 1.5), 2 / 3.0);
    curve.push_back({2e6 * to * c, 2e5 * to * s});
  }
  const int caps = factorisations_of_struck_portal({}), surface = factorisations_of_struck_portal(curve);
  EXPECT_GT(caps, 100);
  EXPECT_LT(surface, 4 * caps);
}

}  // namespace
}  // namespace ductile::dynamics
