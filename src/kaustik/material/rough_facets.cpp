#include "kaustik/material/rough_facets.h"

namespace kaustik {
namespace {

/// The row of a roughness; `name` is alpha, alpha_u or alpha_v.
Parameter alpha_parameter(const std::string& name, const std::string& sentence) {
  return number_parameter(name, 0.1, sentence)
      .range(0, RoughFacets::largest_alpha)
      .textured();
}

}  // namespace

Parameter distribution_parameter() {
  return choice_parameter("distribution", "beckmann", {"beckmann", "ggx"},
                          "Distribution of the normals of the microscopic facets.");
}

Parameter sample_visible_parameter() {
  return boolean_parameter("sample_visible", true,
                           "No effect: facets that can be seen are always the ones sampled.");
}

RoughFacets::Kind facet_kind_of(const Arguments& arguments) {
  return arguments.text("distribution") == "ggx" ? RoughFacets::Kind::ggx
                                                 : RoughFacets::Kind::beckmann;
}

std::vector<Parameter> rough_facets_parameters() {
  return {distribution_parameter(),
          alpha_parameter("alpha", "Roughness; about the root mean square slope of the facets."),
          optional(alpha_parameter("alpha_u", "Roughness along the tangent, instead of alpha.")),
          optional(alpha_parameter("alpha_v", "Roughness across the tangent, instead of alpha.")),
          sample_visible_parameter()};
}

RoughFacets rough_facets_of(const BsdfInputs& inputs) {
  const Arguments& arguments = inputs.arguments;
  const auto kind = facet_kind_of(arguments);
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
  // Isotropic facets are told by one texture for both.
  if (u->is_constant() && v->is_constant() && u->mean() == v->mean()) v = u;
  return {kind, std::move(u), std::move(v)};
}

}  // namespace kaustik
