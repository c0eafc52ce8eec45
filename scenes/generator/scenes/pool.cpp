#include <fmt/format.h>

#include "kaustik/base/wave_field.h"
#include "kit/architecture.h"
#include "kit/furniture.h"
#include "kit/lamps.h"
#include "scenes/materials.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

// The hall, and the basin in its floor.
const Vec3d hall_low(-9, -5.6, 0), hall_high(9, 5.6, 4.6);
const Vec2d basin_low(-6.5, -2.75), basin_high(6.5, 2.75);
constexpr double water_level = -0.12, shallow = -1.35, deep = -2.15, basin_wall = 0.35;
constexpr double lane = 0.92;  ///< distance of the lane ropes from the middle

double basin_floor(double x) {
  const double t = (x - basin_low.x) / (basin_high.x - basin_low.x);
  return shallow + (deep - shallow) * t;
}

Xml tiles(const Vec3d& color, const Vec3d& joints, double size, double joint, double variation) {
  return object(
      "texture", "tiles",
      {rgb("color", color), rgb("joint_color", joints), number("tile_width", size),
       number("tile_height", size), number("joint", joint), number("variation", variation)});
}

/// Glazed tiles: glossy, each a little askew.
void add_tiles(SceneFolder& scene, const std::string& id, const Vec3d& color, const Vec3d& joints,
               double size, double joint, double variation, double gloss) {
  Xml phong = object("bsdf", "phong",
                     {tiles(color, joints, size, joint, variation).named("diffuse_reflectance"),
                      gray("specular_reflectance", gloss), number("exponent", 300)});
  scene.add_bsdf(id, object("bsdf", "bumpmap",
                            {tiles(color, joints, size, joint, variation).named("texture"),
                             std::move(phong)}));
}

void add_pool_materials(SceneFolder& scene) {
  Materials m(scene);
  // Glaze (n = 1.5) throws back a twelfth as much in water as in air: ((1.5 − 1.333) / 2.833)².
  constexpr double in_water = 0.0035;
  add_tiles(scene, "basin_tiles", {0.34, 0.66, 0.76}, {0.66, 0.70, 0.70}, 0.146, 0.004, 0.25,
            in_water);
  add_tiles(scene, "dark_tiles", {0.03, 0.09, 0.24}, {0.40, 0.45, 0.48}, 0.0455, 0.0045, 0.4,
            in_water);
  add_tiles(scene, "deck_tiles", {0.62, 0.56, 0.46}, {0.40, 0.37, 0.33}, 0.296, 0.004, 0.18, 0.03);
  add_tiles(scene, "wall_tiles", {0.66, 0.70, 0.68}, {0.52, 0.52, 0.50}, 0.146, 0.004, 0.10, 0.05);
  m.matt("plaster", {0.78, 0.77, 0.74});
  m.matt("ceiling", {0.80, 0.80, 0.79});
  m.matt("stone", {0.72, 0.70, 0.66});
  m.matt("black", {0.03, 0.03, 0.03});
  m.matt("float_red", {0.62, 0.04, 0.03});
  m.matt("float_white", {0.80, 0.80, 0.80});
  m.matt("ball_yellow", {0.75, 0.52, 0.04});
  m.matt("towel", {0.70, 0.25, 0.12});
  m.matt("clay", {0.52, 0.27, 0.17});
  m.matt("earth", {0.06, 0.045, 0.035});
  m.matt("leaf", {0.08, 0.20, 0.05});
  m.glossy("teak", {0.36, 0.21, 0.11}, 0.04, 60);
  m.metal("steel", "Cr", 0.06);
}

/// The basin with its water's edge, and the floor around it.
void add_basin(SceneFolder& scene) {
  const Vec2d &l = basin_low, &h = basin_high;
  const PlyLayout flat{.normals = Normals::flat};
  constexpr double base = -2.6;
  Mesh sides = box({l.x - basin_wall, l.y - basin_wall, base}, {l.x, h.y + basin_wall, 0});
  sides.append(box({h.x, l.y - basin_wall, base}, {h.x + basin_wall, h.y + basin_wall, 0}));
  sides.append(box({l.x - 0.01, l.y - basin_wall, base}, {h.x + 0.01, l.y, 0}));
  sides.append(box({l.x - 0.01, h.y, base}, {h.x + 0.01, h.y + basin_wall, 0}));
  const auto floor_block = [](const Vec2d& a, const Vec2d& b, double above) {
    return height_field(a, b, 1, 1, base,
                        [above](double x, double) { return basin_floor(x) + above; });
  };
  sides.append(floor_block(l - Vec2d(0.02, 0.02), h + Vec2d(0.02, 0.02), 0));
  scene.add_mesh("basin", sides, "basin_tiles", flat,
                 "The basin, 13 m x 5.5 m, 1.2 m to 2 m deep.");

  // Lines on the floor with a bar at either end, and a band at the water's edge.
  Mesh dark;
  for (const double y : {-1.83, 0.0, 1.83}) {
    dark.append(floor_block({l.x + 1.5, y - 0.125}, {h.x - 1.5, y + 0.125}, 0.002));
    for (const double x : {l.x + 1.25, h.x - 1.5})
      dark.append(floor_block({x, y - 0.45}, {x + 0.25, y + 0.45}, 0.002));
  }
  constexpr double proud = 0.004, from = -0.34, to = 0.001;
  dark.append(box({l.x - 0.01, l.y - 0.01, from}, {l.x + proud, h.y + 0.01, to}));
  dark.append(box({h.x - proud, l.y - 0.01, from}, {h.x + 0.01, h.y + 0.01, to}));
  dark.append(box({l.x, l.y - 0.01, from}, {h.x, l.y + proud, to}));
  dark.append(box({l.x, h.y - proud, from}, {h.x, h.y + 0.01, to}));
  scene.add_mesh("bands", dark, "dark_tiles", flat);

  // Rounded stones along the edge.
  const Curve stone = {{-0.03, 0},   {0.30, 0},      {0.30, 0.045},
                       {0.0, 0.045}, {-0.02, 0.038}, {-0.03, 0.022}};
  SweepOptions closed;
  closed.closed_path = true;
  scene.add_mesh(
      "coping",
      swept(stone, {{l.x, l.y, 0}, {h.x, l.y, 0}, {h.x, h.y, 0}, {l.x, h.y, 0}}, {0, 0, 1}, closed),
      "stone");
  Mesh deck = box({hall_low.x, hall_low.y, -0.3}, {l.x - 0.2, hall_high.y, 0.03});
  deck.append(box({h.x + 0.2, hall_low.y, -0.3}, {hall_high.x, hall_high.y, 0.03}));
  deck.append(box({l.x - 0.2, hall_low.y, -0.3}, {h.x + 0.2, l.y - 0.2, 0.03}));
  deck.append(box({l.x - 0.2, h.y + 0.2, -0.3}, {h.x + 0.2, hall_high.y, 0.03}));
  scene.add_mesh("deck", deck, "deck_tiles", flat);
}

void add_hall(SceneFolder& scene) {
  const RoomShell shell = room_shell({hall_low.x, hall_low.y, -0.3}, hall_high, 0.3);
  const PlyLayout flat{.normals = Normals::flat};
  scene.add_mesh("walls", merged({shell.west, shell.east, shell.south, shell.north}), "plaster",
                 flat, "The hall, 18 m x 11.2 m, 4.6 m high, closed on all sides.");
  scene.add_mesh("ceiling", shell.ceiling, "ceiling", flat);
  constexpr double dado = 1.5, proud = 0.02;
  Mesh lining = box({hall_low.x - 0.1, hall_low.y - 0.1, -0.2},
                    {hall_low.x + proud, hall_high.y + 0.1, dado});
  lining.append(box({hall_high.x - proud, hall_low.y - 0.1, -0.2},
                    {hall_high.x + 0.1, hall_high.y + 0.1, dado}));
  lining.append(box({hall_low.x, hall_low.y - 0.1, -0.2}, {hall_high.x, hall_low.y + proud, dado}));
  lining.append(
      box({hall_low.x, hall_high.y - proud, -0.2}, {hall_high.x, hall_high.y + 0.1, dado}));
  scene.add_mesh("lining", lining, "wall_tiles", flat);
  // Columns carry beams across the hall.
  const Curve profile = {{0, 0},       {0.34, 0},     {0.34, 0.10}, {0.27, 0.16},
                         {0.23, 0.20}, {0.215, 3.60}, {0.25, 3.66}, {0.25, 3.72},
                         {0.33, 3.86}, {0.33, 3.98},  {0, 3.98}};
  Mesh columns, beams;
  for (const double x : {-6.6, -2.2, 2.2, 6.6}) {
    for (const double y : {-4.25, 4.25}) columns.append(moved(revolved(profile, 40), {x, y, 0.03}));
    beams.append(
        bevelled_box({x - 0.22, hall_low.y - 0.1, 4.0}, {x + 0.22, hall_high.y + 0.1, 4.7}, 0.01));
  }
  scene.add_mesh("columns", columns, "stone");
  scene.add_mesh("beams", beams, "ceiling");
}

/// Handrails that lead into the water, with steps between them.
void add_ladder(Mesh& steel, const Vec3d& at, double degrees) {
  Mesh ladder;
  SweepOptions round;
  round.crease_degrees = 60;
  for (const double side : {-0.25, 0.25}) {
    const Path path = smooth_path({{side, -0.55, 0.0},
                                   {side, -0.55, 0.55},
                                   {side, -0.38, 0.80},
                                   {side, -0.10, 0.78},
                                   {side, 0.07, 0.45},
                                   {side, 0.09, -0.30},
                                   {side, 0.09, -1.25}},
                                  8);
    ladder.append(tube(0.021, path, 14, round));
  }
  for (const double z : {-0.32, -0.60, -0.88, -1.16})
    ladder.append(bevelled_box({-0.25, 0.05, z - 0.015}, {0.25, 0.13, z + 0.015}, 0.004));
  steel.append(moved(turned(ladder, {0, 0, 1}, degrees), at));
}

void add_fittings(SceneFolder& scene) {
  Mesh steel;
  add_ladder(steel, {-4.2, basin_high.y, 0.04}, 180);
  add_ladder(steel, {4.2, basin_high.y, 0.04}, 180);
  add_ladder(steel, {4.2, basin_low.y, 0.04}, 0);
  // Springboard over the deep end.
  const double end = basin_high.x;
  for (const double y : {-0.22, 0.22}) {
    steel.append(moved(cylinder(0.035, 0.03, 0.62, 20), {end + 1.5, y, 0}));
    steel.append(moved(cylinder(0.035, 0.03, 0.62, 20), {end + 0.45, y, 0}));
  }
  scene.add_mesh("steel", steel, "steel", {}, "Ladders, and what carries the springboard.");
  scene.add_mesh("springboard",
                 bevelled_box({end - 0.9, -0.26, 0.62}, {end + 1.75, 0.26, 0.67}, 0.012),
                 "float_white");
  Mesh blocks;
  for (const double y : {-2 * lane, 0.0, 2 * lane}) {
    Mesh block = bevelled_box({-0.30, -0.25, 0.03}, {0.25, 0.25, 0.62}, 0.015);
    block = bent(block, [](const Vec3d& p) { return Vec3d(p.x, p.y, p.z * (1 - 0.12 * p.x)); });
    blocks.append(moved(shaded(block, 30), {basin_low.x - 0.42, y, 0}));
  }
  scene.add_mesh("blocks", blocks, "stone");
  // Ropes with floats between the lanes: every fifth float is red.
  Mesh red, white;
  constexpr double step = 0.125;
  for (const double y : {-lane, lane})
    for (int i = 0; i < 104; ++i) {
      const double x = basin_low.x + (i + 0.5) * step;
      const Mesh one = moved(turned(cylinder(0.045, -0.045, 0.045, 12), {0, 1, 0}, 90),
                             {x, y, water_level + 0.008 * std::sin(1.7 * x + 2 * y)});
      (i / 5 % 2 == 0 ? red : white).append(one);
    }
  scene.add_mesh("floats_red", red, "float_red", {}, "Lane ropes.");
  scene.add_mesh("floats_white", white, "float_white");
  // What lies on the floor: an amphora, and rings to dive for.
  const auto on_floor = [](const Mesh& mesh, double x, double y) {
    return moved(mesh, {x, y, basin_floor(x)});
  };
  scene.add_mesh(
      "amphora",
      on_floor(moved(turned(turned(amphora(0.75), {0, 1, 0}, 82), {0, 0, 1}, 35), {0, 0, 0.16}),
               -0.6, 0.95),
      "clay", {}, "On the floor an amphora, and rings to dive for.");
  const Mesh ring = moved(torus(0.085, 0.014, 40, 12), {0, 0, 0.014});
  scene.add_mesh("ring_red", on_floor(ring, -2.6, -0.45), "float_red");
  scene.add_mesh("ring_yellow", on_floor(ring, -1.9, -0.95), "ball_yellow");
  scene.add_mesh("ball", ball({-2.6, -1.75, water_level + 0.10}, 0.17, 40), "ball_yellow", {},
                 "A ball that floats.");
}

void add_pool_furniture(SceneFolder& scene, uint64_t seed) {
  Mesh wood, steel, cloth, pots, earth, leaves;
  for (const double x : {-4.4, 0.0, 4.4}) {
    const Bench b = bench(1.8, 0.5, 0.44);
    wood.append(moved(b.seat, {x, 5.0, 0.03}));
    steel.append(moved(b.legs, {x, 5.0, 0.03}));
  }
  cloth.append(moved(turned(curtain(0.5, 0.42, 5, 0.02), {0, 0, 1}, 0), {0.35, 4.73, 0.47}));
  uint64_t number = seed;
  for (const double x : {-6.6, -2.2, 2.2, 6.6}) {
    const PottedPlant plant = potted_plant(1.5, 24, number++);
    const Vec3d at(x, 5.05, 0.03);
    pots.append(moved(plant.pot, at));
    earth.append(moved(plant.earth, at));
    leaves.append(moved(plant.stems, at));
    leaves.append(moved(plant.leaves, at));
  }
  scene.add_mesh("benches", wood, "teak", {}, "Benches and plants along the wall.");
  scene.add_mesh("bench_legs", steel, "steel");
  scene.add_mesh("towel", cloth, "towel");
  scene.add_mesh("pots", pots, "clay");
  scene.add_mesh("earth", earth, "earth");
  scene.add_mesh("leaves", leaves, "leaf");
}

/// Planar lights below the ceiling along its edge, and round ones in the sides of the basin.
void add_lights(SceneFolder& scene) {
  Mesh casings;
  std::vector<Xml> lights;
  const auto ceiling_light = [&](double x, double y, const Vec2d& size) {
    const Vec3d center(x, y, hall_high.z - 0.12);
    casings.append(moved(bevelled_box({-0.5 * size.x - 0.03, -0.5 * size.y - 0.03, 0},
                                      {0.5 * size.x + 0.03, 0.5 * size.y + 0.03, 0.14}, 0.01),
                         center));
    lights.push_back(glowing_rectangle(center - Vec3d(0, 0, 0.001), size, 60, neutral_white));
  };
  for (const double y : {-5.0, 5.0})
    for (const double x : {-8.0, -4.4, 0.0, 4.4, 8.0}) ceiling_light(x, y, {1.4, 0.4});
  for (const double x : {-8.2, 8.2})
    for (const double y : {-2.2, 2.2}) ceiling_light(x, y, {0.4, 1.4});
  scene.add_mesh("light_casings", casings, "ceiling");
  lights.front() = std::move(lights.front())
                       .said("Planar lights along the edge of the ceiling, 60 W (10 700 lm) each.");
  for (Xml& light : lights) scene.add(std::move(light));

  constexpr double radius = 0.14, depth = -0.75;
  Mesh rings;
  std::vector<Xml> lamps;
  const auto pool_light = [&](const Vec3d& at, const Vec3d& direction) {
    Mesh ring = torus(radius + 0.012, 0.018, 40, 12);
    ring = direction.x == 0 ? turned(ring, {1, 0, 0}, 90) : turned(ring, {0, 1, 0}, 90);
    rings.append(moved(ring, at));
    const Vec3d light = at + direction * 0.006;
    Xml disk = object("shape", "disk");
    disk.add(transform({scale({radius, radius, 1}), look_at(light, light + direction, {0, 0, 1})}));
    disk.add(ref("black"));
    disk.add(
        object("emitter", "area",
               {rgb("radiance", lamp_radiance(30, pi_d * radius * radius, {1.0, 0.97, 0.86}))}));
    lamps.push_back(std::move(disk));
  };
  for (const double x : {-4.9, -1.6, 1.6, 4.9}) {
    pool_light({x, basin_low.y, depth}, {0, 1, 0});
    pool_light({x, basin_high.y, depth}, {0, -1, 0});
  }
  pool_light({basin_high.x, -lane, depth}, {-1, 0, 0});
  pool_light({basin_high.x, lane, depth}, {-1, 0, 0});
  scene.add_mesh("lamp_rings", rings, "steel");
  lamps.front() =
      std::move(lamps.front()).said("Lamps in the sides of the basin, 30 W (5400 lm) each.");
  for (Xml& lamp : lamps) scene.add(std::move(lamp));
}

/// The water's surface, twice: flat with a bump map, and as real waves; -D water=waves chooses.
void add_water(SceneFolder& scene, uint64_t seed, const std::string& variant) {
  scene.add(setting("water", variant)
                .said("The water's surface: \"bumped\" (flat with a bump map) or \"waves\"."));
  const auto dielectric = [](const std::string& id) {
    return object("bsdf", "dielectric", {number("int_ior", 1.333), number("ext_ior", 1)}, id);
  };
  Xml bumped = object("bsdf", "bumpmap", {}, "water_bumped");
  bumped.add(
      object("texture", "waves",
             {number("amplitude", 0.006), number("wavelength", 1.1), integer("seed", int(seed))})
          .named("texture"));
  bumped.add(dielectric(""));
  scene.add(std::move(bumped));
  scene.add(dielectric("water_waves"));
  // A little into the walls, so that no ray slips past its edge.
  const Vec2d l = basin_low - Vec2d(0.005, 0.005),
              size = basin_high - basin_low + Vec2d(0.01, 0.01);
  WaveSettings settings;
  settings.amplitude = 0.008f;
  settings.wavelength = 1.5f;
  settings.count = 60;
  settings.seed = seed;
  const WaveField field(settings);
  const auto surface = [&](bool moving) {
    return [&, moving](double u, double v) {
      const double x = l.x + u * size.x, y = l.y + v * size.y;
      return Vec3d(
          x, y, water_level + (moving ? double(field.height({float(x), float(y)}, 0.08f)) : 0.0));
    };
  };
  scene.write_mesh("water_bumped", sheet(1, 1, surface(false)));
  scene.write_mesh("water_waves", sheet(170, 72, surface(true)));
  Xml shape = object("shape", "ply", {text("filename", "meshes/water_$water.ply")});
  shape.add(ref("water_$water"));
  shape.add(named_ref("interior", "haze"));
  scene.add(std::move(shape));
}

/// What floats in the water; -D haze=0.05 makes it seen.
void add_haze(SceneFolder& scene) {
  scene.add(
      setting("haze", "0").said("Scattering by what floats in the water, 1/m; 0: clear water."));
  scene.add(object("medium", "homogeneous",
                   {Xml("spectrum", {{"name", "sigma_s"}, {"value", "$haze"}}),
                    object("phase", "hg", {number("g", 0.5)})},
                   "haze"));
}

void build(SceneFolder& scene, const SceneOptions& options, const std::string& water) {
  add_pool_materials(scene);
  add_hall(scene);
  add_basin(scene);
  add_fittings(scene);
  add_pool_furniture(scene, options.seed);
  add_lights(scene);
  add_water(scene, options.seed, water);
}

}  // namespace

SceneFolder make_pool_above(const SceneOptions& options) {
  SceneFolder scene("pool_above",
                    "An indoor swimming pool: lights along the edge of the ceiling, lamps in the "
                    "basin under the water. After figure 8.8 of R. Schregle, \"Rendering with "
                    "Photon Maps\" (1998). Lengths in metres, z is up.");
  add_haze(scene);
  scene.add_view({.origin = {-8.6, -3.4, 1.85}, .target = {0.6, 0.75, 0.1}, .fov = 70});
  build(scene, options, "bumped");
  return scene;
}

SceneFolder make_pool_below(const SceneOptions& options) {
  SceneFolder scene("pool_below",
                    "The swimming pool of pool_above from under its water: the surface bends the "
                    "light of the ceiling and throws back that of the pool's lamps, the tiles bear "
                    "its caustics. After figure 8.9 of R. Schregle, \"Rendering with Photon Maps\" "
                    "(1998). Lengths in metres, z is up.");
  scene.share_files_of("pool_above");
  add_haze(scene);
  scene.add_view(
      {.origin = {-4.9, -1.6, -0.85}, .target = {2.2, 0.75, -0.92}, .fov = 78, .medium = "haze"});
  build(scene, options, "waves");
  return scene;
}

}  // namespace kaustik::scenes
