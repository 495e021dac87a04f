// A bent beam saved and loaded, sent to a late player, repaired; rewound; and no memory asked for while it
// runs.
#include <ductile/save.h>

#include <new>

#include "game.h"

using namespace game;

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

int main() {
  const RowDef root{
      .stiffness = 1e6, .damping_ratio = 0.5, .cap = 18e3, .cap_reverse = 18e3, .hardening = 2e4};
  b2World world({0, -10});
  world.SetAllowSleeping(false);
  Structure structure(world);
  Beam beam(world, structure, 4, root);  // M = 20 kN m
  run(world, structure, 0.7);
  const double bent = beam.joints[0]->plastic(rotation);
  check(bent < -0.01, "it bends", bent);

  // Another process, by its bytes; and a player who gets text.
  const std::vector<std::uint8_t> bytes = save_bytes(structure);
  const std::string text = save_json(structure);
  b2World loaded({0, 0}), told({0, 0});
  Structure of_bytes(loaded), of_text(told);
  load_bytes(of_bytes, bytes);
  load_json(of_text, text);
  Snapshot snapshot;
  snapshot.save(world);
  run(world, structure, 5);
  const b2Vec2 tip = beam.bodies[3]->GetPosition();
  for (Structure* each : {&of_bytes, &of_text}) {
    check_near(each->joints()[0]->plastic(rotation), bent, 1e-12, "what is loaded is as bent");
    run(*each->world(), *each, 5);
    const b2Vec2 other = each->joints()[3]->GetBodyB()->GetPosition();
    check(other == tip, "  and goes on to the bit", (other - tip).Length());
  }
  snapshot.restore(world);
  run(world, structure, 5);
  check(beam.bodies[3]->GetPosition() == tip, "rewound, it goes on to the bit");

  beam.joints[0]->set_state({});
  check(beam.joints[0]->accumulated_rotation() == 0 && beam.joints[0]->dissipated() == 0,
        "repaired, it is as new");

  run(world, structure, 1);
  const long before = allocations;
  run(world, structure, 5);
  check(allocations == before, "nothing is allocated while it runs",
        static_cast<double>(allocations - before));
  return failed;
}
