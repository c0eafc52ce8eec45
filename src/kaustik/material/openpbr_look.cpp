#include "kaustik/material/openpbr_look.h"

#include <cmath>

namespace kaustik {
namespace {

/// Burley's facets have the specification's ratio of roughnesses, 1 − anisotropy, with this …
float burley_anisotropic(float anisotropy) { return std::min(anisotropy, 0.98f) / 0.9f; }
/// … and its mean square with a roughness that is this times as large.
float burley_factor(float anisotropy) {
  if (anisotropy == 0) return 1;
  const float ratio = 1 - std::min(anisotropy, 0.98f);
  return std::pow(2 * ratio / (1 + ratio * ratio), 0.25f);
}

/// Of facets beneath others that light passes twice: variances of slopes add up.
float rougher(float roughness, float above) {
  if (above == 0) return roughness;
  const float sum = sqr(sqr(roughness)) + 2 * sqr(sqr(above));
  return std::pow(std::min(1.0f, sum), 0.25f);
}

Parameter pbr_color(const std::string& name, double usual, const std::string& sentence) {
  return color_parameter(name, usual, sentence).range(0, 1).textured();
}

}  // namespace

std::vector<Parameter> OpenPbrParameters::rows() {
  std::vector<Parameter> rows = {
      share_parameter("base_weight", 1, "Factor on base_color."),
      pbr_color("base_color", 0.8, "Colour of the matt part, and of metal at normal incidence."),
      share_parameter("base_diffuse_roughness", 0,
                      "Roughness of the matt part: 0 is 'diffuse', 1 is like plaster."),
      share_parameter("base_metalness", 0, "Fraction of metal."),
      share_parameter("specular_weight", 1,
                      "Factor on the base's reflectance at normal incidence."),
      pbr_color("specular_color", 1,
                "Factor on the base's specular reflectance. On metal it acts only toward grazing "
                "angles."),
      share_parameter("specular_roughness", 0.3,
                      "Roughness of the base. The slope of its facets is about the square."),
      share_parameter("specular_roughness_anisotropy", 0,
                      "Stretches highlights of the base along the tangent."),
      number_parameter("specular_ior", 1.5, "Index of refraction of the base, relative to outside.")
          .range(0.01, 100),
      share_parameter("transmission_weight", 0, "Fraction of glass in the non-metal part."),
      pbr_color("transmission_color", 1, "Factor on light that passes the surface of the glass."),
      share_parameter("subsurface_weight", 0, "Fraction of skin or wax in the matt part."),
      pbr_color("subsurface_color", 0.8,
                "Colour of skin or wax. Scattered light leaves where it arrives."),
      number_parameter("subsurface_scatter_anisotropy", 0,
                       "For thin-walled sheets: 1 transmits all light that skin or wax scatters, "
                       "−1 reflects it.")
          .range(-1, 1),
      share_parameter("coat_weight", 0, "Fraction of the surface with a coat."),
      pbr_color("coat_color", 1, "Factor on light that passes the coat twice."),
      share_parameter("coat_roughness", 0,
                      "Roughness of the coat. It also makes the base rougher."),
      share_parameter("coat_roughness_anisotropy", 0,
                      "Stretches highlights of the coat along the tangent."),
      number_parameter("coat_ior", 1.6, "Index of refraction of the coat, relative to outside.")
          .range(0.01, 100),
      share_parameter("coat_darkening", 1,
                      "Strength of the darkening of the base by reflection inside the coat."),
      share_parameter("fuzz_weight", 0, "Fraction of the surface with fibres."),
      pbr_color("fuzz_color", 1, "Colour of the fibres."),
      share_parameter("fuzz_roughness", 0.5, "Roughness of the fibres: 0 upright fibres, 1 dust."),
      boolean_parameter(
          "geometry_thin_walled", false,
          "Makes it a thin sheet with two equal sides. Light leaves it where it enters."),
      share_parameter("geometry_opacity", 1, "Fraction of the surface that exists.")};
  for (const char* name :
       {"transmission_depth", "transmission_scatter_anisotropy", "transmission_dispersion_scale",
        "transmission_dispersion_abbe_number", "subsurface_radius", "thin_film_weight",
        "thin_film_thickness", "thin_film_ior", "emission_luminance"})
    rows.push_back(ignored_parameter(name, ParameterKind::number));
  for (const char* name : {"transmission_scatter", "subsurface_radius_scale", "emission_color"})
    rows.push_back(ignored_parameter(name, ParameterKind::color));
  return rows;
}

OpenPbrParameters::OpenPbrParameters(const BsdfInputs& inputs)
    : base_color_(inputs.texture("base_color")),
      specular_color_(inputs.texture("specular_color")),
      transmission_color_(inputs.texture("transmission_color")),
      subsurface_color_(inputs.texture("subsurface_color")),
      coat_color_(inputs.texture("coat_color")),
      fuzz_color_(inputs.texture("fuzz_color")),
      base_weight_(inputs.texture("base_weight")),
      diffuse_roughness_(inputs.texture("base_diffuse_roughness")),
      metalness_(inputs.texture("base_metalness")),
      specular_weight_(inputs.texture("specular_weight")),
      specular_roughness_(inputs.texture("specular_roughness")),
      specular_anisotropy_(inputs.texture("specular_roughness_anisotropy")),
      transmission_(inputs.texture("transmission_weight")),
      subsurface_(inputs.texture("subsurface_weight")),
      coat_(inputs.texture("coat_weight")),
      coat_roughness_(inputs.texture("coat_roughness")),
      coat_anisotropy_(inputs.texture("coat_roughness_anisotropy")),
      coat_darkening_(inputs.texture("coat_darkening")),
      fuzz_(inputs.texture("fuzz_weight")),
      fuzz_roughness_(inputs.texture("fuzz_roughness")),
      base_eta_(float(inputs.arguments.number("specular_ior"))),
      coat_eta_(float(inputs.arguments.number("coat_ior"))),
      forward_(float(inputs.arguments.number("subsurface_scatter_anisotropy"))),
      is_sheet_(inputs.arguments.boolean("geometry_thin_walled")) {
  // No boundary at all has no facets that refract.
  if (base_eta_ == 1) base_eta_ = 1.001f;
}

std::array<const Share*, 14> OpenPbrParameters::shares() const {
  return {&base_weight_,
          &diffuse_roughness_,
          &metalness_,
          &specular_weight_,
          &specular_roughness_,
          &specular_anisotropy_,
          &transmission_,
          &subsurface_,
          &coat_,
          &coat_roughness_,
          &coat_anisotropy_,
          &coat_darkening_,
          &fuzz_,
          &fuzz_roughness_};
}

std::array<const Texture*, 6> OpenPbrParameters::colors() const {
  return {base_color_.get(),       specular_color_.get(), transmission_color_.get(),
          subsurface_color_.get(), coat_color_.get(),     fuzz_color_.get()};
}

SurfaceNeeds OpenPbrParameters::needs() const {
  SurfaceNeeds all = SurfaceNeeds::none;
  for (const Share* share : shares()) all = all | texture_needs({share->texture()});
  for (const Texture* color : colors()) all = all | texture_needs({color});
  const bool is_isotropic = specular_anisotropy_.is_zero() && coat_anisotropy_.is_zero();
  return is_isotropic ? all : all | SurfaceNeeds::tangent;
}

float OpenPbrParameters::mean_anisotropic() const {
  return burley_anisotropic(specular_anisotropy_.mean());
}
float OpenPbrParameters::mean_coat_anisotropic() const {
  return burley_anisotropic(coat_anisotropy_.mean());
}

bool OpenPbrParameters::may_transmit() const {
  const bool has_dielectric = !metalness_.is_constant() || metalness_.at({}) < 1;
  return has_dielectric && (!transmission_.is_zero() || (is_sheet_ && !subsurface_.is_zero()));
}

bool OpenPbrParameters::is_pane(const OpenPbrLook& look) const {
  return is_sheet_ && look.clear() > 0 &&
         kaustik::is_pane(look.roughness, look.anisotropic, base_eta_);
}
bool OpenPbrParameters::may_be_pane() const {
  if (!is_sheet_ || transmission_.is_zero()) return false;
  return !has_constant_surface() || !transmission_.is_constant() || !metalness_.is_constant() ||
         is_pane(at({}));
}

bool OpenPbrParameters::has_constant_layers() const {
  for (const Share* share : {&coat_, &coat_roughness_, &coat_anisotropy_, &fuzz_, &fuzz_roughness_})
    if (!share->is_constant()) return false;
  return true;
}

bool OpenPbrParameters::has_constant_surface() const {
  return has_constant_layers() && specular_weight_.is_constant() &&
         specular_roughness_.is_constant() && specular_anisotropy_.is_constant() &&
         diffuse_roughness_.is_constant();
}

Spectrum OpenPbrParameters::color_at(const BsdfContext& context, const Color& color) {
  return color->is_constant() ? color->eval(context.texture(), context.wavelengths())
                              : context.value_of(*color);
}

OpenPbrLook OpenPbrParameters::at(const BsdfContext& context) const {
  OpenPbrLook look;
  look.white = lanes_from_reflectance(spectrum_from_rgb(1, 1, 1), context.wavelengths());
  look.base_color = color_at(context, base_color_) * base_weight_.at(context);
  look.specular_color = color_at(context, specular_color_);
  look.transmission_color = color_at(context, transmission_color_);
  look.subsurface_color = color_at(context, subsurface_color_);
  look.coat_color = color_at(context, coat_color_);
  look.fuzz_color = color_at(context, fuzz_color_);
  look.diffuse_roughness = diffuse_roughness_.at(context);
  look.metalness = metalness_.at(context);
  look.specular_weight = specular_weight_.at(context);
  look.transmission = transmission_.at(context);
  look.subsurface = subsurface_.at(context);
  look.coat = coat_.at(context);
  look.coat_darkening = coat_darkening_.at(context);
  look.fuzz = fuzz_.at(context);
  look.fuzz_roughness = fuzz_roughness_.at(context);
  const float roughness = specular_roughness_.at(context),
              coat_roughness = coat_roughness_.at(context);
  // Light passes the coat twice.
  const float beneath_coat = rougher(roughness, look.coat > 0 ? coat_roughness : 0.0f);
  const float anisotropy = specular_anisotropy_.at(context),
              coat_anisotropy = coat_anisotropy_.at(context);
  look.roughness = std::lerp(roughness, beneath_coat, look.coat) * burley_factor(anisotropy);
  look.anisotropic = burley_anisotropic(anisotropy);
  look.coat_roughness = coat_roughness * burley_factor(coat_anisotropy);
  look.coat_anisotropic = burley_anisotropic(coat_anisotropy);
  return look;
}

}  // namespace kaustik
