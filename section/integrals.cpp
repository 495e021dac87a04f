#include "integrals.h"

namespace ductile {

Moments moments(const Boundary& boundary, const Boundary::Loop& loop) {
  Moments m;
  auto p = vertex<DoubleDouble>(boundary, loop.begin);
  for (std::size_t i = loop.begin + 1; i < loop.end; ++i) {
    const auto q = vertex<DoubleDouble>(boundary, i);
    const DoubleDouble cross = p.x * q.y - q.x * p.y;
    m.A += cross;
    m.Sx += (p.x + q.x) * cross;
    m.Sy += (p.y + q.y) * cross;
    m.Jxx += (p.x * p.x + p.x * q.x + q.x * q.x) * cross;
    m.Jyy += (p.y * p.y + p.y * q.y + q.y * q.y) * cross;
    m.Jxy += ((p.x + p.x + q.x) * p.y + (p.x + q.x + q.x) * q.y) * cross;
    p = q;
  }
  return {m.A / 2.0, m.Sx / 6.0, m.Sy / 6.0, m.Jxx / 12.0, m.Jxy / 24.0, m.Jyy / 12.0};
}

}  // namespace ductile
