// The part of SceneBuilder that deals with solid bodies, which overlap: see SolidBodies.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "kaustik/material/dielectric_arguments.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

const Property* find_property(const Object& object, std::string_view name) {
  for (const Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}

const Object* bsdf_with_priority(const Object& object, std::set<const Object*>& seen) {
  if (!seen.insert(&object).second) return nullptr;  // shared by several
  if (object.family == "bsdf" && find_property(object, priority_name)) return &object;
  for (const Child& child : object.children)
    if (child.object->family == "bsdf")
      if (const Object* found = bsdf_with_priority(*child.object, seen)) return found;
  return nullptr;
}

/// The bsdf in an object that has a priority: the object itself, or one that it holds; null: none.
const Object* bsdf_with_priority(const Object& object) {
  std::set<const Object*> seen;
  return bsdf_with_priority(object, seen);
}

/// What is no number was told when the bsdf was made.
double priority_of(const Object& bsdf) {
  const Property& property = *find_property(bsdf, priority_name);
  if (const auto* integer = std::get_if<int64_t>(&property.value)) return double(*integer);
  if (const auto* number = std::get_if<double>(&property.value)) return *number;
  return 0;
}

using Copies = std::map<const Object*, std::shared_ptr<Object>>;

/// A copy of a bsdf, and of those in it, where the one of a priority borders on `exterior` outside.
/// What several share is copied once.
std::shared_ptr<Object> bordering_on(const Object& bsdf, const Value& exterior, Copies& copies) {
  std::shared_ptr<Object>& copy = copies[&bsdf];
  if (copy) return copy;
  copy = std::make_shared<Object>(bsdf);
  copy->id.clear();
  if (find_property(bsdf, priority_name)) {
    std::erase_if(copy->properties, [](const Property& p) { return p.name == "ext_ior"; });
    copy->properties.push_back({"ext_ior", exterior, bsdf.place});
  }
  for (Child& child : copy->children)
    if (child.object->family == "bsdf")
      child.object = bordering_on(*child.object, exterior, copies);
  return copy;
}

const Object* bsdf_of_shape(const Object& shape) {
  for (const Child& child : shape.children)
    if (child.object->family == "bsdf") return child.object.get();
  return nullptr;
}

/// The index inside a body, whether it was given as a number, by a name, or not at all.
Value interior_of(const Object& shape) {
  const Property* given = find_property(*bsdf_with_priority(shape), "int_ior");
  const Value value = given ? given->value : Value(std::string("bk7"));
  if (const auto* integer = std::get_if<int64_t>(&value)) return double(*integer);
  return value;
}

/// The same as a number, that of RGB mode. What is neither number nor known name was told when the
/// bsdf was made.
std::optional<float> number_of_index(const Value& index) {
  if (const auto* number = std::get_if<double>(&index)) return float(*number);
  const auto* name = std::get_if<std::string>(&index);
  const std::vector<std::string> known = dielectric_names();
  if (!name || std::find(known.begin(), known.end(), *name) == known.end()) return std::nullopt;
  return dielectric_ior(*name);
}

}  // namespace

std::vector<uint32_t> SceneBuilder::find_bodies() {
  std::vector<uint32_t> bodies;
  for (size_t i = 0; i < shapes_.size(); ++i)
    if (bsdf_with_priority(*shapes_[i].object)) bodies.push_back(uint32_t(i));
  std::stable_sort(bodies.begin(), bodies.end(), [&](uint32_t a, uint32_t b) {
    return priority_of(*bsdf_with_priority(*shapes_[a].object)) >
           priority_of(*bsdf_with_priority(*shapes_[b].object));
  });
  for (const auto& group : groups_)
    for (const BuiltShape& built : group)
      if (bsdf_with_priority(*built.object))
        warnings_.push_back(fmt::format(
            "the priority of '{}' has no effect: it is in a shape group", built.surface.name));
  return bodies;
}

void SceneBuilder::add_body_parts(std::span<const BodyPart> parts, std::vector<Surface>& surfaces) {
  static const Object nothing{"bsdf", "null", "", {}, {}, {}};
  for (const BodyPart& part : parts) {
    Surface surface = surfaces[part.shape];
    surface.light = -1;
    if (part.is_hidden) {
      surface.bsdf = create_bsdf(nothing, nullptr);
      surface.interior = surface.exterior = nullptr;
      surface.names_media = false;
    } else {
      const Surface& around = surfaces[part.around];
      surface.exterior = around.interior;
      surface.names_media |= around.names_media;
      surface.bsdf = bsdf_within(shapes_[part.shape], *shapes_[part.around].object);
    }
    if (!surface.bsdf) continue;  // told
    surface.traits = surface.bsdf->traits();
    surfaces.push_back(std::move(surface));
  }
}

std::shared_ptr<const Bsdf> SceneBuilder::bsdf_within(const BuiltShape& shape,
                                                      const Object& around) {
  static const Object nothing{"bsdf", "null", "", {}, {}, {}};
  const Value exterior = interior_of(around);
  // Between two bodies of the same index, as single floats tell, there is nothing to see; not even
  // where one of them disperses.
  const auto outside = number_of_index(exterior),
             inside = number_of_index(interior_of(*shape.object));
  if (outside && inside && *outside == *inside) return create_bsdf(nothing, nullptr);
  Copies copies;
  bordering_.push_back(bordering_on(*bsdf_of_shape(*shape.object), exterior, copies));
  return create_bsdf(*bordering_.back(), &shape);
}

}  // namespace kaustik
