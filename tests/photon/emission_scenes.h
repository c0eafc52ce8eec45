#pragma once
// Small scenes for tests of emission: one light of each kind and things to aim at.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "kaustik/photon/emission/emission.h"

namespace kaustik::test {

using ObjectPointer = std::shared_ptr<Object>;

inline ObjectPointer object(std::string family, std::string type,
                            std::vector<std::pair<std::string, Value>> properties = {},
                            std::vector<ObjectPointer> children = {}) {
  auto result = std::make_shared<Object>();
  result->family = std::move(family);
  result->type = std::move(type);
  for (auto& [name, value] : properties) result->properties.push_back({name, value, {}});
  for (auto& child : children) result->children.push_back({"", child});
  return result;
}

inline ObjectPointer mirror_bsdf() { return object("bsdf", "conductor"); }
inline ObjectPointer black() { return object("bsdf", "diffuse", {{"reflectance", Rgb{0, 0, 0}}}); }

inline ObjectPointer sphere(const Vec3d& center, double radius, const ObjectPointer& bsdf,
                            std::vector<ObjectPointer> emitter = {}) {
  emitter.push_back(bsdf);
  return object("shape", "sphere", {{"center", center}, {"radius", radius}}, emitter);
}
inline ObjectPointer cylinder(const Vec3d& p0, const Vec3d& p1, double radius) {
  return object("shape", "cylinder", {{"p0", p0}, {"p1", p1}, {"radius", radius}}, {mirror_bsdf()});
}
inline ObjectPointer placed(const std::string& type, const Transform& to_world,
                            const ObjectPointer& bsdf, std::vector<ObjectPointer> emitter = {}) {
  emitter.push_back(bsdf);
  return object("shape", type, {{"to_world", to_world}}, emitter);
}

inline const std::vector<std::string>& light_kinds() {
  static const std::vector<std::string> kinds = {"point", "spot",        "rectangle", "ball",
                                                 "mesh",  "directional", "constant"};
  return kinds;
}
/// That share their way of aiming with one of the above, but not their emission.
inline const std::vector<std::string>& further_light_kinds() {
  static const std::vector<std::string> kinds = {"sunsky", "distributedspot", "two-sided ball",
                                                 "projector"};
  return kinds;
}

/// A light at about (0, 0, 2) that shines down, or from everywhere.
inline ObjectPointer light(const std::string& kind) {
  const auto area = object("emitter", "area", {{"radiance", Rgb{1, 1, 1}}});
  const Transform up = Transform::translate(Vec3d(0, 0, 2));
  const Transform down = up * Transform::rotate(Vec3d(1, 0, 0), 180);
  if (kind == "point") return object("emitter", "point", {{"position", Vec3d(0, 0, 2)}});
  if (kind == "spot")
    return object("emitter", "spot", {{"to_world", down}, {"cutoff_angle", 35.0}});
  if (kind == "rectangle")
    return placed("rectangle", down * Transform::scale(Vec3d(0.4, 0.3, 1)), black(), {area});
  if (kind == "ball") return sphere(Vec3d(0, 0, 2), 0.3, black(), {area});
  if (kind == "mesh")
    return placed(
        "cube", up * Transform::rotate(Vec3d(1, 2, 0), 30) * Transform::scale(Vec3d(0.2, 0.3, 0.1)),
        black(), {area});
  if (kind == "directional")
    return object("emitter", "directional", {{"direction", Vec3d(0.3, 0.2, -1)}});
  if (kind == "sunsky")
    return object("emitter", "sunsky",
                  {{"sun_direction", Vec3d(0.3, 0.2, 1)}, {"sun_aperture", 20.0}});
  if (kind == "projector")
    return object("emitter", "projector", {{"to_world", down}, {"fov", 60.0}});
  if (kind == "distributedspot")
    return object("emitter", "distributedspot",
                  {{"to_world", down}, {"radius", 0.3}, {"cutoff_angle", 50.0}});
  if (kind == "two-sided ball")
    return sphere(Vec3d(0, 0, 2), 0.3, black(),
                  {object("emitter", "area", {{"radiance", Rgb{1, 1, 1}}, {"two_sided", true}})});
  return object("emitter", "constant");
}

inline std::shared_ptr<const Scene> make_scene(const std::vector<ObjectPointer>& objects) {
  const auto root = object("scene", "", {}, objects);
  root->children.push_back({"", object("sensor", "perspective")});
  return build_scene({root});
}

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  float number() { return float(engine_() >> 40) * 0x1p-24f; }
  Vec2f pair() {
    const float x = number();
    return {x, number()};
  }

 private:
  std::mt19937_64 engine_;
};

/// Named sets of things to aim at, with a lobe that is specular.
struct Targets {
  std::string name;
  std::vector<ObjectPointer> objects;
};

inline std::vector<Targets> target_sets() {
  const Transform tilt = Transform::rotate(Vec3d(1, 1, 0), 25);
  const auto cube = [&](const Vec3d& at, double size) {
    return placed("cube",
                  Transform::translate(at) * tilt * Transform::scale(Vec3d(size, size, size)),
                  mirror_bsdf());
  };
  return {
      {"sphere", {sphere(Vec3d(0.3, 0.1, 0), 0.4, mirror_bsdf())}},
      {"pin", {cylinder(Vec3d(-0.3, -0.1, 0.1), Vec3d(0.4, 0.1, -0.2), 0.002)}},
      {"overlapping",
       {sphere(Vec3d(0.1, 0, 0.1), 0.3, mirror_bsdf()), cube(Vec3d(0.2, 0.1, 0), 0.25),
        cylinder(Vec3d(-0.5, 0, 0), Vec3d(0.5, 0, 0.2), 0.05)}},
      // All about the light, so that the origin is inside; and in part behind it.
      {"around", {cube(Vec3d(0, 0, 1.5), 1.2), sphere(Vec3d(0.6, 0, 1.9), 0.2, mirror_bsdf())}},
      {"at the horizon", {sphere(Vec3d(1.2, 0.1, 2.0), 0.4, mirror_bsdf())}},
  };
}

inline std::shared_ptr<const Scene> scene_of(const std::string& light_kind,
                                             const Targets& targets) {
  std::vector<ObjectPointer> objects = {light(light_kind)};
  objects.insert(objects.end(), targets.objects.begin(), targets.objects.end());
  return make_scene(objects);
}

}  // namespace kaustik::test
