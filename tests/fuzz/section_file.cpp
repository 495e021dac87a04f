#include "ductile/files.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ductile;
  try {
    const Section section{std::span<const Region>(parse_section(text(data, size)))};
    const Point c = section.centroid();
    require_finite({section.area(), c.x, c.y}, "area and centroid");
    for (const Point d : {Point{1, 0}, Point{0, 1}, Point{-0.6, 0.8}}) {
      const Capacities k = section.capacities(d);
      require_finite({k.N, k.Nc, k.Q, k.M, k.M_reverse, k.pna, k.pna_reverse}, "capacities");
      require(k.N > 0 && k.Nc > 0 && k.Q > 0 && k.M >= 0 && k.M_reverse >= 0, "capacities are positive");
      const Elastic e = section.elastic(d);
      require_finite({e.centroid.x, e.centroid.y, e.EA, e.EI, e.yield_moment}, "elastic values");
      for (const Interaction& point : section.interaction(d, c.x * d.x + c.y * d.y)) {
        require_finite({point.N, point.M}, "interaction");
      }
    }
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
