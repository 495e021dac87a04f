#include "ductile/profiles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/curves.h"

namespace ductile::profiles {
namespace {

std::string mm(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%g mm", 1000 * metres);
  return text;
}

struct Requirement {
  const char* name;
  double length;
};
void require_positive(const char* profile, std::initializer_list<Requirement> lengths) {
  std::vector<Problem> problems;
  for (const auto& [name, length] : lengths)
    if (!(length > 0 && std::isfinite(length)))
      problems.push_back(
          {profile, std::string(name) + " is " + mm(length), "it must be finite and above zero"});
  if (!problems.empty()) throw InvalidInput(std::move(problems));
}
void require(bool holds, const char* profile, const std::string& what, const char* remedy) {
  if (!holds) throw InvalidInput({{profile, what, remedy}});
}
void require_radius(const char* profile, const char* name, double radius) {
  require(radius >= 0 && std::isfinite(radius), profile, std::string(name) + " is " + mm(radius),
          "it must be finite and not negative");
}

/// An arc of n ≥ 2 chords, θ each, between two exact points of a circle. Its inner points lie at k times the
/// radius such that it encloses with the centre what the sector does, (2k + (n − 2) k²) sin θ = nθ.
/// Returns the area that lies on the other side of the drawn edge than it should at most, m².
double add_arc(Ring& ring, Point centre, Point start, double sweep, double tolerance) {
  const Point a{start.x - centre.x, start.y - centre.y}, b{-a.y, a.x};
  const double radius = std::hypot(a.x, a.y), two_chords = radius * (1 - std::cos(sweep / 4));
  const std::size_t before = ring.size();
  flatten_arc(ring, centre, a, b, 0, sweep, std::min(tolerance, 0.999 * two_chords));
  const auto n = static_cast<double>(ring.size() - before);
  const double angle = std::abs(sweep) / n, x = n * angle / std::sin(angle);
  const double k = x / (1 + std::sqrt(1 + (n - 2) * x));
  for (std::size_t i = before; i + 1 < ring.size(); ++i)
    ring[i] = {centre.x + k * (ring[i].x - centre.x), centre.y + k * (ring[i].y - centre.y)};
  // The chords' segments: θ − sin θ by its series where it cancels.
  return n * radius * radius / 2 * (angle < 1e-3 ? angle * angle * angle / 6 : angle - std::sin(angle));
}

/// The modulus that moving an area by no more than an arc's extent √2 r can change: W_plastic by that first
/// moment, W_elastic = I/reach by twice it.
double moved(double area, double radius) { return 3 * area * radius; }

struct Corner {
  Point at;
  double radius = 0;  // 0: sharp
};

/// A polygon whose corners are rounded, outward ones and inward ones alike.
Ring rounded(std::span<const Corner> corners, double tolerance, double& modulus_error) {
  Ring ring;
  const auto add = [&](Point p) {
    if (ring.empty() || std::hypot(ring.back().x - p.x, ring.back().y - p.y) > 1e-12) ring.push_back(p);
  };
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point p = corners[i].at;
    const double r = corners[i].radius;
    if (r == 0) {
      add(p);
      continue;
    }
    const auto toward = [&](Point q) {
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      return Point{(q.x - p.x) / length, (q.y - p.y) / length};
    };
    const Point u = toward(corners[(i + n - 1) % n].at), v = toward(corners[(i + 1) % n].at);
    const double turn = std::atan2(u.y * v.x - u.x * v.y, -(u.x * v.x + u.y * v.y));  // of the ring's edges
    const double leg = r * std::tan(std::abs(turn) / 2), side = turn > 0 ? r : -r;
    const Point start{p.x + leg * u.x, p.y + leg * u.y}, centre{start.x + side * u.y, start.y - side * u.x};
    add(start);
    modulus_error += moved(add_arc(ring, centre, start, turn, tolerance), r);
    ring.back() = {p.x + leg * v.x, p.y + leg * v.y};
  }
  if (std::hypot(ring.front().x - ring.back().x, ring.front().y - ring.back().y) <= 1e-12) ring.pop_back();
  return ring;
}

/// Counter-clockwise in four quarters, so that the extreme fibres are drawn exactly.
Ring circle(double radius, double tolerance, double& modulus_error) {
  const Point ends[] = {{radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}, {radius, 0}};
  Ring ring;
  for (int q = 0; q < 4; ++q) {
    modulus_error += moved(add_arc(ring, {0, 0}, ends[q], std::acos(0.0), tolerance), radius);
    ring.back() = ends[q + 1];
  }
  return ring;
}

Ring centred_rectangle(double b, double h) {
  return {{-b / 2, -h / 2}, {b / 2, -h / 2}, {b / 2, h / 2}, {-b / 2, h / 2}};
}

Ring rounded_rectangle(double b, double h, double r, double tolerance, double& modulus_error) {
  std::vector<Corner> corners;
  for (const Point p : centred_rectangle(b, h)) corners.push_back({p, r});
  return rounded(corners, tolerance, modulus_error);
}

void require_flanged(const char* profile, double h, double b, double tw, double tf, double r, int fillets,
                     double tolerance) {
  require_positive(
      profile, {{"height", h}, {"flange width", b}, {"web", tw}, {"flange", tf}, {"tolerance", tolerance}});
  require_radius(profile, "fillet radius", r);
  require(tw + fillets * r <= b && tw < b, profile,
          "web " + mm(tw) + " and fillets of " + mm(r) + " do not fit the flange width " + mm(b),
          "web and fillets must be no wider than the flange");
  require(2 * tf + 2 * r <= h && 2 * tf < h, profile,
          "flanges of " + mm(tf) + " and fillets of " + mm(r) + " do not fit the height " + mm(h),
          "two flanges and two fillets must be no higher than the section");
}

}  // namespace

Profile rectangle(double b, double h) {
  require_positive("rectangle", {{"width", b}, {"height", h}});
  return {{centred_rectangle(b, h)}};
}

Profile box(double b, double h, double tw, double tf) {
  require_positive("box", {{"width", b}, {"height", h}, {"side wall", tw}, {"top and bottom wall", tf}});
  require(2 * tw < b && 2 * tf < h, "box",
          "walls of " + mm(tw) + " and " + mm(tf) + " fill " + mm(b) + " by " + mm(h),
          "two walls must leave a space between them");
  return {{centred_rectangle(b, h), {centred_rectangle(b - 2 * tw, h - 2 * tf)}}};
}

Profile hollow(double b, double h, double t, double outer_radius, double inner_radius, double tolerance) {
  require_positive("hollow section", {{"width", b}, {"height", h}, {"wall", t}, {"tolerance", tolerance}});
  require_radius("hollow section", "outer radius", outer_radius);
  require_radius("hollow section", "inner radius", inner_radius);
  const double least = std::min(b, h);
  require(
      2 * t < least && 2 * outer_radius <= least && 2 * (t + inner_radius) <= least, "hollow section",
      "walls of " + mm(t) + " and corners of " + mm(outer_radius) + " do not fit " + mm(b) + " by " + mm(h),
      "two walls and two corners must be no wider than the section");
  Profile profile;
  const double fine = std::min(tolerance, t / 4);  // the walls stay apart
  profile.outline.outer = rounded_rectangle(b, h, outer_radius, fine, profile.modulus_error);
  profile.outline.holes = {
      rounded_rectangle(b - 2 * t, h - 2 * t, inner_radius, fine, profile.modulus_error)};
  return profile;
}

Profile disc(double diameter, double tolerance) {
  require_positive("disc", {{"diameter", diameter}, {"tolerance", tolerance}});
  Profile profile;
  profile.outline.outer = circle(diameter / 2, tolerance, profile.modulus_error);
  return profile;
}

Profile tube(double diameter, double thickness, double tolerance) {
  require_positive("tube", {{"diameter", diameter}, {"wall", thickness}, {"tolerance", tolerance}});
  require(2 * thickness < diameter, "tube",
          "a wall of " + mm(thickness) + " fills a diameter of " + mm(diameter),
          "the wall must be thinner than the radius");
  Profile profile;
  const double fine = std::min(tolerance, thickness / 4);  // the circles stay apart
  profile.outline.outer = circle(diameter / 2, fine, profile.modulus_error);
  profile.outline.holes = {circle(diameter / 2 - thickness, fine, profile.modulus_error)};
  return profile;
}

Profile i_section(double h, double b, double tw, double tf, double r, double tolerance) {
  require_flanged("I-section", h, b, tw, tf, r, 2, tolerance);
  const double H = h / 2, B = b / 2, w = tw / 2, y = h / 2 - tf;
  const Corner corners[] = {{{B, H}},   {{-B, H}}, {{-B, y}}, {{-w, y}, r}, {{-w, -y}, r}, {{-B, -y}},
                            {{-B, -H}}, {{B, -H}}, {{B, -y}}, {{w, -y}, r}, {{w, y}, r},   {{B, y}}};
  Profile profile;
  profile.outline.outer = rounded(corners, tolerance, profile.modulus_error);
  return profile;
}

Profile channel(double h, double b, double tw, double tf, double r, double tolerance) {
  require_flanged("channel", h, b, tw, tf, r, 1, tolerance);
  const double H = h / 2, y = h / 2 - tf;
  const Corner corners[] = {{{0, H}},      {{0, -H}},    {{b, -H}}, {{b, -y}},
                            {{tw, -y}, r}, {{tw, y}, r}, {{b, y}},  {{b, H}}};
  Profile profile;
  profile.outline.outer = rounded(corners, tolerance, profile.modulus_error);
  return profile;
}

Profile tapered_channel(double h, double b, double tw, double tf, double slope, double u, double root_radius,
                        double toe_radius, double tolerance) {
  require_flanged("channel", h, b, tw, tf, root_radius, 1, tolerance);
  require_radius("channel", "toe radius", toe_radius);
  const double at_web = tf + slope * (b - u - tw), at_tip = tf - slope * u;
  require(
      slope >= 0 && slope < 1 && u >= 0 && u <= b - tw && toe_radius <= at_tip &&
          tw + root_radius + toe_radius <= b && 2 * (at_web + root_radius) <= h,
      "channel",
      "flanges of " + mm(tf) + ", " + mm(u) + " from their tips, with a slope of " + std::to_string(slope) +
          " and radii of " + mm(root_radius) + " and " + mm(toe_radius) + " do not fit " + mm(h) + " by " +
          mm(b),
      "the tips must be thicker than their radius, the flanges at the web must leave room for the fillets");
  const double H = h / 2, root = H - at_web, tip = H - at_tip;
  const Corner corners[] = {{{0, H}},
                            {{0, -H}},
                            {{b, -H}},
                            {{b, -tip}, toe_radius},
                            {{tw, -root}, root_radius},
                            {{tw, root}, root_radius},
                            {{b, tip}, toe_radius},
                            {{b, H}}};
  Profile profile;
  profile.outline.outer = rounded(corners, tolerance, profile.modulus_error);
  return profile;
}

Profile angle(double h, double b, double t, double root_radius, double toe_radius, double tolerance) {
  require_positive("angle", {{"leg", h}, {"other leg", b}, {"thickness", t}, {"tolerance", tolerance}});
  require_radius("angle", "root radius", root_radius);
  require_radius("angle", "toe radius", toe_radius);
  require(t + root_radius + toe_radius <= std::min(h, b) && toe_radius <= t && t < std::min(h, b), "angle",
          "radii of " + mm(root_radius) + " and " + mm(toe_radius) + " do not fit legs of " + mm(h) +
              " and " + mm(b) + ", " + mm(t) + " thick",
          "thickness, root and toe must be no longer than the shorter leg, the toe no thicker than it");
  const Corner corners[] = {
      {{0, 0}}, {{b, 0}}, {{b, t}, toe_radius}, {{t, t}, root_radius}, {{t, h}, toe_radius}, {{0, h}}};
  Profile profile;
  profile.outline.outer = rounded(corners, tolerance, profile.modulus_error);
  return profile;
}

}  // namespace ductile::profiles
