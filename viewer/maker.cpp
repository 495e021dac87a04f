#include "maker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "part.h"

namespace ductile::viewer {

void Maker::choose(Workbench& bench, Tool tool) {
  cancel(bench);
  tool_ = tool;
  if (tool != Tool::none) {
    bench.playing = false;
    if (bench.run().cursor() > 0) bench.restart();
  }
  bench.check_at_rest(tool != Tool::none);
}

// What is being drawn has its own end under the pointer, so it snaps to what was there before.
Point Maker::snapped(const Workbench& bench, Point at, double reach) const {
  const SceneDef& scene = drawn_ ? before_ : bench.scene();
  std::optional<Point> nearest;
  double within = reach;
  const auto offer = [&](Point p) {
    if (length(p - at) > within) return;
    within = length(p - at);
    nearest = p;
  };
  for (const Point node : nodes(scene)) offer(node);
  for (const Point corner : corners_) offer(corner);
  if (nearest) return *nearest;
  const Point on_grid{grid * std::round(at.x / grid), grid * std::round(at.y / grid)};
  const bool on_things = tool_ == Tool::support || tool_ == Tool::load || tool_ == Tool::remove ||
                         tool_ == Tool::line || tool_ == Tool::node;
  if (!on_things || body_at(scene, on_grid)) return on_grid;
  for (const BodyDef& body : scene.bodies) {
    if (const auto axis = axis_of(body)) offer(axis->nearest(at));
  }
  if (tool_ == Tool::remove) {
    for (const JointBetweenDef& joint : scene.joints) {
      if (joint.line) offer(Axis{(*joint.line)[0], (*joint.line)[1]}.nearest(at));
    }
  }
  if (!nearest && body_at(scene, at)) return at;  // a body that the grid misses
  return nearest.value_or(on_grid);
}

void Maker::point(Workbench& bench, Point at, double reach) {
  aim_ = at;
  if (grip_) return turn(bench);
  put(bench, snapped(bench, at, reach));
}

void Maker::step(Workbench& bench, int columns, int rows) {
  const auto on = [this](double from, int by) {
    return by == 0 ? from : grid * (std::round(from / grid) + by);
  };
  aim_ = {on(cursor_.x, columns), on(cursor_.y, rows)};
  put(bench, aim_);
}

void Maker::next_node(Workbench& bench, int by) {
  const std::vector<Point> all = nodes(drawn_ ? before_ : bench.scene());
  if (all.empty()) return;
  const auto before = [](Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  const auto n = static_cast<std::ptrdiff_t>(all.size());
  const auto here = std::lower_bound(all.begin(), all.end(), cursor_, before) - all.begin();
  const bool on_node = here < n && is_same(all[static_cast<std::size_t>(here)], cursor_);
  const std::ptrdiff_t next = by > 0 ? here + (on_node ? 1 : 0) : here - 1;
  aim_ = all[static_cast<std::size_t>((next + n) % n)];
  put(bench, aim_);
}

void Maker::put(Workbench& bench, Point at) {
  if (is_same(at, cursor_)) return;
  cursor_ = at;
  if (start_) draw(bench);
}

void Maker::press(Workbench& bench) {
  if (tool_ == Tool::none) return;
  bench.playing = false;
  if (bench.run().cursor() > 0) return bench.restart();  // what is seen stands elsewhere
  switch (tool_) {
    case Tool::beam:
    case Tool::line:
    case Tool::cut:
    case Tool::move:
    case Tool::choose:
      return begin(bench);
    case Tool::block:
      return attempt(bench, [&] { add_corner(bench); });
    case Tool::paste:
    case Tool::mirror:
    case Tool::turn:
      if ((tool_ == Tool::paste ? copied_.bodies : part_of(bench.scene(), chosen_).bodies).empty()) {
        bench.message = "Nothing is chosen. Draw a box around what is meant, with the tool for that (9).";
        return;
      }
      begin(bench);
      return draw(bench);
    default:
      return attempt(bench, [&] { click(bench); });
  }
}

void Maker::begin(Workbench& bench) {
  start_ = cursor_;
  begun_at_ = aim_;
  before_ = bench.scene();
  edition_ = bench.edition();
  problem_.clear();
}

void Maker::click(Workbench& bench) const {
  const SceneDef& scene = bench.scene();
  if (tool_ == Tool::support) bench.edit(with_next_support(scene, cursor_, stiffness));
  if (tool_ == Tool::load) bench.edit(with_load(scene, cursor_, load.vector(), load.ramp));
  if (tool_ == Tool::node) bench.edit(with_weld_or_pin(scene, cursor_));
  if (tool_ == Tool::remove) bench.edit(without(scene, cursor_));
}

// Another one at the first or the last corner closes the polygon.
void Maker::add_corner(Workbench& bench) {
  if (corners_.empty() || !(is_same(cursor_, corners_.front()) || is_same(cursor_, corners_.back()))) {
    corners_.push_back(cursor_);
    return;
  }
  if (corners_.size() < 3) {
    if (corners_.size() > 1) corners_.pop_back();
    return;
  }
  bench.edit(with_block(bench.scene(), std::exchange(corners_, {}), block));
}

bool Maker::interrupted(const Workbench& bench) {
  if (bench.edition() == edition_) return false;
  let_go();
  return true;
}

void Maker::let_go() {
  start_.reset();
  grip_.reset();
  drawn_ = false;
}

SceneDef Maker::drawn(std::vector<std::string>& chosen) const {
  const auto joined = [&](SceneDef scene, SceneDef part) {
    Joined result = with_part(std::move(scene), std::move(part));
    chosen = std::move(result.added);
    return std::move(result.scene);
  };
  const auto turned_about = [&](Point about, double degrees) {
    return joined(without_chosen(before_),
                  turned(part_of(before_, chosen_), about, degrees * std::numbers::pi / 180));
  };
  if (grip_) return turned_about(grip_->about, turned_by_);
  switch (tool_) {
    case Tool::beam:
      return with_beam(before_, {*start_, cursor_}, style);
    case Tool::line:
      return with_line(before_, {*start_, cursor_}, line);
    case Tool::cut:
      return with_cut(before_, {*start_, cursor_});
    case Tool::paste:
      return joined(before_, shifted(copied_, cursor_ - grip_of(copied_)));
    case Tool::mirror:
      return joined(before_, mirrored(part_of(before_, chosen_), cursor_.x));
    case Tool::turn:
      return turned_about(cursor_, turn_by);
    default:
      break;
  }
  // A node where something ends, or else the body there, with all that is chosen where it is one of those.
  if (is_end(before_, *start_)) return with_node_moved(before_, *start_, cursor_);
  const BodyDef* body = body_at(before_, begun_at_);
  if (!body) body = body_at(before_, *start_);
  if (!body) throw InvalidInput({{"move", "there is nothing here", "drag a node or a body"}});
  const bool with_chosen = std::find(chosen_.begin(), chosen_.end(), body->name) != chosen_.end();
  return with_bodies_moved(before_, with_chosen ? chosen_ : with_assemblies(before_, {body->name}),
                           cursor_ - *start_);
}

void Maker::draw(Workbench& bench) {
  if (interrupted(bench) || (tool_ == Tool::choose && !grip_)) return;
  try {
    std::vector<std::string> added;
    bench.draw(drawn(added), drawn_);
    if (tool_ == Tool::paste || tool_ == Tool::turn || grip_) chosen_ = std::move(added);
    drawn_ = true;
    edition_ = bench.edition();
    problem_.clear();
  } catch (const InvalidInput& error) {
    problem_ = error.what();
  }
}

void Maker::release(Workbench& bench, bool add) {
  if (!start_ || interrupted(bench)) return;
  if (tool_ == Tool::choose && !grip_) return choose_between(bench, add);
  const bool at_once = tool_ == Tool::paste || tool_ == Tool::mirror || tool_ == Tool::turn;
  const bool moved = at_once || (grip_ ? turned_by_ != 0 : !is_same(cursor_, *start_));
  if (moved && !problem_.empty()) bench.message = "This cannot be.\n" + problem_;
  if (!moved || !problem_.empty()) return cancel(bench);
  bench.settle();
  let_go();
}

void Maker::choose_between(const Workbench& bench, bool add) {
  if (!add) chosen_.clear();
  std::vector<std::string> found;
  if (is_same(*start_, cursor_)) {
    const BodyDef* body = body_at(bench.scene(), begun_at_);
    if (!body) body = body_at(bench.scene(), cursor_);
    if (body) found = {body->name};
  } else {
    Bounds box;
    for (const Point p : {*start_, cursor_})
      for (const double margin : {-node_size, node_size}) box.add(p + Point{margin, margin});
    found = bodies_in(bench.scene(), box);
  }
  found = with_assemblies(bench.scene(), std::move(found));
  chosen_.insert(chosen_.end(), found.begin(), found.end());
  start_.reset();
}

void Maker::cancel(Workbench& bench) {
  corners_.clear();
  if (!start_ || interrupted(bench)) return;
  if (drawn_) bench.undo();
  let_go();
}

std::vector<std::string> Maker::chosen(const Workbench& bench) const {
  std::vector<std::string> there;
  for (const std::string& name : chosen_) {
    if (body_named(bench.scene(), name)) there.push_back(name);
  }
  return there;
}

bool Maker::copy(const Workbench& bench) {
  SceneDef part = part_of(bench.scene(), chosen_);
  if (part.bodies.empty()) return false;
  copied_ = std::move(part);
  return true;
}

SceneDef Maker::without_chosen(SceneDef scene) const {
  for (const std::string& name : chosen_) {
    if (body_named(scene, name)) scene = without_body(std::move(scene), name);
  }
  return scene;
}

bool Maker::remove_chosen(Workbench& bench) {
  if (chosen(bench).empty()) return false;
  attempt(bench, [&] { bench.edit(without_chosen(bench.scene())); });
  return true;
}

bool Maker::group(Workbench& bench) {
  const std::vector<std::string> names = chosen(bench);
  if (std::set<std::string>(names.begin(), names.end()).size() < 2) return false;
  attempt(bench, [&] { bench.edit(with_assembly(bench.scene(), names)); });
  return true;
}

void Maker::ungroup(Workbench& bench) {
  attempt(bench, [&] { bench.edit(without_assemblies(bench.scene(), chosen(bench))); });
}

std::optional<Maker::TurnGrip> Maker::turn_grip(const Workbench& bench, double arm) const {
  if (grip_)
    return TurnGrip{grip_->about, grip_->about + Rotation(turned_by_ * std::numbers::pi / 180) *
                                                     (grip_->at - grip_->about)};
  if (tool_ != Tool::choose || start_) return std::nullopt;
  const Bounds box = box_of(part_of(bench.scene(), chosen_).bodies);
  if (box.empty()) return std::nullopt;
  return TurnGrip{box.middle(), {box.middle().x, box.high.y + arm}};
}

void Maker::take_grip(Workbench& bench, const TurnGrip& grip) {
  cursor_ = aim_ = grip.at;
  turned_by_ = 0;
  begin(bench);
  grip_ = grip;
}

void Maker::turn(Workbench& bench) {
  constexpr double step = 5;  // degrees
  const Point from = grip_->at - grip_->about, to = aim_ - grip_->about;
  const double angle = std::atan2(cross(from, to), dot(from, to)) * 180 / std::numbers::pi;
  if (const double by = step * std::round(angle / step); by != turned_by_) {
    turned_by_ = by;
    draw(bench);
  }
}

}  // namespace ductile::viewer
