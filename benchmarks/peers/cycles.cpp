#include "benchmarks/peers/cycles.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

#include "kaustik/base/error.h"
#include "kaustik/image/image_io.h"

namespace kaustik::bench {
namespace {

using nlohmann::json;

json json_of(const Vec3f& v) { return {v.x, v.y, v.z}; }
json json_of(const Spectrum& s) { return {s[0], s[1], s[2]}; }

template <typename T>
json json_of(const std::vector<T>& values) {
  json all = json::array();
  for (const T& value : values) all.push_back(json_of(value));
  return all;
}

const char* name_of(PeerMaterial material) {
  switch (material) {
    case PeerMaterial::diffuse:
      return "diffuse";
    case PeerMaterial::mirror:
      return "mirror";
    case PeerMaterial::glass:
      return "glass";
  }
  return "";
}

/// With the names that cycles_render.py reads.
json json_of_surface(const PeerSurface& surface, size_t index) {
  return {{"name", fmt::format("{}", index)},
          {"material", name_of(surface.material)},
          {"reflectance", json_of(surface.reflectance)},
          {"ior", surface.ior},
          {"radiance", json_of(surface.radiance)},
          {"positions", json_of(surface.mesh.positions)},
          {"normals", json_of(surface.mesh.normals)},
          {"triangles", surface.mesh.triangles}};
}

json json_of_scene(const PeerScene& scene) {
  json surfaces = json::array();
  for (size_t i = 0; i < scene.surfaces.size(); ++i)
    surfaces.push_back(json_of_surface(scene.surfaces[i], i));
  return {{"size", {scene.size.x, scene.size.y}},
          {"filter_stddev", peer_filter_stddev},
          {"horizontal_fov", scene.horizontal_fov},
          {"position", json_of(scene.position)},
          {"forward", json_of(scene.forward)},
          {"up", json_of(scene.up)},
          {"surfaces", surfaces}};
}

}  // namespace

PeerPicture render_with_cycles(const PeerScene& scene, double seconds, int threads, int seed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.json") << json_of_scene(scene);
  const std::string said =
      run_peer(fmt::format("blender --background --factory-startup --python-exit-code 1 --python "
                           "'{}/benchmarks/peers/cycles_render.py' -- '{}' {} {} {} '{}' '{}'",
                           KAUSTIK_SOURCE_DIR, folder / "scene.json", seconds, threads, seed,
                           folder / "picture.exr", folder / "times.txt"),
               folder);
  PeerPicture picture;
  int samples_per_pixel = 0;
  if (!(std::ifstream(folder / "times.txt") >> samples_per_pixel >> picture.seconds >>
        picture.start_up_seconds))
    throw Error(ErrorKind::system, "Blender did not render:\n" + said);
  picture.effort = fmt::format("{} samples per pixel", samples_per_pixel);
  picture.image = read_image(folder / "picture.exr");
  return picture;
}

}  // namespace kaustik::bench
