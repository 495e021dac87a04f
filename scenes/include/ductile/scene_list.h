// The scenes of this repository: the tests run each and hold it to its outcome; benchmarks, the report and
// the window take their list from here.
#pragma once

#include <string_view>

namespace ductile {

/// What has become of a scene's joints when it is over.
enum class Outcome {
  stands,  ///< none has yielded
  bends,   ///< some have yielded, none is broken
  breaks,  ///< some are broken
};

struct SceneEntry {
  std::string_view name;   ///< of the file: scenes/NAME.scene.json
  std::string_view about;  ///< one sentence
  double seconds;          ///< of simulated time until all is over
  Outcome outcome;         ///< with the direct solver, at 60 Hz and 8/3 iterations
};

/// B1-1 to CS1 are the presets of "Breakable Elastic-plastic Constraint for Rigid Body Simulation" (S.
/// Nikula), in the dimensions of its published code.
inline constexpr SceneEntry scene_list[] = {
    {"cantilever", "A steel beam of ten pieces sags under its own weight.", 6, Outcome::stands},
    {"fixed_fixed", "A beam of forty pieces between two walls carries its own weight.", 6, Outcome::stands},
    {"collapse", "A load on a clamped beam grows until three plastic hinges make it a mechanism.", 31,
     Outcome::bends},
    {"frame", "Four storeys of four bays stand: 160 joints.", 10, Outcome::stands},
    {"frame_large", "Fifteen storeys of fifteen bays stand: 2085 joints.", 5, Outcome::stands},
    {"frame_pushed", "The frame is pushed sideways with a little less than half of what makes it sway.", 6,
     Outcome::stands},
    {"frame_bomb", "A bomb of 2 t at 30 m/s bends a column of the frame.", 5, Outcome::bends},
    {"frame_heavy_bomb", "A bomb of 20 t at 30 m/s breaks through columns of the frame.", 5, Outcome::breaks},
    {"harbour_crane", "A container caught on a barge bends the jib of a crane, then breaks it.", 6,
     Outcome::breaks},
    {"viaduct", "A viaduct of 248 panels, drawn with its openings, carries two loads: 500 joints.", 5,
     Outcome::stands},
    {"car", "A car jumps onto the drawbridge, bends its hinge and drives across.", 13, Outcome::bends},
    {"car_heavy", "A car three times as heavy tears the drawbridge off.", 10, Outcome::breaks},
    {"crane_winch", "A crane winds in its rope and lifts a load of 6 t.", 12, Outcome::stands},
    {"jack", "A hydraulic jack lifts a beam against a stop and bends it.", 10, Outcome::bends},
    {"B1-1", "A block of 10 000 t comes down on a beam of 20 m beside its root.", 5, Outcome::stands},
    {"B1-2", "The same on a beam of 6 m.", 5, Outcome::stands},
    {"B2-1", "Two pieces as long as they are high.", 5, Outcome::stands},
    {"B3-1", "A rigid-plastic beam of 80 m is heavier than its root can hold, and bends down.", 20,
     Outcome::bends},
    {"B3-11", "The same with an elastic root of 10 Hz.", 20, Outcome::bends},
    {"B3-2", "The same beam in four pieces: only the root bends.", 20, Outcome::bends},
    {"B4-1", "A beam of 20 m carries a block of 500 t in its middle.", 5, Outcome::stands},
    {"CS1", "A disc of 200 kg at 5 m/s bends a post.", 5, Outcome::bends},
};

}  // namespace ductile
