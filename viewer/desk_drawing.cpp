// What is seen of making: the grid, nodes, what holds the scene, what is chosen, the cursor.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "desk.h"
#include "quantity.h"

namespace ductile::viewer {
namespace {

/// Under the point where the scene is held, px.
void draw_support(ImDrawList& to, const SupportDef& support, Point at, double ui) {
  const auto f = [ui](double value) { return static_cast<float>(value * ui); };
  const auto under = [&](double x, double y) { return px(at + ui * Point{x, y}); };
  if (support.fix_angle) {
    to.AddRectFilled(under(-8, 4), under(8, 14), ink::accent);
  } else if (!support.fix_x && !support.fix_y) {  // springs
    for (const double y : {3., 7., 11.}) {
      to.AddLine(under(-5, y), under(5, y + 2), ink::accent, f(2));
      to.AddLine(under(5, y + 2), under(-5, y + 4), ink::accent, f(2));
    }
  } else {
    to.AddTriangle(under(0, 3), under(-8, 14), under(8, 14), ink::accent, f(2));
  }
  if (!support.fix_x) to.AddLine(under(-8, 18), under(8, 18), ink::accent, f(2));
}

}  // namespace

// Below the scene.
void Desk::draw_grid(ImDrawList& to) const {
  const Point low = camera_.to_world({camera_.screen.low.x, camera_.screen.high.y}),
              high = camera_.to_world({camera_.screen.high.x, camera_.screen.low.y});
  const double grid = maker_.grid;
  if (grid * camera_.scale < 8 * ui_) return;
  const Point first{grid * std::ceil(low.x / grid), grid * std::ceil(low.y / grid)};
  const int columns = static_cast<int>((high.x - first.x) / grid) + 1,
            rows = static_cast<int>((high.y - first.y) / grid) + 1;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const Point node = first + grid * Point{static_cast<double>(i), static_cast<double>(j)};
      to.AddCircleFilled(px(camera_.to_screen(node)), f(ui_), ink::line, 4);
    }
  }
}

void Desk::draw_chosen(ImDrawList& to) const {
  const float width = static_cast<float>(2.5 * ui_);
  for (const std::string& name : maker_.chosen(bench_)) {
    const BodyDef& body = *body_named(bench_.scene(), name);
    if (body.circle > 0) {
      to.AddCircle(px(camera_.to_screen(body.at)), static_cast<float>(body.circle * camera_.scale),
                   ink::accent, 0, width);
    }
    for (const Point p : body.outline.outer)
      to.PathLineTo(px(camera_.to_screen(body.at + Rotation(body.angle) * p)));
    to.PathStroke(ink::accent, ImDrawFlags_Closed, width);
  }
  if (const auto grip = maker_.turn_grip(bench_, grip_arm * ui_ / camera_.scale)) {
    const Point at = camera_.to_screen(grip->at);
    to.AddLine(px(camera_.to_screen(grip->about)), px(at), ink::accent, static_cast<float>(ui_));
    to.AddCircleFilled(px(at), static_cast<float>(6 * ui_), ink::ground);
    to.AddCircle(px(at), static_cast<float>(6 * ui_), ink::accent, 0, width);
    if (const auto turning = maker_.turning()) {
      to.AddText(px(at + ui_ * Point{12, -8}), ink::accent, fmt::format("{:.4g}°", *turning).c_str());
      return;
    }
  }
  const Point cursor = camera_.to_screen(maker_.cursor());
  if (maker_.tool() == Maker::Tool::choose && maker_.start()) {
    to.AddRect(px(camera_.to_screen(*maker_.start())), px(cursor), ink::accent, 0, 0,
               static_cast<float>(ui_));
  }
  if (maker_.tool() == Maker::Tool::mirror) {
    to.AddLine(px({cursor.x, camera_.screen.low.y}), px({cursor.x, camera_.screen.high.y}), ink::accent,
               static_cast<float>(ui_));
  }
}

void Desk::draw_making(ImDrawList& to) const {
  const auto f = [this](double value) { return static_cast<float>(value * ui_); };
  const SceneDef& scene = bench_.scene();
  draw_chosen(to);
  for (const Point node : nodes(scene)) {
    const ImVec2 at = px(camera_.to_screen(node));
    to.AddCircleFilled(at, f(3.5), ink::ground);
    to.AddCircle(at, f(3.5), ink::edge, 0, f(1.5));
  }
  for (const JointBetweenDef& joint : scene.joints) {  // welds
    if (!joint.at || !(joint.welded || joint.overrides.moment.value_or(0) > 0)) continue;
    const Point at = camera_.to_screen(*joint.at), half{4 * ui_, 4 * ui_};
    to.AddRectFilled(px(at - half), px(at + half), ink::edge);
  }
  for (const SupportDef& support : scene.supports)
    draw_support(to, support, camera_.to_screen(support.at), ui_);
  const Point cursor = maker_.cursor(), at = camera_.to_screen(cursor);
  if (const Ring& corners = maker_.corners(); !corners.empty()) {
    for (const Point corner : corners) {
      to.PathLineTo(px(camera_.to_screen(corner)));
      to.AddCircleFilled(px(camera_.to_screen(corner)), f(4), ink::accent);
    }
    to.PathLineTo(px(at));
    to.PathStroke(ink::accent, 0, f(2));
  }
  to.AddText(px(camera_.screen.low + ui_ * Point{12, 28}), ink::edge, bench_.verdict().c_str());
  if (maker_.turning()) return;  // the grip tells where the pointer is
  const Point across{7 * ui_, 0}, up{0, 7 * ui_};
  to.AddLine(px(at - across), px(at + across), ink::accent, f(2));
  to.AddLine(px(at - up), px(at + up), ink::accent, f(2));
  std::string text = fmt::format("{:.4g}, {:.4g} m", cursor.x, cursor.y);
  if (const auto start = maker_.start()) {
    text += fmt::format("   {} long", si(length(cursor - *start), "m"));
    if (maker_.tool() == Maker::Tool::line || maker_.tool() == Maker::Tool::cut) {
      to.AddLine(px(camera_.to_screen(*start)), px(at), ink::accent, f(1.5));
    }
  }
  to.AddText(px(at + ui_ * Point{10, -20}), ink::accent, text.c_str());
}

}  // namespace ductile::viewer
