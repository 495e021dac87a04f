// Levels that come and go: what a structure keeps in the world, who owns which body, worlds that end.
#include <memory>
#include <stdexcept>

#include "game.h"

using namespace game;

namespace {

template <class Do>
bool is_refused(Do attempt) {
  try {
    attempt();
  } catch (const std::exception& error) {
    std::printf("   it says: %s\n", error.what());
    return true;
  }
  return false;
}

void cleared_by_destroying_all() {
  b2World world({0, -10});
  Structure structure(world);
  check(world.GetBodyCount() == 1 && Structure::is_watch(*world.GetBodyList()),
        "its one body says what it is");
  for (int level = 0; level < 100; ++level) {
    const Beam beam(world, structure, 4);
    run(world, structure, 0.2);
    check_near(beam.joints[0]->force(rotation), -10 * 250 * 8, 1, "a new level stands");
    for (b2Body *b = world.GetBodyList(), *next; b; b = next) next = b->GetNext(), world.DestroyBody(b);
    if (level > 2) continue;
    check(structure.joints().empty() && world.GetBodyCount() == 0, "  and is cleared");
  }
  check(structure.bytes() < 20'000, "nothing is left of a hundred levels",
        static_cast<double>(structure.bytes()));
}

void one_structure_per_body() {
  b2World world({0, -10}), other({0, -10});
  Structure first(world), second(world), third(other);
  check(Structure::of(world) == &first, "a world knows its structure");
  const Beam beam(world, first, 5), elsewhere(other, third, 1);
  b2Body* more = box(world, 5.5, 0, 1, 0.5, 250);
  ElasticPlasticJointDef def;
  def.Initialize(beam.bodies.back(), more, {5, 0}, {1, 0});
  check(is_refused([&] { second.create_joint(def); }), "two structures share no body");
  check(!second.problems(def).empty(), "  as one can ask without an exception");
  first.create_joint(def);
  run(world, first, 5);
  check_near(beam.joints[0]->force(rotation), -10 * 250 * 18, 5, "  and one carries all of it");
  def.Initialize(beam.bodies.back(), elsewhere.bodies[0], {5, 0}, {1, 0});
  check(is_refused([&] { first.create_joint(def); }), "no joint ties two worlds");
}

void worlds_that_end() {
  auto world = std::make_unique<b2World>(b2Vec2{0, -10});
  Structure structure(*world);
  Beam(*world, structure, 3);
  world.reset();
  structure.update();
  check(structure.world() == nullptr && structure.joints().empty(), "a structure outlives its world");
  world = std::make_unique<b2World>(b2Vec2{0, -10});
  check(is_refused([&] { Beam(*world, structure, 1); }), "  and makes nothing in the next one");
  structure = Structure(*world);
  const Beam beam(*world, structure, 3);
  run(*world, structure, 1);
  check_near(beam.joints[0]->force(rotation), -10 * 250 * 4.5, 1, "  until it is that one's");
  structure = Structure(*world);  // the old one's joints are welds now
  run(*world, structure, 1);
  check(world->GetJointCount() == 3 && structure.joints().empty(), "joints without a structure are welds");
}

}  // namespace

int main() {
  cleared_by_destroying_all();
  one_structure_per_body();
  worlds_that_end();
  return failed;
}
