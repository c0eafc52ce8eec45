// The part of SceneBuilder for what fills space: media, phase functions, volumes, who refers to
// them.
#include <fmt/format.h>

#include <algorithm>

#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

/// Phase functions hold phase functions, each of which is made as often as it is held.
constexpr int maximum_phase_levels = 6;

std::vector<std::string> volume_parameters(const TypeInfo& info) {
  std::vector<std::string> names;
  for (const Parameter& row : info.parameters)
    if (row.accepts_volume) names.push_back(row.name);
  return names;
}

}  // namespace

std::shared_ptr<const PhaseFunction> SceneBuilder::make_phase_function(const Object& object,
                                                                       int level) {
  const PhaseFunctionType* type = find_row(phase_function_types(), object.type);
  if (!type) {
    unknown_type(object, names_of(phase_function_types()));
    return nullptr;
  }
  refuse_children(
      object, type->nested > 0 ? std::vector<std::string>{"phase"} : std::vector<std::string>{});
  const std::vector<const Child*> children = ordered_children(object, "phase");
  if (type->nested > 0 && (children.size() != type->nested || level > maximum_phase_levels)) {
    problems_.add(
        children.size() != type->nested
            ? fmt::format("phase '{}' holds {} phase functions", object.type, children.size())
            : "phase functions nest too deep",
        children.size() != type->nested ? fmt::format("give it {}", type->nested)
                                        : "hold fewer in one another",
        object.place);
    return nullptr;
  }
  const Arguments arguments = arguments_of(type->info, object);
  PhaseFunctionInputs inputs{arguments};
  for (const Child* child : children) {
    if (type->nested == 0) break;
    inputs.nested.push_back(make_phase_function(*child->object, level + 1));
    if (!inputs.nested.back()) return nullptr;
  }
  std::shared_ptr<const PhaseFunction> phase;
  if (arguments.is_complete()) collecting(object.place, [&] { phase = type->create(inputs); });
  return phase;
}

std::shared_ptr<const Volume> SceneBuilder::make_volume(const std::shared_ptr<Object>& object) {
  const auto known = volumes_.find(object.get());
  if (known != volumes_.end()) return known->second;
  std::shared_ptr<const Volume>& volume = volumes_[object.get()];
  const VolumeType* type = find_row(volume_types(), object->type);
  if (!type) {
    unknown_type(*object, names_of(volume_types()));
    return nullptr;
  }
  refuse_children(*object, {});
  const Arguments arguments = arguments_of(type->info, *object);
  if (arguments.is_complete())
    collecting(source_place(arguments), [&] { volume = volume_of(*object, *type, arguments); });
  return volume;
}

std::optional<SceneBuilder::Volumes> SceneBuilder::volumes_of(const Object& object,
                                                              const TypeInfo& info) {
  Volumes volumes;
  const std::vector<std::string> valid = volume_parameters(info);
  for (const Child& child : object.children) {
    if (child.object->family != "volume") continue;
    const Place& place = child.object->place;
    if (std::find(valid.begin(), valid.end(), child.name) == valid.end()) {
      problems_.add(
          fmt::format("{} '{}' takes no volume '{}'", object.family, object.type, child.name),
          child.name == "emission" ? "remove it: media do not glow yet"
                                   : suggest(child.name, valid),
          place);
      continue;
    }
    const std::shared_ptr<const Volume> volume = make_volume(child.object);
    if (!volume) return std::nullopt;
    if (!volumes.try_emplace(child.name, MediumInputs::GivenVolume{volume, place}).second)
      problems_.add(
          fmt::format("{} '{}' has a second volume '{}'", object.family, object.type, child.name),
          "keep one", place);
  }
  return volumes;
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
  refuse_children(*object, {"phase", "volume"});
  std::shared_ptr<const PhaseFunction> phase = isotropic_phase_function();
  int phases = 0;
  for (const Child& child : object->children) {
    if (child.object->family != "phase") continue;
    if (++phases == 2)
      problems_.add("the medium has a second phase function", "keep one", child.object->place);
    phase = make_phase_function(*child.object);
  }
  const Arguments arguments = arguments_of(type->info, *object);
  std::optional<Volumes> volumes = volumes_of(*object, type->info);
  if (phase && volumes)
    collecting(object->place, [&] {
      medium =
          type->create({.arguments = arguments, .phase = phase, .volumes = std::move(*volumes)});
    });
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
