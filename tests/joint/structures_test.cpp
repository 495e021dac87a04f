// Several structures of one world: what touches or ties them is one problem, and each keeps its own joints,
// events and reports.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "ductile/joint.h"
#include "ductile/save.h"

namespace ductile {
namespace {

constexpr double g = 10, height = 0.3, depth = 0.1;

/// A beam of steel, 1 m a piece, from a wall on its left or right.
struct Cantilever {
  double root;    // x of the wall
  double toward;  // 1: it reaches to the right
  double y;
  int pieces = 6;
  bool elastic = false;
};

/// A world with two structures, or with one that has the joints of both, made in the same order.
struct Pair {
  explicit Pair(bool as_one, StructureDef def = {.keep_ledger = true}) : world({0, -g}), one(as_one) {
    world.SetAllowSleeping(false);
    structures.push_back(std::make_unique<Structure>(world, def));
    if (!one) structures.push_back(std::make_unique<Structure>(world, def));
  }
  Structure& of(std::size_t k) { return *structures[one ? 0 : k]; }

  void add(std::size_t k, const Cantilever& c) {
    b2Body* previous = add_box(world, {.x = c.root - 0.5 * c.toward, .y = c.y, .type = b2_staticBody});
    for (int i = 0; i < c.pieces; ++i) {
      b2Body* next = add_box(world, {.x = c.root + (i + 0.5) * c.toward,
                                     .y = c.y,
                                     .width = 1,
                                     .height = height,
                                     .mass = 7850 * height * depth,
                                     .group = static_cast<short>(k == 0 ? -1 : -2)});
      joints[k].push_back(join(k, previous, next, c.root + i * c.toward, c.y, c.elastic));
      pieces[k].push_back(next);
      previous = next;
    }
  }
  ElasticPlasticJoint* join(std::size_t k, b2Body* a, b2Body* b, double x, double y, bool elastic) {
    ElasticPlasticJointDef joint;
    joint.Initialize(a, b, vec(x, y), {1, 0});
    const double area = height * depth, E = 210e9, axial_cap = 355e6 * area,
                 moment_cap = axial_cap * height / 4;
    if (elastic) {
      joint.rows[axial] = {
          .stiffness = E * area, .damping_ratio = 0.05, .cap = axial_cap, .cap_reverse = axial_cap};
      joint.rows[shear] = {.stiffness = E * area / 3.1, .damping_ratio = 0.05};
      joint.rows[rotation] = {.stiffness = E * area * height * height / 12,
                              .damping_ratio = 0.05,
                              .cap = moment_cap,
                              .cap_reverse = moment_cap};
    }
    return of(k).create_joint(joint);
  }
  void run(double seconds) {
    for (int i = 0; i < 60 * seconds; ++i) {
      world.Step(1.0f / 60, 8, 3);
      for (const auto& s : structures) s->update();
    }
  }
  /// All that joints and pieces tell.
  std::vector<double> state() const {
    std::vector<double> all;
    for (const auto& of_one : pieces) {
      for (const b2Body* b : of_one) {
        for (const float value :
             {b->GetPosition().x, b->GetPosition().y, b->GetAngle(), b->GetLinearVelocity().x,
              b->GetLinearVelocity().y, b->GetAngularVelocity()})
          all.push_back(value);
      }
    }
    for (const auto& of_one : joints) {
      for (const ElasticPlasticJoint* j : of_one) {
        for (const Row row : {axial, shear, rotation}) {
          all.push_back(j->force(row));
          all.push_back(j->plastic(row));
        }
      }
    }
    return all;
  }
  /// Of the weights of the pieces of one structure about x, where they are now.
  double moment(std::size_t k, double x) const {
    double sum = 0;
    for (const b2Body* b : pieces[k]) sum += g * b->GetMass() * (b->GetWorldCenter().x - x);
    return sum;
  }

  b2World world;
  bool one;
  std::vector<std::unique_ptr<Structure>> structures;
  std::vector<b2Body*> pieces[2];
  std::vector<ElasticPlasticJoint*> joints[2];
};

/// The first lies with its tip on that of the second.
void lay_on_each_other(Pair& pair, bool elastic = true) {
  pair.add(0, {.root = 0, .toward = 1, .y = height + 0.01, .pieces = 6, .elastic = elastic});
  pair.add(1, {.root = 11, .toward = -1, .y = 0, .pieces = 6, .elastic = elastic});
}

/// A free dumbbell of the first, above the tip of the second.
void throw_at(Pair& pair, double speed, bool elastic = true) {
  pair.add(1, {.root = 0, .toward = 1, .y = 0, .pieces = 6, .elastic = elastic});
  for (int i = 0; i < 2; ++i) {
    pair.pieces[0].push_back(
        add_box(pair.world, {.x = 4.9 + i, .y = 0.75, .width = 1, .height = 1, .mass = 400, .group = -1}));
    pair.pieces[0].back()->SetLinearVelocity(vec(0, -speed));
  }
  pair.joints[0].push_back(pair.join(0, pair.pieces[0][0], pair.pieces[0][1], 5.4, 0.75, false));
}

using Scene = std::pair<const char*, std::function<void(Pair&)>>;

class Alike : public testing::TestWithParam<Scene> {};

// The order of unknowns and rows is that in which joints were made, whichever structure they are of: so are
// all bits.
TEST_P(Alike, MoveAsOneWould) {
  Pair one(true), two(false);
  for (Pair* pair : {&one, &two}) GetParam().second(*pair);
  for (int second = 0; second < 5; ++second) {
    one.run(1);
    two.run(1);
    ASSERT_EQ(two.state(), one.state()) << second;
  }
  JointEnergy sum;
  for (const auto& s : two.structures) {
    EXPECT_EQ(s->report().bounds_hit, 0);
    const JointEnergy energy = s->energy();
    sum.elastic += energy.elastic;
    sum.dissipated += energy.dissipated;
    sum.damping += energy.damping;
    sum.numerical += energy.numerical;
    sum.contacts += energy.contacts;
  }
  const JointEnergy whole = one.of(0).energy();
  const double scale = whole.elastic + whole.dissipated + whole.damping;
  EXPECT_NEAR(sum.elastic, whole.elastic, 1e-12 * scale);
  EXPECT_NEAR(sum.dissipated, whole.dissipated, 1e-12 * scale);
  EXPECT_NEAR(sum.damping, whole.damping, 1e-12 * scale);
  EXPECT_NEAR(sum.numerical, whole.numerical, 1e-12 * scale);
  EXPECT_NEAR(sum.contacts, whole.contacts, 1e-12 * scale);
}
INSTANTIATE_TEST_SUITE_P(InContact, Alike,
                         testing::Values(Scene{"laid", [](Pair& p) { lay_on_each_other(p); }},
                                         Scene{"laid, rigid", [](Pair& p) { lay_on_each_other(p, false); }},
                                         Scene{"struck", [](Pair& p) { throw_at(p, 10); }},
                                         Scene{"struck hard", [](Pair& p) { throw_at(p, 30); }},
                                         Scene{"on a rope",
                                               [](Pair& p) {
                                                 p.add(0, {.root = 0, .toward = 1, .y = 3, .elastic = true});
                                                 p.add(1, {.root = 0, .toward = 1, .y = 0, .elastic = true});
                                                 b2DistanceJointDef rope;
                                                 rope.Initialize(p.pieces[0].back(), p.pieces[1].back(),
                                                                 vec(5.5, 3), vec(5.5, 0));
                                                 p.world.CreateJoint(&rope);
                                               }}),
                         [](const auto& name) { return std::to_string(name.index); });

// What is left of the other goes on, and is carried: as a stock weld's bodies, or not at all.
TEST(Together, UntilOneGoes) {
  for (const bool bodies : {false, true}) {
    Pair pair(false);
    throw_at(pair, 0, false);
    const auto root_moment = [&] {
      return -pair.moment(1, 0) - (pair.pieces[0].empty() ? 0 : pair.moment(0, 0));
    };
    const auto expect_statics = [&] {
      pair.run(4);
      const double exact = root_moment();
      EXPECT_NEAR(pair.joints[1].front()->force(rotation), exact, 1e-5 * -exact);
      EXPECT_EQ(pair.of(1).report().bounds_hit, 0);
    };
    expect_statics();
    EXPECT_EQ(pair.of(0).report().solves + pair.of(0).report().resting, 1);
    if (bodies) {
      for (b2Body* b : std::exchange(pair.pieces[0], {})) pair.world.DestroyBody(b);
      EXPECT_TRUE(pair.of(0).joints().empty());
    } else {
      pair.structures[0] = std::make_unique<Structure>(pair.world);  // joints of the old one are welds now
    }
    expect_statics();
  }
}

// The one whose joints come first tells the energies of both; the other outlives it.
TEST(Together, UntilTheFirstGoes) {
  Pair pair(false);
  throw_at(pair, 3);
  pair.run(1);
  pair.structures[1].reset();
  ElasticPlasticJoint* left = pair.joints[0].front();
  for (int i = 0; i < 120; ++i) {
    pair.world.Step(1.0f / 60, 8, 3);
    pair.of(0).update();
    EXPECT_EQ(pair.of(0).report().bounds_hit, 0);
  }
  EXPECT_EQ(pair.of(0).joints().size(), 1u);
  EXPECT_LT(std::abs(left->elastic(rotation)), 1e-6);
}

TEST(Together, InAWorldThatGoesFirst) {
  std::unique_ptr<Structure> first, second;
  {
    auto pair = std::make_unique<Pair>(false);
    lay_on_each_other(*pair);
    pair->run(0.2);
    first = std::move(pair->structures[0]);
    second = std::move(pair->structures[1]);
    pair->structures.clear();
  }
  EXPECT_EQ(first->world(), nullptr);
  EXPECT_EQ(second->world(), nullptr);
  second.reset();
  first->update();
}

// A snapshot is of the world, with all of its structures.
TEST(Together, SnapshotsRunOnAsTheyDid) {
  Pair pair(false);
  throw_at(pair, 10);
  pair.run(0.1);
  Snapshot struck;
  struck.save(pair.world);
  const auto end = [&] {
    pair.run(1);
    std::vector<double> all = pair.state();
    for (const auto& s : pair.structures) {
      const JointEnergy e = s->energy();
      all.insert(all.end(), {e.elastic, e.dissipated, e.damping, e.numerical, e.contacts, e.clamped});
    }
    return all;
  };
  const auto first = end();
  struck.restore(pair.world);
  EXPECT_EQ(end(), first);
}

// A save is of one structure's world.
TEST(Together, AreNotSavedAsOne) {
  Pair pair(false);
  lay_on_each_other(pair);
  pair.run(0.2);
  EXPECT_THROW(static_cast<void>(save_bytes(pair.of(0))), std::logic_error);
}

// Each handler hears of the joints of its own structure, and each veto is asked of them alone.
TEST(Together, EventsAreEachOnesOwn) {
  Pair pair(false);
  throw_at(pair, 30);
  for (std::size_t k : {0u, 1u}) {
    for (ElasticPlasticJoint* j : pair.joints[k]) j->set_limits(0.01, unlimited, unlimited, unlimited);
  }
  std::vector<int> heard(2), asked(2);
  for (std::size_t k : {0u, 1u}) {
    const auto is_own = [&pair, k](const ElasticPlasticJoint* j) {
      return std::count(pair.joints[k].begin(), pair.joints[k].end(), j) == 1;
    };
    pair.of(k).on_event([&heard, k, is_own](const JointEvent& event) {
      ++heard[k];
      EXPECT_TRUE(is_own(event.joint));
    });
    pair.of(k).may_break([&asked, k, is_own](const ElasticPlasticJoint& joint) {
      ++asked[k];
      EXPECT_TRUE(is_own(&joint));
      return false;
    });
  }
  pair.run(1);
  EXPECT_GT(heard[1], 0);
  EXPECT_GT(asked[1], 0);
  EXPECT_EQ(asked[0], 0);  // the dumbbell is rigid and has no caps
  EXPECT_EQ(pair.of(1).joints().size(), pair.joints[1].size());
}

// Of those that are solved otherwise bodies push, as all that is not solved with a structure.
TEST(Together, NotWhereTheyAreSolvedOtherwise) {
  b2World world({0, -g});
  world.SetAllowSleeping(false);
  Structure direct(world), iterative(world, {.solver = SolverKind::iterative});
  b2Body* wall = add_box(world, {.type = b2_staticBody});
  std::vector<b2Body*> boxes;
  for (Structure* s : {&direct, &iterative}) {
    boxes.push_back(add_box(world, {.x = 1,
                                    .y = s == &direct ? 0.0 : 0.49,
                                    .height = 0.4,
                                    .mass = 100,
                                    .group = s == &direct ? short{-1} : short{-2}}));
    ElasticPlasticJointDef joint;
    joint.Initialize(wall, boxes.back(), boxes.back()->GetPosition() - vec(0.5, 0), {1, 0});
    s->create_joint(joint);
  }
  for (int i = 0; i < 120; ++i) {
    world.Step(1.0f / 60, 8, 3);
    direct.update();
    iterative.update();
  }
  EXPECT_TRUE(finite(boxes));
  EXPECT_GT(boxes[1]->GetPosition().y, 0.35f);
  EXPECT_EQ(direct.report().bounds_hit, 0);
}

}  // namespace
}  // namespace ductile
