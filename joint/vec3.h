// Three numbers of one planar body: velocity (vx, vy, ω), momentum, or displacement, in the body's own frame.
#pragma once

#include <cstddef>

#include "ductile/turn.h"
#include "tape.h"

namespace ductile::dynamics {

/// Bodies and joints are numbered by int; as an index.
constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }

struct Vec3 {
  double x = 0, y = 0, w = 0;

  Vec3& operator+=(const Vec3& o) { return x += o.x, y += o.y, w += o.w, *this; }
  Vec3& operator-=(const Vec3& o) { return x -= o.x, y -= o.y, w -= o.w, *this; }
};

inline Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
inline Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
inline Vec3 operator*(double t, const Vec3& a) { return {t * a.x, t * a.y, t * a.w}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.w * b.w; }

template <>
inline constexpr bool all_doubles<Vec3> = true;
template <>
inline constexpr bool all_doubles<Turn> = true;

inline Turn operator*(const Turn& a, const Turn& b) { return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s}; }
inline Turn inverse(const Turn& a) { return {a.c, -a.s}; }

/// A velocity in the world, in the frame of a body that is turned so far; and back.
inline Vec3 into_own_frame(const Turn& turn, const Vec3& v) {
  return {turn.c * v.x + turn.s * v.y, turn.c * v.y - turn.s * v.x, v.w};
}
inline Vec3 into_world(const Turn& turn, const Vec3& v) {
  return {turn.c * v.x - turn.s * v.y, turn.s * v.x + turn.c * v.y, v.w};
}

}  // namespace ductile::dynamics
