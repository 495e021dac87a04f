#include "sizing.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "beam.h"
#include "ductile/rolled.h"
#include "ductile/targets.h"
#include "making.h"
#include "quantity.h"

namespace ductile::viewer {
namespace {

Sized with_profile(const SceneDef& scene, const BodyDef& beam, double reserve) {
  const auto series = [](const std::string& name) { return name.substr(0, name.find(' ')); };
  BeamStyle style = style_of(beam);
  std::vector<SceneDef> candidates;
  std::vector<std::string> names;
  for (const Rolled& profile : rolled_profiles()) {
    if (series(profile.name) != series(beam.profile_name)) continue;
    style.profile = profile.name;
    try {
      candidates.push_back(with_style(scene, beam.name, style));
      names.push_back(profile.name);
    } catch (const InvalidInput&) {  // higher than the beam is long
    }
  }
  Reach found = lightest(candidates, Measure::reserve, reserve);
  return {std::move(found.scene),
          fmt::format("{} of {} has a reserve of {:.3g}.", names[static_cast<std::size_t>(found.value)],
                      beam.name, found.reached)};
}

}  // namespace

Sized with_reserve(const SceneDef& scene, const std::string& name, double reserve) {
  Sized sized{scene, {}};
  const auto body = std::find_if(sized.scene.bodies.begin(), sized.scene.bodies.end(),
                                 [&](const BodyDef& b) { return b.name == name; });
  if (!body->profile_name.empty()) return with_profile(scene, *body, reserve);
  const Answer depth = depth_for(scene, name, reserve);
  body->depth = depth.value;
  sized.what = fmt::format("{} is {} deep: {} has a reserve of {:.3g}.", name, si(depth.value, "m"),
                           depth.governed_by, reserve);
  return sized;
}

}  // namespace ductile::viewer
