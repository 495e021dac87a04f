// Labels that lie on nothing else: each is put at the first of its spots that is free.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "svg.h"

namespace ductile::picture {

class Labels {
 public:
  /// `place`: px, where they may be.
  explicit Labels(const Box& place) : place_(place) {}

  struct Spot {
    Point at;  ///< of the baseline, px
    const char* anchor = "start";
  };

  /// Nothing may lie on the straight line between two points.
  void avoid(Point a, Point b) {
    const int parts = 1 + static_cast<int>(std::hypot(b.x - a.x, b.y - a.y) / 8);
    for (int i = 0; i <= parts; ++i) {
      Box dot;
      dot.add(Point{a.x + (b.x - a.x) * i / parts, a.y + (b.y - a.y) * i / parts});
      taken_.push_back(dot.grown(2));
    }
  }

  /// Where the text goes; nowhere, where no spot is free, unless it must.
  std::optional<Spot> place(const std::string& text, const std::vector<Spot>& spots, bool must) {
    for (const Spot& spot : spots) {
      const Box box = box_of(text, spot);
      if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return overlap(box, other); }) ||
          box.x0 < place_.x0 || box.x1 > place_.x1 || box.y0 < place_.y0 || box.y1 > place_.y1)
        continue;
      taken_.push_back(box);
      return spot;
    }
    if (!must || spots.empty()) return std::nullopt;
    Spot first = spots.front();
    first.at.y = std::clamp(first.at.y, place_.y0 + 16, place_.y1 - 8);
    taken_.push_back(box_of(text, first));
    return first;
  }

  /// Writes the text there, in a white halo.
  void write(Node to, const std::string& text, const std::vector<Spot>& spots, bool must = true) {
    if (const auto spot = place(text, spots, must))
      picture::write(to, text, spot->at.x, spot->at.y, "font-size", size, "fill", ink, "stroke", "#ffffff",
                     "stroke-width", "3", "paint-order", "stroke", "stroke-linejoin", "round", "text-anchor",
                     spot->anchor);
  }

  static constexpr double size = 13;  // px

 private:
  // Digits and small letters are some 0.6 of the size wide.
  static Box box_of(const std::string& text, const Spot& spot) {
    const double width = 0.62 * size * static_cast<double>(text.size());
    const std::string anchor = spot.anchor;
    const double x = spot.at.x - (anchor == "end" ? width : anchor == "middle" ? width / 2 : 0);
    return {x, spot.at.y - 0.8 * size, x + width, spot.at.y + 0.2 * size};
  }
  static bool overlap(const Box& a, const Box& b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
  }

  Box place_;
  std::vector<Box> taken_;
};

}  // namespace ductile::picture
