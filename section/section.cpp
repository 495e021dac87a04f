#include "ductile/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "section_data.h"

namespace ductile {
template <class Real>
void Section::Data::sum() {
  geometric = strength = asymmetry = modulus = {};
  DoubleDouble tension, compression, shear;
  boundary.reach = 0;
  for (Boundary::Loop& loop : boundary.loops) {
    const Material& material = regions[loop.region].material;
    const double ft = material.yield_stress, fc = material.compression(), h = (ft + fc) / 2;
    const double E = E_known ? material.youngs_modulus : 1;
    const Moments<Real> own = moments<Real>(boundary, loop);
    const double sign = (to_double(own.A) < 0 ? -1 : 1) * (loop.hole ? -1 : 1);
    loop.strength = sign * h;
    const Moments<DoubleDouble> m{own.A, own.Sx, own.Sy};
    const auto add = [&](Weighted& to, double weight) {
      to.sum.add(m, sign * weight);
      to.scatter = std::sqrt(to.scatter * to.scatter + weight * weight * loop.length2);
    };
    add(geometric, 1);
    add(strength, h);
    add(asymmetry, (ft - fc) / 2);
    add(modulus, E);
    tension += m.A * (sign * ft);
    compression += m.A * (sign * fc);
    shear += m.A * (sign * material.shear());
    boundary.reach += h * loop.length;
  }
  N = to_double(tension);
  Nc = to_double(compression);
  Q = to_double(shear);
}

void require_direction(Point d) {
  if (!(std::isfinite(d.x) && std::isfinite(d.y)) || (d.x == 0 && d.y == 0))
    throw std::invalid_argument("a bending direction must be a finite vector that is not zero");
}

Section::Section(std::span<const Region> regions) {
  if (auto problems = validate(regions); !problems.empty()) throw InvalidInput(std::move(problems));
  auto data = std::make_shared<Data>(regions);
  const Material& first = regions.front().material;
  data->E_known = first.youngs_modulus > 0;
  data->sum<double>();
  const auto doubtful = [&](const Data::Weighted& weighted) {
    const double A = to_double(weighted.sum.A);
    return !(data->boundary.rounding(weighted.scatter, A) <= trusted * A);
  };
  if (doubtful(data->geometric) || doubtful(data->strength) || doubtful(data->modulus))
    data->sum<DoubleDouble>();
  data->boundary.summarise();
  for (const Region& region : regions) {
    const Material& material = region.material;
    data->one_material &= material.youngs_modulus == first.youngs_modulus &&
                          material.yield_stress == first.yield_stress &&
                          material.compression() == first.compression();
    data->f_differ |= material.yield_stress != material.compression();
  }
  data_ = std::move(data);
}

Section::Section(const Outline& outline, const Material& material)
    : Section(std::vector<Region>{{outline, material}}) {}

double Section::area() const { return to_double(data_->geometric.sum.A); }

Point Section::centroid() const {
  const auto& m = data_->geometric.sum;
  const Point o = data_->boundary.origin;
  return {to_double(m.Sx / m.A + o.x), to_double(m.Sy / m.A + o.y)};
}

std::span<const Region> Section::regions() const { return data_->regions; }

Capacities Section::capacities(Point direction) const {
  require_direction(direction);
  Capacities result{.N = data_->N, .Nc = data_->Nc, .Q = data_->Q};
  const DoubleDouble C = data_->asymmetry.sum.A;
  const NeutralAxis axis = data_->neutral_axis(direction, -C);  // N = C + G = 0
  result.M = result.M_reverse = to_double(axis.F);
  result.pna = result.pna_reverse = axis.absolute;
  if (data_->f_differ) {
    const NeutralAxis reverse = data_->neutral_axis(direction, C);  // N = C − G = 0
    const auto d = unit<DoubleDouble>(direction);
    result.M = to_double(axis.F + first_moment(data_->asymmetry.sum, d, axis.s));
    result.M_reverse = to_double(reverse.F - first_moment(data_->asymmetry.sum, d, reverse.s));
    result.pna_reverse = reverse.absolute;
  }
  return result;
}

template <class Real>
Section::Data::Bent Section::Data::bend(Vec<Real> d, Real axis) const {
  Real EI = 0.0;
  Bent result{.curvature = std::numeric_limits<double>::infinity()};
  for (const Boundary::Loop& loop : boundary.loops) {
    const Material& material = regions[loop.region].material;
    const double E = E_known ? material.youngs_modulus : 1;
    const Bending<Real> own = bending(boundary, loop, d, axis);
    EI += own.second * std::copysign(E, loop.strength);
    const double above = to_double(own.above), below = to_double(own.below);
    result.farthest = std::max({result.farthest, above, below});
    result.curvature = std::min(
        {result.curvature, material.yield_stress / (E * above), material.compression() / (E * below)});
  }
  result.EI = to_double(EI);
  return result;
}

Elastic Section::elastic(Point direction) const {
  require_direction(direction);
  const Moments<DoubleDouble>& m = data_->modulus.sum;
  const DoubleDouble x = m.Sx / m.A, y = m.Sy / m.A;
  const auto d = unit<double>(direction);
  Data::Bent bent = data_->bend<double>(d, to_double(x) * d.x + to_double(y) * d.y);
  // Relative errors: of the area within, and of the lever, which is ε·radius in a mean lever of √(EI/EA).
  const double A = to_double(m.A), lever = std::sqrt(bent.EI / A);
  const double error = data_->boundary.rounding(data_->modulus.scatter, A) / A;
  if (!(error * std::max(1.0, 3 * data_->boundary.radius / lever) <= trusted)) {
    const auto dd = unit<DoubleDouble>(direction);
    bent = data_->bend<DoubleDouble>(dd, x * dd.x + y * dd.y);
  }

  const Capacities plastic = capacities(direction);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const Material& material = data_->regions.front().material;
  const double I =
      data_->one_material ? (data_->E_known ? bent.EI / material.youngs_modulus : bent.EI) : unknown;
  const Point o = data_->boundary.origin;
  const double yield_moment = bent.EI * bent.curvature;
  return {.centroid = {to_double(x + o.x), to_double(y + o.y)},
          .EA = data_->E_known ? A : 0,
          .EI = data_->E_known ? bent.EI : 0,
          .I = I,
          .W_elastic = I / bent.farthest,
          .W_plastic = data_->one_material ? plastic.M / material.yield_stress : unknown,
          .yield_moment = yield_moment,
          .shape_factor = plastic.M / yield_moment};
}

PrincipalAxes Section::principal_axes() const {
  // EI toward (cos α, sin α) is xx cos²α + 2 xy cos α sin α + yy sin²α: three directions tell all, and the
  // extremes are at tan 2α = 2 xy/(xx − yy).
  const Moments<DoubleDouble>& m = data_->modulus.sum;
  const auto EI = [&](Point direction) {
    const auto d = unit<DoubleDouble>(direction);
    return data_->bend<DoubleDouble>(d, (m.Sx * d.x + m.Sy * d.y) / m.A).EI;
  };
  const double xx = EI({1, 0}), yy = EI({0, 1}), xy = EI({1, 1}) - (xx + yy) / 2;
  const double angle = std::atan2(2 * xy, xx - yy) / 2;
  return {.strong = {std::cos(angle), std::sin(angle)}, .weak = {-std::sin(angle), std::cos(angle)}};
}

double doubled_area(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Point o = ring[0], a = ring[i - 1], b = ring[i];
    sum += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  }
  return sum;
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
