#include "kaustik/integrator/make_integrator.h"
#include "kaustik/integrator/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/surface_models.h"

namespace kaustik {
namespace {

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const IntegratorType& row : integrator_types())
    if (row.is_model) names.push_back(row.info.name);
  return names;
}

/// Of an integrator's type here.
const IntegratorType& type_of(const Object& object, const std::string& native, bool of_surface) {
  if (const IntegratorType* type = find_integrator_type(native)) return *type;
  throw Error(ErrorKind::input, fmt::format("unknown integrator type '{}'", object.type),
              suggest(object.type, of_surface ? model_names() : integrator_names()), object.place);
}

/// What belongs to the picture cannot be said of one surface.
void refuse_what_is_the_scenes(const Arguments& arguments, Problems& problems) {
  for (const char* name : {"components", "samples_per_pass", "hide_emitters"})
    if (arguments.info().find(name) && arguments.given(name))
      problems.add(fmt::format("'{}' in the integrator of a single shape", name),
                   "give it to the scene's integrator: it holds for the whole picture",
                   arguments.place_of(name));
}

void refuse_gauges(const IntegratorType& type, const Scene& scene, const Place& place) {
  if (scene.gauges().empty() || type.knows_gauges) return;
  std::vector<std::string> names;
  for (const IntegratorType& row : integrator_types())
    if (row.knows_gauges) names.push_back(row.info.name);
  throw Error(
      ErrorKind::input,
      fmt::format("integrator '{}' knows nothing of irradiance at points in the air, which the "
                  "camera measures",
                  type.info.name),
      fmt::format("one of these does: {}", fmt::join(names, ", ")), place);
}

/// Several shapes may have such an integrator.
void tell_once(const std::string& warning, std::vector<std::string>& warnings) {
  if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
}

std::unique_ptr<Integrator> create(const Object& given, const Scene& scene, bool of_surface,
                                   bool is_strict, std::vector<std::string>& warnings) {
  std::vector<std::string> notes;
  const Object object = native_integrator(given, notes, is_strict);
  for (const std::string& note : notes) tell_once(note, warnings);
  const IntegratorType& type = type_of(object, object.type, of_surface);
  Problems problems;
  UnknownParameters unknown;
  const Arguments arguments(
      type.info,
      is_strict ? object.properties : unknown.without_unknown(type.info, object.properties),
      object.place, problems);
  for (const Child& child : object.children) {
    if (child.object->family == "integrator" && !is_strict) {
      tell_once(fmt::format("integrator '{}' holds none: '{}' in it is left out", given.type,
                            child.object->type),
                warnings);
      continue;
    }
    if (child.object->family == "sampler" && !is_strict) {
      tell_once(fmt::format("the sampler in integrator '{}' has no effect: put it into the sensor",
                            given.type),
                warnings);
      continue;
    }
    problems.add(fmt::format("integrator '{}' cannot hold a {}", object.type, child.object->family),
                 "remove it", child.object->place);
  }
  if (of_surface) refuse_what_is_the_scenes(arguments, problems);
  problems.throw_if_any();
  for (const std::string& warning : unknown.warnings()) tell_once(warning, warnings);
  std::vector<std::string> ignored;
  for (const Property& property : arguments.ignored())
    ignored.push_back(name_and_place(property, fmt::format("integrator '{}'", object.type)));
  if (!ignored.empty()) tell_once(without_effect(ignored), warnings);
  if (!of_surface) refuse_gauges(type, scene, object.place);
  return type.create(arguments, scene);
}

/// The scene's surfaces by their own models' objects, in the order in which they come.
std::vector<std::pair<const Object*, std::vector<uint32_t>>> own_models(const Scene& scene) {
  std::vector<std::pair<const Object*, std::vector<uint32_t>>> models;
  std::map<const Object*, size_t> known;
  for (uint32_t i = 0; i < scene.surface_count(); ++i) {
    const Object* object = scene.surface(i).illumination.get();
    if (!object) continue;
    const auto [entry, is_new] = known.try_emplace(object, models.size());
    if (is_new) models.push_back({object, {}});
    models[entry->second].second.push_back(i);
  }
  return models;
}

std::unique_ptr<IlluminationModel> create_model(const Object& object, const Scene& scene,
                                                bool is_strict,
                                                std::vector<std::string>& warnings) {
  if (!type_of(object, native_type(object), true).is_model)
    throw Error(ErrorKind::input,
                fmt::format("integrator '{}' cannot belong to a single shape", object.type),
                fmt::format("one of these can: {}", fmt::join(model_names(), ", ")), object.place);
  auto integrator = create(object, scene, true, is_strict, warnings);
  return std::unique_ptr<IlluminationModel>(static_cast<IlluminationModel*>(integrator.release()));
}

}  // namespace

std::unique_ptr<Integrator> make_integrator_alone(const Object& object, const Scene& scene,
                                                  std::vector<std::string>& warnings,
                                                  bool is_strict) {
  return create(object, scene, false, is_strict, warnings);
}

std::unique_ptr<Integrator> make_integrator(const Object& object, const Scene& scene,
                                            std::vector<std::string>& warnings, bool is_strict) {
  auto of_scene = make_integrator_alone(object, scene, warnings, is_strict);
  std::vector<SurfaceModels::Model> of_surfaces;
  for (auto& [own, surfaces] : own_models(scene))
    of_surfaces.push_back({create_model(*own, scene, is_strict, warnings), std::move(surfaces)});
  if (of_surfaces.empty()) return of_scene;
  if (!type_of(object, native_type(object), false).is_model) {
    warnings.push_back(fmt::format(
        "the integrators of single shapes have no effect with integrator '{}'", object.type));
    return of_scene;
  }
  return std::make_unique<SurfaceModels>(
      scene,
      std::unique_ptr<IlluminationModel>(static_cast<IlluminationModel*>(of_scene.release())),
      std::move(of_surfaces));
}

}  // namespace kaustik
