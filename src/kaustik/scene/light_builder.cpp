// The part of SceneBuilder for lights: which there are, and what they shine with.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kaustik/light/measured_light.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/texture_emission.h"

namespace kaustik {
namespace {

bool takes_texture(const TypeInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const Parameter& row) { return row.accepts_texture; });
}

}  // namespace

void SceneBuilder::find_emitters_of_shapes(const Object& scene) {
  for (const Child& child : scene.children)
    for (const Child& part : child.object->children)
      if (part.object->family == "emitter") emitters_of_shapes_.insert(part.object->id);
}

bool SceneBuilder::is_for_shapes(const Object& emitter) {
  const LightType* type = find_row(light_types(), emitter.type);
  if (!type || !type->needs_shape || emitter.id.empty()) return false;
  if (!emitters_of_shapes_.contains(emitter.id))
    warnings_.push_back(
        fmt::format("emitter '{}' belongs to no shape: it is left out", emitter.id));
  return true;
}

std::shared_ptr<const EmissionPattern> SceneBuilder::emission_pattern_of(
    const LightType& type, const PendingLight& pending, const Arguments& arguments) {
  if (!takes_texture(arguments.info())) {
    textures_of(*pending.object, arguments.info(), nullptr);  // tells what becomes of them
    return nullptr;
  }
  const Object& emitter = *pending.object;
  const BuiltShape* on = pending.shape_index < 0 ? nullptr : &shapes_[size_t(pending.shape_index)];
  if (!on && asks_surface(emitter)) {
    problems_.add(fmt::format("emitter '{}' lies on no mesh whose colours its texture could show",
                              emitter.type),
                  "give it another texture", emitter.place);
    return nullptr;
  }
  const std::optional<Textures> textures = textures_of(emitter, arguments.info(), on);
  if (!textures || textures->empty()) return nullptr;
  const auto& [name, texture] = *textures->begin();
  if (arguments.given(name))
    problems_.add(
        fmt::format("emitter '{}' has '{}' both as a value and as a texture", emitter.type, name),
        "keep one", arguments.place_of(name));
  return std::make_shared<TextureEmission>(texture, type.pattern_is_factor);
}

void SceneBuilder::make_lights() {
  for (PendingLight& pending : pending_lights_) {
    const LightType* type = find_row(light_types(), pending.object->type);
    if (!type) {
      pending.object = emitter_instead_of(pending);
      if (!pending.object) continue;
      type = find_row(light_types(), pending.object->type);
    }
    if (const auto instead = stand_in_for_file(*pending.object, type->info)) {
      pending.object = instead.get();
      type = find_row(light_types(), instead->type);
    }
    std::vector<std::string> families = {"medium"};
    if (takes_texture(type->info) || !is_strict_) families.emplace_back("texture");
    refuse_children(*pending.object, families);
    if (type->needs_shape != (pending.shape != nullptr)) {
      problems_.add(
          type->needs_shape
              ? fmt::format("emitter '{}' stands outside of a shape", pending.object->type)
              : fmt::format("emitter '{}' cannot belong to a shape", pending.object->type),
          type->needs_shape ? "put it into the shape that shines"
                            : "put it at the top of the scene",
          pending.object->place);
      continue;
    }
    if (pending.shape && !pending.shape->can_sample()) {
      problems_.add("this shape cannot be a light: it cannot be sampled by area",
                    "let a mesh or an analytic shape shine instead", pending.object->place);
      continue;
    }
    if (pending.shape && !(pending.shape->area() > 0)) {
      problems_.add("the light's shape has no area", "check its vertices and its to_world",
                    pending.object->place);
      continue;
    }
    const Arguments arguments = arguments_of(type->info, *pending.object);
    if (!arguments.is_complete()) continue;
    collecting(pending.object->place, [&] {
      make_light(*type, pending, arguments);
      if (const auto* measured = dynamic_cast<const MeasuredLight*>(lights_.back().get()))
        for (const std::string& remark : measured->remarks())
          if (remarks_reported_.insert(remark).second) warnings_.push_back(remark);
      // Not all that are pending are made, and no ray meets a beam.
      if (lights_.back()->traits().shape >= 0)
        shapes_[size_t(pending.shape_index)].surface.light = int(lights_.size()) - 1;
      light_media_.push_back(medium_of(*pending.object));
      const std::string& own = pending.object->id;
      light_names_.push_back(
          own.empty() && pending.shape ? shapes_[size_t(pending.shape_index)].object->id : own);
      hidden_lights_.push_back(hides_lights_ ||
                               (type->info.find("visible") && !arguments.boolean("visible")));
    });
  }
}

}  // namespace kaustik
