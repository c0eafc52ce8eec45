#include "kit/architecture.h"
#include "kit/gem.h"
#include "kit/glassware.h"
#include "kit/lamps.h"
#include "kit/provisions.h"
#include "scenes/materials.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

// The room; the table's top is z = 0.
const Vec3d room_low(-0.72, -2.3, -0.75), room_high(1.6, 0.95, 1.9);
constexpr double thick = 0.3, table_back = 0.62;

const Vec3d late_sun(1.0, 0.79, 0.52);
/// Toward the sun, 21 degrees high.
const Vec3d sunward = Vec3d(-1, 0.65, 0.458).normalized();
/// Where the beam through the window is aimed.
const Vec3d sun_target(0.05, 0.03, 0.08);

Xml openpbr(const Vec3d& color, double roughness) {
  return object("bsdf", "openpbr",
                {rgb("base_color", color), number("specular_roughness", roughness)});
}

/// Soft clouds of two colours.
Xml mottled(const Vec3d& color0, const Vec3d& color1, double size, int seed) {
  return object("texture", "noise",
                {rgb("color0", color0), rgb("color1", color1), number("scale", size),
                 integer("octaves", 5), integer("seed", seed)});
}

/// Skin of a fruit, with pores of that height.
Xml skin(Xml color, double roughness, double pores) {
  Xml bsdf = object("bsdf", "openpbr");
  bsdf.add(std::move(color).named("base_color"));
  bsdf.add(number("specular_roughness", roughness));
  bsdf.add(number("base_diffuse_roughness", 0.3));
  Xml bumps = object("bsdf", "bumpmap");
  bumps.add(object("texture", "noise",
                   {number("scale", 0.0035), integer("octaves", 3), number("amplitude", pores)})
                .named("texture"));
  bumps.add(std::move(bsdf));
  return bumps;
}

void add_transparent(SceneFolder& scene, const std::string& id, double ior, int priority) {
  scene.add(object("bsdf", "dielectric",
                   {number("int_ior", ior), number("ext_ior", 1), integer("priority", priority)},
                   id));
}

void add_still_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("plaster", mottled({0.19, 0.205, 0.20}, {0.225, 0.24, 0.23}, 0.8, 4));
  m.matt("room", {0.60, 0.58, 0.54});
  m.matt("black", {0.02, 0.02, 0.02});
  m.glossy("frame", {0.45, 0.44, 0.42}, 0.03, 60);
  Xml walnut = object("texture", "wood");
  walnut.add(rgb("color0", {0.19, 0.118, 0.075}));
  walnut.add(rgb("color1", {0.105, 0.060, 0.036}));
  walnut.add(number("grain", 0.2));
  walnut.add(integer("seed", 4));
  m.glossy("walnut", std::move(walnut), 0.04, 120);
  m.metal("brass", "CuZn", 0.02);
  scene.add_bsdf("gold", object("bsdf", "conductor", {text("material", "Au")}));
  scene.add_bsdf("leather", openpbr({0.05, 0.018, 0.012}, 0.4));
  scene.add_bsdf("paper", openpbr({0.55, 0.48, 0.36}, 0.7));
  scene.add_bsdf("pear",
                 skin(mottled({0.30, 0.32, 0.05}, {0.52, 0.40, 0.09}, 0.035, 7), 0.38, 2e-5));
  scene.add_bsdf("lemon",
                 skin(mottled({0.68, 0.46, 0.03}, {0.78, 0.60, 0.06}, 0.03, 9), 0.33, 1.2e-4));
  scene.add_bsdf("stalk", openpbr({0.09, 0.05, 0.025}, 0.6));
  // Where bodies overlap the one of the higher priority is there.
  add_transparent(scene, "glass", 1.52, 2);
  add_transparent(scene, "water", 1.333, 1);
  add_transparent(scene, "wine", 1.345, 1);
  scene.add(
      object("bsdf", "dielectric", {number("int_ior", 1.52), number("ext_ior", 1)}, "crystal"));
  scene.add(object("bsdf", "dielectric",
                   {number("int_ior", 1.77), number("ext_ior", 1),
                    rgb("specular_transmittance", {0.62, 0.86, 0.98})},
                   "aquamarine"));
  scene.add(object("medium", "homogeneous",
                   {rgb("sigma_a", {3, 48, 54}), rgb("sigma_s", {0, 0, 0})}, "red_wine"));
}

void add_still_room(SceneFolder& scene) {
  const PlyLayout flat{.normals = Normals::flat};
  const RoomShell shell = room_shell(room_low, room_high, thick);
  // It ends where the western wall does: farther out it would be in the sun's way.
  const Mesh back = box({room_low.x - 0.03, room_high.y, room_low.z - thick},
                        {room_high.x + thick, room_high.y + thick, room_high.z + thick});
  scene.add_mesh("back_wall", back, "plaster", flat, "The room; the table's top is z = 0.");
  scene.add_mesh("walls", merged({shell.east, shell.south, shell.floor, shell.ceiling}), "room",
                 flat);
  // The western wall with two windows, its face at low x.
  const double length = room_high.y - room_low.y + 2 * thick;
  const std::vector<Opening> windows = {{1.2, 1.0, 0.85, 1.8}, {2.755, 1.21, 0.775, 1.3}};
  const auto placed = [&](const Mesh& mesh) {
    return moved(turned(mesh, {0, 0, 1}, 90), {room_low.x, room_low.y - thick, room_low.z - thick});
  };
  scene.add_mesh(
      "window_wall",
      placed(wall_with_openings(length, room_high.z - room_low.z + 2 * thick, 0.03, windows)),
      "room", flat);
  const Opening& o = windows[0];
  const Mesh bars = moved(window_bars(o.width, o.height, 2, 3, 0.035), {o.x, 0.015, o.z});
  scene.add_mesh("window_bars", placed(bars), "frame", flat);
  scene.add_mesh("table", bevelled_box({-0.7, -0.75, -0.03}, {1.3, table_back, 0}, 0.004, 3),
                 "walnut");
}

void add_vessel(SceneFolder& scene, const std::string& name, const Vessel& vessel, const Vec3d& at,
                const std::string& liquid, const std::string& medium, const std::string& comment) {
  scene.add_mesh(name, moved(vessel.glass, at), "glass", {}, comment);
  scene.write_mesh(name + "_" + liquid, moved(vessel.liquid, at));
  Xml shape = scene.shape(name + "_" + liquid, liquid);
  if (!medium.empty()) shape.add(named_ref("interior", medium));
  scene.add(std::move(shape));
}

Mesh stood(const Mesh& mesh, double degrees, const Vec3d& at) {
  return moved(turned(mesh, {0, 0, 1}, degrees), at);
}

void add_glass(SceneFolder& scene) {
  add_vessel(scene, "decanter", decanter(0.125), {-0.225, 0.20, 0}, "water", "",
             "A decanter of water, and a glass of wine.");
  add_vessel(scene, "wine_glass", wine_glass(0.118), {-0.09, 0.095, 0}, "wine", "red_wine", "");
  scene.add(
      object("shape", "sphere",
             {point("center", {-0.205, -0.065, 0.036}), number("radius", 0.036), ref("crystal")})
          .said("A ball of glass."));
  // The stone lies on one of its lower main facets.
  constexpr double size = 0.046;
  const BrilliantCut cut;
  const Mesh gem = turned(brilliant(size, cut), {0, 1, 0}, cut.pavilion_degrees);
  scene.add_mesh("gem", stood(moved(gem, {0, 0, -lowest(gem)}), 200, {0.0, -0.215, 0}),
                 "aquamarine", {.normals = Normals::flat}, "A cut stone.");
}

void add_metal(SceneFolder& scene) {
  const double inner = 0.052, outer = 0.054, height = 0.011;
  const Curve band = {{inner, 0.0006},          {inner + 0.0006, 0},      {outer - 0.0006, 0},
                      {outer, 0.0006},          {outer, height - 0.0006}, {outer - 0.0006, height},
                      {inner + 0.0006, height}, {inner, height - 0.0006}};
  scene.add_mesh("ring", moved(revolved(band, 240, true, 50), {0.125, -0.15, 0}), "gold", {},
                 "A golden ring.");
  scene.add_mesh("cup", moved(fluted_cup(18), {0.24, 0.03, 0}), "brass", {}, "A fluted cup.");
}

void add_food(SceneFolder& scene) {
  const Book b = book(0.21, 0.14, 0.034);
  const Vec3d book_at(0.315, 0.165, 0);
  scene.add_mesh("book", stood(b.cover, 14, book_at), "leather", {}, "A book with a pear on it.");
  scene.add_mesh("pages", stood(b.pages, 14, book_at), "paper", {.normals = Normals::flat});
  scene.add_mesh("gilding", stood(b.gilding, 14, book_at), "gold");
  const Pear p = pear(3);
  const Vec3d pear_at(0.325, 0.17, 0.034);
  scene.add_mesh("pear", stood(p.flesh, -35, pear_at), "pear");
  scene.add_mesh("stalk", stood(p.stalk, -35, pear_at), "stalk");
  scene.add_mesh("lemon", stood(lemon(5), -25, {0.045, 0.225, 0}), "lemon");
}

void add_still_light(SceneFolder& scene) {
  constexpr double distance = 40, sun_radius = 0.00465 * distance, half_angle = 0.57;
  constexpr double sun_illuminance = 38000, sky_luminance = 12000;
  Xml sun = object("emitter", "distributedspot");
  sun.add(rgb("intensity", lamp_intensity(sun_illuminance / luminous_efficacy * distance * distance,
                                          1, late_sun)));
  sun.add(number("radius", sun_radius));
  sun.add(number("cutoff_angle", half_angle));
  sun.add(number("beam_width", 0.98 * half_angle));
  sun.add(transform({look_at(sun_target + sunward * distance, sun_target)}));
  scene.add(
      std::move(sun).said("The sun, 38 klx: a ball 40 m away, as wide as the sun for the eye, that "
                          "shines into the window."));
  const Vec3d sky = lamp_intensity(sky_luminance / luminous_efficacy, 1, sky_blue);
  Xml pane = object("shape", "rectangle");
  pane.add(transform({scale({0.9, 0.425, 1}), rotate({0, 1, 0}, 90),
                      translate({room_low.x - 0.04, -0.975, 0.85})}));
  pane.add(ref("black"));
  pane.add(object("emitter", "area", {rgb("radiance", sky)}));
  scene.add(std::move(pane).said("The sky in the other window, 12 000 cd/m2."));
}

}  // namespace

SceneFolder make_still_life(const SceneOptions&) {
  SceneFolder scene("still_life",
                    "A still life on a table by a window: water and wine in glass, a cut stone, "
                    "gold, brass and fruit in the late sun. Lengths in metres, z is up.");
  scene.add_view({.origin = {0.03, -1.10, 0.46},
                  .target = {0.04, 0.0, 0.076},
                  .fov = 36.5,
                  .width = 1600,
                  .height = 900,
                  .aperture_radius = 0.0025});
  add_still_materials(scene);
  add_still_room(scene);
  add_glass(scene);
  add_metal(scene);
  add_food(scene);
  add_still_light(scene);
  return scene;
}

}  // namespace kaustik::scenes
