#include "kit/maze.h"

#include <fmt/format.h>

#include "kit/architecture.h"
#include "kit/lamps.h"
#include "kit/random.h"
#include "scenes/materials.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

constexpr double cell = 1.3, thickness = 0.20, wall_height = 1.15, post_width = 0.30;

void add_maze_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("wall", masonry({0.76, 0.66, 0.52}, {0.46, 0.41, 0.34}, {0.325, 0.18}, 0.010, 0.5, 0.28));
  m.matt("stone", {0.62, 0.58, 0.52});
  for (int i = 0; i < 2; ++i)
    m.matt(fmt::format("paving_{}", i),
           masonry(Vec3d(0.54, 0.37, 0.27) * (1 - 0.14 * i), {0.25, 0.22, 0.19}, {0.1625, 0.1625},
                   0.006, 0, 0.25));
  m.matt("lawn", {0.09, 0.17, 0.05});
  m.matt("black", {0.03, 0.03, 0.03});
  m.glossy("iron", {0.045, 0.05, 0.05}, 0.05, 40);
  m.metal("gold", "Au", 0.12);
}

/// One segment of wall along x about the origin, with its coping, between two posts.
struct Segment {
  Mesh wall, coping;
};

Segment segment() {
  const double half = 0.5 * (cell - post_width) + 0.01;
  Segment s;
  s.wall = box({-half, -0.5 * thickness, -0.05}, {half, 0.5 * thickness, wall_height - 0.07});
  const double w = 0.5 * thickness + 0.04, z = wall_height - 0.08;
  const Curve outline = {
      {-w, z},       {w, z}, {w, z + 0.05}, {0.2 * w, wall_height}, {-0.2 * w, wall_height},
      {-w, z + 0.05}};
  s.coping = swept(outline, {{-half, 0, 0}, {half, 0, 0}}, {0, 0, 1});
  return s;
}

Mesh post() {
  const double h = 0.5 * post_width, top = wall_height + 0.10;
  Mesh mesh = box({-h, -h, -0.05}, {h, h, top});
  const double w = h + 0.04;
  mesh.append(box({-w, -w, top - 0.02}, {w, w, top + 0.04}));
  mesh.append(turned(scaled(cone(w, 0, top + 0.04, top + 0.20, 4), {1, 1, 1}), {0, 0, 1}, 45));
  return mesh;
}

/// Walls of a maze whose middle is the origin.
void add_walls(SceneFolder& scene, const Maze& maze) {
  const Segment along_x = segment();
  const Segment along_y{turned(along_x.wall, {0, 0, 1}, 90), turned(along_x.coping, {0, 0, 1}, 90)};
  const Mesh one_post = post();
  Mesh walls, stones;
  const double start = -0.5 * maze.size() * cell;
  const auto put = [&](const Segment& s, double x, double y) {
    walls.append(moved(s.wall, {start + x * cell, start + y * cell, 0}));
    stones.append(moved(s.coping, {start + x * cell, start + y * cell, 0}));
  };
  for (int y = 0; y < maze.size(); ++y)
    for (int x = 0; x < maze.size(); ++x) {
      if (maze.wall_east(x, y)) put(along_y, x + 1, y + 0.5);
      if (maze.wall_north(x, y)) put(along_x, x + 0.5, y + 1);
    }
  for (int i = 0; i < maze.size(); ++i) {
    put(along_y, 0, i + 0.5);
    if (i > 0) put(along_x, i + 0.5, 0);  // the entrance is at the corner
  }
  for (int y = 0; y <= maze.size(); ++y)
    for (int x = 0; x <= maze.size(); ++x)
      stones.append(moved(one_post, {start + x * cell, start + y * cell, 0}));
  const PlyLayout flat{.normals = Normals::flat};
  scene.add_mesh("walls", walls, "wall", flat,
                 fmt::format("Walls, coping and posts of {0} x {0} cells.", maze.size()));
  scene.add_mesh("stones", stones, "stone", flat);
}

/// A low lamp with a hood: it shines along the ways and hardly upward.
Mesh bollard() {
  Mesh lamp = revolved({{0, 0},
                        {0.09, 0},
                        {0.09, 0.02},
                        {0.035, 0.05},
                        {0.03, 0.46},
                        {0.05, 0.48},
                        {0.05, 0.50},
                        {0, 0.50}},
                       16);
  lamp.append(revolved({{0, 0.67}, {0.15, 0.64}, {0.16, 0.65}, {0.03, 0.72}, {0, 0.73}}, 16));
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * pi_d * i / 3;
    lamp.append(tube(0.006,
                     {{0.045 * std::cos(a), 0.045 * std::sin(a), 0.49},
                      {0.12 * std::cos(a), 0.12 * std::sin(a), 0.658}},
                     6));
  }
  return lamp;
}

void add_lamps(SceneFolder& scene, const Maze& maze, uint64_t seed) {
  Random random(seed);
  const double start = -0.5 * maze.size() * cell;
  const int spacing = 3;  // one lamp in a field of 3 x 3 cells, in a corner of its cell
  Mesh bodies;
  std::vector<Vec3d> bulbs;
  for (int j = 0; j < maze.size(); j += spacing)
    for (int i = 0; i < maze.size(); i += spacing) {
      const int x = std::min(maze.size() - 1, i + int(random.index(spacing)));
      const int y = std::min(maze.size() - 1, j + int(random.index(spacing)));
      const double off = 0.5 * cell - 0.5 * thickness - 0.22;
      // One after the other: the order in which arguments are evaluated is the compiler's.
      const double off_y = random.next() < 0.5 ? -off : off;
      const double off_x = random.next() < 0.5 ? -off : off;
      const Vec3d at(start + (x + 0.5) * cell + off_x, start + (y + 0.5) * cell + off_y, 0);
      bodies.append(moved(bollard(), at));
      bulbs.push_back(at + Vec3d(0, 0, 0.571));
    }
  for (const double side : {-1.0, 1.0}) {  // by the entrance
    const Vec3d at(start + 0.5 * cell + side * 1.0, start - 0.45, 0);
    bodies.append(moved(bollard(), at));
    bulbs.push_back(at + Vec3d(0, 0, 0.571));
  }
  scene.add_mesh("lamps", bodies, "iron", {}, "Hooded lamps of 12 W (2100 lm).");
  for (const Vec3d& bulb : bulbs) scene.add(glowing_ball(bulb, 0.07, 12, warm_white));
}

void add_ground(SceneFolder& scene, const Maze& maze) {
  const double half = 0.5 * maze.size() * cell + 1.2, lawn = half + 18;
  const PlyLayout flat{.normals = Normals::flat};
  scene.add_mesh("lawn", box({-lawn, -lawn, -0.4}, {lawn, lawn, -0.015}), "lawn", flat,
                 "The ground.");
  const std::vector<Mesh> paving = chequered_floor({-half, -half}, {half, half}, 0.65);
  for (int i = 0; i < 2; ++i)
    scene.add_mesh(fmt::format("paving_{}", i), paving[size_t(i)], fmt::format("paving_{}", i),
                   flat);
  const double goal = 0.5 * maze.size() * cell - 0.5 * cell;
  Mesh obelisk = cone(0.20, 0.10, 0.15, 1.75, 4);
  obelisk.append(cone(0.10, 0, 1.75, 1.92, 4));
  obelisk.append(turned(box({-0.24, -0.24, 0}, {0.24, 0.24, 0.15}), {0, 0, 1}, 45));
  scene.add_mesh("goal", moved(turned(obelisk, {0, 0, 1}, 45), {goal, goal, 0}), "gold", flat,
                 "The goal, in the corner across from the entrance.");
}

}  // namespace

SceneFolder make_maze(const SceneOptions& options) {
  const Maze maze(options.maze_size, options.seed);
  SceneFolder scene(
      "maze",
      "A random maze at dusk with lamps in its ways. After figure 8.7 of R. Schregle, "
      "\"Rendering with Photon Maps\" (1998). Lengths in metres, z is up.");
  const double s = maze.size() * cell;
  scene.add_view({.origin = {-0.22 * s, -0.84 * s, 0.95 * s},
                  .target = {-0.01 * s, -0.075 * s, 0},
                  .fov = 54});
  add_maze_materials(scene);
  add_ground(scene, maze);
  add_walls(scene, maze);
  add_lamps(scene, maze, options.seed + 1);
  scene.add(object("emitter", "constant",
                   {rgb("radiance", lamp_intensity(7 / luminous_efficacy, 1, {0.45, 0.75, 1.7}))})
                .said("The sky after sunset, 7 cd/m2."));
  return scene;
}

}  // namespace kaustik::scenes
