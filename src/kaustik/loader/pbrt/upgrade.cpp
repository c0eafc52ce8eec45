#include "kaustik/loader/pbrt/upgrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/pbrt/colour_space.h"

namespace kaustik::pbrt {
namespace {

Parameter* parameter_named(ParameterList& list, std::string_view name) {
  for (Parameter& parameter : list.all())
    if (parameter.name == name) return &parameter;
  return nullptr;
}

void rename(ParameterList& list, std::string_view old_name, std::string_view name) {
  Parameter* parameter = parameter_named(list, old_name);
  if (parameter && !parameter_named(list, name)) parameter->name = name;
}

void remove(ParameterList& list, std::string_view name) {
  std::erase_if(list.all(), [&](const Parameter& p) { return p.name == name; });
}

/// Unless it is there.
void add_number(ParameterList& list, std::string_view name, double value) {
  if (parameter_named(list, name)) return;
  Parameter parameter;
  parameter.type = "float";
  parameter.name = name;
  parameter.place = list.place();
  parameter.numbers = {value};
  parameter.is_used = true;
  list.all().push_back(std::move(parameter));
}

bool is_zero(const Parameter* parameter) {
  return parameter && !parameter->numbers.empty() &&
         std::ranges::all_of(parameter->numbers, [](double v) { return v == 0; });
}

/// The slope of facets that pbrt-v3 and Beckmann's distribution have for a roughness
/// (core/microfacet.h, RoughnessToAlpha): a polynomial of its logarithm.
double slope_of_roughness(double roughness) {
  const double x = std::log(std::max(roughness, 1e-3));
  return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

/// Whether v3 takes it as smooth where it is not rough at all.
bool has_smooth_kind(const std::string& type) {
  return type == "glass" || type == "subsurface" || type == "kdsubsurface";
}

/// Roughness of v4, whose root is the slope, in place of that of v3.
void upgrade_roughness(const std::string& type, ParameterList& list, const std::string& object,
                       Deviations& deviations) {
  if (!list.flag("remaproughness", true)) return;
  std::vector<Parameter*> given;
  for (const std::string_view name : {"roughness", "uroughness", "vroughness"})
    if (Parameter* parameter = parameter_named(list, name)) given.push_back(parameter);
  if (has_smooth_kind(type) && std::ranges::all_of(given, [](auto* p) { return is_zero(p); }))
    return;
  for (Parameter* parameter : given) {
    if (parameter->type == "texture")
      deviations.approximated(
          object,
          fmt::format("the slopes of its facets are the roots of {}, as in pbrt-v4, where "
                      "those of pbrt-v3 are steeper",
                      shown(parameter->name)),
          parameter->place);
    for (double& number : parameter->numbers) number = std::pow(slope_of_roughness(number), 2);
  }
}

/// What v3 took as the default, of what is not given along u or v, too.
void add_roughness(ParameterList& list, double value) { add_number(list, "roughness", value); }

/// A colour as the mean of its parts.
void make_number(ParameterList& list, std::string_view name, const std::string& object,
                 Deviations& deviations) {
  Parameter* parameter = parameter_named(list, name);
  if (!parameter || parameter->type != "rgb" || parameter->numbers.size() != 3) return;
  const std::vector<double> parts = parameter->numbers;
  if (parts[0] != parts[1] || parts[0] != parts[2])
    deviations.approximated(object, fmt::format("{} has no colour", shown(name)), parameter->place);
  parameter->type = "float";
  parameter->numbers = {(parts[0] + parts[1] + parts[2]) / 3};
}

std::string upgraded_uber(ParameterList& list, const std::string& object, Deviations& deviations) {
  const bool has_gloss = !is_zero(parameter_named(list, "Ks"));
  for (const std::string_view name : {"Kr", "Kt", "opacity"})
    if (const Parameter* parameter = parameter_named(list, name);
        parameter && !is_zero(parameter)) {
      const bool is_full =
          name == "opacity" &&
          std::ranges::all_of(parameter->numbers, [](double v) { return v == 1; }) &&
          !parameter->numbers.empty();
      if (!is_full)
        deviations.approximated(object, fmt::format("{} of 'uber' is left out", shown(name)),
                                parameter->place);
    }
  for (const std::string_view name : {"Ks", "Kr", "Kt", "opacity", "index"})
    if (name != "index" || !has_gloss) remove(list, name);
  rename(list, "index", "eta");
  if (has_gloss) {
    add_roughness(list, 0.1);
    return "coateddiffuse";
  }
  for (const std::string_view name : {"roughness", "uroughness", "vroughness", "eta"})
    remove(list, name);
  return "diffuse";
}

std::string upgraded_translucent(ParameterList& list, const std::string& object,
                                 Deviations& deviations) {
  deviations.approximated(object, "it has no gloss, and half of its colour on each side",
                          list.place());
  for (const std::string_view name : {"Ks", "reflect", "transmit", "roughness", "remaproughness"})
    remove(list, name);
  if (const Parameter* colour = parameter_named(list, "reflectance")) {
    Parameter copy = *colour;
    copy.name = "transmittance";
    list.all().push_back(std::move(copy));
    add_number(list, "scale", 0.5);
  }
  return "diffusetransmission";
}

void upgrade_mix(ParameterList& list, const std::string& object, Deviations& deviations) {
  Parameter* first = parameter_named(list, "namedmaterial1");
  Parameter* second = parameter_named(list, "namedmaterial2");
  if (!first || !second || first->texts.empty() || second->texts.empty()) return;
  // There the amount is that of the first one.
  first->texts = {second->texts.front(), first->texts.front()};
  first->name = "materials";
  remove(list, "namedmaterial2");
  make_number(list, "amount", object, deviations);
}

bool is_of_old(const std::string& type) {
  return std::ranges::find(old_materials, type) != old_materials.end();
}

std::string upgraded_type(const std::string& type, ParameterList& list, const std::string& object,
                          Deviations& deviations) {
  rename(list, "bumpmap", "displacement");
  if (type == "mix") {
    upgrade_mix(list, object, deviations);
    return type;
  }
  if (type == "disney" || type == "hair" || type == "fourier" || type == "subsurface") {
    rename(list, "index", "eta");
    return type;
  }
  if (!is_of_old(type)) return type;
  rename(list, type == "mirror" ? "Kr" : "Kd", "reflectance");
  if (type == "matte") {
    if (const Parameter* sigma = parameter_named(list, "sigma"); sigma && !is_zero(sigma))
      deviations.approximated(object, "it is matt without rough facets ('sigma')", sigma->place);
    return "diffuse";
  }
  if (type == "plastic" || type == "substrate") {
    remove(list, "Ks");
    deviations.approximated(
        object, fmt::format("{} of pbrt-v3 is matt under a clear coat", shown(type)), list.place());
    add_roughness(list, 0.1);
    return "coateddiffuse";
  }
  if (type == "uber") return upgraded_uber(list, object, deviations);
  if (type == "translucent") return upgraded_translucent(list, object, deviations);
  if (type == "kdsubsurface") {
    for (const std::string_view name : {"Kr", "Kt"}) remove(list, name);
    rename(list, "index", "eta");
    return "subsurface";
  }
  if (type == "mirror") {
    add_number(list, "reflectance", 0.9);
    return "conductor";
  }
  if (type == "glass") {
    rename(list, "index", "eta");
    return "dielectric";
  }
  add_roughness(list, 0.01);
  return "conductor";
}

}  // namespace

std::string upgraded_material(const std::string& type, ParameterList& list,
                              const std::string& object, Deviations& deviations, bool is_old_file) {
  std::string meant = upgraded_type(type, list, object, deviations);
  if (is_of_old(type) || (is_old_file && type == "subsurface"))
    upgrade_roughness(type, list, object, deviations);
  return meant;
}

void upgrade_light(ParameterList& list, const std::string& object, Deviations& deviations) {
  make_number(list, "scale", object, deviations);
  for (const std::string_view name : {"L", "I"}) {
    Parameter* light = parameter_named(list, name);
    if (!light || light->type != "blackbody" || light->numbers.size() != 2) continue;
    // v3 gives its curve the maximum 1, v4 the luminance 1.
    const double factor =
        light->numbers.back() * luminance(blackbody_curve(light->numbers.front()));
    light->numbers.pop_back();
    add_number(list, "scale", 1);
    if (Parameter* scale = parameter_named(list, "scale"); !scale->numbers.empty())
      scale->numbers.front() *= factor;
  }
}

std::string upgraded_medium(const std::string& type) {
  return type == "heterogeneous" ? "uniformgrid" : type;
}

}  // namespace kaustik::pbrt
