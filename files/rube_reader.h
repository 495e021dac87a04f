// A R.U.B.E. scene on its way to a calibrated one: bodies that name a material become bodies of a SceneDef,
// their joints joints between them; what comes out is written back into the scene.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rube.h"

namespace ductile::rube {

class Reader {
 public:
  Reader(const Json& original, Scene& scene, StockJoint as, Problems& problems)
      : original_(original), scene_(scene), as_(as), problems_(problems) {}
  void read();

 private:
  /// A joint that is to be calibrated: its number in the scene and its bodies, by def_.joints.
  struct Between {
    int joint, a, b;
    Point anchor;  // m, in the world
    bool pin;
  };

  // bodies: rube_bodies.cpp
  std::vector<BodyDef> parts_of(const Body& body);
  void take_part(int body);
  void describe(const Body& body, std::vector<BodyDef>& parts);
  std::optional<Material> material(const Item& item);
  std::string unique(std::string name);
  bool is_ground(int body) const;
  void read_loads(int body);

  // joints: rube_scene.cpp
  void joint(int index, const Value& value);
  std::optional<RateLaw> rate(const Item& item) const;
  void values(int index, const Item& item, int a, int b);
  void find_section(JointBetweenDef& joint, const Between& between);
  const BodyDef& part_at(int body, Point at) const;
  void list_what_is_beyond();

  // what came out: rube_calibrated.cpp
  void unite_parts();
  void write_bodies();
  void redirect();
  void write_joints();
  int piece_at(int body, Point at) const;

  const Json& original_;  // values point into it
  Scene& scene_;
  StockJoint as_;
  Problems& problems_;
  std::vector<Body> bodies_;
  SceneDef def_;
  std::vector<int> body_of_def_;  // by def_.bodies
  std::vector<Between> between_;
  std::set<std::string> names_;
  std::vector<PlannedJoint> given_;  // joints that have their values; a and b are the scene's bodies
  std::vector<int> given_at_;
  std::vector<std::string> given_reasons_;
};

bool names_material(const Item& body);

/// Complains of each custom property "ductile.…" that is not known where it stands.
void refuse_unknown_properties(const Item& scene);

/// Metres from a point to a body or piece; 0 inside.
double distance(Point p, const Outline& outline, double circle, Point centre);

}  // namespace ductile::rube
