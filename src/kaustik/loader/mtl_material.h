#pragma once
// What an MTL file says, before it becomes bsdfs.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/file_search.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// A picture, and how it lies on the surface: u and v times `scale`, then plus `offset`.
struct MtlMap {
  std::string file;  ///< "": it is not there
  Vec3d scale{1, 1, 1}, offset{0, 0, 0};
  bool clamps = false;
  double bump = 1;           ///< factor on heights, -bm
  std::string channel = {};  ///< -imfchan: "r", "g", "b" or "a"; "": its colours
};

/// One material. What is not given has no value, or the default that is told.
struct MtlMaterial {
  Place place;
  Rgb diffuse{0.5, 0.5, 0.5}, specular{0, 0, 0};
  std::optional<Rgb> filter;
  double exponent = 0, ior = 1;
  std::optional<double> dissolve, transparency;
  int illumination = 2;
  std::optional<MtlMap> diffuse_map, dissolve_map;

  // Of the extension for physically based rendering, and what Mitsuba 0.6 does not read.
  Rgb emission{0, 0, 0};
  std::optional<double> roughness, metallic, sheen, coat, coat_roughness, anisotropy;
  std::optional<MtlMap> emission_map, roughness_map, metallic_map, specular_map, normal_map,
      bump_map;

  bool is_physical() const {
    return roughness || metallic || sheen || coat || anisotropy || roughness_map || metallic_map;
  }
};

/// What was left out.
struct MtlRemark {
  DeviationKind kind;
  std::string what;
  Place place;
};

struct MtlLibrary {
  std::map<std::string, MtlMaterial> materials;  ///< by their names
  std::vector<MtlRemark> remarks;
};

/// Which keys of materials are read.
enum class MtlKeys {
  mitsuba,  ///< those that Mitsuba 0.6 reads
  all       ///< and emission, the keys of physically based rendering, normal and bump maps
};

/// Reads what materials have; lines that are wrong are left out and told. Pictures are found by
/// `find`. Throws Error(input) if the file cannot be read; quotes nothing of it, which may be any
/// that a scene names.
MtlLibrary read_mtl_library(const std::string& path, const FindBeside& find, MtlKeys keys);

/// A picture as a texture of that name; the checker of missing ones if it is not there.
Child mtl_texture(const std::string& name, const MtlMap& map, bool is_raw, const Place& place);

/// The bsdf of what Mitsuba 0.6 reads.
std::shared_ptr<Object> plain_mtl_bsdf(const MtlMaterial& material);
/// The bsdf of all keys, seen from both sides; `openpbr` where there are those of physically based
/// rendering.
std::shared_ptr<Object> full_mtl_bsdf(const MtlMaterial& material);
/// The area light of Ke; null: it does not shine.
std::shared_ptr<Object> mtl_emitter(const MtlMaterial& material);

/// Whether it is seen through as glass is, and what share of the surface is there if it is not.
bool is_glass(const MtlMaterial& material);
double opacity_of(const MtlMaterial& material);

}  // namespace kaustik
