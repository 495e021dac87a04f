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
/// The same from memory; `folder` is what the files that it names are relative to.
SceneDef parse_scene(std::string_view text, const std::string& name = "scene",
                     const std::filesystem::path& folder = ".");

/// The text of a scene file that reads back as `scene`. Drawn outlines become rings, profiles are written in
/// place.
std::string scene_text(const SceneDef& scene);

/// How outlines are taken from a drawing.
struct DrawingScale {
  double metres_per_unit =
      0;                 ///< of the viewBox's units; 0: from the drawing's physical size (width, height)
  double tolerance = 0;  ///< m, between a curve and its chords; 0: 1e-4 of the diagonal of the shape's points
};

/// An SVG drawing. Shapes are path, rect, circle, ellipse, polygon, polyline, and `use` of one; a group
/// stands for the one shape in it. y is flipped at the bottom of the viewBox, x stays.
class Drawing {
 public:
  explicit Drawing(const std::filesystem::path& file);
  Drawing(std::string_view text, std::string name);

  /// The filled area of the element with that id, or else inkscape:label, in metres: its fill-rule decides
  /// what is outer ring and what is hole. A problem where that is not one connected area, or something in it
  /// is not understood.
  Outline outline(std::string_view id, const DrawingScale& scale = {}) const;

  /// Ids (labels where there is no id) of the shapes, in document order.
  std::vector<std::string> ids() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// The file's bytes. A problem when it cannot be read, or is larger than 256 MiB.
std::string read_text(const std::filesystem::path& file);

/// A file that appears whole or not at all: written beside its place, and put there by keep(). What is there
/// already stays until then; a device or a pipe is written to directly. Throws std::system_error.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(std::string_view text);
  void keep();

 private:
  std::filesystem::path target_, fresh_;  // equal for a device
  std::ofstream out_;
};

/// The same in one go.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace ductile
