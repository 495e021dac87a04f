#include "workbench.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <unordered_map>
#include <utility>

#include "ductile/files.h"
#include "making.h"
#include "open.h"

namespace ductile::viewer {
namespace {

constexpr std::size_t gone = std::numeric_limits<std::size_t>::max();  // the saved version was edited away

/// Nothing in it is damped.
SceneDef undamped(SceneDef scene) {
  const auto stop = [](JointOverrides& joint) { joint.damping_ratio = 0; };
  stop(scene.joint);
  for (BodyDef& body : scene.bodies) stop(body.joint);
  for (JointBetweenDef& joint : scene.joints) stop(joint.overrides);
  return scene;
}

}  // namespace

Workbench::Workbench(std::vector<std::filesystem::path> scenes)
    : scenes_(std::move(scenes)), versions_{empty_scene()}, before_(calibrate(versions_[0])) {
  run_ = std::make_unique<Timeline>(before_);
}

void Workbench::open(const std::filesystem::path& file, double metres_per_unit) {
  put(open_file(file, metres_per_unit), file);
  metres_per_unit_ = metres_per_unit;
}

void Workbench::watch(const std::vector<std::filesystem::path>& files) {
  watched_.clear();
  for (const std::filesystem::path& file : files) {
    std::error_code none;
    watched_.push_back({file, std::filesystem::last_write_time(file, none)});
  }
}

void Workbench::read_again_if_written() {
  std::string written;
  for (Watched& watched : watched_) {
    std::error_code gone;
    const auto now = std::filesystem::last_write_time(watched.file, gone);
    if (gone || now == watched.written) continue;
    watched.written = now;
    written = watched.file.filename().string();
  }
  if (written.empty()) return;
  if (changed()) {
    message = written +
              " has been written by another program; what is edited here and not saved is kept. Open " +
              source_.filename().string() + " to have it anew.";
    return;
  }
  try {
    open(source_, metres_per_unit_);
    message = written + " has been written by another program: read again.";
  } catch (const std::exception& error) {  // it may be half written
    message = written + " has been written by another program, and cannot be read:\n" + error.what();
  }
}

void Workbench::put(Opened opened, const std::filesystem::path& source) {
  Plan plan;
  std::unique_ptr<Timeline> run;
  in_file(source.string(), [&] {
    plan = opened.level ? *opened.level : calibrate(opened.scene);
    run = std::make_unique<Timeline>(plan, solver());
  });
  // Nothing can fail from here on.
  ++edition_;
  run_ = std::move(run);
  drawing_ = false;
  before_ = std::move(plan);
  versions_ = {std::move(opened.scene)};
  editable_ = !opened.level;
  version_ = saved_ = 0;
  warned_.clear();
  file_ = std::move(opened.file);
  source_ = source;
  watch(opened.sources);
  text_ = std::move(opened.text);
  message = std::move(opened.note);
  selected.clear();
  focus.reset();
  body.reset();
  owed_ = 0;
  if (beside_) start_beside();
  check();
}

bool Workbench::may_discard(const std::string& what) {
  if (!changed() || warned_ == what) return true;
  warned_ = what;
  message = file_.filename().string() + " has been edited and is not saved. Save it, or " + what +
            " once more to lose the edits.";
  return false;
}

bool Workbench::try_open(const std::filesystem::path& file) {
  if (!may_discard("open " + file.filename().string())) return false;
  try {
    open(file);
    return true;
  } catch (const std::exception& error) {
    message = file.filename().string() + " cannot be opened.\n" + error.what();
    return false;
  }
}

bool Workbench::receive(const std::filesystem::path& file) {
  if (!bringing) return try_open(file);
  try {
    brought = part_of_file(file);
    return true;
  } catch (const std::exception& error) {
    message = file.filename().string() + " cannot be brought.\n" + error.what();
    return false;
  }
}

bool Workbench::try_new() {
  if (!may_discard("start a new scene")) return false;
  const std::filesystem::path folder = file_.parent_path();
  std::filesystem::path file = folder / "new.scene.json";
  for (int number = 2; std::filesystem::exists(file); ++number) {
    file = folder / ("new" + std::to_string(number) + ".scene.json");
  }
  put({.scene = empty_scene(), .file = file}, file);
  return true;
}

void Workbench::open_neighbour(int by) {
  if (scenes_.empty()) return;
  const auto n = static_cast<int>(scenes_.size());
  const auto here = std::find(scenes_.begin(), scenes_.end(), file_);
  const int next =
      here == scenes_.end() ? (by > 0 ? 0 : n - 1) : (static_cast<int>(here - scenes_.begin()) + by + n) % n;
  try_open(scenes_[static_cast<std::size_t>(next)]);
}

void Workbench::require_editable() const {
  if (editable_) return;
  throw InvalidInput({{file_.string(), "is a level of another editor", "edit and save it there"}});
}

void Workbench::save(const std::filesystem::path& file) {
  require_editable();
  settle();
  std::string text = edited_scene(text_, scene(), file.parent_path());
  write_text(file, text);
  text_ = std::move(text);
  file_ = source_ = file;
  metres_per_unit_ = 0;
  std::vector<std::filesystem::path> sources{file};
  for (const Watched& watched : watched_)
    if (watched.file != file) sources.push_back(watched.file);
  watch(sources);
  saved_ = version_;
  before_ = plan();
}

void Workbench::edit(SceneDef scene, bool continued) {
  require_editable();
  Plan plan = calibrate(scene);
  change(std::move(scene), std::move(plan), continued);
}

void Workbench::draw(SceneDef scene, bool continued) {
  require_editable();
  Plan plan = calibrate(undamped(scene));
  change(std::move(scene), std::move(plan), continued);
  drawing_ = true;
}

void Workbench::settle() {
  if (!drawing_) return;
  show(calibrate(scene()), solver(), run_->acts());
}

void Workbench::change(SceneDef scene, Plan plan, bool continued) {
  // What was done to pieces that are no longer there is forgotten.
  std::vector<Timeline::Entry> acts{{0, act::Set{run_->stepping()}}};
  if (plan.pieces.size() == this->plan().pieces.size()) acts = run_->acts();
  show(std::move(plan), solver(), std::move(acts));
  warned_.clear();
  if (saved_ > version_) saved_ = gone;
  versions_.resize(version_ + 1);
  if (continued && version_ > 0) {
    if (saved_ == version_) saved_ = gone;
    versions_.back() = std::move(scene);
  } else {
    versions_.push_back(std::move(scene));
    ++version_;
  }
}

void Workbench::undo() {
  if (!can_undo()) return;
  show(calibrate(versions_[version_ - 1]), solver(), {{0, act::Set{run_->stepping()}}});
  --version_;
}

void Workbench::redo() {
  if (!can_redo()) return;
  show(calibrate(versions_[version_ + 1]), solver(), {{0, act::Set{run_->stepping()}}});
  ++version_;
}

// Joints are found again by name.
void Workbench::show(Plan plan, JointSolver solver, std::vector<Timeline::Entry> acts) {
  auto run = std::make_unique<Timeline>(std::move(plan), solver, std::move(acts));
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < run->plan().joints.size(); ++i) index.emplace(run->plan().joints[i].name, i);
  const auto again = [&](std::size_t joint) -> std::optional<std::size_t> {
    const auto found = index.find(this->plan().joints[joint].name);
    return found == index.end() ? std::nullopt : std::optional(found->second);
  };
  std::set<std::size_t> still;
  for (const std::size_t joint : selected) {
    if (const auto found = again(joint)) still.insert(*found);
  }
  selected = std::move(still);
  if (focus) focus = again(*focus);
  ++edition_;
  run_ = std::move(run);
  drawing_ = false;
  owed_ = 0;
  if (beside_) start_beside();
  check();
}

void Workbench::select(const std::vector<std::size_t>& joints, bool add) {
  if (!add) selected.clear();
  selected.insert(joints.begin(), joints.end());
  if (!joints.empty()) {
    focus = joints.front();
  } else if (!add) {
    focus.reset();
  }
}

std::optional<Limits> limits_of(SceneDef& scene, const Plan& plan, std::size_t joint) {
  const PlannedJoint& planned = plan.joints[joint];
  if (planned.a < 0) return std::nullopt;
  const auto body = [&](int piece) {
    return static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body);
  };
  const std::size_t a = body(planned.a), b = body(planned.b);
  if (a == b) return Limits{&scene.bodies[a].joint, "joints inside " + scene.bodies[a].name};
  for (JointBetweenDef& between : scene.joints) {
    const std::string &first = scene.bodies[a].name, &second = scene.bodies[b].name;
    if ((between.a == first && between.b == second) || (between.a == second && between.b == first)) {
      return Limits{&between.overrides, between.a + " to " + between.b};
    }
  }
  return std::nullopt;
}

}  // namespace ductile::viewer
