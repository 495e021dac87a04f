// What a game does wrong: in handlers, in contact callbacks, with numbers. Each is defined.
#include <limits>
#include <stdexcept>
#include <string>

#include "game.h"

using namespace game;

namespace {

// A beam of two pieces that breaks at its root in its first second.
struct Weak {
  Weak() : structure(world), beam(world, structure, 2, {.cap = 1000, .cap_reverse = 1000}) {
    beam.joints[0]->set_limits(0.1, unlimited, unlimited, unlimited);
  }
  b2World world{{0, -10}};
  Structure structure;
  Beam beam;
};

void in_handlers() {
  Weak once;
  int told = 0;
  once.structure.on_event([&](const JointEvent&) { ++told, once.structure.update(); });
  run(once.world, once.structure, 1);
  check(told > 2 && once.structure.joints().size() == 1, "update() in a handler does nothing", told);

  Weak thrown;
  int caught = 0, broke = 0;
  thrown.structure.on_event([&](const JointEvent& event) {
    broke += event.kind == JointEvent::broke;
    throw std::runtime_error("the game's");
  });
  for (int i = 0; i < 60; ++i) {
    thrown.world.Step(1 / 60.0f, 8, 3);
    try {
      thrown.structure.update();
    } catch (const std::runtime_error&) {
      ++caught;
    }
  }
  thrown.structure.on_event({});
  thrown.structure.update();
  check(caught > 2 && broke == 1 && thrown.structure.joints().size() == 1,
        "a handler that throws is heard once an event", caught);

  Weak destroys;
  destroys.structure.on_event([&](const JointEvent& event) {
    if (event.kind == JointEvent::broke) destroys.world.DestroyBody(destroys.beam.bodies[0]);
  });
  run(destroys.world, destroys.structure, 1);
  check(destroys.structure.joints().empty(), "a handler may destroy the body that broke off");
}

void in_a_contact() {
  struct Listener : b2ContactListener {
    void BeginContact(b2Contact*) override {
      ElasticPlasticJointDef def;
      def.Initialize(weak->beam.bodies[0], weak->beam.bodies[1], {1, 0}, {1, 0});
      try {
        weak->structure.create_joint(def);
      } catch (const std::exception& error) {
        said = error.what();
      }
    }
    Weak* weak = nullptr;
    std::string said;
  } listener;
  Weak weak;
  listener.weak = &weak;
  weak.world.SetContactListener(&listener);
  b2Body* stone = box(weak.world, 1, 0.6, 0.3, 0.3, 100);
  stone->GetFixtureList()->SetFilterData({});
  run(weak.world, weak.structure, 0.3);
  check(listener.said.find("stepping") != std::string::npos,
        ("a joint made in a contact: " + listener.said).c_str());
}

void with_numbers() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  b2World world({0, -10});
  world.SetAllowSleeping(false);  // asleep it would stay asleep, as Box2D has it
  Structure structure(world);
  const Beam beam(world, structure, 4);
  run(world, structure, 0.5);
  beam.bodies[2]->SetLinearVelocity({nan, 0});
  run(world, structure, 3);
  check_near(beam.joints[0]->force(rotation), -10 * 250 * 8, 1,
             "a velocity that is no number stops its body alone");
  const std::vector<std::string> told = structure.warnings();
  check(told.size() == 1, told.empty() ? "  and says so" : ("  and says so: " + told[0]).c_str());

  ElasticPlasticJointDef def;
  def.Initialize(beam.bodies[2], beam.bodies[3], {3, 0}, {1, 0});
  def.rows[axial].cap = -1;
  def.rows[shear].hardening = -1;
  def.rows[rotation].damping_ratio = nan;
  check(structure.problems(def).size() == 3, "every mistake of a def is told",
        static_cast<double>(structure.problems(def).size()));
  run(world, structure, 0.5);
  world.Step(0, 8, 3);
  world.Step(1 / 60.0f, 0, 0);
  structure.update();
  run(world, structure, 1);
  check_near(beam.joints[0]->force(rotation), -10 * 250 * 8, 1, "steps of nothing change nothing");
}

}  // namespace

int main() {
  in_handlers();
  in_a_contact();
  with_numbers();
  return failed;
}
