#include "ductile/replay.h"

#include <gtest/gtest.h>

#include "scenes.h"

namespace ductile {
namespace {

TEST(Replay, ALongRunIsThinnedEvenly) {
  Simulation run(calibrate(viewer::cantilever(4, 3e6)));
  const std::size_t values = 5 * 3 + 4 * 11;  // of a frame
  Replay replay(run.plan(), 20 * values);
  replay.take(run);
  for (int i = 0; i < 500; ++i) {
    run.step();
    replay.take(run);
    EXPECT_LE(replay.frames(), 20u);
  }
  EXPECT_EQ(replay.frames(), 16u) << "500 steps, each 32nd";
  EXPECT_NE(replay.page("t", run).find("\"time\":[0.0,0.5333333"), std::string::npos);
}

TEST(Replay, AShortRunIsKeptWhole) {
  Simulation run(calibrate(viewer::cantilever(4, 3e6)));
  Replay replay(run.plan());
  for (int i = 0; i < 100; ++i) {
    replay.take(run);
    run.step();
  }
  EXPECT_EQ(replay.frames(), 100u);
}

TEST(Replay, ATitleIsTextAndNothingElse) {
  Simulation run(calibrate(viewer::cantilever(1, unlimited)));
  Replay replay(run.plan());
  replay.take(run);
  const std::string page = replay.page("</script><img src=x>@DATA@\xff", run);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("</script>@"), std::string::npos);
}

}  // namespace
}  // namespace ductile
