#pragma once
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "kaustik/geometry/shape.h"
#include "kaustik/image/picture_reader.h"
#include "kaustik/light/light.h"
#include "kaustik/material/bsdf.h"
#include "kaustik/material/texture.h"
#include "kaustik/volume/volume.h"

namespace kaustik {

/// How much of a scene build_scene() made anew; the rest is that of the scene before.
struct BuildCounts {
  int shapes = 0;    ///< meshes read, among them
  int pictures = 0;  ///< read, of textures and lights
  int textures = 0;
  int bsdfs = 0;
  int volumes = 0;
  int lights = 0;            ///< without their tables
  int light_tables = 0;      ///< of pictures around the scene
  int group_structures = 0;  ///< for rays, of shape groups
  int top_structures = 0;    ///< for rays, over all shapes and instances of the world
  int light_selectors = 0;   ///< the trees over all lights
  int light_probings = 0;    ///< that learn from the camera on which lights are seen where
};

/// What a scene was built of, by the digests of what describes it (PartKeys): for the scene that
/// comes after it.
struct BuiltParts {
  struct MadeTexture {
    std::shared_ptr<const Texture> texture;
    PictureReader::Use pictures;
  };
  struct MadeLight {
    std::shared_ptr<const Light> light;
    // What it was made from beside its description.
    std::shared_ptr<const Shape> shape;
    Bounds3f scene_bounds;
    std::shared_ptr<const void> tables;  ///< see LightInputs
    PictureReader::Use pictures;
  };
  template <typename Part>
  using ByKey = std::unordered_map<uint64_t, Part>;

  ByKey<std::shared_ptr<const Shape>> shapes;
  ByKey<MadeTexture> textures;
  ByKey<std::shared_ptr<const Bsdf>> bsdfs;
  ByKey<std::shared_ptr<const Volume>> volumes;
  ByKey<MadeLight> lights;
  uint64_t sensor = 0;  ///< the key of the camera with its film
  uint64_t world = 0;   ///< the key of all else that light meets, the camera's medium included
};

/// The part of that key; null if there is none.
template <typename Part>
const Part* find_part(const std::unordered_map<uint64_t, Part>& parts, uint64_t key) {
  const auto found = parts.find(key);
  return found == parts.end() ? nullptr : &found->second;
}

}  // namespace kaustik
