// Warnings to a designer: what went wrong, and what to do about it.

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "structure.h"

namespace ductile {

using namespace dynamics;

namespace {

/// Of plastic flow, rad or by the way between two bodies, that matters: by so much of its length a rigid
/// structure may drift that is said to stand (report/stability.cpp).
constexpr double least_left_out = 1e-3;

/// Of all plastic work: what a blow bends is promised within so much (docs/games/promises.md).
constexpr double most_left_out = 0.15;

/// By what a body may turn in a step, rad. It moves along a tangent and is brought back in the next, so that
/// a spin of φ a step lies ½φ² of its radius r too far out, at both ends of a chord: m v r (1 + ½φ²) cos ½φ
/// is kept, and ¾φ² of the energy is lost, 1 % at 0.115.
constexpr double most_turn = 0.1;

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char line[300];
  std::va_list values;
  va_start(values, format);
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start() has
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

/// The heavier of two over the lighter, where both are moved by forces.
double mass_ratio(const b2Body* a, const b2Body* b) {
  if (!is_free(a) || !is_free(b)) return 1;
  const double x = a->GetMass(), y = b->GetMass();
  return std::max(x, y) / std::min(x, y);
}

/// By what a body turns in a step about an anchor, rad; one that has it in its centre of mass stays where it
/// is.
double turn_about(const b2Body* body, const b2Vec2& local_anchor, double h) {
  if (!is_free(body) || !((local_anchor - body->GetLocalCenter()).Length() > b2_linearSlop)) return 0;
  return h * std::abs(double{body->GetAngularVelocity()});
}

/// The least width of a fixture without the skin that Box2D gives it, m.
double least_width(const b2Fixture& fixture) {
  const b2Shape* shape = fixture.GetShape();
  if (shape->GetType() == b2Shape::e_circle) return 2 * shape->m_radius;
  if (shape->GetType() != b2Shape::e_polygon) return unlimited;
  const auto& polygon = static_cast<const b2PolygonShape&>(*shape);
  double least = unlimited;  // over the directions of its edges
  for (int32 e = 0; e < polygon.m_count; ++e) {
    double deepest = 0;
    for (int32 i = 0; i < polygon.m_count; ++i) {
      const b2Vec2 to_edge = polygon.m_vertices[e] - polygon.m_vertices[i];
      deepest = std::max(deepest, static_cast<double>(b2Dot(polygon.m_normals[e], to_edge)));
    }
    least = std::min(least, deepest);
  }
  return least;
}

}  // namespace

std::vector<std::string> Structure::warnings() const {
  const Impl& structure = *impl_;
  const StepReport& worst = structure.reports.worst;
  std::vector<std::string> all;
  if (worst.slowed > 0.01) {
    all.push_back(
        text("the speed limit took %.0f %% of the kinetic energy in one step: Box2D moves a body by at "
             "most 2 m and 90 degrees a step; use a smaller step",
             100 * worst.slowed));
  }
  if (structure.reports.stopped > 0) {
    all.push_back(
        text("%d times the velocity of a body was not a finite number, and was taken as 0; look for what the "
             "game set or pushed it with",
             structure.reports.stopped));
  }
  if (const int unsolved = worst.bounds_hit - worst.parted; unsolved > 0) {
    all.push_back(
        text("%d solves did not reach their tolerance: the structure gave way in those steps; use a smaller "
             "step or masses that differ less",
             unsolved));
  }
  if (worst.parted > 0) {
    all.push_back(
        text("%d times bodies were moved to where their joints could not follow: the joints took the new "
             "place as theirs; move what hangs together alike",
             worst.parted));
  }
  if (worst.residual > 1e-6) {
    all.push_back(
        text("a solve left %.1e of its impulses unbalanced, where 1e-8 is promised; use a smaller step or "
             "masses that differ less",
             worst.residual));
  }
  double dissipated = structure.gone.dissipated;
  for (const ElasticPlasticJoint* joint : structure.joints) dissipated += joint->dissipated();
  const LeftOut& left_out = structure.reports.left_out;
  if (left_out.flow > least_left_out && left_out.work > most_left_out * (left_out.work + dissipated)) {
    all.push_back(text(
        "blows that were over within a step left out up to %.2g of plastic flow (rad, or of the way between "
        "two bodies), %.0f %% of the plastic work: use a smaller step",
        left_out.flow, 100 * left_out.work / (left_out.work + dissipated)));
  }
  int lowered = 0;
  double ratio = 1, contact_ratio = 1, width = unlimited;
  double turn = 0;
  std::uint32_t first_lowered = 0, widest = 0, turning = 0;
  for (const ElasticPlasticJoint* joint : structure.joints) {
    for (const Row row : {axial, shear, rotation}) {
      if (joint->stiffness_limited(row) && lowered++ == 0) first_lowered = joint->id();
    }
    auto* j = const_cast<ElasticPlasticJoint*>(joint);
    if (const double r = mass_ratio(j->GetBodyA(), j->GetBodyB()); r > ratio) ratio = r, widest = joint->id();
    if (const Component* c = structure.find(joint->id())->component; c != nullptr) {
      const double h = c->solver.step();
      const double most = std::max(turn_about(j->GetBodyA(), j->GetLocalAnchorA(), h),
                                   turn_about(j->GetBodyB(), j->GetLocalAnchorB(), h));
      if (most > turn) turn = most, turning = joint->id();
    }
    for (const b2Body* body : {j->GetBodyA(), j->GetBodyB()}) {
      for (const b2Fixture* f = body->GetFixtureList(); f != nullptr; f = f->GetNext()) {
        if (is_free(body) && !f->IsSensor()) width = std::min(width, least_width(*f));
      }
      for (const b2ContactEdge* e = body->GetContactList(); e != nullptr; e = e->next) {
        if (e->contact->IsTouching()) contact_ratio = std::max(contact_ratio, mass_ratio(body, e->other));
      }
    }
  }
  if (lowered > 0) {
    all.push_back(
        text("%d rows (the first in joint %u) are stiffer than the step can integrate and are held less "
             "stiffly; use a smaller step where that shows",
             lowered, first_lowered));
  }
  if (turn > most_turn * 1.0001) {
    all.push_back(text(
        "joint %u turns by %.2f rad a step, where %.1g is promised: bodies are drawn apart as they turn, "
        "and a spin loses up to three quarters of the square of it; use a smaller step",
        turning, turn, most_turn));
  }
  if (ratio > 1.0001e6) {
    all.push_back(
        text("joint %u ties masses of %.1e to 1, where 1e6 is promised; make the lighter one heavier", widest,
             ratio));
  }
  if (contact_ratio > 1.0001e3) {
    all.push_back(
        text("a piece touches a body with a mass of %.1e to 1, where 1e3 is promised; use a smaller step, "
             "or join them",
             contact_ratio));
  }
  if (width < 0.02 * 0.999) {
    all.push_back(
        text("a piece has a fixture of %.4f m, where Box2D needs 0.02 m to collide; make it larger, or "
             "leave the fixture out",
             width));
  }
  return all;
}

}  // namespace ductile
