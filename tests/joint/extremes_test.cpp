// Far beyond what is sensible: nothing may become NaN, gain energy, hang, abort or hit the bound on rounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

// What the bodies and joints hold must not grow: gravity is all that works on them. Velocities are those of
// the middle of a step: so heights are taken there, half a step back, and strains as the ledger has them.
class Watch {
 public:
  // Box2D's way of stepping keeps the energy of a swing of frequency ω to a share of ωh at every moment.
  Watch(const Beam& beam, const std::vector<b2Body*>& others, double longest_step)
      : beam_(beam),
        bodies_(others),
        share_(1e-4 + longest_step * std::sqrt(beam.def.gravity / beam.def.length)) {
    bodies_.insert(bodies_.end(), beam.pieces.begin(), beam.pieces.end());
    start_ = total();
    height_ = potential_energy(bodies_, beam.def.gravity);
    // What floats tell of a height, and what Box2D may push a block up by: the skin of polygons.
    for (const b2Body* b : others) rounding_ += 0.02 * b->GetMass() * beam.def.gravity;
    for (const b2Body* b : bodies_) {
      rounding_ += b->GetMass() * (1 + std::abs(beam.def.gravity)) * 1e-6 * (1 + b->GetPosition().Length());
    }
  }
  void look(double h) {
    h_ = h;
    ASSERT_TRUE(finite(bodies_));
    double plastic = 0;
    for (const ElasticPlasticJoint* j : beam_.structure.joints()) {
      for (const Row row : {axial, shear, rotation}) {
        ASSERT_TRUE(std::isfinite(j->force(row)) && std::isfinite(j->plastic(row)) &&
                    std::isfinite(j->elastic(row)));
        ASSERT_TRUE(std::isfinite(j->GetReactionForce(60).Length()) &&
                    std::isfinite(j->GetReactionTorque(60)));
      }
      ASSERT_TRUE(std::isfinite(j->elastic_energy()));
      ASSERT_GE(j->dissipated(), 0);
      plastic += j->dissipated();
    }
    // An energy that is told a moment early or late swings by a share of ωh; one that grows shows at both
    // moments.
    const double middle = total() + (plastic + std::exchange(plastic_, plastic)) / 2;
    double end = kinetic_energy(bodies_) + potential_energy(bodies_, beam_.def.gravity) + plastic;
    for (const ElasticPlasticJoint* j : beam_.structure.joints()) end += j->elastic_energy();
    const double now = std::min(middle, end);
    turnover_ = std::max(turnover_, kinetic_energy(bodies_) + plastic +
                                        std::abs(potential_energy(bodies_, beam_.def.gravity) - height_));
    ASSERT_LE(now, start_ + share_ * turnover_ + rounding_);
    hits_ += beam_.structure.report().bounds_hit;
  }
  int hits() const { return hits_; }

 private:
  double total() const {
    double sum = kinetic_energy(bodies_) + potential_energy(bodies_, beam_.def.gravity);
    for (const b2Body* b : bodies_)
      sum -= b->GetMass() * beam_.def.gravity * h_ / 2 * b->GetLinearVelocity().y;
    return sum + beam_.structure.energy().elastic;
  }
  const Beam& beam_;
  std::vector<b2Body*> bodies_;
  double start_, height_, share_, rounding_ = 0, turnover_ = 0;
  double h_ = 0, plastic_ = 0;
  int hits_ = 0;
};

struct Extreme {
  std::string name;
  BeamDef beam = {};
  double resting = 0, welded = 0;  // mass of a block at the tip, in pieces
  std::vector<double> steps = {1.0 / 60};
  int velocity_iterations = 8, position_iterations = 3;
  double seconds = 4;
  std::vector<RowDef> rows = {};  // of every joint, instead of the beam's
};

constexpr double steel = 210e9;

std::vector<Extreme> make_extremes() {
  std::vector<Extreme> all;
  // Rigid and elastic, strong enough and too weak for its own weight.
  for (const double E : {0.0, steel}) {
    for (const double weakness : {0.0, 1.3}) {
      const std::string tail = std::string(E > 0 ? "_elastic" : "_rigid") + (weakness > 0 ? "_plastic" : "");
      const auto beam = [&](int pieces, double length, double height) {
        const double moment = 7800 * height * 10 * length * length / 2;
        return BeamDef{.pieces = pieces,
                       .length = length,
                       .height = height,
                       .youngs_modulus = E,
                       .damping_time = 0,
                       .moment_cap = weakness > 0 ? moment / weakness : unlimited};
      };
      const BeamDef usual = beam(10, 20, 1);
      BeamDef b = usual;
      all.push_back({.name = "contact_1000" + tail, .beam = b, .resting = 1000});
      all.push_back({.name = "welded_1e6" + tail, .beam = b, .welded = 1e6});
      all.push_back({.name = "welded_1e6_to_40" + tail, .beam = beam(40, 20, 1), .welded = 1e6});
      all.push_back({.name = "welded_a_millionth" + tail, .beam = b, .welded = 1e-6});
      b = beam(5, 0.05, 0.005);
      b.fixtures = false;  // Box2D's polygons cannot be so small
      all.push_back({.name = "five_centimetres" + tail, .beam = b});
      all.push_back({.name = "one_kilometre" + tail, .beam = beam(20, 1000, 50)});
      b = usual;
      all.push_back({.name = "dt_15" + tail, .beam = b, .resting = 1, .steps = {1.0 / 15}});
      all.push_back({.name = "dt_5000" + tail, .beam = b, .resting = 1, .steps = {1.0 / 5000}, .seconds = 1});
      all.push_back({.name = "dt_changing" + tail,
                     .beam = b,
                     .resting = 1,
                     .steps = {1.0 / 15, 1.0 / 5000, 0, 1.0 / 60, 1.0 / 240, 0, 1.0 / 30}});
      all.push_back({.name = "no_iterations" + tail,
                     .beam = b,
                     .resting = 1,
                     .velocity_iterations = 0,
                     .position_iterations = 0,
                     .seconds = 1});
      all.push_back(
          {.name = "no_position_iterations" + tail, .beam = b, .resting = 1, .position_iterations = 0});
      all.push_back({.name = "one_iteration" + tail,
                     .beam = b,
                     .resting = 1,
                     .velocity_iterations = 1,
                     .position_iterations = 1});
      b.x = 1e5, b.y = -1e5;
      all.push_back({.name = "far" + tail, .beam = b});
      b = usual;
      b.gravity = 0;
      all.push_back({.name = "weightless" + tail, .beam = b});
      b.gravity = 1e4;
      all.push_back({.name = "heavy" + tail, .beam = b, .resting = 1});
    }
    for (const auto& [name, cap] : {std::pair{"hinges_none", 0.0},
                                    {"hinges_tiny", 1e-30},
                                    {"hinges_weak", 1e3},
                                    {"hinges_huge", 1e300}}) {
      all.push_back({.name = name + std::string(E > 0 ? "_elastic" : "_rigid"),
                     .beam = {.pieces = 20, .youngs_modulus = E, .damping_time = 0, .moment_cap = cap},
                     .seconds = 10});
    }
  }
  for (const auto& [name, scale] : {std::pair{"hard", 1e6}, {"soft", 1e-6}, {"softest", 1e-12}}) {
    for (const double cap : {unlimited, 7800 * 10 * 200 / 1.3, 1e3}) {
      all.push_back({.name = name + std::string(cap > 1e8   ? ""
                                                : cap > 1e6 ? "_plastic"
                                                            : "_weak"),
                     .beam = {.youngs_modulus = scale * steel, .damping_time = 0, .moment_cap = cap},
                     .resting = 1,
                     .seconds = 10});
    }
  }
  for (const auto& [name, cap] :
       {std::pair{"rows_tiny", 1e-30}, {"rows_weak", 1e4}, {"rows_near", 2e6}, {"rows_huge", 1e300}}) {
    const RowDef row{.cap = cap, .cap_reverse = cap};
    all.push_back({.name = name, .beam = {.pieces = 20}, .resting = 1, .rows = {row, row, row}});
  }
  const RowDef no_pull{.cap = 0}, no_push{.cap_reverse = 0};
  all.push_back({.name = "no_tension", .beam = {.angle = 0.1}, .rows = {no_pull, {}, {}}});
  all.push_back({.name = "no_compression", .beam = {.angle = -0.1}, .rows = {no_push, {}, {}}});
  all.push_back({.name = "no_sagging", .beam = {.pieces = 20}, .rows = {{}, {}, no_push}});
  all.push_back({.name = "no_way_down", .beam = {.pieces = 20}, .rows = {no_pull, no_push, no_push}});
  const RowDef damped{.stiffness = 1e8, .damping_ratio = 100};
  all.push_back({.name = "overdamped", .resting = 1, .rows = {damped, damped, damped}});
  all.push_back({.name = "out_of_scale",
                 .resting = 1,
                 .rows = {{.stiffness = 1, .damping_ratio = 1e300},
                          {.stiffness = 1e-300, .damping_ratio = 1e10},
                          {.stiffness = 1e300, .damping_ratio = 1e300}}});
  for (const double hardening : {1e-300, 1e6, 1e300}) {
    const RowDef row{.cap = 1e4, .cap_reverse = 1e4, .hardening = hardening};
    all.push_back({.name = "hardening_" + std::to_string(static_cast<int>(std::log10(hardening)) + 300),
                   .beam = {.pieces = 20},
                   .resting = 1,
                   .rows = {row, row, row}});
  }
  return all;
}
const std::vector<Extreme> extremes = make_extremes();

class Extremes : public testing::TestWithParam<std::size_t> {};

TEST_P(Extremes, StayFiniteAndGainNothing) {
  const Extreme& extreme = extremes[GetParam()];
  Beam beam(extreme.beam);
  for (ElasticPlasticJoint* j : beam.joints) {
    if (extreme.rows.empty()) break;
    ElasticPlasticJointDef def;
    def.bodyA = j->GetBodyA(), def.bodyB = j->GetBodyB();
    def.localAnchorA = j->GetLocalAnchorA(), def.localAnchorB = j->GetLocalAnchorB();
    std::copy_n(extreme.rows.begin(), 3, def.rows);
    beam.world.DestroyJoint(j);
    beam.structure.create_joint(def);
  }
  const double piece = beam.mass() / extreme.beam.pieces, l = extreme.beam.length / extreme.beam.pieces;
  const double h = extreme.beam.height;
  std::vector<b2Body*> others;
  if (extreme.resting > 0) {
    const b2Vec2 at = beam.point(extreme.beam.length - l / 2);
    others.push_back(add_box(beam.world, {.x = at.x,
                                          .y = at.y + h + 0.015,
                                          .width = h,
                                          .height = h,
                                          .mass = extreme.resting * piece,
                                          .group = 0}));
  }
  if (extreme.welded > 0) {
    const b2Vec2 at = beam.point(extreme.beam.length);
    others.push_back(
        add_box(beam.world, {.x = at.x, .y = at.y, .width = h, .height = h, .mass = extreme.welded * piece}));
    ElasticPlasticJointDef weld;
    weld.Initialize(beam.pieces.back(), others.back(), at, {1, 0});
    beam.structure.create_joint(weld);
  }
  Watch watch(beam, others, *std::max_element(extreme.steps.begin(), extreme.steps.end()));
  std::size_t i = 0;
  for (double t = 0; t < extreme.seconds; ++i) {
    const double dt = extreme.steps[i % extreme.steps.size()];
    beam.world.Step(static_cast<float>(dt), extreme.velocity_iterations, extreme.position_iterations);
    watch.look(dt);
    if (HasFatalFailure()) FAIL() << extreme.name << " at step " << i << ", " << t << " s";
    beam.structure.update();
    t += dt;
  }
  EXPECT_EQ(watch.hits(), 0) << extreme.name;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::Range(std::size_t{0}, extremes.size()),
                         [](const auto& info) { return extremes[info.param].name; });

// A free chain, every other piece 1e4 times heavier than steel, that spins so fast that the middle is asked
// for three times its plastic tension: it stretches everywhere at once, and ever more slowly.
TEST(StretchingChain, EverySolveEnds) {
  constexpr int n = 80;
  constexpr double length = 20, l = length / n, dt = 1.0 / 240, tension = 350e6, heavy = 1e4;
  b2World world({0, 0});
  world.SetAllowSleeping(false);
  Structure structure(world);
  std::vector<b2Body*> pieces;
  double mass = 0, moment = 0;
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) * l, m = 7800 * l * (i % 2 == 0 ? 1 : heavy);
    pieces.push_back(add_box(world, {.x = x, .width = l, .mass = m}));
    mass += m, moment += m * x;
    if (i == 0) continue;
    ElasticPlasticJointDef joint;
    joint.Initialize(pieces[pieces.size() - 2], pieces.back(), vec(i * l, 0), {1, 0});
    joint.rows[axial].cap = joint.rows[axial].cap_reverse = tension;
    joint.rows[shear].cap = joint.rows[shear].cap_reverse = tension / std::sqrt(3);
    joint.rows[rotation].cap = joint.rows[rotation].cap_reverse = tension / 4;
    structure.create_joint(joint);
  }
  const double middle = moment / mass;
  double pull = 0;  // on the middle, at ω = 1
  for (const b2Body* b : pieces) pull += b->GetMass() * std::max(b->GetPosition().x - middle, 0.);
  const double omega = std::sqrt(3 * tension / pull);
  for (b2Body* b : pieces) {
    b->SetLinearVelocity(vec(0, omega * (b->GetPosition().x - middle)));
    b->SetAngularVelocity(static_cast<float>(omega));
  }
  const double energy = kinetic_energy(pieces);
  int hits = 0;
  for (int i = 0; i < 480; ++i) {
    world.Step(static_cast<float>(dt), 8, 3);
    hits += structure.report().bounds_hit;
    structure.update();
  }
  EXPECT_EQ(hits, 0);
  const auto& joints = structure.joints();
  EXPECT_GT(std::count_if(joints.begin(), joints.end(), [](auto* j) { return j->elongation() > 0; }), n / 2);
  EXPECT_LE(kinetic_energy(pieces), energy);
}

// In H the inertia of such bodies is lost beside what rigid rows on such arms add to it.
TEST(Extremes, JointsAcrossAHundredKilometres) {
  for (const double apart : {1e3, 1e4, 1e5, 1e6}) {
    for (const bool surface : {false, true}) {
      for (int seed = 0; seed < 100; ++seed) {
        b2World world({0, -10});
        Structure structure(world);
        b2Body* a = add_box(world, {.mass = 76.0 + seed});
        b2Body* b = add_box(world, {.x = apart, .y = -apart / 3, .mass = 2000, .angle = 0.1 * seed});
        ElasticPlasticJointDef def;
        def.Initialize(a, b, {0, 0}, {1, 0});
        def.localAnchorB = {0.1f * static_cast<float>(seed), 0};
        def.axisFollow = static_cast<float>(seed % 3) * 0.5f;
        const double cap = std::pow(10, 2 + seed % 11);
        def.rows[axial] = def.rows[shear] = def.rows[rotation] = {.cap = cap, .cap_reverse = cap};
        if (surface) def.interaction = {{cap, 0}, {0, cap}, {-cap, 0}, {0, -cap}};
        structure.create_joint(def);
        a->SetAngularVelocity(1);
        for (int i = 0; i < 100; ++i) {
          world.Step(1.0f / 60, 8, 3);
          structure.update();
          for (const b2Body* body : {a, b}) {
            ASSERT_TRUE(std::isfinite(body->GetPosition().x + body->GetAngle() + body->GetLinearVelocity().x +
                                      body->GetAngularVelocity()))
                << apart << " " << surface << " " << seed << " " << i;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace ductile
