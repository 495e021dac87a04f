// Outlines out of a drawing: of one element by its name, or of all that the page shows.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "svg_document.h"

namespace ductile {

struct Drawing::Data {
  svg::Document document;
  Data(std::string_view text, std::string name) : document(text, std::move(name)) {}

  [[noreturn]] void refuse(const std::string& place, const std::string& what,
                           const std::string& remedy) const {
    throw InvalidInput({{document.name + ":" + place, what, remedy}});
  }
  svg::Affine page(const DrawingScale& scale) const {
    try {
      return document.page(scale);
    } catch (const svg::ShapeError& error) {
      refuse(error.place, error.what(), error.remedy);
    }
  }
  std::vector<Outline> areas(const svg::Painted& shape, const DrawingScale& scale,
                             std::vector<Problem>* mended = nullptr) const;
  svg::Painted the_one(std::string_view id, const svg::Affine& page, std::size_t& part) const;
};

/// The connected areas of a shape, the largest first; none where nothing of it is seen. Tells what is mended.
std::vector<Outline> Drawing::Data::areas(const svg::Painted& shape, const DrawingScale& scale,
                                          std::vector<Problem>* mended) const {
  if (shape.problem) throw InvalidInput({*shape.problem});
  try {
    const double size = document.extent(shape);
    const double tolerance = scale.tolerance > 0 ? scale.tolerance : 1e-4 * size;
    if (!(size > 0)) return {};
    svg::Areas areas = document.areas(shape, tolerance);
    if (mended && areas.slivers > 0) {
      char metres[32];
      std::snprintf(metres, sizeof metres, "%.2g", tolerance);
      mended->push_back({document.name + ":#" + shape.name,
                         "has " + std::to_string(areas.slivers) +
                             (areas.slivers == 1 ? " sliver, an area or a gap" : " slivers, areas or gaps") +
                             " thinner than " + metres + " m",
                         "draw wider what shall be there"});
    }
    return std::move(areas.outlines);
  } catch (const svg::ShapeError& error) {
    refuse("#" + shape.name + ", " + error.place, error.what(), error.remedy);
  }
}

Drawing::Drawing(const std::filesystem::path& file) : Drawing(read_text(file), file.string()) {}

Drawing::Drawing(std::string_view text, std::string name)
    : data_(std::make_shared<const Data>(text, std::move(name))) {}

const std::string& Drawing::name() const { return data_->document.name; }

bool Drawing::sized() const {
  try {
    return data_->document.sized();
  } catch (const svg::ShapeError& error) {
    data_->refuse(error.place, error.what(), error.remedy);
  }
}

std::vector<std::string> Drawing::ids() const {
  std::vector<std::string> ids;
  for (const svg::Painted& shape : data_->document.shown(data_->page({.metres_per_unit = 1})).shapes)
    ids.push_back(shape.name);
  return ids;
}

DrawnShapes Drawing::shapes(const DrawingScale& scale) const {
  DrawnShapes drawn;
  svg::Shown shown = data_->document.shown(data_->page(scale));
  drawn.left_out = std::move(shown.not_taken);
  for (const svg::Painted& shape : shown.shapes) {
    try {
      auto areas = data_->areas(shape, scale, &drawn.left_out);
      for (std::size_t i = 0; i < areas.size(); ++i) {
        drawn.shapes.push_back(
            {areas.size() == 1 ? shape.name : shape.name + " " + std::to_string(i + 1), std::move(areas[i])});
      }
    } catch (const InvalidInput& error) {
      drawn.left_out.insert(drawn.left_out.end(), error.problems().begin(), error.problems().end());
    }
  }
  return drawn;
}

/// The shape that is asked for. Where it has several areas, "name 2" is the second: `part`, from 1; 0: all.
svg::Painted Drawing::Data::the_one(std::string_view id, const svg::Affine& page, std::size_t& part) const {
  const std::string place = "#" + std::string(id);
  part = 0;
  const auto named = [&](std::vector<svg::Painted> shapes, std::string_view name) {
    std::erase_if(shapes, [&](const svg::Painted& shape) {
      return std::find(shape.names.begin(), shape.names.end(), name) == shape.names.end();
    });
    return shapes;
  };
  const auto shown = document.shown(page).shapes;
  auto found = named(shown, id);
  const pugi::xml_node element = document.find(id);
  if (found.empty() && element) {
    try {
      svg::Shown held = document.held(element, page);
      found = named(std::move(held.shapes), id);
      if (found.empty() && !held.not_taken.empty())
        refuse(place, held.not_taken.front().what, held.not_taken.front().remedy);
    } catch (const svg::ShapeError& error) {  // of what is around it
      refuse(place + ", " + error.place, error.what(), error.remedy);
    }
  }
  const auto space = id.rfind(' ');
  if (found.empty() && !element && space != std::string_view::npos && id.size() - space < 8) {
    const std::string_view number = id.substr(space + 1);
    if (number.find_first_not_of("0123456789") == std::string_view::npos && !number.empty()) {
      found = named(shown, id.substr(0, space));
      part = static_cast<std::size_t>(std::stoi(std::string(number)));
    }
  }
  for (const svg::Painted& shape : found) {
    if (found.size() == 1 || shape.problem) return shape;
  }
  const auto list = [](const std::vector<svg::Painted>& shapes) {
    constexpr std::size_t most = 10;
    std::string names;
    for (std::size_t i = 0; i < std::min(shapes.size(), most); ++i) names += (i ? ", " : "") + shapes[i].name;
    return names + (shapes.size() > most ? "..." : "");
  };
  if (!found.empty()) {
    refuse(place, "has " + std::to_string(found.size()) + " shapes", "name the shape itself: " + list(found));
  }
  if (element) refuse(place, "has no shapes", "draw one there, or name another");
  refuse(place, "is not in the drawing", shown.empty() ? "draw a shape" : "its shapes are " + list(shown));
}

Outline Drawing::outline(std::string_view id, const DrawingScale& scale) const {
  std::size_t part = 0;
  const svg::Painted shape = data_->the_one(id, data_->page(scale), part);
  auto areas = data_->areas(shape, scale);
  if (areas.empty()) {
    data_->refuse("#" + std::string(id) + ", outline", "has no area",
                  "draw a closed shape with a fill, or a line with a stroke");
  }
  if (part == 0 && areas.size() > 1) {
    data_->refuse("#" + std::string(id) + ", outline",
                  "has " + std::to_string(areas.size()) + " separate areas",
                  "name one of them, \"" + std::string(id) + " 1\", or unite them");
  }
  if (part > areas.size()) {
    data_->refuse("#" + std::string(id), "is not in the drawing",
                  "the shape has " + std::to_string(areas.size()) + " separate areas");
  }
  return std::move(areas[part == 0 ? 0 : part - 1]);
}

}  // namespace ductile
