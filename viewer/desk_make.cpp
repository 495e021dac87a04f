// Making things in the window: the tools and what they make, and the keys that move them.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "controls.h"
#include "desk.h"
#include "prices.h"

namespace ductile::viewer {
namespace {

using Tool = Maker::Tool;

struct ToolButton {
  Tool tool;
  const char *label, *control, *text;
};
// In the order of their keys.
constexpr std::array tools{
    ToolButton{Tool::none, "1 look", "tool look", "The pointer selects, drags and throws (1)."},
    ToolButton{Tool::beam, "2 beam", "tool beam",
               "Drag from one end to the other: it is pinned to what is there (2)."},
    ToolButton{Tool::support, "3 support", "tool support",
               "On a beam: a hinge; once more a roller, clamped, springs, nothing (3)."},
    ToolButton{Tool::load, "4 load", "tool load", "On a beam: a force; once more: none (4)."},
    ToolButton{Tool::move, "5 move", "tool move", "Drag a node, or a body, with all that hangs on it (5)."},
    ToolButton{Tool::remove, "6 delete", "tool delete",
               "On a load, a support, a line, or else a body: it goes (6, or Delete)."},
    ToolButton{Tool::line, "7 line", "tool line",
               "Drag a rope, a strut or a jack from one body to another (7)."},
    ToolButton{Tool::node, "8 weld", "tool node", "On a node: its beams are welded; once more: pinned (8)."},
    ToolButton{Tool::choose, "9 choose", "tool choose",
               "Drag a box around bodies, or click on one, to copy, mirror, turn, move or delete them; "
               "shift: more (9). The grip above turns them."},
    ToolButton{Tool::block, "0 block", "tool block",
               "Click corner after corner of a polygon, and its first or last one once more (0)."},
    ToolButton{Tool::cut, "- cut", "tool cut",
               "Drag across a body: it is cut there, instead of into equal pieces (-)."}};

}  // namespace

void Desk::make() {
  if (button("New", "new", "A floor and nothing else (ctrl+N; alt+N in a browser).")) start_new();
  ImGui::SameLine();
  if (button("Open", "open", "A file: of those that were opened last, or of a folder (ctrl+O)."))
    ask_for_file();
  ImGui::SameLine();
  ImGui::BeginDisabled(!bench_.editable());
  if (button(
          "Import", "import",
          "What a scene, a drawing or a level has, beside what is there: then click where it goes (ctrl+I)."))
    ask_for_file(true);
  ImGui::EndDisabled();
  if (!bench_.editable()) return ImGui::TextWrapped("A level is made in the editor that it comes from.");
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine(static_cast<float>(105 * ui_ * static_cast<double>(i % 3)));
    if (ImGui::RadioButton(tools[i].label, maker_.tool() == tools[i].tool)) take(tools[i].tool);
    tip(tools[i].control, tools[i].text);
  }
  with_chosen();
  const auto now = std::find_if(tools.begin(), tools.end(),
                                [this](const ToolButton& t) { return t.tool == maker_.tool(); });
  ImGui::TextWrapped("%s", now != tools.end()              ? now->text
                           : maker_.tool() == Tool::mirror ? "Click where the mirror stands."
                           : maker_.tool() == Tool::turn   ? "Click on the point about which it turns."
                                                           : "Click where its lowest node goes.");
  ImGui::Separator();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.52f);
  if (maker_.tool() == Tool::support) {
    double stiffness = maker_.stiffness / 1e3;
    if (slide("springs", stiffness, 1e-3, 1e9, "%.4g kN/m")) maker_.stiffness = 1e3 * stiffness;
    tip("spring stiffness", "Of the next springs, across and upright.");
  } else if (maker_.tool() == Tool::load) {
    load_style();
  } else if (maker_.tool() == Tool::line) {
    line_style();
  } else if (maker_.tool() == Tool::block) {
    block_style();
  } else if (maker_.tool() == Tool::turn) {
    slide("angle", maker_.turn_by, -180, 180, "%.4g °");
    tip("turn angle", "By which a click turns what is chosen, counter-clockwise.");
  } else {
    beam_style(maker_.style);
  }
  if (maker_.tool() == Tool::block) {
    if (!maker_.block.fixed) price(maker_.block.material, maker_.block.price);
  } else {
    price(maker_.style.material, maker_.style.price);
  }
  slide("grid", maker_.grid, 0.01, 10, "%.3g m");
  tip("grid", "What the cursor snaps to where no node is near.");
  ImGui::PopItemWidth();
  ImGui::Separator();
  ImGui::TextWrapped("%s", bench_.verdict().c_str());
  if (const double all = cost(bench_.plan()); all > 0) ImGui::Text("It costs %.4g.", all);
}

void Desk::price(const Material& material, double& price) {
  const bool changed = slide("price", price, 0, 1000, "%.4g /kg");
  tip("price",
      "Of a kg of all that moves and is made of this material, in whatever currency: the cost is told "
      "below.");
  const auto& bodies = bench_.scene().bodies;
  const bool is_used = std::any_of(bodies.begin(), bodies.end(),
                                   [&](const BodyDef& body) { return body.material == material; });
  commit(changed && is_used, with_price(bench_.scene(), material, price));
}

void Desk::load_style() {
  LoadStyle& load = maker_.load;
  double force = load.force / 1e3;
  if (slide("load", force, 1e-3, 1e6, "%.4g kN")) load.force = 1e3 * force;
  tip("load force", "Of the next load.");
  slide("direction", load.direction, -180, 180, "%.4g °");
  tip("load direction", "Of the next load, counter-clockwise from the right: -90 is down.");
  slide("ramp", load.ramp, 0, 60, "%.3g s");
  tip("load ramp", "Over which the next load grows, evenly; 0: it is there at once.");
}

// What can be done with the bodies that are chosen.
void Desk::with_chosen() {
  const std::size_t chosen = maker_.chosen(bench_).size();
  ImGui::BeginDisabled(chosen == 0);
  if (button("Copy", "copy", "What is chosen, with what holds, loads and joins it (ctrl+C).")) copy();
  ImGui::SameLine();
  if (button("Cut", "cut", "Copies it, and takes it away (ctrl+X).")) cut();
  ImGui::SameLine();
  if (button("Mirror", "mirror",
             "Then click where the mirror stands: what is chosen is there twice (ctrl+M)."))
    take(Tool::mirror);
  ImGui::SameLine();
  if (button(
          "Turn", "turn",
          "Then click on the point about which it turns, by the angle that is given below (ctrl+T; alt+T in "
          "a browser)."))
    take(Tool::turn);
  ImGui::EndDisabled();
  ImGui::BeginDisabled(!maker_.can_paste());
  if (button("Paste", "paste", "Then click where its lowest node goes (ctrl+V).")) take(Tool::paste);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(chosen == 0);
  if (button("Group", "group", "What is chosen is chosen and moved as one from now on (ctrl+G).")) group();
  ImGui::SameLine();
  if (button("Ungroup", "ungroup", "Each by itself again (ctrl+shift+G).")) maker_.ungroup(bench_);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextDisabled("%zu chosen", chosen);
}

void Desk::copy() {
  if (!maker_.copy(bench_))
    bench_.message = "Nothing is chosen. Draw a box around what is meant, with the tool for that (9).";
}

void Desk::group() {
  if (!maker_.group(bench_)) bench_.message = "A group takes two bodies or more: choose them first (9).";
}

void Desk::cut() {
  copy();
  maker_.remove_chosen(bench_);
}

void Desk::line_style() {
  LineStyle& line = maker_.line;
  int kind = static_cast<int>(line.kind);
  if (choose(
          "line",
          "What the next line is: a rope pulls, a strut pushes, a spring does both, a winch is a rope that "
          "is wound in, a jack grows or shortens.",
          kind, {"rope", "strut", "spring", "winch", "jack"})) {
    line.kind = static_cast<LineStyle::Kind>(kind);
  }
  if (line.kind == LineStyle::Kind::spring) {
    double stiffness = line.stiffness / 1e3;
    if (slide("stiffness", stiffness, 1e-3, 1e9, "%.4g kN/m")) line.stiffness = 1e3 * stiffness;
    tip("line stiffness", "Of the next spring.");
  }
  if (line.kind != LineStyle::Kind::winch && line.kind != LineStyle::Kind::jack) return;
  double force = line.force / 1e3;
  if (slide("force", force, 1e-3, 1e6, "%.4g kN")) line.force = 1e3 * force;
  tip("jack force", "With which the next jack or winch pushes or pulls at most.");
  slide("stroke", line.stroke, -5, 5, "%.3g m");
  tip("jack stroke", "By how much it grows; shortens, to the left.");
  slide("speed", line.speed, 1e-3, 10, "%.3g m/s");
  tip("jack speed", "How fast it does.");
}

void Desk::block_style() {
  BlockStyle& block = maker_.block;
  int moves = block.fixed ? 0 : 1;
  if (choose("block", "Whether the next polygon stands still, as a bank or a pier, or moves.", moves,
             {"stands", "moves"}))
    block.fixed = moves == 0;
  if (block.fixed) return;
  if (choose_material(block.material)) block.price = price_of(bench_.scene(), block.material);
  tip("block material", "Of the next polygon.");
  slide("depth", block.depth, 0.001, 10, "%.3g m");
  tip("block depth", "Of the next polygon, out of the plane.");
}

void Desk::start_new() {
  if (bench_.try_new()) take(Tool::beam);
}

void Desk::take(Tool tool) {
  if (!bench_.editable()) tool = Tool::none;
  maker_.choose(bench_, tool);
  if (tool != Tool::none) first_tab_ = "make";
}

// True where a key was the tool's in the hand and nobody else's.
bool Desk::make_keys() {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const int digit = static_cast<int>(i);
    if (key(i < 9 ? GLFW_KEY_1 + digit : i == 9 ? GLFW_KEY_0 : GLFW_KEY_MINUS)) take(tools[i].tool);
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
  const bool shift = ImGui::GetIO().KeyShift;
  if (key(GLFW_KEY_ENTER)) maker_.start() ? maker_.release(bench_, shift) : maker_.press(bench_);
  if (key(GLFW_KEY_DELETE) && !(maker_.tool() == Tool::choose && maker_.remove_chosen(bench_))) {
    const Tool before = maker_.tool();
    take(Tool::remove);
    maker_.press(bench_);
    take(before);
  }
  if (key(GLFW_KEY_ESCAPE))
    maker_.start() || !maker_.corners().empty() ? maker_.cancel(bench_) : take(Tool::none);
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
  if (clicked) {
    adds_ = io.KeyShift;
    const auto grip = maker_.turn_grip(bench_, grip_arm * ui_ / camera_.scale);
    if (grip && length(camera_.to_screen(grip->at) - mouse) < Hand::reach * ui_)
      maker_.take_grip(bench_, *grip);
    else
      maker_.press(bench_);
  }
  if (ImGui::IsMouseReleased(ImGuiMouseButton_Left)) maker_.release(bench_, adds_);
}

}  // namespace ductile::viewer
