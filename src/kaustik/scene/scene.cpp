#include "kaustik/scene/scene.h"

#include <algorithm>
#include <string>

#include "kaustik/scene/gauges.h"
#include "kaustik/scene/light_probes.h"
#include "kaustik/scene/media.h"

namespace kaustik {

Scene::Scene(Parts parts, const Scene* previous) : parts_(std::move(parts)) {
  for (size_t i = 0; i < parts_.lights.size(); ++i)
    if (parts_.lights[i]->is_infinite()) environment_lights_.push_back(int(i));
  has_lights_to_meet_ = std::any_of(
      parts_.lights.begin(), parts_.lights.end(), [](const std::shared_ptr<const Light>& light) {
        return light->is_infinite() ? !light->traits().is_delta && !light->traits().is_only_seen
                                    : light->traits().shape >= 0;
      });
  find_hidden_surfaces();
  const std::vector<bool>& hidden = parts_.hidden_lights;
  hides_lights_ = std::find(hidden.begin(), hidden.end(), true) != hidden.end();
  find_media();
  if (parts_.camera && !parts_.camera->gauges().empty()) gauges_ = place_gauges(*this);
  make_light_selector(previous);
}

std::string Scene::light_name(size_t light) const {
  const bool has_name = light < parts_.light_names.size() && !parts_.light_names[light].empty();
  return has_name ? parts_.light_names[light] : "lamp " + std::to_string(light + 1);
}

void Scene::find_hidden_surfaces() {
  const std::span<const BodyPart> parts = tracer().body_parts();
  if (parts.empty()) return;
  for (const Surface& surface : parts_.surfaces) may_let_pass_.push_back(surface.lets_pass());
  for (size_t i = 0; i < parts.size(); ++i)
    may_let_pass_[parts[i].shape] |= may_let_pass_[tracer().shape_count() + i];
}

void Scene::make_light_selector(const Scene* previous) {
  const bool has_same_lights = previous && previous->parts_.lights == parts_.lights;
  if (has_same_lights && probes_lights_like(*previous)) {
    light_selector_ = previous->light_selector_;
    return;
  }
  const std::shared_ptr<LightSelector> selector =
      has_same_lights ? previous->light_selector_->unlearned_copy()
                      : std::make_unique<LightSelector>(parts_.lights);
  parts_.counts.light_selectors = has_same_lights ? 0 : 1;
  light_selector_ = selector;
  if (!parts_.camera) return;
  parts_.counts.light_probings = selector->can_learn() ? 1 : 0;
  selector->learn(probe_lights(*this));
}

/// Whether probe_lights() would learn the same of the same lights.
bool Scene::probes_lights_like(const Scene& other) const {
  const auto lets_through_alike = [](const Surface& a, const Surface& b) {
    return a.lets_pass() == b.lets_pass() && a.traits.transmits == b.traits.transmits;
  };
  return parts_.camera && other.parts_.camera && parts_.built.sensor != 0 &&
         parts_.built.sensor == other.parts_.built.sensor &&
         parts_.tracer->traces_like(*other.parts_.tracer) &&
         std::equal(parts_.surfaces.begin(), parts_.surfaces.end(), other.parts_.surfaces.begin(),
                    other.parts_.surfaces.end(), lets_through_alike);
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
    passes_straight_ |= surface.traits.passes_straight;
  }
  parts_.light_media.resize(parts_.lights.size());
  for (const auto& medium : parts_.light_media) see(medium);
  light_media_.assign(parts_.lights.size(), nullptr);
  if (!has_media_) return;
  for (size_t i = 0; i < parts_.lights.size(); ++i) {
    const Light& light = *parts_.lights[i];
    const Surface* surface = light.traits().surface() >= 0
                                 ? &parts_.surfaces[size_t(light.traits().surface())]
                                 : nullptr;
    if (surface && surface->separates_media())
      light_media_[i] = surface->exterior.get();
    else if (parts_.light_media[i])
      light_media_[i] = parts_.light_media[i].get();
    else if (light.is_infinite() && !light.traits().is_beam())
      light_media_[i] = separated ? nullptr : camera_medium();
    else
      light_media_[i] = find_medium(
          *this, light.sample_emission({0.5f, 0.5f}, {0.5f, 0.5f}, {}).point, camera_medium());
  }
  if (const std::string message = contradicting_media(*this); !message.empty())
    parts_.warnings.push_back(message);
}

}  // namespace kaustik
