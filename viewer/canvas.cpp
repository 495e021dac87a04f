#include "canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/colours.h"
#include "ductile/picture.h"
#include "quantity.h"

namespace ductile::viewer {
namespace {

/// What all but a fiftieth of the values keep below: the largest ones are impacts.
double usual(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - values.size() / 50);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double thickness(const Ring& ring) {
  double area = 0, perimeter = 0;
  for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
    area += cross(ring[last], ring[i]) / 2;
    perimeter += length(ring[i] - ring[last]);
  }
  return perimeter > 0 ? 2 * std::abs(area) / perimeter : 0;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

}  // namespace

void Canvas::draw(ImDrawList& to, const Workbench& bench, const Camera& camera, const Look& look,
                  const Hand& hand, double ui, std::optional<std::size_t> pointed) {
  to_ = &to;
  bench_ = &bench;
  camera_ = camera;
  look_ = look;
  ui_ = ui;
  if (edition_ != bench.edition()) prepare(bench);
  placed_.clear();
  for (std::size_t i = 0; i < bench.plan().joints.size(); ++i) {
    placed_.push_back(place(bench.plan(), i, bench.frame()));
  }
  pieces();
  thrown();
  joints();
  beside();
  collapse();
  if (look.diagram) diagram();
  if (look.loads) loads();
  if (look.forces || look.moments) forces();
  chosen(pointed);
  numbers();
  this->hand(hand);
  legend();
}

void Canvas::prepare(const Workbench& bench) {
  const Plan& plan = bench.plan();
  edition_ = bench.edition();
  usual_force_ = usual_moment_ = 0;
  skins_.clear();
  for (const Piece& piece : plan.pieces) {
    const bool moves = plan.bodies[static_cast<std::size_t>(piece.body)].type == BodyType::dynamic_body;
    Skin& skin = skins_.emplace_back(Skin{.moves = moves, .thickness = thickness(piece.outline.outer)});
    if (piece.circle > 0) continue;
    skin.fills = convex_parts(piece);  // relative to its centre
    skin.edges.push_back(piece.outline.outer);
    skin.edges.insert(skin.edges.end(), piece.outline.holes.begin(), piece.outline.holes.end());
    for (Ring& ring : skin.edges) {
      for (Point& p : ring) p = p - piece.center;
    }
  }
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    for (const int side : {plan.joints[i].a, plan.joints[i].b}) {
      if (side >= 0) skins_[static_cast<std::size_t>(side)].joints.push_back(i);
    }
  }
}

double Canvas::shown_stage(std::size_t joint) const {
  const Frame& frame = bench_->frame();
  const bool peak = look_.peaks && !frame.peaks.empty();
  return peak ? static_cast<double>(frame.peaks[joint]) : stage(frame.joints[joint]);
}

ImU32 Canvas::colour_of(double stage) const {
  return rgb(look_.contrast ? contrast_colour(stage) : stage_colour(stage));
}

void Canvas::pieces() {
  const Frame& frame = bench_->frame();
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    const Skin& skin = skins_[i];
    const PieceReading& now = frame.pieces[i];
    double worst = 0;
    for (const std::size_t j : skin.joints) {
      if (look_.peaks || !frame.joints[j].broken) worst = std::max(worst, shown_stage(j));
    }
    const ImU32 fill = skin.moves ? colour_of(worst) : ink::fixed;
    const float width = f(look_.contrast ? 2 * ui_ : ui_);
    // Black outlines would be all that is seen of what is only a few pixels high.
    const double dark = look_.contrast ? 1 : std::clamp(skin.thickness * camera_.scale / (8 * ui_), 0.25, 1.);
    const ImU32 edge = IM_COL32(0x1b, 0x20, 0x27, static_cast<int>(255 * dark));
    const Rotation turn(now.angle);
    const Point centre = camera_.to_screen(now.position);
    if (const double radius = bench_->plan().pieces[i].circle * camera_.scale; radius > 0) {
      const Point rim = turn * Point{radius, 0};
      to_->AddCircleFilled(px(centre), f(radius), fill);
      to_->AddCircle(px(centre), f(radius), ink::edge, 0, width);
      to_->AddLine(px(centre), px(centre + Point{rim.x, -rim.y}), ink::edge, width);
      continue;
    }
    const auto transform = [&](const std::vector<Point>& ring) {
      points_.clear();
      for (const Point& p : ring) {
        const Point d = camera_.scale * (turn * p);
        points_.push_back({f(centre.x + d.x), f(centre.y - d.y)});
      }
    };
    // Smooth edges would show as seams between the parts; the outline covers them.
    const ImDrawListFlags flags = to_->Flags;
    to_->Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (const Convex& part : skin.fills) {
      transform(part);
      to_->AddConvexPolyFilled(points_.data(), static_cast<int>(points_.size()), fill);
    }
    to_->Flags = flags;
    for (const Ring& ring : skin.edges) {
      transform(ring);
      to_->AddPolyline(points_.data(), static_cast<int>(points_.size()), edge, ImDrawFlags_Closed, width);
    }
  }
}

void Canvas::thrown() {
  const std::vector<act::Throw> list = bench_->run().thrown();
  const Frame& frame = bench_->frame();
  for (std::size_t i = 0; i < frame.thrown.size(); ++i) {
    const Rotation turn(frame.thrown[i].angle);
    const Point centre = frame.thrown[i].position;
    const double half = list[i].size / 2;
    constexpr ImU32 fill = IM_COL32(0x4d, 0x56, 0x61, 255);
    if (list[i].square) {
      points_.clear();
      for (const Point corner : {Point{-1, -1}, Point{1, -1}, Point{1, 1}, Point{-1, 1}}) {
        const Point at = half * Point{corner.x, list[i].flat * corner.y};
        points_.push_back(px(camera_.to_screen(centre + turn * at)));
      }
      to_->AddConvexPolyFilled(points_.data(), 4, fill);
      to_->AddPolyline(points_.data(), 4, ink::edge, ImDrawFlags_Closed, f(ui_));
    } else {
      to_->AddCircleFilled(px(camera_.to_screen(centre)), f(half * camera_.scale), fill);
      to_->AddLine(px(camera_.to_screen(centre)), px(camera_.to_screen(centre + turn * Point{half, 0})),
                   ink::ground, f(ui_));
    }
  }
}

// A rope or strut from end to end; else a line across the cut in the colour of its stage, a dot that grows
// with its plastic rotation, or crosses where it broke.
void Canvas::joints() {
  const Frame& frame = bench_->frame();
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const JointReading& joint = frame.joints[i];
    const Point at = camera_.to_screen(placed_[i].anchor);
    if (joint.broken) {  // on both sides, wherever they are by now
      const PlannedJoint& planned = bench_->plan().joints[i];
      for (const int side : {planned.a, planned.b}) {
        const Point end = camera_.to_screen(carried(bench_->plan(), side, planned.anchor, frame));
        const Point d{3 * ui_, 3 * ui_}, e{3 * ui_, -3 * ui_};
        to_->AddLine(px(end - d), px(end + d), ink::edge, f(1.5 * ui_));
        to_->AddLine(px(end - e), px(end + e), ink::edge, f(1.5 * ui_));
      }
      continue;
    }
    const ImU32 colour = colour_of(shown_stage(i));
    if (const PlannedJoint& line = bench_->plan().joints[i]; line.end) {
      const Point from = camera_.to_screen(carried(bench_->plan(), line.a, line.anchor, frame));
      const Point to = camera_.to_screen(carried(bench_->plan(), line.b, *line.end, frame));
      const double width = (line.carries == Carries::tension ? 2 : 4) * ui_;
      to_->AddLine(px(from), px(to), ink::edge, f(width));
      to_->AddLine(px(from), px(to), colour, f(width - ui_));
      continue;
    }
    const double height = bench_->plan().joints[i].height * camera_.scale;
    // A support has no height; what is small on the screen is drawn thinner.
    const double half = height > 0 ? height / 2 + ui_ : 5 * ui_;
    const double width = height > 0 ? std::clamp(0.2 * height, 1.5 * ui_, 4 * ui_) : 4 * ui_;
    const Point across = half * Point{placed_[i].axis.y, placed_[i].axis.x};  // y runs down
    if (width >= 2.5 * ui_) to_->AddLine(px(at - across), px(at + across), ink::edge, f(width));
    to_->AddLine(px(at - across), px(at + across), colour, f(std::max(width - 1.5 * ui_, 1.5 * ui_)));
    if (const double dot = hinge_dot(joint.accumulated_rotation); dot > 0) {
      const float radius = f(std::max(2.5 * ui_, height * dot));
      to_->AddCircleFilled(px(at), radius, colour);
      to_->AddCircle(px(at), radius, ink::edge, 0, f(ui_));
    }
  }
}

// Outlines of the pieces where the run beside this one has them.
void Canvas::beside() {
  const Timeline* other = bench_->beside();
  if (!other) return;
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    if (!skins_[i].moves) continue;
    const PieceReading& there = other->frame().pieces[i];
    const Rotation turn(there.angle);
    const Point centre = camera_.to_screen(there.position);
    if (const double radius = bench_->plan().pieces[i].circle; radius > 0)
      to_->AddCircle(px(centre), f(radius * camera_.scale), ink::accent, 0, f(1.5 * ui_));
    for (const Ring& ring : skins_[i].edges) {
      points_.clear();
      for (const Point p : ring) points_.push_back(px(camera_.to_screen(there.position + turn * p)));
      to_->AddPolyline(points_.data(), static_cast<int>(points_.size()), ink::accent, ImDrawFlags_Closed,
                       f(1.5 * ui_));
    }
  }
}

// Where a collapse takes the pieces, about a tenth of the structure far, and the joints that flow in it.
void Canvas::collapse() {
  const LimitAnalysis* found = bench_->collapse();
  if (!found || bench_->run().cursor() > 0) return;
  const Plan& plan = bench_->plan();
  const double times = exaggeration(plan, found->mechanism);
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    const Motion& motion = found->mechanism[i];
    constexpr double still = 1e-6;  // of the largest, which is 1
    if (std::abs(motion.turn) < still && length(motion.along) < still) continue;
    const Point centre = plan.pieces[i].center + times * motion.along;
    for (const Ring& ring : skins_[i].edges) {
      points_.clear();
      // To first order, as the mechanism is: what turns by a small angle moves at a right angle to its arm.
      for (const Point p : ring)
        points_.push_back(px(camera_.to_screen(centre + p + times * motion.turn * left(p))));
      to_->AddPolyline(points_.data(), static_cast<int>(points_.size()), ink::accent, ImDrawFlags_Closed,
                       f(1.5 * ui_));
    }
  }
  for (const int hinge : found->hinges) {
    const ImVec2 at = px(camera_.to_screen(placed_[static_cast<std::size_t>(hinge)].anchor));
    to_->AddCircleFilled(at, f(6 * ui_), ink::ground);
    to_->AddCircle(at, f(6 * ui_), rgb(stage_colour(1.9)), 0, f(2.5 * ui_));
  }
}

// The force on the second body as an arrow, the moment as an arc whose arrow turns it. What is usual in the
// scene is 50 px long, or 22 px in radius, at scale 1; impacts are cut at three times that.
void Canvas::forces() {
  const Frame& frame = bench_->frame();
  std::vector<double> forces, moments;
  for (const JointReading& joint : frame.joints) {
    forces.push_back(std::hypot(joint.N, joint.Q));
    moments.push_back(std::abs(joint.M));
  }
  usual_force_ = std::max(usual_force_, usual(forces));
  usual_moment_ = std::max(usual_moment_, usual(moments));
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const JointReading& joint = frame.joints[i];
    if (joint.broken) continue;
    const auto& [anchor, axis] = placed_[i];
    const Point at = camera_.to_screen(anchor);
    if (look_.forces && usual_force_ > 0) {
      const Point force = joint.N * axis + joint.Q * left(axis);
      const double share = look_.force_scale * length(force) / usual_force_;
      if (share * 50 > 1) {
        const Point d = 50 * ui_ * std::min(share, 3.) / length(force) * force;
        arrow(*to_, at, at + Point{d.x, -d.y}, ink::force, 2 * ui_);
      }
    }
    if (look_.moments && usual_moment_ > 0) {
      const double share = look_.moment_scale * std::abs(joint.M) / usual_moment_;
      const double radius = 22 * ui_ * std::min(std::sqrt(share), 3.);
      if (radius < 2 * ui_) continue;
      const double along = std::atan2(-axis.y, axis.x), quarter = std::numbers::pi / 2;
      to_->PathArcTo(px(at), f(radius), f(along - quarter), f(along + quarter));
      to_->PathStroke(ink::moment, 0, f(1.5 * ui_));
      // Counter-clockwise for M > 0: on a screen whose y runs down towards smaller angles.
      const double sense = joint.M > 0 ? -1 : 1;
      const Point end = at + radius * (Rotation(along + sense * quarter) * Point{1, 0});
      const Point tangent = sense * left(1 / radius * (end - at));
      arrow(*to_, end - 2 * ui_ * tangent, end + 5 * ui_ * tangent, ink::moment, 1.5 * ui_);
    }
  }
}

void Canvas::loads() {
  const double time = bench_->frame().time;
  const auto now = [time](const LoadDef& load) {
    if (time < load.from || time >= load.to) return 0.;
    return load.ramp > 0 ? std::min(1., (time - load.from) / load.ramp) : 1.;
  };
  double most = 0;
  for (const Plan::Load& load : bench_->plan().loads) most = std::max(most, length(load.def.force));
  if (most == 0) return;
  for (const Plan::Load& load : bench_->plan().loads) {
    const double size = length(load.def.force), share = now(load.def);
    if (share == 0 || size == 0) continue;
    const Point at = camera_.to_screen(carried(bench_->plan(), load.piece, load.at, bench_->frame()));
    const Point d = 60 * ui_ * share / most * load.def.force;
    arrow(*to_, at - Point{d.x, -d.y}, at, ink::load, 3 * ui_);
  }
}

void Canvas::chosen(std::optional<std::size_t> pointed) {
  const auto ring = [&](std::size_t joint, ImU32 colour, double width) {
    const ImVec2 at = px(camera_.to_screen(placed_[joint].anchor));
    to_->AddCircle(at, f(9 * ui_), ink::ground, 0, f((width + 2) * ui_));  // seen on dark steel too
    to_->AddCircle(at, f(9 * ui_), colour, 0, f(width * ui_));
  };
  for (const std::size_t joint : bench_->selected) ring(joint, ink::accent, 2);
  if (bench_->focus) ring(*bench_->focus, ink::accent, 3.5);
  if (pointed) ring(*pointed, ink::edge, 1.5);
}

// Beside their joints, the one with the details first, then the most used; what would cover another is left
// out.
void Canvas::numbers() {
  if (look_.numbers == Look::Numbers::none && !look_.names) return;
  const Frame& frame = bench_->frame();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const bool seen = look_.numbers == Look::Numbers::all || look_.names || bench_->selected.contains(i);
    if (seen && camera_.screen.contains(camera_.to_screen(placed_[i].anchor))) order.push_back(i);
  }
  const auto rank = [&](std::size_t i) {
    return bench_->focus == i ? 4. : bench_->selected.contains(i) ? 3. : stage(frame.joints[i]);
  };
  constexpr std::size_t most = 100;
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
  std::partial_sort(order.begin(), end, order.end(),
                    [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  order.erase(end, order.end());
  std::vector<Bounds> taken;
  for (const std::size_t i : order) {
    const JointReading& joint = frame.joints[i];
    std::string text = look_.names ? bench_->plan().joints[i].name : "";
    const bool number = look_.numbers == Look::Numbers::all ||
                        (look_.numbers == Look::Numbers::selected && bench_->selected.contains(i));
    if (number) {
      if (!text.empty()) text += '\n';
      if (joint.broken) {
        text += "broken";
      } else if (look_.as == Look::As::value) {
        text += fmt::format("N {}\nQ {}\nM {}", si(joint.N, "N"), si(joint.Q, "N"), si(joint.M, "N m"));
      } else {
        text += fmt::format("N {}\nQ {}\nM {}", percent(joint.usage.N), percent(joint.usage.Q),
                            percent(joint.usage.M));
      }
    }
    if (text.empty()) continue;
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const Point pad{3 * ui_, 2 * ui_}, at = camera_.to_screen(placed_[i].anchor) + ui_ * Point{11, 8};
    const Bounds box{at - pad, at + Point{size.x, size.y} + pad};
    if (std::any_of(taken.begin(), taken.end(), [&](const Bounds& other) { return overlap(box, other); })) {
      continue;
    }
    taken.push_back(box);
    to_->AddRectFilled(px(box.low), px(box.high), IM_COL32(255, 255, 255, 225), f(3 * ui_));
    to_->AddRect(px(box.low), px(box.high), ink::line, f(3 * ui_));
    to_->AddText(px(at), ink::edge, text.c_str());
  }
}

void Canvas::hand(const Hand& hand) {
  const Point from = camera_.to_screen(hand.from()), now = camera_.to_screen(hand.now());
  if (hand.doing() == Hand::Doing::boxing) {
    to_->AddRectFilled(px(from), px(now), IM_COL32(0x14, 0x5f, 0xa8, 40));
    to_->AddRect(px(from), px(now), ink::accent, 0, 0, f(ui_));
  } else if (hand.doing() == Hand::Doing::aiming) {
    to_->AddCircle(px(from), f(hand.size / 2 * camera_.scale), ink::edge, 0, f(ui_));
    arrow(*to_, from, from + (from - now), ink::edge, 2 * ui_);
  } else if (hand.doing() == Hand::Doing::dragging) {
    to_->AddCircleFilled(px(now), f(4 * ui_), ink::accent);
  }
}

// The scale of colours, and a length.
void Canvas::legend() {
  const double width = 220 * ui_, height = 10 * ui_, text = ImGui::GetFontSize();
  const Point corner{camera_.screen.low.x + 14 * ui_, camera_.screen.high.y - 16 * ui_ - height - text};
  to_->AddRectFilled(px(corner - Point{8 * ui_, 6 * ui_}),
                     px(corner + Point{width + 8 * ui_, height + text + 8 * ui_}),
                     IM_COL32(255, 255, 255, 225), f(4 * ui_));
  double from_stage = 0;
  for (const ContrastBand& band : contrast_bands) {
    if (!look_.contrast || band.below > 2) break;
    to_->AddRectFilled(px(corner + Point{width * from_stage / 2, 0}),
                       px(corner + Point{width * band.below / 2, height}), rgb(band.colour));
    from_stage = band.below;
  }
  if (look_.contrast) to_->AddRect(px(corner), px(corner + Point{width, height}), ink::edge);
  for (std::size_t i = 1; i < stage_colours.size() && !look_.contrast; ++i) {
    const ColourStop &a = stage_colours[i - 1], &b = stage_colours[i];
    if (a.stage == b.stage) continue;
    const ImU32 from = rgb(a.colour), till = rgb(b.colour);
    to_->AddRectFilledMultiColor(px(corner + Point{width * a.stage / 2, 0}),
                                 px(corner + Point{width * b.stage / 2, height}), from, till, till, from);
  }
  struct Mark {
    double at, align;
    const char* text;
  };
  for (const Mark& mark : {Mark{0, 0, "elastic"}, Mark{0.5, 0.5, "yields"}, Mark{1, 1, "breaks"}}) {
    const double shift = mark.align * ImGui::CalcTextSize(mark.text).x;
    to_->AddText(px(corner + Point{mark.at * width - shift, height + 2 * ui_}), ink::edge, mark.text);
  }
  // 1, 2 or 5 of a power of ten, at most 100 px.
  const double most = 100 * ui_ / camera_.scale, ten = std::pow(10, std::floor(std::log10(most)));
  const double metres = ten * (most >= 5 * ten ? 5 : most >= 2 * ten ? 2 : 1);
  const std::string label = si(metres, "m");
  const Point right{camera_.screen.high.x - 14 * ui_, camera_.screen.high.y - 14 * ui_};
  const Point start = right - Point{metres * camera_.scale, 0}, tick{0, 4 * ui_};
  to_->AddLine(px(start), px(right), ink::edge, f(1.5 * ui_));
  to_->AddLine(px(start - tick), px(start + tick), ink::edge, f(1.5 * ui_));
  to_->AddLine(px(right - tick), px(right + tick), ink::edge, f(1.5 * ui_));
  to_->AddText(px(right - Point{ImGui::CalcTextSize(label.c_str()).x, text + 5 * ui_}), ink::edge,
               label.c_str());
}

}  // namespace ductile::viewer
