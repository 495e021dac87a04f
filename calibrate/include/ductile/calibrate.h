// From drawn bodies to joints: split outlines, take every joint's limits from its section, build Box2D
// worlds.
//
// A SceneDef is what a user draws and writes (docs/scene.schema.json describes the same as a file);
// calibrate() turns it into a Plan, numbers that any engine could use; build() turns a Plan into bodies,
// fixtures and joints of a b2World (ductile/box2d.h), which this header names in Plan::make alone. SI units,
// y up.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ductile/joint_law.h"
#include "ductile/section.h"

class b2World;

namespace ductile {

class Structure;

enum class BodyType { static_body, dynamic_body, kinematic_body };

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // a way to be elastic, and the stiffness of that name
#endif
/// How a row of a joint behaves below its cap.
enum class Elasticity {
  true_stiffness,  ///< EA/ℓ, κGA/ℓ, EI/ℓ of the material and section (rigid where E is not known)
  rigid,           ///< as stiff as the step can integrate
  /// From a frequency and damping ratio of the two bodies as they turn about their centres of mass, as
  /// b2AngularStiffness. About the joint they turn more slowly: a uniform arm on a wall at half of it.
  frequency,
  elastic_rotation,  ///< k = cap/θ; with a frequency: cap = k·θ
};
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

/// What a user says of joints instead of leaving it to section and material; unset fields are not overridden.
struct JointOverrides {
  std::optional<double> moment{}, moment_reverse{};    ///< N m; unlimited, or 0 for a free row
  std::optional<double> axial{}, axial_compression{};  ///< N; likewise
  std::optional<double> shear{};                       ///< N; likewise
  /// k of each row, N/m, N/m, N m/rad; unlimited: as stiff as the step can integrate. They go before
  /// `elastic`.
  std::optional<double> stiffness_axial{}, stiffness_shear{}, stiffness_moment{};
  std::optional<Elasticity> elastic{};
  double frequency = 0;  ///< Hz, with `elastic`
  /// ζ: with `frequency`, of a vibration of that frequency; otherwise of the structure's lowest elastic mode.
  std::optional<double> damping_ratio{};
  double elastic_rotation = 0;           ///< rad, with `elastic`
  std::optional<double> max_rotation{};  ///< rad, accumulated; unlimited: never breaks by it
  /// m, accumulated; likewise. By default ε_f L_p; the hinge's length, or that of the material that the joint
  /// stands for if it is less, for then nothing is left of it; the cut's height, for then its faces have
  /// passed each other.
  std::optional<double> max_elongation{}, max_compression{}, max_slip{};
  std::optional<double> hinge_length{};  ///< L_p, m; default: the section's height
  /// m, from the joint to where the moment is 0, instead of `hinge_length`: the hinge is as long as hardening
  /// makes it. A moment that falls linearly from M_u = (f_u/f_y) M_p to 0 over the shear span is above M_p in
  /// L_p = span · (1 − f_y/f_u), by similar triangles. A hinge within a span: the sum of both sides'. The
  /// strain is taken as ε_f in all of it, as in any hinge length; were hardening linear, its mean would be
  /// half.
  std::optional<double> shear_span{};
  /// One joint, of the section that they make together, where two pieces touch along several intervals in
  /// line (a cut across a hole); default: one each.
  std::optional<bool> combine{};
  std::optional<bool> hold{};  ///< keep the joint as it is where others are left out
};

/// A body as drawn, before it is split.
struct BodyDef {
  std::string name = "body";  ///< unique in its scene, without `/ # -`, not "ground"
  BodyType type = BodyType::dynamic_body;
  Outline outline{};  ///< m
  double circle = 0;  ///< m: a disc of this radius about the origin instead of an outline; not split
  std::optional<Material> material{};  ///< required for dynamic bodies
  double depth = 1;                    ///< m, out of plane
  /// Instead of depth: the section that the strip is extruded from, x out of plane, y across the strip, its
  /// centroid at the cut's middle; its height fits each cut within 1 %.
  std::vector<Region> profile{};
  /// What `profile` is called in rolled.h, if it has a name: its A_v is that of EN 1993-1-1, not of its
  /// outline.
  std::string profile_name{};
  int pieces = 1;  ///< equal parts along `along`, at most `most_pieces`; 1: not split
  static constexpr int most_pieces = 10'000;
  std::array<Point, 2> along{};  ///< the line that `pieces` divides; both equal: the outline's long axis. As
                                 ///< `cuts`, in the outline's own coordinates
  /// Explicit cuts instead: segments that leave the outline at both ends.
  std::vector<std::array<Point, 2>> cuts{};
  bool automatic = false;           ///< split: number and place of the cuts from SceneDef::target_error
  JointOverrides joint{};           ///< for the joints inside this body
  Point at{};                       ///< m: where the outline's origin is placed
  double angle = 0;                 ///< rad
  Point velocity{};                 ///< m/s
  double angular_velocity = 0;      ///< rad/s
  std::vector<Point> velocities{};  ///< m/s: of each piece, instead of velocity and angular_velocity
  std::int16_t group = 0;           ///< collision filter group, as Box2D
  bool collides = true;             ///< false: nothing touches it, and it may be thinner than Box2D collides
  double price = 0;                 ///< of a kg of it as built in, in whatever currency; 0: not known
  /// Bodies of the same one are chosen and moved together in the window; empty: alone.
  std::string assembly{};
};

/// A motor, winch or hydraulic jack: moves a row of a joint, with at most its cap. Beyond that it slips,
/// which is no damage.
struct DriveDef {
  Row row = rotation;  ///< axial or rotation
  /// Where it stops: length of a line, else distance (m) or turn (rad) of the second body from how it was
  /// drawn; unset: it goes on and on.
  std::optional<double> position{};
  /// m/s or rad/s: > 0 lengthens, or turns the second body counter-clockwise; with a position its sign says
  /// nothing. 0: holds. Unset: it gets to its position evenly in `ramp`, or as fast as its cap lets it.
  std::optional<double> speed{};
  double cap = unlimited;     ///< N or N m
  double from = 0, ramp = 0;  ///< s: holds before `from`; its speed grows linearly over `ramp`
};

/// Which axial forces a line carries.
enum class Carries { both, tension, compression };

/// Two bodies joined wherever their edges overlap; across a segment; at a point, two or more, whether or not
/// they meet there; or by a line from a point of one to a point of the other.
struct JointBetweenDef {
  std::string a{}, b{};  ///< names of bodies
  double gap = 0;        ///< m between edges that still count as touching; 0: 1e-6 of the smaller body's size
  JointOverrides overrides{};
  /// m, world axes at t = 0: a node, each body's nearest piece joined to a's there. A pin, rigid, that
  /// nothing limits but its own overrides; `moment` or `stiffness_moment` makes it resist turning.
  std::optional<Point> at{};
  std::vector<std::string> others{};  ///< further bodies of a node
  /// Of a node: not a pin, but as strong as the sections that end there. Each of its joints has the moments
  /// and the `max_rotation` of the weaker body's own joint next to the node; a body that goes on beyond it,
  /// or is one piece, does not govern.
  bool welded = false;
  /// m, world axes at t = 0: the joint's section instead of common edges, between the pieces nearest to its
  /// middle, which is the joint's anchor. Two bodies may have several such joints.
  std::optional<std::array<Point, 2>> across{};
  /// m, world axes at t = 0: a rope, strut, winch or jack, from a point of a's nearest piece to one of b's.
  /// Turns freely at both; rigid, and limited by its overrides alone.
  std::optional<std::array<Point, 2>> line{};
  /// Of a line; one that is not `both` and has no `line` is between the bodies' centres of mass.
  Carries carries = Carries::both;
  std::optional<double> length{};   ///< m: of a line without force; unset: as drawn
  std::optional<DriveDef> drive{};  ///< the row's cap is then that of the drive

  bool is_line() const { return line || carries != Carries::both; }
  /// All that it joins, a first.
  std::vector<std::string> bodies() const {
    std::vector<std::string> all{a, b};
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }
};

/// Holds the piece under a point to the ground, in world axes: rows fixed, sprung, or free. Fixed and sprung
/// rows may have their ground moved, as where a footing settles or a jack pushes.
struct SupportDef {
  std::string body{};
  Point at{};  ///< m, world axes at t = 0
  bool fix_x = false, fix_y = false, fix_angle = false;
  double stiffness_x = 0, stiffness_y = 0, stiffness_angle = 0;  ///< N/m, N m/rad: of a spring; 0: none
  std::array<double, 3> displacement{};  ///< x, y, angle, m and rad: how far the ground moves; 0 in free rows
  double ramp = 0;                       ///< s over which it moves there evenly, from the start on
};

/// A force and moment that ride with the piece under a point, in world axes.
struct LoadDef {
  std::string body{};
  Point at{};                                 ///< m, world axes at t = 0
  Point force{};                              ///< N
  double moment = 0;                          ///< N m
  double from = 0, ramp = 0, to = unlimited;  ///< s: grows linearly over `ramp` after `from`, zero after `to`
};

/// A stock b2WheelJoint: a wheel body carried by a chassis body at a point, sprung along an axis of the
/// chassis.
struct WheelDef {
  std::string chassis{}, wheel{};             ///< names of bodies
  Point at{};                                 ///< m, world axes at t = 0
  Point axis{0, 1};                           ///< of any length above 0, world axes at t = 0
  double frequency = 4, damping_ratio = 0.7;  ///< of the spring, Hz
  double motor_speed = 0;                     ///< rad/s
  double motor_torque = 0;                    ///< N m
};

struct SceneDef {
  Point gravity{0, -9.81};  ///< m/s²
  double gravity_ramp = 0;  ///< s over which gravity grows linearly
  bool sleep = false;       ///< may Box2D put bodies to sleep
  /// N–M–Q yield surface instead of independent caps: safer, and dearer where joints flow.
  bool interaction = false;
  JointOverrides joint{};      ///< for all joints
  double target_error = 0.01;  ///< relative displacement error that automatic splits may bring, in (0, 1)
  std::vector<BodyDef> bodies{};
  std::vector<JointBetweenDef> joints{};
  std::vector<SupportDef> supports{};
  std::vector<LoadDef> loads{};
  std::vector<WheelDef> wheels{};
};

/// One rigid part of a split body (or the whole of an unsplit one).
struct Piece {
  std::string name;    ///< "beam/0"; "wall" when not split
  int body = 0;        ///< index into Plan::bodies
  double mass = 0;     ///< kg, from the outline, not from the fixtures; 0 unless dynamic
  double inertia = 0;  ///< kg m², about `center`
  Point center;        ///< m, centre of mass, world axes at t = 0
  Outline outline;     ///< m, world axes at t = 0; empty for a disc
  double circle = 0;   ///< m, radius of a disc
  /// The piece whose rigid body this one is part of, an index into Plan::pieces below its own; −1: it has one
  /// of its own.
  /// Mass, inertia and centre of the body are then that piece's, which is part of none itself.
  int part_of = -1;
  bool stands_still = false;  ///< though its body is dynamic: merged with the ground or a static body
};

/// How a piece moves, small against the structure, or to a scale.
struct Motion {
  Point along;      ///< of its centre of mass, m
  double turn = 0;  ///< rad
};

/// A joint to be: everything a Box2D definition, a limit analysis or a drawing needs of it. Positive N is
/// tension; positive M turns b counter-clockwise against a and puts the right of the axis in tension.
struct PlannedJoint {
  std::string name;                                   ///< "beam/0-beam/1", "wall-beam/0", "support/0"
  int a = -1, b = -1;                                 ///< indices into Plan::pieces; −1: the ground
  Point anchor;                                       ///< m, world axes at t = 0
  Point axis;                                         ///< unit, from a to b
  double N = 0, Nc = 0, Q = 0, M = 0, M_reverse = 0;  ///< caps, N and N m; unlimited, or 0 for a free row
  struct Stiffness {
    double N = 0, Q = 0, M = 0;  ///< N/m, N/m, N m/rad; unlimited: rigid
    double operator[](Row row) const { return row == axial ? N : row == shear ? Q : M; }
  } stiffness;
  double damping_ratio = 0;  ///< ζ of a vibration at `damping_frequency`
  /// Hz: the lowest natural frequency of the joint's structure, as designed, or the frequency that the user
  /// gave the joint; a vibration of another frequency f' is damped by ζ f'/f. 0: of each row by itself.
  double damping_frequency = 0;
  double max_rotation = unlimited;    ///< rad, accumulated plastic
  double max_elongation = unlimited;  ///< m, likewise
  double max_compression = unlimited, max_slip = unlimited;
  double hinge_length = 0;      ///< m
  std::optional<RateLaw> rate;  ///< where its materials depend on the rate of strain
  double height = 0;            ///< m, length of the interval along which the pieces touch; 0 for supports
  /// Of a joint that is several intervals: from and to, m to the left of the axis, from the anchor, which is
  /// their centroid. Empty where there is one; `height` is from the first's start to the last's end.
  std::vector<std::array<double, 2>> intervals;
  /// Of a's half and of b's, to the cut's: not 1 where a piece is not as high up to its middle as the cut.
  struct Mean {
    double EA = 1, EI = 1;  ///< on the mean of their flexibility
  };
  std::array<Mean, 2> mean;
  int governed_by = -1;                  ///< index into Plan::reasons
  bool hold = false;                     ///< JointOverrides::hold
  std::array<double, 3> displacement{};  ///< SupportDef::displacement, by rows
  double ramp = 0;                       ///< s, SupportDef::ramp
  int node = 0;                          ///< ≠ 0: of one node, whose bodies hold together where body a goes
  std::optional<Point>
      end;            ///< m, world axes at t = 0: of a line, which goes from `anchor` on a to here on b
  double length = 0;  ///< m: of a line without force
  Carries carries = Carries::both;
  std::optional<DriveDef> drive;

  /// Where the joint is fixed to b.
  Point far_anchor() const { return end.value_or(anchor); }
  /// Whether it is a support whose ground moves.
  bool ground_moves() const { return displacement != std::array<double, 3>{}; }
  /// c = 2ζk/ω = ζk/(πf) of an elastic row, N s/m or N m s, f the `damping_frequency`: all rows of a
  /// structure in proportion to their stiffness, so that a mode of ω' has ζω'/ω. 0 where the row is rigid or
  /// f is 0.
  double damping(Row row) const;
};

/// What an automatic split came to.
struct SplitError {
  int body = 0;             ///< index into Plan::bodies
  double error = 0;         ///< estimated relative displacement error under the body's own weight
  std::string governed_by;  ///< "target error", or what kept it from being reached
};

/// What was left out of a plan, with the error it brings and the time it saves.
struct LeftOut {
  std::string what;
  double error = 0;       ///< relative displacement error that it brings, at most
  double measured = 0;    ///< the same, as a run with and without it has shown
  double time_saved = 0;  ///< share of the step's time, from the same run
};

struct Built;

/// Calibrated pieces and joints.
struct Plan {
  Point gravity;
  double gravity_ramp = 0;
  bool sleep = false, interaction = false;
  std::vector<BodyDef> bodies;           ///< as given
  std::vector<Piece> pieces;             ///< in the order of the bodies, then along the split
  std::vector<PlannedJoint> joints;      ///< inside bodies, between bodies, supports
  std::vector<SplitError> split_errors;  ///< of the bodies that are split automatically
  std::vector<std::string> reasons;  ///< which input set each value: "N, Nc, Q: section of beam; M: joint; …"
  struct Load {
    int piece = 0;
    Point at;  ///< m, world axes at t = 0
    LoadDef def;
  };
  std::vector<Load> loads;
  struct Wheel {
    int chassis = 0, wheel = 0;  ///< pieces
    WheelDef def;
  };
  std::vector<Wheel> wheels;
  std::vector<LeftOut> left_out;
  /// Whether a support's ground moves.
  bool settles() const {
    for (const PlannedJoint& j : joints)
      if (j.ground_moves()) return true;
    return false;
  }
  /// Whether forces may depend on which lines are slack, or on how far drives have got.
  bool has_lines_or_drives() const {
    for (const PlannedJoint& j : joints)
      if (j.carries != Carries::both || j.drive) return true;
    return false;
  }
  /// Makes the plan in a world, where a level says more of its bodies than pieces do and has more than a plan
  /// holds (ductile/level.h); its joints in the structure, or as stock joints where that is null. Empty:
  /// build() makes the pieces as they are.
  std::function<Built(b2World&, const Plan&, Structure*)> make;

  /// The piece that stands for the rigid body of a piece: itself unless it is part of another.
  const Piece& carrier(int piece) const {
    const Piece& p = pieces[static_cast<std::size_t>(piece)];
    return p.part_of < 0 ? p : pieces[static_cast<std::size_t>(p.part_of)];
  }
  /// Whether a joint is one of a split body's own.
  bool is_inside(const PlannedJoint& joint) const {
    return joint.a >= 0 &&
           pieces[static_cast<std::size_t>(joint.a)].body == pieces[static_cast<std::size_t>(joint.b)].body;
  }
  bool is_dynamic(int piece) const {
    const Piece& p = pieces[static_cast<std::size_t>(piece)];
    return !p.stands_still && bodies[static_cast<std::size_t>(p.body)].type == BodyType::dynamic_body;
  }
};

/// A convex polygon of at most 8 vertices, counter-clockwise, relative to its piece's centre.
using Convex = std::vector<Point>;

/// Convex polygons, as physics engines want them, that cover the outline of a piece exactly and use no
/// vertices but its own. None for a disc.
std::vector<Convex> convex_parts(const Piece& piece);

/// The section of a joint on the side of `piece` (PlannedJoint::a or b), for N–M curves and drawings: x out
/// of the scene's plane, y to the left of the joint's axis, the anchor at the origin, so that the joint's M
/// is the section's about d = right of the axis = (0, −1), with the reference line at 0. None for the ground
/// and for a body without material.
std::optional<Section> section_at(const Plan& plan, const PlannedJoint& joint, int piece);

/// Splits, joins and calibrates. Throws InvalidInput with every problem found (`place` names body and
/// vertex).
Plan calibrate(const SceneDef& scene);

/// One body alone, with no gravity of its own: the level-load call for a program that has outlines in memory.
Plan calibrate(const BodyDef& body);

}  // namespace ductile
