// The part of MaterialReader that deals with the bsdf itself.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/loader/gltf/gltf_material_reader.h"
#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::gltf {
namespace {

bool is_zero(const Textured& value) { return value.factor == Rgb{}; }
double largest_of(const Rgb& color) { return std::max({color.r, color.g, color.b}); }
Rgb over(const Rgb& color, double divisor) {
  return {color.r / divisor, color.g / divisor, color.b / divisor};
}

/// The index of refraction of what reflects so much straight on.
double ior_reflecting(double share) {
  const double root = std::sqrt(std::clamp(share, 0.0, 0.96));
  return (1 + root) / (1 - root);
}

}  // namespace

bool MaterialReader::is_solid() const {
  if (options_.glass != Glass::automatic) return options_.glass == Glass::solid;
  const JsonValue* volume = extension("KHR_materials_volume");
  return (volume && file_.number(*volume, "thicknessFactor", 0) > 0) || use_.is_closed;
}

/// Whether an extension makes it more than glass; many programs write them with values that do
/// nothing.
bool MaterialReader::has_layers() const {
  const auto is_above_zero = [&](const char* name, const char* factor) {
    const JsonValue* given = extension(name);
    return given && file_.number(*given, factor, 0) > 0;
  };
  const std::vector<double> white = {1, 1, 1}, black = {0, 0, 0};
  const JsonValue* specular = extension("KHR_materials_specular");
  const JsonValue* sheen = extension("KHR_materials_sheen");
  if (specular && (file_.number(*specular, "specularFactor", 1) != 1 ||
                   file_.numbers(*specular, "specularColorFactor", white) != white ||
                   specular->find("specularTexture") || specular->find("specularColorTexture")))
    return true;
  return (sheen && file_.numbers(*sheen, "sheenColorFactor", black) != black) ||
         is_above_zero("KHR_materials_clearcoat", "clearcoatFactor") ||
         is_above_zero("KHR_materials_anisotropy", "anisotropyStrength") ||
         is_above_zero("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor");
}

std::shared_ptr<Object> MaterialReader::glass() {
  if (transmission_ < 1) return nullptr;
  const JsonValue& transmission = *extension("KHR_materials_transmission");
  const double roughness = unit(*base_, "roughnessFactor", 1);
  if (has_layers() || transmission.find("transmissionTexture") ||
      base_->find("metallicRoughnessTexture") || unit(*base_, "metallicFactor", 1) > 0 ||
      (roughness > 0 && !is_solid()) || ior() == 1)
    return nullptr;
  const char* type = !is_solid()     ? "thindielectric"
                     : roughness > 0 ? "roughdielectric"
                                     : "dielectric";
  auto bsdf = make_object("bsdf", type, place_);
  give(*bsdf, "int_ior", ior());
  give(*bsdf, "ext_ior", 1.0);
  // The extension has 20 over the Abbe number.
  if (const JsonValue* dispersion = extension("KHR_materials_dispersion"))
    if (const double value = file_.number(*dispersion, "dispersion", 0); value > 0)
      give(*bsdf, "abbe_number", std::clamp(20 / value, 1.0, 1000.0));
  if (roughness > 0) {
    give(*bsdf, "distribution", "ggx");
    give(*bsdf, "alpha", roughness * roughness);
  }
  const Textured tint = base_color();
  if (tint.texture || !(tint.factor == Rgb{1, 1, 1}))
    give_value(*bsdf, "specular_transmittance", tint, false);
  return bsdf;
}

void MaterialReader::read_base(Object& bsdf) {
  give_value(bsdf, "base_color", base_color(), false);
  give_value(bsdf, "base_metalness",
             scalar(*base_, "metallicFactor", 1, "metallicRoughnessTexture", TextureUse::blue),
             true);
  give_value(bsdf, "specular_roughness",
             scalar(*base_, "roughnessFactor", 1, "metallicRoughnessTexture", TextureUse::green),
             true);
  give(bsdf, "specular_ior",
       normal_reflectance() == 1 ? ior_reflecting(normal_reflectance()) : ior());
  read_anisotropy(bsdf);
}

/// Of what is no metal. Straight on it reflects the share of its index times the colour, at most
/// all; that makes another index where light does not pass. `openpbr` has the colour toward the
/// edge, too, and the factor nowhere there.
void MaterialReader::read_specular(Object& bsdf) {
  const JsonValue* specular = extension("KHR_materials_specular");
  if (!specular || number_in(bsdf, "base_metalness") == 1.0) return;
  const Textured weight =
      scalar(*specular, "specularFactor", 1, "specularTexture", TextureUse::opacity);
  if (is_zero(weight) && !transmits()) {
    set_number(bsdf, "specular_ior", 1);
    return;
  }
  const std::vector<double> given = file_.numbers(*specular, "specularColorFactor", {1, 1, 1});
  Textured tint;
  tint.factor = {std::max(0.0, given[0]), std::max(0.0, given[1]), std::max(0.0, given[2])};
  const double most = std::max(largest_of(tint.factor), transmits() ? 1.0 : 1e-9);
  if (const JsonValue* info = specular->find("specularColorTexture"))
    tint.texture = textures_.texture(*info, TextureUse::color);
  tint.factor = over(tint.factor, most);
  if (most != 1)
    set_number(bsdf, "specular_ior", ior_reflecting(std::min(1.0, normal_reflectance() * most)));
  give_value(bsdf, "specular_weight", weight, true);
  give_value(bsdf, "specular_color", tint, false);
  const bool is_usual =
      !weight.texture && weight.factor.r == 1 && !tint.texture && tint.factor == Rgb{1, 1, 1};
  if (!is_usual)
    approximated(
        "its specular factor acts straight on alone, and its specular colour toward the edge, too");
  if (number_in(bsdf, "base_metalness") != 0.0)
    approximated("its specular factors change its metal, too");
}

/// The share that its index makes it reflect straight on. An index of 0 stands for all light.
double MaterialReader::normal_reflectance() const {
  const JsonValue* given = extension("KHR_materials_ior");
  if (given && file_.number(*given, "ior", 1.5) == 0) return 1;
  const double root = (ior() - 1) / (ior() + 1);
  return root * root;
}

void MaterialReader::read_transmission(Object& bsdf) {
  if (!transmits()) return;
  give_value(bsdf, "transmission_weight",
             scalar(*extension("KHR_materials_transmission"), "transmissionFactor", 0,
                    "transmissionTexture", TextureUse::red),
             true);
  give_value(bsdf, "transmission_color", base_color(), false);
  if (!is_solid()) give(bsdf, "geometry_thin_walled", true);
}

/// Its coat does not darken what is beneath it, and has the index 1.5.
void MaterialReader::read_clearcoat(Object& bsdf) {
  const JsonValue* coat = extension("KHR_materials_clearcoat");
  if (!coat) return;
  const Textured weight = scalar(*coat, "clearcoatFactor", 0, "clearcoatTexture", TextureUse::red);
  if (is_zero(weight)) return;
  give_value(bsdf, "coat_weight", weight, true);
  give_value(
      bsdf, "coat_roughness",
      scalar(*coat, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", TextureUse::green),
      true);
  constexpr double coat_ior = 1.5;
  give(bsdf, "coat_ior", coat_ior);
  give(bsdf, "coat_darkening", 0.0);
  // In glTF the base reflects beneath the coat as it does in air, here by its index over the
  // coat's.
  if (!transmits() && !weight.texture && weight.factor.r == 1)
    set_number(bsdf, "specular_ior",
               std::min(100.0, coat_ior * number_in(bsdf, "specular_ior").value_or(coat_ior)));
  const JsonValue *own = coat->find("clearcoatNormalTexture"),
                  *base = material_.find("normalTexture");
  const auto index = [&](const JsonValue* info) {
    return info ? file_.count(*info, "index") : std::nullopt;
  };
  if (index(own) != index(base)) approximated("its coat has the normals of its base");
}

void MaterialReader::read_sheen(Object& bsdf) {
  const JsonValue* sheen = extension("KHR_materials_sheen");
  if (!sheen) return;
  const Textured tint = color(*sheen, "sheenColorFactor", 0, "sheenColorTexture");
  if (is_zero(tint)) return;
  // What is beneath loses what the largest part of the colour reflects.
  const double most = largest_of(tint.factor);
  Textured share = tint;
  share.factor = over(tint.factor, most);
  give(bsdf, "fuzz_weight", most);
  give_value(bsdf, "fuzz_color", share, false);
  Textured roughness =
      scalar(*sheen, "sheenRoughnessFactor", 0, "sheenRoughnessTexture", TextureUse::opacity);
  // The width of the distribution is the square in glTF, and the roughness itself here.
  const double width = roughness.factor.r * roughness.factor.r;
  roughness.factor = {width, width, width};
  give_value(bsdf, "fuzz_roughness", roughness, true);
  if (tint.texture || roughness.texture)
    approximated("what is beneath its sheen is as dark everywhere as its factors make it");
}

/// glTF widens the facets along the tangent; `openpbr` keeps the product of both slopes and makes
/// their ratio 1 − 0.9 a, as Burley.
void MaterialReader::read_anisotropy(Object& bsdf) {
  const JsonValue* anisotropy = extension("KHR_materials_anisotropy");
  if (!anisotropy) return;
  const double strength = unit(*anisotropy, "anisotropyStrength", 0);
  if (strength == 0) return;
  const double turned =
      std::remainder(file_.number(*anisotropy, "anisotropyRotation", 0), std::numbers::pi);
  if (std::fabs(turned) > 1e-3 || anisotropy->find("anisotropyTexture"))
    approximated("its highlights are stretched along u alone, evenly");
  const auto roughness = number_in(bsdf, "specular_roughness");
  if (!roughness) {
    approximated("its roughness has a texture: its highlights are stretched, and not widened");
    give(bsdf, "specular_roughness_anisotropy", strength * strength);
    return;
  }
  const double across = std::max(*roughness * *roughness, 1e-4);
  const double along = across + (1 - across) * strength * strength;
  remove_property(bsdf, "specular_roughness");
  give(bsdf, "specular_roughness", std::pow(across * along, 0.25));
  give(bsdf, "specular_roughness_anisotropy", std::min(1.0, (1 - across / along) / 0.9));
}

/// A sheet whose share of skin lets all light through that it scatters.
void MaterialReader::read_diffuse_transmission(Object& bsdf) {
  const JsonValue* through = extension("KHR_materials_diffuse_transmission");
  if (!through) return;
  const Textured share = scalar(*through, "diffuseTransmissionFactor", 0,
                                "diffuseTransmissionTexture", TextureUse::opacity);
  if (is_zero(share)) return;
  if (transmits()) {
    ignored("it lets light through clearly: its diffuse transmission is not rendered");
    return;
  }
  give_value(bsdf, "subsurface_weight", share, true);
  give_value(
      bsdf, "subsurface_color",
      color(*through, "diffuseTransmissionColorFactor", 1, "diffuseTransmissionColorTexture"),
      false);
  give(bsdf, "subsurface_scatter_anisotropy", 1.0);
  give(bsdf, "geometry_thin_walled", true);
}

/// The archived model: straight on it reflects its specular colour.
void MaterialReader::read_specular_glossiness(Object& bsdf, const JsonValue& given) {
  const Textured specular = color(given, "specularFactor", 1, "specularGlossinessTexture");
  const double most = largest_of(specular.factor);
  give_value(bsdf, "base_color", base_color(), false);
  give(bsdf, "base_metalness", 0.0);
  give(bsdf, "specular_ior", ior_reflecting(most));
  if (most > 0) {
    Textured tint = specular;
    tint.factor = over(specular.factor, most);
    give_value(bsdf, "specular_color", tint, false);
  }
  give(bsdf, "specular_roughness", 1 - unit(given, "glossinessFactor", 1));
  if (given.find("specularGlossinessTexture"))
    approximated("its glossiness is the same everywhere, without the texture");
}

}  // namespace kaustik::gltf
