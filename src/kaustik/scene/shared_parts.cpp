// The part of SceneBuilder that takes from the scene before what has not changed.
#include "kaustik/scene/scene_builder.h"

namespace kaustik {

const BuiltParts& SceneBuilder::before() const {
  static const BuiltParts nothing;
  return previous_ ? previous_->built() : nothing;
}

std::shared_ptr<const Shape> SceneBuilder::shape_of(const Object& object, const ShapeType& type,
                                                    const Arguments& arguments) {
  const uint64_t key = keys_.own(object);
  std::shared_ptr<const Shape> shape;
  if (const auto* known = find_part(before().shapes, key)) {
    shape = *known;
  } else {
    shape = type.create(arguments);
    ++counts_.shapes;
  }
  built_.shapes.emplace(key, shape);
  return shape;
}

std::shared_ptr<const Texture> SceneBuilder::texture_of(const Object& object,
                                                        const TextureType& type,
                                                        const Arguments& arguments) {
  const uint64_t key = keys_.whole(object);
  BuiltParts::MadeTexture made;
  const auto* known = find_part(before().textures, key);
  if (known && pictures_.account(known->pictures)) {
    made = *known;
  } else {
    const PictureReader::Mark mark = pictures_.mark();
    made.texture = type.create(arguments, pictures_);
    made.pictures = pictures_.use_since(mark);
    ++counts_.textures;
  }
  built_.textures.emplace(key, made);
  return made.texture;
}

std::shared_ptr<const Bsdf> SceneBuilder::bsdf_of(const Object& object, const BsdfType& type,
                                                  const BsdfInputs& inputs) {
  const uint64_t key = keys_.whole(object);
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
      emission_pattern_of(*pending.object, arguments);
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
