#include <fmt/format.h>

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

}  // namespace

std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const BuildOptions& options) {
  SceneBuilder builder;
  std::vector<std::string> warnings;
  const Description flat = flatten_placed_scenes(description, warnings);
  Scene::Parts parts = builder.build(*flat.scene);
  parts.warnings.insert(parts.warnings.begin(), warnings.begin(), warnings.end());
  parts.observer = options.observer;
  return std::make_shared<const Scene>(std::move(parts));
}

std::shared_ptr<Object> find_integrator(const Description& description) {
  std::vector<std::shared_ptr<Object>> at_top;
  for (const Child& child : description.scene->children)
    if (child.object->family == "integrator") at_top.push_back(child.object);
  if (at_top.size() > 1) {
    const std::set<const Object*> of_shapes = integrators_of_shapes(*description.scene);
    std::erase_if(at_top, [&](const auto& object) { return of_shapes.contains(object.get()); });
  }
  if (at_top.size() > 1)
    throw Error(ErrorKind::input, "the scene has a second integrator",
                fmt::format("keep one; the first is on line {}", at_top[0]->place.line),
                at_top[1]->place);
  return at_top.empty() ? nullptr : at_top[0];
}

}  // namespace kaustik
