#include "ductile/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "svg.h"

namespace ductile {
namespace {

using namespace picture;

constexpr auto still = "#c6cdd4", ghost = "#eef1f4";
// Moving bodies in turn, pale, so that the joints' colours stand out on all of them.
constexpr std::array tints{"#e6ecf2", "#f1e7d9", "#e3ecdf", "#eee4ef"};

// Small is light and large is dark: the colours of a flame, whose lightness falls steadily for every kind of
// colour vision.
constexpr std::array<Colour, 5> moment_colours{
    {{0xfc, 0xe3, 0x8a}, {0xf6, 0xa0, 0x4d}, {0xd9, 0x53, 0x4f}, {0x93, 0x2b, 0x72}, {0x2f, 0x10, 0x5c}}};

constexpr double gap = 14, caption = 30, footer = 64;

/// Where a point of a piece, as drawn, is in a panel.
class Pose {
 public:
  Pose(const Plan& plan, const Panel& panel, int piece) {
    if (piece < 0 || panel.pieces.empty()) return;
    from_ = plan.pieces[static_cast<std::size_t>(piece)].center;
    const PieceReading& now = panel.pieces[static_cast<std::size_t>(piece)];
    to_ = now.position;
    cos_ = std::cos(now.angle);
    sin_ = std::sin(now.angle);
  }
  Point operator()(Point p) const {
    const double x = p.x - from_.x, y = p.y - from_.y;
    return {to_.x + cos_ * x - sin_ * y, to_.y + sin_ * x + cos_ * y};
  }

 private:
  Point from_, to_;
  double cos_ = 1, sin_ = 0;
};

bool moves(const Plan& plan, const Piece& piece) {
  return plan.bodies[static_cast<std::size_t>(piece.body)].type != BodyType::static_body;
}

Box box_of(const Piece& piece, const Pose& pose) {
  Box box;
  if (piece.circle > 0) {
    box.add(pose(piece.center));
    return box.grown(piece.circle);
  }
  for (const Point& p : piece.outline.outer) box.add(pose(p));
  return box;
}

/// What the panels show: all that moves as it is drawn, and as much of its surroundings, and of where it has
/// gone, as half the size of that lets in.
Box view_of(const Plan& plan, const std::vector<Panel>& panels) {
  Box core, all;
  const Panel as_drawn;
  for (const bool moving : {true, false}) {
    for (std::size_t i = 0; core.empty() && i < plan.pieces.size(); ++i)
      if (moves(plan, plan.pieces[i]) == moving) {
        for (const Piece& piece : plan.pieces)
          if (moves(plan, piece) == moving) core.add(box_of(piece, Pose(plan, as_drawn, -1)));
      }
  }
  if (core.empty()) core.add(Point{});
  for (const Panel& panel : panels)
    for (std::size_t i = 0; i < plan.pieces.size(); ++i)
      all.add(box_of(plan.pieces[i], Pose(plan, panel, static_cast<int>(i))));
  const double size = std::max({core.width(), core.height(), 1e-9});
  Box view = all.within(core.grown(size / 2));
  view.add(core);
  return view.grown(0.03 * std::max(view.width(), view.height()));
}

Colour moment_colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (moment_colours.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), moment_colours.size() - 2);
  const Colour &a = moment_colours[i], &b = moment_colours[i + 1];
  const auto mix = [t = at - static_cast<double>(i)](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + t * (to - from)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

/// Plastic moments on a logarithmic scale. Moments that read alike, within 1e-3, are one: what rounding makes
/// of equal sections does not fill the scale.
struct MomentScale {
  double low = unlimited, high = 0;

  explicit MomentScale(const Plan& plan) {
    for (const PlannedJoint& joint : plan.joints) {
      if (!(joint.M > 0) || joint.M == unlimited) continue;
      low = std::min(low, joint.M);
      high = std::max(high, joint.M);
    }
    if (high <= low * (1 + 1e-3)) low = high;
  }
  bool empty() const { return high == 0; }
  double share(double moment) const { return high > low ? std::log(moment / low) / std::log(high / low) : 1; }
  /// Both ends, and the powers of ten that are clear of them.
  std::vector<double> ticks() const {
    if (!(high > low)) return {high};
    std::vector<double> ticks{low, high};
    // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): powers of ten
    for (double power = std::pow(10, std::ceil(std::log10(low))); power < high; power *= 10)
      if (share(power) > 0.22 && share(power) < 0.78) ticks.push_back(power);
    return ticks;
  }
};

/// One panel's drawing, y up in metres to y down in px.
class Artist {
 public:
  /// `place`: the panel, px; `mark`: how large marks are, 1 where the panel is as wide as the picture.
  Artist(const Plan& plan, const Panel& panel, const MomentScale& moments, const Box& view, double scale,
         const Box& place, double mark)
      : plan_(plan),
        panel_(panel),
        moments_(moments),
        view_(view),
        scale_(scale),
        mark_(mark),
        place_(place),
        corner_{(place.x0 + place.x1 - scale * view.width()) / 2,
                (place.y0 + place.y1 - scale * view.height()) / 2} {}

  void draw(Node to) const {
    const Panel as_drawn;
    Node bodies = add(to, "g", "stroke-width", "1", "stroke-linejoin", "round");
    for (const bool moving : {false, true}) {
      if (moving && !panel_.pieces.empty())
        for (const Piece& piece : plan_.pieces)
          if (moves(plan_, piece)) shape(bodies, piece, Pose(plan_, as_drawn, -1), ghost, "none");
      for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
        if (moves(plan_, plan_.pieces[i]) == moving) draw_piece(bodies, i);
    }
    // Plain ones first: what yields or breaks must not lie under its neighbours.
    std::vector<std::size_t> order(plan_.joints.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (!panel_.joints.empty())
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return stage(panel_.joints[a]) < stage(panel_.joints[b]);
      });
    for (const std::size_t i : order) draw_joint(to, i);
    for (const Arrow& arrow : arrows()) draw_arrow(to, arrow);
  }

 private:
  Point px(Point p) const {
    return {corner_.x + (p.x - view_.x0) * scale_, corner_.y + (view_.y1 - p.y) * scale_};
  }

  void shape(Node to, const Piece& piece, const Pose& pose, const char* fill, const char* stroke) const {
    if (piece.circle > 0) {
      const Point centre = px(pose(piece.center));
      const Point rim = px(pose({piece.center.x + piece.circle, piece.center.y}));
      add(to, "circle", "cx", centre.x, "cy", centre.y, "r", piece.circle * scale_, "fill", fill, "stroke",
          stroke);
      add(to, "path", "d", fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", centre.x, centre.y, rim.x, rim.y),
          "stroke", stroke);
      return;
    }
    fmt::memory_buffer d;
    const auto ring = [&](const Ring& points) {
      const char* command = "M";
      for (const Point& p : points) {
        const Point at = px(pose(p));
        fmt::format_to(std::back_inserter(d), "{}{:.1f} {:.1f}", std::exchange(command, "L"), at.x, at.y);
      }
      d.push_back('Z');
    };
    ring(piece.outline.outer);
    for (const Ring& hole : piece.outline.holes) ring(hole);
    add(to, "path", "d", fmt::to_string(d), "fill-rule", "evenodd", "fill", fill, "stroke", stroke);
  }

  void draw_piece(Node to, std::size_t index) const {
    const Piece& piece = plan_.pieces[index];
    const bool moving = moves(plan_, piece);
    const char* tint = moving ? tints[static_cast<std::size_t>(piece.body) % tints.size()] : still;
    Node group = add(to, "g", "class", "piece");
    hover(group, moving && piece.mass > 0 ? piece.name + ": " + quantity(piece.mass * 1e3, "g") : piece.name);
    shape(group, piece, Pose(plan_, panel_, static_cast<int>(index)), tint, moving ? edge : "none");
  }

  std::string colour(std::size_t index) const {
    if (!panel_.joints.empty()) return hex(stage_colour(stage(panel_.joints[index])));
    const double moment = plan_.joints[index].M;
    if (moment == 0) return "#ffffff";
    return moment == unlimited ? quiet : hex(moment_colour(moments_.share(moment)));
  }

  std::string about(std::size_t index) const {
    const PlannedJoint& joint = plan_.joints[index];
    if (panel_.joints.empty()) {
      return fmt::format("{}: M_p {}, N {}, Q {}", joint.name, quantity(joint.M, "N m"),
                         quantity(joint.N, "N"), quantity(joint.Q, "N"));
    }
    const JointReading& now = panel_.joints[index];
    if (now.broken)
      return fmt::format("{}: broke at {:.3g} s; {} dissipated", joint.name, now.broken_at,
                         quantity(now.dissipated, "J"));
    return fmt::format("{}: N {}, Q {}, M {}; plastic rotation {:.3g} rad; {:.0f} % of its limit", joint.name,
                       quantity(now.N, "N"), quantity(now.Q, "N"), quantity(now.M, "N m"),
                       now.plastic_rotation, 100 * now.capacity_used);
  }

  /// The cut along which the pieces touch, and a dot at its anchor that grows with the hinge; where it is
  /// broken, both of its banks.
  void draw_joint(Node to, std::size_t index) const {
    const PlannedJoint& joint = plan_.joints[index];
    const Pose a(plan_, panel_, joint.a), b(plan_, panel_, joint.b);
    const Point half{-joint.axis.y * joint.height / 2, joint.axis.x * joint.height / 2};
    const Point ends[2] = {{joint.anchor.x - half.x, joint.anchor.y - half.y},
                           {joint.anchor.x + half.x, joint.anchor.y + half.y}};
    const auto between = [&](Point p) {
      const Point of_a = px(a(p)), of_b = px(b(p));
      return Point{(of_a.x + of_b.x) / 2, (of_a.y + of_b.y) / 2};
    };
    const auto line = [](Point p, Point q) {
      return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", p.x, p.y, q.x, q.y);
    };
    Node group = add(to, "g", "class", "joint", "stroke-linecap", "round");
    hover(group, about(index));
    const std::string paint = colour(index);
    const bool broken = !panel_.joints.empty() && panel_.joints[index].broken;
    if (broken) {
      for (const Pose* bank : {&a, &b}) {
        const std::string d = line(px((*bank)(ends[0])), px((*bank)(ends[1])));
        add(group, "path", "d", d, "stroke", paint, "stroke-width", 3 * mark_);
        cross(group, px((*bank)(joint.anchor)), paint);
      }
      return;
    }
    if (joint.height > 0) {
      const std::string d = line(between(ends[0]), between(ends[1]));
      add(group, "path", "d", d, "stroke", ink, "stroke-width", 4.6 * mark_);
      add(group, "path", "d", d, "stroke", paint, "stroke-width", 3 * mark_);
    }
    const Point at = between(joint.anchor);
    if (joint.a < 0) {
      add(group, "path", "d",
          fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z", at.x, at.y, -7 * mark_, 12 * mark_, 14 * mark_),
          "fill", still, "stroke", ink);
    }
    const double hinge = panel_.joints.empty() ? 0 : hinge_dot(panel_.joints[index].accumulated_rotation);
    const double smallest = panel_.joints.empty() ? 4.5 : 4;
    add(group, "circle", "cx", at.x, "cy", at.y, "r",
        std::max({smallest * mark_, 20 * mark_ * hinge, hinge * joint.height * scale_}), "fill", paint,
        "stroke", ink, "stroke-width", "1");
  }

  void cross(Node to, Point at, const std::string& paint) const {
    const double size = 10 * mark_;
    const std::string d = fmt::format("M{0:.1f} {1:.1f}l{2:.1f} {2:.1f}m0 {3:.1f}l{3:.1f} {2:.1f}",
                                      at.x - size / 2, at.y - size / 2, size, -size);
    add(to, "path", "d", d, "stroke", "#ffffff", "stroke-width", 6 * mark_, "fill", "none");
    add(to, "path", "d", d, "stroke", paint, "stroke-width", 3 * mark_, "fill", "none");
  }

  struct Arrow {
    int piece;
    Point at, force;
    double moment;
  };

  /// What acts at the panel's time, added up point by point; without a time, the largest load of each point.
  std::vector<Arrow> arrows() const {
    std::vector<Arrow> arrows;
    for (const Plan::Load& load : plan_.loads) {
      const LoadDef& def = load.def;
      double factor = 1;
      if (panel_.time) {
        const double since = *panel_.time - def.from;
        factor = since < 0 || *panel_.time >= def.to ? 0 : def.ramp > 0 ? std::min(1.0, since / def.ramp) : 1;
      }
      const Arrow arrow{
          load.piece, load.at, {factor * def.force.x, factor * def.force.y}, factor * def.moment};
      const auto same = std::find_if(arrows.begin(), arrows.end(), [&](const Arrow& other) {
        return other.piece == arrow.piece && other.at == arrow.at;
      });
      if (same == arrows.end()) {
        arrows.push_back(arrow);
      } else if (panel_.time) {
        same->force = {same->force.x + arrow.force.x, same->force.y + arrow.force.y};
        same->moment += arrow.moment;
      } else if (std::hypot(arrow.force.x, arrow.force.y) > std::hypot(same->force.x, same->force.y)) {
        *same = arrow;
      }
    }
    return arrows;
  }

  void draw_arrow(Node to, const Arrow& arrow) const {
    const double force = std::hypot(arrow.force.x, arrow.force.y);
    const Point at = px(Pose(plan_, panel_, arrow.piece)(arrow.at));
    if (force == 0 && arrow.moment == 0) return;
    Node group = add(to, "g", "class", "load", "stroke", ink, "stroke-width", "2.4", "fill", "none");
    if (force > 0) {
      const double length = 60 * mark_, x = arrow.force.x / force, y = -arrow.force.y / force;
      const Point tip{at.x + length * x, at.y + length * y};
      add(group, "path", "d",
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", at.x, at.y, tip.x - 6 * x, tip.y - 6 * y));
      add(group, "path", "fill", ink, "stroke", "none", "d",
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", tip.x, tip.y, tip.x - 12 * x - 5 * y,
                      tip.y - 12 * y + 5 * x, tip.x - 12 * x + 5 * y, tip.y - 12 * y - 5 * x));
      // Beside the shaft: above one that lies, to the right of one that stands.
      if (std::abs(x) > std::abs(y)) {
        label(group, quantity(force, "N"), {at.x + length * x / 2, at.y + length * y / 2 - 8}, "text-anchor",
              "middle");
      } else {
        label(group, quantity(force, "N"), {at.x + 0.75 * length * x + 10, at.y + 0.75 * length * y + 4});
      }
    }
    if (arrow.moment != 0) {
      // Three quarters of a circle; counter-clockwise is positive.
      const int side = arrow.moment > 0 ? 1 : -1;
      add(group, "path", "d",
          fmt::format("M{:.1f} {:.1f}a18 18 0 1 {} {} 18m{} -5l{} 5l{} 5", at.x + side * 18, at.y,
                      side > 0 ? 0 : 1, -side * 18, -side * 5, side * 5, -side * 5));
      label(group, quantity(std::abs(arrow.moment), "N m"), {at.x + 24, at.y - 12});
    }
  }

  template <class... Style>
  void label(Node to, const std::string& text, Point at, const Style&... style) const {
    write(to, text, at.x, std::clamp(at.y, place_.y0 + 16, place_.y1 - 8), "font-size", "13", "fill", ink,
          "stroke", "#ffffff", "stroke-width", "3", "paint-order", "stroke", "stroke-linejoin", "round",
          style...);
  }

  const Plan& plan_;
  const Panel& panel_;
  const MomentScale& moments_;
  const Box& view_;
  double scale_, mark_;
  Box place_;
  Point corner_;
};

struct Stop {
  double at;
  Colour colour;
};

/// A bar of colours with words above and ticks below.
void colour_bar(Node to, Node defs, const char* id, const std::vector<Stop>& stops, Point at, double width,
                const std::string& words, const std::vector<std::pair<double, std::string>>& ticks) {
  Node gradient = add(defs, "linearGradient", "id", id);
  for (const Stop& stop : stops) add(gradient, "stop", "offset", stop.at, "stop-color", hex(stop.colour));
  add(to, "rect", "x", at.x, "y", at.y, "width", width, "height", "10", "rx", "2", "fill",
      fmt::format("url(#{})", id));
  write(to, words, at.x, at.y - 7);
  for (const auto& [share, text] : ticks) {
    const double x = at.x + share * width;
    add(to, "path", "d", fmt::format("M{:.1f} {:.1f}v4", x, at.y + 10), "stroke", quiet);
    write(to, text, x, at.y + 27, "text-anchor",
          share < 0.05   ? "start"
          : share > 0.95 ? "end"
                         : "middle",
          "font-size", "12");
  }
}

void moment_bar(Node to, Node defs, const MomentScale& moments, Point at, double width) {
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < moment_colours.size(); ++i)
    stops.push_back({static_cast<double>(i) / (moment_colours.size() - 1), moment_colours[i]});
  std::vector<std::pair<double, std::string>> ticks;
  for (const double tick : moments.ticks()) ticks.emplace_back(moments.share(tick), quantity(tick, "N m"));
  colour_bar(to, defs, "moments", stops, at, width, "plastic moment of the joint", ticks);
}

void stage_bar(Node to, Node defs, Point at, double width) {
  std::vector<Stop> stops;
  stops.reserve(stage_colours.size());
  for (const auto& [stage, colour] : stage_colours) stops.push_back({stage / 2, colour});
  colour_bar(to, defs, "stages", stops, at, width, "", {{0, "unloaded"}, {0.5, "yields"}, {1, "breaks"}});
  write(to, "elastic: share of cap", at.x, at.y - 7);
  write(to, "plastic: share of limit", at.x + width, at.y - 7, "text-anchor", "end");
}

}  // namespace

Panel panel_of(const Simulation& simulation, std::string title) {
  Panel panel{.title = std::move(title), .time = simulation.time()};
  for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i)
    panel.pieces.push_back(simulation.piece(i));
  for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i)
    panel.joints.push_back(simulation.joint(i));
  return panel;
}

std::string picture_svg(const Plan& plan, const PictureDef& picture) {
  const Box view = view_of(plan, picture.panels);
  const MomentScale moments(plan);
  const auto columns = std::min<std::size_t>(3, picture.panels.size());
  const std::size_t rows = (picture.panels.size() + columns - 1) / columns;
  const double wide =
      (picture.width - 2 * margin - gap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  // As high as the view is, but readable where that is a line or a tower.
  const double high = wide * std::clamp(view.height() / view.width(), 0.25, 1.25);
  const double scale = std::min(wide / view.width(), high / view.height());
  const bool titled = std::any_of(picture.panels.begin(), picture.panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  const double row_height = high + (titled ? caption : gap);
  const double height = header + static_cast<double>(rows) * row_height + footer;

  pugi::xml_document document;
  Node svg = page(document, picture.width, height, picture.title, picture.subtitle);
  Node defs = add(svg, "defs");

  bool by_moment = false, by_stage = false;
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    const Panel& panel = picture.panels[i];
    const std::size_t column = i % columns, row = i / columns;
    const Point corner{margin + static_cast<double>(column) * (wide + gap),
                       header + static_cast<double>(row) * row_height};
    const std::string clip = fmt::format("panel{}", i);
    add(add(defs, "clipPath", "id", clip), "rect", "x", corner.x, "y", corner.y, "width", wide, "height",
        high, "rx", "4");
    Node group = add(svg, "g", "class", "panel", "clip-path", fmt::format("url(#{})", clip));
    add(group, "rect", "x", corner.x, "y", corner.y, "width", wide, "height", high, "fill", ground);
    const Box place{corner.x, corner.y, corner.x + wide, corner.y + high};
    Artist(plan, panel, moments, view, scale, place, columns == 1 ? 1 : 0.7).draw(group);
    write(svg, panel.title, corner.x + wide / 2, corner.y + high + 19, "text-anchor", "middle");
    (panel.joints.empty() ? by_moment : by_stage) = true;
  }

  const double foot = height - footer + 30;
  const double bar = 0.36 * picture.width;
  double x = margin;
  if (by_moment && !moments.empty()) {
    moment_bar(svg, defs, moments, {x, foot}, bar);
    x += bar + 2 * margin;
  }
  if (by_stage) stage_bar(svg, defs, {x, foot}, bar);
  scale_bar(svg, scale, {picture.width - margin, foot + 10}, 0.15 * picture.width);

  return text_of(document);
}

}  // namespace ductile
