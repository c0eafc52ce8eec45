#include "kaustik/material/plastic_base.h"

#include "kaustik/material/dielectric_arguments.h"

namespace kaustik {

std::vector<Parameter> plastic_parameters() {
  std::vector<Parameter> parameters = {
      color_parameter("diffuse_reflectance", 0.5, "Fraction of light that the base reflects.")
          .range(0, 1)
          .textured(),
      boolean_parameter("nonlinear", false,
                        "Lets multiple reflections inside the coat deepen the colour.")};
  for (Parameter& parameter : dielectric_ior_parameters("polypropylene"))
    parameters.push_back(std::move(parameter));
  parameters.push_back(specular_reflectance_parameter());
  return parameters;
}

float plastic_ratio_of(const Arguments& arguments) {
  return dielectric_ior_of(arguments, "int_ior").rgb()[0] /
         dielectric_ior_of(arguments, "ext_ior").rgb()[0];
}

}  // namespace kaustik
