#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "ductile/picture.h"
#include "ductile/plane.h"
#include "svg.h"

namespace ductile {
namespace {

using namespace picture;

constexpr Colour tension{0x2b, 0x7b, 0xba}, compression{0xe0, 0x8a, 0x1e};
constexpr double legend_height = 52, side = 420;  // px, of both squares

/// Towards white, as the stress is below the greatest one in the section.
std::string shade(Colour c, double stress, double greatest) {
  const double strength = 0.18 + 0.82 * stress / greatest;
  const auto mix = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(std::lround(255 + strength * (value - 255)));
  };
  return hex({mix(c.red), mix(c.green), mix(c.blue)});
}

/// The section at its plastic moment: every fibre flows, one side of the neutral axis in tension, the other
/// in compression.
class SectionArtist {
 public:
  SectionArtist(const Section& section, Point direction, Point corner)
      : section_(section), direction_(direction), corner_(corner) {
    for (const Region& region : section.regions())
      for (const Point& p : region.outline.outer) box_.add(p);
    scale_ = (side - 90) / std::max(box_.width(), box_.height());
  }

  double scale() const { return scale_; }

  void draw(Node to, Node defs) const {
    add(to, "rect", "x", corner_.x, "y", corner_.y, "width", side, "height", side, "rx", "4", "fill", ground);
    const Capacities c = section_.capacities(direction_);
    double greatest = 0;
    for (const Region& region : section_.regions())
      greatest = std::max({greatest, region.material.yield_stress, region.material.compression()});
    for (const bool pulled : {true, false}) {
      const char* id = pulled ? "tension" : "compression";
      half_plane(defs, id, c.pna, pulled ? 1 : -1);
      Node half = add(to, "g", "class", id, "clip-path", fmt::format("url(#{})", id));
      for (const Region& region : section_.regions()) {
        const double stress = pulled ? region.material.yield_stress : region.material.compression();
        add(half, "path", "d", outline(region.outline), "fill-rule", "evenodd", "fill",
            shade(pulled ? tension : compression, stress, greatest));
      }
    }
    for (const Region& region : section_.regions())
      add(to, "path", "d", outline(region.outline), "fill", "none", "stroke", ink, "stroke-width", "1.2");
    neutral_axis(to, c.pna);
    const Point centroid = px(section_.centroid());
    Node mark = add(to, "g", "stroke", ink, "stroke-width", "1.6");
    hover(mark, "centroid");
    add(mark, "circle", "cx", centroid.x, "cy", centroid.y, "r", "4.5", "fill", "#ffffff");
    add(mark, "path", "d",
        fmt::format("M{:.1f} {:.1f}h13M{:.1f} {:.1f}v13", centroid.x - 6.5, centroid.y, centroid.x,
                    centroid.y - 6.5));
  }

 private:
  Point px(Point p) const {
    return {corner_.x + side / 2 + (p.x - (box_.x0 + box_.x1) / 2) * scale_,
            corner_.y + side / 2 - (p.y - (box_.y0 + box_.y1) / 2) * scale_};
  }

  std::string outline(const Outline& outline) const {
    std::string d;
    const auto ring = [&](const Ring& points) {
      char command = 'M';
      for (const Point& p : points) {
        const Point at = px(p);
        d += fmt::format("{}{:.1f} {:.1f}", command, at.x, at.y);
        command = 'L';
      }
      d += 'Z';
    };
    ring(outline.outer);
    for (const Ring& hole : outline.holes) ring(hole);
    return d;
  }

  /// On the neutral axis, `along` px from the foot of the centre of the drawing.
  Point on_axis(double pna, double along) const {
    const Point centre{(box_.x0 + box_.x1) / 2, (box_.y0 + box_.y1) / 2};
    const double off = pna - dot(centre, direction_);
    const Point foot = px({centre.x + off * direction_.x, centre.y + off * direction_.y});
    return {foot.x - along * direction_.y, foot.y - along * direction_.x};
  }

  /// Where s > pna (`sign` 1) or s < pna.
  void half_plane(Node defs, const char* id, double pna, int sign) const {
    const Point a = on_axis(pna, -2 * side), b = on_axis(pna, 2 * side);
    const double x = 4 * side * sign * direction_.x, y = -4 * side * sign * direction_.y;
    add(add(defs, "clipPath", "id", id), "path", "d",
        fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}l{:.1f} {:.1f}L{:.1f} {:.1f}Z", a.x, a.y, b.x, b.y, x, y,
                    a.x + x, a.y + y));
  }

  void neutral_axis(Node to, double pna) const {
    const double reach = side / 2 - 14;
    const Point a = on_axis(pna, -reach), b = on_axis(pna, reach);
    Node group = add(to, "g", "class", "pna");
    hover(group, fmt::format("plastic neutral axis at {:.6g} m", pna));
    add(group, "path", "d", fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x, a.y, b.x, b.y), "stroke", ink,
        "stroke-width", "1.6", "stroke-dasharray", "8 4");
    // Beside its higher end, on the side of tension.
    const Point end = a.y < b.y ? a : b;
    const bool left = end.x < corner_.x + side / 2;
    write(group, "neutral axis", std::clamp(end.x, corner_.x + 10, corner_.x + side - 10) + 8 * direction_.x,
          end.y - 8 * direction_.y - (direction_.y < 0 ? -8 : 0), "text-anchor", left ? "start" : "end",
          "stroke", ground, "stroke-width", "3", "paint-order", "stroke");
  }

  const Section& section_;
  Point direction_, corner_;
  Box box_;
  double scale_ = 1;
};

/// The N–M curve about the centroid: M to the right, tension up.
void draw_interaction(Node to, const Section& section, Point direction, Point corner) {
  add(to, "rect", "x", corner.x, "y", corner.y, "width", side, "height", side, "rx", "4", "fill", ground);
  const auto curve = section.interaction(direction, dot(section.centroid(), direction));
  const Capacities c = section.capacities(direction);
  Box box;
  for (const Interaction& at : curve) box.add(Point{at.M, at.N});
  constexpr double room = 64;
  const auto px = [&](double M, double N) {
    return Point{corner.x + room + (M - box.x0) / box.width() * (side - 2 * room),
                 corner.y + side - room - (N - box.y0) / box.height() * (side - 2 * room)};
  };
  std::string d;
  for (const Interaction& at : curve) {
    const Point p = px(at.M, at.N);
    d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? 'M' : 'L', p.x, p.y);
  }
  add(to, "path", "class", "interaction", "d", d + "Z", "fill", "#dde8f2", "stroke", hex(tension),
      "stroke-width", "2.2", "stroke-linejoin", "round");
  const Point origin = px(0, 0);
  add(to, "path", "stroke", quiet, "d",
      fmt::format("M{:.1f} {:.1f}H{:.1f}M{:.1f} {:.1f}V{:.1f}", corner.x + 14, origin.y, corner.x + side - 14,
                  origin.x, corner.y + side - 14, corner.y + 14));
  write(to, "M", corner.x + side - 16, origin.y - 7, "text-anchor", "end", "fill", quiet);
  write(to, "N", origin.x + 7, corner.y + 24, "fill", quiet);
  const auto value = [&](double M, double N, const std::string& words, double dx, double dy,
                         const char* anchor) {
    const Point p = px(M, N);
    add(to, "circle", "cx", p.x, "cy", p.y, "r", "4", "fill", ink);
    write(to, words, p.x + dx, p.y + dy, "text-anchor", anchor, "stroke", ground, "stroke-width", "3",
          "paint-order", "stroke");
  };
  // N about the centroid comes with a moment where the stresses differ.
  double M_at_N = 0, M_at_Nc = 0;
  for (const Interaction& at : curve) {
    if (at.N == box.y1) M_at_N = at.M;
    if (at.N == box.y0) M_at_Nc = at.M;
  }
  value(M_at_N, c.N, quantity(c.N, "N"), M_at_N < 0 ? -9 : 9, -8, M_at_N < 0 ? "end" : "start");
  value(M_at_Nc, -c.Nc, quantity(-c.Nc, "N"), M_at_Nc < 0 ? -9 : 9, 18, M_at_Nc < 0 ? "end" : "start");
  value(c.M, 0, quantity(c.M, "N m"), -9, 18, "end");
  value(-c.M_reverse, 0, quantity(-c.M_reverse, "N m"), 9, -9, "start");
}

}  // namespace

std::string section_svg(const Section& section, Point direction, const std::string& title) {
  const double length = std::hypot(direction.x, direction.y);
  const Point d{direction.x / length, direction.y / length};
  const double width = 2 * margin + 2 * side + 20, height = header + side + legend_height;
  const Elastic elastic = section.elastic(d);
  const std::string words = fmt::format("{} region{}, {:.4g} m²{}", section.regions().size(),
                                        section.regions().size() == 1 ? "" : "s", section.area(),
                                        std::isfinite(elastic.shape_factor) && elastic.shape_factor > 0
                                            ? fmt::format(", shape factor {:.3g}", elastic.shape_factor)
                                            : "");
  pugi::xml_document document;
  Node svg = page(document, width, height, title, words);
  Node defs = add(svg, "defs");
  const SectionArtist artist(section, d, {margin, header});
  artist.draw(svg, defs);
  draw_interaction(svg, section, d, {margin + side + 20, header});
  const double foot = header + side + 28;
  double x = margin;
  for (const auto& [colour, name] :
       {std::pair{tension, "flows in tension"}, {compression, "in compression"}}) {
    add(svg, "rect", "x", x, "y", foot - 11, "width", "13", "height", "13", "rx", "2", "fill", hex(colour));
    write(svg, name, x + 20, foot);
    x += 160;
  }
  scale_bar(svg, artist.scale(), {margin + side, foot - 6}, 0.2 * side);
  write(svg, "axial force and moment carried together", margin + side + 20, foot);
  return text_of(document);
}

}  // namespace ductile
