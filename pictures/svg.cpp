#include "svg.h"

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace ductile::picture {

std::string quantity(double value, const char* unit) {
  if (!std::isfinite(value)) return "unlimited";
  static constexpr std::array<std::pair<double, const char*>, 4> prefixes{
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}}};
  for (const auto& [factor, prefix] : prefixes)
    if (std::abs(value) >= factor * 0.9995) return fmt::format("{:.3g} {}{}", value / factor, prefix, unit);
  return fmt::format("{:.2g} {}", value, unit);
}

std::string hex(Colour c) { return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue); }

Node page(pugi::xml_document& document, double width, double height, const std::string& title,
          const std::string& subtitle) {
  Node svg = add(document, "svg", "xmlns", "http://www.w3.org/2000/svg", "width", width, "height", height,
                 "viewBox", fmt::format("0 0 {:.5g} {:.5g}", width, height), "font-family",
                 "'DejaVu Sans', Verdana, 'Segoe UI', sans-serif", "font-size", "13", "fill", ink);
  hover(svg, title);
  add(svg, "rect", "width", width, "height", height, "rx", "8", "fill", "#ffffff");
  write(svg, title, margin, 30, "font-size", "19", "font-weight", "bold");
  write(svg, subtitle, margin, 51, "fill", quiet);
  return svg;
}

void scale_bar(Node to, double px_per_metre, Point right, double most) {
  double length = std::pow(10, std::floor(std::log10(most / px_per_metre)));
  for (const double digit : {5., 2.})
    if (digit * length * px_per_metre <= most) {
      length *= digit;
      break;
    }
  const double width = length * px_per_metre;
  add(to, "path", "fill", "none", "stroke", ink, "stroke-width", "1.6", "d",
      fmt::format("M{:.1f} {:.1f}v-8h{:.1f}v8", right.x - width, right.y, width));
  const std::string words = length < 1 ? fmt::format("{:g} mm", length * 1e3) : fmt::format("{:g} m", length);
  write(to, words, right.x - width / 2, right.y + 17, "text-anchor", "middle", "font-size", "12");
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration);
  return std::move(text).str() + "\n";
}

}  // namespace ductile::picture
