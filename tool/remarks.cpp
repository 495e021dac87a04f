// What one has to know of a plan beside its numbers: what is rigid, brittle, askew, loose or in other units.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "ductile/design.h"
#include "ductile/moments.h"
#include "ductile/plane.h"
#include "ductile/section.h"

namespace ductile::tool {

double ductility(const Material& material) {
  return material.youngs_modulus > 0
             ? material.fracture_strain * material.youngs_modulus / material.yield_stress
             : std::numeric_limits<double>::infinity();
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

namespace {

/// Of a body's section; without one, as of bodies without material, infinite.
double least_ductile(const BodyDef& body) {
  double least = std::numeric_limits<double>::infinity();
  if (body.profile.empty() && body.material) least = ductility(*body.material);
  for (const Region& region : body.profile) least = std::min(least, ductility(region.material));
  return least;
}

/// Whether it would bend sideways, too, under a moment in the scene's plane, which nothing in a scene does.
bool bends_sideways(const BodyDef& body) {
  if (body.profile.empty()) return false;
  const Section section(body.profile);
  const PrincipalAxes axes = section.principal_axes();
  const double I_max = section.elastic(axes.strong).I, I_min = section.elastic(axes.weak).I;
  return (I_max - I_min) * std::abs(axes.strong.x * axes.strong.y) > 1e-6 * I_max;
}

/// Bars of one piece that joints hold in several places or against turning: such a piece is rigid.
std::vector<std::string> rigid_bars(const Plan& plan) {
  std::vector<int> joints(plan.pieces.size()), pieces(plan.bodies.size());
  for (const PlannedJoint& joint : plan.joints)
    for (const int piece : {joint.a, joint.b})
      if (piece >= 0) joints[static_cast<std::size_t>(piece)] += joint.M > 0 || joint.M_reverse > 0 ? 2 : 1;
  for (const Piece& piece : plan.pieces) ++pieces[static_cast<std::size_t>(piece.body)];
  std::vector<std::string> names;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const Piece& piece = plan.pieces[i];
    if (joints[i] < 2 || pieces[static_cast<std::size_t>(piece.body)] > 1 || piece.circle > 0 ||
        !plan.is_dynamic(static_cast<int>(i)))
      continue;
    const AreaMoments m = moments(piece.outline);
    const LongAxis axis = long_axis(piece.outline, m);
    constexpr double slender = 4;  // length over mean width
    if ((axis.high - axis.low) * (axis.high - axis.low) > slender * m.area) names.push_back(piece.name);
  }
  return names;
}

/// Bodies that go on beyond a node that clamps them at one of their cuts: the piece on one side of it takes
/// the node's whole moment. At the middle of a piece there is nothing to choose.
std::vector<std::string> clamped_at_cuts(const Plan& plan) {
  std::vector<std::vector<const PlannedJoint*>> inside(plan.bodies.size());
  const auto piece_at = [&](int i) -> const Piece& { return plan.pieces[static_cast<std::size_t>(i)]; };
  for (const PlannedJoint& joint : plan.joints)
    if (plan.is_inside(joint)) inside[static_cast<std::size_t>(piece_at(joint.a).body)].push_back(&joint);
  std::vector<std::string> names;
  for (const PlannedJoint& node : plan.joints) {
    if (node.node == 0 || !(node.M > 0)) continue;
    for (const int piece : {node.a, node.b}) {
      if (piece < 0 || !plan.is_dynamic(piece)) continue;
      const auto body = static_cast<std::size_t>(piece_at(piece).body);
      const bool over_a_cut =
          std::any_of(inside[body].begin(), inside[body].end(), [&](const PlannedJoint* cut) {
            if (cut->a != piece && cut->b != piece) return false;
            const Point off = node.anchor - cut->anchor;
            const auto half = [&](int i) {
              return std::abs(dot(piece_at(i).center - cut->anchor, cut->axis));
            };
            constexpr double nearly = 0.2;  // of half of the shorter piece
            return std::abs(dot(off, cut->axis)) < nearly * std::min(half(cut->a), half(cut->b)) &&
                   std::abs(cross(off, cut->axis)) <= cut->height;
          });
      const std::string& name = plan.bodies[body].name;
      if (over_a_cut && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// A cut askew through a strip is longer than the strip is wide, and stronger than the hinge that forms
/// beside it. How wide the piece is from its middle up to halfway to the joint; 0 where it is no such strip.
double width_beside(const Plan& plan, const PlannedJoint& joint, int index) {
  if (!plan.is_dynamic(index)) return 0;
  const Piece& piece = plan.pieces[static_cast<std::size_t>(index)];
  const Point to_middle = piece.center - joint.anchor;
  // The less, the more askew. Two bodies that lie on each other are joined along them, which is no cut.
  const double across = std::abs(dot(joint.axis, unit(to_middle)));
  if (across < (plan.is_inside(joint) ? 0.2 : 0.6) || piece.circle > 0) return 0;
  const Point direction = left(unit(to_middle));
  const double width = chord(piece.outline.outer, piece.center, direction),
               nearer = chord(piece.outline.outer, joint.anchor + 0.5 * to_middle, direction);
  constexpr double alike = 0.02, like_the_cut = 0.15;
  if (length(to_middle) < width || std::abs(nearer - width) > alike * width ||
      std::abs(joint.height * across - width) > like_the_cut * width)
    return 0;
  return width;
}

/// Joints across a strip that are too long, and so too strong by their sections: names, and the worst of
/// them.
struct Askew {
  std::vector<std::string> names;
  double height = 0, width = 1;  ///< m
};
Askew cuts_askew(const Plan& plan) {
  constexpr double too_long = 1.05;  // to the width
  Askew result;
  for (const PlannedJoint& joint : plan.joints) {
    if (joint.a < 0 || !(joint.height > 0) || !joint.intervals.empty()) continue;
    for (const int piece : {joint.a, joint.b}) {
      const double width = width_beside(plan, joint, piece);
      if (width == 0 || joint.height < too_long * width) continue;
      const std::optional<Section> section = section_at(plan, joint, piece);
      const double by_section = section ? section->capacities({0, -1}).M : 0, share = width / joint.height;
      if (joint.M > by_section * (1 + 1e-6) || joint.M < too_long * share * share * by_section) continue;
      if (joint.height / width > result.height / result.width)
        result.height = joint.height, result.width = width;
      result.names.push_back(joint.name);
      break;
    }
  }
  return result;
}

/// Of numbers that no solid has in the units of scenes, and many in those of tables: what they are, and the
/// bodies of which they are.
std::map<std::string, std::vector<std::string>> other_units(const Plan& plan) {
  constexpr double least_yield_stress = 1e4, least_modulus = 1e6;  // Pa
  constexpr double strong = 1e7, least_density = 25;  // Pa, kg/m³: what is stronger than cork is heavier
  std::map<std::string, std::vector<std::string>> found;
  for (const BodyDef& body : plan.bodies) {
    if (!body.material) continue;
    const Material& m = *body.material;
    const auto look = [&](const char* key, double value, double least, const char* unit, const char* needs) {
      if (value > 0 && value < least)
        found[fmt::format("{} is {:g} {}; in {}", key, value, unit, needs)].push_back(body.name);
    };
    look("fy", m.yield_stress, least_yield_stress, "Pa", "MPa it needs 1e6");
    look("E", m.youngs_modulus, least_modulus, "Pa", "GPa it needs 1e9, in MPa 1e6");
    look("density", m.density, m.yield_stress > strong ? least_density : 0, "kg/m³",
         "g/cm³ or t/m³ it needs 1000");
  }
  return found;
}

}  // namespace

std::vector<std::string> remarks(const Plan& plan) {
  std::vector<double> heights(plan.bodies.size());  // of the highest section of a joint
  for (const PlannedJoint& joint : plan.joints)
    for (const int piece : {joint.a, joint.b}) {
      if (piece < 0 || !plan.is_dynamic(piece)) continue;
      double& height = heights[static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body)];
      height = std::max(height, joint.height);
    }
  std::vector<std::string> result, high, sideways;
  std::map<std::string, std::vector<std::string>> breaking;  // bodies, by how far they yield
  for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
    if (heights[i] == 0) continue;
    if (heights[i] > too_high) high.push_back(plan.bodies[i].name);
    if (bends_sideways(plan.bodies[i])) sideways.push_back(plan.bodies[i].name);
    if (const double strain = least_ductile(plan.bodies[i]); strain < least_ductility)
      breaking[fmt::format("{:.2g}", strain)].push_back(plan.bodies[i].name);
  }
  if (const std::vector<std::string> rigid = rigid_bars(plan); !rigid.empty())
    result.push_back(list_of(rigid) +
                     ": one piece is rigid: beyond its joints it neither bends nor yields nor buckles; "
                     "split it into several");
  if (const std::vector<std::string> clamped = clamped_at_cuts(plan); !clamped.empty())
    result.push_back(
        list_of(clamped) +
        ": a node holds it at one of its cuts, and the piece on one side takes the whole moment: "
        "elastic forces and displacements are off, the less the shorter its pieces are; split it into more");
  if (const Askew askew = cuts_askew(plan); !askew.names.empty()) {
    const double longer = askew.height / askew.width;
    result.push_back(fmt::format(
        "{}: cut askew over {:.3g} m where the body is {:.3g} m across: {:.2g} times as strong in bending as "
        "a hinge beside it, which no joint stands for; cut across the body, or give `moment`",
        list_of(askew.names), askew.height, askew.width, longer * longer));
  }
  for (const auto& [what, names] : other_units(plan)) result.push_back(list_of(names) + ": " + what);
  for (const auto& [strain, names] : breaking)
    result.push_back(fmt::format(
        "{}: breaks at {} times the yield strain, before a plastic hinge turns; design with the first fibre",
        list_of(names), strain));
  if (!sideways.empty())
    result.push_back(
        list_of(sideways) +
        ": the scene's plane is no principal one of its section; M and stiffness hold with it kept "
        "from bending sideways");
  if (!high.empty())
    result.push_back(
        fmt::format("{}: {:g} m high where it is cut: scenes are in metres; drawn in millimetres, it needs "
                    "0.001 of every coordinate, of depths, too",
                    list_of(high), *std::max_element(heights.begin(), heights.end())));
  return result;
}

std::vector<std::string> loose_names(const Plan& plan) {
  std::vector<std::string> names;
  for (const int piece : loose_pieces(plan)) names.push_back(piece_name(plan, piece));
  return names;
}

std::string loose_line(const Plan& plan) {
  const std::vector<std::string> names = loose_names(plan);
  return names.empty() ? "" : "loose, and not looked at: " + list_of(names) + '\n';
}

std::string lines(const std::vector<std::string>& remarks) {
  std::string text;
  for (const std::string& remark : remarks) text += remark + '\n';
  return text;
}

}  // namespace ductile::tool
