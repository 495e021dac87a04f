#include "ductile/files.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ductile;
  try {
    const SceneDef scene = parse_scene(text(data, size), "scene", "no such folder");
    const std::string written = scene_text(scene);
    require(scene_text(parse_scene(written)) == written, "what is written reads back the same");
    require(edited_scene(text(data, size), scene, "no such folder") == text(data, size),
            "nothing was edited");
    SceneDef edited = scene;
    edited.gravity.x += 1;
    if (!edited.bodies.empty()) edited.bodies.back().depth *= 2;
    require(scene_text(parse_scene(edited_scene(text(data, size), edited, "no such folder"))) ==
                scene_text(edited),
            "an edited file has the edited values");
    const Plan plan = calibrate(scene);
    for (const Piece& piece : plan.pieces) {
      require_finite({piece.mass, piece.inertia, piece.center.x, piece.center.y}, "piece");
    }
    for (const PlannedJoint& joint : plan.joints) {
      require_finite({joint.anchor.x, joint.anchor.y, joint.axis.x, joint.axis.y}, "joint");
      for (const double cap : {joint.N, joint.Nc, joint.Q, joint.M, joint.M_reverse})
        require(cap >= 0, "cap");
      for (const double k : {joint.stiffness.N, joint.stiffness.Q, joint.stiffness.M})
        require(k >= 0, "stiffness");
    }
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
