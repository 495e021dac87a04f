// Parkes' struck cantilever, run.
#pragma once

#include <cmath>

#include "bodies.h"
#include "parkes.h"
#include "structures.h"

namespace ductile::report {

/// Parkes: a tip mass as heavy as the beam, struck with 12 m/s; rotation of the root.
struct ParkesRun {
  static constexpr double length = 20, height = 1;  // m
  static constexpr double moment = bench::Steel::fy / 4, tip = bench::Steel::density * length * height,
                          speed = 12;
  static double exact() {
    return parkes(tip, bench::Steel::density * height, length, speed, moment).root_rotation;
  }
  static double root_rotation(int n, double dt) {
    bench::Layout layout = bench::chains(1, n, false);
    layout.E = unlimited;
    layout.breaks = false;
    const int box = layout.box(length, 0, 0, 0.1, 0.1);
    layout.pieces.back().density = tip / 0.01;
    layout.weld(box - 1, box, length, 0, 0, 1);
    bench::Built b(layout, bench::Built::ours, 0);
    // Of bending alone: the rest holds, as the theory has it.
    for (b2Joint* joint : b.joints) {
      auto* j = static_cast<ElasticPlasticJoint*>(joint);
      for (const Row row : {axial, shear}) j->set_caps(row, unlimited, unlimited);
      const double cap = joint == b.joints.back() ? unlimited : moment;
      j->set_caps(rotation, cap, cap);
    }
    b.pieces.back()->SetLinearVelocity(vec(0, -speed));
    // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): steps of time
    for (double t = 0; t < 0.7; t += dt) b.step(dt);
    return std::abs(static_cast<ElasticPlasticJoint*>(b.joints[0])->plastic(rotation));
  }
};

}  // namespace ductile::report
