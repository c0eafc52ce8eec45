// Materials of pbrt that Kaustik has no like of, and those that fill a body.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/materials.h"
#include "kaustik/loader/pbrt/media.h"

namespace kaustik::pbrt {
namespace {

/// Absorption in a hair by its pigments, 1 over its diameter (d'Eon et al., "An Energy-Conserving
/// Hair Reflectance Model", EGSR 2011).
Rgb absorption_of_pigments(double eumelanin, double pheomelanin) {
  return {eumelanin * 0.419 + pheomelanin * 0.187, eumelanin * 0.697 + pheomelanin * 0.4,
          eumelanin * 1.37 + pheomelanin * 1.05};
}

/// The colour that much hair of an absorption has (Chiang et al., "A Practical and Controllable
/// Hair and Fur Model for Production Path Tracing", CGF 2016, the inverse of its fit).
double colour_of_hair(double absorption, double beta) {
  const double b2 = beta * beta;
  const double fit = 5.969 - 0.215 * beta + 2.532 * b2 - 10.73 * b2 * beta + 5.574 * b2 * b2 +
                     0.245 * b2 * b2 * beta;
  return std::exp(-std::sqrt(std::max(absorption, 0.0)) * fit);
}

/// Single-scattering albedo of a medium whose surface has that colour, under light that is diffuse
/// (Chiang et al., "Practical and Controllable Subsurface Scattering for Production Path Tracing",
/// SIGGRAPH 2016 Talks).
double scattered_share_of(double colour) {
  const double a = std::clamp(colour, 0.0, 1.0);
  return 1 - std::exp(-5.09406 * a + 2.61188 * a * a - 4.31805 * a * a * a);
}
template <typename Function>
Rgb map_colour(const Rgb& c, const Function& function) {
  return {function(c.r), function(c.g), function(c.b)};
}

}  // namespace

std::shared_ptr<Object> make_hair(const MaterialTools& tools) {
  const ParameterList& list = tools.list();
  list.accept({"alpha", "beta_n", "scale"});
  const double beta = std::clamp(list.number("beta_m", 0.3), 0.01, 1.0);
  Input colour = tools.textures.colour(list, "reflectance", tools.owner());
  if (!colour.is_given()) colour = tools.textures.colour(list, "color", tools.owner());
  if (!colour.is_given()) {
    const auto given = tools.spectra.read(list, "sigma_a", SpectrumUse::coefficient, tools.owner());
    const bool has_pigments = list.has("eumelanin") || list.has("pheomelanin");
    const Rgb pigments = absorption_of_pigments(list.number("eumelanin", has_pigments ? 0 : 1.3),
                                                list.number("pheomelanin", 0));
    const Rgb absorption = given ? as_colour(*given).value_or(pigments) : pigments;
    colour.value = Rgb{colour_of_hair(absorption.r, beta), colour_of_hair(absorption.g, beta),
                       colour_of_hair(absorption.b, beta)};
  }
  tools.approximated("hair is rendered as a glossy coat over its colour");
  auto bsdf = described("bsdf", "roughplastic", tools.place());
  set(*bsdf, "diffuse_reflectance", colour);
  set(*bsdf, "distribution", std::string("ggx"));
  set(*bsdf, "alpha", beta);
  set(*bsdf, "int_ior", std::clamp(index_of(tools, "eta", 1.55), 0.01, 100.0));
  set(*bsdf, "ext_ior", 1.0);
  return two_sided(bsdf);
}

std::shared_ptr<Object> make_disney(const MaterialTools& tools) {
  const ParameterList& list = tools.list();
  auto bsdf = described("bsdf", "principled", tools.place());
  const Input colour = tools.textures.colour(list, "color", tools.owner());
  set(*bsdf, "base_color", colour.is_given() ? colour : Input{0.5, nullptr});
  const std::pair<const char*, const char*> numbers[] = {{"metallic", "metallic"},
                                                         {"roughness", "roughness"},
                                                         {"speculartint", "spec_tint"},
                                                         {"anisotropic", "anisotropic"},
                                                         {"sheen", "sheen"},
                                                         {"sheentint", "sheen_tint"},
                                                         {"clearcoat", "clearcoat"},
                                                         {"clearcoatgloss", "clearcoat_gloss"},
                                                         {"spectrans", "spec_trans"},
                                                         {"flatness", "flatness"}};
  bool transmits = false;
  for (const auto& [name, ours] : numbers) {
    Input number = tools.textures.number(list, name, tools.owner());
    if (!number.is_given()) continue;
    if (number.value) change_numbers(*number.value, [](double v) { return std::clamp(v, 0., 1.); });
    set(*bsdf, ours, number);
    transmits |= std::string_view(name) == "spectrans";
  }
  set(*bsdf, "eta", std::clamp(index_of(tools, "eta", 1.5), 0.01, 100.0));
  if (list.flag("thin", false) || list.has("difftrans") || list.has("scatterdistance"))
    tools.approximated("it is no thin sheet, and light does not spread below its surface");
  return transmits ? bsdf : two_sided(bsdf);
}

MadeMaterial make_subsurface(const MaterialTools& tools) {
  const ParameterList& list = tools.list();
  MadeMaterial made;
  const Input colour = tools.textures.colour(list, "reflectance", tools.owner());
  if (colour.texture) {
    // A medium is alike everywhere: the picture of a skin counts more than how deep light goes.
    list.accept({"mfp", "scale", "g", "sigma_a", "sigma_s", "name"});
    tools.approximated("light does not spread below its surface, whose colours lie under a coat");
    made.bsdf = make_coated_diffuse(tools, 1.33);
    return made;
  }
  made.bsdf = make_dielectric(tools);
  for (Property& property : made.bsdf->properties)
    if (property.name == "int_ior" && !list.has("eta")) property.value = 1.33;
  auto medium = described("medium", "homogeneous", tools.place());
  const double scale = list.number("scale", 1);
  const std::string name = list.text("name"), substance = substance_named(name);
  if (!name.empty() && substance.empty())
    tools.deviations.missing(tools.owner().object,
                             fmt::format("there is no substance {}", shown(name)),
                             list.place_of("name"), substance_suggestion(name));
  const auto read = [&](const char* parameter) {
    return tools.spectra.read(list, parameter, SpectrumUse::coefficient, tools.owner());
  };
  const auto absorption = read("sigma_a"), scattering = read("sigma_s");
  if (!substance.empty()) {
    set(*medium, "material", substance);
    set(*medium, "scale", scale);
  } else if (colour.is_given() && !absorption) {
    const Rgb seen = as_colour(*colour.value).value_or(Rgb{.5, .5, .5});
    const Rgb path = as_colour(read("mfp").value_or(1.0)).value_or(Rgb{1, 1, 1});
    const auto extinction = [](double mfp) { return 1 / std::max(mfp, 1e-6); };
    set(*medium, "albedo", map_colour(seen, scattered_share_of));
    set(*medium, "sigma_t", map_colour(path, extinction));
    set(*medium, "scale", scale);
  } else {
    // Per millimetre, of pbrt's defaults.
    set(*medium, "sigma_a", absorption.value_or(Rgb{.0011, .0024, .014}));
    set(*medium, "sigma_s", scattering.value_or(Rgb{2.55, 3.21, 3.77}));
    set(*medium, "scale", scale);
  }
  const double g = std::clamp(list.number("g", 0), -0.999, 0.999);
  if (g != 0) {
    auto phase = described("phase", "hg", tools.place());
    set(*phase, "g", g);
    hold(*medium, "", phase);
  }
  made.interior = medium;
  tools.approximated(
      "light walks through a medium below its surface, which has to be closed, not by a profile");
  return made;
}

}  // namespace kaustik::pbrt
