#include "kaustik/scene/scene.h"

#include <algorithm>

#include "kaustik/scene/light_probes.h"
#include "kaustik/scene/media.h"

namespace kaustik {

Scene::Scene(Parts parts) : parts_(std::move(parts)) {
  light_selector_ = std::make_unique<LightSelector>(parts_.lights);
  for (size_t i = 0; i < parts_.lights.size(); ++i)
    if (parts_.lights[i]->is_infinite()) environment_lights_.push_back(int(i));
  has_lights_to_meet_ = std::any_of(
      parts_.lights.begin(), parts_.lights.end(), [](const std::unique_ptr<Light>& light) {
        return light->is_infinite() ? !light->traits().is_delta && !light->traits().is_only_seen
                                    : light->traits().shape >= 0;
      });
  find_media();
  if (parts_.camera) light_selector_->learn(probe_lights(*this));
}

void Scene::find_media() {
  bool separated = false;
  const auto see = [this](const std::shared_ptr<const Medium>& medium) {
    has_media_ |= medium != nullptr;
    has_scattering_ |= medium && medium->scatters();
  };
  see(parts_.camera_medium);
  for (const Surface& surface : parts_.surfaces) {
    see(surface.interior);
    see(surface.exterior);
    separated |= surface.separates_media();
    has_media_ |= surface.traits.is_null;
  }
  parts_.light_media.resize(parts_.lights.size());
  for (const auto& medium : parts_.light_media) see(medium);
  light_media_.assign(parts_.lights.size(), nullptr);
  if (!has_media_) return;
  for (size_t i = 0; i < parts_.lights.size(); ++i) {
    const Light& light = *parts_.lights[i];
    const Surface* surface =
        light.traits().shape >= 0 ? &parts_.surfaces[size_t(light.traits().shape)] : nullptr;
    if (surface && surface->separates_media())
      light_media_[i] = surface->exterior.get();
    else if (parts_.light_media[i])
      light_media_[i] = parts_.light_media[i].get();
    else if (light.is_infinite())
      light_media_[i] = separated ? nullptr : camera_medium();
    else
      light_media_[i] =
          find_medium(*this, light.placed().sample_origin({0.5f, 0.5f}).point, camera_medium());
  }
  if (const std::string message = contradicting_media(*this); !message.empty())
    parts_.warnings.push_back(message);
}

}  // namespace kaustik
