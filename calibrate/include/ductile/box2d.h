// A Plan in Box2D: definitions of its joints for any world, and whole worlds.
//
// Every piece becomes a body, or part of one (Piece::part_of), whose origin is its centre of mass and whose
// angle is 0 at first, so that a joint's local anchors are its anchor less the centres (those of a level are
// where the level has them). Numbers that Box2D
// takes as floats are checked: one that overflows a float or vanishes in it is refused (InvalidInput), never
// inf or 0.
#pragma once

#include <box2d/box2d.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/joint.h"

namespace ductile {

/// The same in Box2D's floats, m.
inline b2Vec2 to_box2d(Point p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

// --- definitions; bodyA and bodyB are the caller's to set ---

/// All that the plan knows of the joint; with Plan::interaction, its N–M polygon too.
ElasticPlasticJointDef elastic_plastic_def(const Plan& plan, const PlannedJoint& joint);

/// How fast and where to the joint's drive goes `time` seconds after the start; before its `from` it holds. A
/// definition has it at full speed.
Drive drive_at(const PlannedJoint& joint, double time);

/// A stock weld: rigid, or with the joint's bending stiffness and damping.
b2WeldJointDef weld_def(const Plan& plan, const PlannedJoint& joint);

/// A plastic hinge without any of our code at run time: a stock revolute joint whose motor, at speed 0, gives
/// way at the joint's plastic moment (the smaller of both senses).
b2RevoluteJointDef hinge_def(const Plan& plan, const PlannedJoint& joint);

/// The stock joints that stand for planned ones.
using StockJointDef = std::variant<b2WeldJointDef, b2RevoluteJointDef, b2PrismaticJointDef, b2WheelJointDef,
                                   b2MotorJointDef, b2DistanceJointDef>;

/// The stock joint that leaves free what is free in the joint's rows: a revolute, prismatic or motor joint,
/// or a wheel joint without a spring (a point on a line). A line is a distance joint: a rope one of a
/// greatest length, a strut of a least one. A driven pin's motor runs from the start. Where no row is free,
/// weld_def(). Nothing where all are.
std::optional<StockJointDef> stock_def(const Plan& plan, const PlannedJoint& joint);

/// What of the plan stock_def() or hinge_def() does not do, in plain words; empty where nothing is lost.
std::vector<std::string> lost_in_stock(const PlannedJoint& joint);
std::vector<std::string> lost_in_hinge(const PlannedJoint& joint);

/// The N–M polygon of a joint, counter-clockwise from its section's exact curve within `tolerance` of its
/// extent: of both sides where two bodies meet, stretched and cut to overridden caps. Empty where a cap is
/// unlimited or 0, or no section is known.
std::vector<AxialMoment> interaction_of(const Plan& plan, const PlannedJoint& joint, double tolerance = 1e-3);

/// The hull of the points as a fixture that Box2D takes: without vertices that it would weld, or that stand
/// out less than its floats tell. None where that is thinner than b2_linearSlop or has more than 8 vertices.
std::optional<b2PolygonShape> polygon_shape(const std::vector<Point>& points);

/// The fixtures of a piece that is not a disc, about its centre. Parts too thin for Box2D to collide (below
/// b2_linearSlop) are left out, which costs nothing: mass comes from the outline. A piece thinner than
/// 4 b2_linearSlop = 0.02 m in all is refused (InvalidInput).
std::vector<b2PolygonShape> shapes(const Piece& piece);

// --- worlds ---

/// Where a body was when it was made.
struct BodyPlace {
  b2Vec2 origin{0, 0};  ///< m
  float angle = 0;      ///< rad
};

/// What a plan became in a world, which owns it all.
struct Built {
  std::vector<b2Body*> bodies;   ///< by Plan::pieces; the same for pieces of one rigid body
  b2Body* ground = nullptr;      ///< static, holds the supports; null where there are none
  std::vector<b2Joint*> joints;  ///< by Plan::joints
  std::vector<b2WheelJoint*> wheels;
  std::vector<BodyPlace> places;  ///< of `bodies` at t = 0
};

/// A point of the plan, m, world axes at t = 0, in the coordinates of the body of a piece.
b2Vec2 local_point(const Built& built, int piece, Point at);

/// Bodies with exact mass, fixtures and wheels, without the plan's joints. Pieces of one body do not collide
/// with each other: a split body without a collision group of its own gets a negative one that is new in the
/// world.
Built build_bodies(b2World& world, const Plan& plan);

/// The plan with ductile joints. Keep the structure beside the world, and call its update() after each Step.
Structure build(b2World& world, const Plan& plan, const StructureDef& def = {}, Built* built = nullptr);

/// The same into the world's structure, beside what is there: one for all that is built in a world
/// (Structure::of). Throws std::invalid_argument, and builds nothing, where the structure is another world's.
Built build(Structure& structure, b2World& world, const Plan& plan);

/// The plan with stock joints that never give way: welds (with the joints' bending stiffness and damping
/// unless `all_rigid`), and where a row is free the revolute, prismatic, wheel or motor joint that leaves it
/// free.
Built build_stock(b2World& world, const Plan& plan, bool all_rigid = false);

/// A load as it is at a moment, or in the mean of a step.
struct AppliedLoad {
  b2Body* body;
  b2Vec2 at, force;  ///< m, N: world axes
  float moment;      ///< N m
};

/// Sets the world's gravity and puts the plan's loads on, as they are `time` seconds after the start or, in
/// the mean, from then on for `dt` seconds, so that a load that comes and goes within steps gives its whole
/// impulse; returns those that are not zero. Call before each Step.
std::vector<AppliedLoad> apply_loads(b2World& world, const Plan& plan, const Built& built, double time,
                                     double dt = 0);

/// Sets the plan's drives to drive_at(). Call before each Step; a joint that is gone must be null in
/// `built.joints` by then, as a destruction listener learns.
void apply_drives(const Plan& plan, const Built& built, double time);

}  // namespace ductile
