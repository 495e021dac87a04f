// The middle line of an outline: along which lines it is a strip, how wide it is there, and where strips
// meet.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ductile/plane.h"
#include "ductile/section.h"
#include "triangulation.h"

namespace ductile::calibration {

/// Across a strip, from its left side to its right one, at equal angles to both.
struct Chord {
  Point left, right;
};
inline Point middle(const Chord& c) { return middle(c.left, c.right); }
inline double width(const Chord& c) { return length(c.left - c.right); }

/// A strip between two ends, as a line with places where chords are known.
struct Member {
  struct Station {
    double s = 0;  ///< m along the line from `start`
    Chord chord;   ///< the line goes through its middle
    int triangle = -1;
    bool follows = false;   ///< between the station before and this one a chord may lie anywhere
    bool straight = false;  ///< and both sides are straight between them
    bool fans = false;      ///< or chords turn from that of the one to that of the other
  };
  std::vector<Station> stations;
  Point start, end;
  double length = 0;       ///< m, from start to end
  int from = -1, to = -1;  ///< indices into Axis::nodes; −1: a free end
  bool closed = false;     ///< a ring without nodes
};

/// From the constrained Delaunay triangulation: its dual graph without the branches that are corners and
/// bumps tells how members run (L. Prasad, "Morphological analysis of shapes", 1997); chords across them give
/// the line. Holes that are small beside the width do not part a strip. No members where an outline is a
/// strip in no direction (a square, a disc).
class Axis {
 public:
  /// `faces`: where other bodies hold the outline. A strip that widens towards one ends there, across it,
  /// rather than in one of its corners.
  explicit Axis(const Outline& outline, std::span<const Chord> faces = {});

  std::vector<Point> nodes;  ///< where three and more members meet
  std::vector<Member> members;

  /// At s along a member: where that is between two stations that follow each other, else at the nearest
  /// station.
  Member::Station at(const Member& member, double s) const;

 private:
  struct Walk;
  struct Graph;
  /// A place on the way from triangle to triangle: a point, and the triangle that the way goes on through.
  struct Step {
    Point at;
    int triangle;
  };
  void add_member(const std::vector<int>& edges, int first, int last, const Graph& graph);
  double find_stations(Member& member, const std::vector<Step>& rough) const;
  void drop_wide_ends(Member& member) const;
  void extend(Member& member, double apart) const;
  std::vector<Member::Station> march(Member::Station from, double sign, double apart,
                                     const Member::Station* up_to, int node) const;
  void end_at(Member& member, const Chord& face) const;
  std::optional<Member::Station> fan(const Member::Station& a, const Member::Station& b, double share) const;
  void add_corners(Member& member, const std::vector<Point>& corners) const;
  std::optional<Member::Station> chord_between(Point left, Point right, const Member::Station& near) const;
  std::optional<Step> step_to(const Member::Station& from, Point at) const;
  static bool is_after(const Member::Station& a, const Member::Station& b);
  static bool follows(const Member::Station& a, const Member::Station& b, double sign = 1);
  void measure();
  std::optional<Member::Station> chord_at(Step start, Point along) const;
  std::optional<Member::Station> chord_across(Step start, Point along) const;
  std::optional<Member::Station> station(Step start, Point along, double to_left, double to_right) const;
  Walk walk(int triangle, Point from, Point direction, double most) const;
  Point points_to(int edge) const;

  std::span<const Chord> faces_;
  Triangulation triangulation_;
  int corners_;                // its first points; feet follow
  std::vector<int> triangle_;  // of every half-edge
  std::vector<int> first_;     // half-edge of every triangle
};

}  // namespace ductile::calibration
