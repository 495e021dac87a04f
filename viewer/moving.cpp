// Nodes and bodies that are drawn elsewhere, and what follows them: beams end where their nodes are, and what
// hangs between a beam's ends stays where it is along it.
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "making.h"
#include "pins.h"

namespace ductile::viewer {
namespace {

struct Shift {
  Point from, to;
};

template <class F>
bool any_body(const JointBetweenDef& joint, const F& is) {
  const std::vector<std::string> names = joint.bodies();
  return std::any_of(names.begin(), names.end(), is);
}

class Moving {
 public:
  Moving(SceneDef scene, const std::vector<std::string>& whole, Point by)
      : scene_(std::move(scene)), by_(by) {
    for (const BodyDef& body : scene_.bodies) {
      if (std::find(whole.begin(), whole.end(), body.name) == whole.end()) continue;
      if (const auto axis = axis_of(body)) {
        shift(axis->from, axis->from + by);
        shift(axis->to, axis->to + by);
      } else {
        whole_.push_back(body.name);
      }
    }
    for (const WheelDef& wheel : scene_.wheels) {
      if (is_whole(wheel.chassis) && !is_whole(wheel.wheel)) whole_.push_back(wheel.wheel);
    }
    for (const JointBetweenDef& joint : scene_.joints) {
      if (joint.at && any_body(joint, [&](const auto& name) { return is_whole(name); }))
        shift(*joint.at, *joint.at + by);
    }
  }

  void shift(Point from, Point to) {
    if (!shifted(from)) nodes_.push_back({from, to});
  }

  SceneDef done() && {
    follow();
    for (BodyDef& body : scene_.bodies) {
      if (is_whole(body.name)) body.at = body.at + by_;
      const auto old = axis_of(body);
      const auto now = old ? axis_now(*old) : std::nullopt;
      if (!now) continue;
      lay(body, *now);
      laid_.emplace(body.name, std::pair{*old, *now});
    }
    for (SupportDef& support : scene_.supports) support.at = carried(support.body, support.at);
    for (LoadDef& load : scene_.loads) load.at = carried(load.body, load.at);
    for (WheelDef& wheel : scene_.wheels) wheel.at = carried(wheel.chassis, wheel.at);
    for (JointBetweenDef& joint : scene_.joints) {
      if (joint.line) move_line(joint);
      if (joint.across) {
        for (Point& end : *joint.across) end = carried(joint.a, end);
      }
    }
    pin_again();
    return std::move(scene_);
  }

 private:
  bool is_whole(const std::string& name) const {
    return std::find(whole_.begin(), whole_.end(), name) != whole_.end();
  }

  std::optional<Point> shifted(Point p) const {
    const auto found =
        std::find_if(nodes_.begin(), nodes_.end(), [p](const Shift& s) { return is_same(s.from, p); });
    return found == nodes_.end() ? std::nullopt : std::optional(found->to);
  }

  /// Where a beam will be; nothing: where it is.
  std::optional<Axis> axis_now(const Axis& old) const {
    const auto from = shifted(old.from), to = shifted(old.to);
    if (!from && !to) return std::nullopt;
    return Axis{from.value_or(old.from), to.value_or(old.to)};
  }

  static Point along(const Axis& old, const Axis& now, Point p) {
    if (is_same(p, old.from)) return now.from;
    if (is_same(p, old.to)) return now.to;
    return now.from + length(p - old.from) / old.length() * (now.to - now.from);
  }

  /// Nodes between the ends of a beam that moves go along, and the beams that end there with them, and so on:
  /// each node once, so that rings of beams come to an end.
  void follow() {
    std::vector<Point> hung;
    for (const BodyDef& body : scene_.bodies) {
      if (const auto axis = axis_of(body)) hung.insert(hung.end(), {axis->from, axis->to});
    }
    for (bool more = true; std::exchange(more, false);) {
      for (const BodyDef& body : scene_.bodies) {
        const auto old = axis_of(body);
        const auto now = old ? axis_now(*old) : std::nullopt;
        if (!now) continue;
        for (const Point p : hung) {
          if (old->distance(p) >= node_size || old->ends_at(p) || shifted(p)) continue;
          nodes_.push_back({p, along(*old, *now, p)});
          more = true;
        }
      }
    }
  }

  /// Where a point of a body will be.
  Point carried(const std::string& body, Point p) const {
    if (is_whole(body)) return p + by_;
    const auto laid = laid_.find(body);
    if (laid == laid_.end()) return p;
    const auto& [old, now] = laid->second;
    return old.distance(p) < node_size ? along(old, now, p) : p;
  }

  /// Its ends go with their bodies; one that is moved by itself hangs on what is there.
  void move_line(JointBetweenDef& joint) const {
    for (const std::size_t end : {0u, 1u}) {
      std::string& body = end == 0 ? joint.a : joint.b;
      const std::string& other = end == 0 ? joint.b : joint.a;
      Point& at = (*joint.line)[end];
      const Point before = at;
      at = carried(body, at);
      if (!is_same(at, before)) continue;
      at = shifted(at).value_or(at);
      if (is_same(at, before)) continue;
      const BodyDef* there = body_at(scene_, at);
      if (there && there->name != other) body = there->name;
    }
  }

  void pin_again() {
    std::vector<Point> pins;
    for (JointBetweenDef& joint : scene_.joints) {
      if (!joint.at) continue;
      const auto to = shifted(*joint.at);
      const auto moves = [this](const std::string& name) { return laid_.contains(name); };
      if (to || any_body(joint, moves)) pins.push_back(to.value_or(*joint.at));
      if (to) joint.at = to;
    }
    for (const Shift& node : nodes_) pins.push_back(node.to);
    for (const Point at : pins) pin(scene_, at);
  }

  SceneDef scene_;
  Point by_;
  std::vector<std::string> whole_;  // bodies that are no beams
  std::vector<Shift> nodes_;
  std::map<std::string, std::pair<Axis, Axis>> laid_;  // beams, before and after
};

}  // namespace

bool is_end(const SceneDef& scene, Point at) {
  const auto ends = [&](const JointBetweenDef& joint) {
    return joint.line && Axis{(*joint.line)[0], (*joint.line)[1]}.ends_at(at);
  };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [&](const BodyDef& body) { return ends_at(body, at); }) ||
         std::any_of(scene.joints.begin(), scene.joints.end(), ends);
}

SceneDef with_node_moved(SceneDef scene, Point from, Point to) {
  if (!is_end(scene, from)) {
    throw InvalidInput({{"move", "nothing ends here", "drag the end of a beam or a line"}});
  }
  Moving moving(std::move(scene), {}, {});
  moving.shift(from, to);
  return std::move(moving).done();
}

SceneDef with_bodies_moved(SceneDef scene, const std::vector<std::string>& names, Point by) {
  return Moving(std::move(scene), names, by).done();
}

}  // namespace ductile::viewer
