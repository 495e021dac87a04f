#include "plot.h"

#include <algorithm>
#include <cmath>

#include "quantity.h"

namespace ductile::viewer {
namespace {

/// Takes its place among the controls; the box, px.
Bounds place_for(const char* id, ImVec2 size) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, size);
  return {point(corner), point(corner) + point(size)};
}

void frame_of(const Bounds& box) {
  ImDrawList& to = *ImGui::GetWindowDrawList();
  to.AddRectFilled(px(box.low), px(box.high), ink::ground);
  to.AddRect(px(box.low), px(box.high), ink::line);
}

void write(Point at, ImU32 colour, const std::string& text) {
  ImGui::GetWindowDrawList()->AddText(px(at), colour, text.c_str());
}

double text_width(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }

/// What of a plot the values span, 0 always.
struct Span {
  double low = 0, high = 0;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low == high; }
  double share(double value) const { return empty() ? 0 : (value - low) / (high - low); }
};

}  // namespace

std::optional<long> plot(const char* title, const Timeline& run, const std::vector<Line>& lines,
                         std::string (*show)(double), ImVec2 size, double ui) {
  const Frame& now = run.frame();
  // Title and the values of now; as many lines of them as it takes.
  const float right = ImGui::GetCursorPosX() + size.x;
  ImGui::TextUnformatted(title);
  for (const Line& line : lines) {
    const Frame* at = line.run ? &line.run->frame() : &now;
    const std::string label = line.name + (line.name.empty() ? "" : " ") + show(line.value(*at));
    ImGui::SameLine(0, f(10 * ui));
    if (ImGui::GetCursorPosX() + f(text_width(label)) > right) ImGui::NewLine();
    ImGui::PushStyleColor(ImGuiCol_Text, line.colour);
    ImGui::TextUnformatted(label.c_str());
    ImGui::PopStyleColor();
  }
  const double used = ImGui::GetItemRectMax().x + 8 * ui;
  const Bounds box = place_for(title, size);
  frame_of(box);
  const double start = run.kept(run.first_kept())->time, end = run.kept(run.last_kept())->time;
  const auto width = static_cast<std::size_t>(std::max(1., box.size().x / ui));
  Span span;
  std::vector<std::vector<Column>> drawn;
  for (const Line& line : lines) {
    drawn.push_back(columns(line.run ? *line.run : run, line.value, width, start, end));
    for (const Column& c : drawn.back()) {
      span.add(c.low);
      span.add(c.high);
    }
  }
  const Bounds inner{box.low + ui * Point{0, 3}, box.high - ui * Point{0, 3}};
  const auto y = [&](double value) { return inner.high.y - span.share(value) * inner.size().y; };
  const double step = box.size().x / static_cast<double>(width);
  ImDrawList& to = *ImGui::GetWindowDrawList();
  to.PushClipRect(px(box.low), px(box.high), true);
  to.AddLine({f(box.low.x), f(y(0))}, {f(box.high.x), f(y(0))}, ink::line, f(ui));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    std::optional<Point> before;
    for (std::size_t i = 0; i < width; ++i) {
      const Column& c = drawn[k][i];
      if (!std::isfinite(c.low)) continue;
      const double x = box.low.x + (static_cast<double>(i) + 0.5) * step;
      const auto line = [&](Point from, Point to_point) {
        to.AddLine(px(from), px(to_point), lines[k].colour, f(1.4 * ui));
      };
      if (before) line(*before, {x, y(c.first)});
      if (c.low < c.high) line({x, y(c.low)}, {x, y(c.high)});
      before = {x, y(c.last)};
    }
  }
  const auto x_of = [&](double time) {
    return box.low.x + (end > start ? (time - start) / (end - start) : 0) * box.size().x;
  };
  to.AddLine({f(x_of(now.time)), f(box.low.y)}, {f(x_of(now.time)), f(box.high.y)}, ink::edge, f(ui));
  to.PopClipRect();
  if (!span.empty()) {  // above the upper right corner, or in it where values stand there
    const std::string range = (span.low < 0 ? show(span.low) + " to " : "up to ") + show(span.high);
    const double line = ImGui::GetTextLineHeight(), x = box.high.x - text_width(range);
    const bool room = x > used;
    const Point corner = room ? Point{x, box.low.y - ImGui::GetTextLineHeightWithSpacing()}
                              : Point{x - 3 * ui, box.low.y + 2 * ui};
    if (!room)
      to.AddRectFilled(px(corner), px(corner + Point{text_width(range), line}), IM_COL32(255, 255, 255, 200));
    write(corner, ink::faint, range);
  }
  if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return std::nullopt;
  const double share = std::clamp((point(ImGui::GetMousePos()).x - box.low.x) / box.size().x, 0., 1.);
  const long hovered = step_at(run, start + share * (end - start));
  ImGui::BeginTooltip();
  ImGui::Text("%.4f s (step %ld; a click goes there)", run.kept(hovered)->time, hovered);
  for (const Line& line : lines) {
    const Frame* at = line.run ? line.run->kept(hovered) : run.kept(hovered);
    if (at) ImGui::Text("%s %s", line.name.c_str(), show(line.value(*at)).c_str());
  }
  ImGui::EndTooltip();
  return ImGui::IsItemActive() ? std::optional(hovered) : std::nullopt;
}

void plot_limits(const Diagram& diagram, const Timeline& run, std::size_t joint, ImVec2 size, double ui) {
  const Bounds box = place_for("N-M", size);
  frame_of(box);
  const JointReading& now = run.frame().joints[joint];
  Span N, M;
  for (const auto* ring : {&diagram.limit, &diagram.curve}) {
    for (const AxialMoment& at : *ring) {
      N.add(at.N);
      M.add(at.M);
    }
  }
  if (diagram.limit.empty() && diagram.curve.empty()) {  // unlimited: what it has carried
    for (long step = run.first_kept(); step <= run.last_kept(); ++step) {
      N.add(run.kept(step)->joints[joint].N);
      M.add(run.kept(step)->joints[joint].M);
    }
  }
  const double text = ImGui::GetTextLineHeight();
  const Bounds inner{box.low + Point{8 * ui, text + 5 * ui}, box.high - Point{8 * ui, text + 5 * ui}};
  const auto at = [&](double n, double m) {
    return Point{inner.low.x + N.share(n) * inner.size().x, inner.high.y - M.share(m) * inner.size().y};
  };
  ImDrawList& to = *ImGui::GetWindowDrawList();
  to.PushClipRect(px(box.low), px(box.high), true);
  const Point origin = at(0, 0);
  to.AddLine({f(box.low.x), f(origin.y)}, {f(box.high.x), f(origin.y)}, ink::line, f(ui));
  to.AddLine({f(origin.x), f(inner.low.y)}, {f(origin.x), f(inner.high.y)}, ink::line, f(ui));
  std::vector<ImVec2> path;
  const auto ring = [&](const std::vector<AxialMoment>& points, ImU32 colour, double width) {
    path.clear();
    for (const AxialMoment& p : points) path.push_back(px(at(p.N, p.M)));
    to.AddPolyline(path.data(), static_cast<int>(path.size()), colour, ImDrawFlags_Closed, f(width * ui));
  };
  ring(diagram.curve, IM_COL32(0x7f, 0xae, 0xd8, 255), 1.2);
  ring(diagram.limit, ink::accent, 2);
  // Where it has been, up to now; points that fall together are one.
  path.clear();
  for (long step = run.first_kept(); step <= run.cursor() && run.kept(step); ++step) {
    const JointReading& then = run.kept(step)->joints[joint];
    const ImVec2 p = px(at(then.N, then.M));
    if (path.empty() || std::hypot(p.x - path.back().x, p.y - path.back().y) > ui) path.push_back(p);
  }
  to.AddPolyline(path.data(), static_cast<int>(path.size()), IM_COL32(0xb5, 0x48, 0x9a, 150), 0, f(ui));
  to.AddCircleFilled(px(at(now.N, now.M)), f(4 * ui), rgb(stage_colour(stage(now))));
  to.AddCircle(px(at(now.N, now.M)), f(4 * ui), ink::edge, 0, f(1.2 * ui));
  write({box.low.x + 4 * ui, box.low.y + 2 * ui}, ink::faint, "M up to " + si(M.high, "N m"));
  const std::string n = "N to " + si(N.high, "N");
  write({box.high.x - text_width(n) - 4 * ui, box.high.y - text - 2 * ui}, ink::faint, n);
  to.PopClipRect();
}

void plot_section(const Diagram& diagram, const JointReading& joint, ImVec2 size, double ui) {
  const Bounds box = place_for("section", size);
  frame_of(box);
  const double text = ImGui::GetTextLineHeight();
  if (!diagram.section) {
    write(box.low + ui * Point{4, 2}, ink::faint, "no section");
    return;
  }
  Bounds shape;
  for (const Region& region : diagram.section->regions()) {
    for (const Point& p : region.outline.outer) shape.add(p);
  }
  const Bounds inner{box.low + Point{10 * ui, text + 6 * ui}, box.high - Point{10 * ui, text + 6 * ui}};
  // Both directions in one scale, unless that would make a hair of it.
  const Point fit{inner.size().x / shape.size().x, inner.size().y / shape.size().y};
  const double scale = std::min(fit.x, fit.y), thinnest = 12 * ui;
  const Point zoom{std::min(fit.x, std::max(scale, thinnest / shape.size().x)),
                   std::min(fit.y, std::max(scale, thinnest / shape.size().y))};
  const auto at = [&](Point p) {
    const Point d = p - shape.middle(), m = inner.middle();
    return Point{m.x + zoom.x * d.x, m.y - zoom.y * d.y};
  };
  const bool positive = joint.M >= 0;
  const double axis = neutral_axis(*diagram.section, joint.N, positive);
  const double y = std::clamp(at({0, axis}).y, box.low.y, box.high.y);
  constexpr ImU32 tension = IM_COL32(0x2b, 0x7b, 0xba, 255), compression = IM_COL32(0xe0, 0x8a, 0x1e, 255);
  ImDrawList& to = *ImGui::GetWindowDrawList();
  std::vector<ImVec2> path;
  for (const bool upper : {true, false}) {
    to.PushClipRect({f(box.low.x), f(upper ? box.low.y : y)}, {f(box.high.x), f(upper ? y : box.high.y)},
                    true);
    for (const Convex& part : diagram.parts) {
      path.clear();
      // Flipped, so turned round: parts are counter-clockwise with y up.
      for (auto p = part.rbegin(); p != part.rend(); ++p) path.push_back(px(at(*p)));
      const ImDrawListFlags flags = to.Flags;
      to.Flags &= ~ImDrawListFlags_AntiAliasedFill;
      to.AddConvexPolyFilled(path.data(), static_cast<int>(path.size()),
                             upper != positive ? tension : compression);
      to.Flags = flags;
    }
    to.PopClipRect();
  }
  for (const Region& region : diagram.section->regions()) {
    std::vector<Ring> rings = region.outline.holes;
    rings.push_back(region.outline.outer);
    for (const Ring& ring : rings) {
      path.clear();
      for (const Point& p : ring) path.push_back(px(at(p)));
      to.AddPolyline(path.data(), static_cast<int>(path.size()), ink::edge, ImDrawFlags_Closed, f(ui));
    }
  }
  for (int dash = 0; dash * 9 * ui < box.size().x; ++dash) {
    const double x = box.low.x + (2 + 9 * dash) * ui;
    to.AddLine({f(x), f(y)}, {f(std::min(x + 6 * ui, box.high.x)), f(y)}, ink::edge, f(1.5 * ui));
  }
  write(box.low + ui * Point{4, 2}, positive ? compression : tension, positive ? "compression" : "tension");
  write({box.low.x + 4 * ui, box.high.y - text - 2 * ui}, positive ? tension : compression,
        positive ? "tension" : "compression");
}

}  // namespace ductile::viewer
