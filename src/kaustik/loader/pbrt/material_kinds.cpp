// What pbrt's materials are made of here, one by one.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/materials.h"

namespace kaustik::pbrt {
namespace {

/// Below it pbrt takes facets as a smooth surface.
constexpr double smooth_slope = 1e-3;

std::optional<double> plain_number(const Input& input) {
  return input.value ? as_number(*input.value) : std::nullopt;
}

/// η of the two sides, where outside is nothing: pbrt knows no air.
void set_indices(Object& bsdf, double inside) {
  set(bsdf, "int_ior", std::clamp(inside, 0.01, 100.0));
  set(bsdf, "ext_ior", 1.0);
}

/// Extinction by which a metal of index 1 reflects a share at normal incidence.
double extinction_of(double reflectance) {
  const double r = std::clamp(reflectance, 0.0, 0.9999);
  return 2 * std::sqrt(r) / std::sqrt(1 - r);
}

/// η and k, or the reflectance, of a metal; names begin with the prefix.
void set_metal(Object& bsdf, const MaterialTools& tools, const std::string& prefix,
               double surroundings) {
  const Input reflectance = tools.textures.colour(tools.list(), "reflectance", tools.owner());
  if (reflectance.texture) {
    hold(bsdf, "reflectance", reflectance.texture);
    tools.approximated("toward grazing angles it reflects as a usual metal of its colour");
    return;
  }
  if (reflectance.value) {
    Value k = *reflectance.value;
    change_numbers(k, [&](double r) { return extinction_of(r) / surroundings; });
    set(bsdf, "eta", 1 / surroundings);
    set(bsdf, "k", std::move(k));
    return;
  }
  const std::string eta_name = prefix + "eta", k_name = prefix + "k";
  const std::string eta_metal = tools.spectra.metal_in(tools.list(), eta_name, tools.owner());
  const std::string k_metal = tools.spectra.metal_in(tools.list(), k_name, tools.owner());
  const bool has_eta = tools.list().has(eta_name), has_k = tools.list().has(k_name);
  std::string metal = !eta_metal.empty() ? eta_metal : k_metal;
  if (metal.empty() && (!has_eta || !has_k)) metal = "cu";
  if (!metal.empty()) {
    const bool is_whole = (has_eta ? eta_metal : std::string("cu")) == metal &&
                          (has_k ? k_metal : std::string("cu")) == metal;
    if (!is_whole)
      tools.approximated(fmt::format("both indices are those of the metal '{}'", metal));
    set(bsdf, "material", metal);
    if (surroundings != 1) set(bsdf, "ext_eta", surroundings);
    return;
  }
  const auto read = [&](const std::string& name) {
    Value value = tools.spectra.read(tools.list(), name, SpectrumUse::coefficient, tools.owner())
                      .value_or(1.0);
    change_numbers(value, [&](double v) { return std::clamp(v / surroundings, 0.0, 1000.0); });
    return value;
  };
  set(bsdf, "eta", read(eta_name));
  set(bsdf, "k", read(k_name));
}

/// What reflects or transmits, times a factor; at most all of it.
Input scaled_share(Input share, double factor, const Place& place) {
  if (share.value)
    change_numbers(*share.value, [&](double v) { return std::clamp(v * factor, 0.0, 1.0); });
  if (!share.texture || factor == 1) return share;
  auto scaled = described("texture", "scale", place);
  set(*scaled, "scale", std::min(factor, 1e6));
  hold(*scaled, "value", share.texture);
  return {{}, scaled};
}

double largest(const Value& value) {
  double most = 0;
  Value copy = value;
  change_numbers(copy, [&](double v) { return most = std::max(most, v), v; });
  return most;
}

/// Of two, channel by channel where they are colours.
double largest_sum(const Value& a, const Value& b) {
  const auto x = as_colour(a), y = as_colour(b);
  if (!x || !y) return largest(a) + largest(b);
  return std::max({x->r + y->r, x->g + y->g, x->b + y->b});
}

}  // namespace

std::shared_ptr<Object> two_sided(std::shared_ptr<Object> bsdf) {
  auto both = described("bsdf", "twosided", bsdf->place);
  hold(*both, "", std::move(bsdf));
  return both;
}

Facets facets_of(const MaterialTools& tools, const std::string& prefix, double otherwise) {
  const ParameterList& list = tools.list();
  const bool takes_root = list.flag("remaproughness", true);
  const auto slope = [&](const std::string& name) {
    return takes_root ? tools.textures.root_of_number(list, prefix + name, tools.owner())
                      : tools.textures.number(list, prefix + name, tools.owner());
  };
  const Input both = slope("roughness");
  Facets facets{slope("uroughness"), slope("vroughness"), false};
  const Input usual =
      both.is_given() ? both : Input{takes_root ? std::sqrt(otherwise) : otherwise, nullptr};
  if (!facets.u.is_given()) facets.u = usual;
  if (!facets.v.is_given()) facets.v = usual;
  const auto is_flat = [](const Input& input) {
    const auto number = plain_number(input);
    return number && *number < smooth_slope;
  };
  facets.is_smooth = is_flat(facets.u) && is_flat(facets.v);
  for (Input* input : {&facets.u, &facets.v})
    if (const auto number = plain_number(*input))
      input->value = std::clamp(*number, smooth_slope, 10.0);
  return facets;
}

void set_facets(Object& bsdf, const Facets& facets) {
  set(bsdf, "distribution", std::string("ggx"));
  const auto u = plain_number(facets.u), v = plain_number(facets.v);
  const bool is_even =
      (u && v && *u == *v) || (facets.u.texture && facets.u.texture == facets.v.texture);
  if (is_even) {
    set(bsdf, "alpha", facets.u);
    return;
  }
  set(bsdf, "alpha_u", facets.u);
  set(bsdf, "alpha_v", facets.v);
}

/// An index of refraction, and how much it depends on the wavelength.
struct Index {
  double yellow;               ///< near 588 nm
  std::optional<double> abbe;  ///< Abbe number; absent: it is the same everywhere, or not known
};

Index index_and_dispersion(const MaterialTools& tools, std::string_view name, double otherwise) {
  const std::string glass = Spectra::name_of(tools.list(), name);
  const auto known = index_of_glass(glass);
  const auto value =
      known ? std::optional<Value>(*known)
            : tools.spectra.read(tools.list(), name, SpectrumUse::coefficient, tools.owner());
  if (!value) return {otherwise, std::nullopt};
  return {number_of_index(*value), known ? abbe_of_glass(glass) : abbe_of_index(*value)};
}

/// For what has one index.
double index_of(const MaterialTools& tools, std::string_view name, double otherwise) {
  const Index index = index_and_dispersion(tools, name, otherwise);
  if (index.abbe)
    tools.approximated("it has one index of refraction, that of yellow light: nothing disperses");
  return index.yellow;
}

/// For glass, which disperses in spectral mode.
void set_glass(Object& bsdf, const MaterialTools& tools) {
  const Index index = index_and_dispersion(tools, "eta", 1.5);
  set_indices(bsdf, index.yellow);
  if (!index.abbe) return;
  set(bsdf, "abbe_number", *index.abbe);
  tools.approximated("an Abbe number tells how its index of refraction depends on the wavelength");
}

std::shared_ptr<Object> make_diffuse(const MaterialTools& tools) {
  auto bsdf = described("bsdf", "diffuse", tools.place());
  tools.list().accept({"sigma"});
  const Input reflectance = tools.textures.colour(tools.list(), "reflectance", tools.owner());
  set(*bsdf, "reflectance", reflectance.is_given() ? reflectance : Input{0.5, nullptr});
  return two_sided(bsdf);
}

std::shared_ptr<Object> make_coated_diffuse(const MaterialTools& tools, double index) {
  const ParameterList& list = tools.list();
  list.accept({"thickness", "g", "maxdepth", "nsamples"});
  const Facets facets = facets_of(tools);
  const Input albedo = tools.textures.colour(list, "albedo", tools.owner());
  const auto scattering = plain_number(albedo);
  const auto* colour = albedo.value ? std::get_if<Rgb>(&*albedo.value) : nullptr;
  if (albedo.is_given() && !(scattering && *scattering == 0) &&
      !(colour && *colour == Rgb{0, 0, 0}))
    tools.approximated("its coat is clear: what scatters in it is left out");
  auto bsdf = described("bsdf", facets.is_smooth ? "plastic" : "roughplastic", tools.place());
  const Input reflectance = tools.textures.colour(list, "reflectance", tools.owner());
  set(*bsdf, "diffuse_reflectance", reflectance.is_given() ? reflectance : Input{0.5, nullptr});
  set(*bsdf, "nonlinear", true);
  set_indices(*bsdf, index_of(tools, "eta", index));
  if (facets.is_smooth) return two_sided(bsdf);
  set(*bsdf, "distribution", std::string("ggx"));
  const auto u = plain_number(facets.u), v = plain_number(facets.v);
  // A coat takes one number.
  constexpr double usual_slope = 0.3;
  if (!u || !v)
    tools.approximated("its coat is evenly rough: its texture of roughness is left out");
  else if (*u != *v)
    tools.approximated("its coat is as rough along u as along v");
  set(*bsdf, "alpha", u && v ? std::sqrt(*u * *v) : u.value_or(v.value_or(usual_slope)));
  return two_sided(bsdf);
}

std::shared_ptr<Object> make_conductor(const MaterialTools& tools) {
  const Facets facets = facets_of(tools);
  auto bsdf = described("bsdf", facets.is_smooth ? "conductor" : "roughconductor", tools.place());
  set_metal(*bsdf, tools, "", 1);
  if (!facets.is_smooth) set_facets(*bsdf, facets);
  return two_sided(bsdf);
}

std::shared_ptr<Object> make_coated_conductor(const MaterialTools& tools) {
  const ParameterList& list = tools.list();
  list.accept({"thickness", "g", "albedo", "maxdepth", "nsamples", "interface.thickness"});
  const Facets of_coat = facets_of(tools, "interface."), of_metal = facets_of(tools, "conductor.");
  const double index = index_of(tools, "interface.eta", 1.5);
  auto metal =
      described("bsdf", of_metal.is_smooth ? "conductor" : "roughconductor", tools.place());
  set_metal(*metal, tools, "conductor.", index);
  if (!of_metal.is_smooth) set_facets(*metal, of_metal);
  auto coat = described("bsdf", of_coat.is_smooth ? "coating" : "roughcoating", tools.place());
  set_indices(*coat, index);
  if (!of_coat.is_smooth) {
    set(*coat, "distribution", std::string("ggx"));
    set(*coat, "alpha", of_coat.u);
  }
  hold(*coat, "", metal);
  tools.approximated("its coat is a layer of Weidlich and Wilkie's, not a walk between layers");
  return two_sided(coat);
}

std::shared_ptr<Object> make_dielectric(const MaterialTools& tools) {
  const Facets facets = facets_of(tools);
  auto bsdf = described("bsdf", facets.is_smooth ? "dielectric" : "roughdielectric", tools.place());
  set_glass(*bsdf, tools);
  if (!facets.is_smooth) set_facets(*bsdf, facets);
  // Those of v3.
  for (const auto& [old_name, name] :
       {std::pair("Kr", "specular_reflectance"), {"Kt", "specular_transmittance"}}) {
    const Input factor = tools.textures.colour(tools.list(), old_name, tools.owner());
    const auto number = plain_number(factor);
    const auto* colour = factor.value ? std::get_if<Rgb>(&*factor.value) : nullptr;
    const bool is_one = (number && *number == 1) || (colour && *colour == Rgb{1, 1, 1});
    if (factor.is_given() && !is_one) set(*bsdf, name, factor);
  }
  return bsdf;
}

std::shared_ptr<Object> make_thin_dielectric(const MaterialTools& tools) {
  auto bsdf = described("bsdf", "thindielectric", tools.place());
  set_glass(*bsdf, tools);
  return bsdf;
}

std::shared_ptr<Object> make_diffuse_transmission(const MaterialTools& tools) {
  auto bsdf = described("bsdf", "thinphong", tools.place());
  const double scale = std::max(tools.list().number("scale", 1), 0.0);
  Input shares[2];
  for (const auto& [name, share] :
       {std::pair("reflectance", &shares[0]), {"transmittance", &shares[1]}}) {
    *share = tools.textures.colour(tools.list(), name, tools.owner());
    if (!share->is_given()) share->value = 0.25;
    *share = scaled_share(*share, scale, tools.place());
  }
  const bool are_plain = shares[0].value && shares[1].value;
  if (const double sum = are_plain ? largest_sum(*shares[0].value, *shares[1].value) : 0; sum > 1) {
    for (Input& share : shares) multiply_value(*share.value, 1 / sum);
    tools.approximated("it reflects and transmits more than all: it is made darker");
  }
  set(*bsdf, "diffuse_reflectance", shares[0]);
  set(*bsdf, "diffuse_transmittance", shares[1]);
  set(*bsdf, "specular_reflectance", 0.0);
  set(*bsdf, "specular_transmittance", 0.0);
  return bsdf;
}

}  // namespace kaustik::pbrt
