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

// The hall, and the cabinet behind the doorway in its north wall.
const Vec3d low(-5, -5.5, 0), high(5, 5, 4.4);
const Vec3d cabinet_low(1.2, 5.4, 0), cabinet_high(5, 8.4, 3.4);
constexpr double wall = 0.4;
const Opening north_window{0.7, 0.9, 2.6, 2.9}, doorway{7.0, 0, 1.7, 2.6};
const Opening west_window{6.6, 0.9, 2.9, 2.9};  // measured along the wall from the south
const Vec3d statue_at(-1.75, 1.55, 0);
constexpr double statue_base = 0.72, statue_scale = 1.22;

struct Exhibit {
  Vec3d at;       ///< foot of its pedestal
  double height;  ///< of the pedestal
  double width;
};
const Exhibit shell_place{{-3.75, -0.6, 0}, 1.0, 0.44};
const Exhibit knot_place{{1.15, 0.35, 0}, 0.95, 0.50};
const Exhibit idol_place{{0.05, 4.1, 0}, 1.15, 0.38};
const Exhibit amphora_place{{3.95, 1.9, 0}, 0.85, 0.46};
const Exhibit cluster_place{{-2.55, -2.5, 0}, 0.90, 0.44};
const Exhibit bowl_place{{3.1, 7.7, 0}, 1.0, 0.46};

void add_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("wall", {0.72, 0.69, 0.61});
  m.matt("cabinet_wall", {0.42, 0.52, 0.50});
  m.matt("white", {0.82, 0.81, 0.79});
  m.matt("plaster", {0.76, 0.74, 0.70});
  m.matt("black", {0.03, 0.03, 0.03});
  m.matt("rope", {0.38, 0.03, 0.04});
  m.glossy("enamel", {0.07, 0.07, 0.075}, 0.05, 60);
  m.glossy("leather", {0.15, 0.055, 0.03}, 0.05, 30);
  m.glossy("marble", {0.72, 0.70, 0.67}, 0.05, 100);
  m.glossy("amethyst", {0.30, 0.13, 0.42}, 0.10, 200);
  m.glossy("pearl", {0.70, 0.60, 0.50}, 0.10, 60);
  m.glossy("terracotta", {0.52, 0.22, 0.11}, 0.04, 40);
  m.glossy("limestone", {0.60, 0.55, 0.46}, 0.02, 20);
  m.wood("board", {0.31, 0.175, 0.09}, 4, 0.05, 90);
  m.metal("bronze", "Cu", 0.16);
  m.metal("brass", "CuZn", 0.10);
  m.metal("gold", "Au", 0.22);
}

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
  const std::vector<Mesh> boards = board_floor(floor_low, floor_high, 2.3, 0.155, 4, 7);
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

const std::vector<Painting> paintings = {
    {"mountain_lake", mountain_lake, 1.5, 1.0, {-0.35, 4.99, 1.95}, 0},
    {"color_fields", color_fields, 1.05, 1.4, {-4.99, -1.25, 1.9}, 90},
    {"seascape", seascape_at_dusk, 1.5, 1.0, {-4.99, -3.35, 1.9}, 90},
    {"composition", geometric_composition, 1.2, 1.2, {4.99, 3.35, 1.9}, -90},
    {"still_life", still_life, 1.0, 0.75, {3.1, 8.39, 1.9}, 0},
};

void add_exhibits(SceneFolder& scene, uint64_t seed) {
  Mesh pedestals;
  const auto on = [&](const Exhibit& e, const Mesh& mesh, double degrees = 0) {
    pedestals.append(moved(pedestal(e.width, e.height), e.at));
    return moved(turned(mesh, {0, 0, 1}, degrees), e.at + Vec3d(0, 0, e.height));
  };
  const PlyLayout smooth{.normals = Normals::smooth};
  Mesh statue = scaled(turned(dancer(0.015), {0, 0, 1}, 38), Vec3d(statue_scale));
  scene.add_mesh("statue", moved(statue, statue_at + Vec3d(0, 0, statue_base)), "bronze", smooth,
                 "A bronze dancer.");
  pedestals.append(moved(pedestal(1.15, statue_base), statue_at));
  scene.add_mesh("shell", on(shell_place, snail_shell(0.5), 60), "pearl", {}, "Exhibits.");
  scene.add_mesh("knot", on(knot_place, knot(0.72), -20), "marble", smooth);
  scene.add_mesh("idol", on(idol_place, idol_head(0.58, 0.014), 25), "limestone", smooth);
  scene.add_mesh("amphora", on(amphora_place, amphora(0.85), -50), "terracotta");
  scene.add_mesh("crystals", on(cluster_place, crystal_cluster(0.42, 16, seed), 10), "amethyst",
                 {.normals = Normals::flat});
  scene.add_mesh("bowl", on(bowl_place, bowl(0.24)), "brass");
  scene.add_mesh("pedestals", pedestals, "plaster");
}

/// Posts with a sagging rope in front of the statue.
void add_barrier(SceneFolder& scene) {
  const Vec3d posts[] = {{-0.35, 2.55, 0}, {-0.55, 0.35, 0}, {-2.95, 0.15, 0}};
  Mesh brass, rope;
  const Mesh post = revolved({{0, 0},
                              {0.15, 0},
                              {0.15, 0.012},
                              {0.05, 0.03},
                              {0.018, 0.05},
                              {0.018, 0.86},
                              {0.03, 0.875},
                              {0.03, 0.90},
                              {0.018, 0.915},
                              {0.034, 0.945},
                              {0.022, 0.975},
                              {0, 0.98}},
                             24);
  for (const Vec3d& at : posts) brass.append(moved(post, at));
  for (int i = 0; i < 2; ++i) {
    Path path;
    for (int s = 0; s <= 16; ++s) {
      const double t = s / 16.0;
      path.push_back(posts[i] + (posts[i + 1] - posts[i]) * t +
                     Vec3d(0, 0, 0.885 - 0.27 * 4 * t * (1 - t)));
    }
    SweepOptions round;
    round.crease_degrees = 60;
    rope.append(tube(0.017, path, 10, round));
  }
  scene.add_mesh("posts", brass, "brass", {}, "A barrier before the statue.");
  scene.add_mesh("rope", rope, "rope");
}

void add_bench(SceneFolder& scene) {
  const Bench b = bench(1.9, 0.55, 0.45);
  const auto placed = [](const Mesh& mesh) {
    return moved(turned(mesh, {0, 0, 1}, 24), {0.75, -2.35, 0});
  };
  scene.add_mesh("bench_seat", placed(b.seat), "leather", {}, "A bench.");
  scene.add_mesh("bench_legs", placed(b.legs), "enamel");
}

void add_exhibit_lamps(SceneFolder& scene) {
  Mesh bodies;
  std::vector<std::pair<CanSpot, double>> lamps;
  const auto aim = [&](const Vec3d& mount, const Vec3d& target, double watts) {
    lamps.emplace_back(can_spot(mount, target), watts);
    bodies.append(lamps.back().first.body);
  };
  const auto above = [&](const Exhibit& e, const Vec2d& offset, double watts) {
    aim({e.at.x + offset.x, e.at.y + offset.y, high.z}, e.at + Vec3d(0, 0, e.height + 0.25), watts);
  };
  aim({-2.9, -0.9, high.z}, statue_at + Vec3d(0, 0, 2.1), 40);
  aim({0.2, 0.2, high.z}, statue_at + Vec3d(0, 0, 1.9), 40);
  above(shell_place, {1.0, -0.9}, 35);
  above(knot_place, {0.9, -1.1}, 35);
  above(idol_place, {0.3, -1.5}, 35);
  above(amphora_place, {-1.2, -0.9}, 35);
  above(cluster_place, {1.1, -0.5}, 35);
  for (const Painting& p : paintings) {
    if (p.center.y > high.y) continue;
    const double a = p.turn * pi_d / 180;
    const Vec3d away(std::sin(a), -std::cos(a), 0);  // of the wall
    aim(Vec3d(p.center.x, p.center.y, high.z) + away * 1.5, p.center, 35);
  }
  scene.add_mesh("spotlights", bodies, "enamel", {}, "Small lamps, each on its exhibit.");
  for (const auto& [lamp, watts] : lamps) scene.add(glowing_disk(lamp, watts, warm_white));
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

/// Sky and sun are brought close to the windows, so that no photon misses them: the sky is two
/// luminous planes, behind the north window and rising from below the west window as steeply as the
/// sun does, which shines over it; the sun is a spotlight far away whose beam is as wide as the
/// window.
void add_daylight(SceneFolder& scene) {
  constexpr double sky_luminance = 2500, sun_illuminance = 60000, distance = 120;
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
                .said("The sky behind the windows, 2500 cd/m2."));
  const Vec3d window(low.x - 0.5 * wall, low.y + west_window.x + 0.5 * west_window.width,
                     west_window.z + 0.5 * west_window.height);
  constexpr double slope = 29.5, length = 11;
  const double c = std::cos(slope * pi_d / 180), s = std::sin(slope * pi_d / 180);
  const Vec3d foot(low.x - wall - 0.05, window.y + 2.5, west_window.z - 0.25);
  scene.add(plane(foot + Vec3d(-c, 0, s) * (0.5 * length), {length, 18}, {0, 1, 0}, slope));
  const Vec3d travels = Vec3d(0.62, -0.25, -0.418).normalized();
  constexpr double half_angle = 1.15;
  Xml sun = object("emitter", "spot");
  sun.add(rgb("intensity", lamp_intensity(sun_illuminance / luminous_efficacy * distance * distance,
                                          1, evening_sun)));
  sun.add(number("cutoff_angle", half_angle));
  sun.add(number("beam_width", 0.98 * half_angle));
  sun.add(transform({look_at(window - travels * distance, window)}));
  scene.add(
      std::move(sun).said("The sun, 60 klx at the window: a spotlight 120 m away whose beam is as "
                          "wide as the window."));
}

}  // namespace

SceneFolder make_museum(const SceneOptions& options) {
  SceneFolder scene(
      "museum",
      "A museum's hall: small lamps on the exhibits, planar lights below the ceiling, "
      "the evening sun through the windows of the corner. After figure 8.4 of R. "
      "Schregle, \"Rendering with Photon Maps\" (1998). Lengths in metres, z is up.");
  scene.add_view({.origin = {3.5, -4.9, 1.65}, .target = {-0.75, 1.6, 1.6}, .fov = 66});
  scene.add(object("integrator", "photonmap"));
  add_materials(scene);
  add_hall(scene);
  add_joinery(scene);
  add_cabinet(scene);
  add_paintings(scene, paintings, options.seed);
  add_exhibits(scene, options.seed);
  add_barrier(scene);
  add_bench(scene);
  add_exhibit_lamps(scene);
  add_ceiling_lights(scene);
  add_daylight(scene);
  return scene;
}

}  // namespace kaustik::scenes
