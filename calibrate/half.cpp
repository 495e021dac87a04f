#include "half.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ductile/plane.h"

namespace ductile::calibration {
namespace {

// Of the cut's height: chords that differ by less differ by rounding. A cut's height is known that well.
constexpr double rounding = 1e-6;
// Of the cut's height. A cut marks where a bar is weak. What is thinner beside it is a notch or a corner,
// which gives in one place, and no bar: by (H/h)³ it would take the whole bar's stiffness.
constexpr double least_height = 0.5;
constexpr int most_stretches = 64;

// Gauss's three points of a stretch from 0 to 1.
struct Sample {
  double at, weight;
};
constexpr double off_middle = 0.3872983346207417;  // √0.15
constexpr std::array samples{Sample{0.5 - off_middle, 5. / 18}, Sample{0.5, 8. / 18},
                             Sample{0.5 + off_middle, 5. / 18}};

// Between these depths chords grow or shrink evenly, but for parts that are not worth it.
std::vector<double> depths(const Ring& ring, const Face& face, double reach) {
  std::vector<double> result{0};
  for (const Point& p : ring)
    if (const double s = dot(p - face.anchor, face.outward); s > 0 && s < reach) result.push_back(s);
  std::sort(result.begin(), result.end());
  std::size_t kept = 1;
  for (const double s : result)
    if (s - result[kept - 1] > reach / most_stretches) result[kept++] = s;
  result.resize(kept);
  result.push_back(reach);
  return result;
}

// Whether the outline goes on beside the cut higher or lower than the cut, by more than it tapers.
bool steps(const Outline& piece, const Face& face, double reach) {
  const double off = 1e-3 * reach, least = 1e-3 * face.height;
  const Point along = right(face.outward);
  const double near = chord(piece.outer, face.anchor + off * face.outward, along),
               far = chord(piece.outer, face.anchor + 2 * off * face.outward, along);
  return near > 0 && far > 0 && std::abs(2 * near - far - face.height) > least;
}

}  // namespace

Longer half_of(const Outline& piece, const Face& face, double reach) {
  Longer result;
  if (!(reach > 0) || !piece.holes.empty() || !steps(piece, face, reach)) return result;
  const std::vector<double> s = depths(piece.outer, face, reach);
  for (std::size_t i = 1; i < s.size(); ++i)
    for (const Sample& sample : samples) {
      const Point at = face.anchor + (s[i - 1] + sample.at * (s[i] - s[i - 1])) * face.outward;
      const double behind = chord(piece.outer, at, right(face.outward));
      if (behind == 0) continue;
      const double h = behind / face.height,
                   higher = std::max({least_height, std::min(h, 1.), face.share * h});
      if (std::abs(higher - 1) <= rounding) continue;
      const double part = sample.weight * (s[i] - s[i - 1]);
      result.along += part * (1 / higher - 1);
      result.bending += part * (1 / (higher * higher * higher) - 1);
    }
  return result;
}

}  // namespace ductile::calibration
