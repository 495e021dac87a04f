// What is in the window: the scene in the middle, controls around it. All state of the scene is the
// workbench's; here is how it is looked at.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "canvas.h"
#include "diagram.h"
#include "maker.h"
#include "recent.h"
#include "workbench.h"

namespace ductile::viewer {

class Desk {
 public:
  /// `tab`: "joint", "joints", "edit", "events", "ledger" or "make" is open at first.
  explicit Desk(Workbench& bench, bool forces = false, std::string tab = "")
      : bench_(bench), first_tab_(std::move(tab)) {
    look_.forces = look_.moments = forces;
  }

  /// One frame, of `size` px; `ui`: pixels per pixel of a window at scale 1.
  void draw(Point size, double ui);

  /// How a file is asked for, instead of by the list of what was opened last and of a folder.
  void when_opening(std::function<void()> what) { when_opening_ = std::move(what); }
  /// Where the names of files that are opened are kept for the next time.
  void keep_recent(const std::filesystem::path& list) { recent_ = Recent(list); }
  /// What is done with a file after it has been saved: a page hands it over to the user.
  void when_saved(std::function<void(const std::filesystem::path&)> what) { when_saved_ = std::move(what); }

  /// Where a link can carry a scene: what is done with its name and text to make one. Offered as an export.
  void when_linking(std::function<void(const std::string& name, const std::string& text)> what) {
    when_linking_ = std::move(what);
  }

  /// How far the grip that turns is above what is chosen, px at scale 1.
  static constexpr double grip_arm = 28;

  const Camera& camera() const { return camera_; }
  const Maker& maker() const { return maker_; }
  /// The box of every control of the last frame, px, by name.
  const std::map<std::string, Bounds>& controls() const { return controls_; }
  /// The control that has the keys; empty: the scene has them.
  const std::string& focus() const { return focus_; }

 private:
  void adopt();  // another scene or plan has come
  void keys();
  void panel_keys();
  void centre(const Bounds& box);
  void scene(const Bounds& box);
  void run();
  void beside();
  void show();
  void throwing();
  void time(const Bounds& box);
  void time_slider();
  void panel_buttons();
  void details(const Bounds& box);
  void joint();
  void joints();
  void edit();
  void material(SceneDef& scene, BodyDef& body);
  void limits(SceneDef& scene);
  void events();
  void ledger();
  void message();
  /// Good news, which goes away by itself.
  void tell(std::string news);
  void help();
  void make();
  void with_chosen();
  void copy();
  void cut();
  void group();
  /// `price`: of a kg of that material, in what is made next.
  void price(const Material& material, double& price);
  void load_style();
  void line_style();
  void block_style();
  void size_for_reserve(const BodyDef& body);
  void body_type(SceneDef& scene, BodyDef& body);
  void beam_style(BeamStyle& style);
  bool section_style(BeamStyle& style);
  void beam_section(const SceneDef& scene, const BodyDef& beam);
  bool choose_material(Material& material);
  bool choose_profile(std::string& profile);
  bool make_keys();
  void make_with(Point mouse, bool over);
  void draw_grid(ImDrawList& to) const;
  void draw_chosen(ImDrawList& to) const;
  void draw_making(ImDrawList& to) const;
  void take(Maker::Tool tool);
  void start_new();
  /// `beside`: for what is put beside what is there.
  void ask_for_file(bool beside = false);
  void take_brought();
  void open_list();

  void save();
  void exports();
  /// Puts a changed scene on the bench where a control `changed` it; wrong values become the message.
  void commit(bool changed, SceneDef scene);
  /// To be called right after a control: its name, and what it does, for whoever rests the pointer on it.
  void tip(const char* name, const char* text);
  bool button(const char* label, const char* name, const char* text);
  /// A slider, fine at both ends of a range that has no negative numbers. Ctrl + click, or Enter by keys,
  /// types a value, in the unit that `format` ends with or another one.
  bool slide(const char* label, double& value, double low, double high, const char* format);
  /// One of several.
  bool choose(const char* label, const char* text, int& value, std::initializer_list<const char*> items);
  void seek(std::optional<long> step);

  Workbench& bench_;
  std::function<void()> when_opening_;
  std::function<void(const std::filesystem::path&)> when_saved_;
  std::function<void(const std::string&, const std::string&)> when_linking_;
  std::string first_tab_;  // to be opened in the next frame
  Camera camera_;
  Canvas canvas_;
  Look look_;
  Hand hand_;
  Maker maker_;
  double ui_ = 1;
  int edition_ = -1;
  std::filesystem::path file_;   // of the scene that is shown
  std::string save_as_, scene_;  // what is typed; what was opened
  Recent recent_;
  std::filesystem::path folder_, listed_;         // of the list from which a file is opened
  std::vector<std::filesystem::path> in_folder_;  // what it has
  std::string open_filter_;                       // what is typed to find one of it
  std::string profile_filter_;                    // what is typed to find one
  std::map<std::string, Bounds> controls_;
  std::string focus_;
  std::optional<Diagram> diagram_;  // of the joint in focus
  std::size_t diagram_of_ = 0;
  bool edited_ = false;   // by the control that is being dragged
  ImGuiID typing_ = 0;    // the slider whose value is being typed
  int typing_since_ = 0;  // frame
  std::string typed_;
  std::string news_;
  double news_ends_ = 0;     // s of ImGui::GetTime()
  double rests_ = 0;         // s since the pointer moved
  float from_share_ = 0.9f;  // of "select from"
  int quantity_ = 0;
  double reserve_ = 1.5;  // that a body is sized for
  bool adds_ = false;     // to what is chosen, what the pointer is choosing
  bool placing_ = false, helping_ = false, exporting_ = false, opening_ = false;
  enum class Panel { view, details, time, scene } panel_ = Panel::view;  // that has the keys
  bool popup_ = false;                                                   // a list or menu has them
  bool narrow_ = false, details_ = false;  // one panel at a time; the one on the right
};

}  // namespace ductile::viewer
