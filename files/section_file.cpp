#include "section_file.h"

#include <filesystem>
#include <string>
#include <string_view>

#include "ductile/files.h"

namespace ductile {

void read_strength(Object& object, Material& material) {
  object.read(fields::strength, material);
  object.choice("criterion", material.criterion,
                {{"tresca", Criterion::tresca}, {"von_mises", Criterion::von_mises}});
}

std::optional<Material> built_in_material(const Value& name, const std::vector<std::string_view>& also) {
  const auto text = name.text();
  if (!text) return std::nullopt;
  if (const Material* found = materials::find(*text)) return *found;
  std::vector<std::string_view> names = also;
  for (const NamedMaterial& material : materials::all()) names.push_back(material.name);
  return wrong_choice(name, names), std::nullopt;
}

namespace {
Region read_region(const Value& value) {
  Region region;
  Object object(value);
  if (const auto outer = object.require("outer")) region.outline.outer = outer->ring().value_or(Ring{});
  if (const auto holes = object.find("holes")) {
    region.outline.holes = holes->rings().value_or(std::vector<Ring>{});
  }
  if (const auto material = object.require("material")) {
    if (material->json().is_string()) {
      region.material = built_in_material(*material).value_or(Material{});
    } else {
      Object strength(*material);
      read_strength(strength, region.material);
    }
  }
  return region;
}
}  // namespace

std::vector<Region> read_regions(const Value& value) {
  std::vector<Region> regions;
  if (value.json().is_object() && value.json().contains("bodies")) {
    value.wrong("has \"bodies\": this is a scene",
                "a section has \"regions\"; a scene goes to ductile calibrate");
    return regions;
  }
  Object object(value);
  if (const auto list = object.require("regions")) {
    for (const Value& element : list->elements()) regions.push_back(read_region(element));
    if (list->json().is_array() && regions.empty())
      list->wrong("is empty", "a section has at least one region");
  }
  return regions;
}

std::vector<Region> parse_section(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  Problems problems(name);
  auto regions = read_regions(Value(json, "top level", problems));
  problems.check();
  return regions;
}

std::vector<Region> read_section(const std::filesystem::path& file) {
  return parse_section(read_text(file), file.string());
}

}  // namespace ductile
