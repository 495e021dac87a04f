#include "ductile/level.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "rube.h"
#include "rube_world.h"

namespace ductile {
namespace {

Level level_of_plan(b2World& world, Plan plan, const StructureDef& def) {
  Built built;
  Structure structure = build(world, plan, def, &built);
  world.SetGravity(to_box2d(plan.gravity));
  Level level{std::move(plan), std::move(built), {}, {}, std::move(structure)};
  for (std::size_t i = 0; i < level.plan.pieces.size(); ++i)
    level.bodies.emplace(level.plan.pieces[i].name, level.built.bodies[i]);
  if (level.built.ground) level.bodies.emplace("ground", level.built.ground);
  for (std::size_t i = 0; i < level.plan.joints.size(); ++i)
    level.joints.emplace(level.plan.joints[i].name, level.built.joints[i]);
  return level;
}

}  // namespace

Level load_text(b2World& world, std::string_view text, const std::string& name,
                const std::filesystem::path& folder, const StructureDef& def) {
  const nlohmann::json json = parse_json(text, name);
  if (rube::is_scene(json)) {
    rube::Scene scene = rube::read(json, name);
    Plan plan = scene.plan;
    const rube::World level(std::move(scene), name);
    Structure structure(world, def);
    rube::World::Names names;
    Built built = level.make(world, plan, &structure, &names);
    return {std::move(plan), std::move(built), std::move(names.bodies), std::move(names.joints),
            std::move(structure)};
  }
  const SceneDef scene = parse_scene(text, name, folder);
  return in_file(name, [&] { return level_of_plan(world, calibrate(scene), def); });
}

Level load(b2World& world, const std::filesystem::path& file, const StructureDef& def) {
  return load_text(world, read_text(file), file.string(), file.parent_path(), def);
}

Plan parse_plan(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                std::vector<Problem>* beyond) {
  const nlohmann::json json = parse_json(text, name);
  if (!rube::is_scene(json)) {
    const SceneDef scene = parse_scene(text, name, folder);
    return in_file(name, [&] { return calibrate(scene); });
  }
  rube::Scene scene = rube::read(json, name);
  if (beyond) *beyond = std::move(scene.beyond_plan);
  Plan plan = scene.plan;
  const auto level = std::make_shared<const rube::World>(std::move(scene), name);
  plan.make = [level](b2World& world, const Plan& of, Structure* structure) {
    return level->make(world, of, structure);
  };
  return plan;
}

bool is_rube(std::string_view text) {
  try {
    return rube::is_scene(parse_json(text, ""));
  } catch (const InvalidInput&) {
    return false;
  }
}

std::string calibrated_rube(std::string_view text, const std::string& name, StockJoint as) {
  return printed(nlohmann::ordered_json(rube::read(parse_json(text, name), name, as).json));
}

}  // namespace ductile
