// Levels from files, in one call: ductile scenes, written or drawn, and R.U.B.E. scenes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/calibrate.h"
#include "ductile/definitions.h"
#include "ductile/joint.h"

namespace ductile {

/// What a file became in a world, which owns it. Call structure.update() after each Step, and, where the plan
/// has loads, apply_loads(world, plan, built, time) before it.
struct Level {
  Plan plan;                                    ///< the bodies and joints that ductile knows
  Built built;                                  ///< the same in the world
  std::multimap<std::string, b2Body*> bodies;   ///< all that were made, by name
  std::multimap<std::string, b2Joint*> joints;  ///< likewise, with those of other kinds
  Structure structure;
};

/// Makes a level in `world` and sets the world's gravity: a scene file with the drawings that it names, or a
/// R.U.B.E. scene (docs/files/rube.md) whose bodies name materials. The content of a file decides which it
/// is. Throws InvalidInput with every problem, before the world has changed.
Level load(b2World& world, const std::filesystem::path& file, const StructureDef& def = {});
/// The same from memory; `name` is what problems call it, `folder` what the files that it names are relative
/// to.
Level load_text(b2World& world, std::string_view text, const std::string& name = "level",
                const std::filesystem::path& folder = ".", const StructureDef& def = {});

/// The plan of such a text: calibrated, for commands and tools that work on plans. Built in a world, that of
/// a R.U.B.E. scene brings all of it along (Plan::make): ropes, motors, sensors. `beyond`, if given, becomes
/// the list of joints that the plan itself knows nothing of, and statics therefore leaves out.
Plan parse_plan(std::string_view text, const std::string& name = "level",
                const std::filesystem::path& folder = ".", std::vector<Problem>* beyond = nullptr);

/// Is it a R.U.B.E. scene? Told by its keys; false for what is no JSON.
bool is_rube(std::string_view text);

/// A R.U.B.E. scene with its joints calibrated, as text; everything else stands there as it did.
std::string calibrated_rube(std::string_view text, const std::string& name = "level",
                            StockJoint as = StockJoint::hinge);

}  // namespace ductile
