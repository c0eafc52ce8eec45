#include "kaustik/scene/scene_report.h"

#include <fmt/format.h>

#include "kaustik/light/measured_light.h"
#include "kaustik/light/sun_position.h"
#include "kaustik/light/sunsky_light.h"
#include "kaustik/scene/look_through.h"

namespace kaustik {
namespace {

/// Largest lane of the directional albedo over a few directions.
float largest_albedo(const Bsdf& bsdf) {
  float largest = 0;
  for (const float u : {0.0f, 0.25f, 0.75f})
    for (const float cosine : {1.0f, 0.5f, 0.1f})
      for (const float side : {1.0f, -1.0f}) {
        BsdfContext context;
        context.move_to({.uv = {u, u}}, {});
        const Vec3f wo(safe_sqrt(1 - cosine * cosine), 0, cosine * side);
        largest = std::max(largest, bsdf.albedo(context, wo, Lobes::all).max_lane());
      }
  return largest;
}

/// What the camera sees, over a grid of the picture.
struct View {
  int rays = 0, hits = 0;
  int media = 0;             ///< whose boundaries are met: they are seen where no surface is
  int black_backs = 0;       ///< hits of the unlit inner side of opaque surfaces
  float nearest = infinity;  ///< of the hits
  uint32_t nearest_shape = 0;
};

/// Whether a surface neither reflects nor lets through what comes to its back.
bool is_black_from_behind(const Surface& surface) {
  if (surface.traits.passes_straight) return false;
  BsdfContext context;
  context.move_to({.uv = {0.5f, 0.5f}}, {});
  return surface.bsdf->albedo(context, normalize({0.3f, 0.2f, -1.0f}), Lobes::all).is_zero();
}

View look_around(const Scene& scene) {
  constexpr int grid = 16;
  // Where boundaries meet, rounding may never let a ray leave them.
  constexpr int most_boundaries = 1000;
  View view;
  const Vec2i size = scene.film().crop_size;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) {
      const Vec2f raster((float(x) + 0.5f) / grid * float(size.x),
                         (float(y) + 0.5f) / grid * float(size.y));
      const CameraRay ray = scene.camera().sample_ray(
          raster, scene.camera().numbers_to_look_around(uint32_t(y * grid + x)));
      if (ray.is_none()) continue;
      ++view.rays;
      probe_through(scene, ray, most_boundaries,
                    [&](const SurfacePoint& point, const Hit& hit, const Ray& segment) {
                      const Surface& surface = scene.surface(point.shape);
                      if (surface.traits.is_null) {
                        if (surface.interior || surface.exterior) ++view.media;
                        return false;
                      }
                      ++view.hits;
                      if (dot(point.ng, segment.direction) > 0 && is_black_from_behind(surface))
                        ++view.black_backs;
                      if (hit.t < view.nearest) {
                        view.nearest = hit.t;
                        view.nearest_shape = point.shape;
                      }
                      return true;
                    });
    }
  return view;
}

/// Lamps that the camera does not see do not count.
bool has_visible_surface(const Scene& scene) {
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    if (!scene.is_hidden(scene.surface(i).light)) return true;
  return false;
}

void describe_view(const Scene& scene, SceneReport& report) {
  const View view = look_around(scene);
  const Camera& camera = scene.camera();
  const Vec3f p = camera.traits().position;
  const CameraTraits& traits = camera.traits();
  const std::string field = traits.horizontal_fov > 0
                                ? fmt::format("field of view {:.4g}° × {:.4g}°",
                                              traits.horizontal_fov, traits.vertical_fov)
                                : traits.view;
  report.lines.push_back(
      fmt::format("camera     at {:.4g}, {:.4g}, {:.4g}; {}", p.x, p.y, p.z, field));
  report.lines.push_back(
      fmt::format("picture    {} × {} pixels{}", scene.film().crop_size.x, scene.film().crop_size.y,
                  scene.quantity() == Quantity::irradiance ? " of irradiance" : ""));
  if (!has_visible_surface(scene))
    report.warnings.push_back("the scene has no shape: only what is behind it can be seen");
  else if (view.hits == 0 && view.media == 0)
    report.warnings.push_back("the camera sees no shape: check its to_world");
  const float extent = length(scene.tracer().bounds().max - scene.tracer().bounds().min);
  // Meters look from within the scene, from wherever they are told to.
  if (view.hits < view.rays || view.rays == 0 || !traits.can_connect) return;
  const std::string& name = scene.surface(view.nearest_shape).name;
  if (view.black_backs == view.rays)
    report.warnings.push_back(fmt::format(
        "the camera sees only back sides, which are black: is it inside a wall ('{}')?", name));
  else if (view.nearest < 1e-4f * extent)
    report.warnings.push_back(fmt::format(
        "the camera stands {:.2g} m from a surface that fills the picture: is it inside a wall "
        "('{}')?",
        view.nearest, name));
}

std::string place_of(const Light& light, const Scene& scene) {
  if (const int surface = light.traits().surface(); surface >= 0) {
    const std::string& name = scene.surface(uint32_t(surface)).name;
    // One without a name of its own is called after its type and its line.
    return name.find('\'') == name.npos ? fmt::format("surface '{}'", name) : name;
  }
  if (light.is_infinite()) return "at infinity";
  const Bounds3f& bounds = light.traits().bounds.position;
  const Vec3f p = bounds.center();
  return fmt::format("{} {:.4g}, {:.4g}, {:.4g}", bounds.min == bounds.max ? "at" : "around", p.x,
                     p.y, p.z);
}

/// Where the sun stands, for who gave place and time.
std::string sun_line(const SunPlace& sun) {
  const Horizontal at = horizontal(sun.by_compass);
  const auto rounded = [](float x) { return std::round(double(x) * 1000) / 1000 + 0.0; };
  return fmt::format("sun        {:.1f}° high, {:.1f}° from north by east; toward {}, {}, {}",
                     at.altitude, at.azimuth, rounded(sun.in_world.x), rounded(sun.in_world.y),
                     rounded(sun.in_world.z));
}

void describe_lights(const Scene& scene, SceneReport& report) {
  int index = 0;
  for (const auto& light : scene.lights()) {
    const float power = light->traits().power.sum();
    const std::string where = place_of(*light, scene);
    const Spectrum rgb = light->traits().power;
    report.lines.push_back(fmt::format("light {:<4} {}, {:.4g} {:.4g} {:.4g} W", index, where,
                                       rgb[0], rgb[1], rgb[2]));
    if (const auto sun = sun_place(*light)) report.lines.push_back(sun_line(*sun));
    if (const auto* measured = dynamic_cast<const MeasuredLight*>(light.get());
        measured && !measured->report().empty())
      report.lines.push_back(fmt::format("           {}", measured->report()));
    if (!(power > 0))
      report.warnings.push_back(fmt::format("light {} ({}) has no power", index, where));
    ++index;
  }
  if (scene.lights().empty()) report.warnings.push_back("the scene has no light");
}

}  // namespace

std::string refused_rays_warning(uint64_t rays) {
  return fmt::format(
      "{} rays left the range of single floats and hit nothing: something in the scene is too far "
      "out, too large or too thin",
      rays);
}

SceneReport describe_scene(const Scene& scene) {
  SceneReport report;
  size_t triangles = 0, analytic = 0;
  for (uint32_t i = 0; i < scene.tracer().shape_count(); ++i) {
    const TriangleMesh* mesh = scene.tracer().shape(i).mesh();
    if (mesh)
      triangles += mesh->triangles.size();
    else
      ++analytic;
  }
  const Bounds3f b = scene.tracer().bounds();
  report.lines.push_back(fmt::format("shapes     {} ({} triangles, {} analytic or procedural)",
                                     scene.tracer().shape_count(), triangles, analytic));
  report.lines.push_back(fmt::format("bounds     {:.4g}, {:.4g}, {:.4g} … {:.4g}, {:.4g}, {:.4g} m",
                                     b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z));
  report.lines.push_back(fmt::format("memory     {:.1f} MB for ray tracing",
                                     double(scene.tracer().size_in_bytes()) / 1e6));
  describe_view(scene, report);
  describe_lights(scene, report);
  for (uint32_t i = 0; i < scene.surface_count(); ++i) {
    const float albedo = largest_albedo(*scene.surface(i).bsdf);
    if (albedo > 1.001f)
      report.warnings.push_back(
          fmt::format("{} reflects {:.3g} times what arrives: light would grow without bound",
                      scene.surface(i).name, albedo));
  }
  report.warnings.insert(report.warnings.end(), scene.warnings().begin(), scene.warnings().end());
  return report;
}

}  // namespace kaustik
