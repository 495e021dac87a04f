// The right side of the desk, to read: the joint in focus, all joints, what happened, where energy and time
// go.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "desk.h"
#include "pick.h"
#include "plot.h"
#include "quantity.h"
#include "rows.h"

namespace ductile::viewer {
namespace {

/// Of Okabe and Ito, for every kind of colour vision.
constexpr std::array<ImU32, 7> line_colours{IM_COL32(0x00, 0x72, 0xb2, 255), IM_COL32(0xd5, 0x5e, 0x00, 255),
                                            IM_COL32(0x00, 0x9e, 0x73, 255), IM_COL32(0xcc, 0x79, 0xa7, 255),
                                            IM_COL32(0xa8, 0x80, 0x00, 255), IM_COL32(0x56, 0xb4, 0xe9, 255),
                                            IM_COL32(0x1b, 0x20, 0x27, 255)};

struct Quantity {
  const char* name;
  double (*of)(const JointReading&);
  std::string (*show)(double);
};
std::string newton(double v) { return si(v, "N"); }
std::string newton_metre(double v) { return si(v, "N m"); }
std::string radian(double v) { return si(v, "rad"); }
std::string metre(double v) { return si(v, "m"); }
std::string joule(double v) { return si(v, "J"); }
std::string microsecond(double v) { return fmt::format("{:.4g} µs", v); }
std::string count(double v) { return fmt::format("{:.4g}", v); }

constexpr std::array<Quantity, 12> quantities{
    {{"M, % of cap", [](const JointReading& j) { return j.usage.M; }, percent},
     {"N, % of cap", [](const JointReading& j) { return j.usage.N; }, percent},
     {"Q, % of cap", [](const JointReading& j) { return j.usage.Q; }, percent},
     {"M", [](const JointReading& j) { return j.M; }, newton_metre},
     {"N", [](const JointReading& j) { return j.N; }, newton},
     {"Q", [](const JointReading& j) { return j.Q; }, newton},
     {"plastic rotation", [](const JointReading& j) { return j.plastic_rotation; }, radian},
     {"accumulated rotation", [](const JointReading& j) { return j.accumulated_rotation; }, radian},
     {"plastic lengthening", [](const JointReading& j) { return j.plastic_axial; }, metre},
     {"plastic shear", [](const JointReading& j) { return j.plastic_shear; }, metre},
     {"plastic capacity used", [](const JointReading& j) { return j.capacity_used; }, percent},
     {"dissipated", [](const JointReading& j) { return j.dissipated; }, joule}}};

std::string cap_of(double positive, double negative, const char* unit) {
  if (positive == negative) return si(positive, unit);
  return si(positive, unit) + " / " + si(negative, unit);
}

}  // namespace

void Desk::details(const Bounds& box) {
  ImGui::SetNextWindowPos(px(box.low));
  ImGui::SetNextWindowSize(px(box.size()));
  ImGui::Begin("details", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  struct Tab {
    const char *name, *control, *text;
    void (Desk::*draw)();
  };
  static constexpr std::array tabs{
      Tab{"Joint", "tab joint", "Numbers, N-M diagram, section and plots of what is selected.", &Desk::joint},
      Tab{"Joints", "tab joints", "All joints as a list; selection by usage.", &Desk::joints},
      Tab{"Edit", "tab edit", "Material, depth, pieces and limits of what is selected.", &Desk::edit},
      Tab{"Events", "tab events", "What yielded and broke; a click goes there.", &Desk::events},
      Tab{"Ledger", "tab ledger", "Where the energy goes, and what a step costs.", &Desk::ledger},
      Tab{"Make", "tab make", "Beams, supports and loads; what the static check says of them.", &Desk::make}};
  if (ImGui::BeginTabBar("tabs")) {
    for (const Tab& tab : tabs) {
      const bool wanted = !first_tab_.empty() && tab.control == "tab " + first_tab_;
      const bool open = ImGui::BeginTabItem(tab.name, nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
      tip(tab.control, tab.text);
      if (!open) continue;
      (this->*tab.draw)();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
    first_tab_.clear();
  }
  ImGui::End();
}

void Desk::joint() {
  if (!bench_.focus) {
    ImGui::TextWrapped(
        "Click on a joint to see what it carries. Shift adds one more, a drag from empty ground draws a "
        "box.");
    return;
  }
  const std::size_t i = *bench_.focus;
  const PlannedJoint& planned = bench_.plan().joints[i];
  const JointReading& now = bench_.frame().joints[i];
  ImGui::TextUnformatted(planned.name.c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("%s", now.broken ? fmt::format("broke at {:.3f} s", now.broken_at).c_str()
                                       : fmt::format("{} selected", bench_.selected.size()).c_str());
  if (ImGui::BeginTable("numbers", 4, table_flags)) {
    ImGui::TableSetupColumn("");
    ImGui::TableSetupColumn("now");
    ImGui::TableSetupColumn("of cap");
    ImGui::TableSetupColumn("cap");
    ImGui::TableHeadersRow();
    row("N", {si(now.N, "N"), percent(now.usage.N), cap_of(planned.N, planned.Nc, "N")});
    row("Q", {si(now.Q, "N"), percent(now.usage.Q), si(planned.Q, "N")});
    row("M", {si(now.M, "N m"), percent(now.usage.M), cap_of(planned.M, planned.M_reverse, "N m")});
    row("rotation",
        {si(now.plastic_rotation, "rad"),
         percent(planned.max_rotation < unlimited ? now.accumulated_rotation / planned.max_rotation : NAN),
         si(planned.max_rotation, "rad")});
    row("dissipated", {si(now.dissipated, "J"), "", ""});
    ImGui::EndTable();
  }
  ImGui::ProgressBar(static_cast<float>(now.broken ? 1 : now.capacity_used), {-1, ImGui::GetFrameHeight()},
                     ("plastic capacity used: " + percent(now.broken ? 1 : now.capacity_used)).c_str());
  tip("capacity used", "Plastic deformation over the maximum that is nearest: it breaks at 100 %.");
  if (planned.governed_by >= 0) {
    const std::string& reason = bench_.plan().reasons[static_cast<std::size_t>(planned.governed_by)];
    ImGui::TextDisabled("why these limits?");
    tip("reasons", reason.c_str());
  }

  if (!diagram_ || diagram_of_ != i) diagram_ = diagram(bench_.plan(), i);
  diagram_of_ = i;
  const float width = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
  const auto height = static_cast<float>(150 * ui_);
  plot_limits(*diagram_, bench_.run(), i, {0.62f * width - gap, height}, ui_);
  tip("N-M",
      "N to the right, M up. Bold: where it yields; thin: its section's own curve; the dot: now, with where "
      "it has been.");
  ImGui::SameLine();
  plot_section(*diagram_, now, {0.38f * width, height}, ui_);
  tip("section",
      "The section where it yields with the present N: tension, compression, and the neutral axis between "
      "them. What is very thin is drawn wider.");

  ImGui::SetNextItemWidth(0.6f * width);
  if (ImGui::BeginCombo("over time", quantities[static_cast<std::size_t>(quantity_)].name)) {
    for (int k = 0; k < static_cast<int>(quantities.size()); ++k) {
      if (ImGui::Selectable(quantities[static_cast<std::size_t>(k)].name, k == quantity_)) quantity_ = k;
    }
    ImGui::EndCombo();
  }
  tip("quantity", "What is plotted over time of the selected joints.");
  const Quantity& quantity = quantities[static_cast<std::size_t>(quantity_)];
  std::vector<std::size_t> plotted{i};
  for (const std::size_t other : bench_.selected) {
    if (other != i && plotted.size() < line_colours.size()) plotted.push_back(other);
  }
  std::vector<Line> lines;
  lines.reserve(plotted.size());
  for (const std::size_t k : plotted) {
    lines.push_back({plotted.size() > 1 ? bench_.plan().joints[k].name : "", line_colours[lines.size()],
                     [k, &quantity](const Frame& frame) { return quantity.of(frame.joints[k]); }});
  }
  const float below = ImGui::GetContentRegionAvail().y - 2 * ImGui::GetTextLineHeightWithSpacing();
  seek(plot(plotted.size() > 1 ? "" : "now", bench_.run(), lines, quantity.show,
            {width, std::max(static_cast<float>(60 * ui_), below)}, ui_));
  tip("plot", "The values over the steps that are kept; a click goes there.");
  if (bench_.selected.size() > plotted.size()) {
    ImGui::TextDisabled("the first %zu of %zu", plotted.size(), bench_.selected.size());
  }
}

void Desk::joints() {
  ImGui::SetNextItemWidth(static_cast<float>(110 * ui_));
  ImGui::SliderFloat("##from", &from_share_, 0, 1, "%.2f of cap", ImGuiSliderFlags_AlwaysClamp);
  tip("from", "Share of a cap from which on a joint is selected by the button.");
  ImGui::SameLine();
  const auto select = [&](double least) { bench_.select(joints_from(bench_.frame(), least), false); };
  if (button("Select", "select from",
             "Selects the joints that use that much of a cap, and all that have yielded.")) {
    select(from_share_);
  }
  ImGui::SameLine();
  if (button("Yielded", "select yielded", "Selects what has yielded.")) select(1);
  ImGui::SameLine();
  if (button("All", "select all", "Selects all joints (ctrl+A).")) select(0);
  ImGui::SameLine();
  if (button("None", "select none", "Selects nothing (Escape).")) bench_.select({}, false);
  const Frame& frame = bench_.frame();
  const Plan& plan = bench_.plan();
  if (!ImGui::BeginTable("joints", 4, table_flags | ImGuiTableFlags_ScrollY | ImGuiTableFlags_Sortable))
    return;
  ImGui::TableSetupScrollFreeze(0, 1);
  constexpr ImGuiTableColumnFlags down = ImGuiTableColumnFlags_PreferSortDescending;
  ImGui::TableSetupColumn("joint", ImGuiTableColumnFlags_None, 3.4f);
  ImGui::TableSetupColumn("use", down | ImGuiTableColumnFlags_DefaultSort);
  ImGui::TableSetupColumn("rad", down);
  ImGui::TableSetupColumn("limit", down);
  ImGui::TableHeadersRow();
  const auto use = [&](std::size_t i) {  // of the cap that is nearest
    const auto& usage = frame.joints[i].usage;
    return std::fmax(usage.N, std::fmax(usage.Q, usage.M));
  };
  const auto value = [&](std::size_t i, int column) {
    const JointReading& joint = frame.joints[i];
    return column == 1 ? use(i) : column == 2 ? joint.accumulated_rotation : joint.capacity_used;
  };
  std::vector<std::size_t> order(plan.joints.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs && specs->SpecsCount > 0) {
    const int column = specs->Specs[0].ColumnIndex;
    const bool descends = specs->Specs[0].SortDirection == ImGuiSortDirection_Descending;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (descends) std::swap(a, b);
      return column == 0 ? plan.joints[a].name < plan.joints[b].name : value(a, column) < value(b, column);
    });
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(order.size()));
  while (clipper.Step()) {
    for (int line = clipper.DisplayStart; line < clipper.DisplayEnd; ++line) {
      const std::size_t i = order[static_cast<std::size_t>(line)];
      const JointReading& joint = frame.joints[i];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable(plan.joints[i].name.c_str(), bench_.selected.contains(i),
                            ImGuiSelectableFlags_SpanAllColumns)) {
        bench_.select({i}, ImGui::GetIO().KeyShift || ImGui::GetIO().KeyCtrl);
      }
      ImGui::PopID();
      const char* name = plan.joints[i].name.c_str();  // may be longer than the column
      if (line == 0) {
        tip("first joint", name);
      } else if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%s", name);
      }
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(joint.broken ? "broke" : percent(use(i)).c_str());
      ImGui::TableNextColumn();
      ImGui::Text("%.4f", joint.accumulated_rotation);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(percent(joint.broken ? 1 : joint.capacity_used).c_str());
    }
  }
  ImGui::EndTable();
}

void Desk::events() {
  constexpr std::array modes{"tension", "compression", "shear", "rotation"};
  const auto& events = bench_.run().events();
  if (events.empty()) ImGui::TextWrapped("Nothing has yielded or broken so far.");
  ImGui::BeginChild("events");
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(events.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const TimelineEvent& e = events[static_cast<std::size_t>(i)];
      const auto joint = static_cast<std::size_t>(e.event.joint);
      const bool broke = e.event.kind == JointEvent::broke;
      const std::string text =
          fmt::format("{:8.3f} s  {} {} in {}##{}", e.event.time, bench_.plan().joints[joint].name,
                      broke ? "breaks" : "yields", modes[static_cast<std::size_t>(e.event.mode)], i);
      if (broke) ImGui::PushStyleColor(ImGuiCol_Text, rgb(stage_colour(1.9)));
      if (ImGui::Selectable(text.c_str(), e.step == bench_.run().cursor() && bench_.focus == joint)) {
        bench_.select({joint}, false);
        seek(e.step);
      }
      if (broke) ImGui::PopStyleColor();
      if (i == 0) tip("first event", "Goes to that step and selects the joint.");
    }
  }
  ImGui::EndChild();
}

void Desk::ledger() {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 size{width, static_cast<float>(82 * ui_)};
  const auto energy = [](double Energy::*term) {
    return [term](const Frame& frame) { return frame.energy.*term; };
  };
  seek(plot("Stored", bench_.run(),
            {{"kinetic", line_colours[0], energy(&Energy::kinetic)},
             {"potential", line_colours[1], energy(&Energy::potential)},
             {"elastic", line_colours[2], energy(&Energy::elastic)}},
            joule, size, ui_));
  tip("stored energy", "Energy in the scene now; potential against where each body began.");
  seek(plot("Flowed", bench_.run(),
            {{"loads", line_colours[0], energy(&Energy::external)},
             {"plastic", line_colours[1], energy(&Energy::dissipated)},
             {"damping", line_colours[2], energy(&Energy::damping)},
             {"contacts", line_colours[3], energy(&Energy::contacts)},
             {"integration", line_colours[4], energy(&Energy::numerical)},
             {"left over", line_colours[6], energy(&Energy::total_error)}},
            joule, size, ui_));
  tip("flowed energy",
      "Since the start: work of loads; what plastic joints, dampers, contacts and implicit integration took; "
      "what is left over is an error.");
  seek(plot(
      "Solver", bench_.run(),
      {{"rounds", line_colours[0], [](const Frame& f) { return double(f.report.rounds); }},
       {"factorisations", line_colours[1], [](const Frame& f) { return double(f.report.factorisations); }},
       {"solves", line_colours[2], [](const Frame& f) { return double(f.report.solves); }}},
      count, size, ui_));
  tip("solver work",
      "Of each step: rounds of conjugate gradients, factorisations, solutions of the structure.");
  std::vector<Line> time{{"this", line_colours[0], [](const Frame& f) { return f.step_us; }}};
  if (bench_.beside()) {
    time.push_back({"beside", line_colours[1], [](const Frame& f) { return f.step_us; }, bench_.beside()});
  }
  seek(plot("b2World::Step", bench_.run(), time, microsecond, size, ui_));
  tip("step time", "Wall time of b2World::Step alone; of the run beside this one, too.");
}

}  // namespace ductile::viewer
