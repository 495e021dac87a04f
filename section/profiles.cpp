#include "ductile/profiles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "ductile/curves.h"

namespace ductile::profiles {
namespace {

constexpr double quarter = std::numbers::pi / 2;

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

/// Four quarter arcs, so that the extreme fibres are drawn exactly.
Ring circle(double radius, double tolerance) {
  Ring ring;
  for (int q = 0; q < 4; ++q) {
    flatten_arc(ring, {0, 0}, {radius, 0}, {0, radius}, q * quarter, quarter, tolerance);
    ring.back() = {q == 1 ? -radius : q == 3 ? radius : 0, q == 0 ? radius : q == 2 ? -radius : 0};
  }
  return ring;
}

/// The circular segments between a quarter arc of n chords and those chords.
double segments(double radius, std::size_t n) {
  const double angle = quarter / static_cast<double>(n);
  // θ − sin θ by its series where it cancels
  const double cap = angle < 1e-3 ? angle * angle * angle / 6 : angle - std::sin(angle);
  return static_cast<double>(n) * radius * radius / 2 * cap;
}

/// With both axes of symmetry kept and the extreme fibres exact, an area δ that moves in or out at most
/// `reach` from the axis changes W_plastic by δ·reach at most, and W_elastic = I/reach likewise.
Profile drawn(Outline outline, double area_error, double reach) {
  return {std::move(outline), area_error, area_error * reach};
}

Ring centred_rectangle(double b, double h) {
  return {{-b / 2, -h / 2}, {b / 2, -h / 2}, {b / 2, h / 2}, {-b / 2, h / 2}};
}

// h, b, tw, tf, r in mm.
constexpr Rolled table[] = {
    {"IPE 80", 80, 46, 3.8, 5.2, 5},       {"IPE 100", 100, 55, 4.1, 5.7, 7},
    {"IPE 120", 120, 64, 4.4, 6.3, 7},     {"IPE 140", 140, 73, 4.7, 6.9, 7},
    {"IPE 160", 160, 82, 5, 7.4, 9},       {"IPE 180", 180, 91, 5.3, 8, 9},
    {"IPE 200", 200, 100, 5.6, 8.5, 12},   {"IPE 220", 220, 110, 5.9, 9.2, 12},
    {"IPE 240", 240, 120, 6.2, 9.8, 15},   {"IPE 270", 270, 135, 6.6, 10.2, 15},
    {"IPE 300", 300, 150, 7.1, 10.7, 15},  {"IPE 330", 330, 160, 7.5, 11.5, 18},
    {"IPE 360", 360, 170, 8, 12.7, 18},    {"IPE 400", 400, 180, 8.6, 13.5, 21},
    {"IPE 450", 450, 190, 9.4, 14.6, 21},  {"IPE 500", 500, 200, 10.2, 16, 21},
    {"IPE 550", 550, 210, 11.1, 17.2, 24}, {"IPE 600", 600, 220, 12, 19, 24},
    {"HEA 100", 96, 100, 5, 8, 12},        {"HEA 120", 114, 120, 5, 8, 12},
    {"HEA 140", 133, 140, 5.5, 8.5, 12},   {"HEA 160", 152, 160, 6, 9, 15},
    {"HEA 180", 171, 180, 6, 9.5, 15},     {"HEA 200", 190, 200, 6.5, 10, 18},
    {"HEA 220", 210, 220, 7, 11, 18},      {"HEA 240", 230, 240, 7.5, 12, 21},
    {"HEA 260", 250, 260, 7.5, 12.5, 24},  {"HEA 280", 270, 280, 8, 13, 24},
    {"HEA 300", 290, 300, 8.5, 14, 27},    {"HEA 320", 310, 300, 9, 15.5, 27},
    {"HEA 340", 330, 300, 9.5, 16.5, 27},  {"HEA 360", 350, 300, 10, 17.5, 27},
    {"HEA 400", 390, 300, 11, 19, 27},     {"HEA 450", 440, 300, 11.5, 21, 27},
    {"HEA 500", 490, 300, 12, 23, 27},     {"HEA 550", 540, 300, 12.5, 24, 27},
    {"HEA 600", 590, 300, 13, 25, 27},     {"HEA 650", 640, 300, 13.5, 26, 27},
    {"HEA 700", 690, 300, 14.5, 27, 27},   {"HEA 800", 790, 300, 15, 28, 30},
    {"HEA 900", 890, 300, 16, 30, 30},     {"HEA 1000", 990, 300, 16.5, 31, 30},
    {"HEB 100", 100, 100, 6, 10, 12},      {"HEB 120", 120, 120, 6.5, 11, 12},
    {"HEB 140", 140, 140, 7, 12, 12},      {"HEB 160", 160, 160, 8, 13, 15},
    {"HEB 180", 180, 180, 8.5, 14, 15},    {"HEB 200", 200, 200, 9, 15, 18},
    {"HEB 220", 220, 220, 9.5, 16, 18},    {"HEB 240", 240, 240, 10, 17, 21},
    {"HEB 260", 260, 260, 10, 17.5, 24},   {"HEB 280", 280, 280, 10.5, 18, 24},
    {"HEB 300", 300, 300, 11, 19, 27},     {"HEB 320", 320, 300, 11.5, 20.5, 27},
    {"HEB 340", 340, 300, 12, 21.5, 27},   {"HEB 360", 360, 300, 12.5, 22.5, 27},
    {"HEB 400", 400, 300, 13.5, 24, 27},   {"HEB 450", 450, 300, 14, 26, 27},
    {"HEB 500", 500, 300, 14.5, 28, 27},   {"HEB 550", 550, 300, 15, 29, 27},
    {"HEB 600", 600, 300, 15.5, 30, 27},   {"HEB 650", 650, 300, 16, 31, 27},
    {"HEB 700", 700, 300, 17, 32, 27},     {"HEB 800", 800, 300, 17.5, 33, 30},
    {"HEB 900", 900, 300, 18.5, 35, 30},   {"HEB 1000", 1000, 300, 19, 36, 30},
};

std::string plain(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (!std::isspace(static_cast<unsigned char>(c)))
      letters += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return letters;
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

Profile disc(double diameter, double tolerance) {
  require_positive("disc", {{"diameter", diameter}, {"tolerance", tolerance}});
  Ring ring = circle(diameter / 2, tolerance);
  const double error = 4 * segments(diameter / 2, ring.size() / 4);
  return drawn({std::move(ring)}, error, diameter / 2);
}

Profile tube(double diameter, double thickness, double tolerance) {
  require_positive("tube", {{"diameter", diameter}, {"wall", thickness}, {"tolerance", tolerance}});
  require(2 * thickness < diameter, "tube",
          "a wall of " + mm(thickness) + " fills a diameter of " + mm(diameter),
          "the wall must be thinner than the radius");
  // The chords of the outer circle must stay clear of the inner one.
  const double fine = std::min(tolerance, thickness / 2), R = diameter / 2, r = R - thickness;
  Ring outer = circle(R, fine), inner = circle(r, fine);
  const double error = std::max(4 * segments(R, outer.size() / 4), 4 * segments(r, inner.size() / 4));
  return drawn({std::move(outer), {std::move(inner)}}, error, R);
}

Profile i_section(double h, double b, double tw, double tf, double r, double tolerance) {
  require_positive(
      "I-section",
      {{"height", h}, {"flange width", b}, {"web", tw}, {"flange", tf}, {"tolerance", tolerance}});
  require(r >= 0 && std::isfinite(r), "I-section", "fillet radius is " + mm(r),
          "it must be finite and not negative");
  require(tw + 2 * r <= b && tw < b, "I-section",
          "web " + mm(tw) + " and fillets of " + mm(r) + " do not fit the flange width " + mm(b),
          "web and two fillets must be no wider than the flange");
  require(2 * tf + 2 * r <= h && 2 * tf < h, "I-section",
          "flanges of " + mm(tf) + " and fillets of " + mm(r) + " do not fit the height " + mm(h),
          "two flanges and two fillets must be no higher than the section");
  // The upper right quarter from the flange's tip to the web, then its images.
  Ring upper_right{{b / 2, h / 2}, {b / 2, h / 2 - tf}};
  const double x = tw / 2 + r, y = h / 2 - tf - r;
  std::size_t chords = 0;
  if (r > 0) {
    if (x < b / 2) upper_right.push_back({x, y + r});
    const std::size_t before = upper_right.size();
    flatten_arc(upper_right, {x, y}, {r, 0}, {0, r}, quarter, quarter, tolerance);
    chords = upper_right.size() - before;
    upper_right.back() = {tw / 2, y};
  } else {
    upper_right.push_back({x, y});
  }
  Ring ring;
  const auto image = [&](double sx, double sy, bool backwards) {
    const std::size_t n = upper_right.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Point p = upper_right[backwards ? n - 1 - i : i], q{sx * p.x, sy * p.y};
      if (ring.empty() || ring.back() != q) ring.push_back(q);
    }
  };
  image(1, 1, false);
  image(1, -1, true);
  image(-1, -1, false);
  image(-1, 1, true);
  return drawn({std::move(ring)}, chords > 0 ? 4 * segments(r, chords) : 0, std::max(h, b) / 2);
}

std::span<const Rolled> rolled() { return table; }

Profile rolled(std::string_view name, double tolerance) {
  const std::string wanted = plain(name);
  const auto* found = std::find_if(std::begin(table), std::end(table),
                                   [&](const Rolled& row) { return plain(row.name) == wanted; });
  if (found == std::end(table))
    throw InvalidInput({{"profile '" + std::string(name) + "'", "is not in the table",
                         "known are IPE 80 … 600 and HEA, HEB 100 … 1000"}});
  return i_section(found->h / 1000, found->b / 1000, found->tw / 1000, found->tf / 1000, found->r / 1000,
                   tolerance);
}

}  // namespace ductile::profiles
