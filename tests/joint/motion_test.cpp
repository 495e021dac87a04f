// Motion at the rate of games: damping that is what was asked for, ductility, the order in time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "beam.h"
#include "bodies.h"
#include "structures.h"

namespace ductile {
namespace {

constexpr double pi = std::numbers::pi;

// ωL² √(m/EI) of a cantilever's first mode.
constexpr double first_mode = 3.5160153;

// Of the parabola through three samples at equal distances.
double vertex(double a, double b, double c) { return b + (c - a) * (c - a) / (8 * (2 * b - a - c)); }

// ζ of a vibration whose amplitude falls from `first` to `last` in n periods.
double damping_ratio(double first, double last, int n) {
  const double decrement = std::log(first / last) / n;
  return decrement / std::sqrt(4 * pi * pi + decrement * decrement);
}

struct Decay {
  double ratio, first_peak;
};

// Of the tip's fall below where it comes to rest, over periods after gravity sets in at once. The peaks of
// the whole fall, of parabolas through three steps, are those of the first mode: the second has 2 % of it.
Decay decay(double frequency, int pieces, double ratio, double rate) {
  BeamDef def{.pieces = pieces, .gravity = 1};
  const double inertia = std::pow(def.height, 3) / 12, mass = def.density * def.height;
  const double omega = 2 * pi * frequency, per_modulus = first_mode * first_mode * inertia / mass;
  def.youngs_modulus = omega * omega * std::pow(def.length, 4) / per_modulus;
  def.damping_time = 2 * ratio / omega;
  Beam beam(def);
  const auto tip = [&] { return double{beam.pieces.back()->GetWorldCenter().y}; };
  const double start = tip(), h = 1 / rate;
  std::vector<double> y{0, 0}, peaks, valleys;
  const int periods = 9;
  for (double t = 0; t < periods / frequency; t += h) {
    beam.world.Step(static_cast<float>(h), 8, 3);
    beam.structure.update();
    y.push_back(start - tip());
    const double a = y[y.size() - 3], b = y[y.size() - 2], c = y.back();
    if (b > a && b >= c) peaks.push_back(vertex(a, b, c));
    if (b < a && b <= c && !peaks.empty()) valleys.push_back(vertex(a, b, c));
  }
  // Of swings from valley to peak: rest cancels.
  const auto swing = [&](std::size_t i) { return peaks[i + 1] - valleys[i]; };
  const int n = 6;
  EXPECT_GT(valleys.size(), std::size_t{n});
  EXPECT_GT(peaks.size(), std::size_t{n} + 1);
  return {damping_ratio(swing(0), swing(n), n), peaks[0]};
}

TEST(Motion, ACantileverIsDampedAsAsked) {
  for (const double frequency : {0.5, 2.0, 6.0}) {
    for (const int pieces : {6, 40}) {
      for (const double ratio : {0.0, 0.02, 0.05}) {
        SCOPED_TRACE(testing::Message() << frequency << " Hz, " << pieces << " pieces, " << ratio);
        const Decay at_60 = decay(frequency, pieces, ratio, 60);
        EXPECT_NEAR(at_60.ratio, ratio, std::max(0.002, 0.1 * ratio));
        if (pieces > 6) continue;
        EXPECT_NEAR(at_60.first_peak, decay(frequency, pieces, ratio, 4000).first_peak,
                    0.04 * at_60.first_peak);
      }
    }
  }
}

// How far the tip of a cantilever column leans that carries `share` of Euler's load, and 1e-5 of it across.
double lean(double share, int pieces, double rate) {
  BeamDef def{.pieces = pieces, .length = 10, .height = 0.2, .youngs_modulus = 210e9, .gravity = 0};
  def.angle = pi / 2;
  def.fixtures = false;
  const double inertia = std::pow(def.height, 3) / 12, mass = def.density * def.height;
  const double bending = def.youngs_modulus * inertia;
  const double omega = first_mode * std::sqrt(bending / (mass * std::pow(def.length, 4)));
  def.damping_time = 2 * 0.05 / omega;
  Beam beam(def);
  const double load = share * pi * pi * bending / (4 * def.length * def.length);
  b2Body* last = beam.pieces.back();
  const b2Vec2 end{static_cast<float>(def.length / pieces / 2), 0};
  for (double t = 0; t < 60; t += 1 / rate) {
    const double now = load * std::min(1.0, t / 5);
    last->ApplyForce({static_cast<float>(1e-5 * now), static_cast<float>(-now)}, last->GetWorldPoint(end),
                     true);
    beam.world.Step(static_cast<float>(1 / rate), 8, 3);
    beam.structure.update();
  }
  return std::abs(last->GetWorldPoint(end).x);
}

// Of the elastica beyond Euler's load, as a share of its length: 2p/K(p) where P/P_cr = (2 K(p)/π)²
// (Timoshenko & Gere, Theory of Elastic Stability, 1961, 2.7; table 2-4 has 0.422 at 1.063).
double lean_of_elastica(double share) {
  double low = 0, high = 0.9;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (2 / pi * std::comp_ellint_1(middle) < std::sqrt(share) ? low : high) = middle;
  }
  return 2 * low / std::comp_ellint_1(low);
}

// The end of a cantilever is loaded at once, by a force that would turn the last piece by 0.36 rad in a step
// of 1/30 s, were it free. The end falls to twice its static deflection, period after period; the first mode
// has 97 % of that.
TEST(Motion, ALoadThatTurnsALightPieceDampsNothing) {
  constexpr int n = 12;
  constexpr double length = 5, height = 0.08, width = 0.1, E = 2e11, density = 7800, piece = length / n,
                   F = 600, bending = E * width * height * height * height / 12;
  for (const double rate : {30.0, 60.0, 120.0}) {
    b2World world({0, 0});
    world.SetAllowSleeping(false);
    Structure structure(world);
    b2Body* last = add_box(world, {.x = -0.5, .type = b2_staticBody});
    double deflection = 0;  // of the last piece's centre, of a chain of springs
    for (int i = 0; i < n; ++i) {
      b2Body* next = add_box(world, {.x = (i + 0.5) * piece,
                                     .width = piece,
                                     .height = height,
                                     .mass = density * width * height * piece});
      ElasticPlasticJointDef def;
      def.Initialize(last, next, vec(i * piece, 0), {1, 0});
      def.rows[rotation].stiffness = bending / (i > 0 ? piece : piece / 2);
      structure.create_joint(def);
      const double lever = length - i * piece;
      deflection += F * lever / def.rows[rotation].stiffness * (lever - piece / 2);
      last = next;
    }
    const auto deepest_in = [&](double seconds) {
      double deepest = 0;
      for (double t = 0; t < seconds; t += 1 / rate) {
        last->ApplyForce(vec(0, -F), last->GetWorldPoint(vec(piece / 2, 0)), true);
        world.Step(static_cast<float>(1 / rate), 8, 3);
        deepest = std::max(deepest, -double{last->GetPosition().y});
      }
      return deepest / deflection;
    };
    EXPECT_NEAR(deepest_in(2.6), 2, 0.06) << rate;
    EXPECT_NEAR(deepest_in(0.4), 2, 0.06) << rate;  // a period of 1/2.6 s
  }
}

// Below Euler's load first-order deflection grows by 1/(1 − P/P_cr). Beyond it an error of P_cr, a quarter of
// a per cent with 10 pieces, is one of 1/(2 (P/P_cr − 1)) times as much of the lean.
TEST(Motion, ColumnsBuckleAtEulersLoad) {
  // The table's row of a tip that turns by 40°: its share is cut to three digits, which are 1.6e-3 of the
  // lean.
  const double at_40_degrees = std::pow(2 / pi * std::comp_ellint_1(std::sin(pi / 9)), 2);
  EXPECT_NEAR(at_40_degrees, 1.063, 1e-3);
  EXPECT_NEAR(lean_of_elastica(at_40_degrees), 0.422, 5e-4);
  for (const double rate : {30.0, 60.0}) {
    for (const int pieces : {10, 20}) {
      SCOPED_TRACE(testing::Message() << rate << " Hz, " << pieces << " pieces");
      const double straight = 1e-5 * 0.95 * pi * pi / 4 * 10 / 3;
      EXPECT_NEAR(lean(0.95, pieces, rate), straight / 0.05, 0.1 * straight / 0.05);
      const double leant = lean_of_elastica(1.05) * 10;
      EXPECT_NEAR(lean(1.05, pieces, rate), leant, (pieces == 10 ? 0.025 : 0.0125) * leant);
    }
  }
}

// A cantilever that its own weight, set in at once, bends beyond yield: the root's plastic rotation, and the
// rotation of the chord at yield, M_p L/3EI.
struct Bent {
  double plastic, elastic;
};

Bent bent(int pieces, double share, double rate) {
  BeamDef def{.pieces = pieces, .youngs_modulus = 210e9, .gravity = 10};
  def.moment_cap = share * def.density * def.height * def.gravity * def.length * def.length / 2;
  const double inertia = std::pow(def.height, 3) / 12, mass = def.density * def.height;
  const double bending = def.youngs_modulus * inertia;
  def.damping_time = 2 * 0.02 * std::sqrt(mass * std::pow(def.length, 4) / bending) / first_mode;
  Beam beam(def);
  beam.run(3, 1 / rate);
  return {beam.joints[0]->accumulated_rotation(), def.moment_cap * def.length / (3 * bending)};
}

// Plastic moments as shares of the static one. What is less than the elastic rotation is known to a share of
// that.
TEST(Motion, AnElasticPlasticCantileverRotatesAsAtSmallSteps) {
  for (const int pieces : {6, 20}) {
    for (const double share : {1.05, 1.1, 1.2, 1.5, 1.7}) {
      const Bent exact = bent(pieces, share, 4000);
      EXPECT_GT(exact.plastic, 1e-4);
      EXPECT_NEAR(bent(pieces, share, 60).plastic, exact.plastic,
                  std::max(0.05 * exact.plastic, 0.02 * exact.elastic))
          << pieces << " " << share << ": " << exact.plastic << " " << exact.elastic;
    }
  }
}

// Period of the first vibration of a string of n rigid pieces, as a share of that of a continuous one, 2 L
// √(μ/T); T is `share` of μ l²/h², so that the wave runs l √share in a step.
double period_of_string(int n, double share, double rate) {
  const double h = 1 / rate, l = 1, mass = 100, tension = share * mass * l / (h * h);
  b2World world(b2Vec2_zero);
  Structure structure(world);
  world.SetAllowSleeping(false);
  b2BodyDef def;
  b2Body* last = world.CreateBody(&def);
  def.type = b2_dynamicBody;
  std::vector<b2Body*> pieces;
  for (int i = 0; i <= n; ++i) {
    def.position.Set(static_cast<float>((i + 0.5) * l), 0);
    if (i == n) def.type = b2_staticBody;
    b2Body* piece = world.CreateBody(&def);
    if (i < n) {
      const b2MassData data{static_cast<float>(mass), {0, 0}, static_cast<float>(mass * l * l / 12)};
      piece->SetMassData(&data);
      const double at = pi / n, to = (i + 1) * at, from = i * at;
      piece->SetLinearVelocity({0, static_cast<float>(0.01 * (std::sin(from) + std::sin(to)) / 2)});
      piece->SetAngularVelocity(static_cast<float>(0.01 * (std::sin(to) - std::sin(from)) / l));
      pieces.push_back(piece);
    }
    ElasticPlasticJointDef joint;
    joint.Initialize(last, piece, {static_cast<float>(i * l), 0}, {1, 0});
    joint.rows[axial].stiffness = 1e3 * tension / l;
    joint.state.elastic[axial] = 1e-3 * l;
    joint.rows[rotation].cap = joint.rows[rotation].cap_reverse = 0;
    structure.create_joint(joint);
    last = piece;
  }
  std::vector<double> crossings;
  const double period = 2 * n * l * std::sqrt(mass / l / tension);
  double y = 0;
  for (int i = 0; crossings.size() < 4 && i * h < 5 * period; ++i) {
    world.Step(static_cast<float>(h), 8, 3);
    structure.update();
    const double now = pieces[static_cast<std::size_t>(n / 2)]->GetWorldCenter().y;
    if (y < 0 && now >= 0) crossings.push_back(i - now / (now - y));
    y = now;
  }
  return crossings.size() < 4 ? 0 : (crossings[3] - crossings[0]) * h / 3 / period;
}

// Beyond a share of 1/3 a chain that knows of its tension at the step's start only would blow up.
TEST(Motion, ATautStringVibratesAtItsFrequency) {
  for (const double rate : {30.0, 60.0}) {
    for (const double share : {0.05, 0.2, 1.0, 4.0}) {
      EXPECT_NEAR(period_of_string(20, share, rate), 1, 0.02) << rate << " " << share;
    }
  }
}

// A mass on an elastic-plastic spring, and the force that sets in at once: Biggs, Introduction to Structural
// Dynamics (1964), 2.7: ductility 1/(2 (1 − F/R)) for F ≥ R/2.
struct Oscillator {
  explicit Oscillator(double period, double cap = unlimited) : world(b2Vec2_zero), structure(world) {
    world.SetAllowSleeping(false);
    b2BodyDef def;
    b2Body* ground = world.CreateBody(&def);
    def.type = b2_dynamicBody;
    def.position.Set(1, 0);
    body = world.CreateBody(&def);
    const b2MassData mass{1000, {0, 0}, 100};
    body->SetMassData(&mass);
    stiffness = 1000 * 4 * pi * pi / (period * period);
    ElasticPlasticJointDef joint;
    joint.Initialize(ground, body, {0, 0}, {1, 0});
    joint.rows[axial] = {.stiffness = stiffness, .cap = cap, .cap_reverse = cap};
    structure.create_joint(joint);
  }
  double step(double h, double force = 0) {
    body->ApplyForceToCenter({static_cast<float>(force), 0}, true);
    world.Step(static_cast<float>(h), 8, 3);
    structure.update();
    return body->GetWorldCenter().x - 1;
  }
  b2World world;
  Structure structure;
  b2Body* body;
  double stiffness;
};

// A dropped frame is a step twice as long. δ = ln 2 in it, and in the next, which is half as long, leaves at
// least exp(−δφ²/2) of a swing each, φ = ωh (row.h). Kept for half a second, δ took three quarters.
TEST(Motion, OneStepOfAnotherLengthDampsThatAndTheNext) {
  Oscillator mass(0.2);
  mass.body->SetLinearVelocity({1, 0});
  const auto swing_in = [&mass](int steps) {
    double most = 0;
    for (int i = 0; i < steps; ++i) most = std::max(most, std::abs(mass.step(1 / 60.0)));
    return most;
  };
  const double before = swing_in(60);
  mass.step(1 / 30.0);
  const double h = 2 * pi / 0.2 / 60, left = std::exp(-std::log(2) * (4 * h * h + h * h) / 2);
  EXPECT_GT(swing_in(60), left * before);
}

TEST(Motion, ASuddenForceReachesTheDuctilityOfTheClosedForm) {
  for (const double share : {0.5, 0.6, 0.75, 0.9}) {
    constexpr double cap = 1000;
    Oscillator mass(1, cap);
    double most = 0;
    for (int i = 0; i < 240; ++i) most = std::max(most, mass.step(1.0 / 60, share * cap));
    EXPECT_NEAR(most / (cap / mass.stiffness), 1 / (2 * (1 - share)), 0.002 / (2 * (1 - share))) << share;
  }
}

// An arm of 2 m on a spring of 2.2 Hz, which turns by up to 0.027 rad a step.
struct Arm {
  explicit Arm(double yield_moment) : world({0, 0}), structure(world) {
    world.SetAllowSleeping(false);
    b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody});
    body = add_box(world, {.x = 1, .width = 2, .height = 0.1, .mass = 310});
    ElasticPlasticJointDef def;
    def.Initialize(wall, body, {0, 0}, {1, 0});
    def.rows[rotation] = {.stiffness = stiffness, .cap = yield_moment, .cap_reverse = yield_moment};
    structure.create_joint(def);
  }
  void step(double rate) { world.Step(static_cast<float>(1 / rate), 8, 3); }
  static constexpr double stiffness = 80e3;  // N m/rad
  b2World world;
  Structure structure;
  b2Body* body;
};

// A moment does not turn with the arm: M θ = k θ_y²/2 + M_p (θ − θ_y), so θ/θ_y = 1/(2 (1 − M/M_p)).
TEST(Motion, ASuddenMomentReachesTheDuctilityOfTheClosedForm) {
  constexpr double M_p = 6e3;
  for (const double rate : {30.0, 45.0, 60.0, 120.0}) {
    for (const double share : {0.6, 0.8}) {
      Arm arm(M_p);
      double farthest = 0;
      for (double t = 0; t < 1; t += 1 / rate) {
        arm.body->ApplyTorque(static_cast<float>(share * M_p), true);
        arm.step(rate);
        farthest = std::max(farthest, std::abs(double{arm.body->GetAngle()}));
      }
      EXPECT_NEAR(farthest * Arm::stiffness / M_p * 2 * (1 - share), 1, 0.02) << rate << ", " << share;
    }
  }
}

// A mass on the end of a beam of light pieces, under a sudden force of s times what its root bears: P u = R
// (u − u_y/2) where it comes to rest. The joints beside the root, which no step resolves, stop growing as it
// yields. They are implicit in that step, which loses ½ k u²: u is part of ωh e_y √(2s − 1), what they would
// have grown by, and R (u − u_y) is (2s − 1)/(1 − s) times what they store until then. 2 % are the beam's own
// vibrations, which the balance leaves out.
TEST(Motion, ABeamOfManyPiecesYieldsAsMuchAsItsForceCanBend) {
  constexpr double share = 0.8, M_p = 875e3, length = 2, mass = 5000;
  for (const int pieces : {4, 10, 20}) {
    for (const double rate : {30.0, 50.0, 60.0, 120.0}) {
      Beam beam({.pieces = pieces,
                 .length = length,
                 .height = 0.1,
                 .youngs_modulus = 210e9,
                 .damping_time = 0,
                 .moment_cap = M_p,
                 .gravity = 0});
      b2BodyDef def;
      def.type = b2_dynamicBody;
      def.position = beam.point(length);
      b2Body* tip = beam.world.CreateBody(&def);
      const b2MassData data{static_cast<float>(mass), {0, 0}, 50};
      tip->SetMassData(&data);
      ElasticPlasticJointDef pin;
      pin.Initialize(beam.pieces.back(), tip, beam.point(length), {1, 0});
      pin.rows[rotation] = RowDef::free();
      beam.structure.create_joint(pin);

      double give = 0;  // of the tip, m per N
      for (int i = 0; i < pieces; ++i) {
        const auto& row = beam.joints[static_cast<std::size_t>(i)]->def();
        const double arm = length - i * length / pieces;
        give += arm * arm / row.rows[rotation].stiffness + 1 / row.rows[shear].stiffness;
      }
      const double R = M_p / length, u_y = R * give, omega_h = 1 / std::sqrt(give * mass) / rate;
      const double work = R * u_y * (share - 0.5) / (1 - share);
      for (int i = 0; i < rate; ++i) {
        tip->ApplyForceToCenter(vec(0, -share * R), true);
        beam.run(1 / rate, 1 / rate);
      }
      EXPECT_NEAR(beam.structure.energy().dissipated, work, (0.2 * omega_h * omega_h + 0.02) * work)
          << pieces << ", " << rate;
      EXPECT_GT(beam.structure.energy().numerical, -0.02 * work) << pieces << ", " << rate;
    }
  }
}

// Gravity sets in at once on beams held at one end or both. Their second frequency and those above, which no
// step of 1/60 s resolves, have another phase as hinges yield than at 1/1920 s: that is 6 %.
TEST(Motion, ABeamUnderSuddenGravityYieldsAsInFineSteps) {
  for (const bool held_at_both_ends : {false, true}) {
    for (const int pieces : {8, 20}) {
      const double length = held_at_both_ends ? 12 : 6, weight = 7800 * 0.1 * 10;
      const double at_rest = weight * length * length / (held_at_both_ends ? 12 : 2);
      const auto plastic_work = [&](double rate) {
        Beam beam({.pieces = pieces,
                   .length = length,
                   .height = 0.1,
                   .youngs_modulus = 210e9,
                   .damping_time = 0,
                   .moment_cap = 1.25 * at_rest});
        if (held_at_both_ends) {
          ElasticPlasticJointDef end;
          end.Initialize(beam.wall, beam.pieces.back(), beam.point(length), {1, 0});
          end.axisFollow = 0;
          beam.set_rows(end, length / pieces / 2);
          end.rows[axial] = RowDef::free();
          beam.structure.create_joint(end);
        }
        beam.run(1, 1 / rate);
        EXPECT_LT(std::abs(beam.structure.energy().numerical), 0.05 * beam.structure.energy().dissipated);
        return beam.structure.energy().dissipated;
      };
      const double fine = plastic_work(1920);
      ASSERT_GT(fine, 0.01 * at_rest);
      EXPECT_NEAR(plastic_work(60), fine, 0.06 * fine) << held_at_both_ends << ", " << pieces;
    }
  }
}

// A frame that is shaken at its own frequency until it yields, first here, then there: it takes what the
// ground gives. With (ωh)²/12 = 0.4 % its frequency is another, which is 1.3 % of a phase in 3.5 s; the rest
// is where in a step hinges yield.
TEST(Motion, AFrameInResonanceYieldsAsInFineSteps) {
  const auto plastic_work = [](double rate) {
    bench::Built frame(bench::frame(4, 4), bench::Built::ours, 10, true);
    for (int i = 0; i < 3.5 * rate; ++i) {
      frame.world.SetGravity(vec(3 * std::cos(4 * std::numbers::pi * i / rate), -10));
      frame.step(1 / rate);
    }
    return frame.structure->energy().dissipated;
  };
  const double fine = plastic_work(960);
  ASSERT_GT(fine, 1e5);
  EXPECT_NEAR(plastic_work(60), fine, 0.05 * fine);
}

// The ratio of the first mode of n masses in a row, each on the line to the one before, with dampers c = τk:
// ζ = ωτ/2 of ω = 2 √(k/m) sin(π/(4n + 2)).
double ratio_of_lines(double frequency, double ratio, double rate) {
  const int n = 80;
  const double mass = 10, omega = 2 * pi * frequency;
  const double angle = pi / (4 * n + 2), stiffness = mass * std::pow(omega / (2 * std::sin(angle)), 2);
  b2World world({0, 0});
  Structure structure(world);
  b2Body* last = add_box(world, {.type = b2_staticBody});
  std::vector<b2Body*> masses;
  std::vector<double> mode;
  for (int i = 1; i <= n; ++i) {
    b2Body* body = add_box(world, {.x = 2.0 * i, .mass = mass});
    ElasticPlasticJointDef line;
    line.InitializeLine(last, body, last->GetWorldCenter(), body->GetWorldCenter());
    line.rows[axial] = {.stiffness = stiffness, .damping = 2 * ratio / omega * stiffness};
    structure.create_joint(line);
    mode.push_back(std::sin(2 * i * angle));
    body->SetLinearVelocity(vec(2 * mode.back(), 0));
    masses.push_back(last = body);
  }
  std::vector<double> q{0, 0}, peaks;
  const int periods = 6;
  for (double t = 0; t < periods / frequency; t += 1 / rate) {
    world.Step(static_cast<float>(1 / rate), 8, 3);
    structure.update();
    q.push_back(0);
    for (std::size_t i = 0; i < mode.size(); ++i)
      q.back() += mode[i] * (masses[i]->GetPosition().x - 2 * (static_cast<double>(i) + 1));
    const double a = q[q.size() - 3], b = q[q.size() - 2], c = q.back();
    if (b > a && b >= c) peaks.push_back(vertex(a, b, c));
  }
  EXPECT_GE(peaks.size(), 5u);
  return damping_ratio(peaks[0], peaks[4], 4);
}

// Each of these lines alone would swing within a step, and its damper is heavier than a step resolves.
TEST(Motion, WhatHangsOnLinesIsDampedAsAsked) {
  for (const double rate : {30., 60., 120., 240., 480., 960.})
    for (const double ratio : {0.05, 0.1})
      EXPECT_NEAR(ratio_of_lines(1, ratio, rate), ratio, 0.02 * ratio) << rate << " Hz";
}

// However short an arm is, and so however slow, its hinge stops it at ½ I ω²/M_p.
TEST(Motion, AShortArmThatIsSetTurningStopsAtItsWork) {
  for (const double length : {0.05, 0.3}) {
    for (const double rate : {0.3, 1.0, 6.0}) {
      for (const bool before_first_step : {true, false}) {
        constexpr double angle = 0.05;
        const double mass = 1,
                     inertia = mass * length * length * (1 + 0.01) / 12 + mass * length * length / 4;
        Beam beam({.pieces = 1,
                   .length = length,
                   .height = length / 10,
                   .density = 10 * mass / (length * length),
                   .moment_cap = inertia * rate * rate / 2 / angle,
                   .gravity = 0});
        if (!before_first_step) beam.run(0.5);
        beam.pieces[0]->SetAngularVelocity(static_cast<float>(rate));
        beam.pieces[0]->SetLinearVelocity(vec(0, rate * length / 2));
        beam.run(3 * angle / rate + 1);
        EXPECT_NEAR(beam.joints[0]->accumulated_rotation(), angle, 0.01 * angle) << length << ", " << rate;
      }
    }
  }
}

// ζ = γ(ωh)³/2 = 6e-5 (row.h) takes 0.7 % in 4 s. The tolerance leaves room for what bodies part by along
// their tangents, of second order in 0.023 rad a step, and take back.
TEST(Motion, AnArmThatSwingsFarKeepsItsEnergy) {
  Arm arm(unlimited);
  const double inertia = 310 * (0.1 * 0.1 + 2 * 2) / 12.0 + 310, angle = 0.1,
               speed = angle * std::sqrt(Arm::stiffness / inertia);
  arm.body->SetAngularVelocity(static_cast<float>(speed));
  arm.body->SetLinearVelocity(vec(0, speed));
  const auto farthest_in = [&arm](int steps) {
    double farthest = 0;
    for (int i = 0; i < steps; ++i) {
      arm.step(60);
      farthest = std::max(farthest, std::abs(double{arm.body->GetAngle()}));
    }
    return farthest;
  };
  const double first = farthest_in(27);
  farthest_in(240 - 27);
  EXPECT_NEAR(std::pow(farthest_in(27) / first, 2), 1, 0.04);
}

// A beam of three stiff pieces between two walls, whose first joint yields as its weight sets in, and which
// was given a kick. Its rotation rows ring, unresolved, from step to step, and their caps threw them from
// side to side: it moved by 2 cm/s for good.
TEST(Motion, AStiffBeamThatYieldsOnceComesToRest) {
  constexpr double length = 8.88, piece = length / 3, mass = 133.72;
  constexpr double axial_stiffness[] = {5.80531e10, 4.94393e10, rigid, 4.42367e10},
                   bending_stiffness[] = {2.60177e8, 8.79356e7, 9.84271e8},
                   moment[] = {1877.24814, 5078.80669, 29199.6525};
  for (const double damping : {0.0, 1.2e-3}) {
    for (const double kick : {-0.2, 0.2, 0.24, 0.26, 0.28}) {
      b2World world(vec(-5.7843, -6.2179));
      world.SetAllowSleeping(false);
      Structure structure(world);
      b2BodyDef at;
      b2Body* wall = world.CreateBody(&at);
      std::vector<b2Body*> pieces;
      for (int i = 0; i < 4; ++i) {
        b2Body* last = i == 0 ? wall : pieces.back();
        const double x = (i + 0.5) * piece;
        if (i < 3) {
          pieces.push_back(add_box(world, {.x = x, .width = piece, .height = 0.174, .mass = mass}));
          const double share = x / length;
          pieces.back()->SetLinearVelocity(vec(0, kick * share * share * std::sin(std::numbers::pi * share)));
        }
        b2Body* next = i < 3 ? pieces.back() : wall;
        ElasticPlasticJointDef def;
        const b2Vec2 anchor = vec(i * piece, 0);
        i == 0 ? def.Initialize(next, last, anchor, {-1, 0}) : def.Initialize(last, next, anchor, {1, 0});
        const double k = axial_stiffness[i];
        def.rows[axial].stiffness = k;
        if (k < rigid) def.rows[axial].damping = damping * k;
        RowDef& bending = def.rows[rotation] = RowDef::free();
        if (i < 3) {
          bending.stiffness = bending_stiffness[i];
          bending.damping = damping * bending.stiffness;
          bending.cap = bending.cap_reverse = moment[i];
        }
        structure.create_joint(def);
      }
      for (int i = 0; i < 600; ++i) {
        world.Step(1 / 30.0f, 8, 3);
        structure.update();
      }
      EXPECT_LT(kinetic_energy(pieces), 1e-8) << damping << ", " << kick;
    }
  }
}

// A steel bar of 50 cm² swings on a pin, by so many rad. While it turns by more than 0.01 rad a step its
// axial row is implicit, and gaps that it leaves are no strain of the row that it is at the turning points:
// N = m (ω²L/2 + g cos φ), with ω from the energy. What it rings by as gravity sets in falls by 8 % a step.
TEST(Motion, ASteelBarThatSwingsPullsAsThePendulumThatItIs) {
  constexpr double area = 5e-3, E = 210e9, g = 9.81;
  for (const double hz : {30.0, 60.0, 120.0}) {
    for (const double L : {6.0, 14.0}) {
      for (const double swing : {0.6, 1.2, 2.0}) {
        b2World world(vec(0, -g));
        world.SetAllowSleeping(false);
        Structure structure(world);
        b2BodyDef pin;
        const double m = 7850 * area * L, start = swing - std::numbers::pi / 2;
        b2Body* bar = add_box(world, {.x = L / 2 * std::cos(start),
                                      .y = L / 2 * std::sin(start),
                                      .width = L,
                                      .height = 0.1,
                                      .mass = m,
                                      .angle = start});
        ElasticPlasticJointDef def;
        def.Initialize(world.CreateBody(&pin), bar, {0, 0}, bar->GetPosition());
        def.axisFollow = 1;
        def.rows[axial].stiffness = E * area / (L / 2);
        def.rows[rotation] = RowDef::free();
        ElasticPlasticJoint* joint = structure.create_joint(def);
        const double most = m * g * (1 + 1.5 * (1 - std::cos(swing)));
        for (int i = 0; i < 10 * hz; ++i) {
          const double phi = bar->GetAngle() + std::numbers::pi / 2;
          world.Step(static_cast<float>(1 / hz), 8, 3);
          const double N = m * g * (std::cos(phi) + 1.5 * (std::cos(phi) - std::cos(swing)));
          EXPECT_NEAR(joint->force(axial), N, (i > hz ? 0.02 : 1) * most)
              << hz << ", " << L << ", " << swing << ", " << i;
          EXPECT_LT(joint->elastic_energy(), 1e-3 * m * g * L) << hz << ", " << L << ", " << swing;
        }
      }
    }
  }
}

// Rows between bodies that turn far in a step are damped, as they take another direction. Those of others are
// not: a frictionless wheel may spin on its axle, or lie on a beam, and what swings does not know of it.
TEST(Motion, AWheelThatSpinsDampsNothing) {
  for (const bool on_axle : {true, false}) {
    const auto late_swing = [&](float spin) {
      Beam beam({.pieces = 8,
                 .length = 8,
                 .height = 0.2,
                 .density = 500,
                 .youngs_modulus = 1.2e9,
                 .damping_time = 0});
      b2BodyDef def;
      def.type = b2_dynamicBody;
      def.position = beam.point(on_axle ? 8 : 0.3);
      if (!on_axle) def.position.y += 0.1f + 0.2f + 0.01f;
      def.angularVelocity = spin;
      b2CircleShape circle;
      circle.m_radius = 0.2f;
      b2Body* wheel = beam.world.CreateBody(&def);
      b2Fixture* fixture = wheel->CreateFixture(&circle, 80);
      fixture->SetFriction(0);
      fixture->SetSensor(on_axle);
      if (on_axle) beam.structure.pin(def.position, std::vector<b2Body*>{beam.pieces.back(), wheel});
      beam.run(4);
      double lowest = 0, highest = -10;
      for (int i = 0; i < 60; ++i) {
        beam.run(1.0 / 60);
        const double y = beam.pieces.back()->GetPosition().y;
        lowest = std::min(lowest, y);
        highest = std::max(highest, y);
      }
      return highest - lowest;
    };
    const double still = late_swing(0);
    EXPECT_GT(still, 0.1);
    for (const float spin : {1.5f, 10.0f, 40.0f})
      EXPECT_NEAR(late_swing(spin), still, 1e-4 * still) << on_axle << spin;
  }
}

// What is elastic swings as if it could not yield.
TEST(Motion, AYieldSurfaceThatIsNotReachedDampsNothing) {
  for (const double frequency : {1.0, 2.0}) {
    const double omega = 2 * pi * frequency, swing = 0.3;  // rad/s, rad
    const auto left = [&](bool has_surface) {
      b2World world({0, 0});
      Structure structure(world);
      b2Body* arm = add_box(world, {.x = 0.5, .height = 0.1, .mass = 1});
      const double inertia = arm->GetInertia() + arm->GetMass() / 4;
      ElasticPlasticJointDef joint;
      joint.Initialize(add_box(world, {.x = -0.5, .type = b2_staticBody}), arm, {0, 0}, {1, 0});
      joint.rows[axial] = {.stiffness = arm->GetMass() * std::pow(2 * pi * 25, 2)};
      joint.rows[rotation] = {.stiffness = inertia * omega * omega};
      if (has_surface) joint.interaction = {{1e6, 0}, {0, 1e6}, {-1e6, 0}, {0, -1e6}};
      structure.create_joint(joint);
      arm->SetAngularVelocity(static_cast<float>(swing * omega));
      arm->SetLinearVelocity({0, static_cast<float>(swing * omega / 2)});
      double farthest = 0;
      for (int i = 0; i < 12 * 60; ++i) {
        world.Step(1.0f / 60, 8, 3);
        structure.update();
        if (i > 10 * 60) farthest = std::max(farthest, std::abs(double{arm->GetAngle()}));
      }
      return farthest;
    };
    EXPECT_GT(left(false), 0.8 * swing) << frequency;
    EXPECT_NEAR(left(true), left(false), 1e-6 * swing) << frequency;
  }
}

// The error of x(t) = v/ω sin ωt falls with h². Velocities belong to the middle of a step, so the start at t
// = 0 is late by h/2, which a peak shows to second order only.
TEST(Motion, IsOfSecondOrder) {
  const auto error = [](double rate) {
    Oscillator mass(1);
    mass.body->SetLinearVelocity({1, 0});
    double x = 0;
    for (int i = 0; i < static_cast<int>(1.25 * rate); ++i) x = mass.step(1 / rate);
    return std::abs(x - 1 / (2 * pi));
  };
  const double coarse = error(60), fine = error(120);
  EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " " << fine;
}

// A rigid-plastic hinge takes all of the energy that a beam turns with: θ = Iω²/2M_p, but for the last step,
// which is not complete: M_p h²/8I at most; and what the velocities that are given at the start turn by until
// the middle of the first step, to which they belong: (ωh)²/2 of it at most. The step that is the last in
// parts hands on its mean velocities, which are a chord's and (ωh)²/24 less: ¾ of the energy is in those, so
// that (ωh)²/16 of it is lost.
TEST(Motion, ARigidHingeStopsWhenItsWorkIsDone) {
  for (const double omega : {0.3, 1.0, 3.0, 6.0}) {
    BeamDef d{.pieces = 1, .length = 4, .height = 0.5, .density = 1000, .gravity = 0};
    const double mass = d.density * d.length * d.height, turn = 0.8;
    const double inertia = mass * (d.length * d.length / 3 + d.height * d.height / 12);
    d.moment_cap = inertia * omega * omega / (2 * turn);
    Beam beam(d);
    beam.pieces[0]->SetAngularVelocity(static_cast<float>(omega));
    beam.pieces[0]->SetLinearVelocity({0, static_cast<float>(omega * d.length / 2)});
    beam.run(2.2 * turn / omega);
    EXPECT_NEAR(beam.joints[0]->accumulated_rotation(), turn,
                d.moment_cap / (8 * 3600 * inertia) + omega * omega / 3600 * (1 / 2. + 1 / 16.) * turn)
        << omega;
  }
}

// Where a free spin of two masses m and I, d apart, stops drawing out a tie of the cap F: with L = J ω₀ kept
// and J = m d²/2 + 2I, F (d − d₀) = L²/2 (1/J₀ − 1/J).
double drawn_out(double m, double I, double d0, double omega, double F) {
  const auto J = [&](double d) { return m * d * d / 2 + 2 * I; };
  const double L = J(d0) * omega;
  const auto left = [&](double d) { return L * L / 2 * (1 / J(d0) - 1 / J(d)) - F * (d - d0); };
  double low = d0, high = 2 * d0;
  for (double d = d0; d < high; d += 1e-3 * d0)
    if (left(d) > 0) low = d;
  if (low == d0) return 0;
  for (int i = 0; i < 60; ++i) (left((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low - d0;
}

// A tie of steel, no step's to resolve, flows by what a free spin asks of it, and gains nothing: what its
// masses part by in a step, T = d (ωh)²/2, is up to a hundred times what it is strained by at its cap. A spin
// that is given at the start, to bodies whose velocities belong to the middle of a step, draws it out by up
// to 3 T.
TEST(Motion, ATieOfSteelFlowsByWhatASpinAsksOfIt) {
  constexpr double m = 200, inertia = 50, d = 6, EA = 210e9 * 0.01;
  struct Case {
    double critical, rate;
  };
  for (const auto& [critical, rate] : {Case{0.6, 60}, Case{0.6, 240}, Case{2, 240}, Case{2.5, 240}}) {
    for (const double share : {0.9, 0.95, 1.04, 1.2}) {
      SCOPED_TRACE(testing::Message() << critical << " rad/s, " << rate << " Hz, " << share);
      const double omega = share * critical, cap = m * d / 2 * critical * critical;
      b2World world({0, 0});
      world.SetAllowSleeping(false);
      Structure structure(world, {.keep_ledger = true});
      b2Body* masses[2];
      for (const int side : {0, 1}) {
        masses[side] = add_box(world, {.x = (side - 0.5) * d, .width = 0.2, .height = 0.2, .mass = m});
        const b2MassData data{m, {0, 0}, inertia};
        masses[side]->SetMassData(&data);
        masses[side]->SetAngularVelocity(static_cast<float>(omega));
        masses[side]->SetLinearVelocity(vec(0, omega * (side - 0.5) * d));
      }
      ElasticPlasticJointDef def;
      def.Initialize(masses[0], masses[1], {0, 0}, {1, 0});
      def.rows[axial] = {.stiffness = EA / d, .cap = cap, .cap_reverse = cap, .damping = 1e-4 * EA / d};
      def.rows[rotation].stiffness = EA * 0.01 / 12 / d;
      const ElasticPlasticJoint* tie = structure.create_joint(def);
      const double start = kinetic_energy(masses), turn2 = omega * omega / (rate * rate), T = d * turn2 / 2;
      for (int i = 0; i < 20 * rate; ++i) {
        world.Step(static_cast<float>(1 / rate), 8, 3);
        structure.update();
      }
      const JointEnergy e = structure.energy();
      const double apart = (masses[1]->GetPosition() - masses[0]->GetPosition()).Length();
      EXPECT_NEAR(tie->elongation(), drawn_out(m, inertia, d, omega, cap), 3.5 * T);
      EXPECT_NEAR(apart - d, tie->elongation(), T);
      EXPECT_NEAR((kinetic_energy(masses) + e.elastic + e.dissipated + e.damping) / start, 1, turn2 / 2);
    }
  }
}

// A bar that spins freely is strained by the pull N of what is farther out, and stores Σ N²/2k. What its
// pieces part by along tangents in a step is no strain; of that, shear rows see lφ³/6 a step, φ = ωh. A spin
// that is given at the start, to bodies whose velocities belong to the middle of a step, parts them by lφ²/2,
// of which the law stores ½kε(lφ²/2)² at first: 1.6e-3 of the spin at 60 Hz and the ratio 0.01.
TEST(Motion, ASpinningBarStoresWhatItsPullStrains) {
  for (const double rate : {60.0, 240.0}) {
    for (const int pieces : {5, 20}) {
      for (const double ratio : {0.0, 0.01, 0.05}) {
        SCOPED_TRACE(testing::Message() << rate << " Hz, " << pieces << " pieces, ratio " << ratio);
        constexpr double omega = 3;
        BeamDef def{.pieces = pieces, .youngs_modulus = 210e9, .gravity = 0};
        def.damping_time = 2 * ratio / 5.14;  // of a cantilever of these measures
        Beam bar(def);
        bar.world.DestroyJoint(bar.joints[0]);
        const double l = def.length / pieces, mass = bar.mass() / pieces;
        double kinetic = 0, stored = 0, pull = 0;
        for (int i = 0; i < pieces; ++i) {
          b2Body* piece = bar.pieces[static_cast<std::size_t>(i)];
          const double r = (i + 0.5) * l - def.length / 2;
          piece->SetLinearVelocity({0, static_cast<float>(omega * r)});
          piece->SetAngularVelocity(static_cast<float>(omega));
          kinetic += (mass * r * r + piece->GetInertia()) * omega * omega / 2;
          pull -= mass * r * omega * omega;  // at the end of piece i
          if (i + 1 < pieces) stored += pull * pull / 2 * l / (def.youngs_modulus * def.height);
        }
        const auto total = [&] {
          double sum = bar.structure.energy().elastic;
          for (b2Body* piece : bar.pieces) {
            const double v = piece->GetLinearVelocity().Length(), w = piece->GetAngularVelocity();
            sum += (mass * v * v + piece->GetInertia() * w * w) / 2;
          }
          return sum;
        };
        for (int i = 0; i < 4 * rate; ++i) {
          bar.world.Step(static_cast<float>(1 / rate), 8, 3);
          bar.structure.update();
          EXPECT_LT(total(), kinetic * (1 + 2e-3)) << i;
        }
        EXPECT_NEAR(total(), kinetic, 2e-3 * kinetic);
        EXPECT_NEAR(bar.structure.energy().elastic, stored, 0.03 * stored);
      }
    }
  }
}

TEST(Motion, OneJointSwingsAtItsFrequencyAndRatio) {
  for (const double frequency : {1.0, 3.0, 6.0}) {
    for (const double ratio : {0.0, 0.02, 0.1, 0.2}) {
      Oscillator mass(1 / frequency);
      ElasticPlasticJointDef joint;
      b2Body* ground = mass.structure.joints()[0]->GetBodyA();
      mass.world.DestroyJoint(mass.structure.joints()[0]);
      joint.Initialize(ground, mass.body, {0, 0}, {1, 0});
      joint.rows[axial] = {.stiffness = mass.stiffness,
                           .damping = 2 * ratio * mass.stiffness / (2 * pi * frequency)};
      mass.structure.create_joint(joint);
      mass.body->SetLinearVelocity({1, 0});
      std::vector<double> x{0}, crossings, peaks;
      for (int i = 0; i < 600; ++i) {
        x.push_back(mass.step(1.0 / 60));
        const std::size_t n = x.size();
        if (x[n - 2] < 0 && x[n - 1] >= 0) crossings.push_back(i - x[n - 1] / (x[n - 1] - x[n - 2]));
        if (n < 3) continue;
        const double a = x[n - 3], b = x[n - 2], c = x[n - 1];
        if (b > a && b >= c && b > 0) peaks.push_back(vertex(a, b, c));
      }
      SCOPED_TRACE(testing::Message() << frequency << " Hz, ratio " << ratio);
      const double damped = std::sqrt(1 - ratio * ratio);
      ASSERT_GT(crossings.size(), 4u);
      // The average acceleration method makes a period longer by φ²/12, φ = ωh.
      const double phi = 2 * pi * frequency / 60;
      // A damper of 2ζ > φ is integrated by implicit Euler, whose errors are of the order of ζφ/2.
      const double heavy = 2 * ratio > phi ? ratio * phi / 2 : 0;
      EXPECT_NEAR(180 / (crossings[3] - crossings[0]) / (frequency * damped), 1,
                  0.01 + phi * phi / 12 + heavy);
      EXPECT_NEAR(damping_ratio(peaks[0], peaks[3], 3), ratio, std::max(0.002, (0.01 + heavy) * ratio));
    }
  }
}

// A bar of 100 kg on an elastic clamp is struck at up to 50 m/s by ten times its mass, which turns it by up
// to a rad: its springs are implicit then. Left alone it comes to rest where it hung before, at m g l/2k.
// What it still swings by is less than a hundredth of that.
TEST(Motion, AnElasticBarThatIsStruckIsNotBent) {
  for (const double hz : {30., 60.})
    for (const double speed : {20., 30., 40., 50.}) {
      constexpr double stiffness = 1e5, mass = 100, length = 1, gravity = 10;
      b2World world(vec(0, -gravity));
      world.SetAllowSleeping(false);
      Structure structure(world);
      b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody, .group = -1});
      b2Body* bar =
          add_box(world, {.x = length / 2, .width = length, .height = 0.2, .mass = mass, .group = 0});
      ElasticPlasticJointDef clamp;
      clamp.Initialize(wall, bar, {0, 0}, {1, 0});
      clamp.rows[rotation].stiffness = stiffness;
      clamp.rows[axial].stiffness = 200 * stiffness;
      clamp.rows[shear].stiffness = 70 * stiffness;
      const ElasticPlasticJoint* joint = structure.create_joint(clamp);
      b2BodyDef def;
      def.type = b2_dynamicBody;
      def.position = vec(0.9, 0.5);
      b2Body* ball = world.CreateBody(&def);
      b2CircleShape circle;
      circle.m_radius = 0.3f;
      ball->CreateFixture(&circle, static_cast<float>(10 * mass / (std::numbers::pi * 0.09)));
      ball->SetLinearVelocity(vec(0, -speed));
      const auto run = [&](double seconds) {
        for (int i = 0; i < std::lround(seconds * hz); ++i) {
          world.Step(static_cast<float>(1 / hz), 8, 3);
          structure.update();
        }
      };
      run(0.5);
      world.DestroyBody(ball);
      bar->SetAngularDamping(3);
      run(10);
      const double hung = -mass * gravity * length / 2 / stiffness;
      EXPECT_NEAR(bar->GetAngle(), hung, 0.01 * -hung) << hz << " Hz, " << speed;
      EXPECT_EQ(joint->neutral(rotation), 0) << hz << " Hz, " << speed;
    }
}

// A block on two springs in series, with a gusset between them that is ten million times as light, swings as
// on one of half of their stiffness: no step resolves the gusset, but what the springs move is the block.
TEST(Motion, GussetsDampNothing) {
  constexpr double mass = 100, frequency = 2, omega = 2 * pi * frequency, hz = 60;
  b2World world({0, 0});
  world.SetAllowSleeping(false);
  Structure structure(world);
  b2Body* wall = add_box(world, {.x = -0.5, .type = b2_staticBody});
  b2Body* gusset = add_box(world, {.x = 0.5, .mass = 1e-7 * mass});
  b2Body* block = add_box(world, {.x = 1.5, .mass = mass});
  const auto join = [&](b2Body* a, b2Body* b, double x) {
    ElasticPlasticJointDef def;
    def.Initialize(a, b, vec(x, 0), {1, 0});
    def.rows[axial] = {.stiffness = 2 * mass * omega * omega};
    structure.create_joint(def);
  };
  join(wall, gusset, 0);
  join(gusset, block, 1);
  for (b2Body* b : {gusset, block}) b->SetLinearVelocity(vec(b == block ? 1 : 0.5, 0));
  std::vector<double> crossings;
  double last = 0, first_peak = 0, peak = 0;
  for (int i = 0; i < 10 / frequency * hz; ++i) {
    world.Step(static_cast<float>(1 / hz), 8, 3);
    structure.update();
    const double x = block->GetPosition().x - 1.5;
    if (last < 0 && x >= 0) crossings.push_back(i - x / (x - last));
    if (i == std::lround(hz / frequency)) first_peak = std::exchange(peak, 0);
    if (i >= 9 / frequency * hz || first_peak == 0) peak = std::max(peak, x);
    last = x;
  }
  ASSERT_GT(crossings.size(), 8u);
  const double phi = omega / hz;  // the average acceleration method makes a period longer by φ²/12
  EXPECT_NEAR(8 * hz / (crossings[8] - crossings[0]) / frequency, 1 - phi * phi / 12, 1e-3);
  EXPECT_NEAR(first_peak, 1 / omega, 0.02 / omega);
  EXPECT_NEAR(std::log(first_peak / peak) / (2 * pi * 9), 0, 0.002);
}

double step_of(int sequence, int i) {
  switch (sequence) {
    case 0:
      return 1 / 60.0;
    case 1:
      return i % 2 == 0 ? 1 / 60.0 : 1 / 30.0;
    case 2:
      return i % 10 == 9 ? 1 / 30.0 : 1 / 60.0;
    default:
      return 1.0 / std::array{30, 60, 240}[static_cast<std::size_t>(i % 3)];
  }
}

// Two halves of a bar spin about their joint, in steps of unequal lengths: it bears N = m ω² r for ever, and
// yields by none of them at a cap of 1.2 N. By what the first steps of a spin draw it apart it may, once
// ((ωh)²/2 of r, docs/games/promises.md), 1 % of the energy at 3 rad/s and 1/30 s.
TEST(UnequalSteps, OfASpin) {
  for (const double stiffness : {rigid, 1e9, 1e7}) {
    for (int sequence = 0; sequence < 4; ++sequence) {
      constexpr double m = 189, r = 1.5, spin = 3;
      b2World world({0, 0});
      world.SetAllowSleeping(false);
      Structure structure(world, {.keep_ledger = true});
      b2Body* halves[2];
      for (const int side : {0, 1}) {
        halves[side] = add_box(world, {.x = side == 0 ? -r : r, .width = 2 * r, .height = 0.3, .mass = m});
        halves[side]->SetAngularVelocity(static_cast<float>(spin));
        halves[side]->SetLinearVelocity(vec(0, side == 0 ? -spin * r : spin * r));
      }
      ElasticPlasticJointDef def;
      def.Initialize(halves[0], halves[1], {0, 0}, {1, 0});
      const double cap = 1.2 * m * spin * spin * r;
      def.rows[axial] = {.stiffness = stiffness, .cap = cap, .cap_reverse = cap};
      structure.create_joint(def);
      const double start = kinetic_energy(halves);
      for (int i = 0; i < 600; ++i) {
        world.Step(static_cast<float>(step_of(sequence, i)), 8, 3);
        structure.update();
      }
      EXPECT_LT(structure.energy().dissipated, 0.01 * start) << stiffness << ", " << sequence;
      EXPECT_NEAR(kinetic_energy(halves), start, 0.015 * start) << stiffness << ", " << sequence;
    }
  }
}

// A ball of 100 kg swings on a rope or on a pinned bar of 4 m from 1.2 rad: m g (3 − 2 cos 1.2) at most.
TEST(UnequalSteps, OfASwing) {
  for (const bool is_rope : {true, false}) {
    for (int sequence = 0; sequence < 4; ++sequence) {
      constexpr double m = 100, start = 1.2, length = 4;
      const double cap = 1.1 * m * 10 * (3 - 2 * std::cos(start));
      const b2Vec2 at = vec(length * std::sin(start), -length * std::cos(start));
      b2World world({0, -10});
      world.SetAllowSleeping(false);
      Structure structure(world);
      b2BodyDef held;
      b2Body* wall = world.CreateBody(&held);
      b2Body* ball = add_box(world, {.x = at.x, .y = at.y, .width = 0.2, .height = 0.2, .mass = m});
      ElasticPlasticJointDef def;
      if (is_rope) {
        def.InitializeLine(wall, ball, {0, 0}, at);
        def.rows[axial] = RowDef::rope(rigid, cap);
      } else {
        def.Initialize(wall, ball, {0, 0}, at);
        def.rows[rotation] = RowDef::free();
        def.rows[axial] = {.stiffness = rigid, .cap = cap, .cap_reverse = cap};
        def.axisFollow = 1;
      }
      const ElasticPlasticJoint* joint = structure.create_joint(def);
      for (int i = 0; i < 600; ++i) {
        world.Step(static_cast<float>(step_of(sequence, i)), 8, 3);
        structure.update();
      }
      EXPECT_LT(joint->elongation(), 1e-6) << is_rope << ", " << sequence;
    }
  }
}

}  // namespace
}  // namespace ductile
