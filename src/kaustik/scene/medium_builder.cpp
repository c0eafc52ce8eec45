// The part of SceneBuilder for what fills space: media, phase functions, who refers to them.
#include <fmt/format.h>

#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
std::shared_ptr<const PhaseFunction> SceneBuilder::make_phase_function(const Object& object) {
  const PhaseFunctionType* type = find_row(phase_function_types(), object.type);
  if (!type) {
    unknown_type(object, names_of(phase_function_types()));
    return nullptr;
  }
  refuse_children(object, {});
  const Arguments arguments = arguments_of(type->info, object);
  std::shared_ptr<const PhaseFunction> phase;
  collecting(object.place, [&] { phase = type->create(arguments); });
  return phase;
}

std::shared_ptr<const Medium> SceneBuilder::make_medium(const std::shared_ptr<Object>& object) {
  const auto known = media_.find(object.get());
  if (known != media_.end()) return known->second;
  std::shared_ptr<const Medium>& medium = media_[object.get()];
  const MediumType* type = find_row(medium_types(), object->type);
  if (!type) {
    unknown_type(*object, names_of(medium_types()));
    return nullptr;
  }
  refuse_children(*object, {"phase"});
  std::shared_ptr<const PhaseFunction> phase = isotropic_phase_function();
  int phases = 0;
  for (const Child& child : object->children) {
    if (child.object->family != "phase") continue;
    if (++phases == 2)
      problems_.add("the medium has a second phase function", "keep one", child.object->place);
    phase = make_phase_function(*child.object);
  }
  const Arguments arguments = arguments_of(type->info, *object);
  if (phase) collecting(object->place, [&] { medium = type->create({arguments, phase}); });
  return medium;
}

std::shared_ptr<const Medium> SceneBuilder::medium_of(const Object& object) {
  std::shared_ptr<const Medium> medium;
  int count = 0;
  for (const Child& child : object.children) {
    if (child.object->family != "medium") continue;
    if (++count == 2)
      problems_.add(fmt::format("the {} has a second medium", object.family), "keep one",
                    child.object->place);
    medium = make_medium(child.object);
  }
  return medium;
}

void SceneBuilder::read_media(const Object& shape, Surface& surface) {
  for (const Child& child : shape.children) {
    if (child.object->family != "medium") continue;
    if (child.name != "interior" && child.name != "exterior") {
      problems_.add("the shape does not say on which side the medium is",
                    "let the shape hold it under the name 'interior' or 'exterior'",
                    child.object->place);
      continue;
    }
    surface.names_media = true;
    (child.name == "interior" ? surface.interior : surface.exterior) = make_medium(child.object);
  }
}

}  // namespace kaustik
