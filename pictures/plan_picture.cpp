#include "ductile/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "artist.h"
#include "ductile/plane.h"
#include "svg.h"

namespace ductile {
namespace {

using namespace picture;

constexpr double gap = 14, caption = 30, footer = 64;

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
  if (std::any_of(panels.begin(), panels.end(), [](const Panel& panel) { return panel.diagram; }))
    view.add(core.grown(ordinate_share * size));
  return view.grown(0.03 * std::max(view.width(), view.height()));
}

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

double exaggeration(const Plan& plan, const std::vector<Motion>& motions) {
  Box box;
  for (const Piece& piece : plan.pieces)
    if (moves(plan, piece)) box.add(box_of(piece, Pose(plan, {}, -1)));
  double largest = 0;
  for (const Motion& motion : motions) largest = std::max(largest, length(motion.along));
  if (box.empty() || !(largest > 0 && largest < unlimited)) return 1;
  const double most = 0.12 * std::max(box.width(), box.height()) / largest;
  const double power = std::pow(10, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

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
  const auto columns = picture.panels.size() == 4 ? 2 : std::min<std::size_t>(3, picture.panels.size());
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
    draw_panel(group, plan, panel, moments, {view, scale, place, columns == 1 ? 1 : 0.7});
    write(svg, panel.title, corner.x + wide / 2, corner.y + high + 19, "text-anchor", "middle");
    if (panel.diagram) continue;
    (panel.joints.empty() ? by_moment : by_stage) |= panel.motions.empty() || !panel.joints.empty();
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
