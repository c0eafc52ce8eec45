#include <fmt/format.h>

#include "kit/architecture.h"
#include "kit/furniture.h"
#include "kit/lamps.h"
#include "kit/sculpture.h"
#include "scenes/materials.h"
#include "scenes/paintings.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

struct Room {
  Vec3d low, high;
  double slab;                  ///< edge of the floor's slabs
  std::vector<double> beams_x;  ///< where beams cross the ceiling, along y
  std::vector<double> beams_y;  ///< and along x
};

void add_materials(SceneFolder& scene, const Vec3d& wall_color) {
  Materials m(scene);
  m.matt("wall", wall_color);
  m.matt("plaster", {0.80, 0.78, 0.74});
  m.matt("black", {0.03, 0.03, 0.03});
  m.glossy("light_marble", marble({0.82, 0.79, 0.74}, {0.34, 0.33, 0.32}, 0.5, 1), 0.16, 600);
  m.glossy("dark_marble", marble({0.10, 0.12, 0.11}, {0.62, 0.60, 0.56}, 0.4, 2), 0.16, 600);
  m.glossy("ceiling_marble", marble({0.78, 0.72, 0.63}, {0.36, 0.27, 0.20}, 0.8, 3), 0.08, 300);
  m.glossy("leather", {0.22, 0.08, 0.04}, 0.05, 30);
  m.glossy("enamel", {0.05, 0.05, 0.055}, 0.05, 60);
  m.glossy("porcelain", {0.20, 0.30, 0.42}, 0.10, 300);
  m.metal("brass", "CuZn", 0.12);
  m.metal("gold", "Au", 0.25);
  m.cloth("shade", {0.42, 0.38, 0.30}, {0.46, 0.38, 0.26});
}

void add_room(SceneFolder& scene, const Room& room) {
  const PlyLayout flat{.normals = Normals::flat};
  const Vec3d &low = room.low, &high = room.high;
  const RoomShell shell = room_shell(low, high, 0.3);
  scene.add_mesh("walls", merged({shell.west, shell.east, shell.south, shell.north}), "wall", flat,
                 fmt::format("The room: {:g} m x {:g} m, {:g} m high, closed on all sides.",
                             high.x - low.x, high.y - low.y, high.z));
  scene.add_mesh("ceiling", shell.ceiling, "ceiling_marble", flat);
  scene.add_mesh("base", moved(shell.floor, {0, 0, -0.01}), "dark_marble", flat);
  const Vec2d l(low.x, low.y), h(high.x, high.y);
  const std::vector<Mesh> slabs = chequered_floor(l, h, room.slab);
  scene.add_mesh("light_slabs", slabs[0], "light_marble", flat, "The marble floor.");
  scene.add_mesh("dark_slabs", slabs[1], "dark_marble", flat);
  Mesh beams;
  constexpr double half = 0.09, depth = 0.16;
  for (const double x : room.beams_x)
    beams.append(
        bevelled_box({x - half, low.y, high.z - depth}, {x + half, high.y, high.z + 0.05}, 0.01));
  for (const double y : room.beams_y)
    beams.append(bevelled_box({low.x, y - half, high.z - 0.85 * depth},
                              {high.x, y + half, high.z + 0.05}, 0.01));
  beams.append(moulding_around(cornice_outline(0.18), l, h, high.z));
  beams.append(moulding_around(skirting_outline(0.16, 0.022), l, h, 0));
  scene.add_mesh("mouldings", beams, "plaster", {}, "Beams, cornice and skirting.");
}

void add_lamps(SceneFolder& scene, const std::vector<ShadedLamp>& lamps, double watts) {
  Mesh metal, shades;
  for (const ShadedLamp& lamp : lamps) {
    metal.append(lamp.metal);
    shades.append(lamp.shade);
  }
  scene.add_mesh("lamps", metal, "brass", {},
                 fmt::format("Lamps of {:g} W ({:.0f} lm) behind shades of cloth.", watts,
                             watts * luminous_efficacy));
  scene.add_mesh("shades", shades, "shade");
  for (const ShadedLamp& lamp : lamps)
    scene.add(glowing_ball(lamp.bulb, lamp.bulb_radius, watts, warm_white));
}

void add_bench(SceneFolder& scene, const Vec3d& at, double degrees, double length) {
  const Bench b = bench(length, 0.5, 0.45);
  const auto placed = [&](const Mesh& mesh) { return moved(turned(mesh, {0, 0, 1}, degrees), at); };
  scene.add_mesh("bench_seat", placed(b.seat), "leather", {}, "A bench.");
  scene.add_mesh("bench_legs", placed(b.legs), "enamel");
}

/// Puts the foot of a leaning picture where its top touches the wall behind `wall_point`.
Painting leaning(Painting p) {
  const double a = p.turn * pi_d / 180, distance = foot_of_leaning(p);
  p.center += Vec3d(std::sin(a), -std::cos(a), 0) * distance;
  return p;
}

std::string title(const char* what, const char* figure) {
  return fmt::format(
      "{} After figure {} of R. Schregle, \"Rendering with Photon Maps\" (1998). "
      "Lengths in metres, z is up.",
      what, figure);
}

}  // namespace

SceneFolder make_gallery_1(const SceneOptions& options) {
  SceneFolder scene(
      "gallery_1",
      title("A closed gallery, lit through lampshades, with a marble floor and ceiling.", "8.5"));
  scene.add_view({.origin = {2.75, -2.5, 1.5},
                  .target = {-0.55, 1.2, 1.28},
                  .fov = 70,
                  .width = 800,
                  .height = 600});
  add_materials(scene, {0.30, 0.40, 0.36});
  const Vec3d low(-3.6, -3.0, 0), high(3.4, 2.8, 3.2);
  add_room(scene, {low, high, 0.58, {-1.3, 1.1}, {-1.1, 0.85}});
  constexpr double skirting = 0.03;  // what leans touches the skirting's front
  add_paintings(
      scene,
      {{"mountain_lake", mountain_lake, 1.5, 1.0, {-1.45, high.y - 0.002, 1.62}, 0},
       {"color_fields", color_fields, 0.9, 1.2, {0.75, high.y - 0.002, 1.65}, 0},
       {"seascape", seascape_at_dusk, 1.35, 0.9, {low.x + 0.002, 1.35, 1.62}, 90},
       {"composition", geometric_composition, 0.95, 0.95, {low.x + 0.002, -0.85, 1.62}, 90},
       leaning({"still_life", still_life, 1.2, 0.9, {2.25, high.y - skirting, 0}, 0, 14}),
       leaning({"ridge", mountain_lake, 0.75, 1.0, {low.x + skirting, 0.2, 0}, 90, 12})},
      options.seed + 1);
  add_lamps(
      scene,
      {pendant_lamp({-1.9, -0.1, high.z}, 0.85, 0.30),
       pendant_lamp({0.0, -0.1, high.z}, 0.85, 0.30), pendant_lamp({1.9, -0.1, high.z}, 0.85, 0.30),
       floor_lamp({-3.05, 2.2, 0}, 1.62, 0.24)},
      60);
  add_bench(scene, {-0.25, 0.15, 0}, 0, 1.7);
  scene.add_mesh("vase", moved(scaled(amphora(0.75), {1, 1, 1}), {1.45, 2.35, 0}), "porcelain", {},
                 "A vase.");
  return scene;
}

SceneFolder make_gallery_2(const SceneOptions& options) {
  SceneFolder scene(
      "gallery_2",
      title("A long closed gallery with two rows of lampshades and columns of marble.", "8.6"));
  scene.add_view({.origin = {-0.75, -5.6, 1.55},
                  .target = {0.25, 2.0, 1.45},
                  .fov = 64,
                  .width = 800,
                  .height = 600});
  add_materials(scene, {0.46, 0.13, 0.10});
  const Vec3d low(-2.9, -6, 0), high(2.9, 6, 3.6);
  add_room(scene, {low, high, 0.725, {}, {-4.2, -1.4, 1.4, 4.2}});
  constexpr double skirting = 0.03;
  add_paintings(
      scene,
      {{"triptych", seascape_at_dusk, 2.1, 1.4, {0, high.y - 0.002, 1.85}, 0},
       {"mountain_lake", mountain_lake, 1.5, 1.0, {low.x + 0.002, 0, 1.75}, 90},
       {"color_fields", color_fields, 1.0, 1.35, {low.x + 0.002, -2.8, 1.75}, 90},
       {"still_life", still_life, 1.2, 0.9, {high.x - 0.002, 0, 1.75}, -90},
       {"composition", geometric_composition, 1.2, 1.2, {high.x - 0.002, -2.8, 1.75}, -90},
       {"colours", color_fields, 1.2, 1.2, {high.x - 0.002, 2.8, 1.75}, -90},
       leaning({"abandoned", geometric_composition, 0.9, 1.2, {low.x + skirting, 2.75, 0}, 90, 13}),
       leaning({"coast", seascape_at_dusk, 1.0, 0.75, {high.x - skirting, -1.45, 0}, -90, 15})},
      options.seed + 5);
  std::vector<ShadedLamp> lamps;
  for (const double y : {-2.8, 0.0, 2.8})
    for (const double x : {-1.35, 1.35}) lamps.push_back(pendant_lamp({x, y, high.z}, 1.0, 0.26));
  lamps.push_back(floor_lamp({-2.2, 5.3, 0}, 1.7, 0.26));
  lamps.push_back(floor_lamp({2.2, 5.3, 0}, 1.7, 0.26));
  add_lamps(scene, lamps, 45);
  add_bench(scene, {0.1, -0.6, 0}, 90, 1.8);
  Mesh columns;
  const Mesh column = revolved({{0, 0},
                                {0.24, 0},
                                {0.24, 0.10},
                                {0.22, 0.13},
                                {0.20, 0.17},
                                {0.175, 0.20},
                                {0.165, 0.9},
                                {0.145, 3.15},
                                {0.165, 3.19},
                                {0.19, 3.24},
                                {0.22, 3.30},
                                {0.22, high.z - 0.1},
                                {0, high.z - 0.1}},
                               28);
  for (const double y : {-4.2, -1.4, 1.4, 4.2})
    for (const double x : {low.x + 0.26, high.x - 0.26}) columns.append(moved(column, {x, y, 0}));
  scene.add_mesh("columns", columns, "light_marble", {}, "Columns along the walls.");
  scene.add_mesh("vase", moved(amphora(0.85), {0.0, 5.45, 0}), "porcelain", {}, "A vase.");
  return scene;
}

}  // namespace kaustik::scenes
