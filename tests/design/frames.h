// Portal frames of slender members, on their centre lines.
#pragma once

#include "structures.h"

namespace ductile {

/// Columns from (0, 0) and (l, 0) up to h, a girder between, all of square section t by 1 m.
struct Frame {
  double h = 8, l = 10, t = 0.4;
  int pieces = 20;                                             // of each member
  double stiffness() const { return 210e9 / 12 * t * t * t; }  // EI
  double moment() const { return 350e6 / 4 * t * t; }          // M_p

  BodyDef member(const std::string& name, Ring ring, Point from, Point to) const {
    BodyDef body = beam(pieces);
    body.name = name;
    body.outline = {std::move(ring), {}};
    body.along = {from, to};
    return body;
  }
  BodyDef node(const std::string& name, double x) const {
    BodyDef body = beam(1);
    body.name = name;
    body.outline = {rectangle(x - t / 2, h - t / 2, x + t / 2, h + t / 2), {}};
    return body;
  }
  SceneDef scene(bool fixed_feet, double P) const {
    SceneDef s = bending_only();
    const double under = h - t / 2;
    s.bodies = {
        {.name = "floor", .type = BodyType::static_body, .outline = {rectangle(-2, -1, l + 2, 0), {}}},
        member("left", rectangle(-t / 2, 0, t / 2, under), {0, 0}, {0, under}),
        member("right", rectangle(l - t / 2, 0, l + t / 2, under), {l, 0}, {l, under}),
        member("girder", rectangle(t / 2, under, l - t / 2, h + t / 2), {t / 2, h}, {l - t / 2, h}),
        node("west", 0),
        node("east", l)};
    s.joints = {{.a = "left", .b = "west"},
                {.a = "right", .b = "east"},
                {.a = "west", .b = "girder"},
                {.a = "girder", .b = "east"}};
    for (const char* column : {"left", "right"}) {
      JointBetweenDef foot{.a = "floor", .b = column};
      if (!fixed_feet) foot.overrides.moment = 0;
      s.joints.push_back(foot);
    }
    s.loads = {{.body = "west", .at = {0, h}, .force = {0, -P}},
               {.body = "east", .at = {l, h}, .force = {0, -P}}};
    return s;
  }
  SceneDef braced(SceneDef s) const {
    s.supports = {{.body = "east", .at = {l, h}, .fix_x = true}};
    return s;
  }
};

}  // namespace ductile
