// A Box2D world with a structure in it, for games in JavaScript: classes and functions that world.js wraps.
#include <emscripten/bind.h>
#include <emscripten/val.h>

#include <memory>
#include <string>
#include <vector>

#include "ductile/files.h"
#include "ductile/simulation.h"

namespace {
using namespace ductile;
using emscripten::val;

/// What `make` makes; what is wrong with the input becomes an Error of JavaScript with the command's lines.
template <class Make>
auto or_error(const Make& make) {
  std::string message;
  try {
    return make();
  } catch (const InvalidInput& error) {
    for (const Problem& problem : error.problems())
      message += (message.empty() ? "" : "\n") + to_string(problem);
  } catch (const std::exception& error) {
    message = error.what();
  }
  val::global("Error").new_(message).throw_();
  __builtin_unreachable();
}

JointSolver solver_of(const std::string& name) {
  if (name == "direct") return JointSolver::direct;
  if (name == "iterative") return JointSolver::iterative;
  if (name == "stock") return JointSolver::stock;
  throw std::invalid_argument("solver is '" + name + "'; let it be direct, iterative or stock");
}

val points(const Ring& ring) {
  val list = val::array();
  for (const Point& p : ring) {
    val point = val::array();
    point.call<void>("push", p.x, p.y);
    list.call<void>("push", point);
  }
  return list;
}

/// Numbers as they lie in the program's memory: world.js copies them.
val numbers(const std::vector<double>& list) {
  return val(emscripten::typed_memory_view(list.size(), list.data()));
}

class GameWorld {
 public:
  GameWorld(const std::string& scene, const std::string& solver, double dt)
      : run_(or_error([&] {
          SceneDef def = parse_scene(scene, "scene.json", ".");
          Plan plan = in_file("scene.json", [&] { return calibrate(def); });
          return std::make_unique<Simulation>(std::move(plan), solver_of(solver), Stepping{.dt = dt});
        })) {}

  void step(int count) {
    for (int i = 0; i < count; ++i) run_->step();
  }
  double time() const { return run_->time(); }

  /// What does not change: names and shapes of the pieces, names and places of the joints.
  val plan() const {
    const Plan& plan = run_->plan();
    val pieces = val::array(), joints = val::array();
    for (const Piece& piece : plan.pieces) {
      val each = val::object();
      each.set("name", piece.name);
      each.set("body", plan.bodies[static_cast<std::size_t>(piece.body)].name);
      each.set("mass", piece.mass);
      each.set("circle", piece.circle);
      Ring outer = piece.outline.outer;
      for (Point& p : outer) p = {p.x - piece.center.x, p.y - piece.center.y};
      each.set("outline", points(outer));
      pieces.call<void>("push", each);
    }
    for (const PlannedJoint& joint : plan.joints) {
      val each = val::object();
      each.set("name", joint.name);
      each.set("a", joint.a);
      each.set("b", joint.b);
      each.set("N", joint.N);
      each.set("Q", joint.Q);
      each.set("M", joint.M);
      joints.call<void>("push", each);
    }
    val both = val::object();
    both.set("pieces", pieces);
    both.set("joints", joints);
    return both;
  }
  /// x, y, angle of each piece: m of its centre of mass, rad since the start.
  val poses() {
    values_.clear();
    for (std::size_t i = 0; i < run_->plan().pieces.size(); ++i) {
      const PieceReading p = run_->piece(i);
      values_.insert(values_.end(), {p.position.x, p.position.y, p.angle});
    }
    return numbers(values_);
  }
  /// N, Q, M, the largest usage, accumulated rotation, capacity used, broken (1 or 0) of each joint.
  val joints() {
    values_.clear();
    for (std::size_t i = 0; i < run_->plan().joints.size(); ++i) {
      const JointReading j = run_->joint(i);
      const double used =
          std::fmax(j.usage.N, std::fmax(j.usage.Q, j.usage.M));  // NaN: unlimited, passed over
      values_.insert(values_.end(),
                     {j.N, j.Q, j.M, used, j.accumulated_rotation, j.capacity_used, j.broken ? 1. : 0.});
    }
    return numbers(values_);
  }
  /// Yields and breaks since this was asked last.
  val events() {
    constexpr const char* modes[] = {"tension", "compression", "shear", "rotation"};
    val list = val::array();
    for (; told_ < run_->events().size(); ++told_) {
      const SceneEvent& event = run_->events()[told_];
      val each = val::object();
      each.set("time", event.time);
      each.set("joint", event.joint);
      each.set("kind", std::string(event.kind == JointEvent::broke ? "breaks" : "yields"));
      each.set("mode", std::string(modes[event.mode]));
      each.set("force", event.force);
      each.set("energy", event.energy);
      list.call<void>("push", each);
    }
    return list;
  }
  /// N at a point of the world, m, on a piece, in the next step.
  void push(std::size_t piece, double fx, double fy, double x, double y) {
    run_->built().bodies.at(piece)->ApplyForce(vec(fx, fy), vec(x, y), true);
  }
  void impulse(std::size_t piece, double px, double py, double x, double y) {
    run_->built().bodies.at(piece)->ApplyLinearImpulse(vec(px, py), vec(x, y), true);
  }

  /// A disc or a convex polygon of the game's own; index by which it is known.
  std::size_t add(const val& def) {
    b2BodyDef body;
    body.type = b2_dynamicBody;
    body.position = vec(def["at"][0].as<double>(), def["at"][1].as<double>());
    body.angle = def["angle"].as<float>();
    body.linearVelocity = vec(def["velocity"][0].as<double>(), def["velocity"][1].as<double>());
    body.bullet = def["bullet"].as<bool>();
    b2CircleShape disc;
    b2PolygonShape polygon;
    b2FixtureDef fixture;
    fixture.density = def["density"].as<float>();
    fixture.friction = def["friction"].as<float>();
    fixture.restitution = def["restitution"].as<float>();
    if (def["radius"].as<double>() > 0) {
      disc.m_radius = def["radius"].as<float>();
      fixture.shape = &disc;
    } else {
      std::vector<b2Vec2> corners;
      for (const val& corner : emscripten::vecFromJSArray<val>(def["polygon"]))
        corners.push_back(vec(corner[0].as<double>(), corner[1].as<double>()));
      polygon.Set(corners.data(), static_cast<int32>(corners.size()));
      fixture.shape = &polygon;
    }
    b2Body* made = run_->world().CreateBody(&body);
    made->CreateFixture(&fixture);
    added_.push_back(made);
    return added_.size() - 1;
  }
  void remove(std::size_t index) {
    run_->world().DestroyBody(added_.at(index));
    added_[index] = nullptr;
  }
  /// x, y, angle of what was added; NaN where it is gone.
  val added_poses() {
    values_.clear();
    for (const b2Body* body : added_) {
      if (body) {
        const b2Vec2 p = body->GetWorldCenter();
        values_.insert(values_.end(), {p.x, p.y, body->GetAngle()});
      } else {
        values_.insert(values_.end(), 3, std::nan(""));
      }
    }
    return numbers(values_);
  }

 private:
  static b2Vec2 vec(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

  std::unique_ptr<Simulation> run_;
  std::vector<double> values_;
  std::size_t told_ = 0;
  std::vector<b2Body*> added_;
};

}  // namespace

EMSCRIPTEN_BINDINGS(ductile) {
  emscripten::class_<GameWorld>("GameWorld")
      .constructor<std::string, std::string, double>()
      .function("step", &GameWorld::step)
      .function("time", &GameWorld::time)
      .function("plan", &GameWorld::plan)
      .function("poses", &GameWorld::poses)
      .function("joints", &GameWorld::joints)
      .function("events", &GameWorld::events)
      .function("push", &GameWorld::push)
      .function("impulse", &GameWorld::impulse)
      .function("add", &GameWorld::add)
      .function("remove", &GameWorld::remove)
      .function("addedPoses", &GameWorld::added_poses);
}
