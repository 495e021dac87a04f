// Making things in the window: the tools and what they make, the cursor, and the keys that move it.
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "desk.h"
#include "quantity.h"

namespace ductile::viewer {
namespace {

using Tool = Maker::Tool;

struct ToolButton {
  Tool tool;
  const char *label, *control, *text;
};
constexpr std::array tools{
    ToolButton{Tool::none, "1 look", "tool look", "The pointer selects, drags and throws (1)."},
    ToolButton{Tool::beam, "2 beam", "tool beam",
               "Drag from one end to the other: it is pinned to what is there (2)."},
    ToolButton{Tool::support, "3 support", "tool support",
               "On a beam: a hinge; once more a roller, clamped, nothing (3)."},
    ToolButton{Tool::load, "4 load", "tool load", "On a beam: a force downwards; once more: none (4)."},
    ToolButton{Tool::move, "5 move", "tool move", "Drag the end of beams, with all that is there (5)."},
    ToolButton{Tool::remove, "6 delete", "tool delete",
               "On a load, a support, or else a beam: it goes (6, or Delete)."}};

bool key(int glfw_key, bool repeat = false) { return ImGui::IsKeyPressed(glfw_key, repeat); }

bool slide(const char* label, double& value, double low, double high, const char* format) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format,
                             ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}

}  // namespace

void Desk::make() {
  if (button("New", "new", "A floor and nothing else (ctrl+N).")) start_new();
  ImGui::SameLine();
  if (button("Open", "open", "The file that is named on the left, above Save (ctrl+O).")) open_named();
  if (!bench_.editable()) return ImGui::TextWrapped("A level is made in the editor that it comes from.");
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine(static_cast<float>(105 * ui_ * static_cast<double>(i % 3)));
    if (ImGui::RadioButton(tools[i].label, maker_.tool() == tools[i].tool))
      maker_.choose(bench_, tools[i].tool);
    tip(tools[i].control, tools[i].text);
  }
  ImGui::Separator();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.52f);
  BeamStyle& style = maker_.style;
  const auto is = [&](const NamedMaterial& known) { return known.material == style.material; };
  const auto& all = materials::all();
  const auto now = std::find_if(all.begin(), all.end(), is);
  if (ImGui::BeginCombo("material", now == all.end() ? "its own" : std::string(now->name).c_str())) {
    for (const NamedMaterial& known : all) {
      if (ImGui::Selectable(std::string(known.name).c_str(), is(known))) style.material = known.material;
    }
    ImGui::EndCombo();
  }
  tip("beam material", "Of the next beam.");
  slide("height", style.height, 0.01, 10, "%.3g m");
  tip("beam height", "Of the next beam, in the plane.");
  slide("depth", style.depth, 0.001, 10, "%.3g m");
  tip("beam depth", "Of the next beam, out of the plane.");
  ImGui::SliderInt("pieces", &style.pieces, 1, 60, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("beam pieces", "Into how many the next beam is split.");
  double kilonewtons = maker_.force / 1e3;
  if (slide("load", kilonewtons, 1e-3, 1e6, "%.4g kN")) maker_.force = 1e3 * kilonewtons;
  tip("load force", "Of the next load, downwards.");
  slide("grid", maker_.grid, 0.01, 10, "%.3g m");
  tip("grid", "What the cursor snaps to where no node is near.");
  ImGui::PopItemWidth();
  ImGui::Separator();
  ImGui::TextWrapped("%s", bench_.verdict().c_str());
}

void Desk::start_new() {
  if (bench_.try_new()) take(Tool::beam);
}

void Desk::open_named() {
  if (bench_.try_open(save_as_)) take(Tool::none);
}

void Desk::take(Tool tool) {
  if (!bench_.editable()) tool = Tool::none;
  maker_.choose(bench_, tool);
  if (tool != Tool::none) first_tab_ = "make";
}

// True where a key was the tool's in the hand and nobody else's.
bool Desk::make_keys() {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (key(GLFW_KEY_1 + static_cast<int>(i))) take(tools[i].tool);
  }
  if (maker_.tool() == Tool::none) {
    if (!key(GLFW_KEY_DELETE) || !bench_.body || !bench_.editable()) return false;
    const std::string name = bench_.scene().bodies[*bench_.body].name;
    commit(true, without_body(bench_.scene(), name));
    bench_.body.reset();
    return true;
  }
  const int columns = key(GLFW_KEY_RIGHT, true) - key(GLFW_KEY_LEFT, true),
            rows = key(GLFW_KEY_UP, true) - key(GLFW_KEY_DOWN, true);
  if (columns != 0 || rows != 0) maker_.step(bench_, columns, rows);
  if (key(GLFW_KEY_E)) maker_.next_node(bench_, 1);
  if (key(GLFW_KEY_Q)) maker_.next_node(bench_, -1);
  if (key(GLFW_KEY_ENTER)) maker_.start() ? maker_.release(bench_) : maker_.press(bench_);
  if (key(GLFW_KEY_DELETE)) {
    const Tool before = maker_.tool();
    take(Tool::remove);
    maker_.press(bench_);
    take(before);
  }
  if (key(GLFW_KEY_ESCAPE)) maker_.start() ? maker_.cancel(bench_) : take(Tool::none);
  return true;
}

// The pointer over the scene, with a tool in the hand.
void Desk::make_with(Point mouse, bool over) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool clicked = over && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  const bool moved = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;  // the keys have the cursor otherwise
  if (clicked || (moved && (over || maker_.start()))) {
    const double reach = std::min(Hand::reach * ui_ / camera_.scale, 0.6 * maker_.grid);
    maker_.point(bench_, camera_.to_world(mouse), reach);
  }
  if (clicked) maker_.press(bench_);
  if (ImGui::IsMouseReleased(ImGuiMouseButton_Left)) maker_.release(bench_);
}

// Below the scene.
void Desk::draw_grid(ImDrawList& to) const {
  const Point low = camera_.to_world({camera_.screen.low.x, camera_.screen.high.y}),
              high = camera_.to_world({camera_.screen.high.x, camera_.screen.low.y});
  const double grid = maker_.grid;
  if (grid * camera_.scale < 8 * ui_) return;
  for (double x = grid * std::ceil(low.x / grid); x <= high.x; x += grid) {
    for (double y = grid * std::ceil(low.y / grid); y <= high.y; y += grid) {
      to.AddCircleFilled(px(camera_.to_screen({x, y})), static_cast<float>(ui_), ink::line, 4);
    }
  }
}

// Nodes, what holds the scene, and the cursor.
void Desk::draw_making(ImDrawList& to) const {
  const auto f = [this](double value) { return static_cast<float>(value * ui_); };
  for (const Point node : nodes(bench_.scene())) {
    const ImVec2 at = px(camera_.to_screen(node));
    to.AddCircleFilled(at, f(3.5), ink::ground);
    to.AddCircle(at, f(3.5), ink::edge, 0, f(1.5));
  }
  for (const SupportDef& support : bench_.scene().supports) {
    const Point at = camera_.to_screen(support.at);
    const Point left = at + ui_ * Point{-8, 14}, right = at + ui_ * Point{8, 14};
    if (support.fix_angle) {
      to.AddRectFilled(px(at + ui_ * Point{-8, 4}), px(right), ink::accent);
    } else {
      to.AddTriangle(px(at + ui_ * Point{0, 3}), px(left), px(right), ink::accent, f(2));
    }
    if (!support.fix_x)
      to.AddLine(px(left + ui_ * Point{0, 4}), px(right + ui_ * Point{0, 4}), ink::accent, f(2));
  }
  const Point cursor = maker_.cursor(), at = camera_.to_screen(cursor);
  const Point across{7 * ui_, 0}, up{0, 7 * ui_};
  to.AddLine(px(at - across), px(at + across), ink::accent, f(2));
  to.AddLine(px(at - up), px(at + up), ink::accent, f(2));
  std::string text = fmt::format("{:.4g}, {:.4g} m", cursor.x, cursor.y);
  if (maker_.start()) text += fmt::format("   {} long", si(length(cursor - *maker_.start()), "m"));
  to.AddText(px(at + ui_ * Point{10, -20}), ink::accent, text.c_str());
  to.AddText(px(camera_.screen.low + ui_ * Point{12, 28}), ink::edge, bench_.verdict().c_str());
}

}  // namespace ductile::viewer
