#include "wrong.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ductile/fields.h"
#include "ductile/plane.h"
#include "lines.h"

namespace ductile::calibration {
namespace {

class Check {
 public:
  std::vector<Problem> problems;

  void scene(const SceneDef& s) {
    check(fields::scene, s, "scene");
    overrides(s.joint, "scene");
    if (!(s.target_error > 0 && s.target_error < 1))
      add("scene", "the target error is " + to_string(s.target_error), "give a share between 0 and 1");
    for (const BodyDef& b : s.bodies) {
      if (!names_.insert(b.name).second)
        add(body_place(b), "the name is taken", "give every body its own name");
      body(b);
    }
    for (std::size_t i = 0; i < s.joints.size(); ++i) joint(s.joints[i], "joint " + std::to_string(i));
    for (std::size_t i = 0; i < s.supports.size(); ++i)
      support(s.supports[i], "support " + std::to_string(i));
    for (std::size_t i = 0; i < s.loads.size(); ++i) load(s.loads[i], "load " + std::to_string(i));
    for (std::size_t i = 0; i < s.wheels.size(); ++i) wheel(s.wheels[i], "wheel " + std::to_string(i));
  }

 private:
  void add(const std::string& place, std::string what, std::string remedy) {
    problems.push_back({place, std::move(what), std::move(remedy)});
  }
  // Nothing that is multiplied later may overflow or vanish; no number of a scene comes near these.
  static constexpr double most = 1e30, least = 1e-30;

  void finite(Point p, const std::string& place, const char* name) {
    if (!(std::abs(p.x) <= most && std::abs(p.y) <= most))
      add(place,
          std::string(name) +
              (std::isfinite(p.x) && std::isfinite(p.y) ? " is beyond 1e30" : " is not finite"),
          "give finite numbers up to 1e30");
  }
  void number(double value, const fields::Range& range, const std::string& place, const char* name) {
    const bool vanishes = range.low == 0 && value > 0 && value < least;
    if (value != range.null && !(range.contains(value) && std::abs(value) <= most && !vanishes))
      add(place, std::string(name) + " is " + to_string(value),
          vanishes ? "give at least 1e-30"
                   : std::string("give ") + range.words + (range.null == unlimited ? ", or unlimited" : ""));
  }

  // The fields of a table. A default is right where files may leave the field out: 0 for what is derived
  // then.
  template <class Owner, class... Fields>
  void check(const std::tuple<Fields...>& table, const Owner& owner, const std::string& place) {
    const Owner standard;
    fields::for_each(table, [&](const auto& field) {
      const auto& value = owner.*field.member;
      using T = std::remove_cvref_t<decltype(value)>;
      if constexpr (std::is_same_v<T, Point>) finite(value, place, field.key);
      if constexpr (std::is_same_v<T, double>)
        if (field.required || value != standard.*field.member) number(value, field.range, place, field.key);
      if constexpr (std::is_same_v<T, std::optional<double>>)
        if (value) number(*value, field.range, place, field.key);
    });
  }

  void known(const std::string& name, const std::string& place) {
    if (!names_.contains(name))
      add(place, "there is no body '" + name + "'", "name one of the scene's bodies");
  }

  void joint(const JointBetweenDef& j, const std::string& place) {
    const std::vector<std::string> all = j.bodies();
    for (const std::string& name : all) known(name, place);
    for (auto name = all.begin(); name != all.end(); ++name)
      if (std::find(all.begin(), name, *name) != name)
        add(place, "joins '" + *name + "' to itself", "name each body once");
    if (j.at) finite(*j.at, place, "at");
    if (!j.at && !j.is_line() && !j.others.empty())
      add(place, "joins " + std::to_string(all.size()) + " bodies where edges overlap",
          "give the node's point, `at`");
    if (j.at && (j.gap > 0 || j.overrides.elastic || j.overrides.hinge_length || j.overrides.shear_span))
      add(place, "has `gap`, `elastic` or a hinge's length beside `at`",
          "leave them out: a node is rigid, and has no section");
    if (j.welded && !j.at)
      add(place, "is `welded` and no node",
          "leave it out: where edges touch, joints have their section's strength; or give a point, `at`");
    if (j.across) {
      finite((*j.across)[0], place, "across");
      finite((*j.across)[1], place, "across");
      if ((*j.across)[0] == (*j.across)[1]) add(place, "is across no length", "give two different points");
      if (j.at) add(place, "has both `at` and `across`", "give one of them: a node has no section");
    } else if (!j.at && !j.is_line() && !joined_.insert(std::minmax<std::string_view>(j.a, j.b)).second) {
      add(place, "'" + j.a + "' and '" + j.b + "' are joined already", "leave one of the two out");
    }
    if (j.line) {
      finite((*j.line)[0], place, "at");
      finite((*j.line)[1], place, "at");
    }
    check(fields::joint, j, place);
    if (j.drive) check(fields::drive, *j.drive, place + ".drive");
    overrides(j.overrides, place);
    check_line(j, place, problems);
  }

  void support(const SupportDef& s, const std::string& place) {
    known(s.body, place);
    check(fields::support, s, place);
    check(fields::springs, s, place);
    if ((s.fix_x && s.stiffness_x > 0) || (s.fix_y && s.stiffness_y > 0) ||
        (s.fix_angle && s.stiffness_angle > 0))
      add(place, "has a spring in a row that it fixes", "leave one of them out");
    displacement(s, place);
  }

  void load(const LoadDef& l, const std::string& place) {
    known(l.body, place);
    check(fields::load, l, place);
    if (!(l.to >= l.from)) add(place, "ends before it starts", "let `to` be after `from`");
  }

  void wheel(const WheelDef& w, const std::string& place) {
    known(w.chassis, place);
    known(w.wheel, place);
    if (w.chassis == w.wheel) add(place, "carries itself", "name two bodies");
    check(fields::wheel, w, place);
    if (w.axis == Point{}) add(place, "the axis has no direction", "give it a length above 0");
  }

  void displacement(const SupportDef& s, const std::string& place) {
    const bool held[] = {s.fix_x || s.stiffness_x > 0, s.fix_y || s.stiffness_y > 0,
                         s.fix_angle || s.stiffness_angle > 0};
    bool moves = false;
    for (std::size_t row = 0; row < 3; ++row) {
      number(s.displacement[row], fields::any_number, place, "displacement");
      if (s.displacement[row] == 0) continue;
      moves = true;
      if (!held[row])
        add(place,
            std::string("its ground moves in the free row \"") +
                (row == 0   ? "x"
                 : row == 1 ? "y"
                            : "angle") +
                '"',
            "fix that row, give it a spring, or make the displacement 0 there");
    }
    if (!moves && s.ramp > 0) add(place, "has a ramp, and its ground does not move", "give a displacement");
  }

  void overrides(const JointOverrides& o, const std::string& place) {
    check(fields::overrides, o, place);
    if (o.hinge_length) number(*o.hinge_length, fields::positive, place, "hinge_length");
    if (o.shear_span) number(*o.shear_span, fields::positive, place, "shear_span");
    check(fields::elastic, o, place);
    if (o.elastic == Elasticity::frequency) number(o.frequency, fields::positive, place, "frequency");
    if (o.elastic == Elasticity::elastic_rotation)
      number(o.elastic_rotation, fields::positive, place, "elastic_rotation");
  }

  void body(const BodyDef& b) {
    const std::string place = body_place(b);
    if (b.name.empty() || b.name == "ground" || b.name.find_first_of("/#-") != std::string::npos)
      add(place, "is not a name that a body can have", "use one without / # -, that is not 'ground'");
    check(fields::body, b, place);
    for (const Point v : b.velocities) finite(v, place, "velocities");
    if (!b.velocities.empty() && (b.velocity != Point{} || b.angular_velocity != 0))
      add(place, "has both velocities of its pieces and one of its own", "leave one of them out");
    overrides(b.joint, place);

    const bool dynamic = b.type == BodyType::dynamic_body;
    if (b.material) {
      check(fields::strength, *b.material, place);
      check(fields::substance, *b.material, place);
      const double fy = b.material->yield_stress, fu = b.material->ultimate_stress;
      if (fu > 0 && fu < fy)
        add(place, "fu is " + to_string(fu) + ", below fy, " + to_string(fy),
            "give an ultimate stress of at least the yield stress, or leave it out");
      if (dynamic && b.profile.empty() && b.material->density == 0)
        number(b.material->density, fields::positive, place, "density");
    } else if (dynamic) {
      add(place, "has no material", "give it one, or make it static");
    }
    if (!b.profile.empty()) {
      for (Problem& p : validate(b.profile)) add(place + ", profile " + p.place, p.what, p.remedy);
      for (const Region& region : b.profile)
        if (dynamic && !(region.material.density > 0) && !(b.material && b.material->density > 0))
          add(place, "its profile has no density", "give the body a material");
    }

    const bool is_split = b.pieces != 1 || !b.cuts.empty() || b.automatic;
    if (b.circle != 0) {
      number(b.circle, fields::positive, place, "circle");
      if (!b.outline.outer.empty()) add(place, "has both an outline and a circle", "leave one of them out");
      if (is_split) add(place, "is a circle and cannot be split", "give it an outline of vertices");
    } else {
      for (Problem& p : validate(b.outline, place)) problems.push_back(std::move(p));
      for (const Point& p : b.outline.outer)
        if (!(std::max(std::abs(p.x), std::abs(p.y)) < 1e12)) {
          add(place, "reaches out to " + to_string(p), "keep the outline within 1e12 m of its origin");
          break;
        }
    }
    if ((b.pieces != 1) + !b.cuts.empty() + b.automatic > 1)
      add(place, "is split in more than one way", "give one of pieces, cuts and auto");
    if (b.pieces < 1 || b.pieces > BodyDef::most_pieces)
      add(place, "cannot be split into " + std::to_string(b.pieces) + " pieces",
          "give 1 to " + std::to_string(BodyDef::most_pieces));
    finite(b.along[0], place, "along");
    finite(b.along[1], place, "along");
    for (std::size_t i = 0; i < b.cuts.size(); ++i) {
      const std::string at = place + ", cut " + std::to_string(i);
      finite(b.cuts[i][0], at, "its start");
      finite(b.cuts[i][1], at, "its end");
      if (b.cuts[i][0] == b.cuts[i][1]) add(at, "has no length", "give two different points");
    }
    if (is_split && b.group > 0)
      add(place, "has a positive collision group, in which its pieces would collide with each other",
          "give a split body a negative group or none");
  }

  std::set<std::string_view> names_;                                // of bodies
  std::set<std::pair<std::string_view, std::string_view>> joined_;  // bodies where edges overlap
};

}  // namespace

std::vector<Problem> wrong_with(const SceneDef& scene) {
  Check check;
  check.scene(scene);
  return std::move(check.problems);
}

std::string body_place(const BodyDef& body) { return "body '" + body.name + "'"; }

}  // namespace ductile::calibration
