#include "trace.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossing.h"
#include "ductile/colours.h"
#include "prices.h"

namespace ductile::viewer {

std::string trace_of(Workbench& bench, const Desk& desk) {
  using Json = nlohmann::ordered_json;
  const auto pixels = [&](Point world) {
    const Point p = desk.camera().to_screen(world);
    return Json{p.x, p.y};
  };
  Json controls = Json::object(), joints = Json::object(), pieces = Json::object(), selected = Json::array();
  for (const auto& [name, box] : desk.controls()) {
    controls[name] = {box.low.x, box.low.y, box.high.x, box.high.y};
  }
  for (std::size_t i = 0; i < bench.plan().joints.size(); ++i) {
    joints[bench.plan().joints[i].name] = pixels(place(bench.plan(), i, bench.frame()).anchor);
  }
  for (std::size_t i = 0; i < bench.plan().pieces.size(); ++i) {
    pieces[bench.plan().pieces[i].name] = pixels(bench.frame().pieces[i].position);
  }
  double usage = 0;  // the largest of all joints' rows
  long broken = 0;
  for (const JointReading& joint : bench.frame().joints) {
    usage = std::max(usage, stage(joint));
    broken += joint.broken;
  }
  for (const std::size_t i : bench.selected) selected.push_back(bench.plan().joints[i].name);
  const Bounds& view = desk.camera().screen;
  const Json state{{"file", bench.file().string()},
                   {"edition", bench.edition()},
                   {"step", bench.run().cursor()},
                   {"last", bench.run().last()},
                   {"time", bench.frame().time},
                   {"busy", bench.run().busy()},
                   {"playing", bench.playing},
                   {"pace", bench.pace},
                   {"solver", static_cast<int>(bench.solver())},
                   {"dt", bench.run().stepping().dt},
                   {"events", bench.run().events().size()},
                   {"thrown", bench.frame().thrown.size()},
                   {"selected", selected},
                   {"changed", bench.changed()},
                   {"message", bench.message},
                   {"tool", static_cast<int>(desk.maker().tool())},
                   {"cursor", {desk.maker().cursor().x, desk.maker().cursor().y}},
                   {"verdict", bench.verdict()},
                   {"cost", cost(bench.plan())},
                   {"chosen", desk.maker().chosen(bench)},
                   {"usage", usage},
                   {"broken", broken},
                   {"crossing", crossing_text(bench.frame())},
                   {"beside", bench.beside_text()},
                   {"collapse", bench.collapse() ? Json(bench.collapse()->load_factor) : Json()},
                   {"centre", {desk.camera().centre.x, desk.camera().centre.y}},
                   {"scale", desk.camera().scale},
                   {"view", {view.low.x, view.low.y, view.high.x, view.high.y}},
                   {"joints", joints},
                   {"pieces", pieces},
                   {"focus", desk.focus()},
                   {"controls", controls}};
  return state.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ductile::viewer
