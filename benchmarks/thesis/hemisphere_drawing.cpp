#include "hemisphere_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kaustik::thesis {
namespace {

constexpr double size = 360, radius = 160, center = size / 2;

std::string point_text(double r, double phi) {
  return fmt::format("{:.2f} {:.2f}", center + r * std::cos(phi), center - r * std::sin(phi));
}

/// A sector of a ring.
std::string cell_path(const HemisphereGrid& grid, int i, int j) {
  const double inner = radius * std::sqrt(double(i) / grid.theta_cells);
  const double outer = radius * std::sqrt(double(i + 1) / grid.theta_cells);
  const double from = 2 * M_PI * j / grid.phi_cells, to = 2 * M_PI * (j + 1) / grid.phi_cells;
  return fmt::format("M {} A {:.2f} {:.2f} 0 0 0 {} L {} A {:.2f} {:.2f} 0 0 1 {} Z",
                     point_text(outer, from), outer, outer, point_text(outer, to),
                     point_text(inner, to), inner, inner, point_text(inner, from));
}

}  // namespace

std::string draw_hemisphere(const HemisphereGrid& grid, const std::vector<float>& cell_importance,
                            const std::vector<Vec3f>& directions) {
  const float largest = *std::max_element(cell_importance.begin(), cell_importance.end());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {0:.0f}\">\n"
      "<rect width=\"{0:.0f}\" height=\"{0:.0f}\" fill=\"white\"/>\n",
      size);
  for (int i = 0; i < grid.theta_cells; ++i)
    for (int j = 0; j < grid.phi_cells; ++j) {
      const float share = cell_importance[size_t(i * grid.phi_cells + j)] / largest;
      const int red = int(std::lround(255 - 15 * share)),
                green = int(std::lround(255 - 115 * share)),
                blue = int(std::lround(255 - 235 * share));
      svg += fmt::format("<path d=\"{}\" fill=\"rgb({},{},{})\" stroke=\"#888\"/>\n",
                         cell_path(grid, i, j), red, green, blue);
    }
  for (const Vec3f& d : directions)
    svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"2.5\" fill=\"#203050\"/>\n",
                       center + radius * d.x, center - radius * d.y);
  return svg + "</svg>\n";
}

}  // namespace kaustik::thesis
