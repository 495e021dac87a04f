#include <algorithm>

#include "ductile/files.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ductile;
  try {
    const Drawing drawing(text(data, size), "drawing");
    auto ids = drawing.ids();
    ids.resize(std::min<std::size_t>(ids.size(), 10));
    for (const std::string& id : ids) {
      for (const double scale : {0.0, 1.0}) {
        try {
          const Outline outline = drawing.outline(id, {.metres_per_unit = scale});
          require(outline.outer.size() >= 3, "a ring has three points");
          for (const Point& p : outline.outer) require_finite({p.x, p.y}, "point");
          validate(outline);
        } catch (const InvalidInput& error) {
          require(!error.problems().empty(), "an error says what is wrong");
        }
      }
    }
    const DrawnShapes drawn = drawing.shapes({.metres_per_unit = 1});
    for (const auto& shape : drawn.shapes) require(!shape.name.empty(), "a shape has a name");
    for (const Problem& problem : drawn.left_out)
      require(!problem.place.empty() && !problem.what.empty(), "what is left out is said");
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
