#include "kaustik/loader/gltf/gltf_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "kaustik/loader/object_maker.h"
#include "kaustik/loader/object_parts.h"

namespace kaustik::gltf {
namespace {

/// More than that as copies, or so many of them, and instances take less memory and time.
constexpr size_t most_copied_triangles = 100000, most_copies = 50;

size_t triangles_of_shape(const Object& shape) {
  const auto* faces = value_in<std::shared_ptr<const Array>>(shape, "faces");
  return faces ? (*faces)->count() / 3 : 12;
}

/// Of the attributes TRANSLATION, ROTATION and SCALE of an instance; nothing where it is squeezed
/// to nothing or not finite.
std::optional<Transform> transform_of(std::span<const float> t, std::span<const float> q,
                                      std::span<const float> s) {
  const double length = std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] +
                                  double(q[3]) * q[3]);
  try {
    Transform result = Transform::translate({double(t[0]), double(t[1]), double(t[2])});
    const Vec3d axis{double(q[0]), double(q[1]), double(q[2])};
    if (length > 0 && axis.length() > 0)
      result = result * Transform::rotate(axis, 2 * std::atan2(axis.length(), double(q[3])) * 180 /
                                                    std::numbers::pi);
    return result * Transform::scale({double(s[0]), double(s[1]), double(s[2])});
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

void Instances::take_nodes(const std::vector<PlacedNode>& placed) {
  worlds_.resize(file_.list("nodes").size());
  for (const PlacedNode& node : placed) {
    worlds_[node.index] = &node.to_world;
    const auto mesh = file_.count(*node.node, "mesh");
    if (!mesh || !node.is_there) continue;
    uses_[*mesh] += file_.extension(*node.node, "EXT_mesh_gpu_instancing") ? most_copies + 1 : 1;
  }
}

Meshes::Shapes Instances::shapes_of(const PlacedNode& node, const Pose& pose) {
  Meshes::Shapes result;
  const auto mesh = file_.count(*node.node, "mesh");
  if (!mesh) return result;
  const JsonValue& object = file_.item("meshes", *mesh, *node.node);
  Deformation deformation;
  try {
    deformation = deformation_of(file_, accessors_, node, object, pose, worlds_);
  } catch (const MissingData& missing) {
    deviations_.missing(file_.name_of("node", *node.node, node.index),
                        missing.what + ": its mesh is shown at rest", file_.place(*node.node));
  }
  if (!deformation.is_nothing()) {
    // Joints place it in the world themselves.
    const Transform to_world = deformation.joints.empty() ? node.to_world : Transform();
    for (const auto& shape : meshes_.deformed_shapes(*mesh, deformation, *node.node))
      add_placed(shape, to_world, result);
    return result;
  }
  const Meshes::Shapes& shapes = meshes_.shapes(*mesh, *node.node);
  std::vector<Transform> transforms = {Transform()};
  if (const JsonValue* extension = file_.extension(*node.node, "EXT_mesh_gpu_instancing"))
    transforms = instance_transforms(*extension);
  for (const Transform& own : transforms) {
    const Transform to_world = node.to_world * own;
    file_.spend(sizeof(Object) + sizeof(Property), *node.node);
    if (!is_worth_a_group(*mesh, shapes)) {
      for (const auto& shape : shapes) add_placed(shape, to_world, result);
      continue;
    }
    auto instance = make_object("shape", "instance", file_.place(*node.node));
    give(*instance, "to_world", to_world);
    put(*instance, "", group(*mesh, *node.node));
    result.push_back(std::move(instance));
  }
  return result;
}

bool Instances::is_worth_a_group(size_t mesh, const Meshes::Shapes& shapes) const {
  const size_t uses = uses_.at(mesh);
  if (shapes.empty() || uses < 2) return false;
  size_t triangles = 0;
  for (const auto& shape : shapes) triangles += triangles_of_shape(*shape);
  return uses > most_copies || (uses - 1) * triangles > most_copied_triangles;
}

std::shared_ptr<Object> Instances::group(size_t mesh, const JsonValue& at) {
  auto& group = groups_[mesh];
  if (group) return group;
  group = make_object("shape", "shapegroup", file_.place(at));
  group->id = fmt::format("mesh {}", mesh);
  Meshes::Shapes shapes;
  for (const auto& shape : meshes_.shapes(mesh, at)) add_placed(shape, Transform(), shapes);
  for (auto& shape : shapes) put(*group, "", std::move(shape));
  return group;
}

/// A copy of its own: shapes of a mesh share buffers and bsdfs, and nothing else.
void Instances::add_placed(const std::shared_ptr<Object>& shape, const Transform& to_world,
                           Meshes::Shapes& result) {
  auto copy = std::make_shared<Object>(*shape);
  const auto* own = value_in<Transform>(*copy, "to_world");
  const Transform both = own ? to_world * *own : to_world;
  remove_property(*copy, "to_world");
  if (!(both == Transform())) give(*copy, "to_world", both);
  for (Child& child : copy->children)
    if (child.object->family == "emitter") {
      child.object = std::make_shared<Object>(*child.object);
      emitters_.push_back(child.object);
    }
  result.push_back(std::move(copy));
}

void Instances::scale_emission(double factor) {
  for (const auto& emitter : emitters_) multiply_number(*emitter, "scale", factor);
}

std::vector<Transform> Instances::instance_transforms(const JsonValue& extension) {
  const JsonValue* attributes = extension.find("attributes");
  std::vector<Transform> transforms;
  if (!attributes) return {Transform()};
  std::shared_ptr<const Array> arrays[3];
  const char* const names[] = {"TRANSLATION", "ROTATION", "SCALE"};
  const size_t components[] = {3, 4, 3};
  std::optional<size_t> count;
  try {
    for (size_t i = 0; i < 3; ++i) {
      const auto index = file_.count(*attributes, names[i]);
      if (!index) continue;
      arrays[i] = accessors_.floats(*index, *attributes);
      const std::vector<size_t>& extents = arrays[i]->extents();
      if (extents[1] != components[i] || (count && *count != extents[0]))
        file_.fail(*attributes, fmt::format("{} does not go with the other instances", names[i]),
                   "export the file again");
      count = extents[0];
    }
  } catch (const MissingData& missing) {
    deviations_.missing("instances", missing.what + ": a single one is shown",
                        file_.place(extension));
    return {Transform()};
  }
  constexpr float defaults[3][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 1}};
  file_.spend(count.value_or(1) * sizeof(Transform), extension);
  for (size_t i = 0; i < count.value_or(1); ++i) {
    const auto part = [&](size_t k) {
      return arrays[k] ? floats_in(*arrays[k]).subspan(i * components[k], components[k])
                       : std::span<const float>(defaults[k], components[k]);
    };
    if (const auto transform = transform_of(part(0), part(1), part(2)))
      transforms.push_back(*transform);
    else
      deviations_.ignored("instances", "some are squeezed to nothing: they are left out",
                          file_.place(extension));
  }
  return transforms;
}

}  // namespace kaustik::gltf
