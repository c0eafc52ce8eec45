#include "kaustik/scene/scene.h"

namespace kaustik {

Scene::Scene(Parts parts) : parts_(std::move(parts)) {
  light_selector_ = std::make_unique<LightSelector>(parts_.lights);
  for (size_t i = 0; i < parts_.lights.size(); ++i)
    if (parts_.lights[i]->is_infinite()) environment_lights_.push_back(int(i));
}

}  // namespace kaustik
