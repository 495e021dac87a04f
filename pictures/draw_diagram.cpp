#include "draw_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ductile/plane.h"
#include "ductile/strips.h"

namespace ductile::picture {
namespace {

using diagram::Station, diagram::Strip, diagram::strips;

// Ordinates: tension, and moments; compression.
constexpr Colour positive{0x2b, 0x7b, 0xba}, negative{0xd9, 0x6a, 0x1e};

class DiagramArtist {
 public:
  DiagramArtist(const Plan& plan, const Panel& panel, const Frame& frame, Labels& labels)
      : plan_(plan), panel_(panel), frame_(frame), labels_(labels) {}

  void draw(Node to) {
    const std::vector<Strip> all = strips(plan_, panel_.joints, panel_.gone);
    double largest = 0;
    for (const Strip& strip : all)
      for (const Station& station : strip.stations) largest = std::max(largest, std::abs(value(station)));
    const double height =  // px per unit
        largest > 0
            ? ordinate_share * frame_.scale * std::max(frame_.view.width(), frame_.view.height()) / largest
            : 0;
    Node group = add(to, "g", "class", "diagram", "stroke-linejoin", "round");
    for (const Strip& strip : all) draw_strip(group, strip, height);
    label_extremes(group, all, height, largest);
  }

 private:
  double value(const Station& station) const {
    return *panel_.diagram == axial ? station.N : *panel_.diagram == shear ? station.Q : station.M;
  }
  /// Toward positive ordinates: moments on the side in tension, others above, and left of what stands.
  Point aside(const Strip& strip) const {
    const Point n = left(strip.axis);
    if (*panel_.diagram == rotation) return -n;
    return n.y > 1e-9 || (n.y > -1e-9 && n.x < 0) ? n : -n;
  }

  /// Parts of one sign, each a polygon between the line of the strip and its ordinates.
  void draw_strip(Node to, const Strip& strip, double height) const {
    const Point n{aside(strip).x, -aside(strip).y};
    Node group = add(to, "g", "class", "strip");
    hover(group, plan_.pieces[static_cast<std::size_t>(strip.piece)].name);
    const auto part = [&](const std::vector<std::pair<Point, double>>& ordinates) {
      double most = 0;
      for (const auto& [at, v] : ordinates)
        if (std::abs(v) > std::abs(most)) most = v;
      std::string d;
      for (const auto& [at, v] : ordinates) {
        const Point tip = at + height * v * n;
        d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", tip.x, tip.y);
      }
      for (auto it = ordinates.rbegin(); it != ordinates.rend(); ++it)
        d += fmt::format("L{:.1f} {:.1f}", it->first.x, it->first.y);
      const std::string paint = hex(*panel_.diagram == rotation || most >= 0 ? positive : negative);
      add(group, "path", "d", d + "Z", "fill", paint, "fill-opacity", "0.35", "stroke", paint);
    };
    std::vector<std::pair<Point, double>> open;
    for (const Station& station : strip.stations) {
      const Point at = frame_.px(station.at);
      const double v = value(station);
      if (!open.empty() && open.back().second * v < 0) {
        const auto [before, was] = open.back();
        const std::pair zero{before + was / (was - v) * (at - before), 0.};
        open.push_back(zero);
        part(open);
        open = {zero};
      }
      open.emplace_back(at, v);
    }
    if (open.size() > 1) part(open);
  }

  /// Each body's largest and smallest ordinate.
  void label_extremes(Node to, const std::vector<Strip>& all, double height, double largest) {
    struct Extreme {
      double v;
      Point at, n;
    };
    std::vector<Extreme> extremes;
    for (std::size_t body = 0; body < plan_.bodies.size(); ++body)
      for (const double sign : {1., -1.}) {
        Extreme most{0, {}, {}};
        for (const Strip& strip : all) {
          if (plan_.pieces[static_cast<std::size_t>(strip.piece)].body != static_cast<int>(body)) continue;
          const Point n{aside(strip).x, -aside(strip).y};
          // Signs of moments are sides, which a strip's direction does not decide.
          const double own = *panel_.diagram == rotation && (n.y > 1e-9 || (n.y > -1e-9 && n.x > 0)) ? -1 : 1;
          for (const Station& station : strip.stations)
            if (const double v = value(station); own * sign * v > std::abs(most.v) * (1 + 1e-6))
              most = {v, frame_.px(station.at), n};
        }
        if (std::abs(most.v) > 0.02 * largest) extremes.push_back(most);
      }
    std::stable_sort(extremes.begin(), extremes.end(),
                     [](const Extreme& a, const Extreme& b) { return std::abs(a.v) > std::abs(b.v); });
    const bool signs = *panel_.diagram != rotation;
    for (const Extreme& e : extremes) {
      const Point side = e.v > 0 ? e.n : -e.n, tip = e.at + height * e.v * e.n;
      std::vector<Labels::Spot> spots;
      for (const double off : {6., 20., 34.}) {
        const Point p = tip + off * side + Point{0, 4 + 5 * side.y};
        const char* anchor = side.x > 0.5 ? "start" : side.x < -0.5 ? "end" : "middle";
        for (const double aside : {0., 18., -18.}) spots.push_back({p + aside * left(side), anchor});
      }
      for (const double off : {-8., -22.}) spots.push_back({tip + off * side + Point{0, 4}, "middle"});
      labels_.write(to, quantity(signs ? e.v : std::abs(e.v), *panel_.diagram == rotation ? "N m" : "N"),
                    spots, false);
    }
  }

  const Plan& plan_;
  const Panel& panel_;
  const Frame& frame_;
  Labels& labels_;
};

}  // namespace

void draw_diagram(Node to, const Plan& plan, const Panel& panel, const Frame& frame, Labels& labels) {
  DiagramArtist(plan, panel, frame, labels).draw(to);
}

}  // namespace ductile::picture
