#include "kit/furniture.h"
#include "kit/lamps.h"
#include "kit/sculpture.h"
#include "scenes/materials.h"
#include "scenes/museum_hall.h"
#include "scenes/paintings.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

using namespace museum;

const Vec3d statue_at(-1.75, 1.55, 0);
constexpr double statue_base = 0.72, statue_scale = 1.22;

struct Exhibit {
  Vec3d at;       ///< foot of its pedestal
  double height;  ///< of the pedestal
  double width;
};
const Exhibit shell_place{{-3.75, -0.6, 0}, 1.0, 0.44};
const Exhibit knot_place{{1.15, 0.35, 0}, 0.95, 0.50};
const Exhibit idol_place{{0.95, 4.3, 0}, 1.15, 0.38};
const Exhibit amphora_place{{2.6, 2.6, 0}, 0.85, 0.46};
const Exhibit cluster_place{{-1.75, -1.95, 0}, 0.90, 0.44};
const Exhibit bowl_place{{3.1, 7.7, 0}, 1.0, 0.46};

void add_museum_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("wall", {0.72, 0.69, 0.61});
  m.matt("cabinet_wall", {0.42, 0.52, 0.50});
  m.matt("white", {0.82, 0.81, 0.79});
  m.matt("plaster", {0.76, 0.74, 0.70});
  m.matt("black", {0.03, 0.03, 0.03});
  m.matt("rope", {0.38, 0.03, 0.04});
  m.glossy("enamel", {0.07, 0.07, 0.075}, 0.05, 60);
  m.glossy("leather", {0.30, 0.10, 0.05}, 0.05, 30);
  m.glossy("marble", marble({0.82, 0.80, 0.77}, {0.30, 0.29, 0.30}, 0.25, 3), 0.06, 200);
  m.glossy("amethyst", {0.30, 0.13, 0.42}, 0.10, 200);
  m.glossy("pearl", {0.70, 0.60, 0.50}, 0.10, 60);
  m.glossy("terracotta", {0.52, 0.22, 0.11}, 0.04, 40);
  m.glossy("limestone", {0.60, 0.55, 0.46}, 0.02, 20);
  m.boards("board", floor_wood, 0.05, 90);
  m.metal("bronze", "Cu", 0.16);
  m.metal("brass", "CuZn", 0.10);
  m.metal("gold", "Au", 0.22);
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
  aim({-2.9, -0.9, high.z}, statue_at + Vec3d(0, 0, 2.1), 100);
  aim({0.2, 0.2, high.z}, statue_at + Vec3d(0, 0, 1.9), 100);
  above(shell_place, {1.0, -0.9}, 80);
  above(knot_place, {0.9, -1.1}, 80);
  above(idol_place, {0.3, -1.5}, 80);
  above(amphora_place, {-1.2, -0.9}, 80);
  above(cluster_place, {1.1, -0.5}, 80);
  for (const Painting& p : paintings) {
    if (p.center.y > high.y) continue;
    const double a = p.turn * pi_d / 180;
    const Vec3d away(std::sin(a), -std::cos(a), 0);  // of the wall
    aim(Vec3d(p.center.x, p.center.y, high.z) + away * 1.5, p.center, 80);
  }
  scene.add_mesh("spotlights", bodies, "enamel", {}, "Small lamps, each on its exhibit.");
  for (const auto& [lamp, watts] : lamps) scene.add(glowing_disk(lamp, watts, warm_white));
}

}  // namespace

SceneFolder make_museum(const SceneOptions& options) {
  SceneFolder scene(
      "museum",
      "A museum's hall: small lamps on the exhibits, planar lights below the ceiling, "
      "the evening sun through the windows of the corner. After figure 8.4 of R. "
      "Schregle, \"Rendering with Photon Maps\" (1998). Lengths in metres, z is up.");
  scene.add_view({.origin = {3.5, -4.9, 1.65}, .target = {-0.75, 1.6, 1.6}, .fov = 66});
  add_museum_materials(scene);
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
