// Materials of OBJ files that are scenes: all keys of MTL.

#include <algorithm>
#include <cmath>

#include "kaustik/loader/mtl_material.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

/// Where a picture is not there, the number stands.
void give_share(Object& bsdf, const char* name, std::optional<double> share, double usual,
                const std::optional<MtlMap>& map) {
  if (map && !map->file.empty())
    bsdf.children.push_back(mtl_texture(name, *map, true, bsdf.place));
  else
    give(bsdf, name, share.value_or(usual));
}

/// The slope of Blinn and Phong's highlights: α² is 2 over the exponent and two, and α the square
/// of the roughness (Walter et al. 2007).
double roughness_of(const MtlMaterial& material) {
  return std::pow(2 / (material.exponent + 2), 0.25);
}

std::shared_ptr<Object> physical(const MtlMaterial& material) {
  auto bsdf = make_object("bsdf", "openpbr", material.place);
  if (material.diffuse_map)
    bsdf->children.push_back(mtl_texture("base_color", *material.diffuse_map, false, bsdf->place));
  else
    give(*bsdf, "base_color", material.diffuse);
  give_share(*bsdf, "specular_roughness", material.roughness, roughness_of(material),
             material.roughness_map);
  give_share(*bsdf, "base_metalness", material.metallic, 0, material.metallic_map);
  if (material.ior > 1) give(*bsdf, "specular_ior", material.ior);
  if (material.coat.value_or(0) > 0) {
    give(*bsdf, "coat_weight", *material.coat);
    give(*bsdf, "coat_roughness", material.coat_roughness.value_or(0));
  }
  if (material.sheen.value_or(0) > 0) give(*bsdf, "fuzz_weight", *material.sheen);
  if (material.anisotropy.value_or(0) > 0)
    give(*bsdf, "specular_roughness_anisotropy", *material.anisotropy);
  return bsdf;
}

/// With a normal or bump map that is there.
std::shared_ptr<Object> bent(std::shared_ptr<Object> bsdf, const MtlMaterial& material) {
  const bool has_normals = material.normal_map && !material.normal_map->file.empty();
  const bool has_bumps = material.bump_map && !material.bump_map->file.empty();
  if (!has_normals && !has_bumps) return bsdf;
  auto relief = make_object("bsdf", has_normals ? "normalmap" : "bumpmap", material.place);
  const MtlMap& map = has_normals ? *material.normal_map : *material.bump_map;
  relief->children.push_back(
      mtl_texture(has_normals ? "normalmap" : "texture", map, true, material.place));
  if (has_normals) give(*relief, "against_v", true);
  if (map.bump != 1) give(*relief, has_normals ? "strength" : "scale", map.bump);
  put(*relief, "", std::move(bsdf));
  return relief;
}

}  // namespace

std::shared_ptr<Object> full_mtl_bsdf(const MtlMaterial& material) {
  if (is_glass(material)) return bent(plain_mtl_bsdf(material), material);
  MtlMaterial opaque = material;
  opaque.dissolve = 1;
  opaque.dissolve_map.reset();
  auto bsdf = bent(material.is_physical() ? physical(material) : plain_mtl_bsdf(opaque), material);
  auto both = make_object("bsdf", "twosided", material.place);
  put(*both, "", std::move(bsdf));
  const bool has_map = material.dissolve_map && !material.dissolve_map->file.empty();
  if (opacity_of(material) >= 1 && !has_map) return both;
  auto mask = make_object("bsdf", "mask", material.place);
  give_share(*mask, "opacity", opacity_of(material), 1, material.dissolve_map);
  put(*mask, "", std::move(both));
  return mask;
}

std::shared_ptr<Object> mtl_emitter(const MtlMaterial& material) {
  const Rgb& emission = material.emission;
  if (!(std::max({emission.r, emission.g, emission.b}) > 0)) return nullptr;
  auto emitter = make_object("emitter", "area", material.place);
  if (material.emission_map && !material.emission_map->file.empty()) {
    auto scale = make_object("texture", "scale", material.place);
    give(*scale, "scale", emission);
    scale->children.push_back(mtl_texture("value", *material.emission_map, false, material.place));
    put(*emitter, "radiance", std::move(scale));
  } else {
    give(*emitter, "radiance", emission);
  }
  return emitter;
}

}  // namespace kaustik
