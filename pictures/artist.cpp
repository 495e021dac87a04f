#include "artist.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "draw_diagram.h"
#include "ductile/plane.h"
#include "labels.h"

namespace ductile::picture {
namespace {

constexpr auto still = "#c6cdd4", ghost = "#eef1f4";
// Moving bodies in turn, pale, so that the joints' colours stand out on all of them.
constexpr std::array tints{"#e6ecf2", "#f1e7d9", "#e3ecdf", "#eee4ef"};

Colour moment_colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (moment_colours.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), moment_colours.size() - 2);
  const Colour &a = moment_colours[i], &b = moment_colours[i + 1];
  const auto mix = [t = at - static_cast<double>(i)](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + t * (to - from)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

class Artist {
 public:
  Artist(const Plan& plan, const Panel& panel, const MomentScale& moments, const Frame& frame)
      : plan_(plan),
        panel_(panel),
        moments_(moments),
        frame_(frame),
        scale_(frame.scale),
        mark_(frame.mark),
        labels_(frame.place) {}

  void draw(Node to) {
    const Panel as_drawn;
    Node bodies = add(to, "g", "stroke-width", "1", "stroke-linejoin", "round");
    for (const bool moving : {false, true}) {
      if (moving && !(panel_.pieces.empty() && panel_.motions.empty()))
        for (const Piece& piece : plan_.pieces)
          if (moves(plan_, piece)) shape(bodies, piece, Pose(plan_, as_drawn, -1), ghost, "none");
      for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
        if (moves(plan_, plan_.pieces[i]) == moving) draw_piece(bodies, i);
    }
    if (panel_.diagram) {
      draw_diagram(to, plan_, panel_, frame_, labels_);
      for (std::size_t i = 0; i < plan_.joints.size(); ++i)
        if (plan_.joints[i].a < 0) draw_support(to, px(plan_.joints[i].anchor), plan_.joints[i]);
      return;
    }
    // Plain ones first: what yields or breaks must not lie under its neighbours.
    std::vector<std::size_t> order(plan_.joints.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (!panel_.joints.empty())
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return stage(panel_.joints[a]) < stage(panel_.joints[b]);
      });
    const auto draw_joints = [&] {
      for (const std::size_t i : order) draw_joint(to, i);
    };
    if (panel_.hinges.empty()) draw_joints();
    const std::vector<Arrow> arrows = loads();
    for (const Arrow& arrow : arrows) avoid(arrow);
    // What acts alike on the next point, as a load that is spread along a bar, needs no label of its own.
    for (std::size_t i = 0; i < arrows.size(); ++i)
      draw_arrow(to, arrows[i],
                 i > 0 && arrows[i].force == arrows[i - 1].force && arrows[i].moment == arrows[i - 1].moment);
    if (!panel_.hinges.empty()) draw_joints();  // no arrow covers a hinge's number
  }

 private:
  Point px(Point p) const { return frame_.px(p); }

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

  bool is_hinge(std::size_t index) const {
    return std::find(panel_.hinges.begin(), panel_.hinges.end(), static_cast<int>(index)) !=
           panel_.hinges.end();
  }

  std::string colour(std::size_t index) const {
    if (is_hinge(index)) return hex(stage_colour(1));
    if (panel_.joints.empty() && !panel_.motions.empty()) return "#ffffff";
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
    if (joint.end) {
      if (!broken) draw_line(group, px(a(joint.anchor)), px(b(*joint.end)), joint);
      return;
    }
    if (broken) {
      for (const Pose* bank : {&a, &b}) {
        const std::string d = line(px((*bank)(ends[0])), px((*bank)(ends[1])));
        add(group, "path", "d", d, "stroke", paint, "stroke-width", 3 * mark_);
        draw_broken_end(group, px((*bank)(joint.anchor)), paint);
      }
      return;
    }
    if (joint.height > 0) {
      const std::string d = line(between(ends[0]), between(ends[1]));
      add(group, "path", "d", d, "stroke", ink, "stroke-width", 4.6 * mark_);
      add(group, "path", "d", d, "stroke", paint, "stroke-width", 3 * mark_);
    }
    const Point at = between(joint.anchor);
    if (joint.a < 0) draw_support(group, at, joint);
    if (!panel_.motions.empty()) {  // of a mechanism, a mode or a bent shape: only hinges have dots
      if (is_hinge(index)) draw_hinge(group, at, index);
      return;
    }
    const double hinge = panel_.joints.empty() ? 0 : hinge_dot(panel_.joints[index].accumulated_rotation);
    const double smallest = panel_.joints.empty() ? 4.5 : 4;
    add(group, "circle", "cx", at.x, "cy", at.y, "r",
        std::max({smallest * mark_, 20 * mark_ * hinge, hinge * joint.height * scale_}), "fill", paint,
        "stroke", ink, "stroke-width", "1");
  }

  /// A rope is thin, a strut, bar or jack thick; both have dots where they end.
  void draw_line(Node to, Point from, Point end, const PlannedJoint& joint) const {
    const double width = (joint.carries == Carries::tension ? 1.6 : 4) * mark_;
    add(to, "path", "d", fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", from.x, from.y, end.x, end.y), "stroke",
        ink, "stroke-width", width, "fill", "none");
    for (const Point at : {from, end})
      add(to, "circle", "cx", at.x, "cy", at.y, "r", 2.4 * mark_, "fill", ink);
  }

  /// What is kept from turning ends at hatched ground, what springs hold at a zigzag along each of them, all
  /// else at a triangle, which lies on its side where it may move up and down.
  void draw_support(Node to, Point at, const PlannedJoint& joint) const {
    const auto path = [&](const std::string& d, const char* fill) {
      add(to, "path", "d", fmt::format("M{:.1f} {:.1f}", at.x, at.y) + d, "fill", fill, "stroke", ink);
    };
    const auto line = [&](double x, double y, char kind = 'l') {
      return fmt::format("{}{:.1f} {:.1f}", kind, x * mark_, y * mark_);
    };
    if (joint.M > 0) {
      // Below, or beyond the end of what lies there.
      const Point out = px(joint.anchor) - px(plan_.pieces[static_cast<std::size_t>(joint.b)].center);
      const bool lies = std::abs(out.x) > std::abs(out.y);
      const double sense = out.x < 0 ? -1 : 1;
      const auto step = [&](double along, double away, char kind = 'l') {
        return lies ? line(sense * away, along, kind) : line(along, away, kind);
      };
      std::string d = step(-12, 0, 'm') + step(24, 0);
      for (int i = 0; i < 4; ++i) d += step(0, i == 0 ? 0 : -6, 'm') + step(-6, 6);
      path(d, "none");
      return;
    }
    const auto is_spring = [](double cap, double stiffness) { return cap > 0 && stiffness < unlimited; };
    const bool x_spring = is_spring(joint.N, joint.stiffness.N);
    const bool y_spring = is_spring(joint.Q, joint.stiffness.Q);
    if (x_spring)
      path(line(-4, 0) + line(-2, -4) + line(-4, 8) + line(-4, -8) + line(-2, 4) + line(-4, 0) +
               line(0, -6, 'm') + line(0, 12),
           "none");
    if (y_spring)
      path(line(0, 4) + line(-4, 2) + line(8, 4) + line(-8, 4) + line(4, 2) + line(0, 4) + line(-6, 0, 'm') +
               line(12, 0),
           "none");
    if (joint.Q > 0 && !y_spring)
      path(line(-7, 12) + line(14, 0) + "z", still);
    else if (joint.N > 0 && !x_spring)
      path(line(-12, -7) + line(0, 14) + "z", still);
  }

  void draw_hinge(Node to, Point at, std::size_t index) const {
    const double r = (panel_.numbered ? 9 : 6.5) * mark_;
    add(to, "circle", "cx", at.x, "cy", at.y, "r", r, "fill", colour(index), "stroke", ink, "stroke-width",
        "1.4");
    if (!panel_.numbered) return;
    const auto number = std::find(panel_.hinges.begin(), panel_.hinges.end(), static_cast<int>(index)) -
                        panel_.hinges.begin() + 1;
    write(to, std::to_string(number), at.x, at.y + 4 * mark_, "text-anchor", "middle", "font-size",
          12 * mark_);
  }

  void draw_broken_end(Node to, Point at, const std::string& paint) const {
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
  std::vector<Arrow> loads() const {
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

  struct Shaft {
    Point at, tail, tip, along;  // px
  };
  /// From where it acts, or to there where its tip would be outside of the panel.
  Shaft shaft(const Arrow& arrow) const {
    const double force = std::hypot(arrow.force.x, arrow.force.y);
    const Point at = px(Pose(plan_, panel_, arrow.piece)(arrow.at));
    if (force == 0) return {at, at, at, {}};
    const Point along{arrow.force.x / force, -arrow.force.y / force}, shaft = 60 * mark_ * along;
    const bool turned = !frame_.place.holds(at + shaft) && frame_.place.holds(at - shaft);
    return {at, turned ? at - shaft : at, turned ? at : at + shaft, along};
  }

  void avoid(const Arrow& arrow) {
    const Shaft s = shaft(arrow);
    if (arrow.force != Point{}) labels_.avoid(s.tail, s.tip);
    if (arrow.moment != 0)
      for (const double turn : {-1., 1.})
        labels_.avoid(s.at + Point{-18, turn * 18}, s.at + Point{18, turn * 18});
  }

  void draw_arrow(Node to, const Arrow& arrow, bool again) {
    const double force = std::hypot(arrow.force.x, arrow.force.y);
    if (force == 0 && arrow.moment == 0) return;
    const auto [at, tail, tip, along] = shaft(arrow);
    Node group = add(to, "g", "class", "load", "stroke", ink, "stroke-width", "2.4", "fill", "none");
    if (force > 0) {
      const double x = along.x, y = along.y;
      add(group, "path", "d",
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", tail.x, tail.y, tip.x - 6 * x, tip.y - 6 * y));
      add(group, "path", "fill", ink, "stroke", "none", "d",
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", tip.x, tip.y, tip.x - 12 * x - 5 * y,
                      tip.y - 12 * y + 5 * x, tip.x - 12 * x + 5 * y, tip.y - 12 * y - 5 * x));
      // Beside the shaft, above one that lies, to the right of one that stands; else on its other side, or
      // beyond its tip.
      std::vector<Labels::Spot> spots;
      for (const double share : {0.6, 0.85, 0.3, 1.1}) {
        const Point p = tail + share * (tip - tail);
        if (std::abs(x) > std::abs(y)) {
          spots.push_back({p + Point{0, -9}, "middle"});
          spots.push_back({p + Point{0, 20}, "middle"});
        } else {
          spots.push_back({p + Point{10, 4}});
          spots.push_back({p + Point{-10, 4}, "end"});
        }
      }
      spots.push_back({tip + Point{12 * x, 14 * y + 4}, x < -0.3 ? "end" : x > 0.3 ? "start" : "middle"});
      labels_.write(group, quantity(force, "N"), spots, !again);
    }
    if (arrow.moment != 0) {
      // Three quarters of a circle; counter-clockwise is positive.
      const int side = arrow.moment > 0 ? 1 : -1;
      add(group, "path", "d",
          fmt::format("M{:.1f} {:.1f}a18 18 0 1 {} {} 18m{} -5l{} 5l{} 5", at.x + side * 18, at.y,
                      side > 0 ? 0 : 1, -side * 18, -side * 5, side * 5, -side * 5));
      labels_.write(group, quantity(std::abs(arrow.moment), "N m"),
                    {{at + Point{24, -12}},
                     {at + Point{-24, -12}, "end"},
                     {at + Point{24, 22}},
                     {at + Point{-24, 22}, "end"},
                     {at + Point{0, -26}, "middle"}},
                    !again);
    }
  }

  const Plan& plan_;
  const Panel& panel_;
  const MomentScale& moments_;
  const Frame& frame_;
  double scale_, mark_;
  Labels labels_;
};

}  // namespace

void draw_panel(Node to, const Plan& plan, const Panel& panel, const MomentScale& moments,
                const Frame& frame) {
  Artist(plan, panel, moments, frame).draw(to);
}

}  // namespace ductile::picture
