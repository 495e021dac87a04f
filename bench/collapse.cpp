// What the worst step costs: frames lose the columns of their ground floor and come down, 5 s at 60 Hz, 8/3
// iterations. Beside it the same frame of stock welds that are cut where a reaction exceeds what our joint
// yields at. Times are of one core; those of joints and contacts (b2Profile's solving, and Structure::update)
// apart from what Box2D does besides (collision, continuous collision).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ratio.h"
#include "structures.h"

namespace ductile::bench {
namespace {

constexpr double g = 10;

// Stock welds know no strength: they are cut by hand.
int cut_overloaded(b2World& world) {
  const double N = 0.1 * Steel::fy, M = 0.1 * N / 4;
  int cut = 0;
  for (b2Joint* joint = world.GetJointList(); joint != nullptr;) {
    b2Joint* next = joint->GetNext();
    if (joint->GetReactionForce(60).Length() > N || std::abs(joint->GetReactionTorque(60)) > M) {
      world.DestroyJoint(joint);
      ++cut;
    }
    joint = next;
  }
  return cut;
}

struct Times {
  std::vector<double> joints, rest;
  double share(double part) const {
    std::vector<double> sorted = joints;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::min(sorted.size() - 1,
                           static_cast<std::size_t>(part * static_cast<double>(sorted.size())))];
  }
};

Times come_down(Built& b, int steps, int& broken) {
  Times times;
  for (int i = 0; i < steps; ++i) {
    const std::size_t before = b.structure ? b.structure->joints().size() : 0;
    const double whole = seconds([&] { b.step(); });
    const b2Profile& p = b.world.GetProfile();
    const double elsewhere = 1e-3 * (p.step - p.solveInit - p.solveVelocity - p.solvePosition);
    times.joints.push_back(whole - elsewhere);
    times.rest.push_back(elsewhere);
    broken += b.structure ? static_cast<int>(before - b.structure->joints().size()) : cut_overloaded(b.world);
  }
  return times;
}

void collapse(benchmark::State& state, int storeys, int bays, int steps) {
  const Layout layout = heavy_frame(storeys, bays, 30);
  for (auto _ : state) {
    Built ours(layout, Built::ours, g), stock(layout, Built::stock, g);
    ours.run(0.5);
    ours.sum = {};
    take_ground_floor(ours, layout);
    take_ground_floor(stock, layout);
    int broken = 0, cut = 0;
    const Times mine = come_down(ours, steps, broken), theirs = come_down(stock, steps, cut);
    state.SetIterationTime(mine.share(1));
    state.counters["worst_us"] = 1e6 * mine.share(1);
    state.counters["p99_us"] = 1e6 * mine.share(0.99);
    state.counters["median_us"] = 1e6 * mine.share(0.5);
    state.counters["box2d_worst_us"] = 1e6 * *std::max_element(mine.rest.begin(), mine.rest.end());
    state.counters["stock_worst_us"] = 1e6 * theirs.share(1);
    state.counters["stock_p99_us"] = 1e6 * theirs.share(0.99);
    state.counters["vs_stock_p99"] = mine.share(0.99) / theirs.share(0.99);
    state.counters["joints"] = static_cast<double>(layout.welds.size());
    state.counters["broken"] = broken;
    state.counters["stock_cut"] = cut;
    state.counters["factorisations"] = static_cast<double>(ours.sum.factorisations) / steps;
    state.counters["bounds_hit"] = ours.sum.bounds_hit;
  }
}

// A step of a frame of 10,000 joints before which something is done to every 97th joint, one in each step,
// beside a step before which nothing is.
template <class Change>
void beside_quiet(benchmark::State& state, const Change& change) {
  Built b(frame(25, 44), Built::ours, g);
  b.run(0.5);
  std::size_t next = 0;
  const auto quiet = [&] { return seconds([&] { b.step(); }); };
  alternate(
      state, "quiet",
      [&] {
        return seconds([&] {
          change(b, next += 97);
          b.step();
        });
      },
      quiet);
}

// The frame stays in one piece.
void removal(benchmark::State& state) {
  beside_quiet(state, [](Built& b, std::size_t joint) { b.world.DestroyJoint(b.joints[joint]); });
}

// The pieces of the new joint are joined already, or some pieces apart, so that the pattern of H grows.
void addition(benchmark::State& state, std::size_t apart) {
  beside_quiet(state, [apart](Built& b, std::size_t joint) {
    b2Joint& at = *b.joints[joint];
    ElasticPlasticJointDef def;
    def.Initialize(at.GetBodyA(), b.joints[joint + apart]->GetBodyB(), at.GetAnchorA(), {1, 0});
    def.rows[axial].stiffness = def.rows[shear].stiffness = 1e5;
    def.rows[rotation] = RowDef::free();
    b.structure->create_joint(def);
  });
}

const bool registered = [] {
  struct Frame {
    const char* name;
    int storeys, bays, steps;
  };
  for (const Frame& f : {Frame{"160", 4, 4, 300}, Frame{"2000", 15, 15, 300}, Frame{"10000", 25, 44, 90}}) {
    benchmark::RegisterBenchmark(
        ("joint/collapse/frame/" + std::string(f.name)).c_str(),
        [f](benchmark::State& state) { collapse(state, f.storeys, f.bays, f.steps); })
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMicrosecond);
  }
  for (const std::size_t apart : {0U, 5U}) {
    benchmark::RegisterBenchmark(
        apart == 0 ? "joint/addition/frame/10000" : "joint/addition/frame/10000/apart",
        [apart](benchmark::State& state) { addition(state, apart); })
        ->UseManualTime()
        ->Iterations(20)
        ->Unit(benchmark::kMicrosecond);
  }
  benchmark::RegisterBenchmark("joint/removal/frame/10000", removal)
      ->UseManualTime()
      ->Iterations(50)
      ->Unit(benchmark::kMicrosecond);
  return true;
}();

}  // namespace
}  // namespace ductile::bench
