#include "kit/architecture.h"
#include "kit/furniture.h"
#include "scenes/materials.h"
#include "scenes/scenes.h"

namespace kaustik::scenes {
namespace {

const Vec3d low(-2.4, -2.6, 0), high(2.4, 2.2, 2.7);
constexpr double board_length = 0.48, board_width = 0.08;
const BoardWood oak{{0.50, 0.33, 0.19}, {0.28, 0.16, 0.08}, board_width, (low + high) * 0.5, 3, 3};

void add_show_materials(SceneFolder& scene) {
  Materials m(scene);
  m.matt("wall", {0.80, 0.78, 0.74});
  m.matt("ceiling", {0.85, 0.84, 0.82});
  m.matt("red", {0.66, 0.05, 0.035});
  m.matt("clay", {0.55, 0.28, 0.17});
  m.matt("earth", {0.06, 0.045, 0.035});
  m.matt("leaf", {0.10, 0.24, 0.06});
  m.matt("cane", {0.52, 0.39, 0.22});
  m.glossy("lacquer", {0.05, 0.03, 0.025}, 0.04, 40);
  m.glossy("bentwood", {0.14, 0.06, 0.03}, 0.04, 40);
  m.boards("oak", oak, 0.03, 60);
  m.metal("brass", "CuZn", 0.15);
}

void add_room(SceneFolder& scene, uint64_t seed) {
  const RoomShell shell = room_shell(low, high, 0.2);
  const PlyLayout flat{.normals = Normals::flat};
  scene.add_mesh("walls", merged({shell.west, shell.east, shell.south, shell.north}), "wall", flat,
                 "The room: 4.8 m x 4.8 m, 2.7 m high, closed on all sides.");
  scene.add_mesh("ceiling", shell.ceiling, "ceiling", flat);
  scene.add_mesh("floor", moved(shell.floor, {0, 0, -0.025}), "oak_0", flat);
  const std::vector<Mesh> boards =
      herringbone_floor({low.x, low.y}, {high.x, high.y}, board_length, board_width, 3, seed);
  for (size_t i = 0; i < boards.size(); ++i)
    scene.add_mesh("parquet_" + std::to_string(i), boards[i], "oak_" + std::to_string(i),
                   {.normals = Normals::flat},
                   i == 0 ? "Parquet: three kinds of boards along x, three along y." : "");
  Mesh mouldings =
      moulding_around(skirting_outline(0.12, 0.018), {low.x, low.y}, {high.x, high.y}, 0);
  mouldings.append(
      moulding_around(cornice_outline(0.13), {low.x, low.y}, {high.x, high.y}, high.z));
  scene.add_mesh("mouldings", mouldings, "ceiling");
}

void add_furniture(SceneFolder& scene, uint64_t seed) {
  const auto placed = [](const Mesh& mesh, double degrees, const Vec3d& at) {
    return moved(turned(mesh, {0, 0, 1}, degrees), at);
  };
  const FoldingScreen screen = folding_screen(4, 0.56, 1.75, 24);
  const Vec3d screen_at(0.32, 0.85, 0);
  scene.add_mesh("screen_frame", placed(screen.frame, -8, screen_at), "lacquer", {},
                 "The folding screen that the spotlight hits.");
  scene.add_mesh("screen_cloth", placed(screen.cloth, -8, screen_at), "red",
                 {.normals = Normals::flat});
  scene.add_mesh("screen_hinges", placed(screen.hinges, -8, screen_at), "brass");

  const BentwoodChair chair = bentwood_chair();
  const Vec3d chair_at(-1.1, 0.35, 0);
  scene.add_mesh("chair", placed(chair.wood, 35, chair_at), "bentwood", {}, "A bentwood chair.");
  scene.add_mesh("chair_seat", placed(chair.cane, 35, chair_at), "cane");

  const PottedPlant plant = potted_plant(1.5, 26, seed);
  const Vec3d plant_at(-1.6, 1.45, 0);
  scene.add_mesh("pot", placed(plant.pot, 0, plant_at), "clay", {}, "A plant in the corner.");
  scene.add_mesh("earth", placed(plant.earth, 0, plant_at), "earth");
  scene.add_mesh("stems", placed(plant.stems, 0, plant_at), "leaf");
  scene.add_mesh("leaves", placed(plant.leaves, 0, plant_at), "leaf");
}

void add_light(SceneFolder& scene) {
  const Vec3d at(-0.9, -1.9, 2.45), target(0.62, 0.85, 0.95);
  constexpr double cutoff = 25, beam = 20;
  Xml spot = object("emitter", "spot");
  spot.add(rgb("intensity", lamp_intensity(30, cone_solid_angle(beam), {1, 0.86, 0.66})));
  spot.add(number("cutoff_angle", cutoff));
  spot.add(number("beam_width", beam));
  spot.add(transform({look_at(at, target)}));
  scene.add(std::move(spot).said(
      "The only light: a spotlight of about 30 W (5400 lm) below the ceiling behind the camera."));
}

}  // namespace

SceneFolder make_point_spotlight(const SceneOptions& options) {
  SceneFolder scene("point_spotlight",
                    "A point spotlight on a red folding screen in a pale room: all that lies "
                    "outside of its cone is lit by what the screen and the floor throw back. After "
                    "figure 8.2 of R. Schregle, \"Rendering with Photon Maps\" (1998). Lengths in "
                    "metres, z is up.");
  scene.add_view({.origin = {-0.45, -2.5, 1.35}, .target = {-0.08, 0.6, 1.02}, .fov = 60});
  add_show_materials(scene);
  add_room(scene, options.seed);
  add_furniture(scene, options.seed);
  add_light(scene);
  return scene;
}

}  // namespace kaustik::scenes
