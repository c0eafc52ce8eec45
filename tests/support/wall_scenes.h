#pragma once
// Scenes in which light ends at walls, doors, furniture and bodies that stand on a floor, so that
// what merges near them must not reach through.

#include <utility>
#include <vector>

#include "tests/support/scene_text.h"

namespace kaustik::test {

/// A room of 4 × 3 × 2 m around the origin, from a corner of it.
inline std::string wall_room(const std::string& matter, int size) {
  return camera("1.8, -1.3, 0.5", "0, 0.1, -0.6", 60, size) +
         flat("cube", scale("2, 1.5, 1"), set("flip_normals", true) + matter);
}
/// A square lamp under the ceiling.
inline std::string ceiling_lamp(double x, double y, double half, double radiance) {
  return flat("rectangle",
              scale(fmt::format("{0}, {0}, 1", half)) + rotate("1, 0, 0", 180) +
                  translate(fmt::format("{}, {}, 0.99", x, y)),
              diffuse("0") + area_light(fmt::format("{}", radiance)));
}
inline std::string box(const std::string& center, const std::string& half,
                       const std::string& matter, double turned = 0) {
  return flat("cube", scale(half) + rotate("0, 0, 1", turned) + translate(center), matter);
}

/// Two rooms, of which the near one has a dim lamp of its own and a way round the wall to the
/// other.
inline std::string two_rooms(const std::string& wall, int size) {
  return wall_room(diffuse("0.7"), size) + wall + ceiling_lamp(-1, 0, 0.3, 40) +
         ceiling_lamp(1.2, 0.6, 0.1, 3);
}
inline std::string wall_of(double thickness) {
  return box("0, -0.3, 0", fmt::format("{}, 1.2, 1", thickness / 2), diffuse("0.7, 0.2, 0.1"));
}

/// By name, in `size` pixels.
inline std::vector<std::pair<std::string, std::string>> wall_scenes(int size) {
  const std::string white = diffuse("0.7"), red = diffuse("0.7, 0.2, 0.1"),
                    blue = diffuse("0.1, 0.3, 0.7");
  const std::string sheet =
      flat("rectangle", scale("1, 1.2, 1") + rotate("0, 1, 0", 90) + translate("0, -0.3, 0"),
           R"(<bsdf type="twosided">)" + red + "</bsdf>");
  const std::string door = box("0, -0.6, 0", "0.02, 0.9, 1", red) +
                           box("0.15, 0.8, -0.01", "0.02, 0.55, 0.985", blue, -20);
  std::string table = box("0, 0, -0.3", "0.5, 0.4, 0.02", blue);
  for (const double x : {-0.45, 0.45})
    for (const double y : {-0.35, 0.35})
      table += box(fmt::format("{}, {}, -0.66", x, y), "0.02, 0.02, 0.34", blue);
  const std::string furniture = table + box("-1.2, 0.8, -0.6", "0.3, 0.3, 0.4", red, 20) +
                                box("0.9, 0.9, -0.98", "0.4, 0.3, 0.02", red, 10);
  const std::string round =
      cylinder("-0.3, 0.3, -1", "-0.3, 0.3, 0.2", 0.15, red) + sphere("0.6, 0.5, -0.7", 0.3, blue);
  const std::string rough =
      sphere("-0.9, -0.6, -0.75", 0.25, ggx(0.15)) + sphere("0.3, 0.2, -0.7", 0.3, ggx(0.4));
  const auto room = [&](const std::string& objects) {
    return wall_room(white, size) + ceiling_lamp(-0.5, 0.3, 0.3, 20) + objects;
  };
  return {{"wall_1_mm", two_rooms(wall_of(0.001), size)},
          {"wall_1_cm", two_rooms(wall_of(0.01), size)},
          {"wall_20_cm", two_rooms(wall_of(0.2), size)},
          {"sheet", two_rooms(sheet, size)},
          {"door_ajar", wall_room(white, size) + ceiling_lamp(-1, 0, 0.3, 40) + door},
          {"furniture", room(furniture)},
          {"round_bodies", room(round)},
          {"rough_bodies", room(rough)}};
}

}  // namespace kaustik::test
