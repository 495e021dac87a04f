// Structures of many boxes, built either with our joints or with stock ones, for timing and judging one
// against the other. Steel, SI, depth 1 m.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "ductile/joint.h"

namespace ductile::bench {

struct Steel {
  static constexpr double density = 7800, E = 210e9, fy = 350e6, fracture_strain = 0.2;
};

/// Where pieces lie and where they are joined. Built into a world by Built.
struct Layout {
  struct Piece {
    double x, y, angle, length, height;
    double density = Steel::density;  // kg/m³
    double mass() const { return density * length * height; }
    double inertia() const { return mass() * (length * length + height * height) / 12; }
  };
  struct Weld {
    int a, b;  // pieces; a = -1: the ground
    double x, y, angle;
    double span;          // ℓ of EA/ℓ and EI/ℓ, m
    bool pinned = false;  // no moment
  };
  std::vector<Piece> pieces;
  std::vector<Weld> welds;
  double E = Steel::E;  // infinite: rigid
  double damping = 0;   // s: c/k of every row, of a material that damps; none of rigid ones
  bool yields = true, breaks = true;

  int box(double x, double y, double angle, double length, double height) {
    pieces.push_back({x, y, angle, length, height});
    return static_cast<int>(pieces.size()) - 1;
  }
  void weld(int a, int b, double x, double y, double angle, double span, bool pinned = false) {
    welds.push_back({a, b, x, y, angle, span, pinned});
  }
  /// Without the joints to the ground.
  Layout let_go() const {
    Layout free = *this;
    std::erase_if(free.welds, [](const Weld& w) { return w.a < 0; });
    return free;
  }
};

/// `count` level cantilevers of 20 m × 1 m in a square array, so far apart that none meets another while
/// swinging.
inline Layout chains(int count, int pieces, bool pinned) {
  Layout layout;
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  const double l = 20.0 / pieces;
  for (int c = 0; c < count; ++c) {
    const double x = 45.0 * (c % side - side / 2), y = 45.0 * (c / side - side / 2);
    int previous = -1;
    for (int i = 0; i < pieces; ++i) {
      const int piece = layout.box(x + (i + 0.5) * l, y, 0, l, 1);
      layout.weld(previous, piece, x + i * l, y, 0, previous < 0 ? l / 2 : l, pinned && previous < 0);
      previous = piece;
    }
  }
  return layout;
}

/// Storeys × bays of 2.5 m, each member of four parts 0.625 m × 0.1 m (scenes.md: Frame): storeys·(9·bays +
/// 4) joints, 160 for 4 × 4. Columns are joined to the beam above at the node, beams run through.
inline Layout frame(int storeys, int bays) {
  constexpr int parts = 4;
  constexpr double bay = 2.5, l = bay / parts, h = 0.1, up = std::numbers::pi / 2;
  Layout layout;
  std::vector<int> heads(static_cast<std::size_t>(bays) + 1, -1);  // what the next column stands on
  for (int s = 0; s < storeys; ++s) {
    std::vector<int> beam;
    const double y = bay * (s + 1);
    for (int m = 0; m < bays * parts; ++m) {
      beam.push_back(layout.box((m + 0.5) * l, y, 0, l, h));
      if (m > 0) layout.weld(beam[static_cast<std::size_t>(m) - 1], beam.back(), m * l, y, 0, l);
    }
    for (int i = 0; i <= bays; ++i) {
      int& head = heads[static_cast<std::size_t>(i)];
      for (int k = 0; k < parts; ++k) {
        const int part = layout.box(bay * i, bay * s + (k + 0.5) * l, up, l, h);
        layout.weld(head, part, bay * i, bay * s + k * l, up, head < 0 ? l / 2 : l);
        head = part;
      }
      layout.weld(head, beam[static_cast<std::size_t>(std::min(i * parts, bays * parts - 1))], bay * i, y, up,
                  l);
    }
  }
  return layout;
}

/// n columns × m boxes of 1 m, each welded to its neighbours and the first column to the ground: n(2m − 1)
/// joints.
inline Layout grid(int n, int m) {
  Layout layout;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const int box = layout.box(i + 0.5, j + 0.5, 0, 1, 1);
      layout.weld(i == 0 ? -1 : box - m, box, i, j + 0.5, 0, i == 0 ? 0.5 : 1);
      if (j > 0) layout.weld(box - 1, box, i + 0.5, j, std::numbers::pi / 2, 1);
    }
  }
  return layout;
}

/// One chain of `pieces` boxes of 0.5 m, laid to and fro in rows of 250 and held to the ground every 50
/// pieces: any length, and yet no coordinate so large that floats fail.
inline Layout serpentine(int pieces) {
  constexpr int row = 250, held = 50;
  constexpr double l = 0.5, pitch = 1.5;
  Layout layout;
  for (int i = 0; i < pieces; ++i) {
    const int r = i / row, k = i % row;
    const bool back = r % 2 != 0;
    const double x = ((back ? row - 1 - k : k) + 0.5) * l, y = pitch * r, angle = back ? std::numbers::pi : 0;
    const int box = layout.box(x, y, angle, l, l);
    if (i == 0) {
      layout.weld(-1, box, x - l / 2, y, 0, l / 2);
    } else if (k == 0) {
      layout.weld(box - 1, box, x, y - pitch / 2, std::numbers::pi / 2, pitch);  // the turn to the next row
    } else {
      layout.weld(box - 1, box, x - (back ? -l : l) / 2, y, angle, l);
    }
    if (i % held == held / 2) layout.weld(-1, box, x, y, angle, l);
  }
  return layout;
}

/// A layout in a world of its own. Pieces of a structure do not collide with each other; nothing sleeps.
struct Built {
  enum Kind {
    ours,
    iterative,    // ours, in the paper's own scheme
    stock,        // rigid b2WeldJoints
    stock_soft,   // b2WeldJoints with the joint's bending stiffness
    stock_hinges  // b2RevoluteJoints whose motors give way at the plastic moment
  };

  /// `keep_ledger` is for the direct solver alone; others have none.
  Built(const Layout& layout, Kind kind, double gravity, bool keep_ledger = false)
      : world({0, static_cast<float>(-gravity)}), has_ledger(keep_ledger && kind == ours) {
    world.SetAllowSleeping(false);
    if (kind <= iterative) {
      structure.emplace(world,
                        StructureDef{.solver = kind == ours ? SolverKind::direct : SolverKind::iterative,
                                     .keep_ledger = has_ledger});
    }
    b2BodyDef at_origin;
    ground = world.CreateBody(&at_origin);
    for (const Layout::Piece& p : layout.pieces) {
      b2BodyDef def;
      def.type = b2_dynamicBody;
      def.position = vec(p.x, p.y);
      def.angle = static_cast<float>(p.angle);
      b2PolygonShape shape;
      shape.SetAsBox(static_cast<float>(p.length / 2), static_cast<float>(p.height / 2));
      b2FixtureDef fixture;
      fixture.shape = &shape;
      fixture.density = static_cast<float>(p.density);
      fixture.filter.groupIndex = -1;
      pieces.push_back(world.CreateBody(&def));
      pieces.back()->CreateFixture(&fixture);
    }
    for (const Layout::Weld& w : layout.welds) {
      b2Body* a = w.a < 0 ? ground : pieces[static_cast<std::size_t>(w.a)];
      b2Body* b = pieces[static_cast<std::size_t>(w.b)];
      const ElasticPlasticJointDef ep =
          joint(layout, w, layout.pieces[static_cast<std::size_t>(w.b)].height, a, b);
      if (kind <= iterative) {
        joints.push_back(structure->create_joint(ep));
      } else if (kind == stock_hinges) {
        b2RevoluteJointDef def;
        def.Initialize(a, b, vec(w.x, w.y));
        def.enableMotor = true;
        def.maxMotorTorque = static_cast<float>(ep.rows[rotation].cap);
        joints.push_back(world.CreateJoint(&def));
      } else {
        b2WeldJointDef def;
        def.Initialize(a, b, vec(w.x, w.y));
        if (kind == stock_soft) {
          def.stiffness = static_cast<float>(ep.rows[rotation].stiffness);
          def.damping = static_cast<float>(ep.rows[rotation].damping);
        }
        joints.push_back(world.CreateJoint(&def));
      }
    }
  }

  /// One step as a game makes it.
  void step(double dt = 1. / 60, int velocity_iterations = 8, int position_iterations = 3) {
    world.Step(static_cast<float>(dt), velocity_iterations, position_iterations);
    ++steps;
    if (!structure) return;
    structure->update();
    const StepReport& r = structure->report();
    sum.solves += r.solves;
    sum.skipped += r.skipped;
    sum.rounds += r.rounds;
    sum.factorisations += r.factorisations;
    sum.projections += r.projections;
    sum.bounds_hit += r.bounds_hit;
    sum.residual = std::max(sum.residual, r.residual);
  }
  void run(double seconds) {
    for (int i = 0; i < 60 * seconds; ++i) step();
  }
  /// All pieces as one rigid body that moves at v and turns at w about the origin.
  void set_rigid_motion(double vx, double vy, double w) {
    for (b2Body* p : pieces) {
      const b2Vec2 c = p->GetWorldCenter();
      p->SetLinearVelocity(vec(vx - w * c.y, vy + w * c.x));
      p->SetAngularVelocity(static_cast<float>(w));
    }
  }

  /// A ball that comes flying at (vx, vy).
  void throw_bomb(double mass, double radius, double x, double y, double vx, double vy) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = vec(x, y);
    def.linearVelocity = vec(vx, vy);
    def.bullet = true;
    b2CircleShape ball;
    ball.m_radius = static_cast<float>(radius);
    b2FixtureDef fixture;
    fixture.shape = &ball;
    fixture.density = static_cast<float>(mass / (std::numbers::pi * radius * radius));
    world.CreateBody(&def)->CreateFixture(&fixture);
  }

  /// A box that is no piece, kg/m².
  b2Body* add_box(double x, double y, double width, double height, double density) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = vec(x, y);
    b2PolygonShape box;
    box.SetAsBox(static_cast<float>(width / 2), static_cast<float>(height / 2));
    b2Body* body = world.CreateBody(&def);
    body->CreateFixture(&box, static_cast<float>(density));
    return body;
  }

  static b2Vec2 vec(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

  static ElasticPlasticJointDef joint(const Layout& layout, const Layout::Weld& w, double h, b2Body* a,
                                      b2Body* b) {
    ElasticPlasticJointDef def;
    def.Initialize(a, b, vec(w.x, w.y), vec(std::cos(w.angle), std::sin(w.angle)));
    const double G = layout.E / 2.6;
    const double N = h * Steel::fy, Q = N / std::numbers::sqrt3, M = h * N / 4;
    def.rows[axial] = {.stiffness = layout.E * h / w.span, .cap = N, .cap_reverse = N};
    def.rows[shear] = {.stiffness = 5.0 / 6 * G * h / w.span, .cap = Q, .cap_reverse = Q};
    def.rows[rotation] = {.stiffness = layout.E * h * h * h / 12 / w.span, .cap = M, .cap_reverse = M};
    if (!layout.yields) {
      for (RowDef& row : def.rows) row.cap = row.cap_reverse = unlimited;
    }
    if (layout.damping > 0) {
      for (RowDef& row : def.rows) row.damping = layout.damping * row.stiffness;
    }
    if (w.pinned) def.rows[rotation] = RowDef::free();
    if (layout.yields && layout.breaks) {
      def.max_rotation = 2 * Steel::fracture_strain;  // ε_f L_p / y with L_p = h, y = h/2
      def.max_elongation = Steel::fracture_strain * h;
    }
    return def;
  }

  b2World world;
  bool has_ledger;
  std::optional<Structure> structure;
  b2Body* ground = nullptr;
  std::vector<b2Body*> pieces;
  std::vector<b2Joint*> joints;  // by Layout::welds, as built
  int steps = 0;                 // since the start
  StepReport sum;                // over all steps
};

/// Before a step: ground that shakes sideways, as seen from it, at 1.2 Hz with 3 m/s². A frame of 4 by 4 bays
/// would sway at 2 Hz until it yields. No step is the last again.
inline void shake(Built& b) {
  const double t = b.steps / 60.0;
  b.world.SetGravity(Built::vec(3 * std::cos(2.4 * std::numbers::pi * t), -10));
}

/// A block of a tonne in the middle of each bay of a frame's roof.
inline void load_roof(Built& b, int size) {
  for (int i = 0; i < size; ++i) b.add_box(2.5 * i + 1.25, 2.5 * size + 0.31, 0.5, 0.5, 4000);
}

/// Sixty boxes of 120 kg in six rows on the roof of a frame of 4 by 4 bays.
inline void pile_on_roof(Built& b) {
  for (int i = 0; i < 60; ++i) {
    const int row = i / 10;
    b.add_box(1.5 + 0.62 * (i % 10) + 0.15 * (row % 2), 10.26 + 0.41 * row, 0.6, 0.4, 500);
  }
}

/// A frame of steel that is so many times as heavy: against its weight, its caps are so many times less.
inline Layout heavy_frame(int storeys, int bays, double by) {
  Layout layout = frame(storeys, bays);
  for (Layout::Piece& piece : layout.pieces) piece.density *= by;
  return layout;
}

/// Destroys the columns of a frame's ground floor, and lays a floor under the rest.
inline void take_ground_floor(Built& b, const Layout& layout) {
  b2PolygonShape floor;
  floor.SetAsBox(1000, 1, {0, -1.05f}, 0);
  b.ground->CreateFixture(&floor, 0);
  for (std::size_t i = 0; i < layout.pieces.size(); ++i) {
    const Layout::Piece& piece = layout.pieces[i];
    if (piece.angle != 0 && piece.y < 2.5) b.world.DestroyBody(b.pieces[i]);
  }
}

/// Damps all pieces, 1/s, but not what gravity gives them in a step, of which Box2D would take its share.
inline void damp(Built& b, double by) {
  for (b2Body* piece : b.pieces) {
    piece->SetLinearDamping(static_cast<float>(by));
    piece->SetAngularDamping(static_cast<float>(by));
    piece->SetGravityScale(static_cast<float>(1 + by / 60));
  }
}

/// What the damping takes of gravity comes back as it goes, slowly, or a frame would sway for minutes.
inline void calm(Built& b) {
  for (const float by : {3.0f, 1.0f, 0.3f, 0.1f, 0.03f, 0.0f}) {
    for (b2Body* piece : b.pieces) {
      piece->SetLinearDamping(by);
      piece->SetAngularDamping(by);
    }
    b.run(by == 3 ? 20 : 5);
  }
}

}  // namespace ductile::bench
