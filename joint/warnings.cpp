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
  int lowered = 0;
  double ratio = 1, contact_ratio = 1, width = unlimited;
  std::uint32_t first_lowered = 0, widest = 0;
  for (const ElasticPlasticJoint* joint : structure.joints) {
    for (const Row row : {axial, shear, rotation}) {
      if (joint->stiffness_limited(row) && lowered++ == 0) first_lowered = joint->id();
    }
    auto* j = const_cast<ElasticPlasticJoint*>(joint);
    if (const double r = mass_ratio(j->GetBodyA(), j->GetBodyB()); r > ratio) ratio = r, widest = joint->id();
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
  if (ratio > 1.0001e6) {
    all.push_back(
        text("joint %u ties masses of %.1e to 1, where 1e6 is promised; make the lighter one heavier", widest,
             ratio));
  }
  if (contact_ratio > 1.0001e3) {
    all.push_back(
        text("a piece touches a body with a mass of %.1e to 1, where 1e3 is promised; use more velocity "
             "iterations, or join them",
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
