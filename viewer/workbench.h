// The scene on the bench: opened, run, looked at, changed, saved. Knows no window.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/design.h"
#include "open.h"
#include "timeline.h"

namespace ductile::viewer {

class Workbench {
 public:
  /// `scenes` are offered as a list.
  explicit Workbench(std::vector<std::filesystem::path> scenes = {});

  // --- the scene ---
  /// Another scene. Throws, with everything as it was, where the file cannot be used.
  void open(const std::filesystem::path& file, double metres_per_unit = 0);
  /// The same as a user asks for it: what is wrong becomes the message, and so does what would be lost; false
  /// then. Asked again, edits that are not saved are lost.
  bool try_open(const std::filesystem::path& file);
  /// What comes next is to be put beside what is there: receive() keeps it as `brought`.
  bool bringing = false;
  std::optional<SceneDef> brought;
  /// A file that a user chooses or drops: opened as by try_open(), or brought. False: the message says why
  /// not.
  bool receive(const std::filesystem::path& file);
  /// Whether edits that are not saved may go: the first time that something asks for it, a message says that
  /// doing `what` again discards them.
  bool may_discard(const std::string& what);
  /// The next or the previous of the list, around its ends.
  void open_neighbour(int by);
  /// Reads the scene again where its file, or a drawing or section that it names, has been written since by
  /// another program. What has been edited here and is not saved stays, with a message.
  void read_again_if_written();
  /// A scene with nothing but a floor, in the place of this one, to be saved beside it under a name that no
  /// file has yet. As try_open() it does not lose edits unless asked again.
  bool try_new();
  /// Whether there is a scene to edit and save; a R.U.B.E. level has none.
  bool editable() const { return editable_; }
  /// What was not edited stays in the file as it stood. Throws std::system_error; InvalidInput where it is
  /// not editable.
  void save(const std::filesystem::path& file);
  /// Puts another scene in the place of this one and runs it from the start; undo() takes it back. Throws
  /// InvalidInput, with everything as it was. `continued`: it replaces the last edit, as a slider does while
  /// it is dragged.
  void edit(SceneDef scene, bool continued = false);
  /// The same while something is being drawn, as fast as its check allows: dampers, whose constants take the
  /// structure's lowest frequency, are left out until settle(), or until it is played or saved.
  void draw(SceneDef scene, bool continued);
  void settle();
  void undo();
  void redo();
  bool can_undo() const { return version_ > 0; }
  bool can_redo() const { return version_ + 1 < versions_.size(); }
  /// Something has changed since it was opened or saved.
  bool changed() const { return version_ != saved_; }

  const std::vector<std::filesystem::path>& scenes() const { return scenes_; }
  const std::filesystem::path& file() const { return file_; }
  const SceneDef& scene() const { return versions_[version_]; }
  const Plan& plan() const { return run_->plan(); }
  /// As it was opened or saved last.
  const Plan& plan_before() const { return before_; }
  /// Another number whenever the plan is another one.
  int edition() const { return edition_; }

  // --- the run ---
  Timeline& run() { return *run_; }
  const Timeline& run() const { return *run_; }
  /// What is seen: of the run, or at its start of the static check where that is shown.
  const Frame& frame() const { return at_rest_ && run_->cursor() == 0 ? *at_rest_ : run_->frame(); }
  JointSolver solver() const { return run_->solver(); }
  /// The same scene and acts with another solver, up to the step that is looked at.
  void set_solver(JointSolver solver);
  /// From the cursor on.
  void set_stepping(const Stepping& stepping);
  void act(const Act& what);
  /// Back to the start, with nothing thrown in.
  void restart();
  /// Looks at the first yield or break; false where there has been none.
  bool seek_first(JointEvent::Kind kind);
  void step_by(long steps);

  bool playing = true;
  double pace = 1;  ///< seconds of the scene per second
  enum class StopAt { never, yield, broke } stop_at = StopAt::never;
  /// Time goes on by `seconds`, of which `budget` may be spent on simulating.
  void tick(double seconds, double budget);

  /// How another run of the same is made beside this one.
  struct Beside {
    JointSolver solver = JointSolver::stock;
    double dt = 0;  ///< s; 0: of this run
  };
  /// It is looked at when this one is; null where there is none.
  const Timeline* beside() const { return beside_.get(); }
  const std::optional<Beside>& how_beside() const { return how_beside_; }
  void run_beside(std::optional<Beside> how);
  /// How far it has come apart from this one, and what of each has yielded and broken; empty where there is
  /// none.
  std::string beside_text() const;

  /// Whether the forces of the static check are shown before the first step.
  void check_at_rest(bool on);
  /// What the check says, in a line: the factor on all loads until the first yield, or why there is none.
  /// Empty: not shown.
  const std::string& verdict() const { return verdict_; }

  /// How the scene as drawn collapses under its loads, where that has been asked for.
  const LimitAnalysis* collapse() const { return collapse_ ? &*collapse_ : nullptr; }
  /// Asks for it, at the start of the run; the load at which it does, or why there is none, is the message.
  void find_collapse();
  void forget_collapse() { collapse_.reset(); }

  // --- what the user looks at ---
  std::set<std::size_t> selected;    ///< joints
  std::optional<std::size_t> focus;  ///< the joint whose details show
  std::optional<std::size_t> body;   ///< of the plan: the one that is edited
  void select(const std::vector<std::size_t>& joints, bool add);
  std::string message;  ///< for the user; empty: none

 private:
  /// On the bench, from `source`.
  void put(Opened opened, const std::filesystem::path& source);
  void show(Plan plan, JointSolver solver, std::vector<Timeline::Entry> acts);
  void change(SceneDef scene, Plan plan, bool continued);
  void start_beside();
  long step_beside() const;
  void check();
  void require_editable() const;
  void watch(const std::vector<std::filesystem::path>& files);

  std::vector<std::filesystem::path> scenes_;
  std::filesystem::path file_;
  std::string text_;              // as it was opened or saved; empty: it was no scene file
  std::filesystem::path source_;  // it was opened from
  double metres_per_unit_ = 0;
  struct Watched {
    std::filesystem::path file;
    std::filesystem::file_time_type written;
  };
  std::vector<Watched> watched_;
  std::vector<SceneDef> versions_;
  std::size_t version_ = 0, saved_ = 0;
  bool editable_ = true;
  std::string warned_;  // of losing edits by this
  Plan before_;
  int edition_ = 0;
  std::unique_ptr<Timeline> run_, beside_;
  std::optional<Beside> how_beside_;
  bool checks_ = false;
  std::optional<Frame> at_rest_;  // with the forces of the static check; none where nothing decides them
  std::string verdict_;
  std::optional<LimitAnalysis> collapse_;  // of this edition
  bool drawing_ = false;                   // the plan has no dampers
  double owed_ = 0;                        // s of the scene that are to be shown
};

/// Does what may be refused: the reason becomes the bench's message.
template <class F>
void attempt(Workbench& bench, const F& f) {
  try {
    f();
  } catch (const InvalidInput& error) {
    bench.message = "This cannot be.\n" + std::string(error.what());
  }
}

/// The overrides that govern a joint, and what they are called; null for a support, which has none.
struct Limits {
  JointOverrides* overrides;
  std::string of;  ///< "joints inside beam", "wall to beam"
};
std::optional<Limits> limits_of(SceneDef& scene, const Plan& plan, std::size_t joint);

}  // namespace ductile::viewer
