// A plan as text for other programs: definitions of Box2D's own joints as data, C++ source,
// and R.U.B.E. scenes.
//
// Bodies, fixtures and joints are those that build() makes in a world, number for number: floats are written
// with the digits that bring the same float back. Box2D refuses what it cannot hold (InvalidInput).
#pragma once

#include <string>

#include "ductile/calibrate.h"

namespace ductile {

/// JSON (docs/files/box2d.md): bodies with fixtures and mass, and for every joint the fields of the stock
/// definitions that stand for it, in Box2D 2.4 and in Box2D 3, each beside what it loses.
std::string box2d_text(const Plan& plan);

/// C++ source of a function `function(b2World&)` that makes the plan with ductile joints and returns their
/// Structure. It needs ductile::joint and no other room.
std::string cpp_text(const Plan& plan, const std::string& function);

/// What such a function may be called: "build_B1_1" of a scene "B1-1".
std::string function_name(const std::string& scene);

/// The stock joint that stands for one that yields in bending.
enum class StockJoint {
  hinge,  ///< revolute, its motor at speed 0 the plastic moment (hinge_def())
  weld,   ///< never gives way (weld_def())
};

/// A R.U.B.E. scene (docs/files/rube.md): welds, revolute motors and pins that any player understands, with
/// the joints' values and the loads in customProperties; load() makes ductile joints of those.
std::string rube_text(const Plan& plan, StockJoint as = StockJoint::hinge);

}  // namespace ductile
