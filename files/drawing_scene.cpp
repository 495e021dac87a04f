// A first scene of a drawing: which shapes stand on the floor, which bend, and which lie over one another.
#include <algorithm>
#include <array>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/files.h"
#include "ductile/moments.h"
#include "ductile/plane.h"

namespace ductile {
namespace {

namespace geometry = boost::geometry;

constexpr double size_without_scale = 10;  // m, of a drawing that does not say how large it is

/// A name that a scene takes, each once: without "/ # -", and not one of its own.
std::string body_name(std::string name, std::set<std::string>& taken) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '#' || c == '-'; }, '_');
  if (name == "ground" || name == "floor") name += "_";
  std::string one = name;
  for (int i = 2; !taken.insert(one).second; ++i) one = name + "_" + std::to_string(i);
  return one;
}

Bounds around(const DrawnShapes& drawn) {
  Bounds bounds;
  for (const auto& shape : drawn.shapes) {
    for (const Point& p : shape.outline.outer) bounds.add(p);
  }
  return bounds;
}
/// The longer side; 0 where nothing is drawn.
double size_of(const Bounds& bounds) {
  return bounds.empty() ? 0 : std::max(bounds.size().x, bounds.size().y);
}

/// Where a ring stands on the floor: the middle of each stretch of vertices there.
std::vector<Point> feet(const Ring& ring, double floor) {
  const auto stands = [&](std::size_t i) { return ring[i % ring.size()].y <= floor; };
  std::vector<Point> feet;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (stands(i + ring.size() - 1) || !stands(i)) continue;
    std::size_t last = i;
    while (stands(last + 1)) ++last;
    feet.push_back(0.5 * (ring[i] + ring[last % ring.size()]));
  }
  return feet;
}

/// Does it bend, as a frame does that is drawn as one stroke? Cuts across its long axis would then leave
/// parts of it whole, or cut them lengthwise. What is straight or solid covers about half of the rectangle
/// around it that lies along its long axis, as a triangle does, or more.
bool bends(const Outline& outline) {
  const AreaMoments m = moments(outline);
  const LongAxis axis = long_axis(outline, m);
  double low = 0, high = 0;  // across the axis
  for (const Point& p : outline.outer) {
    const double y = cross(axis.direction, p - m.centroid);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  constexpr double least_of_straight = 0.4;
  return m.area < least_of_straight * (axis.high - axis.low) * (high - low);
}

/// Can it be split like that, held as it is, and into what Box2D collides?
bool stands(const BodyDef& body, const std::vector<SupportDef>& supports) {
  try {
    SceneDef alone;
    alone.bodies = {body};
    for (const SupportDef& support : supports)
      if (support.body == body.name) alone.supports.push_back(support);
    for (const Piece& piece : calibrate(alone).pieces) {
      if (body.collides) shapes(piece);
    }
    return true;
  } catch (const InvalidInput&) {
    return false;
  }
}

/// Across its middle line where it bends, else up to 8 pieces: a body that cannot be split is still a body;
/// what is too thin for Box2D collides with nothing.
BodyDef split(BodyDef body, const std::vector<SupportDef>& supports) {
  const int whole = body.pieces;
  const bool bent = bends(body.outline);
  for (const bool collides : {true, false}) {
    body.collides = collides;
    body.automatic = bent;
    if (bent && stands(body, supports)) return body;
    body.automatic = false;
    for (const int pieces : {8, 4, 2, whole}) {
      body.pieces = pieces;
      if (stands(body, supports)) return body;
    }
    body.pieces = whole;
  }
  return body;
}

// Points at equal distances along a ring.
std::vector<Point> along(const Ring& ring, int count) {
  const auto edge = [&](std::size_t i) { return ring[(i + 1) % ring.size()] - ring[i]; };
  double whole = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) whole += length(edge(i));
  std::vector<Point> points;
  double passed = 0;  // up to ring[i]
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double own = length(edge(i));
    for (; static_cast<int>(points.size()) < count;) {
      const double at = whole * static_cast<double>(points.size()) / count - passed;
      if (!(at < own)) break;
      points.push_back(ring[i] + at / own * edge(i));
    }
    passed += own;
  }
  return points;
}

/// The edges of an outline in a tree of boxes.
class Edges {
 public:
  explicit Edges(const Outline& outline) {
    std::vector<Entry> entries;
    const auto add = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::array edge{ring[i], ring[(i + 1) % ring.size()]};
        const Bounds around = bounds_of(edge);
        entries.emplace_back(box(around.low, around.high), edge);
      }
    };
    add(outline.outer);
    for (const Ring& hole : outline.holes) add(hole);
    tree_ = Tree(entries);  // packed
  }

  /// Is a point inside, and no edge nearer to it than `depth`?
  bool hold(Point p, double depth) const {
    const Point reach{depth, depth};
    const auto near = tree_.qbegin(geometry::index::intersects(box(p - reach, p + reach)) &&
                                   geometry::index::satisfies([&](const Entry& entry) {
                                     return distance(p, entry.second[0], entry.second[1]) < depth;
                                   }));
    if (near != tree_.qend()) return false;
    bool inside = false;  // it is where the edges to its right are odd in number
    const Box right = box(p, {std::numeric_limits<double>::max(), p.y});
    for (auto at = tree_.qbegin(geometry::index::intersects(right)); at != tree_.qend(); ++at) {
      const auto [a, b] = at->second;
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
    }
    return inside;
  }

 private:
  using Box = geometry::model::box<geometry::model::d2::point_xy<double>>;
  using Entry = std::pair<Box, std::array<Point, 2>>;
  using Tree = geometry::index::rtree<Entry, geometry::index::quadratic<16>>;

  static Box box(Point low, Point high) { return {{low.x, low.y}, {high.x, high.y}}; }

  Tree tree_;
};

/// Shapes that are drawn over one another would burst apart: those of a heap have a group in which nothing
/// collides. Returns how many they are. What lies over another by less than `depth` rests on it.
int group_heaps(std::span<BodyDef> bodies, double depth) {
  constexpr int samples = 200;  // of each outline: what reaches into another by less than a 200th is missed
  std::vector<Bounds> bounds;
  std::vector<Edges> edges;
  std::vector<std::vector<Point>> points;
  for (const BodyDef& body : bodies) {
    bounds.push_back(bounds_of(body.outline.outer));
    edges.emplace_back(body.outline);
    points.push_back(along(body.outline.outer, samples));
  }
  const auto reaches_into = [&](std::size_t i, std::size_t k) {
    return std::any_of(points[i].begin(), points[i].end(),
                       [&](Point p) { return bounds[k].contains(p) && edges[k].hold(p, depth); });
  };
  std::int16_t heaps = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!bounds[i].meets(bounds[k])) continue;
      if (bodies[i].group != 0 && bodies[i].group == bodies[k].group) continue;
      if (!reaches_into(i, k) && !reaches_into(k, i)) continue;
      if (bodies[k].group == 0) bodies[k].group = bodies[i].group != 0 ? bodies[i].group : --heaps;
      const std::int16_t old = std::exchange(bodies[i].group, bodies[k].group);
      if (old == 0) continue;
      for (BodyDef& other : bodies)
        if (other.group == old) other.group = bodies[k].group;
    }
  }
  return static_cast<int>(
      std::count_if(bodies.begin(), bodies.end(), [](const BodyDef& b) { return b.group != 0; }));
}

}  // namespace

DrawnScene drawing_scene(const Drawing& drawing, double metres_per_unit) {
  DrawnScene result;
  DrawnShapes drawn;
  if (metres_per_unit > 0 || drawing.sized()) {
    drawn = drawing.shapes({.metres_per_unit = metres_per_unit});
  } else {
    const double units = size_of(around(drawing.shapes({.metres_per_unit = 1})));
    result.scale = units > 0 ? size_without_scale / units : 1;
    drawn = drawing.shapes({.metres_per_unit = result.scale});
  }
  result.left_out = std::move(drawn.left_out);
  if (drawn.shapes.empty()) {
    auto problems = result.left_out;
    problems.push_back({drawing.name(), "shows no shape", "draw one with a fill or a stroke"});
    throw InvalidInput(std::move(problems));
  }
  const Bounds frame = around(drawn);
  const double size = size_of(frame);
  BodyDef floor;
  floor.name = "floor";
  floor.type = BodyType::static_body;
  const double deep = std::max(0.1 * size, 0.1);  // m: thick enough for Box2D
  floor.outline.outer = {{frame.low.x - size, frame.low.y - deep},
                         {frame.high.x + size, frame.low.y - deep},
                         {frame.high.x + size, frame.low.y},
                         {frame.low.x - size, frame.low.y}};
  result.scene.bodies.push_back(floor);
  std::set<std::string> taken;
  for (auto& shape : drawn.shapes) {
    BodyDef body;
    body.name = body_name(std::move(shape.name), taken);
    body.outline = std::move(shape.outline);
    body.material = materials::S355;
    body.depth = 0.05 * size;
    for (const Point& foot : feet(body.outline.outer, frame.low.y + 1e-6 * size))
      result.scene.supports.push_back({body.name, foot, true, true, true});
    result.scene.bodies.push_back(split(std::move(body), result.scene.supports));
    result.too_thin += !result.scene.bodies.back().collides;
  }
  result.heaped = group_heaps(std::span(result.scene.bodies).subspan(1), 1e-3 * size);
  return result;
}

bool is_drawing(std::string_view text) {
  const bool utf16 = text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE");
  if (utf16) return text.substr(2, 2).find('<') != std::string_view::npos;
  const auto first = std::find_if(text.begin(), text.end(), [](unsigned char c) {
    return !std::isspace(c) && c != 0xEF && c != 0xBB && c != 0xBF;  // a byte order mark
  });
  return first != text.end() && *first == '<';
}

}  // namespace ductile
