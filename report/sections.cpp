// Sections: error of the plastic moment against time, of fibres, of clipping and bisection, of ours, and of
// 113 bits.
#include "ductile/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "ductile/clock.h"
#include "ductile/profiles.h"
#include "oracle.h"

namespace ductile::report {
namespace {

constexpr Material steel{.yield_stress = 355e6, .youngs_modulus = 210e9};
constexpr Point up{0.6, 0.8};

/// A ragged pear of n vertices, all seen from its centre: no symmetry, centroid and neutral axis apart.
Ring pear(int n, double size = 0.1, double away = 0) {
  std::mt19937 random(static_cast<unsigned>(n));
  std::uniform_real_distribution<double> uniform(0, 1);
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.8 * uniform(random)) / n;
    const double r = 1 + 0.4 * std::cos(angle) + 0.3 * std::sin(2 * angle) + 0.1 * uniform(random);
    ring.push_back({away + size * (3 + 1.5 * r * std::cos(angle)), away + size * (-2 + r * std::sin(angle))});
  }
  return ring;
}

/// Along d and across it.
struct Vertex {
  double s, w;
};
std::vector<Vertex> turned(const Ring& ring) {
  std::vector<Vertex> out;
  for (const auto& p : ring) out.push_back({up.x * p.x + up.y * p.y, up.x * p.y - up.y * p.x});
  return out;
}

/// Fibres: strips across d, their widths where their middles cut the outline; the neutral axis halves their
/// area.
double by_fibres(const std::vector<Vertex>& ring, int fibres, std::vector<double>& widths) {
  double low = ring[0].s, high = ring[0].s;
  for (const auto& v : ring) low = std::min(low, v.s), high = std::max(high, v.s);
  const double t = (high - low) / fibres;
  widths.assign(static_cast<std::size_t>(fibres), 0);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vertex a = ring[i], b = ring[(i + 1) % ring.size()];
    const double from = std::min(a.s, b.s), to = std::max(a.s, b.s), sign = a.s < b.s ? 1 : -1;
    for (auto k = static_cast<int>(std::ceil((from - low) / t - 0.5)); k < fibres && low + (k + 0.5) * t < to;
         ++k) {
      const double s = low + (k + 0.5) * t;
      widths[static_cast<std::size_t>(k)] += sign * (a.w + (b.w - a.w) * (s - a.s) / (b.s - a.s));
    }
  }
  double area = 0, below = 0, moment = 0;
  for (double& w : widths) area += w = std::abs(w);
  std::size_t k = 0;
  for (; k < widths.size() && below + widths[k] < area / 2; ++k) below += widths[k];
  const double pna = low + (static_cast<double>(k) + (area / 2 - below) / widths[k]) * t;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    moment += widths[i] * t * std::abs(low + (static_cast<double>(i) + 0.5) * t - pna);
  }
  return moment * steel.yield_stress;
}

struct Part {
  double area, first;  // ∫dA and ∫s dA about s0
};
Part part(const std::vector<Vertex>& polygon, double s0) {
  Part sum{0, 0};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double cross = (p.s - s0) * q.w - (q.s - s0) * p.w;
    sum.area += cross / 2;
    sum.first += cross * (p.s + q.s - 2 * s0) / 6;
  }
  return sum.area < 0 ? Part{-sum.area, -sum.first} : sum;
}
void clip(const std::vector<Vertex>& polygon, double s0, int sign, std::vector<Vertex>& out) {
  out.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double ua = sign * (a.s - s0), ub = sign * (b.s - s0);
    if (ua >= 0) out.push_back(a);
    if ((ua > 0) != (ub > 0) && ua != 0 && ub != 0) out.push_back({s0, a.w + (b.w - a.w) * (ua / (ua - ub))});
  }
}

/// The text book: clip by a trial line, bisect until both parts are equal, then their first moments.
double by_clipping(const std::vector<Vertex>& ring, int rounds, std::vector<Vertex>& a,
                   std::vector<Vertex>& b) {
  double low = ring[0].s, high = ring[0].s;
  for (const auto& v : ring) low = std::min(low, v.s), high = std::max(high, v.s);
  for (int i = 0;; ++i) {
    const double s0 = (low + high) / 2;
    clip(ring, s0, 1, a);
    clip(ring, s0, -1, b);
    const Part above = part(a, s0), below = part(b, s0);
    if (i == rounds) return steel.yield_stress * (above.first - below.first);
    (above.area > below.area ? low : high) = s0;
  }
}

double exact(const Ring& ring) {
  const std::vector<Region> regions{{{ring, {}}, steel}};
  const oracle::Section section(regions, up);
  const oracle::Real pna = section.neutral_axis(0, 1);
  return static_cast<double>(section.forces(pna, pna, 1).second);
}

/// Time against that of a peer, each called in turn.
template <class F, class G>
Spread time_against(F&& ours, G&& peer, int pairs) {
  const auto calls = [](auto& f) {
    int n = 1;
    while (n < (1 << 20) && seconds([&] {
                              for (int i = 0; i < n; ++i) f();
                            }) < 5e-5)
      n *= 2;
    return n;
  };
  const int n = calls(ours), m = calls(peer);
  std::vector<double> ratios;
  for (int i = 0; i < pairs; ++i) {
    const double a = seconds([&] {
                       for (int k = 0; k < n; ++k) ours();
                     }) /
                     n;
    const double b = seconds([&] {
                       for (int k = 0; k < m; ++k) peer();
                     }) /
                     m;
    ratios.push_back(a / b);
  }
  return spread(std::move(ratios), 0.05);
}

volatile double kept;  // so that no call is left out

double relative(double value, double reference) { return std::abs(value / reference - 1); }

Result run_sections(const Context& context) {
  const auto vertices =
      context.quick ? std::vector<int>{4, 64} : std::vector<int>{4, 16, 64, 256, 1024, 4096};
  const auto fibres =
      context.quick ? std::vector<int>{10, 1000} : std::vector<int>{10, 100, 1000, 10000, 100000};
  const auto rounds = context.quick ? std::vector<int>{10, 50} : std::vector<int>{5, 10, 20, 30, 40, 50};
  const int pairs = context.quick ? 11 : 41;
  Result result;
  Table table{"moments",
              "Plastic moment, every way",
              {{"vertices"},
               {"way"},
               {"relative error"},
               {"time against the edge formulas", true},
               {"from", true},
               {"to", true},
               {"time [us]", true}},
              {}};
  double worst = 0;
  int on = 0;
  double done = 0;
  const double all = static_cast<double>(vertices.size() * (fibres.size() + rounds.size() + 2));
  for (const int n : vertices) {
    const Ring ring = pear(n);
    const std::vector<Vertex> t = turned(ring);
    const double reference = exact(ring);
    const Section section({ring, {}}, steel);
    const auto ours = [&] { kept = section.capacities(up).M; };
    std::vector<double> times;
    times.reserve(41);
    for (int i = 0; i < 41; ++i)
      times.push_back(1e4 * seconds([&] {
                        for (int k = 0; k < 100; ++k) ours();
                      }));
    const double ours_us = median(times);
    Figure f{.name = fmt::format("moment-{}", n),
             .group = "sections-moment",
             .tab = fmt::format("{} vertices", n),
             .first = n == 64,
             .title = fmt::format("Plastic moment of {} vertices", n),
             .x = {"time [µs]", true},
             .y = {"relative error", true},
             .floor = 1e-16};
    const auto add = [&](const char* family, const std::string& way, double value, auto&& call, bool marked) {
      const Spread timing = time_against(call, ours, pairs);
      auto at = std::find_if(f.series.begin(), f.series.end(), [&](auto& s) { return s.name == family; });
      if (at == f.series.end()) at = f.series.insert(f.series.end(), {.name = family, .look = family});
      const double error = relative(value, reference);
      const double us = timing.median * ours_us;
      at->x.push_back(us), at->low.push_back(timing.low * ours_us), at->high.push_back(timing.high * ours_us);
      at->y.push_back(error);
      at->told.push_back(way);
      at->marked.push_back(marked);
      table.rows.push_back({n, way, error, timing.median, timing.low, timing.high, us});
      context.progress(++done / all);
      return std::pair(error, us);
    };
    const auto mine =
        add("edge formulas (ductile)", "edge formulas (ductile)", section.capacities(up).M, ours, true);
    worst = std::max(worst, mine.first);
    bool front = true;
    std::vector<double> widths;
    for (const int k : fibres) {
      const auto [e, us] = add(
          "fibres", fmt::format("{} fibres", k), by_fibres(t, k, widths),
          [&] { kept = by_fibres(t, k, widths); }, false);
      front &= !(e <= mine.first && us <= mine.second);
    }
    std::vector<Vertex> a, b;
    for (const int k : rounds) {
      const auto [e, us] = add(
          "clip and bisect", fmt::format("{} bisections", k), by_clipping(t, k, a, b),
          [&] { kept = by_clipping(t, k, a, b); }, false);
      front &= !(e <= mine.first && us <= mine.second);
    }
    add(
        "113 bits (the reference)", "113 bits, clip and false position", reference,
        [&] { kept = exact(ring); }, false);
    on += front ? 1 : 0;
    result.figures.push_back(std::move(f));
  }
  result.tables.push_back(std::move(table));

  // Distance from the origin, and size: the outline is that of the moved coordinates, so the error is all
  // arithmetic.
  Figure placed{.name = "sections-distance",
                .title = "Far from the origin: a section of 0.3 m, 64 vertices",
                .x = {"distance [m]", true},
                .y = {"relative error", true},
                .floor = 1e-17};
  Figure sized{.name = "sections-size",
               .title = "Tiny and huge: 64 vertices at the origin",
               .x = {"size [m]", true},
               .y = {"relative error", true},
               .floor = 1e-17};
  Table arithmetic{"arithmetic",
                   "Distance and size",
                   {{"distance [m]"}, {"size [m]"}, {"ductile"}, {"clip and bisect"}, {"fibres (1000)"}},
                   {}};
  const auto place = [&](Figure& figure, double x, double size, double away) {
    const Ring ring = pear(64, size, away);
    const std::vector<Vertex> t = turned(ring);
    const double reference = exact(ring);
    std::vector<Vertex> a, b;
    std::vector<double> widths;
    const std::array values{relative(Section({ring, {}}, steel).capacities(up).M, reference),
                            relative(by_clipping(t, 50, a, b), reference),
                            relative(by_fibres(t, 1000, widths), reference)};
    const std::array names{"edge formulas (ductile)", "clip and bisect", "fibres"};
    figure.series.resize(3);
    for (std::size_t i = 0; i < 3; ++i) {
      Series& s = figure.series[i];
      s.name = s.look = names[i];
      s.x.push_back(x), s.y.push_back(values[i]), s.marked.push_back(false);
    }
    worst = std::max(worst, values[0]);
    arithmetic.rows.push_back({away, size, values[0], values[1], values[2]});
  };
  for (const double away : {1., 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}) place(placed, away, 0.1, away);
  double size = 1e-6;
  for (int i = 0; i < 10; ++i, size *= 10) place(sized, size, size, 0);
  result.figures.push_back(std::move(placed));
  result.figures.push_back(std::move(sized));
  result.tables.push_back(std::move(arithmetic));

  // Curves drawn as polylines: within the bound that comes with the profile, and of second order in the
  // chords.
  Figure curve{.name = "sections-tolerance",
               .title = "A disc of 0.2 m as a polygon: plastic modulus",
               .x = {"tolerance of the chords [m]", true},
               .y = {"relative error", true}};
  Series measured{.name = "error against D³/6", .look = "edge formulas (ductile)"},
      bound{.name = "bound that the profile states", .look = "bound"};
  Table curves{"curves",
               "Disc of 0.2 m: tolerance of the chords",
               {{"tolerance [m]"}, {"vertices"}, {"relative error of W_plastic"}, {"stated bound"}},
               {}};
  bool within = true;
  double tolerance = 1e-2;
  for (int i = 0; i < 7; ++i, tolerance /= 10) {
    const Profile disc = profiles::disc(0.2, tolerance);
    const double W = 0.2 * 0.2 * 0.2 / 6,
                 error = relative(Section(disc.outline, steel).elastic({0, 1}).W_plastic, W);
    measured.x.push_back(tolerance), measured.y.push_back(error),
        measured.marked.push_back(tolerance == 1e-5);
    bound.x.push_back(tolerance), bound.y.push_back(disc.modulus_error / W), bound.marked.push_back(false);
    within &= error * W <= disc.modulus_error;
    curves.rows.push_back({tolerance, disc.outline.outer.size(), error, disc.modulus_error / W});
  }
  curve.series = {measured, bound};
  result.figures.push_back(std::move(curve));
  result.tables.push_back(std::move(curves));

  result.text = {
      "The plastic moment of a ragged outline about a slanting direction, four ways: strips of fibres, "
      "clipping by a trial line "
      "with bisection in double, ductile's closed forms over the edges, and the reference in 113 bits "
      "(clipping and false "
      "position, nothing shared with ductile but the coordinates). Each is timed in turn with ductile's; "
      "fibres and clipping "
      "are given the outline already turned and no memory to allocate."};
  result.summary = fmt::format(
      "Plastic moments of polygons are within {:.1e} of a reference in 113 bits, at 4 to 4096 vertices.",
      worst);
  result.claims = {
      {"Within 1e-13 of the reference, 4 to 4096 vertices, up to 1e8 m away, 1 µm to 1 km in size",
       fmt::format("the worst {:.1e}", worst), worst <= 1e-13, false},
      {"Edge formulas are on the front: nothing else in double is as good and as cheap",
       fmt::format("{} of {} pictures", on, vertices.size()), on == static_cast<int>(vertices.size()), true},
      {"A drawn disc is within the bound that its profile states",
       fmt::format("at every tolerance from 1e-2 to 1e-8 m: {}", within ? "yes" : "no"), within, false}};
  return result;
}

}  // namespace

const Case sections{"sections", "Sections: error against time", run_sections};

}  // namespace ductile::report
