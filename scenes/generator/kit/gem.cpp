#include "kit/gem.h"

namespace kaustik::scenes {

Mesh brilliant(double diameter, const BrilliantCut& cut) {
  const double radius = 0.5 * diameter, girdle = cut.girdle * diameter;
  const double crown_slope = std::tan(cut.crown_degrees * pi_d / 180);
  const double pavilion_slope = std::tan(cut.pavilion_degrees * pi_d / 180);
  const double half_turn = std::cos(pi_d / 8);  // of a main facet's edge from its middle
  const double table = cut.table * radius;
  const double star = table * half_turn + cut.star * (radius - table * half_turn);
  const double half = (1 - cut.lower_halves) * radius;

  Mesh mesh;
  // `sixteenths` of a turn; main facets look toward the even ones.
  const auto at = [&](int sixteenths, double r, double z) {
    const double angle = 2 * pi_d * (sixteenths % 16) / 16;
    return mesh.add({r * std::cos(angle), r * std::sin(angle), z});
  };
  const auto crown = [&](double r) { return girdle + (radius - r) * crown_slope; };
  const auto pavilion = [&](double r) { return -(radius - r) * pavilion_slope; };
  const uint32_t top = mesh.add({0, 0, crown(table)});
  const uint32_t point = mesh.add({0, 0, pavilion(0)});
  for (int i = 0; i < 16; i += 2) {
    const uint32_t table_0 = at(i, table, crown(table)), table_1 = at(i + 2, table, crown(table));
    const uint32_t star_0 = at(i + 15, star, crown(star * half_turn));
    const uint32_t star_1 = at(i + 1, star, crown(star * half_turn));
    const uint32_t half_0 = at(i + 15, half, pavilion(half * half_turn));
    const uint32_t half_1 = at(i + 1, half, pavilion(half * half_turn));
    uint32_t upper[3], lower[3];
    for (int k = 0; k < 3; ++k) {
      upper[k] = at(i + k, radius, girdle);
      lower[k] = at(i + k, radius, 0);
    }
    mesh.triangle(top, table_0, table_1);
    mesh.triangle(table_0, star_1, table_1);
    mesh.quad(table_0, star_0, upper[0], star_1);
    mesh.quad(point, half_1, lower[0], half_0);
    for (int k = 0; k < 2; ++k) {
      mesh.triangle(star_1, upper[k], upper[k + 1]);
      mesh.triangle(half_1, lower[k + 1], lower[k]);
      mesh.quad(lower[k], lower[k + 1], upper[k + 1], upper[k]);
    }
  }
  return shaded(mesh, 0);
}

}  // namespace kaustik::scenes
