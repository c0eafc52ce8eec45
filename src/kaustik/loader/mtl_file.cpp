#include "kaustik/loader/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/error.h"
#include "kaustik/loader/mtl_material.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/stand_ins.h"

namespace kaustik {
namespace {

double largest(const Rgb& color) { return std::max({color.r, color.g, color.b}); }
Rgb scaled(const Rgb& color, double factor) {
  return {color.r * factor, color.g * factor, color.b * factor};
}

/// White where it is not given, or black, which writers give where they know nothing of it.
Rgb filter_of(const MtlMaterial& material) {
  return material.filter && largest(*material.filter) > 0 ? *material.filter : Rgb{1, 1, 1};
}
bool is_filtered(const MtlMaterial& material) {
  const Rgb filter = filter_of(material);
  return std::min({filter.r, filter.g, filter.b}) < 1;
}

/// Diffuse, with a highlight or a mirror.
std::shared_ptr<Object> opaque_bsdf(const MtlMaterial& material) {
  const Place& place = material.place;
  const double diffuse = material.diffuse_map ? 0.5 : largest(material.diffuse);
  const double specular = largest(material.specular);
  const auto give_diffuse = [&](Object& to, const char* name, double factor) {
    if (material.diffuse_map)
      to.children.push_back(mtl_texture(name, *material.diffuse_map, false, place));
    else
      to.properties.push_back({name, scaled(material.diffuse, factor), place});
  };
  constexpr double least_specular = 0.02;
  if (specular < least_specular) {
    auto plain = make_object("bsdf", "diffuse", place);
    give_diffuse(*plain, "reflectance", 1);
    return plain;
  }
  const double total = std::max(1.0, diffuse + specular);
  const bool is_mirror =
      material.illumination == 3 || material.illumination == 5 || material.exponent > 1000;
  if (!is_mirror) {
    auto glossy = make_object("bsdf", "phong", place);
    give_diffuse(*glossy, "diffuse_reflectance", 1 / total);
    glossy->properties.push_back(
        {"specular_reflectance", scaled(material.specular, 1 / total), place});
    glossy->properties.push_back({"exponent", material.exponent, place});
    return glossy;
  }
  // The blend takes of each its share: both are that much brighter.
  const double share = specular / (diffuse + specular);
  auto mirror = make_object("bsdf", "conductor", place);
  mirror->properties.push_back({"material", std::string("none"), place});
  mirror->properties.push_back(
      {"specular_reflectance", scaled(material.specular, 1 / (share * total)), place});
  if (diffuse < least_specular) return mirror;
  auto plain = make_object("bsdf", "diffuse", place);
  give_diffuse(*plain, "reflectance", 1 / ((1 - share) * total));
  auto blend = make_object("bsdf", "blendbsdf", place);
  blend->properties.push_back({"weight", share, place});
  blend->children = {{"", plain}, {"", mirror}};
  return blend;
}

}  // namespace

std::shared_ptr<Object> plain_mtl_bsdf(const MtlMaterial& material) {
  const Place& place = material.place;
  if (is_glass(material)) {
    auto glass = make_object("bsdf", "dielectric", place);
    glass->properties.push_back({"int_ior", material.ior > 1 ? material.ior : 1.5, place});
    if (is_filtered(material))
      glass->properties.push_back({"specular_transmittance", filter_of(material), place});
    return glass;
  }
  auto opaque = opaque_bsdf(material);
  if (opacity_of(material) >= 1 && !material.dissolve_map) return opaque;
  auto mask = make_object("bsdf", "mask", place);
  if (material.dissolve_map)
    mask->children.push_back(mtl_texture("opacity", *material.dissolve_map, true, place));
  else
    mask->properties.push_back({"opacity", opacity_of(material), place});
  mask->children.push_back({"", opaque});
  return mask;
}

double opacity_of(const MtlMaterial& material) {
  // Tr is 1 − d, but where nothing would be left of the material: there the writer means d.
  if (material.dissolve) return *material.dissolve;
  return material.transparency && *material.transparency < 1 ? 1 - *material.transparency : 1;
}

bool is_glass(const MtlMaterial& material) {
  const int model = material.illumination;
  return model == 4 || model == 6 || model == 7 || model == 9 ||
         (material.ior != 1 && (opacity_of(material) < 1 || is_filtered(material)));
}

Child mtl_texture(const std::string& name, const MtlMap& map, bool is_raw, const Place& place) {
  if (map.file.empty()) return {name, missing_texture(place)};
  auto made = std::make_shared<Object>(Object{"texture", "bitmap", "", {}, {}, place});
  made->properties = {{"filename", map.file, place}, {"raw", is_raw, place}};
  if (!map.channel.empty()) made->properties.push_back({"channel", map.channel, place});
  if (map.clamps) made->properties.push_back({"wrap_mode", std::string("clamp"), place});
  const Vec3d &s = map.scale, &o = map.offset;
  if ((s.x != 1 || s.y != 1 || o.x != 0 || o.y != 0) && s.x != 0 && s.y != 0)
    // Of coordinates with v turned upside down, as OBJ files have it.
    made->properties.push_back(
        {"to_uv", Transform::translate({o.x, 1 - s.y - o.y, 0}) * Transform::scale({s.x, s.y, 1}),
         place});
  return {name, made};
}

MtlFile read_mtl(const std::string& path, const FindBeside& find) {
  MtlLibrary library = read_mtl_library(path, find, MtlKeys::mitsuba);
  MtlFile result;
  for (auto& [name, material] : library.materials) {
    for (auto* map : {&material.diffuse_map, &material.dissolve_map})
      if (*map && (*map)->file.empty()) map->reset();
    result.bsdfs[name] = plain_mtl_bsdf(material);
  }
  for (const MtlRemark& remark : library.remarks) {
    result.remarks.push_back(fmt::format(
        "{}: {}{}", text_of(remark.place), remark.what,
        remark.kind == DeviationKind::missing ? ": the material has its plain colour" : ""));
  }
  return result;
}

}  // namespace kaustik
