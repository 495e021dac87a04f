// ductile's files: section files, scene files and SVG drawings (docs/section.schema.json,
// docs/scene.schema.json).
//
// Everything that reads throws InvalidInput with every problem found; a problem's place is
// `file:line:column` where the syntax fails, and `file:bodies[1].split.pieces` or `drawing.svg:#arm, command
// 7` where a value does. Shapes are parsed here and judged by the rooms that use them: Section, calibrate().
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/section.h"

namespace ductile {

/// The regions of a section file.
std::vector<Region> read_section(const std::filesystem::path& file);
/// The same from memory; `name` is what problems call it.
std::vector<Region> parse_section(std::string_view text, const std::string& name = "section");

/// A scene file with all that it names: drawings and profiles are looked for relative to it.
SceneDef read_scene(const std::filesystem::path& file);
/// The same from memory; `folder` is what the files that it names are relative to. `named`, if given, becomes
/// the list of these files: drawings and sections.
SceneDef parse_scene(std::string_view text, const std::string& name = "scene",
                     const std::filesystem::path& folder = ".",
                     std::vector<std::filesystem::path>* named = nullptr);

/// A scene file's name without folder and endings: "B1-1" of scenes/B1-1.scene.json.
std::string scene_name(const std::filesystem::path& file);

/// The text of a scene file that reads back as `scene`. Drawn outlines become rings, profiles are written in
/// place.
std::string scene_text(const SceneDef& scene);

/// The same into the text of a scene file: what has changed is changed where it stands; links to drawings and
/// section files, order, layout and comments stay. `folder` is where the text will be. What is no scene, or
/// cannot be changed so, becomes scene_text().
std::string edited_scene(std::string_view text, const SceneDef& scene,
                         const std::filesystem::path& folder = ".");

/// How outlines are taken from a drawing.
struct DrawingScale {
  double metres_per_unit =
      0;                 ///< of the viewBox's units; 0: from the drawing's physical size (width, height)
  double tolerance = 0;  ///< m, between a curve and its chords; 0: 1e-4 of the diagonal of the shape's points
};

/// What a drawing shows.
struct DrawnShapes {
  struct Shape {
    std::string name;  ///< id, label or title, else "path 7"; with a number where it has several areas
    Outline outline;
  };
  std::vector<Shape> shapes;      ///< in the order in which they are painted
  std::vector<Problem> left_out;  ///< what is shown and could not be taken: text, images, broken paths
};

/// An SVG drawing as a browser shows it: what is hidden or only defined is no shape, style sheets count, a
/// line is as wide as its stroke, clip paths cut. docs/files/svg.md has what is taken and what is not. y is
/// flipped at the bottom of the viewBox, x stays.
class Drawing {
 public:
  explicit Drawing(const std::filesystem::path& file);
  Drawing(std::string_view text, std::string name);

  /// What is painted of the element with that id, inkscape:label or title, in metres. A problem where that is
  /// not one connected area, or something in it is not understood. An element that the page does not show is
  /// taken, too, when it is asked for.
  Outline outline(std::string_view id, const DrawingScale& scale = {}) const;

  /// All that the page shows. One bad shape is left out, not the drawing.
  DrawnShapes shapes(const DrawingScale& scale = {}) const;

  /// Names of what the page shows, in document order.
  std::vector<std::string> ids() const;

  /// What problems call it.
  const std::string& name() const;

  /// Does it say how large it is in the world ("200mm")? Else a scale must be given.
  bool sized() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Is it a drawing? Told by its first character: what is no drawing is JSON.
bool is_drawing(std::string_view text);

/// A first scene of a drawing, to look at and to go on from: every shape is a body of S355, a twentieth of
/// the drawing thick, above a floor, not joined to the others: one that bends, as a frame drawn as one stroke
/// does, is split "auto", a straight or solid one into up to 8 pieces. What reaches down to the floor is held
/// there.
struct DrawnScene {
  SceneDef scene;
  double scale = 0;  ///< metres per unit, where the drawing did not say it and it became 10 m large
  std::vector<Problem> left_out;  ///< as in DrawnShapes
  int too_thin = 0;               ///< bodies that Box2D could not collide, and that collide with nothing
  int heaped = 0;  ///< bodies that lie over others by more than 1e-3 of the drawing; these do not collide
};
/// Throws InvalidInput where the drawing shows nothing that is a body. `metres_per_unit` as DrawingScale has
/// it.
DrawnScene drawing_scene(const Drawing& drawing, double metres_per_unit = 0);

/// The file's bytes, unpacked where gzip packed them. A problem when it cannot be read, or is larger than 256
/// MiB.
std::string read_text(const std::filesystem::path& file);

/// A file that appears whole or not at all: written beside its place, and put there by keep(). What is there
/// already stays until then; a device or a pipe is written to directly. SIGHUP, SIGINT and SIGTERM remove it,
/// where the program has left these to end it. Throws std::system_error.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(std::string_view text);
  /// What is written is on the disk, or this throws; keep() begins with it.
  void close();
  void keep();

 private:
  std::filesystem::path target_, fresh_;  // equal for a device
  std::ofstream out_;
};

/// The same in one go.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace ductile
