#include "kaustik/material/rough_facets.h"

#include <fmt/format.h>

namespace kaustik {

Parameter alpha_parameter(const std::string& name, const std::string& sentence) {
  return number_parameter(name, 0.1, sentence)
      .range(0, RoughFacets::largest_alpha)
      .clamped()
      .textured();
}

Parameter distribution_parameter() {
  return choice_parameter("distribution", "beckmann", {"beckmann", "ggx", "phong", "as"},
                          "Distribution of the normals of the microscopic facets.");
}

Parameter sample_visible_parameter() {
  return boolean_parameter("sample_visible", true,
                           "No effect: only visible facets are sampled, always.");
}

RoughFacets::Kind facet_kind_of(const BsdfInputs& inputs) {
  const std::string& name = inputs.arguments.text("distribution");
  if (name == "ggx") return RoughFacets::Kind::ggx;
  if (name != "beckmann")
    inputs.warn(fmt::format("distribution '{}' of bsdf '{}' is 'beckmann' of the same alpha here",
                            name, inputs.arguments.info().name));
  return RoughFacets::Kind::beckmann;
}

std::vector<Parameter> rough_facets_parameters() {
  return {distribution_parameter(),
          alpha_parameter("alpha", "Roughness: about the root mean square slope of the facets."),
          optional(alpha_parameter("alpha_u", "Roughness along the tangent, instead of alpha.")),
          optional(alpha_parameter("alpha_v", "Roughness across the tangent, instead of alpha.")),
          sample_visible_parameter()};
}

RoughFacets rough_facets_of(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto kind = facet_kind_of(inputs);
  auto u = inputs.texture("alpha_u"), v = inputs.texture("alpha_v");
  if (!u && !v) {
    auto alpha = inputs.texture("alpha");
    return {kind, alpha, alpha};
  }
  if (arguments.given("alpha"))
    throw Error(ErrorKind::input, "'alpha' is given together with 'alpha_u' or 'alpha_v'",
                "keep alpha or both of the others", arguments.place_of("alpha"));
  if (!u || !v)
    throw Error(ErrorKind::input,
                u ? "'alpha_u' is given without 'alpha_v'" : "'alpha_v' is given without 'alpha_u'",
                "give both, or alpha alone", arguments.place_of(u ? "alpha_u" : "alpha_v"));
  return RoughFacets::of_pair(kind, std::move(u), std::move(v));
}

}  // namespace kaustik
