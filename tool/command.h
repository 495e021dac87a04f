// The commands of the tool: each registers itself with its options, and returns what it prints.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/design.h"
#include "ductile/files.h"

namespace ductile::tool {

/// Keys in the order in which the contract lists them.
using Json = nlohmann::ordered_json;

/// Adds one command to `app`; when it is the one that was called, parsing runs it and puts what it prints
/// into `output`, so that nothing is printed of a command that fails.
void add_section(CLI::App& app, std::string& output);
void add_materials(CLI::App& app, std::string& output);
void add_calibrate(CLI::App& app, std::string& output);
void add_simulate(CLI::App& app, std::string& output);
void add_check(CLI::App& app, std::string& output);
void add_limit(CLI::App& app, std::string& output);
void add_design(CLI::App& app, std::string& output);
void add_report(CLI::App& app, std::string& output);
void add_view(CLI::App& app, std::string& output);

/// Thrown by a command whose output is printed all the same, but does not hold what was asked for: exit 1.
struct Unsolved : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The file that a command works on.
struct SceneFile {
  std::string name;
  double metres_per_unit = 0;  ///< of a drawing; 0: as it says itself, else it is 10 m large
  operator const std::string&() const { return name; }
};
/// SCENE and --scale.
void add_scene(CLI::App* command, SceneFile& scene,
               const char* what = "scene file, level of R.U.B.E. or SVG drawing");
/// Refuses what is neither a profile's name nor a file.
void check_profile(const std::string& name, const std::string& option);
/// --scale alone.
void add_scale(CLI::App* command, double& metres_per_unit);

/// Files to be written, by the options that name them; a file "" is none.
using Outputs = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Refuses to write two outputs to one file.
void keep_apart(const Outputs& outputs);

/// Refuses to write an output over a file that is read.
void keep_inputs(const std::vector<std::string>& inputs, const Outputs& outputs);

/// On one line, whatever names a file brings along.
std::string one_line(std::string text);

/// Outputs, all of which can be written before any is: they appear together, or none of them does.
class NewFiles {
 public:
  explicit NewFiles(const Outputs& outputs);
  void write(const std::string& file, std::string_view text);
  void write_pictures(const std::vector<std::string>& files, std::string_view svg);
  void keep();

 private:
  std::map<std::string, NewFile> files_;
};

/// The scene of a drawing or a scene file, whose text it is; warnings of what was not taken on stderr.
/// Refuses to write an output over a file that the scene names.
SceneDef scene_of(const SceneFile& file, const std::string& text, const Outputs& outputs);

/// What becomes of a level's joints that no plan holds, as ropes and motors.
enum class NotInPlan {
  made,      ///< in the world that is built of the plan, with all that the level says besides
  left_out,  ///< with a warning on stderr
  refused,
};

/// Says on stderr which automatic splits do not reach their target error.
void warn_of_splits(const Plan& plan, const SceneFile& file);

/// The plan of a drawing or a scene file, with another target error for its automatic splits if one is given,
/// or of a R.U.B.E. scene; what is wrong with it is said of that file. `outputs` as scene_of() has them.
Plan plan_of(const SceneFile& file, NotInPlan rest, const Outputs& outputs,
             std::optional<double> target_error = std::nullopt);

/// "ground" for −1.
std::string piece_name(const Plan& plan, int piece);

std::string joint_name(const Plan& plan, int joint);

/// "first order; buckles at 1.2 times the loads": what check and limit say of stability.
std::string buckling_line(bool second_order, double critical_load_factor);

/// Whether EN 1993 speaks of it: E within a tenth of 210 GPa.
bool is_steel(const Material& material);

/// Of each body with a profile of rolled.h, in steel: its classes by EN 1993-1-1 Table 5.2, as lines of a
/// table and for
/// --json.
std::string profile_lines(const Plan& plan);
Json profiles_json(const Plan& plan);

/// JSON of a number; null where it is infinite (unlimited) or NaN (does not exist).
Json number(double value);
/// The same for a table: "-" where it is unlimited or does not exist.
std::string shown(double value);

/// Names in the order in which they came, the first few of them.
std::string list_of(const std::vector<std::string>& names);

/// What one has to know of a plan's capacities, a remark each: which bodies break before a hinge turns, or
/// whether a drawing seems to be in millimetres, for two. As lines of a table and for --json.
std::vector<std::string> remarks(const Plan& plan);
/// And of what may become of it under its loads.
std::vector<std::string> remarks(const Plan& plan, const CriticalLoad& critical,
                                 const std::vector<MissedMoment>& missed);
std::string lines(const std::vector<std::string>& remarks);
/// What no joint holds, by name: statics leaves it out with its weight. And as a line of a table, where there
/// is something.
std::vector<std::string> loose_names(const Plan& plan);
std::string loose_line(const Plan& plan);

/// A section of more metres than this was drawn in millimetres.
inline constexpr double too_high = 20;

/// ε_f/ε_y: how many times its yield strain a material bears; infinite where E is not known.
double ductility(const Material& material);
/// What a plastic moment needs of it.
inline constexpr double least_ductility = 5;

/// What a picture of it is called: "scenes/harbour_crane.scene.json" is "Harbour crane".
std::string title_of(const std::string& scene_file);

/// Accepts all names of files but "".
CLI::Validator file_name();

/// --picture FILE, as often as one likes.
CLI::Option* add_picture(CLI::App* command, std::vector<std::string>& files, const std::string& what);

/// Accepts finite numbers from `low`; above it only where `open`.
CLI::Validator finite(double low, bool open = false);

}  // namespace ductile::tool
