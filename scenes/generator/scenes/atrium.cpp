#include <fmt/format.h>

#include "kit/architecture.h"
#include "kit/furniture.h"
#include "kit/lamps.h"
#include "kit/sculpture.h"
#include "scenes/fountain.h"
#include "scenes/materials.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

// An octagon of walls about the origin under a round dome; corridors lead off behind the walls to
// the north-west and north-east.
constexpr double apothem = 6, drum_height = 6.6, wall = 0.5;
const double side = 2 * apothem * std::tan(pi_d / 8);
constexpr double dome_radius = 5.7, dome_rise = 5.2;
constexpr double corridor_width = 2.6, corridor_length = 9, springing = 2.5;
// Walls are counted from the north, against the clock seen from above.
constexpr int north = 0, north_west = 1, west = 2, east = 6, north_east = 7;

/// From the frame of a wall, x along it from its middle, y outward from its face, to the world.
Mesh on_wall(const Mesh& mesh, int wall_index) {
  return turned(moved(mesh, {0, apothem, 0}), {0, 0, 1}, 45.0 * wall_index);
}
void add_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("plaster", {0.78, 0.73, 0.64});
  m.matt("dome", {0.80, 0.78, 0.73});
  m.matt("blue", {0.10, 0.19, 0.38});
  m.matt("trim", {0.80, 0.79, 0.76});
  m.matt("black", {0.03, 0.03, 0.03});
  m.matt("clay", {0.45, 0.22, 0.14});
  m.matt("earth", {0.06, 0.045, 0.035});
  m.matt("leaf", {0.07, 0.19, 0.05});
  m.matt("carpet", {0.42, 0.05, 0.05});
  m.glossy("marble_pale", marble({0.80, 0.77, 0.71}, {0.35, 0.32, 0.30}, 0.5, 1), 0.06, 400);
  m.glossy("marble_dark", marble({0.20, 0.085, 0.065}, {0.62, 0.50, 0.42}, 0.35, 2), 0.06, 400);
  m.glossy("marble_green", marble({0.05, 0.13, 0.09}, {0.42, 0.50, 0.42}, 0.3, 3), 0.06, 400);
  m.glossy("statue_stone", marble({0.84, 0.82, 0.78}, {0.60, 0.58, 0.56}, 0.3, 4), 0.04, 60);
  m.metal("gold", "Au", 0.18);
  m.metal("brass", "CuZn", 0.10);
  m.metal("bronze", "Cu", 0.2);
  const auto clear = [&](const char* id, double ior) {
    scene.add(object("bsdf", "dielectric", {number("int_ior", ior), number("ext_ior", 1)}, id));
  };
  clear("crystal", 1.62);
  clear("water", 1.333);
}

/// A floor of pale and dark slabs, with rings of dark and green stone about the fountain.
void add_floor(SceneFolder& scene) {
  const PlyLayout flat{.normals = Normals::flat};
  constexpr double reach = 16;
  scene.add_mesh("ground", box({-reach, -reach, -0.3}, {reach, reach, -0.012}), "black", flat);
  const std::vector<Mesh> slabs = chequered_floor({-7, -7}, {7, 7}, 0.7);
  scene.add_mesh("slabs_pale", slabs[0], "marble_pale", {}, "The floor's marble slabs.");
  scene.add_mesh("slabs_dark", slabs[1], "marble_dark");
  const auto ring = [](double inner, double outer, double height) {
    return revolved({{inner, -0.01}, {outer, -0.01}, {outer, height}, {inner, height}}, 96, true);
  };
  scene.add_mesh("floor_ring", ring(2.15, 3.0, 0.004), "marble_green");
  scene.add_mesh("floor_border", merged({ring(2.05, 2.15, 0.006), ring(3.0, 3.1, 0.006)}), "brass");
}

/// A wall with an arch in its middle: below the springing straight, above it half a circle.
Mesh wall_with_arch(double length, double height, double thickness, double width, double straight) {
  const double radius = 0.5 * width;
  Curve outline = {{-0.5 * length, 0}, {-radius, 0}, {-radius, straight}};
  constexpr int steps = 32;
  for (int i = 1; i < steps; ++i) {
    const double a = pi_d * (1 - double(i) / steps);
    outline.push_back({radius * std::cos(a), straight + radius * std::sin(a)});
  }
  for (const Vec2d& p : {Vec2d(radius, straight), Vec2d(radius, 0), Vec2d(0.5 * length, 0),
                         Vec2d(0.5 * length, height), Vec2d(-0.5 * length, height)})
    outline.push_back(p);
  // Extruded along z, then set upright with its face at y = 0.
  return moved(turned(extruded(outline, 0, thickness), {1, 0, 0}, 90), {0, thickness, 0});
}

/// The moulding around such an arch.
Mesh archivolt(double width, double straight) {
  const Curve outline = {{0, -0.02},   {0.22, -0.02}, {0.22, 0.05},
                         {0.16, 0.08}, {0.05, 0.06},  {0, 0.04}};
  Path path = {{0.5 * width, 0, 0}};
  constexpr int steps = 40;
  for (int i = 0; i <= steps; ++i) {
    const double a = pi_d * i / steps;
    path.push_back({0.5 * width * std::cos(a), 0, straight + 0.5 * width * std::sin(a)});
  }
  path.push_back({-0.5 * width, 0, 0});
  SweepOptions options;
  options.crease_degrees = 25;
  // Outward from the opening is to the right of a path that climbs on the right side.
  return swept(outline, path, {0, -1, 0}, options);
}

void add_walls(SceneFolder& scene) {
  const double length = side + 0.5;
  Mesh walls, panels, trims;
  for (int i = 0; i < 8; ++i) {
    const bool open = i == north_west || i == north_east;
    const bool niche = i == north || i == west || i == east;
    const Mesh face =
        open    ? wall_with_arch(length, drum_height, wall, corridor_width, springing)
        : niche ? wall_with_arch(length, drum_height, wall, 2.2, 2.3)
                : moved(box({0, 0, 0}, {length, wall, drum_height}), {-0.5 * length, 0, 0});
    walls.append(on_wall(face, i));
    if (open) trims.append(on_wall(archivolt(corridor_width, springing), i));
    if (niche) {
      trims.append(on_wall(archivolt(2.2, 2.3), i));
      panels.append(on_wall(box({-1.3, wall - 0.01, 0}, {1.3, wall + 0.3, 3.6}), i));
    }
  }
  scene.add_mesh("walls", shaded(walls, 25), "plaster", {},
                 "Eight walls 12 m across and 6.6 m high, with arches.");
  scene.add_mesh("niches", panels, "blue", {.normals = Normals::flat});
  scene.add_mesh("archivolts", trims, "trim");
}

/// Engaged columns in the corners and a cornice above them.
void add_order(SceneFolder& scene) {
  const double corner = apothem / std::cos(pi_d / 8);
  const Curve shaft = {{0, 0},       {0.40, 0},    {0.40, 0.14}, {0.36, 0.20}, {0.37, 0.27},
                       {0.30, 0.33}, {0.29, 0.40}, {0.295, 2.2}, {0.25, 5.05}, {0.28, 5.10},
                       {0.28, 5.16}, {0.25, 5.20}, {0.30, 5.36}, {0.36, 5.50}, {0.40, 5.52},
                       {0.40, 5.64}, {0, 5.64}};
  Mesh columns, gilding;
  Path ring;
  for (int i = 0; i < 8; ++i) {
    const double a = 0.25 * pi_d * (i + 0.5);
    const Vec3d at(-(corner - 0.30) * std::sin(a), (corner - 0.30) * std::cos(a), 0);
    columns.append(moved(revolved(shaft, 36), at));
    gilding.append(moved(torus(0.275, 0.022, 32, 8), at + Vec3d(0, 0, 5.13)));
    gilding.append(moved(torus(0.315, 0.025, 32, 8), at + Vec3d(0, 0, 0.335)));
    ring.push_back({-corner * std::sin(a), corner * std::cos(a), 0});
  }
  scene.add_mesh("columns", columns, "marble_dark", {}, "Columns in the corners.");
  scene.add_mesh("gilding", gilding, "gold");
  const Curve cornice = {{-0.05, 0.0}, {0.66, 0.0},  {0.66, 0.06}, {0.72, 0.10}, {0.72, 0.20},
                         {0.80, 0.30}, {0.90, 0.36}, {0.90, 0.46}, {-0.05, 0.46}};
  SweepOptions closed;
  closed.closed_path = true;
  Path mirrored(ring.rbegin(), ring.rend());
  for (Vec3d& p : mirrored) p.z = 5.64;
  scene.add_mesh("cornice", swept(cornice, mirrored, {0, 0, 1}, closed), "trim");
  const Curve skirting = {{0, 0}, {0.05, 0}, {0.05, 0.24}, {0.02, 0.30}, {0, 0.30}};
  Mesh skirtings;
  const double half = 0.5 * side - 0.2;
  for (int i = 0; i < 8; ++i) {
    const double gap = i == north_west || i == north_east     ? 0.5 * corridor_width + 0.22
                       : i == north || i == west || i == east ? 1.32
                                                              : 0;
    const auto piece = [&](double from, double to) {
      skirtings.append(on_wall(moved(box({from, -0.05, 0}, {to, 0.01, 0.28}), {0, 0, 0}), i));
    };
    if (gap == 0) {
      piece(-half, half);
    } else {
      piece(-half, -gap);
      piece(gap, half);
    }
  }
  scene.add_mesh("skirtings", skirtings, "marble_green", {.normals = Normals::flat});
}

/// The dome: a shell over a ring, with ribs and an eye that is closed by a gilded rose.
void add_dome(SceneFolder& scene) {
  constexpr int steps = 40;
  const double base = drum_height - 0.02;
  Curve inner, outer;
  for (int i = 0; i <= steps; ++i) {
    const double a = 0.5 * pi_d * i / steps;
    inner.push_back({dome_radius * std::cos(a), base + dome_rise * std::sin(a)});
    outer.push_back({(dome_radius + 0.4) * std::cos(a), base + (dome_rise + 0.4) * std::sin(a)});
  }
  // Walked upward on the outside, then down on the inside, with the ledge around the dome's foot.
  Curve profile = {{7.6, base}, {7.6, base + 0.4}, {dome_radius + 0.4, base + 0.4}};
  for (size_t i = 4; i < outer.size(); ++i)
    profile.push_back({i + 1 == outer.size() ? 0.0 : outer[i].x, outer[i].y});
  for (size_t i = inner.size(); i-- > 0;)
    profile.push_back({i + 1 == inner.size() ? 0.0 : inner[i].x, inner[i].y});
  scene.add_mesh("dome", revolved(profile, 96, true, 30), "dome", {}, "The dome, 11.4 m across.");
  const Curve rib = {{-0.11, -0.03}, {0.11, -0.03}, {0.11, 0.05},
                     {0.06, 0.09},   {-0.06, 0.09}, {-0.11, 0.05}};
  Mesh ribs, rosettes;
  for (int k = 0; k < 16; ++k) {
    Path path;
    for (int i = 0; i <= 24; ++i) {
      const double a = 0.5 * pi_d * (0.01 + 0.88 * i / 24);
      path.push_back({0, (dome_radius)*std::cos(a), base + dome_rise * std::sin(a)});
    }
    SweepOptions options;
    options.crease_degrees = 25;
    options.scale = [](double t) { return 1 - 0.55 * t; };
    ribs.append(turned(swept(rib, path, {0, -1, 0}, options), {0, 0, 1}, 22.5 * k));
    // Coffers' rosettes between the ribs.
    for (const double share : {0.16, 0.36, 0.55}) {
      const double a = 0.5 * pi_d * share;
      const Vec3d at(0, dome_radius * std::cos(a), base + dome_rise * std::sin(a));
      const double size = 0.30 * std::cos(a);
      Mesh rosette = torus(size, 0.06 * std::cos(a), 20, 6);
      rosette.append(scaled(ball({0, 0, 0}, 0.45 * size, 12), {1, 1, 0.5}));
      rosette = turned(rosette, {1, 0, 0}, 90 + 90 * share);
      rosettes.append(turned(moved(rosette, at), {0, 0, 1}, 22.5 * (k + 0.5)));
    }
  }
  scene.add_mesh("ribs", ribs, "trim");
  Mesh gilded = rosettes;
  gilded.append(moved(torus(1.0, 0.07, 64, 12), {0, 0, base + 0.985 * dome_rise}));
  scene.add_mesh("rosettes", gilded, "gold");
}

/// A corridor with a barrel vault and doors, behind the wall `index`.
void add_corridor(Mesh& vaults, Mesh& floors, Mesh& carpet, Mesh& doors, Mesh& trims, int index) {
  const double begin = wall - 0.01, end = wall + corridor_length, half = 0.5 * corridor_width;
  // The shell: a wall with an arch, as thick as the corridor is long.
  vaults.append(on_wall(moved(wall_with_arch(corridor_width + 1, springing + half + 0.5,
                                             end - begin, corridor_width, springing),
                              {0, begin, 0}),
                        index));
  vaults.append(on_wall(box({-half - 0.6, end - 0.01, -0.3}, {half + 0.6, end + 0.3, 5}), index));
  floors.append(on_wall(box({-half - 0.1, -0.9, -0.3}, {half + 0.1, end + 0.1, 0.002}), index));
  carpet.append(on_wall(bevelled_box({-0.75, 0.6, 0}, {0.75, end - 0.3, 0.014}, 0.004), index));
  for (const double y : {wall + 2.0, wall + 4.6, wall + 7.2}) {
    // Bands of the vault.
    trims.append(
        on_wall(moved(archivolt(corridor_width - 0.12, springing), {0, y - 1.0, 0}), index));
    for (const double sign : {-1.0, 1.0}) {
      doors.append(on_wall(
          bevelled_box({sign * half - 0.05, y - 0.5, 0}, {sign * half + 0.05, y + 0.5, 2.15}, 0.01),
          index));
      for (const double z : {0.25, 1.15})
        doors.append(on_wall(bevelled_box({sign * half - 0.075, y - 0.36, z},
                                          {sign * half + 0.075, y + 0.36, z + 0.75}, 0.015),
                             index));
    }
  }
  doors.append(on_wall(bevelled_box({-0.6, end - 0.06, 0}, {0.6, end + 0.05, 2.3}, 0.01), index));
}

void add_corridors(SceneFolder& scene) {
  Mesh vaults, floors, carpet, doors, trims;
  for (const int index : {north_west, north_east})
    add_corridor(vaults, floors, carpet, doors, trims, index);
  scene.add_mesh("corridors", shaded(vaults, 25), "plaster", {},
                 "Corridors to the left and right, 9 m long.");
  scene.add_mesh("corridor_floors", floors, "marble_pale", {.normals = Normals::flat});
  scene.add_mesh("carpets", carpet, "carpet");
  scene.add_mesh("corridor_bands", trims, "trim");
  scene.add_mesh("doors", doors, "marble_dark");
}

/// 72 crystals on three rings of a brass chandelier, four lamps among them.
void add_chandelier(SceneFolder& scene) {
  constexpr double height = 4.75;
  struct Tier {
    double radius, z, size;
    int count;
  };
  const Tier tiers[] = {{1.30, 0.0, 1.0, 36}, {0.86, -0.34, 1.1, 24}, {0.42, -0.70, 1.25, 12}};
  scene.write_mesh("crystal", crystal(0.062, 0.085, -0.20, 8), {.normals = Normals::flat});
  Xml group = object("shape", "shapegroup", {}, "crystal_group");
  group.add(scene.shape("crystal", "crystal"));
  scene.add(std::move(group).said("The chandelier: 72 crystals on three rings."));
  Mesh brass;
  std::vector<Xml> crystals;
  for (const Tier& tier : tiers) {
    brass.append(moved(torus(tier.radius, 0.022, 96, 12), {0, 0, height + tier.z}));
    for (int i = 0; i < tier.count; ++i) {
      const double a = 2 * pi_d * (i + 0.5) / tier.count;
      const Vec3d hook(tier.radius * std::cos(a), tier.radius * std::sin(a),
                       height + tier.z - 0.02);
      const Vec3d at = hook - Vec3d(0, 0, 0.05 + 0.085 * tier.size);
      brass.append(tube(0.004, {hook, at + Vec3d(0, 0, 0.08 * tier.size)}, 6));
      crystals.push_back(
          object("shape", "instance",
                 {ref("crystal_group"),
                  transform({scale(Vec3d(tier.size)),
                             rotate({0, 0, 1}, 360.0 * (i + 0.5) / tier.count + 11 * i),
                             translate(at)})}));
    }
  }
  for (int i = 0; i < 6; ++i) {  // arms from the rod to the rings
    const double a = 2 * pi_d * i / 6;
    const Vec3d out(std::cos(a), std::sin(a), 0);
    const auto arm = [&](const Tier& tier) {
      const double z = height + tier.z;
      SweepOptions round;
      round.crease_degrees = 60;
      brass.append(tube(
          0.014,
          smooth_path({Vec3d(0, 0, z + 0.30), out * (0.4 * tier.radius) + Vec3d(0, 0, z + 0.38),
                       out * (0.8 * tier.radius) + Vec3d(0, 0, z + 0.12),
                       out * tier.radius + Vec3d(0, 0, z)},
                      8),
          8, round));
    };
    for (const Tier& tier : tiers) arm(tier);
  }
  brass.append(moved(ball({0, 0, 0}, 0.12, 32), {0, 0, height + 0.42}));
  brass.append(tube(0.02, {{0, 0, height - 0.75}, {0, 0, drum_height + dome_rise - 0.05}}, 12));
  brass.append(moved(ball({0, 0, 0}, 0.07, 24), {0, 0, height - 0.80}));
  scene.add_mesh("chandelier", brass, "brass");
  for (Xml& one : crystals) scene.add(std::move(one));
  for (int i = 0; i < 4; ++i) {
    const double a = 2 * pi_d * (i + 0.5) / 4;
    const Vec3d at(0.64 * std::cos(a), 0.64 * std::sin(a), height + 0.02);
    scene.add(glowing_ball(at, 0.055, 140, warm_white)
                  .said(i == 0 ? "Four lamps among them, 140 W (25 000 lm) each." : ""));
  }
}

void add_furnishing(SceneFolder& scene, uint64_t seed) {
  const auto in_niche = [](const Mesh& mesh, int index, double lift) {
    return on_wall(moved(mesh, {0, 0.05, lift}), index);
  };
  Mesh pedestals, statues;
  for (const int index : {north, west, east}) {
    pedestals.append(in_niche(pedestal(0.8, 0.75), index, 0));
    const Mesh work = index == north  ? scaled(dancer(0.026), Vec3d(1.15))
                      : index == west ? knot(0.95)
                                      : idol_head(0.85, 0.022);
    statues.append(in_niche(work, index, 0.75));
  }
  scene.add_mesh("pedestals", pedestals, "marble_pale", {}, "Statues in the niches.");
  scene.add_mesh("statues", statues, "statue_stone", {.normals = Normals::smooth});
  const PottedPlant plant = potted_plant(1.7, 26, seed + 3);
  scene.write_mesh("pot", plant.pot);
  scene.write_mesh("earth", plant.earth);
  scene.write_mesh("leaves", merged({plant.stems, plant.leaves}));
  Xml group = object("shape", "shapegroup", {}, "plant");
  group.add(scene.shape("pot", "clay"));
  group.add(scene.shape("earth", "earth"));
  group.add(scene.shape("leaves", "leaf"));
  scene.add(std::move(group).said("Plants beside the arches."));
  for (const int index : {north_west, north_east})
    for (const double sign : {-1.0, 1.0})
      scene.add(object("shape", "instance",
                       {ref("plant"), transform({rotate({0, 0, 1}, 77 * index + 40 * sign),
                                                 translate({sign * 1.95, apothem - 0.55, 0}),
                                                 rotate({0, 0, 1}, 45.0 * index)})}));
  Mesh benches, legs;
  for (const int index : {west, east})
    for (const double sign : {-1.0, 1.0}) {
      const Bench b = bench(1.0, 0.45, 0.45);
      benches.append(on_wall(moved(b.seat, {sign * 1.72, -0.45, 0}), index));
      legs.append(on_wall(moved(b.legs, {sign * 1.72, -0.45, 0}), index));
    }
  scene.add_mesh("benches", benches, "carpet");
  scene.add_mesh("bench_legs", legs, "brass");
}

}  // namespace

SceneFolder make_atrium(const SceneOptions& options) {
  SceneFolder scene(
      "atrium",
      "An atrium under a dome: a chandelier of 72 crystals with four lamps among "
      "them above a fountain, corridors to the left and right. After figure 8.11 of "
      "R. Schregle, \"Rendering with Photon Maps\" (1998). Lengths in metres, z is up.");
  scene.add_view({.origin = {0.6, -5.55, 1.75}, .target = {-0.05, 1.0, 2.75}, .fov = 84});
  add_materials(scene);
  add_floor(scene);
  add_walls(scene);
  add_order(scene);
  add_dome(scene);
  add_corridors(scene);
  add_fountain(scene, options.seed);
  add_chandelier(scene);
  add_furnishing(scene, options.seed);
  return scene;
}

}  // namespace kaustik::scenes
