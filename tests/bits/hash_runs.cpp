// A hash of 600 steps of every scene: all that pieces and joints tell of themselves after each step.
#include <bit>
#include <cstdint>
#include <cstdio>

#include "ductile/files.h"
#include "ductile/scene_list.h"
#include "ductile/simulation.h"

int main() {
  using namespace ductile;
  for (const SceneEntry& scene : scene_list) {
    const auto file = std::string(DUCTILE_SOURCE_DIR "/scenes/") + std::string(scene.name) + ".scene.json";
    Simulation run(calibrate(read_scene(file)), JointSolver::direct, {.dt = 1 / scene.hz});
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
    std::printf("%s %016llx\n", std::string(scene.name).c_str(), static_cast<unsigned long long>(hash));
  }
}
