#include "kaustik/view/camera_pose.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "kaustik/integrator/description_types.h"
#include "kaustik/scene/scene.h"
#include "kaustik/scene/scene_cameras.h"
#include "kaustik/view/request_error.h"

namespace kaustik::view {
namespace {

constexpr double farthest = 1e12;  ///< m, what lengths can bear

Vec3d point_from(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end() || !found->is_array() || found->size() != 3)
    throw RequestError(400, fmt::format("the camera has no '{}'", name),
                       fmt::format("give three numbers: \"{}\": [0, 0, 1]", name));
  Vec3d point;
  for (int i = 0; i < 3; ++i) {
    const Json& number = (*found)[size_t(i)];
    point[i] = number.is_number() ? number.get<double>() : farthest;
    if (!(std::abs(point[i]) < farthest))
      throw RequestError(400, fmt::format("the camera's '{}' is not of three usual numbers", name),
                         "give numbers in metres");
  }
  return point;
}

Json json_of_point(const Vec3d& point) { return Json::array({point.x, point.y, point.z}); }

std::shared_ptr<Object> camera_of(const Description& description) {
  const auto cameras = cameras_of(*description.scene);
  return cameras.empty() ? nullptr : cameras.front();
}

/// Property `name` of a camera; null: it is not given.
const Property* given(const Object& camera, const std::string& name) {
  for (const Property& property : camera.properties)
    if (property.name == name) return &property;
  return nullptr;
}

Transform placement_of(const Object& camera) {
  for (const char* name : {"to_world", "toWorld"})
    if (const Property* property = given(camera, name))
      if (const auto* transform = std::get_if<Transform>(&property->value)) return *transform;
  return {};
}

bool takes(const Object& camera, const char* name) {
  const TypeInfo* info = description_types().find(camera.family, camera.type);
  return info && info->find(name);
}

std::optional<double> number_of(const Property& property) {
  if (const auto* number = std::get_if<double>(&property.value)) return *number;
  if (const auto* whole = std::get_if<int64_t>(&property.value)) return double(*whole);
  if (const auto* untyped = std::get_if<Untyped>(&property.value)) {
    char* end = nullptr;
    const double number = std::strtod(untyped->text.c_str(), &end);
    if (end != untyped->text.c_str() && *end == 0) return number;
  }
  return std::nullopt;
}

void set(Object& camera, const char* name, Value value) {
  std::erase_if(camera.properties, [&](const Property& p) { return p.name == name; });
  camera.properties.push_back({name, std::move(value), place_in("the view's camera")});
}

Transform look(const CameraPose& pose) {
  try {
    return Transform::look_at(pose.origin, pose.target, pose.up);
  } catch (const std::invalid_argument&) {
    throw RequestError(400, "the camera's 'target' is its 'origin', or 'up' is along the view",
                       "give a target ahead of the origin, and an 'up' that points elsewhere");
  }
}

Vec3d transformed(const Transform& transform, double x, double y, double z, double w) {
  Vec3d result;
  for (int row = 0; row < 3; ++row)
    result[row] = transform.at(row, 0) * x + transform.at(row, 1) * y + transform.at(row, 2) * z +
                  transform.at(row, 3) * w;
  return result;
}

/// Where "up" points for who turns the camera: along an axis of the world, if the horizon is level
/// beside one; else as the picture has it.
Vec3d up_of(const Transform& placement) {
  const Vec3d left = transformed(placement, 1, 0, 0, 0).normalized();
  const Vec3d up = transformed(placement, 0, 1, 0, 0).normalized();
  Vec3d best = up;
  double most = 0.05;  // Else it looks straight along the axis.
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(left[axis]) > 1e-4 || std::abs(up[axis]) <= most) continue;
    most = std::abs(up[axis]);
    best = Vec3d(0, 0, 0);
    best[axis] = up[axis] > 0 ? 1 : -1;
  }
  return best;
}

CameraPose pose_of(const Transform& placement, double distance) {
  CameraPose pose;
  pose.origin = transformed(placement, 0, 0, 0, 1);
  pose.target = pose.origin + transformed(placement, 0, 0, 1, 0).normalized() * distance;
  pose.up = up_of(placement);
  return pose;
}

}  // namespace

CameraPose camera_pose_from(const Json& json) {
  if (!json.is_object())
    throw RequestError(400, "'camera' is no object", "give origin, target, up and fov");
  for (const auto& [name, value] : json.items())
    if (name != "origin" && name != "target" && name != "up" && name != "fov")
      throw RequestError(400, fmt::format("the camera has no '{}'", name),
                         "it has: origin, target, up, fov");
  CameraPose pose{point_from(json, "origin"), point_from(json, "target"), point_from(json, "up"),
                  std::nullopt};
  if (const auto fov = json.find("fov"); fov != json.end() && !fov->is_null()) {
    if (!fov->is_number())
      throw RequestError(400, "the camera's 'fov' is no number", "give degrees, or null");
    pose.fov = fov->get<double>();
  }
  look(pose);
  return pose;
}

Json json_of(const CameraPose& pose) {
  return {{"origin", json_of_point(pose.origin)},
          {"target", json_of_point(pose.target)},
          {"up", json_of_point(pose.up)},
          {"fov", pose.fov ? Json(*pose.fov) : Json(nullptr)}};
}

MovableCamera::MovableCamera(const Description& description) {
  const auto camera = camera_of(description);
  if (!camera) return;
  const Transform placement = placement_of(*camera);
  try {
    camera_from_shape_ = look(pose_of(placement, 1)).inverse() * placement;
  } catch (const RequestError&) {
    // Building the scene tells what is wrong with it.
  }
}

CameraPose MovableCamera::pose(const Description& description, double distance,
                               const Scene* built) const {
  const auto camera = camera_of(description);
  if (!camera) return {};
  CameraPose pose = pose_of(placement_of(*camera), distance);
  if (!takes(*camera, "fov")) return pose;
  if (const Property* fov = given(*camera, "fov"))
    pose.fov = number_of(*fov);
  else if (built && built->camera().traits().horizontal_fov > 0)
    pose.fov = double(built->camera().traits().horizontal_fov);
  return pose;
}

void MovableCamera::put(Description& description, const CameraPose& pose) const {
  const auto camera = camera_of(description);
  if (!camera || !takes(*camera, "to_world"))
    throw RequestError(400, "the scene's camera cannot be moved",
                       "begin the view with another of the scene's cameras");
  std::erase_if(camera->properties, [](const Property& p) { return p.name == "toWorld"; });
  set(*camera, "to_world", look(pose) * camera_from_shape_);
  if (!pose.fov || !takes(*camera, "fov")) return;
  if (!(*pose.fov >= 1e-4 && *pose.fov <= 179.9))
    throw RequestError(400, fmt::format("a field of view of {} degrees", *pose.fov),
                       "give a 'fov' from 0.0001 to 179.9");
  // A focal length is along the diagonal; what the page was told is across.
  if (!given(*camera, "fov")) set(*camera, "fov_axis", std::string("x"));
  std::erase_if(camera->properties, [](const Property& p) { return p.name == "focal_length"; });
  set(*camera, "fov", *pose.fov);
}

double distance_ahead(const Scene& scene) {
  const Vec2i size = scene.film().crop_size;
  const CameraRay ray = scene.camera().sample_ray({0.5f * float(size.x), 0.5f * float(size.y)},
                                                  Camera::middle_of_lens());
  Hit hit;
  if (!ray.is_none() && scene.intersect(ray, hit)) {
    const double distance = double(ray.start) + double(hit.t);
    if (std::isfinite(distance) && distance > 0) return distance;
  }
  const Bounds3f bounds = scene.tracer().bounds();
  if (bounds.isEmpty()) return 1;
  const double ahead = double(dot(center(bounds) - ray.origin, ray.direction));
  return std::isfinite(ahead) && ahead > 0 ? ahead
                                           : std::max(1e-3, double(bounding_radius(bounds)));
}

}  // namespace kaustik::view
