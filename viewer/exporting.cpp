#include "exporting.h"

#include <array>
#include <filesystem>

#include "ductile/definitions.h"
#include "ductile/files.h"
#include "ductile/picture.h"
#include "ductile/replay.h"

namespace ductile::viewer {
namespace {

std::string title(const Workbench& bench) { return scene_name(bench.file()); }

std::string cpp(const Workbench& bench) { return cpp_text(bench.plan(), function_name(title(bench))); }

std::string picture(const Workbench& bench) {
  Panel panel{.time = bench.frame().time};
  for (const PieceReading& piece : bench.frame().pieces) panel.pieces.push_back(piece);
  for (const JointReading& joint : bench.frame().joints) panel.joints.push_back(joint);
  return picture_svg(bench.plan(), {.title = title(bench), .subtitle = bench.verdict(), .panels = {panel}});
}

/// The run as far as it has been seen, done again.
std::string replay(const Workbench& bench) {
  Timeline run(bench.plan(), bench.solver(), bench.run().acts(), 0);
  Replay replay(bench.plan());
  replay.take(run.simulation());
  while (run.cursor() < bench.run().last()) {
    run.go_to(run.cursor() + 1);
    replay.take(run.simulation());
  }
  return replay.page(title(bench), run.simulation());
}

constexpr std::array formats{
    ExportFormat{"Box2D definitions", ".box2d.json",
                 "Bodies, fixtures and joints as data, for Box2D 2.4 and 3.",
                 [](const Workbench& bench) { return box2d_text(bench.plan()); }},
    ExportFormat{"C++ source", ".cpp", "A function that makes the scene in a b2World with ductile's joints.",
                 cpp},
    ExportFormat{"R.U.B.E. level", ".rube.json", "For players of R.U.B.E. levels.",
                 [](const Workbench& bench) { return rube_text(bench.plan()); }},
    ExportFormat{"picture", ".svg", "What is seen of the scene now, as SVG.", picture},
    ExportFormat{"replay", ".html", "The run so far as a page that plays it back.", replay}};

}  // namespace

std::string link_text(const Workbench& bench) {
  if (!bench.editable())
    throw InvalidInput({{bench.file().string(), "is a level of another editor", "pass its file on"}});
  return scene_text(bench.scene());
}

std::span<const ExportFormat> export_formats() { return formats; }

}  // namespace ductile::viewer
