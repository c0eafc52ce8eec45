#include "scenes/museum_hall.h"

#include <fmt/format.h>

#include "kit/lamps.h"

namespace kaustik::scenes::museum {
namespace {

constexpr double wall = 0.4;
const Opening north_window{0.7, 0.9, 2.6, 2.9}, doorway{7.0, 0, 1.7, 2.6};
const Opening west_window{6.6, 0.9, 2.9, 2.9};  // measured along the wall from the south

}  // namespace

void add_hall(SceneFolder& scene) {
  const PlyLayout flat{.normals = Normals::flat};
  const double length = high.x - low.x, depth = high.y - low.y, height = high.z;
  Mesh walls =
      moved(wall_with_openings(length, height, wall, {north_window, doorway}), {low.x, high.y, 0});
  // The west wall runs north; its inner face is turned to the east.
  walls.append(moved(turned(wall_with_openings(depth, height, wall, {west_window}), {0, 0, 1}, 90),
                     {low.x, low.y, 0}));
  walls.append(box({low.x - wall, high.y, 0}, {low.x, high.y + wall, height}));  // the corner
  walls.append(box({high.x, low.y - wall, 0}, {high.x + wall, high.y + wall, height}));
  walls.append(box({low.x - wall, low.y - wall, 0}, {high.x, low.y, height}));
  scene.add_mesh("walls", walls, "wall", flat, "The hall: 10 m x 10.5 m, 4.4 m high.");
  scene.add_mesh(
      "ceiling",
      box({low.x - wall, low.y - wall, height}, {high.x + wall, high.y + wall, height + 0.3}),
      "white", flat);
  scene.add_mesh(
      "base",
      box({low.x - wall, low.y - wall, -0.3}, {high.x + wall, cabinet_high.y + wall, -0.02}),
      "board_0", flat);
  const Vec2d floor_low(low.x, low.y), floor_high(high.x, cabinet_high.y);
  const std::vector<Mesh> boards = board_floor(floor_low, floor_high, 2.3, board_width, 4, 7);
  for (size_t i = 0; i < boards.size(); ++i)
    scene.add_mesh(fmt::format("boards_{}", i), boards[i], fmt::format("board_{}", i), flat,
                   i == 0 ? "The floor's boards, in four tones of brown." : "");
}

/// Casings of windows and doorway, skirting, cornice and picture rail.
void add_joinery(SceneFolder& scene) {
  Mesh bars = moved(window_bars(north_window.width, north_window.height, 3, 4, 0.06),
                    {low.x + north_window.x, high.y + 0.22, north_window.z});
  bars.append(
      moved(turned(window_bars(west_window.width, west_window.height, 3, 4, 0.06), {0, 0, 1}, 90),
            {low.x - 0.22, low.y + west_window.x, west_window.z}));
  scene.add_mesh("window_bars", bars, "white", {.normals = Normals::flat},
                 "Windows without panes: bars only.");
  // Boards under the windows.
  Mesh sills = bevelled_box(
      {low.x + north_window.x - 0.1, high.y - 0.08, north_window.z - 0.04},
      {low.x + north_window.x + north_window.width + 0.1, high.y + 0.3, north_window.z + 0.01},
      0.008);
  sills.append(bevelled_box(
      {low.x - 0.3, low.y + west_window.x - 0.1, west_window.z - 0.04},
      {low.x + 0.08, low.y + west_window.x + west_window.width + 0.1, west_window.z + 0.01},
      0.008));
  scene.add_mesh("sills", sills, "white");
  const Vec2d l(low.x, low.y), h(high.x, high.y);
  Mesh mouldings = moulding_around(cornice_outline(0.22), l, h, high.z);
  const double door = low.x + doorway.x;
  // The skirting stops at the doorway: walked from its right side round to its left.
  mouldings.append(swept(skirting_outline(0.20, 0.025),
                         {{door + doorway.width + 0.12, h.y, 0},
                          {h.x, h.y, 0},
                          {h.x, l.y, 0},
                          {l.x, l.y, 0},
                          {l.x, h.y, 0},
                          {door - 0.12, h.y, 0}},
                         {0, 0, 1}));
  const Curve casing = {{0, 0}, {0.14, 0}, {0.14, 0.03}, {0.10, 0.045}, {0.03, 0.035}, {0, 0.02}};
  mouldings.append(swept(casing,
                         {{door, h.y, 0},
                          {door, h.y, doorway.height},
                          {door + doorway.width, h.y, doorway.height},
                          {door + doorway.width, h.y, 0}},
                         {0, -1, 0}));
  scene.add_mesh("mouldings", mouldings, "white");
}

void add_cabinet(SceneFolder& scene) {
  const RoomShell shell = room_shell(cabinet_low, cabinet_high, 0.2);
  const PlyLayout flat{.normals = Normals::flat};
  scene.add_mesh("cabinet_walls", merged({shell.west, shell.east, shell.north}), "cabinet_wall",
                 flat, "The cabinet behind the doorway.");
  scene.add_mesh("cabinet_ceiling",
                 box({0.8, cabinet_low.y, cabinet_high.z}, {5.4, 8.6, cabinet_high.z + 0.2}),
                 "white", flat);
}

void add_ceiling_lights(SceneFolder& scene) {
  const Vec2d size(1.5, 0.6);
  Mesh bodies;
  std::vector<Vec3d> centers;
  for (const double x : {-2.6, 0.4, 3.4})
    for (const double y : {-3.6, -0.4, 2.8}) centers.emplace_back(x, y, high.z - 0.42);
  for (const Vec3d& c : centers) {
    bodies.append(moved(bevelled_box({-0.5 * size.x - 0.02, -0.5 * size.y - 0.02, 0},
                                     {0.5 * size.x + 0.02, 0.5 * size.y + 0.02, 0.07}, 0.008),
                        c));
    for (const double side : {-1.0, 1.0})
      bodies.append(moved(cylinder(0.004, 0.06, 0.42, 6), c + Vec3d(side * 0.5 * size.x, 0, 0)));
  }
  scene.add_mesh("ceiling_lights", bodies, "white", {},
                 "Planar lights that hang below the ceiling and shine down, 40 W (7200 lm) each.");
  for (const Vec3d& c : centers)
    scene.add(glowing_rectangle(c - Vec3d(0, 0, 0.001), size, 40, neutral_white));
  scene.add(glowing_rectangle({3.1, 6.9, cabinet_high.z - 0.001}, {1.2, 0.4}, 70, neutral_white)
                .said("The cabinet's lamp."));
}

/// Sky and sun are brought close to the windows, so that no photon misses them. The sky is luminous
/// planes: one behind the north window, two that rise from below the west window a little less
/// steeply than the sun stands, so that it shines over them. The sun is a spotlight far away whose
/// beam is as wide as the window.
void add_daylight(SceneFolder& scene) {
  constexpr double sky_luminance = 1500, sun_illuminance = 45000, distance = 120;
  const Vec3d sky = lamp_intensity(sky_luminance / luminous_efficacy, 1, sky_blue);
  const auto plane = [&](const Vec3d& center, const Vec2d& size, const Vec3d& axis,
                         double degrees) {
    Xml shape = object("shape", "rectangle");
    shape.add(transform(
        {scale({0.5 * size.x, 0.5 * size.y, 1}), rotate(axis, degrees), translate(center)}));
    shape.add(ref("black"));
    shape.add(object("emitter", "area", {rgb("radiance", sky)}));
    return shape;
  };
  const double north_x = low.x + north_window.x + 0.5 * north_window.width;
  scene.add(plane({north_x - 0.8, high.y + 0.9, 2.4}, {5.2, 4.6}, {1, 0, 0}, 90)
                .said("The sky behind the windows, 1500 cd/m2."));
  const Vec3d window(low.x - 0.5 * wall, low.y + west_window.x + 0.5 * west_window.width,
                     west_window.z + 0.5 * west_window.height);
  constexpr double slope = 37.5, length = 3.9;
  const Vec3d rise(-std::cos(slope * pi_d / 180), 0, std::sin(slope * pi_d / 180));
  const Vec3d foot(low.x - wall - 0.05, window.y, west_window.z - 0.25);
  // Two parts, shifted to the north as the view through the window goes.
  scene.add(plane(foot + rise * (0.5 * length) + Vec3d(0, 1.2, 0), {length, 9}, {0, 1, 0}, slope));
  scene.add(plane(foot + rise * (1.5 * length) + Vec3d(0, 4.2, 0), {length, 9}, {0, 1, 0}, slope));
  const Vec3d travels = Vec3d(0.62, -0.27, -0.57).normalized();
  constexpr double half_angle = 1.15;
  Xml sun = object("emitter", "spot");
  sun.add(rgb("intensity", lamp_intensity(sun_illuminance / luminous_efficacy * distance * distance,
                                          1, evening_sun)));
  sun.add(number("cutoff_angle", half_angle));
  sun.add(number("beam_width", 0.98 * half_angle));
  sun.add(transform({look_at(window - travels * distance, window)}));
  scene.add(
      std::move(sun).said("The sun, 45 klx at the window: a spotlight 120 m away whose beam is as "
                          "wide as the window."));
}

}  // namespace kaustik::scenes::museum
