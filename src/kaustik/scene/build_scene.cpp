#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "kaustik/scene/placed_scenes.h"
#include "kaustik/scene/scene.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

void collect_integrators_of_shapes(const Object& object, std::set<const Object*>& found,
                                   std::set<const Object*>& visited) {
  if (!visited.insert(&object).second) return;
  for (const Child& child : object.children) {
    if (child.object->family == "integrator" && object.family == "shape")
      found.insert(child.object.get());
    collect_integrators_of_shapes(*child.object, found, visited);
  }
}

std::set<const Object*> integrators_of_shapes(const Object& scene) {
  std::set<const Object*> found, visited;
  collect_integrators_of_shapes(scene, found, visited);
  return found;
}

std::vector<std::shared_ptr<Object>> integrators_of_top(const Description& description) {
  std::vector<std::shared_ptr<Object>> at_top;
  for (const Child& child : description.scene->children)
    if (child.object->family == "integrator") at_top.push_back(child.object);
  return at_top;
}

/// Of an integrator, or one within it.
bool says_to_hide_emitters(const Object& integrator, std::set<const Object*>& visited) {
  if (!visited.insert(&integrator).second) return false;
  for (const Property& property : integrator.properties) {
    if (property.name != "hide_emitters") continue;
    const auto* given = std::get_if<bool>(&property.value);
    const auto* typed = std::get_if<Untyped>(&property.value);
    if ((given && *given) || (typed && typed->text == "true")) return true;
  }
  return std::any_of(integrator.children.begin(), integrator.children.end(),
                     [&](const Child& child) {
                       return child.object->family == "integrator" &&
                              says_to_hide_emitters(*child.object, visited);
                     });
}

/// Whether the scene's integrator says so; integrators of shapes do not count.
bool hides_emitters(const Description& description) {
  std::vector<std::shared_ptr<Object>> at_top = integrators_of_top(description);
  std::set<const Object*> visited;
  std::erase_if(at_top,
                [&](const auto& object) { return !says_to_hide_emitters(*object, visited); });
  if (at_top.empty()) return false;
  const std::set<const Object*> of_shapes = integrators_of_shapes(*description.scene);
  return std::any_of(at_top.begin(), at_top.end(),
                     [&](const auto& object) { return !of_shapes.contains(object.get()); });
}

std::vector<std::string> places_of(const std::vector<std::shared_ptr<Object>>& objects) {
  std::vector<std::string> places;
  for (const auto& object : objects)
    if (std::string place = text_of(object->place); !place.empty()) places.push_back(place);
  return places;
}

}  // namespace

std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const BuildOptions& options) {
  return build_scene(description, nullptr, options);
}

std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const std::shared_ptr<const Scene>& previous,
                                         const BuildOptions& options) {
  SceneBuilder builder(options.texture_memory_bytes, previous.get(), description.is_strict);
  std::vector<std::string> warnings = description.warnings;
  const Description flat = flatten_placed_scenes(description, warnings);
  if (hides_emitters(description)) builder.hide_lights();
  Scene::Parts parts = builder.build(*flat.scene);
  parts.warnings.insert(parts.warnings.begin(), warnings.begin(), warnings.end());
  parts.observer = options.observer;
  return std::make_shared<const Scene>(std::move(parts), previous.get());
}

std::shared_ptr<Object> find_integrator(const Description& description) {
  const std::vector<std::shared_ptr<Object>> at_top = integrators_of_top(description);
  if (at_top.size() <= 1) return at_top.empty() ? nullptr : at_top[0];
  const std::set<const Object*> of_shapes = integrators_of_shapes(*description.scene);
  std::vector<std::shared_ptr<Object>> of_scene = at_top;
  std::erase_if(of_scene, [&](const auto& object) { return of_shapes.contains(object.get()); });
  if (of_scene.empty())
    throw Error(ErrorKind::input, "the scene has no integrator of its own: shapes refer to each",
                fmt::format("give it one that no shape refers to; the others are here: {}",
                            fmt::join(places_of(at_top), ", ")),
                at_top.back()->place);
  if (of_scene.size() > 1)
    throw Error(ErrorKind::input, "the scene has a second integrator", keep_one(of_scene[0]->place),
                of_scene[1]->place);
  return of_scene[0];
}

std::shared_ptr<Object> own_integrator(Description& description) {
  const auto object = find_integrator(description);
  if (!object || !integrators_of_shapes(*description.scene).contains(object.get())) return object;
  const auto own = std::make_shared<Object>(*object);
  own->id.clear();
  for (Child& child : description.scene->children)
    if (child.object == object) child.object = own;
  return own;
}

}  // namespace kaustik
