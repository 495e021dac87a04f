#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include "ductile/section_cgal.h"

namespace {
using namespace ductile;

template <class Kernel>
void expect_square_with_a_hole() {
  using Point_2 = typename Kernel::Point_2;
  CGAL::Polygon_2<Kernel> square, hole;
  for (const auto& [x, y] : {std::pair{0, 0}, {4, 0}, {4, 4}, {0, 4}}) square.push_back(Point_2(x, y));
  for (const auto& [x, y] : {std::pair{1, 1}, {1, 2}, {2, 2}, {2, 1}}) hole.push_back(Point_2(x, y));
  EXPECT_EQ(Section(outline(square), materials::S235).area(), 16);
  CGAL::Polygon_with_holes_2<Kernel> plate(square);
  plate.add_hole(hole);
  EXPECT_EQ(Section(outline(plate), materials::S235).area(), 15);
}

TEST(Cgal, PolygonsBecomeOutlines) {
  expect_square_with_a_hole<CGAL::Exact_predicates_inexact_constructions_kernel>();
  expect_square_with_a_hole<CGAL::Exact_predicates_exact_constructions_kernel>();
}

TEST(Cgal, AnUnboundedPolygonIsRefused) {
  const CGAL::Polygon_with_holes_2<CGAL::Exact_predicates_inexact_constructions_kernel> everything;
  EXPECT_THROW(Section(outline(everything), materials::S235), InvalidInput);
}
}  // namespace
