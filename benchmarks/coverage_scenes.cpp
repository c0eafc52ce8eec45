#include "benchmarks/coverage_scenes.h"

#include <fmt/format.h>

#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/statistics.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace kaustik::bench {
namespace {

constexpr uint64_t truth_seed = 100'000;
constexpr uint32_t truth_passes = 64;
/// Rays per pixel and axis over which a closed form is averaged.
constexpr int rays_per_axis = 20;

const double pi_d = std::numbers::pi;

/// The height 0 plane, which all rays of such a scene meet.
double distance_sq_from_axis(const Ray& ray) {
  const double t = -double(ray.origin.z) / double(ray.direction.z);
  return sqr(double(ray.origin.x) + t * double(ray.direction.x)) +
         sqr(double(ray.origin.y) + t * double(ray.direction.y));
}

/// Begins the text of a scene.
std::string floor_seen_from_above(double reflectance) {
  return fmt::format(R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="90"/>
    <transform name="to_world"><lookat origin="0, 0, 0.4" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><rfilter type="box"/></film></sensor>
  <shape type="rectangle"><transform name="to_world"><scale value="2, 2, 1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></shape>
)",
                     reflectance);
}

/// A Lambertian disk of radius a and radiance L at height h over a floor: at distance d from the
/// axis E = πL/2 (1 − (d² + h² − a²)/√((d² + h² + a²)² − 4a²d²)). The noise of light sampling.
CoverageScene disk_over_plane() {
  return {"disk_over_plane",
          16,
          floor_seen_from_above(0.7) +
              R"(  <shape type="disk"><transform name="to_world"><scale value="0.5, 0.5, 1"/>
      <rotate value="1, 0, 0" angle="180"/><translate value="0, 0, 1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0, 0, 0"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="4, 4, 4"/></emitter></shape>
</scene>)",
          [](const Ray& ray) {
            constexpr double a = 0.5, h = 1, radiance = 4, rho = 0.7;
            const double d_sq = distance_sq_from_axis(ray), s = d_sq + h * h + a * a;
            return rho * radiance / 2 *
                   (1 - (d_sq + h * h - a * a) / std::sqrt(s * s - 4 * a * a * d_sq));
          },
          {}};
}

/// A closed sphere that shines everywhere, L = 1/(1 − ρ): all the noise is that of Russian
/// roulette.
CoverageScene furnace() {
  return {"furnace",
          16,
          R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="80"/>
    <transform name="to_world"><lookat origin="0.2, 0.1, -0.3" target="1, 0.3, 0.2" up="0, 0, 1"/></transform>
    <film type="hdrfilm"><rfilter type="box"/></film></sensor>
  <shape type="sphere"><boolean name="flip_normals" value="true"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.6, 0.6"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="1, 1, 1"/></emitter></shape>
</scene>)",
          [](const Ray&) { return 1 / (1 - 0.6); },
          {}};
}

/// A point lamp of intensity I in a sphere: E = I cos θ/d², and I/R² ρ/(1 − ρ) of light that was
/// reflected before, wherever the lamp is.
CoverageScene diffuse_sphere() {
  return {"diffuse_sphere",
          32,
          R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="80"/>
    <transform name="to_world"><lookat origin="0.5, 0.2, -0.3" target="2, 0.3, 0.2" up="0, 0, 1"/></transform>
    <film type="hdrfilm"><rfilter type="box"/></film></sensor>
  <shape type="sphere"><float name="radius" value="2"/><boolean name="flip_normals" value="true"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.6, 0.6"/></bsdf></shape>
  <emitter type="point"><point name="position" value="0.6, 0.4, 0.3"/>
    <rgb name="intensity" value="3, 3, 3"/></emitter>
</scene>)",
          [](const Ray& ray) {
            constexpr double r_sq = 4, rho = 0.6, intensity = 3;
            const double b = double(ray.origin.dot(ray.direction));
            const double t = std::sqrt(b * b - double(ray.origin.length2()) + r_sq) - b;
            const Vec3f point = ray.origin + ray.direction * float(t);
            const Vec3f to_lamp = Vec3f(0.6f, 0.4f, 0.3f) - point;
            const double d_sq = double(to_lamp.length2());
            const double cosine = -double(to_lamp.dot(point)) / std::sqrt(r_sq * d_sq);
            return rho / pi_d * intensity * (cosine / d_sq + rho / (1 - rho) / r_sq);
          },
          {}};
}

/// Two plates that shine, with four mirrors about them, which make them infinite:
/// B₁ = (M₁ + ρ₁ M₂)/(1 − ρ₁ ρ₂). Of each path all vertices lie near mirrors.
CoverageScene parallel_plates() {
  std::string walls;
  for (int wall = 0; wall < 4; ++wall)
    walls += fmt::format(R"(<shape type="rectangle"><transform name="to_world">
      <scale value="0.5, 0.5, 1"/><rotate value="0, 1, 0" angle="-90"/>
      <translate value="0.5, 0, 0.5"/><rotate value="0, 0, 1" angle="{}"/></transform>
    <bsdf type="twosided"><bsdf type="conductor"/></bsdf></shape>)",
                         90 * wall);
  return {"parallel_plates",
          16,
          R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="50"/>
    <transform name="to_world"><lookat origin="0.1, -0.05, 0.9" target="0, 0.02, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><rfilter type="box"/></film></sensor>
  <shape type="rectangle"><transform name="to_world"><scale value="0.5, 0.5, 1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.5, 0.5"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="1, 1, 1"/></emitter></shape>
  <shape type="rectangle"><transform name="to_world"><scale value="0.5, 0.5, 1"/>
      <rotate value="1, 0, 0" angle="180"/><translate value="0, 0, 1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.4, 0.4, 0.4"/></bsdf>
    <emitter type="area"><rgb name="radiance" value="2, 2, 2"/></emitter></shape>)" +
              walls + "</scene>",
          [](const Ray&) { return (1 + 0.5 * 2) / (1 - 0.5 * 0.4); },
          {}};
}

/// A point lamp over a floor, behind a pane that does not bend light: E = I h/(h² + d²)^1.5, all of
/// it caustic light, smooth but uneven, so that merging has a bias. Paths from the camera do not
/// find it.
CoverageScene pane() {
  return {
      "pane",
      16,
      floor_seen_from_above(0.5) +
          R"(  <shape type="rectangle"><transform name="to_world"><scale value="9, 9, 1"/>
      <translate value="0, 0, 0.5"/></transform>
    <bsdf type="dielectric"><float name="int_ior" value="1.00001"/><float name="ext_ior" value="1"/></bsdf></shape>
  <emitter type="point"><point name="position" value="0, 0, 1"/>
    <rgb name="intensity" value="1, 1, 1"/></emitter>
</scene>)",
      [](const Ray& ray) { return 0.5 / pi_d * std::pow(1 + distance_sq_from_axis(ray), -1.5); },
      {}};
}

CoverageScene shipped(const std::string& name, std::vector<TruthPart> truth) {
  return {name, 64, "", {}, std::move(truth)};
}

std::vector<KnownPixel> closed_form(const CoverageScene& of) {
  const CoverageSetup setup(of, "path");
  std::vector<KnownPixel> result(of.pixel_count());
  for (size_t i = 0; i < result.size(); ++i)
    for (int k = 0; k < rays_per_axis * rays_per_axis; ++k) {
      const Vec2f raster(
          float(i % size_t(of.size)) + (float(k % rays_per_axis) + 0.5f) / rays_per_axis,
          float(i / size_t(of.size)) + (float(k / rays_per_axis) + 0.5f) / rays_per_axis);
      result[i].mean +=
          of.radiance(setup.scene->camera().sample_ray(raster, Camera::middle_of_lens())) /
          sqr(double(rays_per_axis));
    }
  return result;
}

}  // namespace

const std::vector<CoverageScene>& coverage_scenes() {
  static const std::vector<CoverageScene> all = {
      disk_over_plane(),
      furnace(),
      diffuse_sphere(),
      parallel_plates(),
      pane(),
      shipped("cornell_box", {{"path", "emission,direct,indirect", 32768}}),
      shipped("cornell_spheres", {{"path", "emission,direct", 16384},
                                  {"lighttracer", "caustic,indirect", 65536},
                                  {"path", "specular", 65536}}),
      shipped("metal_ring", {{"path", "emission,direct", 16384},
                             {"lighttracer", "caustic", 65536},
                             {"bdpt", "indirect", 16384},
                             {"path", "specular", 131072}}),
      // No smooth mirror and no glass: paths find all of their light.
      shipped("point_spotlight", {{"path", "", 32768}}),
      shipped("gallery_1", {{"path", "", 32768}}),
      shipped("maze", {{"path", "", 32768}}),
  };
  return all;
}

CoverageSetup::CoverageSetup(const CoverageScene& of, const std::string& type,
                             const std::string& components) {
  Description description =
      of.is_analytic() ? parse_mitsuba_xml(of.text, of.name, "") : load_shipped(of.name);
  for (const char* side : {"width", "height"})
    override_property(description, fmt::format("film.{}={}", side, of.size));
  override_integrator(description, type);
  if (!components.empty()) override_property(description, "integrator.components=" + components);
  scene = build_scene(description);
  std::vector<std::string> warnings;
  integrator = make_integrator(description, *scene, warnings);
}

std::vector<KnownPixel> truth_of(const CoverageScene& of) {
  if (of.is_analytic()) return closed_form(of);
  std::vector<KnownPixel> result(of.pixel_count());
  for (const TruthPart& part : of.truth) {
    const CoverageSetup setup(of, part.integrator, part.components);
    SessionSettings settings;
    settings.seed = truth_seed;
    settings.passes = truth_passes;
    settings.samples_per_pass = part.samples / truth_passes;
    Session session(*setup.scene, *setup.integrator, settings);
    session.run();
    const FilmErrors errors(session.film());
    const double t = student_t_quantile(0.975, errors.freedom());
    for (size_t i = 0; i < result.size(); ++i) {
      const ConfidenceInterval found = errors.luminance(i);
      result[i].mean += found.mean;
      result[i].variance += sqr(found.half_width / t);
    }
  }
  return result;
}

}  // namespace kaustik::bench
