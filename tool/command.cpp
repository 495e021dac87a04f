#include "command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "ductile/level.h"
#include "ductile/moments.h"
#include "ductile/picture.h"
#include "ductile/plane.h"
#include "ductile/rolled.h"
#include "ductile/section.h"

namespace ductile::tool {

namespace {

/// What a drawing does not say, and what of it was not taken, on stderr.
SceneDef scene_of_drawing(std::string_view text, const SceneFile& file) {
  DrawnScene drawn = drawing_scene(Drawing(text, file.name), file.metres_per_unit);
  if (drawn.scale > 0)
    fmt::print(stderr, "warning: {}: has no physical size; a unit is taken as {:.4g} m: give --scale\n",
               file.name, drawn.scale);
  if (drawn.too_thin > 0)
    fmt::print(stderr,
               "warning: {}: {} of {} bodies are thinner than the 0.02 m that Box2D collides, and touch "
               "nothing: give a "
               "larger --scale\n",
               file.name, drawn.too_thin, drawn.scene.bodies.size() - 1);
  if (drawn.heaped > 0)
    fmt::print(stderr,
               "warning: {}: {} of {} shapes lie over one another, and do not collide with each other: draw "
               "what shall carry what side by side\n",
               file.name, drawn.heaped, drawn.scene.bodies.size() - 1);
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(drawn.left_out.size(), most); ++i) {
    const Problem& problem = drawn.left_out[i];
    fmt::print(stderr, "warning: {}: {} (left out); {}\n", problem.place, problem.what, problem.remedy);
  }
  if (drawn.left_out.size() > most)
    fmt::print(stderr, "warning: {}: {} more left out\n", file.name, drawn.left_out.size() - most);
  return std::move(drawn.scene);
}

}  // namespace

void add_scale(CLI::App* command, double& metres_per_unit) {
  command
      ->add_option("--scale", metres_per_unit,
                   "metres per unit of a drawing (default: its physical size, else it is 10 m large)")
      ->check(finite(0, true));
}

void add_scene(CLI::App* command, SceneFile& scene, const char* what) {
  command->add_option("SCENE", scene.name, what)->required();
  add_scale(command, scene.metres_per_unit);
}

void check_profile(const std::string& name, const std::string& option) {
  if (!names_a_profile(name) && !std::filesystem::exists(name))
    throw InvalidInput(
        {{"command line:" + option, "'" + name + "' is no profile, series of profiles or file",
          "write a profile as in IPE 300, a tube with its size as in CHS 168.3x5, or a section file"}});
}

namespace {

void tell_of_scale(const SceneFile& file) {
  if (file.metres_per_unit > 0)
    fmt::print(stderr,
               "warning: {}: is no drawing: --scale changes nothing, all its numbers are in SI units\n",
               file.name);
}

}  // namespace

SceneDef scene_of(const SceneFile& file, const std::string& text, const Outputs& outputs) {
  if (is_drawing(text)) return scene_of_drawing(text, file);
  tell_of_scale(file);
  std::vector<std::filesystem::path> named;
  SceneDef scene = parse_scene(text, file.name, std::filesystem::path(file.name).parent_path(), &named);
  keep_inputs({named.begin(), named.end()}, outputs);
  return scene;
}

void warn_of_splits(const Plan& plan, const SceneFile& file) {
  constexpr std::size_t most = 20;  // drawings have bodies by the hundred
  std::size_t above = 0;
  for (const SplitError& split : plan.split_errors)
    if (split.governed_by != "target error" && ++above <= most)
      fmt::print(
          stderr,
          "warning: {}: '{}' is split with a displacement error of {:.2g} %, above the target error: it "
          "is governed by {}\n",
          file.name, plan.bodies[static_cast<std::size_t>(split.body)].name, 100 * split.error,
          split.governed_by);
  if (above > most)
    fmt::print(stderr, "warning: {}: {} more are split with an error above the target error\n", file.name,
               above - most);
}

Plan plan_of(const SceneFile& file, NotInPlan rest, const Outputs& outputs,
             std::optional<double> target_error) {
  const std::string& scene_file = file.name;
  const std::string text = read_text(scene_file);  // once: it may be a pipe
  if (is_rube(text)) {
    tell_of_scale(file);
    std::vector<Problem> beyond;
    Plan plan = parse_plan(text, scene_file, ".", &beyond);
    if (rest == NotInPlan::made) return plan;
    plan.make = nullptr;
    if (!beyond.empty() && rest == NotInPlan::refused) throw InvalidInput(std::move(beyond));
    for (const Problem& problem : beyond)
      fmt::print(stderr, "warning: {}: {}: statics leaves it out\n", problem.place, problem.what);
    return plan;
  }
  SceneDef scene = scene_of(file, text, outputs);
  if (target_error) scene.target_error = *target_error;
  Plan plan = in_file(scene_file, [&] { return calibrate(scene); });
  warn_of_splits(plan, file);
  return plan;
}

std::string piece_name(const Plan& plan, int piece) {
  return piece < 0 ? "ground" : plan.pieces[static_cast<std::size_t>(piece)].name;
}

std::string joint_name(const Plan& plan, int joint) {
  return plan.joints[static_cast<std::size_t>(joint)].name;
}

namespace {

struct ProfileClass {
  const BodyDef* body;
  Classes classes;
  double A_eff, N_eff;  // m², N; NaN where no rule gives them
};

std::vector<ProfileClass> profile_classes(const Plan& plan) {
  std::vector<ProfileClass> all;
  for (const BodyDef& body : plan.bodies) {
    if (body.profile_name.empty() || !is_steel(body.profile.front().material)) continue;
    const Rolled profile = rolled(body.profile_name);
    const Material& material = body.profile.front().material;
    const double A_eff = effective_area(profile, material.yield_stress);
    all.push_back(
        {&body, section_class(profile, material.yield_stress), A_eff, A_eff * material.compression()});
  }
  return all;
}

}  // namespace

bool is_steel(const Material& material) { return std::abs(material.youngs_modulus / 210e9 - 1) < 0.1; }

std::string profile_lines(const Plan& plan) {
  std::string text;
  for (const auto& [body, classes, A_eff, N_eff] : profile_classes(plan)) {
    text += fmt::format("{}: {}, class {} in compression, {} in bending (EN 1993-1-1 Table 5.2)\n",
                        body->name, body->profile_name, classes.compression, classes.bending_y);
    if (classes.compression == 4)
      text += std::isfinite(A_eff)
                  ? fmt::format(
                        "  it buckles locally at N = {:.6g} N, A_eff f_y (EN 1993-1-5 4.4), which Nc leaves "
                        "out\n",
                        -N_eff)
                  : "  it buckles locally before Nc; a shell of class 4 is for EN 1993-1-6\n";
    if (classes.bending_y > 2)
      text += fmt::format("  it buckles locally before M; its first fibre is {}\n",
                          classes.bending_y == 3 ? "what to design with" : "not reached either");
  }
  return text;
}

Json profiles_json(const Plan& plan) {
  Json list = Json::array();
  for (const auto& [body, classes, A_eff, N_eff] : profile_classes(plan))
    list.push_back({{"body", body->name},
                    {"profile", body->profile_name},
                    {"class", {{"compression", classes.compression}, {"bending", classes.bending_y}}},
                    {"A_eff", number(A_eff)}});
  return list;
}

std::string buckling_line(bool second_order, double critical_load_factor) {
  return std::string(second_order ? "second order" : "first order") +
         (critical_load_factor == 0 ? "; unstable under any multiple of the loads"
          : critical_load_factor < unlimited
              ? fmt::format("; buckles at {:.6g} times the loads", critical_load_factor)
              : "; does not buckle");
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value + 0.) : "-";
}  // no "-0"

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
    if (joint.a >= 0 && piece_at(joint.a).body == piece_at(joint.b).body)
      inside[static_cast<std::size_t>(piece_at(joint.a).body)].push_back(&joint);
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
  const bool inside = joint.a >= 0 && plan.pieces[static_cast<std::size_t>(joint.a)].body ==
                                          plan.pieces[static_cast<std::size_t>(joint.b)].body;
  // The less, the more askew. Two bodies that lie on each other are joined along them, which is no cut.
  const double across = std::abs(dot(joint.axis, unit(to_middle)));
  if (across < (inside ? 0.2 : 0.6) || piece.circle > 0) return 0;
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

std::string title_of(const std::string& scene_file) {
  // A file's name may be any bytes, a picture's title is UTF-8.
  const std::string valid = Json(scene_name(scene_file)).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string name = Json::parse(valid).get<std::string>();
  std::replace(name.begin(), name.end(), '_', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

namespace {

/// A device or a pipe is no such file: it may be named twice.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;  // what is not there is no file of this name
  if (std::filesystem::is_other(a, none)) return false;
  if (std::filesystem::equivalent(a, b, none)) return true;
  const auto whole = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file, none), none);
  };
  return !whole(a).empty() && whole(a) == whole(b);
}

/// Each option with each file that it names.
std::vector<std::pair<std::string, std::string>> single(const Outputs& outputs) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [option, files] : outputs)
    for (const std::string& file : files)
      if (!file.empty()) all.emplace_back(option, file);
  return all;
}

}  // namespace

void keep_apart(const Outputs& outputs) {
  const auto all = single(outputs);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (is_same_file(all[i].second, all[j].second))
        throw InvalidInput({{"command line:" + all[i].first,
                             "'" + all[i].second + "' is the file of " + all[j].first + ", too",
                             "give another one: one of them would be lost"}});
}

void keep_inputs(const std::vector<std::string>& inputs, const Outputs& outputs) {
  for (const auto& [option, file] : single(outputs))
    for (const std::string& input : inputs)
      if (is_same_file(input, file))
        throw InvalidInput({{"command line:" + option, "'" + file + "' is the file that is read",
                             "give another one: it would be lost"}});
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

NewFiles::NewFiles(const Outputs& outputs) {
  for (const auto& [option, file] : single(outputs)) files_.try_emplace(file, file);
}

void NewFiles::write(const std::string& file, std::string_view text) { files_.at(file).write(text); }

void NewFiles::write_pictures(const std::vector<std::string>& files, std::string_view svg) {
  for (const std::string& file : files) write(file, picture_bytes(file, svg));
}

void NewFiles::keep() {
  for (auto& [name, file] : files_) file.close();
  for (auto& [name, file] : files_) file.keep();
}

CLI::Validator file_name() {
  return CLI::Validator(
      [](const std::string& file) -> std::string { return file.empty() ? "'' names no file" : ""; }, "");
}

CLI::Option* add_picture(CLI::App* command, std::vector<std::string>& files, const std::string& what) {
  const CLI::Validator name(
      [](const std::string& file) -> std::string {
        return file.ends_with(".svg") || file.ends_with(".png") ? "" : "'" + file + "' is no .svg or .png";
      },
      "");
  return command->add_option("--picture", files, what + " to this SVG or PNG file; may be repeated")
      ->check(name)
      ->allow_extra_args(false);
}

CLI::Validator finite(double low, bool open) {
  return CLI::Validator(
      [=](const std::string& text) -> std::string {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) {
          return "'" + text + "' is no finite number";
        }
        return value < low || (open && value == low)
                   ? fmt::format("{} is not {} {:g}", text, open ? ">" : ">=", low)
                   : "";
      },
      "");
}

}  // namespace ductile::tool
