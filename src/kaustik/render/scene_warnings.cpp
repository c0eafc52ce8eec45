#include "kaustik/render/scene_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "kaustik/integrator/registry.h"
#include "kaustik/scene/look_through.h"

namespace kaustik {
namespace {

/// Steps between neighbouring floats at the scene's farthest coordinate, over the scene's size,
/// from which on they are seen: a fifth of a pixel in a picture of 2000.
constexpr float coarse_step = 1e-4f;

/// Camera rays along a side of the picture, and surfaces that one may pass.
constexpr int probes_per_side = 16, longest_probe = 64;
/// Points and their lamps that may be looked at.
constexpr int most_lamps = 64;

/// Light goes through it straight or bent, but by nothing that can be sampled toward a lamp.
bool is_clear(const Surface& surface) {
  return !surface.lets_pass() && surface.traits.transmits &&
         any(surface.traits.lobes & Lobes::delta);
}

/// A point, and where it is seen from.
struct SeenPoint {
  SurfacePoint point;
  Vec3f toward_camera;
};

/// The first surface along a ray of the camera that scatters light by more than delta lobes.
std::optional<SurfacePoint> seen_point(const Scene& scene, const Ray& ray) {
  std::optional<SurfacePoint> seen;
  probe_through(scene, ray, longest_probe, [&](const SurfacePoint& point, const Hit&, const Ray&) {
    const Surface& surface = scene.surface(point.shape);
    if (any(surface.traits.lobes & (Lobes::diffuse | Lobes::glossy))) seen = point;
    return seen || !surface.traits.transmits;
  });
  return seen;
}

/// Gauges, or by rays of the camera over the picture.
std::vector<SeenPoint> seen_points(const Scene& scene) {
  constexpr size_t probes = size_t(probes_per_side) * probes_per_side;
  std::vector<SeenPoint> seen;
  const std::vector<PlacedGauge>& gauges = scene.gauges();
  for (size_t i = 0; i < gauges.size(); i += 1 + gauges.size() / probes)
    seen.push_back({gauges[i].point, gauges[i].point.ng});
  if (!gauges.empty()) return seen;
  const Vec2i size = scene.film().crop_size;
  for (size_t i = 0; i < probes; ++i) {
    const Vec2f raster((float(i % probes_per_side) + 0.5f) / probes_per_side * float(size.x),
                       (float(i / probes_per_side) + 0.5f) / probes_per_side * float(size.y));
    const CameraRay ray =
        scene.camera().sample_ray(raster, scene.camera().numbers_to_look_around(uint32_t(i)));
    if (ray.is_none()) continue;
    if (const std::optional<SurfacePoint> point = seen_point(scene, ray))
      seen.push_back({*point, -ray.direction});
  }
  return seen;
}

/// The surface, clear, that hides the lamp from the point; null if none does, or something opaque.
const Surface* clear_surface_before(const Scene& scene, const SurfacePoint& point,
                                    const LightSample& sample) {
  const Surface* clear = nullptr;
  const auto toward_lamp = [&](const SurfacePoint& from) {
    return std::isfinite(sample.distance)
               ? spawn_ray_to(from, point.position + sample.direction * sample.distance)
               : spawn_ray(from, sample.direction);
  };
  const Look look = look_through(
      scene, toward_lamp(point), longest_probe,
      [&](const Ray& ray, Hit& hit) { return scene.tracer().intersect(ray, hit); },
      [&](const SurfacePoint& met, const Hit&, const Ray&) {
        const Surface& surface = scene.surface(met.shape);
        if (is_clear(surface)) clear = &surface;
        return !is_clear(surface) && !surface.lets_pass();
      },
      [&](const SurfacePoint& passed, const Hit&, Ray& ray) {
        ray = toward_lamp(passed);
        return true;
      });
  return look == Look::free ? clear : nullptr;
}

/// What hides any of these lamps from the point.
const Surface* what_hides(const Scene& scene, const std::vector<const Light*>& lamps,
                          const SurfacePoint& point, const Vec3f& toward_camera) {
  const Vec3f facing = dot(toward_camera, point.ng) > 0 ? point.ng : -point.ng;
  for (const Light* lamp : lamps) {
    const LightSample sample = lamp->sample_toward({point.position, facing}, {0.5f, 0.5f});
    if (sample.radiance.is_zero() || !(dot(sample.direction, facing) > 0)) continue;
    if (const Surface* clear = clear_surface_before(scene, point, sample)) return clear;
  }
  return nullptr;
}

}  // namespace

std::string hidden_lamps_warning(const Scene& scene, const std::string& integrator) {
  const auto& types = integrator_types();
  const auto type = std::ranges::find(
      types, integrator, [](const IntegratorType& t) -> const std::string& { return t.info.name; });
  if (type == types.end() || !type->is_from_camera_alone) return {};
  std::vector<const Light*> lamps;
  for (const auto& light : scene.lights())
    if (light->traits().is_delta && !light->traits().is_only_seen && int(lamps.size()) < most_lamps)
      lamps.push_back(light.get());
  if (lamps.empty()) return {};
  int hidden = 0;
  std::string name;
  const std::vector<SeenPoint> points = seen_points(scene);
  for (const SeenPoint& seen : points) {
    const Surface* clear = what_hides(scene, lamps, seen.point, seen.toward_camera);
    if (clear && ++hidden == 1) name = clear->name;
  }
  if (hidden == 0) return {};
  return fmt::format(
      "integrator {} never finds light of point, spot and directional lamps through glass or masks "
      "('{}'): {} of {} points that the camera sees lack it; use auto, or a small sphere as lamp",
      integrator, name, hidden, points.size());
}

std::string coordinates_warning(const Scene& scene) {
  const Bounds3f box = scene.tracer().bounds();
  const float farthest = std::max(max_abs(box.min), max_abs(box.max)), size = length(box.size());
  const float step = farthest * std::numeric_limits<float>::epsilon();
  if (step <= coarse_step * size) return {};
  return fmt::format(
      "the scene is {:.2g} m wide, but {:.2g} m from the origin coordinates are rounded to {:.2g} "
      "m: move shapes, lights and camera to the origin",
      size, farthest, step);
}

std::string missed_lamps_warning(const Scene& scene) {
  const bool has_lamps = std::ranges::any_of(scene.lights(), [](const auto& light) {
    return light->traits().is_delta && !light->traits().is_only_seen;
  });
  const CameraTraits& camera = scene.camera().traits();
  if (!camera.has_ways || !has_lamps || !scene.gauges().empty()) return {};
  if (!camera.measures_irradiance)
    return "the fluencemeter misses what point, spot and directional lamps send straight to it: "
           "let small spheres shine instead";
  return "the irradiancemeter stands in a shape with bsdf 'null', where it misses what point, spot "
         "and directional lamps send straight to it: give the shape another bsdf";
}

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> warnings = scene.warnings();
  if (const std::string missed = missed_lamps_warning(scene); !missed.empty())
    warnings.push_back(missed);
  if (const std::string coarse = coordinates_warning(scene); !coarse.empty())
    warnings.push_back(coarse);
  return warnings;
}

std::string darkness_warning(const Scene& scene) {
  if (scene.lights().empty())
    return "the scene has no light: the picture will be black; add an emitter to it";
  const bool may_shine = std::ranges::any_of(scene.lights(), [](const auto& light) {
    return light->traits().is_only_seen || light->traits().power.sum() > 0;
  });
  // Lamps without a surface are not seen themselves.
  if (may_shine && scene.surface_count() == 0 && scene.environment_lights().empty() &&
      !scene.has_media())
    return "the scene has no shape that its lamps could light: the picture will be black; add a "
           "shape to it";
  if (may_shine) return {};
  return "no light of the scene has power: the picture will be black; give an emitter more than "
         "0";
}

}  // namespace kaustik
