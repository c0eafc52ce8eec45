// The part of SceneBuilder for what fills space: media, phase functions, volumes, who refers to
// them.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "kaustik/base/mixture_weights.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/types_to_come.h"

namespace kaustik {
namespace {

/// Phase functions hold phase functions, each of which is made as often as it is held.
constexpr int maximum_phase_levels = 6;
/// A mixture holds more of them than a blend, and counts for as many levels.
constexpr int levels_of_mixture = 3;
constexpr size_t most_phases_of_mixture = 16;

std::string takes_no_volume(const Object& object, const std::string& name) {
  return fmt::format("{} '{}' takes no volume {}", object.family, object.type,
                     name.empty() ? "without a name" : fmt::format("'{}'", name));
}

std::vector<std::string> volume_parameters(const TypeInfo& info) {
  std::vector<std::string> names;
  for (const Parameter& row : info.parameters)
    if (row.accepts_volume) names.push_back(row.name);
  return names;
}

}  // namespace

std::shared_ptr<const PhaseFunction> SceneBuilder::make_phase_function(const Object& given,
                                                                       int level) {
  const PhaseFunctionType* type = find_row(phase_function_types(), given.type);
  const std::vector<std::string> valid = names_of(phase_function_types());
  if (!type && !is_strict_ && (is_foreign(given, valid) || remedy_for_type_to_come(given)))
    return phase_instead_of(given, level);
  if (!type) {
    unknown_type(given, valid);
    return nullptr;
  }
  const Object object = is_strict_ || type->nested == 0 ? given : with_constant_weight(given);
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

std::shared_ptr<const PhaseFunction> SceneBuilder::phase_instead_of(const Object& object,
                                                                    int level) {
  if (object.type == "mixturephase") return mixture_of_phases(object, level);
  leave_out(object, "an isotropic one stands for it");
  return isotropic_phase_function();
}

std::shared_ptr<const PhaseFunction> SceneBuilder::mixture_of_phases(const Object& mixture,
                                                                     int level) {
  std::vector<const Child*> children;
  for (const Child& child : mixture.children)
    if (child.object->family == "phase") children.push_back(&child);
  if (children.size() > most_phases_of_mixture || level > maximum_phase_levels) {
    problems_.add(children.size() > most_phases_of_mixture
                      ? fmt::format("phase 'mixturephase' holds {} phase functions, more than {}",
                                    children.size(), most_phases_of_mixture)
                      : "phase functions nest too deep",
                  "hold fewer in one another", mixture.place);
    return nullptr;
  }
  if (children.empty()) {
    problems_.add("phase 'mixturephase' holds 0 phase functions", "give it at least one",
                  mixture.place);
    return nullptr;
  }
  const auto given = std::find_if(mixture.properties.begin(), mixture.properties.end(),
                                  [](const Property& p) { return p.name == "weights"; });
  const bool is_given = given != mixture.properties.end();
  const MixtureWeights weights = mixture_weights(is_given ? given->value : Value(std::string()),
                                                 children.size(), "phase functions");
  if (!weights.problem.empty()) {
    problems_.add(weights.problem, weights.remedy, is_given ? given->place : mixture.place);
    return nullptr;
  }
  // The weights count by their shares.
  std::shared_ptr<const PhaseFunction> blend;
  double sum = 0;
  for (size_t i = 0; i < children.size(); ++i) {
    const auto part = make_phase_function(*children[i]->object, level + levels_of_mixture);
    if (!part) return nullptr;
    sum += weights.numbers[i];
    const double share = sum > 0 ? weights.numbers[i] / sum : 0;
    blend = blend ? blended_phase_function(blend, part, float(share)) : part;
  }
  return blend;
}

Object SceneBuilder::with_constant_weight(const Object& phase) {
  Object plain = phase;
  const auto at =
      std::find_if(plain.children.begin(), plain.children.end(), [](const Child& child) {
        return child.object->family == "volume" && child.name == "weight";
      });
  if (at == plain.children.end()) return plain;
  const std::shared_ptr<Object> given = at->object;
  plain.children.erase(at);
  const std::shared_ptr<const Volume> volume = make_volume(given);
  const Rgb* color = volume && !volume->grid() ? std::get_if<Rgb>(&volume->color()) : nullptr;
  if (color)
    plain.properties.push_back({"weight", (color->r + color->g + color->b) / 3, given->place});
  else if (volume && left_out_.insert(given.get()).second)
    unknown_.add(fmt::format("'weight' of phase '{}' takes no volume: it is left out", phase.type),
                 given->place);
  return plain;
}

const std::shared_ptr<Object>* SceneBuilder::volume_instead_of(
    const std::shared_ptr<Object>& volume) {
  const std::vector<std::string> valid = names_of(volume_types());
  if (is_strict_ || find_row(volume_types(), volume->type) ||
      !(is_foreign(*volume, valid) || remedy_for_type_to_come(*volume)))
    return &volume;
  for (const Child& child : volume->children)
    if (child.object->family == "volume") {
      leave_out(*volume, "the volume in it stands for it");
      return volume_instead_of(child.object);
    }
  leave_out(*volume, "it is left out");
  return nullptr;
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
  if (const auto instead = stand_in_for_file(*object, type->info))
    return volume = make_volume(instead);
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
    const bool is_taken = std::find(valid.begin(), valid.end(), child.name) != valid.end();
    if (!is_taken && !is_strict_ && nearest_name(child.name, valid).empty()) {
      if (left_out_.insert(child.object.get()).second)
        unknown_.add(takes_no_volume(object, child.name) + ": it is left out", place);
      continue;
    }
    if (!is_taken) {
      problems_.add(takes_no_volume(object, child.name), suggest(child.name, valid), place);
      continue;
    }
    const std::shared_ptr<Object>* known = volume_instead_of(child.object);
    if (!known) continue;
    const std::shared_ptr<const Volume> volume = make_volume(*known);
    if (!volume) return std::nullopt;
    if (!volumes.try_emplace(child.name, MediumInputs::GivenVolume{volume, place}).second)
      problems_.add(
          fmt::format("{} '{}' has a second volume '{}'", object.family, object.type, child.name),
          "keep one", place);
  }
  return volumes;
}

std::shared_ptr<Object> SceneBuilder::without_emission(const std::shared_ptr<Object>& medium) {
  const auto is_emission = [](const auto& part) { return part.name == "emission"; };
  const auto property =
      std::find_if(medium->properties.begin(), medium->properties.end(), is_emission);
  const auto child = std::find_if(medium->children.begin(), medium->children.end(), is_emission);
  const bool is_property = property != medium->properties.end();
  if (!is_property && child == medium->children.end()) return medium;
  const Place place = is_property ? property->place : child->object->place;
  if (is_strict_)
    problems_.add(
        fmt::format("medium '{}' has 'emission', and media do not glow yet", medium->type),
        "remove it", place);
  else if (left_out_.insert(medium.get()).second)
    unknown_.add(
        fmt::format("media do not glow yet: 'emission' of medium '{}' is left out", medium->type),
        place);
  auto dark = std::make_shared<Object>(*medium);
  std::erase_if(dark->properties, is_emission);
  std::erase_if(dark->children, is_emission);
  return dark;
}

std::shared_ptr<const Medium> SceneBuilder::make_medium(const std::shared_ptr<Object>& given) {
  const auto known = media_.find(given.get());
  if (known != media_.end()) return known->second;
  std::shared_ptr<const Medium>& medium = media_[given.get()];
  const std::shared_ptr<Object> object = without_emission(given);
  const MediumType* type = find_row(medium_types(), object->type);
  if (!type && is_foreign(*object, names_of(medium_types()))) {
    leave_out(*object, "it is left out, and space is empty there");
    return nullptr;
  }
  const auto is_density_left_out = [&](const Child& child) {
    return child.object->family == "volume" && child.name == "sigma_t" &&
           !volume_instead_of(child.object);
  };
  if (type && std::any_of(object->children.begin(), object->children.end(), is_density_left_out)) {
    if (left_out_.insert(given.get()).second)
      unknown_.add(fmt::format("medium '{}' has no density that Kaustik can read: it is left out, "
                               "and space is empty there",
                               object->type),
                   object->place);
    return nullptr;
  }
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
