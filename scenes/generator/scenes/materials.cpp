#include "scenes/materials.h"

#include <fmt/format.h>

namespace kaustik::scenes {

Xml plain(const Vec3d& color) { return rgb({}, color); }

// Until there are textures for them, stone and wood have their mean colors.

Xml marble(const Vec3d& ground, const Vec3d& veins, double, int) {
  return plain(ground * 0.75 + veins * 0.25);
}

Xml masonry(const Vec3d& stone, const Vec3d&, const Vec2d&, double, double, double variation) {
  return plain(stone * (1 - 0.5 * variation));
}

void Materials::matt(const std::string& id, Xml color) {
  scene_.add_bsdf(id, object("bsdf", "diffuse", {std::move(color).named("reflectance")}));
}

void Materials::glossy(const std::string& id, Xml color, double gloss, double exponent) {
  Xml bsdf = object("bsdf", "phong");
  bsdf.add(std::move(color).named("diffuse_reflectance"));
  bsdf.add(gray("specular_reflectance", gloss));
  bsdf.add(number("exponent", exponent));
  scene_.add_bsdf(id, std::move(bsdf));
}

void Materials::boards(const std::string& id, const BoardWood& wood, double gloss,
                       double exponent) {
  for (int i = 0; i < wood.along_x + wood.along_y; ++i) {
    const double tone = 0.88 + 0.12 * (i % 4);
    const Vec3d mean = wood.early * 0.6 + wood.late * 0.4;
    glossy(fmt::format("{}_{}", id, i), plain(mean * (0.85 * tone)), gloss, exponent);
  }
}

void Materials::metal(const std::string& id, const std::string& material, double alpha) {
  scene_.add_bsdf(
      id, object("bsdf", "roughconductor", {text("material", material), number("alpha", alpha)}));
}

void Materials::cloth(const std::string& id, const Vec3d& reflectance, const Vec3d&) {
  matt(id, reflectance);
}

}  // namespace kaustik::scenes
