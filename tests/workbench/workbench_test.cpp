#include "workbench.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>

#include "ductile/definitions.h"
#include "ductile/design.h"
#include "ductile/files.h"
#include "gate.h"
#include "making.h"
#include "open.h"
#include "pick.h"
#include "scenes.h"

namespace ductile::viewer {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("ductile_workbench_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

fs::path write_scene(const Folder& folder, const SceneDef& scene, const std::string& name = "a.scene.json") {
  return folder.write(name, scene_text(scene));
}

TEST(Workbench, OpensRunsAndStartsAgain) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  EXPECT_EQ(bench.plan().pieces.size(), 5u);
  for (int i = 0; i < 30; ++i) bench.tick(1. / 60, 1);
  EXPECT_EQ(bench.run().cursor(), 30);
  bench.act(act::Throw{});
  bench.restart();
  EXPECT_EQ(bench.run().cursor(), 0);
  EXPECT_TRUE(bench.frame().thrown.empty());
}

TEST(Workbench, TimeGoesByAtThePaceAsked) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(1, unlimited)));
  bench.pace = 0.25;
  for (int i = 0; i < 120; ++i) bench.tick(1. / 60, 1);
  EXPECT_NEAR(bench.frame().time, 0.5, 1. / 60 + 1e-9);
  bench.pace = 3;
  for (int i = 0; i < 60; ++i) bench.tick(1. / 60, 1);
  EXPECT_NEAR(bench.frame().time, 3.5, 2. / 60 + 1e-9);
  bench.playing = false;
  const long here = bench.run().cursor();
  bench.tick(1, 1);
  EXPECT_EQ(bench.run().cursor(), here);
  bench.step_by(2);
  bench.tick(0, 1);
  EXPECT_EQ(bench.run().cursor(), here + 2);
  bench.step_by(-3);
  EXPECT_EQ(bench.run().cursor(), here - 1);
}

TEST(Workbench, ABadFileIsAMessageAndNothingIsLost) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  bench.run().go_to(20);
  bench.select({1, 2}, false);
  for (const char* bad :
       {"", "{", "[1,2]", "\x89PNG", "<svg></svg>", "<svg", R"({"bodies": [{"name": "x"}]})",
        R"({"bodies": [{"name": "x", "outline": [[0,0],[1,1],[1,0],[0,1]], "material": "S355"}]})"}) {
    SCOPED_TRACE(bad);
    bench.message.clear();
    EXPECT_FALSE(bench.try_open(folder.write("bad.json", bad)));
    EXPECT_NE(bench.message.find("bad.json"), std::string::npos) << bench.message;
    EXPECT_EQ(bench.run().cursor(), 20);
    EXPECT_EQ(bench.plan().pieces.size(), 5u);
    EXPECT_EQ(bench.selected.size(), 2u);
  }
  EXPECT_FALSE(bench.try_open(folder / "none.json"));
  EXPECT_FALSE(bench.message.empty());
  EXPECT_EQ(bench.run().cursor(), 20);
}

TEST(Workbench, EditsAreNotLostUnasked) {
  const Folder folder;
  Workbench bench;
  const fs::path a = write_scene(folder, cantilever(4, 3e6)),
                 b = write_scene(folder, cantilever(2, 3e6), "b.json");
  bench.open(a);
  SceneDef scene = bench.scene();
  scene.bodies[1].depth = 2;
  bench.edit(scene);
  EXPECT_FALSE(bench.try_open(b));
  EXPECT_NE(bench.message.find("not saved"), std::string::npos);
  EXPECT_FALSE(bench.may_discard("close")) << "something else is asked for";
  EXPECT_TRUE(bench.may_discard("close"));
  EXPECT_EQ(bench.scene().bodies[1].depth, 2);
  scene.bodies[1].depth = 3;
  bench.edit(scene);
  EXPECT_FALSE(bench.may_discard("close")) << "more would be lost now";
  bench.save(a);
  EXPECT_TRUE(bench.may_discard("close"));
  bench.undo();
  EXPECT_FALSE(bench.try_open(b));
  EXPECT_TRUE(bench.try_open(b));
  EXPECT_EQ(bench.file(), b);
}

TEST(Workbench, ADrawingBecomesBodies) {
  const Folder folder;
  const std::string shapes = R"(viewBox="0 0 100 50"><rect id="a-b" x="0" y="0" width="100" height="10"/>
      <circle id="b" cx="50" cy="40" r="10"/></svg>)";
  Workbench bench;
  bench.open(folder.write(
      "d.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="2000mm" height="1000mm" )" + shapes));
  ASSERT_EQ(bench.scene().bodies.size(), 3u);
  EXPECT_EQ(bench.scene().bodies[1].name, "a_b") << "names of bodies have no dash";
  EXPECT_EQ(bench.plan().bodies[1].pieces, 8);
  Bounds bar;  // 100 of 100 units are 2 m
  for (const Point& p : bench.scene().bodies[1].outline.outer) bar.add(p);
  EXPECT_NEAR(bar.size().x, 2, 1e-12);
  EXPECT_NEAR(bar.size().y, 0.2, 1e-12);
  EXPECT_EQ(bench.file(), folder / "d.scene.json");
  const double disc = bench.frame().pieces.back().position.y;
  bench.run().go_to(60);
  EXPECT_NEAR(bench.frame().pieces.back().position.y, disc, 0.02) << "the lower one rests on the floor";

  bench.open(folder.write("e.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" )" + shapes));
  Bounds all;
  for (const BodyDef& body : bench.scene().bodies) {
    if (body.type == BodyType::dynamic_body) {
      for (const Point& p : body.outline.outer) all.add(p);
    }
  }
  EXPECT_NEAR(all.size().x, 10, 1e-9) << "a drawing without a size";
  EXPECT_NE(bench.message.find("10 m"), std::string::npos);
}

TEST(Workbench, ALevelRunsAsTheSceneThatItWasMadeOf) {
  const Folder folder;
  const SceneDef scene = cantilever(4, 3e6);
  Workbench bench, level;
  bench.open(write_scene(folder, scene));
  const fs::path file = folder.write("level.json", rube_text(calibrate(scene)));
  level.open(file);
  for (Workbench* each : {&bench, &level}) each->run().go_to(60);
  ASSERT_EQ(level.plan().joints.size(), bench.plan().joints.size());
  for (std::size_t i = 0; i < level.plan().pieces.size(); ++i) {
    // Coordinates went through a file of floats.
    EXPECT_NEAR(level.frame().pieces[i].position.x, bench.frame().pieces[i].position.x, 1e-3);
    EXPECT_NEAR(level.frame().pieces[i].position.y, bench.frame().pieces[i].position.y, 1e-3);
  }
  EXPECT_FALSE(level.editable());
  EXPECT_THROW(level.edit(scene), InvalidInput);
  const std::string before = read_text(file);
  EXPECT_THROW(level.save(file), InvalidInput);
  EXPECT_EQ(read_text(file), before);
  level.open(folder / "a.scene.json");
  EXPECT_TRUE(level.editable());
}
// A part is of a scene, of a drawing without its floor, or of a level, whose beams carry by statics what they
// carried where it was made.
TEST(Workbench, WhatAFileHasIsAPart) {
  const Folder folder;
  SceneDef scene = with_next_support(with_load(gate(), {0, 3}, {0, -1e3}), {-2, 3}, 0);
  const SceneDef part = part_of_file(write_scene(folder, scene));
  EXPECT_EQ(part.bodies.size(), 4u);
  EXPECT_EQ(part.supports.size(), 1u);
  const SceneDef drawing = part_of_file(
      folder.write("d.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="2000mm" viewBox="0 0 2 1">
                                              <rect id="bar" width="2" height="0.1"/></svg>)"));
  ASSERT_EQ(drawing.bodies.size(), 1u);
  EXPECT_EQ(drawing.bodies[0].name, "bar");
  EXPECT_TRUE(drawing.supports.empty());

  const SceneDef beam = cantilever(4, 3e6);
  const Plan plan = calibrate(beam);
  SceneDef level = part_of_file(folder.write("level.json", rube_text(plan)));
  ASSERT_EQ(level.bodies.size(), plan.pieces.size());
  level.gravity = beam.gravity;  // is not a part's
  const StaticCheck was = static_check(plan), is = static_check(calibrate(level));
  EXPECT_NEAR(is.reserve / was.reserve, 1, 1e-5);  // coordinates went through a file of floats

  Workbench bench;
  bench.open(folder / "a.scene.json");
  bench.bringing = true;
  EXPECT_TRUE(bench.receive(folder / "d.svg"));
  EXPECT_EQ(bench.brought->bodies.size(), 1u);
  EXPECT_EQ(bench.file(), folder / "a.scene.json");
  EXPECT_FALSE(bench.receive(folder.write("bad.svg", "<svg")));
  EXPECT_NE(bench.message.find("bad.svg cannot be brought"), std::string::npos);
  bench.bringing = false;
  EXPECT_TRUE(bench.receive(folder / "d.svg"));
  EXPECT_EQ(bench.file(), folder / "d.scene.json");
}

TEST(Workbench, EditsAreUndoneAndRedone) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  const double before = bench.plan().joints[0].M;
  EXPECT_FALSE(bench.changed());
  SceneDef scene = bench.scene();
  scene.bodies[1].material->yield_stress *= 2;
  bench.select({0}, false);
  const std::string chosen = bench.plan().joints[0].name;
  bench.edit(scene);
  EXPECT_TRUE(bench.changed());
  EXPECT_DOUBLE_EQ(bench.plan().joints[0].M, 2 * before);
  EXPECT_DOUBLE_EQ(bench.plan_before().joints[0].M, before);
  EXPECT_EQ(bench.run().cursor(), 0);
  ASSERT_TRUE(bench.focus);
  EXPECT_EQ(bench.plan().joints[*bench.focus].name, chosen);

  scene.bodies[1].pieces = 7;
  bench.edit(scene);
  EXPECT_EQ(bench.plan().pieces.size(), 8u);
  bench.undo();
  EXPECT_EQ(bench.plan().pieces.size(), 5u);
  bench.undo();
  EXPECT_DOUBLE_EQ(bench.plan().joints[0].M, before);
  EXPECT_FALSE(bench.changed());
  EXPECT_FALSE(bench.can_undo());
  bench.redo();
  bench.redo();
  EXPECT_EQ(bench.plan().pieces.size(), 8u);
  EXPECT_FALSE(bench.can_redo());
}

TEST(Workbench, StepsStayAsTheyWereSet) {
  const fs::path scenes = fs::path(DUCTILE_SOURCE_DIR) / "scenes";
  Workbench bench;
  bench.open(scenes / "frame_bomb.scene.json");
  bench.set_stepping({.dt = 1. / 500, .velocity_iterations = 20});
  SceneDef scene = bench.scene();
  scene.gravity.y /= 2;
  bench.edit(scene);
  bench.undo();
  bench.restart();
  EXPECT_EQ(bench.run().stepping().dt, 1. / 500);
  EXPECT_EQ(bench.run().stepping().velocity_iterations, 20);
  bench.open(scenes / "cantilever.scene.json");
  EXPECT_EQ(bench.run().stepping().dt, 1. / 60);
}

TEST(Workbench, ADraggedSliderIsOneEdit) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  SceneDef scene = bench.scene();
  for (const double depth : {0.9, 0.8, 0.7}) {
    scene.bodies[1].depth = depth;
    bench.edit(scene, depth < 0.9);
  }
  EXPECT_EQ(bench.scene().bodies[1].depth, 0.7);
  bench.undo();
  EXPECT_EQ(bench.scene().bodies[1].depth, 1);
  EXPECT_FALSE(bench.can_undo());
}

TEST(Workbench, ABadEditChangesNothing) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  bench.run().go_to(10);
  SceneDef scene = bench.scene();
  scene.bodies[1].depth = -1;
  EXPECT_THROW(bench.edit(scene), InvalidInput);
  EXPECT_EQ(bench.run().cursor(), 10);
  EXPECT_FALSE(bench.changed());
  EXPECT_EQ(bench.scene().bodies[1].depth, 1);
}

TEST(Workbench, WhatIsSavedReadsBack) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  SceneDef scene = bench.scene();
  scene.bodies[1].pieces = 6;
  scene.bodies[1].joint.max_rotation = 0.1;
  bench.edit(scene);
  bench.save(folder / "b.scene.json");
  EXPECT_FALSE(bench.changed());
  bench.undo();
  EXPECT_TRUE(bench.changed()) << "what is saved is the other one";
  Workbench other;
  other.open(folder / "b.scene.json");
  EXPECT_EQ(other.plan().pieces.size(), 7u);
  EXPECT_EQ(other.plan().joints[0].max_rotation, 0.1);
  EXPECT_THROW(bench.save(folder / "no" / "such" / "folder.json"), std::exception);
}

// Bodies and joints that are added go to the end of their lists, where two beams more are pinned to a node of
// the drawn one.
TEST(Workbench, WhatIsMadeBesideADrawingKeepsItsLink) {
  const Folder folder;
  folder.write("d.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="2000mm" viewBox="0 0 2 1">
                             <rect id="bar" y="0.9" width="2" height="0.1"/></svg>)");
  const fs::path file = folder.write("a.scene.json", R"({ "bodies": [ // what stands
    { "name": "bar", "type": "static", "outline": "d.svg#bar" } ] })");
  Workbench bench;
  bench.open(file);
  SceneDef scene = with_beam(bench.scene(), {{1, 0.1}, {1, 3}}, {});
  bench.edit(with_load(scene, {1, 3}, {0, -1e3}));
  bench.save(file);
  EXPECT_NE(read_text(file).find("d.svg#bar"), std::string::npos) << read_text(file);
  EXPECT_NE(read_text(file).find("// what stands"), std::string::npos);
  scene = with_beam(bench.scene(), {{1, 0.1}, {2, 3}}, {});
  bench.edit(with_beam(scene, {{1, 0.1}, {0, 3}}, {}));
  bench.save(file);
  EXPECT_NE(read_text(file).find("d.svg#bar"), std::string::npos) << read_text(file);
  EXPECT_EQ(scene_text(parse_scene(read_text(file), "a", file.parent_path())), scene_text(bench.scene()));
}

TEST(Workbench, AnotherSolverRunsToTheSameStep) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  bench.run().go_to(60);
  const double bent = std::abs(bench.frame().joints.back().plastic_rotation);
  bench.set_solver(JointSolver::stock);
  bench.playing = false;
  while (bench.run().busy()) bench.tick(0, 1);
  EXPECT_EQ(bench.run().cursor(), 60);
  EXPECT_EQ(bench.solver(), JointSolver::stock);
  for (const JointReading& joint : bench.frame().joints) EXPECT_EQ(joint.dissipated, 0);
  bench.set_solver(JointSolver::direct);
  while (bench.run().busy()) bench.tick(0, 1);
  EXPECT_EQ(std::abs(bench.frame().joints.back().plastic_rotation), bent);
}

TEST(Workbench, AnotherSolverRunsBesideInStep) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  EXPECT_EQ(bench.beside_text(), "");
  bench.run_beside({{.solver = JointSolver::stock}});
  for (int i = 0; i < 20; ++i) bench.tick(1. / 60, 1);
  bench.act(act::Throw{.at = {5, 4}});
  for (int i = 0; i < 20; ++i) bench.tick(1. / 60, 1);
  ASSERT_NE(bench.beside(), nullptr);
  EXPECT_EQ(bench.beside()->cursor(), 40);
  EXPECT_EQ(bench.beside()->frame().thrown.size(), 1u);
  EXPECT_EQ(bench.beside()->solver(), JointSolver::stock);
  EXPECT_NE(bench.beside_text().find("stock solver, 60 steps/s"), std::string::npos) << bench.beside_text();
  bench.step_by(-15);
  bench.tick(0, 1);
  EXPECT_EQ(bench.beside()->cursor(), 25);
  bench.run_beside({});
  EXPECT_EQ(bench.beside(), nullptr);
}

// What is done to the one is done to the other at the same time, though at another step.
TEST(Workbench, AnotherStepRunsBesideInTime) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6)));
  bench.playing = false;
  bench.run().go_to(30);
  bench.act(act::Throw{.at = {5, 4}});
  bench.run().go_to(60);
  Stepping finer = bench.run().stepping();
  finer.dt = 1 / 120.;
  bench.set_stepping(finer);
  bench.run().go_to(90);  // 1.25 s
  bench.run_beside({{.solver = JointSolver::direct, .dt = 1 / 240.}});
  while (bench.beside()->busy()) bench.tick(0, 1);
  EXPECT_EQ(bench.beside()->cursor(), 300);
  EXPECT_NEAR(bench.beside()->frame().time, bench.frame().time, 1e-6);
  ASSERT_EQ(bench.beside()->acts().back().step, 240);  // the change of step, at 1 s
  const auto thrown = std::find_if(bench.beside()->acts().begin(), bench.beside()->acts().end(),
                                   [](const auto& e) { return std::holds_alternative<act::Throw>(e.act); });
  ASSERT_NE(thrown, bench.beside()->acts().end());
  EXPECT_EQ(thrown->step, 120);
  bench.act(act::Throw{.at = {5, 4}});  // in both, now
  while (bench.beside()->busy()) bench.tick(0, 1);
  EXPECT_EQ(bench.beside()->acts().back().step, 300);
}

TEST(Workbench, StopsAndJumpsAtYieldAndBreak) {
  const Folder folder;
  Workbench bench;
  bench.open(write_scene(folder, cantilever(4, 3e6, 0.2)));
  EXPECT_FALSE(bench.seek_first(JointEvent::broke));
  bench.stop_at = Workbench::StopAt::broke;
  for (int i = 0; i < 600 && bench.playing; ++i) bench.tick(1. / 60, 1);
  ASSERT_FALSE(bench.playing) << "the root breaks";
  const long broke = bench.run().cursor();
  EXPECT_TRUE(bench.frame().joints.back().broken);
  EXPECT_FALSE(bench.run().kept(broke - 1)->joints.back().broken);
  ASSERT_TRUE(bench.seek_first(JointEvent::yield));
  EXPECT_LT(bench.run().cursor(), broke);
  EXPECT_GT(bench.frame().joints.back().dissipated, 0);
  EXPECT_EQ(bench.run().kept(bench.run().cursor() - 1)->joints.back().dissipated, 0);
  ASSERT_TRUE(bench.seek_first(JointEvent::broke));
  EXPECT_EQ(bench.run().cursor(), broke);
}

TEST(Limits, OfAJointAreThoseOfItsBodyOrPair) {
  SceneDef scene = cantilever(3, 3e6);
  scene.supports = {{.body = "bar", .at = {10, 0.5}, .fix_y = true}};
  const Plan plan = calibrate(scene);
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const auto limits = limits_of(scene, plan, i);
    const std::string& name = plan.joints[i].name;
    if (name == "support/0") {
      EXPECT_FALSE(limits);
    } else if (name == "wall-bar/0") {
      ASSERT_TRUE(limits);
      EXPECT_EQ(limits->overrides, &scene.joints[0].overrides);
    } else {
      ASSERT_TRUE(limits) << name;
      EXPECT_EQ(limits->overrides, &scene.bodies[1].joint);
    }
  }
}

TEST(Pick, JointsAndPiecesAreFoundWhereTheyAre) {
  // Pieces of 2.5 m; joints at x = 2.5, 5, 7.5 and the root at 0, all at y = 0.5.
  Timeline run(calibrate(cantilever(4, 3e6)));
  const Plan& plan = run.plan();
  const auto name = [&](std::optional<std::size_t> joint) {
    return joint ? plan.joints[*joint].name : "none";
  };
  EXPECT_EQ(name(joint_at(plan, run.frame(), {5.1, 0.4}, 0.3)), "bar/1-bar/2");
  EXPECT_EQ(name(joint_at(plan, run.frame(), {6, 0.5}, 0.3)), "none");
  EXPECT_EQ(joints_in(plan, run.frame(), {{2, 0}, {6, 1}}).size(), 2u);
  EXPECT_TRUE(joints_in(plan, run.frame(), {{2, 0}, {6, 0.4}}).empty());
  EXPECT_EQ(piece_at(plan, run.frame(), {-0.5, 0.5}), 0u);
  EXPECT_EQ(piece_at(plan, run.frame(), {9, 0.9}), 4u);
  EXPECT_FALSE(piece_at(plan, run.frame(), {9, 1.1}));
  const Bounds box = extent(plan);
  EXPECT_NEAR(box.low.x, 0, 1e-9);
  EXPECT_NEAR(box.high.x, 10, 1e-9);

  // Bent down, joints and pieces are elsewhere.
  run.go_to(60);
  ASSERT_LT(run.frame().pieces[4].position.y, -1);
  EXPECT_EQ(piece_at(plan, run.frame(), run.frame().pieces[4].position), 4u);
  EXPECT_FALSE(piece_at(plan, run.frame(), {9, 0.9}));
  EXPECT_EQ(joints_from(run.frame(), 1).size(), 1u) << "only the root has yielded";
  EXPECT_EQ(joints_from(run.frame(), 0).size(), 4u);
}

TEST(Place, TheAxisOfAJointTurnsWithItsBodies) {
  Timeline run(calibrate(cantilever(1, 3e6)));
  run.go_to(60);
  // One piece on a static wall: the axis turns with the piece.
  const double angle = run.frame().pieces[1].angle;
  ASSERT_LT(angle, -0.05);
  const Placed placed = place(run.plan(), 0, run.frame());
  EXPECT_NEAR(placed.axis.x, std::cos(angle), 1e-12);
  EXPECT_NEAR(placed.axis.y, std::sin(angle), 1e-12);
  EXPECT_NEAR(placed.anchor.x, 0, 1e-2);
  EXPECT_NEAR(placed.anchor.y, 0.5, 1e-2);
}

// The root bears 6e6 N m and its own weight asks 4e6 of it (scenes.h).
TEST(Workbench, TellsAtWhatLoadItCollapsesAndHow) {
  Workbench bench;
  bench.edit(cantilever(4, 6e6));
  bench.step_by(3);
  bench.find_collapse();
  ASSERT_TRUE(bench.collapse());
  EXPECT_EQ(bench.run().cursor(), 0);
  EXPECT_NEAR(bench.collapse()->load_factor, 1.5, 1e-6);
  EXPECT_NE(bench.message.find("1.5 times its loads, by wall-bar/0."), std::string::npos) << bench.message;
  bench.edit(cantilever(4, 8e6));
  EXPECT_FALSE(bench.collapse());
  bench.edit(empty_scene());
  bench.find_collapse();
  EXPECT_FALSE(bench.collapse());
  EXPECT_NE(bench.message.find("no collapse load"), std::string::npos) << bench.message;
}

TEST(Workbench, ReadsAgainWhatAnotherProgramHasWritten) {
  const Folder folder;
  const fs::path file = folder / "a.scene.json", drawing = folder / "beam.svg";
  const auto draw = [&](const char* width, int seconds) {
    write_text(
        drawing,
        std::string(
            R"(<svg xmlns="http://www.w3.org/2000/svg" width="400cm" height="400cm" viewBox="0 0 4 4">)") +
            "<rect id='beam' x='0' y='1' width='" + width + "' height='0.2'/></svg>");
    fs::last_write_time(drawing, fs::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  draw("2", 0);
  write_text(file, R"({"bodies": [{"name": "beam", "outline": "beam.svg#beam", "material": "S355"}]})");
  Workbench bench;
  bench.open(file);
  const auto mass = [&] { return bench.plan().pieces.at(0).mass; };
  const double before = mass();
  bench.read_again_if_written();
  EXPECT_TRUE(bench.message.empty()) << bench.message;
  draw("3", 10);
  bench.read_again_if_written();
  EXPECT_NEAR(mass() / before, 1.5, 1e-9);
  EXPECT_NE(bench.message.find("beam.svg"), std::string::npos);

  draw("nothing", 20);  // it stays as it was
  bench.read_again_if_written();
  EXPECT_NEAR(mass() / before, 1.5, 1e-9);
  EXPECT_NE(bench.message.find("cannot be read"), std::string::npos) << bench.message;

  SceneDef edited = bench.scene();
  edited.bodies[0].depth *= 2;
  bench.edit(edited);
  draw("1", 30);
  bench.read_again_if_written();
  EXPECT_NEAR(mass() / before, 3, 1e-9);
  EXPECT_NE(bench.message.find("kept"), std::string::npos) << bench.message;

  bench.save(file);  // its own writing is nobody else's
  bench.message.clear();
  bench.read_again_if_written();
  EXPECT_TRUE(bench.message.empty()) << bench.message;
}

}  // namespace
}  // namespace ductile::viewer
