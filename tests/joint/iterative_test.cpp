// The paper's scheme as an option: good for few pieces, and with high caps the weld that Box2D has.
#include <gtest/gtest.h>

#include <utility>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

// By what eight sweeps add to those of the steps before: from none, the root of five pieces errs by half.
TEST(Iterative, HoldsFewPieces) {
  for (const auto& [pieces, error] : {std::pair{1, 1e-5}, {2, 1e-5}, {5, 0.1}}) {
    Beam beam({.pieces = pieces, .solver = SolverKind::iterative});
    beam.run(5);
    EXPECT_NEAR(beam.joints[0]->force(rotation) / beam.root_moment(), 1, error) << pieces;
  }
}

TEST(Iterative, LoneJointRotatesUntilThePlasticWorkIsTheFall) {
  // M0 sinθ = M_p θ at 1.5: 1.4958
  const double moment = 7800 * 10 * 20.0 * 20.0 / 2;
  Beam beam({.pieces = 1, .moment_cap = moment / 1.5, .solver = SolverKind::iterative});
  beam.run(14);
  EXPECT_NEAR(beam.joints[0]->accumulated_rotation(), 1.4957815682221, 2e-3 * 1.4958);
}

// The same pieces joined by stock welds, stepped beside the beam.
double distance_from_welds(int pieces, double seconds) {
  Beam beam({.pieces = pieces, .moment_cap = b2_maxFloat, .solver = SolverKind::iterative});
  b2World world({0, -10});
  world.SetAllowSleeping(false);
  b2BodyDef ground;
  b2Body* previous = world.CreateBody(&ground);
  std::vector<b2Body*> welded;
  for (b2Body* piece : beam.pieces) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = piece->GetPosition();
    b2Body* body = world.CreateBody(&def);
    b2FixtureDef fixture;
    fixture.shape = piece->GetFixtureList()->GetShape();
    fixture.filter.groupIndex = -1;
    fixture.density = 1;
    body->CreateFixture(&fixture);
    b2MassData mass;
    piece->GetMassData(&mass);
    body->SetMassData(&mass);
    b2WeldJointDef weld;
    weld.Initialize(previous, body,
                    beam.point(beam.def.length / pieces * static_cast<double>(welded.size())));
    world.CreateJoint(&weld);
    welded.push_back(body);
    previous = body;
  }
  double farthest = 0;
  for (int i = 0; i < std::lround(60 * seconds); ++i) {
    world.Step(1 / 60.0f, 8, 3);
    beam.run(1.0 / 60);
    for (std::size_t k = 0; k < welded.size(); ++k) {
      const b2Vec2 apart = welded[k]->GetPosition() - beam.pieces[k]->GetPosition();
      farthest = std::max(farthest, static_cast<double>(apart.Length()));
    }
  }
  return farthest;
}

TEST(Iterative, WithHighCapsItMovesAsAWeld) {
  EXPECT_LT(distance_from_welds(1, 2), 1e-6);
  EXPECT_LT(distance_from_welds(2, 2),
            1e-3);  // Box2D's order of joints within its island may differ from ours
}

// True stiffness is more than unfinished iterations can integrate, and impulses of a short step are too rough
// to be made long ones of: both blew structures up.
TEST(Iterative, GainsNoEnergy) {
  const std::vector<double> even{1.0 / 60}, uneven{1.0 / 15, 1.0 / 5000, 1.0 / 60, 1.0 / 240, 1.0 / 30};
  for (const double E : {0.0, 210e9}) {
    for (const auto& steps : {even, uneven}) {
      Beam beam({.pieces = 6, .length = 6, .youngs_modulus = E, .solver = SolverKind::iterative});
      const auto energy = [&] {
        double sum = kinetic_energy(beam.pieces) + potential_energy(beam.pieces, 10);
        for (const ElasticPlasticJoint* j : beam.joints) sum += j->elastic_energy();
        return sum;
      };
      const double start = energy();
      double turnover = 0;
      for (std::size_t i = 0; i < 600; ++i) {
        const double h = steps[i % steps.size()];
        beam.run(h, h);
        turnover = std::max(turnover, std::abs(potential_energy(beam.pieces, 10) - start));
        ASSERT_LE(energy() - start, 1e-4 * turnover) << i << ", E " << E;
      }
    }
  }
}

}  // namespace
}  // namespace ductile
