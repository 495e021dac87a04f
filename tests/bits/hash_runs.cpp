// A hash of 600 steps of every scene under each solver of ours: all that pieces and joints tell of themselves
// after each step. One line per scene and solver, for tests/bits/compare.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

#include "ductile/files.h"
#include "ductile/scene_list.h"
#include "ductile/simulation.h"

namespace ductile {
namespace {

std::uint64_t hash_of(const Plan& plan, JointSolver solver) {
  Simulation run(plan, solver);
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  const auto add = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3; };
  for (int step = 0; step < 600; ++step) {
    run.step();
    for (std::size_t i = 0; i < run.plan().pieces.size(); ++i) {
      const PieceReading p = run.piece(i);
      for (const double x : {p.position.x, p.position.y, p.angle, p.velocity.x, p.velocity.y}) add(x);
    }
    for (std::size_t i = 0; i < run.plan().joints.size(); ++i) {
      const JointReading j = run.joint(i);
      for (const double x : {j.N, j.Q, j.M, j.accumulated_rotation, j.dissipated}) add(x);
    }
  }
  return hash;
}

}  // namespace
}  // namespace ductile

int main() {
  using namespace ductile;
  for (const SceneEntry& scene : scene_list) {
    const auto file = std::string(DUCTILE_SOURCE_DIR "/scenes/") + std::string(scene.name) + ".scene.json";
    const Plan plan = calibrate(read_scene(file));
    for (const auto& [name, solver] :
         {std::pair{"direct", JointSolver::direct}, std::pair{"iterative", JointSolver::iterative}}) {
      std::printf("%s %s %016llx\n", std::string(scene.name).c_str(), name,
                  static_cast<unsigned long long>(hash_of(plan, solver)));
    }
  }
}
