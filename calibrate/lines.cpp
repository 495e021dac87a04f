#include "lines.h"

#include <utility>

#include "ductile/plane.h"

namespace ductile::calibration {
namespace {

bool limits(const JointOverrides& o, Row row) {
  return row == axial ? o.axial || o.axial_compression : o.moment || o.moment_reverse;
}

}  // namespace

void check_line(const JointBetweenDef& def, const std::string& place, std::vector<Problem>& problems) {
  const auto add = [&](std::string what, std::string remedy) {
    problems.push_back({place, std::move(what), std::move(remedy)});
  };
  const JointOverrides& o = def.overrides;
  if (def.is_line()) {
    if (def.at) add("is a line at one point", "give two, `at: [[x, y], [x, y]]`: one on each body");
    if (def.across) add("is a line across a section", "leave out `across`, or `kind` and the line's ends");
    if (!def.others.empty()) add("is a line of more than two bodies", "give each two a line of their own");
    if (def.gap > 0 || o.elastic || o.hinge_length || o.shear_span || o.moment || o.moment_reverse ||
        o.shear || o.stiffness_moment || o.stiffness_shear || o.max_rotation || o.max_slip)
      add("is a line, and has what only bends or shears",
          "keep to axial, axial_compression, stiffness_axial, max_elongation and max_compression");
    if (def.carries == Carries::tension && o.axial_compression)
      add("is a rope with a cap in compression", "leave out `axial_compression`: a rope goes slack");
    if (def.line && (*def.line)[0] == (*def.line)[1])
      add("is a line of no length", "give two different points");
  } else if (def.length) {
    add("has a length, and is no line", "give its ends, `at: [[x, y], [x, y]]`, or leave the length out");
  }
  if (!def.drive) return;
  const DriveDef& d = *def.drive;
  if (d.row == shear) add("drives its shear row", "drive \"axial\" or \"rotation\"");
  if (def.is_line() && d.row != axial)
    add("drives the rotation of a line, which turns freely", "drive its \"axial\" row");
  if (!def.others.empty()) add("drives a node of more than two bodies", "drive two of them by a joint");
  if (!d.position && !d.speed)
    add("has a drive without a goal", "give it a `speed` (0 holds), a `position`, or both");
  if (d.position && d.speed == 0.0)
    add("has a drive to a position at speed 0", "give a speed, or leave it out");
  if (def.is_line() && d.position && !(*d.position > 0))
    add("winds a line in to a length of " + to_string(*d.position), "stop at a length > 0");
  if (limits(o, d.row) || (def.welded && d.row == rotation))
    add("has a cap beside that of its drive", "leave one of them out: give the drive's `cap` alone");
}

PlannedJoint line_between(const JointBetweenDef& def, const Piece& a, const Piece& b, Point from, Point to,
                          double damping_ratio) {
  const JointOverrides& own = def.overrides;
  PlannedJoint joint;
  joint.name = a.name + '-' + b.name;
  joint.anchor = from;
  joint.end = to;
  joint.axis = unit(to - from);
  joint.length = def.length.value_or(length(to - from));
  joint.carries = def.carries;
  joint.N = own.axial.value_or(unlimited);
  joint.Nc = own.axial_compression.value_or(joint.N);
  if (def.carries == Carries::tension) joint.Nc = 0;
  if (def.carries == Carries::compression) joint.N = 0;
  joint.stiffness = {own.stiffness_axial.value_or(unlimited), unlimited, unlimited};
  joint.damping_ratio = own.damping_ratio.value_or(damping_ratio);
  joint.max_elongation = own.max_elongation.value_or(unlimited);
  joint.max_compression = own.max_compression.value_or(unlimited);
  joint.hold = own.hold.value_or(false);
  return joint;
}

void put_drive(PlannedJoint& joint, const DriveDef& drive) {
  joint.drive = drive;
  if (drive.row == rotation) {
    joint.M = joint.M_reverse = drive.cap;
    return;
  }
  if (joint.carries != Carries::compression) joint.N = drive.cap;
  if (joint.carries != Carries::tension) joint.Nc = drive.cap;
}

}  // namespace ductile::calibration
