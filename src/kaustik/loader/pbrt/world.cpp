#include "kaustik/loader/pbrt/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/loader/pbrt/lights.h"
#include "kaustik/loader/pbrt/upgrade.h"

namespace kaustik::pbrt {
namespace {

std::string object_name(const char* family, const std::string& name) {
  return fmt::format("{} {}", family, shown(name));
}

bool names_textures(const ParameterList& list) {
  return std::ranges::any_of(list.all(), [](const Parameter& p) {
    return p.type == "texture" || p.name == "normalmap" || p.name == "materials";
  });
}

/// What is alike in skies that differ in their portals alone.
std::string sky_key(const ParameterList& list, const Transform& to_world) {
  std::string key;
  for (const Parameter& parameter : list.all()) {
    if (parameter.name == "portal") continue;
    key += fmt::format("{}\n{}\n", parameter.name, parameter.type);
    for (size_t i = 0; i < parameter.number_count(); ++i)
      key += fmt::format("{}\n", parameter.number(i));
    for (const std::string& text : parameter.texts) key += text + '\n';
  }
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) key += fmt::format("{} ", to_world.at(row, column));
  return key;
}

}  // namespace

World::World(SceneFiles& files, Deviations& deviations)
    : files_(files),
      deviations_(deviations),
      spectra_(files, deviations),
      textures_(files, spectra_, deviations),
      materials_(files, textures_, spectra_, ids_, deviations),
      media_(files, spectra_, ids_, deviations),
      textured_materials_{false} {}

void World::become_old() {
  is_old_ = true;
  spectra_.keep_brightness_of_light();
}

Owner World::owner(std::string object, const GraphicsState& state) const {
  return {std::move(object), state.colour_space, sequence_};
}

void World::add_defaults(ParameterList& list, const GraphicsState& state, AttributeKind kind) {
  const auto& defaults = state.attributes[size_t(kind)];
  if (!defaults) return;
  files_.spend(defaults->bytes(), list.place());
  list.add_defaults(*defaults);
}

Transform World::resting(const MovingTransform& transform, const std::string& object,
                         const Place& place) {
  if (transform.is_moving && !(transform.start == transform.end))
    deviations_.approximated(object, "it stands still, where its motion begins", place);
  return transform.start;
}

void World::define_texture(const std::string& name, bool is_float, const std::string& type,
                           ParameterList list, const GraphicsState& state) {
  add_defaults(list, state, AttributeKind::texture);
  Owner by = owner(object_name("texture", name), state);
  ++sequence_;
  textures_.define({name, type, is_float, std::move(list), std::move(by), state.transform.start});
}

size_t World::define_material(const std::string& name, const std::string& type, ParameterList list,
                              const GraphicsState& state) {
  add_defaults(list, state, AttributeKind::material);
  Owner by =
      owner(name.empty() ? fmt::format("material {}", shown(type)) : object_name("material", name),
            state);
  ++sequence_;
  const bool is_textured = names_textures(list);
  const std::string meant = upgraded_material(type, list, by.object, deviations_, is_old_);
  textured_materials_.push_back(is_textured);
  if (!name.empty()) textured_names_[name] = textured_names_[name] || is_textured;
  return materials_.define({name, meant, std::move(list), std::move(by)});
}

MaterialReference World::material_named(const std::string& name, const Place& place) const {
  return {0, name, sequence_, place};
}

bool World::may_be_textured(const MaterialReference& material) const {
  if (material.name.empty()) return textured_materials_[material.index];
  const auto known = textured_names_.find(material.name);
  return known == textured_names_.end() || known->second;
}

void World::define_medium(const std::string& name, const std::string& type, ParameterList list,
                          const GraphicsState& state) {
  add_defaults(list, state, AttributeKind::medium);
  const std::string object = object_name("medium", name);
  const Transform to_world = resting(state.transform, object, list.place());
  media_.define(name, {upgraded_medium(type), std::move(list), owner(object, state), to_world});
  ++sequence_;
}

void World::add_light(const std::string& type, ParameterList list, const GraphicsState& state) {
  add_defaults(list, state, AttributeKind::light);
  const Owner by = owner(object_name("light", type), state);
  upgrade_light(list, by.object, deviations_);
  const Transform to_world = resting(state.transform, by.object, list.place());
  // Through several portals the same sky is seen.
  if (list.has("portal") && !skies_.insert(sky_key(list, to_world)).second) {
    deviations_.approximated(by.object, "of one sky with several portals the first counts",
                             list.place());
    return;
  }
  auto emitter =
      make_light({files_, textures_, spectra_, deviations_, is_old_}, type, list, by, to_world);
  if (!emitter) return;
  list.tell_unused(by.object, deviations_);
  const bool has_place =
      emitter->type != "envmap" && emitter->type != "constant" && emitter->type != "directional";
  lights_.push_back(
      {std::move(emitter), has_place ? state.media.outside : std::string(), list.place()});
}

void World::add_shape(const std::string& type, ParameterList list, const GraphicsState& state) {
  add_defaults(list, state, AttributeKind::shape);
  PendingShape pending;
  pending.object = object_name("shape", type);
  pending.material = state.material;
  pending.light = state.area_light;
  pending.media = state.media;
  pending.owner = owner(pending.object, state);
  pending.alpha = ParameterList(list.place());
  if (const Parameter* alpha = list.find("alpha")) pending.alpha.all().push_back(*alpha);
  if (const Parameter* shadow = list.find("shadowalpha"))
    deviations_.ignored(pending.object, "shadows have the holes of 'alpha' alone", shadow->place);
  const Transform to_world = resting(state.transform, pending.object, list.place());
  const bool is_textured = may_be_textured(state.material) || !pending.alpha.empty() ||
                           (pending.light && pending.light->parameters.has("filename"));
  const ShapeTools tools{{deviations_, pending.object, list.place()},
                         files_,
                         list,
                         to_world,
                         state.reverses_orientation,
                         is_textured};
  pending.is_flipped = state.reverses_orientation;
  if (type == "curve") {
    add_curve_of(tools, std::move(pending));
  } else {
    pending.shape = make_shape(tools, type);
    pending.lamps = tools.lamps;
    if (pending.shape) open_shapes().push_back(std::move(pending));
  }
  list.tell_unused(object_name("shape", type), deviations_);
}

void World::add_curve_of(const ShapeTools& tools, PendingShape pending) {
  Shapes& shapes = open_shapes();
  // Hair is thousands of curves: those alike that follow one another are one mesh.
  const bool joins = !shapes.empty() && shapes.back().curves && pending.alpha.empty() &&
                     shapes.back().alpha.empty() && !pending.light && !shapes.back().light &&
                     shapes.back().material == pending.material &&
                     shapes.back().media == pending.media &&
                     shapes.back().is_flipped == pending.is_flipped;
  if (!joins) {
    pending.curves = std::make_unique<MeshParts>();
    pending.shape = described("shape", "mesh", tools.place());
    shapes.push_back(std::move(pending));
  }
  add_curve(tools, *shapes.back().curves);
}

std::shared_ptr<const AreaLight> World::area_light(const std::string& type, ParameterList list,
                                                   const GraphicsState& state) {
  if (type.empty()) return nullptr;
  add_defaults(list, state, AttributeKind::light);
  upgrade_light(list, object_name("area light", type), deviations_);
  return std::make_shared<const AreaLight>(AreaLight{type, std::move(list), state.colour_space});
}

void World::begin_object(const std::string& name, const Place& place) {
  if (open_object_)
    throw Error(ErrorKind::input, "an object begins in another one",
                "end the other one by ObjectEnd before", place);
  const auto [entry, is_new] = objects_.try_emplace(name);
  if (!is_new)
    deviations_.approximated(object_name("object", name),
                             "it is defined twice: the last one counts", place);
  entry->second.clear();
  open_object_ = &entry->second;
}

void World::end_object(const Place& place) {
  if (!open_object_)
    throw Error(ErrorKind::input, "no object is there to be ended", "begin it by ObjectBegin",
                place);
  open_object_ = nullptr;
}

void World::add_instance(const std::string& name, const Place& place, const GraphicsState& state) {
  const std::string object = object_name("object", name);
  if (open_object_) {
    deviations_.ignored(object, "objects within objects are left out", place);
    return;
  }
  instances_.push_back({name, resting(state.transform, object, place), place});
}

}  // namespace kaustik::pbrt
