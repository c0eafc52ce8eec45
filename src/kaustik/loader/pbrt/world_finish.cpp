// The part of World that makes objects of what was collected.

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/near_names.h"
#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/lights.h"
#include "kaustik/loader/pbrt/shape_areas.h"
#include "kaustik/loader/pbrt/texture_mixes.h"
#include "kaustik/loader/pbrt/world.h"

namespace kaustik::pbrt {

std::shared_ptr<Object> World::masked(const std::shared_ptr<Object>& bsdf, const Input& alpha) {
  const double share = alpha.value ? std::clamp(as_number(*alpha.value).value_or(1), 0.0, 1.0) : -1;
  std::shared_ptr<Object>& mask = masks_[{bsdf.get(), alpha.texture.get(), share}];
  if (mask) return mask;
  mask = described("bsdf", "mask", bsdf->place);
  if (alpha.texture)
    hold(*mask, "opacity", alpha.texture);
  else
    set(*mask, "opacity", share);
  hold(*mask, "", bsdf);
  return mask = without_mixes(mask, "alpha", deviations_);
}

std::shared_ptr<Object> World::emitter_of(const PendingShape& pending) {
  const AreaLight& light = *pending.light;
  const LightTools tools{files_, textures_, spectra_, deviations_};
  Owner by = pending.owner;
  by.object = fmt::format("area light {}", shown(light.type));
  by.space = light.space;
  if (light.parameters.number("power").value_or(-1) > 0) {
    // In pbrt each triangle of a mesh is a lamp of that power.
    auto area = area_of(*pending.shape);
    if (area) *area /= double(pending.lamps);
    if (area && !has_even_parts(*pending.shape, pending.lamps))
      deviations_.approximated(by.object, "faces of unlike areas shine alike, as their mean",
                               pending.shape->place);
    auto emitter = make_area_light(tools, light, by, area);
    light.parameters.tell_unused(by.object, deviations_);
    return emitter;
  }
  std::shared_ptr<Object>& emitter = emitters_[&light];
  if (!emitter) {
    emitter = make_area_light(tools, light, by, std::nullopt);
    light.parameters.tell_unused(by.object, deviations_);
  }
  return emitter;
}

void World::give_light(PendingShape& pending, const MadeMaterial& material, bool is_in_group,
                       bool is_hidden) {
  if (!pending.light) return;
  const std::string object = fmt::format("area light {}", shown(pending.light->type));
  if (is_in_group || material.is_interface) {
    deviations_.ignored(object,
                        is_in_group ? "lamps of objects that are placed are left out"
                                    : "on a surface without a material it is left out",
                        pending.shape->place);
    return;
  }
  auto emitter = emitter_of(pending);
  if (is_hidden) {
    emitter = std::make_shared<Object>(*emitter);
    set(*emitter, "visible", false);
    deviations_.approximated(object, "mirrors show it, which the camera does not see",
                             pending.shape->place);
  }
  hold(*pending.shape, "", std::move(emitter));
}

void World::give_media(PendingShape& pending, const MadeMaterial& material) {
  const MediumSides& media = pending.media;
  std::shared_ptr<Object> inside, outside;
  // The same on both sides is no boundary: what light comes from goes on.
  if (media.is_given && media.inside != media.outside) {
    inside = media_.named(media.inside, media.place);
    outside = media_.named(media.outside, media.place);
  }
  if (!inside) inside = material.interior;
  if (inside) hold(*pending.shape, "interior", inside);
  if (outside) hold(*pending.shape, "exterior", outside);
}

void World::lay_textures(const PendingShape& pending, const MappingSet& mappings,
                         bool is_in_group) {
  for (const size_t index : mappings) {
    if (index == SurfaceMappings::by_uv) continue;
    const SurfaceMapping& mapping = textures_.mappings().at(index);
    const char* reason = nullptr;
    if (mappings.size() > 1)
      reason = "other textures of the surface lie otherwise";
    else if (is_in_group)
      reason = "it is one of an object that is placed";
    else if (!lay_by(mapping, *pending.shape))
      reason = "the reader does not have its vertices";
    if (reason)
      deviations_.approximated(mapping.object,
                               fmt::format("on {} it lies by uv, not by mapping {}: {}",
                                           pending.object, shown(mapping.name), reason),
                               mapping.place);
    else if (mapping.kind != MappingKind::planar)
      deviations_.approximated(
          mapping.object,
          fmt::format("its mapping {} is exact at vertices, and even between them",
                      shown(mapping.name)),
          mapping.place);
  }
}

std::shared_ptr<Object> World::finished(PendingShape& pending, bool is_in_group) {
  if (pending.curves) {
    if (pending.curves->faces.empty()) return nullptr;
    const auto mesh = shape_of(std::move(*pending.curves), pending.shape->place);
    if (pending.is_flipped) set(*mesh, "flip_normals", true);
    pending.shape = mesh;
  }
  const MadeMaterial& material = materials_.made(pending.material);
  MappingSet mappings = material.mappings;
  if (pending.light && pending.light->parameters.has("filename"))
    mappings.insert(SurfaceMappings::by_uv);
  const Textures::Collecting collecting(textures_, mappings);
  const Input alpha = textures_.number(pending.alpha, "alpha", pending.owner);
  const auto share = alpha.value ? as_number(*alpha.value) : std::nullopt;
  const bool is_gone = share && *share <= 0;
  if (is_gone && !pending.light) return nullptr;
  std::shared_ptr<Object> bsdf = material.bsdf;
  if (is_gone)
    bsdf = described("bsdf", "null", pending.shape->place);
  else if (!material.is_interface && alpha.is_given() && !(share && *share >= 1))
    bsdf = masked(bsdf, alpha);
  hold(*pending.shape, "", bsdf);
  lay_textures(pending, mappings, is_in_group);
  give_light(pending, material, is_in_group, is_gone);
  give_media(pending, material);
  return pending.shape;
}

void World::finish_instances(Object& scene) {
  std::map<std::string, std::shared_ptr<Object>> groups;
  for (PendingInstance& instance : instances_) {
    auto [entry, is_new] = groups.try_emplace(instance.group);
    if (is_new) {
      const auto shapes = objects_.find(instance.group);
      if (shapes == objects_.end()) {
        deviations_.missing(fmt::format("object {}", shown(instance.group)),
                            "it is not defined: it is left out", instance.place,
                            did_you_mean(instance.group, names_in(objects_)));
        continue;
      }
      auto group = described("shape", "shapegroup", instance.place);
      group->id = ids_.unused(instance.group);
      for (PendingShape& pending : shapes->second)
        if (auto shape = finished(pending, true)) group->children.push_back({"", shape});
      if (group->children.empty()) continue;
      entry->second = group;
      scene.children.push_back({"", group});
    }
    if (!entry->second) continue;
    auto placed_group = described("shape", "instance", instance.place);
    set(*placed_group, "to_world", instance.to_world);
    hold(*placed_group, "", entry->second);
    scene.children.push_back({"", placed_group});
  }
}

void World::finish(const ViewSettings& view, const std::string& camera_medium,
                   Description& description) {
  if (open_object_)
    throw Error(ErrorKind::input, "an object does not end", "end it by ObjectEnd", view.place);
  const auto scene = described("scene", "", view.place);
  const ViewTools tools{files_, deviations_};
  scene->children.push_back({"", make_integrator(tools, view)});
  auto sensor = make_sensor(tools, view);
  if (auto medium = media_.named(camera_medium, sensor->place)) hold(*sensor, "", medium);
  scene->children.push_back({"", sensor});
  for (PendingLight& light : lights_) {
    if (auto medium = media_.named(light.medium, light.place)) hold(*light.emitter, "", medium);
    scene->children.push_back({"", std::move(light.emitter)});
  }
  for (PendingShape& pending : shapes_)
    if (auto shape = finished(pending, false)) scene->children.push_back({"", std::move(shape)});
  finish_instances(*scene);
  description.scene = scene;
  description.sources.assign(files_.sources().begin(), files_.sources().end());
}

}  // namespace kaustik::pbrt
