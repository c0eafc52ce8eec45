#include "scenes/materials.h"

#include <fmt/format.h>

namespace kaustik::scenes {

Xml plain(const Vec3d& color) { return rgb({}, color); }

Xml marble(const Vec3d& ground, const Vec3d& veins, double distance, int seed) {
  Xml texture = object("texture", "marble");
  texture.add(rgb("color0", ground));
  texture.add(rgb("color1", veins));
  texture.add(number("scale", distance));
  texture.add(integer("seed", seed));
  return texture;
}

Xml masonry(const Vec3d& stone, const Vec3d& joints, const Vec2d& size, double joint, double offset,
            double variation) {
  Xml texture = object("texture", "tiles");
  texture.add(rgb("color", stone));
  texture.add(rgb("joint_color", joints));
  texture.add(number("tile_width", size.x - joint));
  texture.add(number("tile_height", size.y - joint));
  texture.add(number("joint", joint));
  texture.add(number("offset", offset));
  texture.add(number("variation", variation));
  return texture;
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
    Xml texture = object("texture", "wood");
    texture.add(rgb("color0", wood.early * tone));
    texture.add(rgb("color1", wood.late * tone));
    texture.add(number("plank_width", wood.board_width));
    texture.add(number("plank_length", 1000));  // the boards end where the mesh says
    texture.add(integer("seed", i));
    std::vector<Xml> steps;
    if (i >= wood.along_x) steps.push_back(rotate({0, 0, 1}, 90));
    steps.push_back(translate(wood.edge));
    texture.add(transform(std::move(steps)));
    glossy(fmt::format("{}_{}", id, i), std::move(texture), gloss, exponent);
  }
}

void Materials::metal(const std::string& id, const std::string& material, double alpha) {
  scene_.add_bsdf(
      id, object("bsdf", "roughconductor", {text("material", material), number("alpha", alpha)}));
}

void Materials::cloth(const std::string& id, const Vec3d& reflectance, const Vec3d& transmittance) {
  scene_.add(object(
      "bsdf", "thinphong",
      {rgb("diffuse_reflectance", reflectance), rgb("diffuse_transmittance", transmittance)}, id));
}

}  // namespace kaustik::scenes
