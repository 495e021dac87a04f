#include "regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ductile/plane.h"
#include "split.h"

namespace ductile::calibration {
namespace {

// Rings as a graph of directed edges with material on their left, cut where they meet.
class Boundary {
 public:
  explicit Boundary(const Outline& outline) : tolerance_(1e-9 * bounds_of(outline.outer).diagonal()) {
    std::vector<std::vector<int>> rings = {merged(outline.outer, false)};
    for (const Ring& hole : outline.holes) rings.push_back(merged(hole, true));
    leaving_.resize(points_.size());
    for (const std::vector<int>& ring : rings)
      for (std::size_t i = 0; i < ring.size(); ++i) add(ring[i], ring[(i + 1) % ring.size()]);
  }

  // After each edge comes the one that leaves its end nearest to the way it came, with material between the
  // two: what is on the left of a cycle is connected.
  std::vector<Ring> cycles() const {
    std::vector<Ring> result;
    std::vector<bool> taken(edges_.size());
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (taken[first] || edges_[first].gone) continue;
      Ring& ring = result.emplace_back();
      for (std::size_t e = first; !taken[e]; e = after(e)) {
        taken[e] = true;
        ring.push_back(points_[edges_[e].from]);
      }
    }
    return result;
  }

 private:
  struct Edge {
    int from, to;
    bool gone = false;  // one that runs against it lies on it
  };

  // A ring's points, each as the first of those within the tolerance.
  std::vector<int> merged(const Ring& ring, bool clockwise) {
    const bool reverse = (doubled_area(ring) < 0) != clockwise;
    std::vector<int> result;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point p = ring[reverse ? ring.size() - 1 - i : i];
      const auto same =
          std::find_if(points_.begin(), points_.end(), [&](Point q) { return length(p - q) <= tolerance_; });
      const int at = static_cast<int>(same - points_.begin());
      if (same == points_.end()) points_.push_back(p);
      if (result.empty() || result.back() != at) result.push_back(at);
    }
    if (result.size() > 1 && result.back() == result.front()) result.pop_back();
    return result;
  }

  // An edge, cut at the points that lie on it.
  void add(int from, int to) {
    const Point a = points_[from], along = unit(points_[to] - a);
    const double end = length(points_[to] - a);
    std::vector<std::pair<double, int>> on = {{0, from}, {end, to}};
    for (int i = 0; i < std::ssize(points_); ++i) {
      const double t = dot(points_[i] - a, along);
      if (i != from && i != to && t > 0 && t < end && std::abs(cross(along, points_[i] - a)) <= tolerance_)
        on.emplace_back(t, i);
    }
    std::sort(on.begin(), on.end());
    for (std::size_t i = 1; i < on.size(); ++i) add_whole(on[i - 1].second, on[i].second);
  }

  void add_whole(int from, int to) {
    for (const std::size_t e : leaving_[to])
      if (edges_[e].to == from && !edges_[e].gone) {
        edges_[e].gone = true;
        return;
      }
    leaving_[from].push_back(edges_.size());
    edges_.push_back({from, to});
  }

  std::size_t after(std::size_t edge) const {
    const Point at = points_[edges_[edge].to], back = points_[edges_[edge].from] - at;
    std::size_t best = edge;
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t e : leaving_[edges_[edge].to]) {
      if (edges_[e].gone) continue;
      const Point away = points_[edges_[e].to] - at;
      double clockwise = std::atan2(cross(away, back), dot(away, back));
      if (clockwise <= 0) clockwise += 2 * std::numbers::pi;
      if (clockwise < least) {
        least = clockwise;
        best = e;
      }
    }
    return best;
  }

  double tolerance_;
  std::vector<Point> points_;
  std::vector<Edge> edges_;
  std::vector<std::vector<std::size_t>> leaving_;  // by point: its edges
};

}  // namespace

std::vector<Outline> regions(const Outline& outline) {
  std::vector<Outline> result;
  std::vector<Ring> holes;
  for (Ring& ring : Boundary(outline).cycles()) {
    if (doubled_area(ring) > 0)
      result.push_back({std::move(ring), {}});
    else
      holes.push_back(std::move(ring));
  }
  for (Ring& hole : holes) {
    const auto around = std::find_if(result.begin(), result.end(), [&](const Outline& region) {
      return std::any_of(hole.begin(), hole.end(), [&](Point p) { return locate(region.outer, p) > 0; });
    });
    if (around != result.end()) around->holes.push_back(std::move(hole));
  }
  return result;
}

}  // namespace ductile::calibration
