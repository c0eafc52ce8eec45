#include "kaustik/loader/gltf/gltf_material_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kaustik/base/photometric_units.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::gltf {
namespace {

bool is_white(const Rgb& color) { return color == Rgb{1, 1, 1}; }
bool is_black(const Rgb& color) { return color == Rgb{}; }

/// A texture times a factor.
std::shared_ptr<Object> scaled(std::shared_ptr<Object> texture, const Rgb& factor) {
  if (is_white(factor)) return texture;
  auto result = make_object("texture", "scale", texture->place);
  give(*result, "scale", factor);
  put(*result, "value", std::move(texture));
  return result;
}

/// The product of two textures, of which either may be null.
std::shared_ptr<Object> product(std::shared_ptr<Object> a, std::shared_ptr<Object> b) {
  if (!a || !b) return a ? a : b;
  auto result = make_object("texture", "scale", a->place);
  put(*result, "value", std::move(a));
  put(*result, "scale", std::move(b));
  return result;
}

std::shared_ptr<Object> vertex_attribute(const char* name, const Place& place) {
  auto texture = make_object("texture", "mesh_attribute", place);
  give(*texture, "name", name);
  return texture;
}

}  // namespace

MaterialReader::MaterialReader(const File& file, Textures& textures, const Options& options,
                               Deviations& deviations, const JsonValue& material, std::string name,
                               const SurfaceUse& use)
    : file_(file),
      textures_(textures),
      options_(options),
      deviations_(deviations),
      material_(material),
      name_(std::move(name)),
      use_(use),
      place_(file.place(material)),
      base_(material.find("pbrMetallicRoughness")) {
  // By the letter the archived model goes first; but of that the glossiness has no texture here.
  glossiness_ = extension("KHR_materials_pbrSpecularGlossiness");
  if (base_ && base_->find("metallicRoughnessTexture")) glossiness_ = nullptr;
  if (!base_) base_ = &nothing_;
  if (const JsonValue* transmission = extension("KHR_materials_transmission"))
    transmission_ = unit(*transmission, "transmissionFactor", 0);
}

void MaterialReader::approximated(std::string what) const {
  deviations_.approximated(name_, std::move(what), place_);
}
void MaterialReader::ignored(std::string what) const {
  deviations_.ignored(name_, std::move(what), place_);
}

Surface MaterialReader::read() {
  Surface surface;
  tell_of_others();
  if (extension("KHR_materials_unlit")) {
    surface.bsdf = masked(unlit());
    return surface;
  }
  std::shared_ptr<Object> bsdf = glass();
  if (!bsdf) {
    bsdf = make_object("bsdf", "openpbr", place_);
    if (glossiness_) {
      read_specular_glossiness(*bsdf, *glossiness_);
    } else {
      read_base(*bsdf);
      read_specular(*bsdf);
    }
    read_transmission(*bsdf);
    read_clearcoat(*bsdf);
    read_sheen(*bsdf);
    read_diffuse_transmission(*bsdf);
    if (extension("KHR_materials_dispersion"))
      ignored("its KHR_materials_dispersion is not rendered: it is not clear glass alone");
  }
  surface.bsdf = masked(bent(std::move(bsdf)));
  surface.interior = interior();
  surface.emitter = emitter();
  return surface;
}

// ---- values ----

double MaterialReader::unit(const JsonValue& object, const char* name, double usual) const {
  const double value = file_.number(object, name, usual);
  const double within = std::clamp(value, 0.0, 1.0);
  if (within != value)
    approximated(fmt::format("'{}' is {}: {} stands for it", name, value, within));
  return within;
}

Textured MaterialReader::scalar(const JsonValue& object, const char* factor, double usual,
                                const char* texture, TextureUse use) {
  const double number = unit(object, factor, usual);
  Textured result{{number, number, number}, nullptr};
  if (const JsonValue* info = object.find(texture); info && number > 0)
    result.texture = textures_.texture(*info, use);
  return result;
}

Textured MaterialReader::color(const JsonValue& object, const char* factor, double usual,
                               const char* texture) {
  const std::vector<double> given = file_.numbers(object, factor, {usual, usual, usual});
  const Rgb within = {std::clamp(given[0], 0.0, 1.0), std::clamp(given[1], 0.0, 1.0),
                      std::clamp(given[2], 0.0, 1.0)};
  if (within != Rgb{given[0], given[1], given[2]})
    approximated(fmt::format("'{}' is not within 0 and 1: the nearer end stands for it", factor));
  Textured result{within, nullptr};
  if (const JsonValue* info = object.find(texture); info && !is_black(within))
    result.texture = textures_.texture(*info, TextureUse::color);
  return result;
}

std::vector<double> MaterialReader::color_factor() const {
  return glossiness_ ? file_.numbers(*glossiness_, "diffuseFactor", {1, 1, 1, 1})
                     : file_.numbers(*base_, "baseColorFactor", {1, 1, 1, 1});
}
const JsonValue* MaterialReader::color_texture() const {
  return glossiness_ ? glossiness_->find("diffuseTexture") : base_->find("baseColorTexture");
}

Textured MaterialReader::base_color() {
  const std::vector<double> given = color_factor();
  Textured result;
  double* const parts[] = {&result.factor.r, &result.factor.g, &result.factor.b};
  for (size_t i = 0; i < 3; ++i) *parts[i] = std::clamp(given[i], 0.0, 1.0);
  if (const JsonValue* info = color_texture())
    result.texture = textures_.texture(*info, TextureUse::color);
  if (use_.has_colors)
    result.texture = product(result.texture, vertex_attribute("vertex_color", place_));
  return result;
}

Textured MaterialReader::opacity() {
  const double factor = color_factor()[3];
  Textured result;
  result.factor.r = result.factor.g = result.factor.b = std::clamp(factor, 0.0, 1.0);
  if (const JsonValue* info = color_texture())
    result.texture = textures_.texture(*info, TextureUse::opacity);
  if (use_.has_opacities)
    result.texture = product(result.texture, vertex_attribute("vertex_value", place_));
  return result;
}

void MaterialReader::give_value(Object& to, const char* name, const Textured& value,
                                bool is_number) const {
  if (value.texture)
    put(to, name, scaled(value.texture, value.factor));
  else if (is_number)
    give(to, name, value.factor.r);
  else
    give(to, name, value.factor);
}

/// In place of the one that it has.
void MaterialReader::set_number(Object& bsdf, const char* name, double number) {
  remove_property(bsdf, name);
  give(bsdf, name, number);
}

double MaterialReader::ior() const {
  const JsonValue* extension_object = extension("KHR_materials_ior");
  if (!extension_object) return 1.5;
  const double ior = file_.number(*extension_object, "ior", 1.5);
  if (ior == 0 && !transmits()) return 1.5;  // see normal_reflectance()
  if (ior >= 1 && ior <= 100) return ior;
  approximated(fmt::format("its index of refraction is {}: 1.5 stands for it", ior));
  return 1.5;
}

// ---- around the bsdf ----

std::shared_ptr<Object> MaterialReader::unlit() {
  approximated("it is unlit, and is rendered as a matt surface of its colour");
  auto matt = make_object("bsdf", "diffuse", place_);
  give_value(*matt, "reflectance", base_color(), false);
  auto both = make_object("bsdf", "twosided", place_);
  put(*both, "", std::move(matt));
  return both;
}

/// With the normal map, and from both sides where light does not pass.
std::shared_ptr<Object> MaterialReader::bent(std::shared_ptr<Object> bsdf) {
  const bool passes_light = transmits() || find_property(*bsdf, "geometry_thin_walled");
  if (const JsonValue* info = material_.find("normalTexture")) {
    if (auto picture = textures_.texture(*info, TextureUse::data)) {
      auto relief = make_object("bsdf", "normalmap", file_.place(*info));
      if (const double scale = file_.number(*info, "scale", 1); scale != 1)
        give(*relief, "strength", scale);
      give(*relief, "against_v", true);
      put(*relief, "normalmap", std::move(picture));
      put(*relief, "", std::move(bsdf));
      bsdf = std::move(relief);
    }
  }
  if (passes_light) return bsdf;
  auto both = make_object("bsdf", "twosided", place_);
  put(*both, "", std::move(bsdf));
  return both;
}

std::shared_ptr<Object> MaterialReader::masked(std::shared_ptr<Object> bsdf) {
  const std::string mode = file_.text(material_, "alphaMode", "OPAQUE");
  if (mode != "MASK" && mode != "BLEND") return bsdf;
  const Textured value = opacity();
  if (mode == "BLEND" && !value.texture && value.factor.r == 1) return bsdf;
  auto mask = make_object("bsdf", "mask", place_);
  give_value(*mask, "opacity", value, true);
  const double cutoff = file_.number(material_, "alphaCutoff", 0.5);
  if (mode == "MASK" && cutoff > 1) {
    mask = make_object("bsdf", "mask", place_);
    give(*mask, "opacity", 0.0);
  } else if (mode == "MASK") {
    give(*mask, "cutoff", std::max(cutoff, 0.0));
  }
  put(*mask, "", std::move(bsdf));
  return mask;
}

std::shared_ptr<Object> MaterialReader::interior() const {
  const JsonValue* volume = extension("KHR_materials_volume");
  if (!volume || !transmits() || !is_solid()) return nullptr;
  const double distance =
      file_.number(*volume, "attenuationDistance", std::numeric_limits<double>::infinity());
  const std::vector<double> color = file_.numbers(*volume, "attenuationColor", {1, 1, 1});
  if (!(distance > 0) || !std::isfinite(distance)) return nullptr;
  constexpr double least = 1e-6;  // black would absorb all at once
  const auto absorption = [&](double left) {
    return -std::log(std::clamp(left, least, 1.0)) / distance;
  };
  const Rgb sigma_a = {absorption(color[0]), absorption(color[1]), absorption(color[2])};
  if (is_black(sigma_a)) return nullptr;
  auto medium = make_object("medium", "homogeneous", place_);
  give(*medium, "sigma_a", sigma_a);
  give(*medium, "sigma_s", Rgb{});
  return medium;
}

std::shared_ptr<Object> MaterialReader::emitter() {
  const std::vector<double> factor = file_.numbers(material_, "emissiveFactor", {0, 0, 0});
  double nits = 1;
  if (const JsonValue* strength = extension("KHR_materials_emissive_strength"))
    nits = std::max(0.0, file_.number(*strength, "emissiveStrength", 1));
  const double watts = nits / lumens_per_watt_white;
  Textured radiance;
  radiance.factor = {std::max(0.0, factor[0]) * watts, std::max(0.0, factor[1]) * watts,
                     std::max(0.0, factor[2]) * watts};
  if (is_black(radiance.factor)) return nullptr;
  if (const JsonValue* info = material_.find("emissiveTexture"))
    radiance.texture = textures_.texture(*info, TextureUse::color);
  auto area = make_object("emitter", "area", place_);
  give_value(*area, "radiance", radiance, false);
  if (file_.boolean(material_, "doubleSided", false)) give(*area, "two_sided", true);
  return area;
}

/// What nothing here can show.
void MaterialReader::tell_of_others() const {
  const JsonValue* all = material_.find("extensions");
  if (!all) return;
  constexpr std::string_view known[] = {"KHR_materials_emissive_strength",
                                        "KHR_materials_transmission",
                                        "KHR_materials_volume",
                                        "KHR_materials_dispersion",
                                        "KHR_materials_ior",
                                        "KHR_materials_specular",
                                        "KHR_materials_clearcoat",
                                        "KHR_materials_sheen",
                                        "KHR_materials_anisotropy",
                                        "KHR_materials_unlit",
                                        "KHR_materials_diffuse_transmission",
                                        "KHR_materials_pbrSpecularGlossiness"};
  for (const auto& [name, value] : all->members())
    if (std::find(std::begin(known), std::end(known), name) == std::end(known))
      ignored(fmt::format("its {} is not rendered", name.substr(0, 100)));
}

}  // namespace kaustik::gltf
