#pragma once
// Scenes in which something glossy is in view of matt surfaces that light one another.

#include <utility>
#include <vector>

#include "tests/support/scene_text.h"

namespace kaustik::test {

/// A matt floor and a wall behind it under a lamp, with something in front, in `size` pixels.
inline std::string glossy_scene(const std::string& floor, const std::string& wall,
                                const std::string& objects, int size) {
  return camera("0, -4, 1.6", "0, 0, 0.5", 40, size) + flat("rectangle", scale("2, 2, 1"), floor) +
         flat("rectangle", scale("2, 2, 1") + rotate("1, 0, 0", 90) + translate("0, 2, 0"), wall) +
         flat("rectangle", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0.8, 0, 2"),
              diffuse("0") + area_light("8")) +
         objects;
}
inline std::string frosted_sheet(double y, double exponent) {
  return flat("rectangle", rotate("1, 0, 0", 90) + translate(fmt::format("0, {}, 1", y)),
              fmt::format(R"(<bsdf type="thinphong"><rgb name="diffuse_reflectance" value="0"/>
              <rgb name="specular_reflectance" value="0"/><rgb name="diffuse_transmittance" value="0"/>
              <rgb name="specular_transmittance" value="0.9"/><float name="exponent" value="{}"/></bsdf>)",
                          exponent));
}

/// By name: rough metal, Phong, frosted sheets.
inline std::vector<std::pair<std::string, std::string>> glossy_scenes(int size) {
  const std::string matt = diffuse("0.7"), ball_center = "0, 0, 0.62";
  const std::string ball = sphere(ball_center, 0.6, diffuse("0.8"));
  const auto scene = [&](const std::string& floor, const std::string& wall,
                         const std::string& objects) {
    return glossy_scene(floor, wall, objects, size);
  };
  return {{"rough_wall", scene(matt, ggx(0.3), ball)},
          {"rough_ball", scene(matt, matt, sphere(ball_center, 0.6, ggx(0.3)))},
          {"smooth_ball", scene(matt, matt, sphere(ball_center, 0.6, ggx(0.08)))},
          {"phong_floor", scene(phong(0.3, 0.6, 20), matt, ball)},
          {"frosted_sheet", scene(matt, matt, frosted_sheet(-0.8, 30))},
          {"frosted_sheets",
           scene(matt, matt, ball + frosted_sheet(-0.8, 200) + frosted_sheet(-1.2, 20))}};
}

}  // namespace kaustik::test
