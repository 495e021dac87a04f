#include "desk.h"

#include <fmt/format.h>
#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <optional>

#include "crossing.h"
#include "pick.h"
#include "prices.h"
#include "quantity.h"

#include <imgui_stdlib.h>  // after imgui.h

namespace ductile::viewer {
namespace {

constexpr double left_width = 238, right_width = 336, bottom_height = 68, narrow_bottom_height = 104,
                 least_width = 200;  // px at scale 1
constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

void place_window(const Bounds& box) {
  ImGui::SetNextWindowPos(px(box.low));
  ImGui::SetNextWindowSize(px(box.size()));
}

}  // namespace

void Desk::draw(Point size, double ui) {
  ui_ = hand_.ui_scale = ui;
  controls_.clear();
  focus_.clear();
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  rests_ = moved.x != 0 || moved.y != 0 ? 0 : rests_ + ImGui::GetIO().DeltaTime;
  if (!ImGui::IsAnyItemActive()) {
    edited_ = false;
    if (ImGui::GetFrameCount() > typing_since_ + 5) typing_ = 0;  // its slider has gone
  }
  // Beside the scene where there is room, else below it, one at a time.
  narrow_ = size.x < (left_width + right_width + least_width) * ui;
  const double left = narrow_ ? 0 : left_width * ui, right = narrow_ ? size.x : size.x - right_width * ui;
  const double top = narrow_ ? std::round(0.42 * size.y) : std::max(size.y - bottom_height * ui, 1.);
  const double bottom = narrow_ ? top + narrow_bottom_height * ui : size.y;
  camera_.screen = {{left, 0}, {right, top}};
  if (edition_ != bench_.edition()) adopt();
  panel_keys();
  const Bounds below{{0, bottom}, size}, bar{{0, top}, {size.x, bottom}},
      at_left = narrow_ ? below : Bounds{{0, 0}, {left, top}},
      at_right = narrow_ ? below : Bounds{{right, 0}, {size.x, top}};
  centre(camera_.screen);
  time(bar);
  if (!narrow_ || !details_) scene(at_left);
  if (!narrow_ || details_) details(at_right);
  if (!bench_.message.empty()) message();
  if (helping_) help();
  open_list();
  take_brought();
  if (panel_ == Panel::view) return;
  const Bounds& box = panel_ == Panel::details ? at_right : panel_ == Panel::time ? bar : at_left;
  ImGui::GetForegroundDrawList()->AddRect(px(box.low), px(box.high), ink::accent, 0, 0, f(2 * ui_));
}

void Desk::adopt() {
  edition_ = bench_.edition();
  diagram_.reset();
  const bool edited = scene_ == bench_.file().string();
  hand_.suit(bench_.plan(), edited);
  if (edited) return;
  scene_ = save_as_ = bench_.file().string();
  recent_.add(bench_.file());
  maker_.forget();
  maker_.style.price = price_of(bench_.scene(), maker_.style.material);
  maker_.block.price = price_of(bench_.scene(), maker_.block.material);
  camera_.show(extent(bench_.plan()));
  if (maker_.tool() != Maker::Tool::none) take(maker_.tool());
}

void Desk::tip(const char* name, const char* text) {
  controls_[name] = {point(ImGui::GetItemRectMin()), point(ImGui::GetItemRectMax())};
  if ((popup_ || panel_ != Panel::view) && ImGui::IsItemFocused()) focus_ = name;
  constexpr double rest = 0.4;  // s
  if (rests_ < rest || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(static_cast<float>(300 * ui_));
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool Desk::button(const char* label, const char* name, const char* text) {
  const bool pressed = ImGui::Button(label);
  tip(name, text);
  return pressed;
}

bool Desk::slide(const char* label, double& value, double low, double high, const char* format) {
  const ImGuiID id = ImGui::GetID(label);
  if (typing_ != id) {
    const char* shown = std::isfinite(value) ? format : "unlimited";
    double slid = value;
    const bool changed =
        ImGui::SliderScalar(label, ImGuiDataType_Double, &slid, &low, &high, shown,
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput |
                                (low < 0 ? ImGuiSliderFlags_None : ImGuiSliderFlags_Logarithmic));
    if (ImGui::IsItemActivated() && (ImGui::GetIO().KeyCtrl || !ImGui::IsMouseDown(ImGuiMouseButton_Left))) {
      typing_ = id;
      typing_since_ = ImGui::GetFrameCount();
      typed_ = fmt::sprintf(shown, value);
      return false;
    }
    if (changed) value = slid;
    return changed;
  }
  if (ImGui::GetFrameCount() == typing_since_ + 1) ImGui::SetKeyboardFocusHere();
  ImGui::InputText((std::string(label) + "##typed").c_str(), &typed_, ImGuiInputTextFlags_AutoSelectAll);
  if (!ImGui::IsItemDeactivated()) return false;
  typing_ = 0;
  if (!ImGui::IsItemDeactivatedAfterEdit()) return false;
  const std::string_view all = format;
  const std::size_t space = all.find(' ');
  const std::string unit(space == all.npos ? "" : all.substr(space + 1));
  const std::optional<double> now = typed(typed_, unit);
  if (!now) {
    bench_.message = "'" + typed_ + "' is no number" + (unit.empty() ? "" : " of " + unit) + ".";
    return false;
  }
  value = std::clamp(*now, low, high);
  return true;
}

bool Desk::choose(const char* label, const char* text, int& value, std::initializer_list<const char*> items) {
  const int before = value;
  const bool open = ImGui::BeginCombo(label, items.begin()[value]);
  if (open) {
    int i = 0;
    for (const char* item : items) {
      if (ImGui::Selectable(item, i == before)) value = i;
      tip((std::string(label) + ": " + item).c_str(), text);
      ++i;
    }
    ImGui::EndCombo();
  }
  tip(label, text);
  return value != before;
}

void Desk::seek(std::optional<long> step) {
  if (!step) return;
  bench_.playing = false;
  bench_.run().seek(*step);
}

void Desk::tell(std::string news) {
  constexpr double shown = 6;  // s
  news_ends_ = ImGui::GetTime() + shown;
  bench_.message = news_ = std::move(news);
}

void Desk::save() {
  try {
    bench_.save(save_as_);
    scene_ = save_as_;
    recent_.add(scene_);
    tell("Saved to " + save_as_);
    if (when_saved_) when_saved_(save_as_);
  } catch (const std::exception& error) {
    bench_.message = "Not saved.\n" + std::string(error.what());
  }
}

// The scene, and what the pointer does to it.
void Desk::centre(const Bounds& box) {
  place_window(box);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ink::ground);
  ImGui::Begin("scene view", nullptr,
               fixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleColor();
  ImGui::SetCursorScreenPos(px(box.low));
  ImGui::InvisibleButton("canvas", px(box.size()),
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const ImGuiIO& io = ImGui::GetIO();
  const Point mouse = point(io.MousePos);
  const bool over = ImGui::IsItemHovered();
  if (ImGui::IsItemActive() &&
      (ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle))) {
    camera_.pan(point(io.MouseDelta));
  }
  std::optional<std::size_t> pointed;
  if (over) {
    if (io.MouseWheel != 0) camera_.zoom(std::pow(1.15, io.MouseWheel), mouse);
    pointed =
        joint_at(bench_.plan(), bench_.frame(), camera_.to_world(mouse), Hand::reach * ui_ / camera_.scale);
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && maker_.tool() == Maker::Tool::none) {
      if (placing_) {
        hand_.put(bench_, camera_.to_world(mouse));
        placing_ = false;
      } else {
        hand_.press(camera_, mouse, {io.KeyShift, io.KeyCtrl});
      }
    }
  }
  if (hand_.doing() != Hand::Doing::nothing) {
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
      hand_.move(bench_, camera_, mouse);
    } else {
      hand_.release(bench_, camera_, mouse);
    }
  }
  const int edition = bench_.edition();
  if (maker_.tool() != Maker::Tool::none) make_with(mouse, over);
  if (bench_.edition() != edition) pointed.reset();  // joints have other numbers now
  ImDrawList& to = *ImGui::GetWindowDrawList();
  const bool making = maker_.tool() != Maker::Tool::none && bench_.run().cursor() == 0;
  if (making) draw_grid(to);
  canvas_.draw(to, bench_, camera_, look_, hand_, ui_, pointed);
  constexpr std::array solvers{"direct", "iterative", "stock"};
  const std::string title =
      fmt::format("{}{}   {:.3f} s   {} solver{}{}", bench_.file().filename().string(),
                  bench_.changed() ? " (changed)" : "", bench_.frame().time,
                  solvers[static_cast<std::size_t>(bench_.solver())], look_.peaks ? "   peaks so far" : "",
                  placing_ ? "   click: a mass" : "");
  to.AddText(px(box.low + ui_ * Point{12, 10}), ink::edge, title.c_str());
  double line = 10;
  for (const std::string& text : {crossing_text(bench_.frame()), bench_.beside_text()}) {
    if (!making && !text.empty())
      to.AddText(px(box.low + ui_ * Point{12, line += 18}), ink::edge, text.c_str());
  }
  if (making) draw_making(to);
  // Beside a tool it would cover what is being made.
  const bool asks = maker_.tool() == Maker::Tool::none || (!maker_.start() && rests_ > 0.8);
  if (pointed && asks && hand_.doing() == Hand::Doing::nothing) {
    const JointReading& joint = bench_.frame().joints[*pointed];
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(bench_.plan().joints[*pointed].name.c_str());
    if (joint.broken) {
      ImGui::Text("broke at %.3f s", joint.broken_at);
    } else {
      ImGui::Text("N %s  %s\nQ %s  %s\nM %s  %s", si(joint.N, "N").c_str(), percent(joint.usage.N).c_str(),
                  si(joint.Q, "N").c_str(), percent(joint.usage.Q).c_str(), si(joint.M, "N m").c_str(),
                  percent(joint.usage.M).c_str());
    }
    ImGui::EndTooltip();
  }
  ImGui::End();
}

// What went wrong stays until it is closed; what has been done, for a while.
void Desk::message() {
  if (bench_.message == news_ && ImGui::GetTime() > news_ends_) return bench_.message.clear();
  const double width = std::min(520 * ui_, camera_.screen.size().x - 40 * ui_);
  ImGui::SetNextWindowPos(px({camera_.screen.middle().x, 52 * ui_}), ImGuiCond_Always, {0.5f, 0});
  ImGui::SetNextWindowSize({static_cast<float>(width), 0});
  bool open = true;
  ImGui::Begin("Message", &open,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  constexpr std::size_t most = 1200;  // bytes: a file full of mistakes tells its first ones
  const std::string text =
      bench_.message.size() > most ? bench_.message.substr(0, most) + " …" : bench_.message;
  ImGui::TextWrapped("%s", text.c_str());
  if (button("Close", "close message", "Closes this message.")) open = false;
  ImGui::End();
  if (!open) bench_.message.clear();
}

void Desk::time(const Bounds& box) {
  place_window(box);
  ImGui::Begin("time", nullptr, fixed | ImGuiWindowFlags_NoScrollbar);
  const auto gap = static_cast<float>(16 * ui_);
  const auto next_group = [&] {  // on a line of its own where it is narrow
    if (!narrow_) ImGui::SameLine(0, gap);
  };
  if (button("Restart", "restart", "Back to the start, with nothing thrown in (R).")) bench_.restart();
  ImGui::SameLine();
  if (button("<", "back", "One step back (,).")) bench_.step_by(-1);
  ImGui::SameLine();
  if (button(bench_.playing ? "Pause" : "Play ", "play", "Plays or pauses (P).")) {
    bench_.playing = !bench_.playing;
  }
  ImGui::SameLine();
  if (button(">", "step", "One step on (O).")) bench_.step_by(1);
  if (narrow_) {
    ImGui::SameLine(0, gap);
    panel_buttons();
  }
  next_group();
  ImGui::SetNextItemWidth(static_cast<float>(110 * ui_));
  slide("pace", bench_.pace, 0.01, 4, "%.2f x");
  tip("pace", "Seconds of the scene per second: slow motion to the left.");
  ImGui::SameLine(0, gap);
  ImGui::SetNextItemWidth(static_cast<float>(90 * ui_));
  int stop = static_cast<int>(bench_.stop_at);
  if (choose("stop at", "Pauses by itself when a joint yields or breaks.", stop,
             {"never", "yield", "break"})) {
    bench_.stop_at = static_cast<Workbench::StopAt>(stop);
  }
  next_group();
  if (button("First yield", "first yield", "Rewinds to the step in which the first joint yielded (Y).") &&
      !bench_.seek_first(JointEvent::yield)) {
    bench_.message = "Nothing has yielded so far.";
  }
  ImGui::SameLine();
  if (button("First break", "first break", "Rewinds to the step in which the first joint broke (B).") &&
      !bench_.seek_first(JointEvent::broke)) {
    bench_.message = "Nothing has broken so far.";
  }
  if (bench_.run().busy() && bench_.run().progress() < 0.999) {
    ImGui::SameLine(0, gap);
    ImGui::TextColored({0.5f, 0.3f, 0, 1}, "simulating again: %.0f %%", 100 * bench_.run().progress());
  }
  if (!narrow_) {
    ImGui::SameLine(static_cast<float>(box.size().x - 70 * ui_));
    if (button("Keys", "keys", "What keys and pointer do (H).")) helping_ = !helping_;
  }
  time_slider();
  ImGui::End();
}

// Which of the panels is seen, where there is room for one.
void Desk::panel_buttons() {
  if (button("Scene", "panel scene", "Which scene, how it is run, what is drawn of it.")) details_ = false;
  ImGui::SameLine();
  if (button("Details", "panel details", "Joints, edits, events, energy.")) details_ = true;
}

// All steps seen so far, with a mark for each event.
void Desk::time_slider() {
  const Timeline& run = bench_.run();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float label = static_cast<float>(190 * ui_);
  const Point low = point(corner), size{width - label, 26 * ui_};
  ImGui::InvisibleButton("time slider", px(size));
  const long last = std::max(1L, run.last());
  const auto x = [&](long step) {
    return static_cast<float>(low.x + size.x * static_cast<double>(step) / static_cast<double>(last));
  };
  if (ImGui::IsItemActive()) {
    const double share = std::clamp((ImGui::GetIO().MousePos.x - low.x) / size.x, 0., 1.);
    seek(std::lround(share * static_cast<double>(last)));
  }
  tip("time slider",
      "The steps so far: click or drag to look at another. Yellow: a joint yielded; red: one broke.");
  ImDrawList& to = *ImGui::GetWindowDrawList();
  const Point high = low + size;
  to.AddRectFilled(px(low), px(high), ink::ground, static_cast<float>(3 * ui_));
  to.AddRectFilled(px(low), {x(run.cursor()), static_cast<float>(high.y)}, IM_COL32(0xd3, 0xdc, 0xe6, 255),
                   static_cast<float>(3 * ui_));
  float drawn[2] = {-1, -1};  // where the last mark of each kind is: thousands of them may share a pixel
  for (const TimelineEvent& event : run.events()) {
    const bool broke = event.event.kind == JointEvent::broke;
    const float at = std::round(x(event.step));
    if (drawn[broke] == at) continue;
    drawn[broke] = at;
    const auto top = static_cast<float>(low.y + (broke ? 1 : 8) * ui_);
    to.AddLine({at, top}, {at, static_cast<float>(high.y)}, rgb(stage_colour(broke ? 1.9 : 1)),
               static_cast<float>(2 * ui_));
  }
  to.AddRect(px(low), px(high), ink::line, static_cast<float>(3 * ui_));
  to.AddLine({x(run.cursor()), static_cast<float>(low.y)}, {x(run.cursor()), static_cast<float>(high.y)},
             ink::edge, static_cast<float>(3 * ui_));
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::Text("%.3f s, step %ld of %ld", bench_.frame().time, run.cursor(), run.last());
}

}  // namespace ductile::viewer
