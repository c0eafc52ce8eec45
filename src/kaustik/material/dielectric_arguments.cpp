#include "kaustik/material/dielectric_arguments.h"

#include "kaustik/material/fresnel.h"

namespace kaustik {
namespace {

Parameter ior_parameter(const std::string& name, std::string_view usual, const std::string& where) {
  return number_or_name_parameter(name, Value(std::string(usual)), dielectric_names(),
                                  "Index of refraction " + where + ", as a number or a material.")
      .range(0.01, 100);
}

/// Without the Abbe number.
SpectralValue index_of(const Arguments& arguments, std::string_view name) {
  const auto value = arguments.number_or_name(name);
  if (const auto* material = std::get_if<std::string>(&value)) return named_ior(*material);
  return SpectralValue(float(std::get<double>(value)));
}

}  // namespace

std::vector<Parameter> dielectric_ior_parameters(std::string_view usual_interior) {
  return {ior_parameter("int_ior", usual_interior, "inside"),
          ior_parameter("ext_ior", "air", "outside")};
}

Parameter abbe_number_parameter() {
  return optional(number_parameter("abbe_number", 58,
                                   "Dispersion inside in spectral mode: (n_d - 1)/(n_F - n_C), "
                                   "from about 20 (much) to 95 (little). If absent, measured "
                                   "materials have their own, and numbers have none.")
                      .range(1, 1000));
}

Parameter priority_parameter() {
  return optional(integer_parameter(priority_name, 0,
                                    "Makes closed shapes solid bodies. Where two overlap, only the "
                                    "one with the higher priority is there (if equal, the first in "
                                    "the file), and its surface uses the other's index."))
      .range(-1000000, 1000000);
}

SpectralValue dielectric_ior_of(const Arguments& arguments, std::string_view name) {
  const SpectralValue index = index_of(arguments, name);
  const bool may_disperse = name == "int_ior" && arguments.info().find("abbe_number");
  if (!may_disperse || !arguments.has("abbe_number")) return index;
  return ior_by_abbe_number(index.rgb()[0], float(arguments.number("abbe_number")));
}

std::vector<Parameter> dielectric_parameters() {
  std::vector<Parameter> parameters = dielectric_ior_parameters();
  parameters.push_back(abbe_number_parameter());
  parameters.push_back(specular_reflectance_parameter());
  parameters.push_back(specular_transmittance_parameter());
  return parameters;
}

Parameter specular_reflectance_parameter() {
  return color_parameter("specular_reflectance", 1, "Factor on reflected radiance; 1 is physical.")
      .range(0, 1)
      .textured();
}

Parameter specular_transmittance_parameter() {
  return color_parameter("specular_transmittance", 1,
                         "Factor on transmitted radiance; 1 is physical.")
      .range(0, 1)
      .textured();
}

}  // namespace kaustik
