#include <fmt/format.h>

#include "kaustik/scene/scene.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {

std::shared_ptr<const Scene> build_scene(const Description& description,
                                         const BuildOptions& options) {
  SceneBuilder builder;
  Scene::Parts parts = builder.build(*description.scene);
  parts.observer = options.observer;
  return std::make_shared<const Scene>(std::move(parts));
}

std::shared_ptr<Object> find_integrator(const Description& description) {
  std::shared_ptr<Object> found;
  for (const Child& child : description.scene->children) {
    if (child.object->family != "integrator") continue;
    if (found)
      throw Error(ErrorKind::input, "the scene has a second integrator",
                  fmt::format("keep one; the first is on line {}", found->place.line),
                  child.object->place);
    found = child.object;
  }
  return found;
}

}  // namespace kaustik
