#include "scenes/materials.h"

#include <fmt/format.h>

namespace kaustik::scenes {

void Materials::matt(const std::string& id, const Vec3d& color) {
  scene_.add_bsdf(id, object("bsdf", "diffuse", {rgb("reflectance", color)}));
}

void Materials::glossy(const std::string& id, const Vec3d& color, double gloss, double exponent) {
  Xml bsdf = object("bsdf", "phong");
  bsdf.add(rgb("diffuse_reflectance", color));
  bsdf.add(gray("specular_reflectance", gloss));
  bsdf.add(number("exponent", exponent));
  scene_.add_bsdf(id, std::move(bsdf));
}

void Materials::wood(const std::string& id, const Vec3d& color, int tones, double gloss,
                     double exponent) {
  for (int i = 0; i < tones; ++i)
    glossy(fmt::format("{}_{}", id, i), color * (0.82 + 0.36 * i / std::max(1, tones - 1)), gloss,
           exponent);
}

void Materials::metal(const std::string& id, const std::string& material, double alpha) {
  scene_.add_bsdf(
      id, object("bsdf", "roughconductor", {text("material", material), number("alpha", alpha)}));
}

void Materials::marble(const std::string& id, const Vec3d& ground, const Vec3d& veins, double gloss,
                       double exponent) {
  (void)veins;
  glossy(id, ground, gloss, exponent);
}

void Materials::lampshade(const std::string& id, const Vec3d& color) { matt(id, color); }

}  // namespace kaustik::scenes
