#include "ductile/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "section_data.h"

namespace ductile {
namespace {

Boundary boundary_of(std::span<const Region> regions) {
  Boundary boundary;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Point low{infinity, infinity}, high{-infinity, -infinity};
  std::size_t count = 0;
  for (const Region& region : regions) {
    for (const Point p : region.outline.outer) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    count += region.outline.outer.size() + 1;
    for (const Ring& hole : region.outline.holes) count += hole.size() + 1;
  }
  boundary.origin = {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
  boundary.magnitude = std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
  boundary.local.reserve(count);
  boundary.residual.reserve(count);

  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Material& material = regions[r].material;
    const auto append = [&](const Ring& ring, double solid) {
      Boundary::Loop loop{boundary.local.size(), 0, r, solid, 0};
      const std::size_t size = ring.size() - (ring.front() == ring.back() ? 1 : 0);
      double length = 0;
      for (std::size_t i = 0; i <= size; ++i) {
        const Point p = ring[i % size];
        const auto x = two_sum(p.x, -boundary.origin.x), y = two_sum(p.y, -boundary.origin.y);
        if (i > 0) length += std::hypot(x.hi - boundary.local.back().x, y.hi - boundary.local.back().y);
        boundary.local.push_back({x.hi, y.hi});
        boundary.residual.push_back({x.lo, y.lo});
        boundary.radius = std::max(boundary.radius, std::hypot(x.hi, y.hi));
      }
      loop.end = boundary.local.size();
      if (to_double(moments(boundary, loop).A) < 0) loop.sign = -solid;
      loop.strength = loop.sign * (material.yield_stress + material.compression()) / 2;
      boundary.reach += std::abs(loop.strength) * length;
      boundary.loops.push_back(loop);
    };
    append(regions[r].outline.outer, 1);
    for (const Ring& hole : regions[r].outline.holes) append(hole, -1);
  }
  boundary.radius *= 1 + 4 * std::numeric_limits<double>::epsilon();
  return boundary;
}

double second_moment(const Moments& m, const Vec<DoubleDouble>& d) {  // about the axis through its centroid
  const DoubleDouble first = m.Sx * d.x + m.Sy * d.y;
  return to_double(m.Jxx * d.x * d.x + (m.Jxy + m.Jxy) * d.x * d.y + m.Jyy * d.y * d.y - first * first / m.A);
}

}  // namespace

void require_direction(Point d) {
  if (!(std::isfinite(d.x) && std::isfinite(d.y)) || (d.x == 0 && d.y == 0))
    throw std::invalid_argument("a bending direction must be a finite vector that is not zero");
}

Section::Section(std::span<const Region> regions) {
  if (auto problems = validate(regions); !problems.empty()) throw InvalidInput(std::move(problems));
  auto data = std::make_shared<Data>();
  data->regions.assign(regions.begin(), regions.end());
  data->boundary = boundary_of(regions);
  data->of_region.resize(regions.size());
  for (const Boundary::Loop& loop : data->boundary.loops)
    data->of_region[loop.region].add(moments(data->boundary, loop), loop.sign);

  const Material& first = regions.front().material;
  data->E_known = first.youngs_modulus > 0;
  DoubleDouble N, Nc, Q;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Material& material = regions[r].material;
    const Moments& m = data->of_region[r];
    const double ft = material.yield_stress, fc = material.compression();
    data->geometric.add(m, 1);
    data->strength.add(m, (ft + fc) / 2);
    data->asymmetry.add(m, (ft - fc) / 2);
    data->modulus.add(m, data->E_known ? material.youngs_modulus : 1);
    N += m.A * ft;
    Nc += m.A * fc;
    Q += m.A * material.shear();
    data->one_E &= material.youngs_modulus == first.youngs_modulus;
    data->one_f &= ft == first.yield_stress && fc == first.compression();
    data->f_differ |= ft != fc;
  }
  data->N = to_double(N);
  data->Nc = to_double(Nc);
  data->Q = to_double(Q);
  data_ = std::move(data);
}

Section::Section(const Outline& outline, const Material& material)
    : Section(std::vector<Region>{{outline, material}}) {}

double Section::area() const { return to_double(data_->geometric.A); }

Point Section::centroid() const {
  const Moments& m = data_->geometric;
  const Point o = data_->boundary.origin;
  return {to_double(m.Sx / m.A + o.x), to_double(m.Sy / m.A + o.y)};
}

std::span<const Region> Section::regions() const { return data_->regions; }

Capacities Section::capacities(Point direction) const {
  require_direction(direction);
  Capacities result{.N = data_->N, .Nc = data_->Nc, .Q = data_->Q};
  const DoubleDouble C = data_->asymmetry.A;
  const NeutralAxis axis = data_->neutral_axis(direction, -C);  // N = C + G = 0
  result.M = result.M_reverse = to_double(axis.F);
  result.pna = result.pna_reverse = axis.absolute;
  if (data_->f_differ) {
    const NeutralAxis reverse = data_->neutral_axis(direction, C);  // N = C − G = 0
    const auto d = unit<DoubleDouble>(direction);
    result.M = to_double(axis.F + first_moment(data_->asymmetry, d, axis.s));
    result.M_reverse = to_double(reverse.F - first_moment(data_->asymmetry, d, reverse.s));
    result.pna_reverse = reverse.absolute;
  }
  return result;
}

Elastic Section::elastic(Point direction) const {
  require_direction(direction);
  const Boundary& boundary = data_->boundary;
  const Moments& m = data_->modulus;
  const auto d = unit<DoubleDouble>(direction);
  const DoubleDouble axis = (m.Sx * d.x + m.Sy * d.y) / m.A;
  const double EI = second_moment(m, d);  // I where no E is known

  // A fibre at distance y of modulus E reaches f under the moment EI f/(E y).
  double yield_moment = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const Boundary::Loop& loop : boundary.loops) {
    const Material& material = data_->regions[loop.region].material;
    const double E = data_->E_known ? material.youngs_modulus : 1;
    DoubleDouble above = 0.0, below = 0.0;
    for (std::size_t i = loop.begin + 1; i < loop.end; ++i) {
      const auto p = vertex<DoubleDouble>(boundary, i);
      const DoubleDouble y = p.x * d.x + p.y * d.y - axis;
      if (above < y) above = y;
      if (below < -y) below = -y;
    }
    farthest = std::max({farthest, to_double(above), to_double(below)});
    yield_moment = std::min({yield_moment, EI / E * material.yield_stress / to_double(above),
                             EI / E * material.compression() / to_double(below)});
  }

  const Capacities plastic = capacities(direction);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const bool one_material = data_->one_E && data_->one_f;
  const double I = second_moment(data_->geometric, d), fy = data_->regions.front().material.yield_stress;
  const Point o = boundary.origin;
  return {.centroid = {to_double(m.Sx / m.A + o.x), to_double(m.Sy / m.A + o.y)},
          .EA = data_->E_known ? to_double(m.A) : 0,
          .EI = data_->E_known ? EI : 0,
          .I = one_material ? I : unknown,
          .W_elastic = one_material ? I / farthest : unknown,
          .W_plastic = one_material ? plastic.M / fy : unknown,
          .yield_moment = yield_moment,
          .shape_factor = plastic.M / yield_moment};
}

PrincipalAxes Section::principal_axes() const {
  const Moments& m = data_->modulus;
  const DoubleDouble xx = m.Jxx - m.Sx * m.Sx / m.A, xy = m.Jxy - m.Sx * m.Sy / m.A,
                     yy = m.Jyy - m.Sy * m.Sy / m.A;
  const double angle =
      std::atan2(to_double(xy + xy), to_double(xx - yy)) / 2;  // tan 2α = 2 I_xy/(I_xx − I_yy)
  return {.strong = {std::cos(angle), std::sin(angle)}, .weak = {-std::sin(angle), std::cos(angle)}};
}

std::pair<double, double> Section::extent(Point direction) const {
  require_direction(direction);
  const auto d = unit<double>(direction);
  const Point o = data_->boundary.origin;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Point p : data_->boundary.local) {
    const double s = p.x * d.x + p.y * d.y;
    low = std::min(low, s);
    high = std::max(high, s);
  }
  const double offset = o.x * d.x + o.y * d.y;
  return {offset + low, offset + high};
}

}  // namespace ductile
