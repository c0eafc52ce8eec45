#include "kaustik/integrator/override_integrator.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/scene/overrides.h"

namespace kaustik {
namespace {

/// In Kaustik's words where these are known.
Object in_our_words(const Object& object) {
  if (!find_foreign_integrator(object.type)) return object;
  std::vector<std::string> ignored;
  try {
    return native_integrator(object, ignored, false);
  } catch (const Error&) {
    // It is replaced, whatever is wrong with it.
    return object;
  }
}

bool has_effect(const IntegratorType* type, const std::string& name) {
  const Parameter* parameter = type ? type->info.find(name) : nullptr;
  return parameter && !parameter->no_effect;
}

bool takes(const IntegratorType& type, const Property& property) {
  if (!has_effect(&type, property.name)) return false;
  Problems problems;
  const Arguments arguments(type.info, {property}, property.place, problems);
  return problems.empty();
}

/// Whether it is what the type means.
bool implies(const std::string& type, const std::string& name) {
  const ForeignIntegrator* foreign = find_foreign_integrator(type);
  return foreign &&
         std::ranges::any_of(foreign->implied, [&](const Property& p) { return p.name == name; });
}

}  // namespace

std::string override_integrator(Description& description, const std::string& type,
                                const Place& place) {
  const auto object = made_integrator(description);
  if (object->type == type) return {};
  const Object before = in_our_words(*object);
  const IntegratorType* const old_type = find_integrator_type(before.type);
  const IntegratorType* const new_type =
      find_integrator_type(native_type(Object{"integrator", type, "", {}, {}, {}}));
  std::vector<Property> kept;
  std::vector<std::string> left_out;
  for (const Property& property : before.properties) {
    if (is_implied(property)) continue;
    if (old_type && !has_effect(old_type, property.name)) continue;
    if (new_type && takes(*new_type, property) && !implies(type, property.name))
      kept.push_back(property);
    else if (std::ranges::find(left_out, property.spelling()) == left_out.end())
      left_out.push_back(property.spelling());
  }
  const std::string type_before = object->type;
  object->type = type;
  object->properties = std::move(kept);
  object->children.clear();
  object->place = place;
  if (left_out.empty()) return {};
  return fmt::format("integrator '{}' has no use for what the scene says of its '{}': {}", type,
                     type_before, fmt::join(left_out, ", "));
}

}  // namespace kaustik
