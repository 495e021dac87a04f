// Axial, shear and moment diagrams over the scene, as pictures have them (ductile/strips.h).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "canvas.h"
#include "ductile/strips.h"
#include "quantity.h"

namespace ductile::viewer {

// Positive forces above a line, or left of one that stands; moments on the side in tension. Loads count at
// their full size.
void Canvas::diagram() {
  const Plan& plan = bench_->plan();
  const Frame& frame = bench_->frame();
  const std::vector<diagram::Strip> all = diagram::strips(plan, frame.joints);
  const auto value = [this](const diagram::Station& s) {
    return *look_.diagram == axial ? s.N : *look_.diagram == shear ? s.Q : s.M;
  };
  double largest = 0;
  for (const diagram::Strip& strip : all)
    for (const diagram::Station& station : strip.stations)
      largest = std::max(largest, std::abs(value(station)));
  if (!(largest > 0)) return;
  const double height = 60 * ui_ / largest;  // px per unit

  struct Ordinate {
    Point at, tip;  // px
    double value;
  };
  std::vector<Ordinate> most(plan.bodies.size());  // of each body
  for (const diagram::Strip& strip : all) {
    const auto piece = static_cast<std::size_t>(strip.piece);
    Point aside = left(strip.axis);
    const bool up = aside.y > 1e-9 || (aside.y > -1e-9 && aside.x < 0);
    if (*look_.diagram == rotation || !up) aside = -aside;
    aside = Rotation(frame.pieces[piece].angle) * aside;
    const auto ordinate = [&](const diagram::Station& station) {
      const Point at = camera_.to_screen(carried(plan, strip.piece, station.at, frame));
      const double v = value(station);
      return Ordinate{at, at + height * v * Point{aside.x, -aside.y}, v};
    };
    const auto fill = [&](const Ordinate& a, const Ordinate& b) {
      const bool blue = *look_.diagram == rotation || a.value + b.value >= 0;
      const ImU32 line = blue ? IM_COL32(0x2b, 0x7b, 0xba, 255) : IM_COL32(0xd9, 0x6a, 0x1e, 255);
      to_->AddQuadFilled(px(a.at), px(a.tip), px(b.tip), px(b.at),
                         (line & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90));
      to_->AddLine(px(a.tip), px(b.tip), line, f(1.5 * ui_));
    };
    for (std::size_t i = 0; i < strip.stations.size(); ++i) {
      const Ordinate b = ordinate(strip.stations[i]);
      Ordinate& greatest = most[static_cast<std::size_t>(plan.pieces[piece].body)];
      if (std::abs(b.value) > std::abs(greatest.value)) greatest = b;
      if (i == 0) continue;
      const Ordinate a = ordinate(strip.stations[i - 1]);
      if (a.value * b.value < 0) {
        const Point at = a.at + a.value / (a.value - b.value) * (b.at - a.at);
        fill(a, {at, at, 0});
        fill({at, at, 0}, b);
      } else {
        fill(a, b);
      }
    }
  }
  for (const Ordinate& o : most) {
    if (std::abs(o.value) < 0.02 * largest) continue;
    const std::string text = si(*look_.diagram == rotation ? std::abs(o.value) : o.value,
                                *look_.diagram == rotation ? "N m" : "N");
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const Point corner = o.tip + Point{-size.x / 2., o.tip.y < o.at.y ? -size.y - 3 * ui_ : 3 * ui_};
    to_->AddRectFilled(px(corner), px(corner + Point{size.x, size.y}), IM_COL32(255, 255, 255, 200));
    to_->AddText(px(corner), ink::edge, text.c_str());
  }
}

}  // namespace ductile::viewer
