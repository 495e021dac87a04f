// A scene file with other values: what has changed is changed where it stands.
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "json.h"
#include "json_text.h"
#include "scene_text.h"

namespace ductile {
namespace {

using Json = nlohmann::ordered_json;
using Path = JsonText::Path;

class SceneEdit {
 public:
  SceneEdit(std::string_view text, const SceneDef& before, const SceneDef& after)
      : text_(std::string(text)), file_(parse_json(text, "scene")), before_(before), after_(after) {}

  std::string run() {
    Json was = scene_json(before_), is = scene_json(after_);
    materials();
    for (Json* scene : {&was, &is}) {
      scene->erase("materials");
      for (Json& body : (*scene)["bodies"]) body.erase("material");
    }
    for (std::size_t i = 0; i < after_.bodies.size(); ++i) {
      const BodyDef& body = after_.bodies[i];
      if (body.material && !named(before_, body.name)) is["bodies"][i]["material"] = name_of(*body.material);
    }
    edit(was, is, Path());
    return text_.text();
  }

 private:
  static const BodyDef* named(const SceneDef& scene, const std::string& name) {
    const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                    [&](const BodyDef& body) { return body.name == name; });
    return found == scene.bodies.end() ? nullptr : &*found;
  }

  /// What the file calls a material of a body that comes.
  std::string name_of(const Material& material) {
    if (const auto known = built_in_name(material)) return *known;
    for (std::size_t i = 0; i < before_.bodies.size(); ++i) {
      const BodyDef* other = named(after_, before_.bodies[i].name);
      if (other && other->material == material && before_.bodies[i].material == material)
        return file_["bodies"][i].value("material", "");
    }
    return new_material("material", material);
  }

  /// A material that all its bodies have changed alike changes in the list; a body that goes its own way gets
  /// a material of its own.
  void materials() {
    std::vector<std::string> done;
    for (std::size_t i = 0; i < before_.bodies.size(); ++i) {
      const BodyDef& body = before_.bodies[i];
      const BodyDef* other = named(after_, body.name);
      if (!other || !other->material || !body.material || *other->material == *body.material) continue;
      const std::string name = file_["bodies"][i].value("material", "");
      if (std::find(done.begin(), done.end(), name) != done.end()) continue;
      const Path at = Path("/bodies") / i / "material";
      if (const auto known = built_in_name(*other->material)) {
        text_.set(at, *known);
        continue;
      }
      const bool own = file_.contains("materials") && file_["materials"].contains(name);
      bool alike = true;
      for (std::size_t k = 0; k < before_.bodies.size(); ++k) {
        if (file_["bodies"][k].value("material", "") != name) continue;
        const BodyDef* with = named(after_, before_.bodies[k].name);
        alike &= with && with->material == other->material;
      }
      if (own && alike) {
        done.push_back(name);
        const Path entry = Path("/materials") / name;
        if (file_["materials"][name].is_object())
          edit(material_json(*body.material), material_json(*other->material), entry);
        else
          text_.set(entry, material_json(*other->material));
        continue;
      }
      text_.set(at, new_material(name, *other->material));
    }
  }

  std::string new_material(const std::string& like, const Material& material) {
    for (const auto& [name, known] : fresh_)
      if (known == material) return name;
    if (!file_.contains("materials")) {
      text_.set(Path("/materials"), Json::object());
      file_["materials"] = nlohmann::json::object();
    }
    std::string name;
    for (int n = 2; name.empty() || file_["materials"].contains(name); ++n)
      name = like + " " + std::to_string(n);
    file_["materials"][name] = nullptr;
    text_.set(Path("/materials") / name, material_json(material));
    fresh_.emplace_back(name, material);
    return name;
  }

  /// Turns what `was` written canonically at `at` into what it `is`.
  void edit(const Json& was, const Json& is, const Path& at) {
    if (was == is) return;
    const bool in_file = at.empty() || file_.contains(at);
    if (in_file && was.is_object() && is.is_object() && (at.empty() || file_[at].is_object())) {
      for (const auto& [key, value] : is.items()) {
        if (was.contains(key))
          edit(was[key], value, at / key);
        else
          text_.set(at / key, value);
      }
      for (const auto& [key, value] : was.items())
        if (!is.contains(key) && file_.contains(at / key)) text_.erase(at / key);
      return;
    }
    const auto of_objects = [](const Json& list) {
      return list.is_array() && !list.empty() && list[0].is_object();
    };
    if (in_file && of_objects(was) && of_objects(is)) return edit_list(was, is, at);
    text_.set(at, is);
  }

  /// Elements are the same where they have the same name; without one, where they stand at the same place of
  /// the list, or, where it has become longer or shorter, are at the same point of the scene.
  void edit_list(const Json& was, const Json& is, const Path& at) {
    std::vector<std::size_t> partner(was.size(), is.size());
    std::size_t j = 0;
    for (std::size_t i = 0; i < was.size(); ++i) {
      for (std::size_t k = j; k < is.size(); ++k) {
        const bool same = was[i].contains("name")   ? is[k].value("name", "") == was[i]["name"]
                          : was.size() == is.size() ? k == i
                          : was[i].contains("at")   ? is[k].value("at", Json()) == was[i]["at"]
                                                    : is[k] == was[i];
        if (!same) continue;
        partner[i] = k;
        j = k + 1;
        break;
      }
    }
    for (std::size_t i = was.size(); i-- > 0;) {  // from the end: what is before stays where it is
      if (partner[i] < is.size())
        edit(was[i], is[partner[i]], at / i);
      else
        text_.erase(at / i);
    }
    for (std::size_t k = j; k < is.size(); ++k) text_.append(at, is[k]);
  }

  JsonText text_;
  nlohmann::json file_;
  const SceneDef &before_, &after_;
  std::vector<std::pair<std::string, Material>> fresh_;
};

}  // namespace

std::string edited_scene(std::string_view text, const SceneDef& scene, const std::filesystem::path& folder) {
  try {
    std::string edited = SceneEdit(text, parse_scene(text, "scene", folder), scene).run();
    // Where that is not the scene, as when elements have changed places, all of it is written anew.
    if (scene_text(parse_scene(edited, "scene", folder)) == scene_text(scene)) return edited;
  } catch (const InvalidInput&) {  // `text` is no scene, or its files are not to be found from the folder
  }
  return scene_text(scene);
}

}  // namespace ductile
