// The part of SceneBuilder that takes from the scene before what has not changed.
#include <algorithm>
#include <set>

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

bool names_file(const TypeInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const Parameter& row) { return row.kind == ParameterKind::file; });
}

void collect_shapes_of_files(const Object& object, std::set<const Object*>& seen,
                             std::vector<std::pair<const Object*, const ShapeType*>>& found) {
  if (!seen.insert(&object).second) return;
  const ShapeType* type = object.family == "shape" ? find_row(shape_types(), object.type) : nullptr;
  if (type && names_file(type->info)) found.emplace_back(&object, type);
  for (const Child& child : object.children) collect_shapes_of_files(*child.object, seen, found);
}

}  // namespace

const BuiltParts& SceneBuilder::before() const {
  static const BuiltParts nothing;
  return previous_ ? previous_->built() : nothing;
}

void SceneBuilder::read_meshes(const Object& scene) {
  std::set<const Object*> seen;
  std::vector<std::pair<const Object*, const ShapeType*>> shapes;
  collect_shapes_of_files(scene, seen, shapes);
  std::vector<std::pair<ReadMesh*, const ShapeType*>> jobs;
  std::vector<Arguments> arguments;
  for (const auto& [object, type] : shapes) {
    // The key is asked for before the file is read: it tells when the file changed.
    if (find_part(before().shapes, shape_key(*object, *type))) continue;
    try {
      Problems told_later;
      UnknownParameters unknown;
      Arguments given(type->info, unknown.without_unknown(type->info, object->properties),
                      object->place, told_later);
      if (!given.is_complete()) continue;
      arguments.push_back(std::move(given));
    } catch (const Error&) {
      continue;  // more problems than are told at once
    }
    jobs.emplace_back(&read_meshes_[object], type);
  }
  parallel_blocks(jobs.size(), 1, [&](size_t i, size_t, size_t) {
    ReadMesh& read = *jobs[i].first;
    try {
      read.shape = jobs[i].second->create(arguments[i]);
    } catch (...) {
      read.error = std::current_exception();
    }
  });
}

uint64_t SceneBuilder::shape_key(const Object& object, const ShapeType& type) {
  return takes_heights(type.info) ? keys_.whole(object) : keys_.own(object);
}

uint64_t SceneBuilder::world_key(const Object& scene) {
  uint64_t key = 0;
  for (const Child& child : scene.children)
    if (child.object->family != "sensor" && child.object->family != "integrator")
      key = hash_mix(key, keys_.whole(*child.object));
  for (const Child& child : sensor_->children)
    if (child.object->family == "medium") key = hash_mix(key, keys_.whole(*child.object));
  return key;
}

std::shared_ptr<const Shape> SceneBuilder::shape_of(const Object& object, const ShapeType& type,
                                                    const Arguments& arguments) {
  const uint64_t key = shape_key(object, type);
  std::shared_ptr<const Shape> shape;
  if (const auto* known = find_part(before().shapes, key)) {
    shape = *known;
  } else if (auto read = read_meshes_.extract(&object)) {
    if (read.mapped().error) std::rethrow_exception(read.mapped().error);
    shape = std::move(read.mapped().shape);
    ++counts_.shapes;
  } else {
    shape = type.create(arguments);
    ++counts_.shapes;
  }
  built_.shapes.emplace(key, shape);
  return shape;
}

uint64_t SceneBuilder::key_on(const Object& object, const BuiltShape* on) {
  const uint64_t key = keys_.whole(object);
  return on && asks_surface(object) ? hash_mix(key, keys_.own(*on->object)) : key;
}

std::shared_ptr<const Texture> SceneBuilder::texture_of(const Object& object,
                                                        const TextureType& type,
                                                        const TextureInputs& inputs,
                                                        const BuiltShape* on) {
  const uint64_t key = key_on(object, on);
  BuiltParts::MadeTexture made;
  const auto* known = find_part(before().textures, key);
  if (known && pictures_.account(known->pictures)) {
    made = *known;
  } else {
    const PictureReader::Mark mark = pictures_.mark();
    made.texture = type.create(inputs);
    made.pictures = pictures_.use_since(mark);
    ++counts_.textures;
  }
  built_.textures.emplace(key, made);
  return made.texture;
}

std::shared_ptr<const Bsdf> SceneBuilder::bsdf_of(const Object& object, const BsdfType& type,
                                                  const BsdfInputs& inputs, const BuiltShape* on) {
  const uint64_t key = key_on(object, on);
  std::shared_ptr<const Bsdf> bsdf;
  if (const auto* known = find_part(before().bsdfs, key)) {
    bsdf = *known;
  } else {
    bsdf = type.create(inputs);
    ++counts_.bsdfs;
  }
  built_.bsdfs.emplace(key, bsdf);
  return bsdf;
}

std::shared_ptr<const Volume> SceneBuilder::volume_of(const Object& object, const VolumeType& type,
                                                      const Arguments& arguments) {
  const uint64_t key = keys_.whole(object);
  std::shared_ptr<const Volume> volume;
  if (const auto* known = find_part(before().volumes, key)) {
    volume = *known;
  } else {
    volume = type.create(arguments);
    ++counts_.volumes;
  }
  built_.volumes.emplace(key, volume);
  return volume;
}

void SceneBuilder::make_light(const LightType& type, const PendingLight& pending,
                              const Arguments& arguments) {
  const std::shared_ptr<const EmissionPattern> pattern =
      emission_pattern_of(type, pending, arguments);
  const uint64_t key = keys_.light(*pending.object, pending.shape_index);
  BuiltParts::MadeLight made{.light = nullptr,
                             .shape = pending.shape,
                             .scene_bounds = bounds_,
                             .tables = nullptr,
                             .pictures = {}};
  const auto* known = find_part(before().lights, key);
  const bool is_known = known && pictures_.account(known->pictures);
  if (is_known) {
    made.tables = known->tables;
    made.pictures = known->pictures;
    // Only lights at infinity ask how large the scene is.
    if (known->shape == pending.shape &&
        (!known->light->is_infinite() || known->scene_bounds == bounds_))
      made.light = known->light;
  }
  if (!made.light) {
    static const Transform identity;
    const Transform& to_world =
        type.info.find("to_world") ? arguments.transform("to_world") : identity;
    const PictureReader::Mark mark = pictures_.mark();
    const bool has_tables = made.tables != nullptr;
    made.light = type.create({.arguments = arguments,
                              .to_world = to_world,
                              .shape = pending.shape,
                              .shape_index = pending.shape_index,
                              .scene_bounds = bounds_,
                              .pattern = pattern,
                              .pictures = &pictures_,
                              .tables = &made.tables});
    if (!is_known) made.pictures = pictures_.use_since(mark);
    ++counts_.lights;
    if (made.tables && !has_tables) ++counts_.light_tables;
  }
  lights_.push_back(made.light);
  built_.lights.emplace(key, std::move(made));
}

}  // namespace kaustik
