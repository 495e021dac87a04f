#include <algorithm>

#include "ductile/level.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ductile;
  if (!is_rube(text(data, size))) return 0;
  try {
    const std::string once = calibrated_rube(text(data, size));
    require(calibrated_rube(once) == once, "a calibrated scene stays as it is");
    b2World world({0, 0});
    Level level = load_text(world, once);
    for (const PlannedJoint& joint : level.plan.joints) {
      require_finite({joint.anchor.x, joint.anchor.y, joint.axis.x, joint.axis.y}, "joint");
      for (const double cap : {joint.N, joint.Nc, joint.Q, joint.M, joint.M_reverse})
        require(cap >= 0, "cap");
    }
    world.Step(1 / 60.0f, 8, 3);
    level.structure.update();
    const Plan plan = parse_plan(once);
    for (const bool stock : {false, true}) {
      b2World of_plan({0, 0});
      if (stock)
        build_stock(of_plan, plan);
      else
        build(of_plan, plan);
      of_plan.Step(1 / 60.0f, 8, 3);
    }
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
