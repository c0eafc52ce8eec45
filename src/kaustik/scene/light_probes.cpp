#include "kaustik/scene/light_probes.h"

#include "kaustik/base/parallel.h"
#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/scene/look_through.h"

namespace kaustik {
namespace {

/// Shadow rays in all, bounds on the number of probes that they are spent at, and on a path.
constexpr size_t wanted_rays = 200000, least_probes = 4096, most_probes = 16384;
constexpr size_t probes_per_path = 4;
/// Surfaces that a shadow ray may go straight on through.
constexpr int most_layers = 16;

class LightProbing {
 public:
  LightProbing(const Scene& scene, size_t paths) : scene_(scene), lights_(scene.lights().size()) {
    const size_t count = paths * probes_per_path;
    probes_.resize(count);
    met_.resize(count, 0);
    expected_.resize(count * lights_, 0.0f);
    found_.resize(count * lights_, 0.0f);
    parallel_blocks(paths, 64, [&](size_t begin, size_t end, size_t) {
      for (size_t path = begin; path < end; ++path) follow(path);
    });
  }

  LightVisibility learned() {
    size_t kept = 0;
    for (size_t i = 0; i < probes_.size(); ++i) {
      if (!met_[i]) continue;
      const auto move_row = [&](std::vector<float>& rows) {
        std::copy_n(rows.begin() + std::ptrdiff_t(i * lights_), lights_,
                    rows.begin() + std::ptrdiff_t(kept * lights_));
      };
      move_row(expected_);
      move_row(found_);
      probes_[kept++] = probes_[i];
    }
    probes_.resize(kept);
    return {probes_, lights_, expected_, found_};
  }

 private:
  void follow(size_t path) {
    Sampler sampler = Sampler::at(0, 0, Stream::light_probe, 0, uint32_t(path));
    const Vec2f u = sampler.next_2d();
    const Vec2i& size = scene_.film().crop_size;
    const CameraRay of_camera =
        scene_.camera().sample_ray({u.x * float(size.x), u.y * float(size.y)},
                                   scene_.camera().numbers_to_look_around(uint32_t(path)));
    if (of_camera.is_none()) return;
    Ray ray = of_camera;
    for (size_t i = 0; i < probes_per_path; ++i) {
      Hit hit;
      if (!scene_.tracer().intersect(ray, hit)) return;
      sampler.start_vertex(uint32_t(i));
      const SurfacePoint point = scene_.tracer().surface_point(ray, hit);
      const Vec3f facing = dot(ray.direction, point.ng) < 0 ? point.ng : -point.ng;
      ask_lights(path * probes_per_path + i, point, facing, sampler.fork(Fork::light_probe));
      const Bsdf& bsdf = *scene_.surface(point.shape).bsdf;
      const bool goes_through = bsdf.traits().transmits && sampler.next_1d() < 0.5f;
      ray = spawn_ray(point, Frame(goes_through ? -facing : facing)
                                 .to_world(square_to_cosine_hemisphere(sampler.next_2d())));
    }
  }

  void ask_lights(size_t probe, const SurfacePoint& point, const Vec3f& facing, Sampler sampler) {
    met_[probe] = 1;
    probes_[probe] = {point.position, facing};
    const LightQuery query(point.position, facing);
    for (size_t i = 0; i < lights_; ++i) {
      const Light& light = *scene_.lights()[i];
      const Vec2f u = sampler.next_2d();
      const float expected = light.expected_irradiance(query);
      if (!(expected > 0) || !std::isfinite(expected)) continue;
      expected_[probe * lights_ + i] = expected;
      found_[probe * lights_ + i] = irradiance(light.sample_toward(query, u), point, facing);
    }
  }

  /// One sample's estimate, shadows included; W/m², sum of the lanes.
  float irradiance(const LightSample& sample, const SurfacePoint& point,
                   const Vec3f& facing) const {
    const float cosine = dot(sample.direction, facing);
    if (!(sample.pdf_solid_angle > 0) || !(cosine > 0)) return 0;
    const float arriving = sample.radiance.sum() * cosine / sample.pdf_solid_angle;
    if (!(arriving > 0) || !std::isfinite(arriving)) return 0;
    const Ray shadow =
        sample.on_surface ? spawn_ray_to(point, sample.point)
        : std::isfinite(sample.distance)
            ? spawn_ray_to(point, point.position + sample.direction * sample.distance)
            : spawn_ray(point, sample.direction);
    return is_hidden(shadow) ? 0.0f : arriving;
  }

  /// By what lets nothing go straight on.
  bool is_hidden(const Ray& shadow) const {
    if (!scene_.passes_straight()) return scene_.tracer().occluded(shadow);
    const auto pass = [](const SurfacePoint& point, const Hit& hit, Ray& ray) {
      if (!std::isfinite(ray.t_max)) return straight_on(point, hit, ray);
      ray = spawn_ray_to(point, ray.origin + ray.direction * ray.t_max);
      return true;
    };
    return look_through(
               scene_, shadow, most_layers,
               [&](const Ray& ray, Hit& hit) { return scene_.tracer().intersect(ray, hit); },
               [&](const SurfacePoint& point, const Hit&, const Ray&) {
                 return !scene_.surface(point.shape).lets_pass();
               },
               pass) != Look::free;
  }

  const Scene& scene_;
  size_t lights_;
  std::vector<LightVisibility::Probe> probes_;
  std::vector<uint8_t> met_;
  std::vector<float> expected_, found_;  ///< a row of lights for each probe
};

}  // namespace

LightVisibility probe_lights(const Scene& scene) {
  if (!scene.light_selector().can_learn()) return {};
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    if (scene.surface(i).traits.is_null) return {};
  const size_t probes = std::clamp(wanted_rays / scene.lights().size(), least_probes, most_probes);
  return LightProbing(scene, probes / probes_per_path).learned();
}

}  // namespace kaustik
