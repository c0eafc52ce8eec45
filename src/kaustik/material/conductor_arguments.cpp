#include "kaustik/material/conductor_arguments.h"

#include <optional>

#include "kaustik/material/dielectric_arguments.h"

namespace kaustik {
namespace {

using Color = std::variant<Rgb, SpectralCurve>;

/// A curve as it is, a grey as a constant curve; nothing for other colours.
std::optional<SpectralCurve> as_curve(const Color& color) {
  if (const auto* curve = std::get_if<SpectralCurve>(&color)) return *curve;
  const Rgb& c = std::get<Rgb>(color);
  if (c.r == c.g && c.g == c.b) return SpectralCurve{{{555, c.r}}};
  return std::nullopt;
}

bool is_curve(const Color& color) { return std::holds_alternative<SpectralCurve>(color); }

}  // namespace

std::vector<Parameter> conductor_parameters() {
  return {
      choice_parameter("material", "none", conductor_names(),
                       "Measured metal; 'none' is a perfect mirror."),
      optional(color_parameter(
                   "eta", 0, "Real part of the index of refraction, relative to the surroundings."))
          .range(0, 1000),
      optional(color_parameter("k", 1, "Imaginary part of the index of refraction."))
          .range(0, 1000),
      optional(number_or_name_parameter(
                   "ext_eta", Value(std::string("air")), dielectric_names(),
                   "Mitsuba 0.6: index of the surroundings. eta and k are divided by it."))
          .range(0.01, 100),
      optional(color_parameter(
                   "reflectance", 0.9,
                   "Reflectance at normal incidence, instead of a material or of eta and k."))
          .range(0, 1)
          .textured(),
      optional(color_parameter("edge_tint", 1,
                               "With reflectance: colour of the reflection toward the edge. The "
                               "usual 1 is as much as a metal can reflect."))
          .range(0, 1)
          .textured(),
      specular_reflectance_parameter()};
}

namespace {

SpectralIor given_ior(const Arguments& arguments) {
  const bool has_eta = arguments.given("eta"), has_k = arguments.given("k");
  if (!has_eta && !has_k) return conductor_ior(arguments.text("material"));
  if (arguments.given("material") && arguments.text("material") != "none")
    throw Error(ErrorKind::input, "'material' is given together with 'eta' or 'k'",
                "keep the material or both of 'eta' and 'k'", arguments.place_of("material"));
  if (has_eta != has_k)
    throw Error(ErrorKind::input,
                has_eta ? "'eta' is given without 'k'" : "'k' is given without 'eta'",
                "give both or neither", arguments.place_of(has_eta ? "eta" : "k"));
  const Color eta = arguments.color("eta"), k = arguments.color("k");
  if (is_curve(eta) || is_curve(k)) {
    const auto eta_curve = as_curve(eta), k_curve = as_curve(k);
    if (eta_curve && k_curve) return conductor_ior(*eta_curve, *k_curve);
  }
  SpectralIor ior{SpectralValue::material_constant(eta), SpectralValue::material_constant(k)};
  // The unused lane of RGB mode is that of a perfect mirror, which is finite.
  Spectrum k_rgb = ior.k.rgb();
  k_rgb.set(3, 1);
  ior.k = ior.k.with_rgb(k_rgb);
  // Nothing at all to reflect on (eta 1, k 0) is fine; eta = k = 0 has no value at some angles.
  for (int lane = 0; lane < 3; ++lane)
    if (ior.eta.rgb()[lane] == 0 && ior.k.rgb()[lane] == 0)
      throw Error(ErrorKind::input, "'eta' and 'k' are both 0 in one channel",
                  "use material 'none' for a perfect mirror", arguments.place_of("eta"));
  return ior;
}

/// As given by name, or by eta and k.
bool has_ior(const Arguments& arguments) {
  return (arguments.given("material") && arguments.text("material") != "none") ||
         arguments.given("eta") || arguments.given("k");
}

}  // namespace

MetalFresnel metal_fresnel_of(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto reflectance = inputs.texture("reflectance");
  auto edge = inputs.texture("edge_tint");
  if (!reflectance) {
    if (edge)
      throw Error(ErrorKind::input, "'edge_tint' is given without 'reflectance'",
                  "give both, or reflectance alone", arguments.place_of("edge_tint"));
    const SpectralIor ior = given_ior(arguments);
    if (!arguments.given("ext_eta")) return MetalFresnel(ior);
    const float inverse = 1 / dielectric_ior_of(arguments, "ext_eta").rgb()[0];
    return MetalFresnel(SpectralIor{ior.eta * inverse, ior.k * inverse});
  }
  if (has_ior(arguments) || arguments.given("ext_eta"))
    throw Error(ErrorKind::input,
                "'reflectance' is given together with 'material', 'eta', 'k' or 'ext_eta'",
                "keep the reflectance or the others", arguments.place_of("reflectance"));
  if (!edge) edge = make_constant_texture(SpectralValue(1.0f));
  return {reflectance, std::move(edge)};
}

}  // namespace kaustik
