// A game with precomputed capacities: a bar of 1 m and 100 kg on a wall, held at its end by a joint that
// carries half of the moment of its weight, until the bar hangs.
#include <ductile/joint.h>

#include <cmath>
#include <cstdio>

int main() {
  b2World world({0, -10});
  b2BodyDef def;
  b2Body* wall = world.CreateBody(&def);
  def.type = b2_dynamicBody;
  def.position = {0.5f, 0};
  b2Body* bar = world.CreateBody(&def);
  const b2MassData mass{100, {0, 0}, 100. / 12};
  bar->SetMassData(&mass);

  ductile::Structure structure(world);
  ductile::ElasticPlasticJointDef joint;
  joint.Initialize(wall, bar, {0, 0}, {1, 0});
  joint.rows[ductile::rotation].cap = joint.rows[ductile::rotation].cap_reverse = 250;
  const ductile::ElasticPlasticJoint* root = structure.create_joint(joint);
  for (int i = 0; i < 60; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }
  const double angle = -bar->GetAngle();
  std::printf("stopped at %g rad, %g J dissipated\n", angle, root->dissipated());
  const bool stopped =
      std::abs(std::sin(angle) / angle - 0.5) < 1e-3 && std::abs(bar->GetAngularVelocity()) < 1e-3;
  return stopped && std::abs(root->dissipated() / (250 * angle) - 1) < 1e-3 ? 0 : 1;
}
