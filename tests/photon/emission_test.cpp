#include "kaustik/photon/emission/emission.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "tests/photon/counted_allocations.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using test::further_light_kinds;
using test::light;
using test::light_kinds;
using test::make_scene;
using test::mirror_bsdf;
using test::ObjectPointer;
using test::Random;
using test::scene_of;
using test::sphere;
using test::target_sets;
using test::Targets;

#ifdef KAUSTIK_SLOW_BUILD
constexpr int sample_divisor = 10;
#else
constexpr int sample_divisor = 1;
#endif

EmittedRay draw(const EmissionSampler& sampler, Random& random) {
  const Vec2f a = random.pair(), b = random.pair();
  return sampler.sample(0, a, b, random.number(), {});
}

constexpr Aim aims[] = {Aim::boxes, Aim::projection_map};

EmissionSampler aimed_at(const Scene& scene, Aim aim = Aim::boxes) {
  return {scene, Lobes::specular, 64, aim};
}
std::string name_of(Aim aim) { return aim == Aim::boxes ? "boxes" : "projection map"; }

// ---------------------------------------------------------------- densities

/// Cells over what is random about a ray: its direction, in a cone about the targets, for lights
/// with a place; for those at infinity where it passes, across its direction.
struct Cells {
  static constexpr int rows = 16, columns = 16, count = rows * columns;
  Vec3f center;  ///< of the targets
  float radius;  ///< half the side of the square across the ray that is divided into cells
  bool infinite;
  Frame cone;
  float one_minus_cos = 2;

  Cells(const Light& source, const std::vector<AimTarget>& targets)
      : infinite(source.is_infinite()) {
    Bounds3f bounds;
    for (const AimTarget& t : targets) bounds.extendBy(t.box);
    center = kaustik::center(bounds);
    radius = 1.1f * bounding_radius(bounds);
    if (infinite) return;
    const Bounds3f place = source.traits().bounds.position;
    const Vec3f to = center - kaustik::center(place);
    const float sine = 1.1f * (radius + bounding_radius(place)) / length(to);
    cone = Frame(normalize(to));
    if (sine < 0.99f) one_minus_cos = 1.0f - std::sqrt(1.0f - sine * sine);
  }

  /// Place on the unit square.
  Vec2f unit(const EmittedRay& ray) const {
    if (!infinite) {
      const Vec3f d = cone.to_local(ray.ray.direction);
      return {(1.0f - d.z) / one_minus_cos, std::atan2(d.y, d.x) / (2.0f * pi) + 0.5f};
    }
    const Vec3f local = Frame(ray.ray.direction).to_local(ray.origin.position - center);
    return {0.5f + 0.5f * local.x / radius, 0.5f + 0.5f * local.y / radius};
  }
  /// −1: outside of all.
  int cell(const Vec2f& u) const {
    if (!(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1)) return -1;
    return int(u.x * rows) * columns + int(u.y * columns);
  }
  /// Area or solid angle of one cell.
  double size() const {
    return (infinite ? 4.0 * double(radius * radius) : double(2.0f * pi * one_minus_cos)) / count;
  }
};

/// A ray through place `u` of the unit square, all else about it random with density `other_pdf`.
EmittedRay ray_at(const Light& source, const Cells& cells, const Vec2f& u, Random& random,
                  float& other_pdf) {
  EmittedRay ray;
  if (cells.infinite) {
    const TravelDirection travel = source.distant().sample_travel_direction(random.pair());
    ray.ray.direction = travel.direction;
    other_pdf = travel.pdf;
    const Vec3f local((2.0f * u.x - 1.0f) * cells.radius, (2.0f * u.y - 1.0f) * cells.radius, 0);
    ray.origin.position = cells.center + Frame(ray.ray.direction).to_world(local);
    return ray;
  }
  const EmissionSample origin = source.placed().sample_origin(random.pair());
  other_pdf = origin.pdf_position;
  ray.origin = origin.point;
  ray.on_surface = origin.on_surface;
  const float z = 1.0f - u.x * cells.one_minus_cos, phi = 2.0f * pi * (u.y - 0.5f);
  const float r = safe_sqrt(1.0f - z * z);
  ray.ray.direction = cells.cone.to_world(Vec3f(r * std::cos(phi), r * std::sin(phi), z));
  return ray;
}

/// Whether the light's surface (if any) emits along the ray.
bool leaves(const EmittedRay& ray) {
  return !ray.on_surface || dot(ray.origin.ng, ray.ray.direction) > 0;
}

double density_p_value(const Scene& scene, const EmissionSampler& sampler, float planted_factor) {
  const Light& source = *scene.lights()[0];
  const Cells cells(source, find_targets(scene, Lobes::specular, 64));
  Random random(7);
  // Origins vary on lights with a surface.
  const int samples = 100'000 / sample_divisor;
  const int per_cell = (source.traits().shape >= 0 ? 5000 : 1000) / sample_divisor;
  std::vector<double> found(Cells::count, 0), expected(Cells::count, 0), variance(Cells::count, 0);
  for (int i = 0; i < samples; ++i) {
    const EmittedRay ray = draw(sampler, random);
    if (!(ray.pdf_position * ray.pdf_direction > 0)) continue;
    const int cell = cells.cell(cells.unit(ray));
    if (cell >= 0) ++found[size_t(cell)];
  }
  for (int cell = 0; cell < Cells::count; ++cell) {
    RunningStatistics density;
    for (int k = 0; k < per_cell; ++k) {
      const Vec2f jitter = random.pair();
      const Vec2f u((float(cell / Cells::columns) + jitter.x) / Cells::rows,
                    (float(cell % Cells::columns) + jitter.y) / Cells::columns);
      float other_pdf = 0;
      const EmittedRay ray = ray_at(source, cells, u, random, other_pdf);
      const float pdf = sampler.pdf(0, ray.origin, ray.ray.direction);
      density.add(leaves(ray) ? double(planted_factor * pdf / other_pdf) : 0.0);
    }
    const double scale = cells.size() * samples;
    expected[size_t(cell)] = density.mean() * scale;
    variance[size_t(cell)] = std::pow(density.standard_error() * scale, 2);
  }
  // Only cells whose expectation is known well: estimates from a few large values are skewed.
  double chi_square = 0;
  int cells_used = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    if (!(expected[i] > 20 && variance[i] < 0.02 * expected[i] * expected[i])) continue;
    const double spread = expected[i] * (1.0 - expected[i] / samples) + variance[i] + 1e-9;
    chi_square += (found[i] - expected[i]) * (found[i] - expected[i]) / spread;
    ++cells_used;
  }
  // Many cells hide an error of all of them alike, the sum shows it.
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  const double total_variance = std::accumulate(variance.begin(), variance.end(), 0.0);
  const double excess = std::accumulate(found.begin(), found.end(), 0.0) - total;
  const double lost = std::max(0.0, 1.0 - total / samples);
  const double p_total = z_test_p_value(excess, std::sqrt(total * lost + total_variance), 0.0);
  return 2.0 * std::min(chi_square_p_value(chi_square, cells_used), p_total);
}

TEST(EmissionDensity, SamplesFollowIt) {
  const std::vector<Targets> sets = target_sets();
  const double level = sidak_level(0.01, int(2 * sets.size() * light_kinds().size()));
  for (const Aim aim : aims)
    for (const Targets& targets : sets)
      for (const std::string& kind : light_kinds()) {
        const auto scene = scene_of(kind, targets);
        EXPECT_GT(density_p_value(*scene, aimed_at(*scene, aim), 1.0f), level)
            << kind << " light, target " << targets.name << ", " << name_of(aim);
      }
}

#ifndef KAUSTIK_SLOW_BUILD
TEST(EmissionDensity, WrongOneIsFound) {
  for (const Aim aim : aims)
    for (const std::string& kind : light_kinds()) {
      const auto scene = scene_of(kind, target_sets()[0]);
      EXPECT_LT(density_p_value(*scene, aimed_at(*scene, aim), 1.02f), 1e-3)
          << kind << ", " << name_of(aim);
    }
}
#endif

TEST(EmissionDensity, OfASampleIsWhatPdfSays) {
  for (const Targets& targets : target_sets()) {
    for (const std::string& kind : light_kinds()) {
      const auto scene = scene_of(kind, targets);
      const EmissionSampler aimed = aimed_at(*scene), by_power(*scene);
      const EmissionSampler mapped = aimed_at(*scene, Aim::projection_map);
      for (const EmissionSampler* sampler : {&aimed, &mapped, &by_power}) {
        Random random(3);
        for (int i = 0; i < 300; ++i) {
          const EmittedRay ray = draw(*sampler, random);
          if (ray.flux.is_zero()) continue;
          const float pdf = ray.pdf_position * ray.pdf_direction;
          EXPECT_NEAR(sampler->pdf(0, ray.origin, ray.ray.direction), pdf, 1e-4f * pdf)
              << kind << " " << targets.name;
        }
      }
    }
  }
}

/// A ray by power that meets a target has a density above zero when aimed.
TEST(EmissionDensity, IsZeroOnlyWhereNoBoxIsMet) {
  for (const Targets& targets : target_sets()) {
    for (const std::string& kind : light_kinds()) {
      const auto scene = scene_of(kind, targets);
      const std::vector<AimTarget> boxes = find_targets(*scene, Lobes::specular, 64);
      const EmissionSampler aimed(*scene, boxes), by_power(*scene);
      const EmissionSampler mapped = aimed_at(*scene, Aim::projection_map);
      Random random(5);
      int met = 0;
      for (int i = 0; i < 40'000 / sample_divisor; ++i) {
        const EmittedRay ray = draw(by_power, random);
        Hit hit;
        if (!scene->intersect(ray.ray, hit)) continue;
        if (!any(scene->surface(hit.shape).bsdf->traits().lobes & Lobes::specular)) continue;
        ++met;
        EXPECT_GT(aimed.pdf(0, ray.origin, ray.ray.direction), 0) << kind << " " << targets.name;
        EXPECT_GT(mapped.pdf(0, ray.origin, ray.ray.direction), 0) << kind << " " << targets.name;
      }
      if (targets.name != "pin" && sample_divisor == 1 &&
          !(targets.name == "at the horizon" && (kind == "spot" || kind == "rectangle"))) {
        EXPECT_GT(met, 50) << kind << " " << targets.name;
      }
    }
  }
}

// ---------------------------------------------------------------- flux that arrives

/// What is measured: flux that meets specular shapes first, with a filter on how obliquely.
using Filter = std::function<bool(float cosine)>;

bool is_target(const Scene& scene, uint32_t shape) {
  return any(scene.surface(shape).bsdf->traits().lobes & Lobes::specular);
}

void add_flux(const Scene& scene, const EmissionSampler& sampler, const Filter& filter, int count,
              Random& random, RunningStatistics& flux) {
  for (int i = 0; i < count; ++i) {
    const EmittedRay ray = draw(sampler, random);
    double value = 0;
    Hit hit;
    if (!ray.flux.is_zero() && scene.intersect(ray.ray, hit) && is_target(scene, hit.shape)) {
      const SurfacePoint p = scene.tracer().surface_point(ray.ray, hit);
      if (filter(abs_dot(p.ng, ray.ray.direction))) value = double(ray.flux[0]);
    }
    flux.add(value);
  }
}

Ray shadow_ray(const SurfacePoint& point, const LightSample& l) {
  if (std::isinf(l.distance)) return spawn_ray(point, l.direction);
  return l.on_surface ? spawn_ray_to(point, l.point) : spawn_ray_to(point, l.point.position);
}

/// The same found the other way round: points on the targets sample the light.
void add_irradiance(const Scene& scene, const Filter& filter, int count, Random& random,
                    RunningStatistics& flux) {
  const Light& source = *scene.lights()[0];
  std::vector<uint32_t> shapes;
  for (uint32_t s = 0; s < scene.surface_count(); ++s)
    if (is_target(scene, s)) shapes.push_back(s);
  for (int i = 0; i < count; ++i) {
    const uint32_t shape = shapes[size_t(random.number() * float(shapes.size()))];
    const ShapeSample on_target = scene.tracer().shape(shape).sample_area(random.pair());
    const LightSample l = source.sample_toward(on_target.point.position, random.pair());
    const float cosine = abs_dot(l.direction, on_target.point.ng);
    double value = 0;
    if (l.pdf_solid_angle > 0 && filter(cosine) && !scene.occluded(shadow_ray(on_target.point, l)))
      value = double(l.radiance[0] * cosine / (l.pdf_solid_angle * on_target.pdf_area));
    flux.add(value * double(shapes.size()));
  }
}

/// Relative standard error that is asked for; cells waste more rays than cones on small targets.
double accuracy_of(Aim aim) {
  return (aim == Aim::boxes ? 0.003 : 0.008) * (sample_divisor == 1 ? 1 : 10);
}

template <typename Add>
RunningStatistics until_exact(double accuracy, const Add& add) {
  RunningStatistics flux;
  for (int round = 0; round < 200; ++round) {
    add(20'000 / sample_divisor, flux);
    if (flux.mean() > 0 && flux.standard_error() < 0.93 * accuracy * flux.mean()) break;
  }
  return flux;
}

/// p value of aimed flux × `planted_factor` against the flux that the targets find themselves.
double flux_p_value(const Scene& scene, const EmissionSampler& sampler, const Filter& filter,
                    double planted_factor, double accuracy = accuracy_of(Aim::boxes)) {
  Random random(11);
  const RunningStatistics aimed = until_exact(accuracy, [&](int count, RunningStatistics& flux) {
    add_flux(scene, sampler, filter, count, random, flux);
  });
  const RunningStatistics expected = until_exact(accuracy, [&](int count, RunningStatistics& flux) {
    add_irradiance(scene, filter, count, random, flux);
  });
  EXPECT_LE(aimed.standard_error(), accuracy * aimed.mean());
  EXPECT_LE(expected.standard_error(), accuracy * expected.mean());
  const double error =
      std::hypot(planted_factor * aimed.standard_error(), expected.standard_error());
  return z_test_p_value(planted_factor * aimed.mean() - expected.mean(), error, 0.0);
}

bool anywhere(float) { return true; }
bool near_silhouette(float cosine) { return cosine < 0.4f; }

/// A spot and a light that faces away can't reach everything.
bool reaches(const std::string& kind, const Targets& targets) {
  return targets.name != "at the horizon" || (kind != "spot" && kind != "rectangle");
}

double flux_level() { return sidak_level(0.01, int(6 * light_kinds().size())); }

TEST(AimedEmission, FluxThatArrivesIsThatOfTheLight) {
  for (const Targets& targets : target_sets()) {
    for (const std::string& kind : light_kinds()) {
      if (!reaches(kind, targets)) continue;
      const auto scene = scene_of(kind, targets);
      for (const Aim aim : aims) {
        // Cells are much wider than the pin.
        if (aim == Aim::projection_map && targets.name == "pin") continue;
        EXPECT_GT(flux_p_value(*scene, aimed_at(*scene, aim), anywhere, 1.0, accuracy_of(aim)),
                  flux_level())
            << kind << " light, target " << targets.name << ", " << name_of(aim);
      }
    }
  }
}

TEST(AimedEmission, FurtherLightsKeepTheirDensitiesAndTheirFlux) {
  for (const std::string& kind : further_light_kinds()) {
    const auto scene = scene_of(kind, target_sets()[1]);
    const EmissionSampler aimed = aimed_at(*scene);
    EXPECT_GT(density_p_value(*scene, aimed, 1.0f), flux_level()) << kind;
    EXPECT_GT(flux_p_value(*scene, aimed, anywhere, 1.0), flux_level()) << kind;
    if (sample_divisor == 1) {
      EXPECT_LT(flux_p_value(*scene, aimed, anywhere, 1.03), flux_level()) << kind;
    }
  }
}

TEST(AimedEmission, FluxAtASilhouette) {
  for (const std::string& kind : light_kinds()) {
    const auto scene = scene_of(kind, target_sets()[0]);
    for (const Aim aim : aims)
      EXPECT_GT(flux_p_value(*scene, aimed_at(*scene, aim), near_silhouette, 1.0, accuracy_of(aim)),
                flux_level())
          << kind << ", " << name_of(aim);
  }
}

#ifndef KAUSTIK_SLOW_BUILD
TEST(AimedEmission, WrongFluxIsFound) {
  for (const std::string& kind : light_kinds()) {
    const auto scene = scene_of(kind, target_sets()[1]);
    EXPECT_LT(flux_p_value(*scene, aimed_at(*scene), anywhere, 1.02), flux_level()) << kind;
    const auto other = scene_of(kind, target_sets()[0]);
    EXPECT_LT(flux_p_value(*other, aimed_at(*other, Aim::projection_map), anywhere, 1.05,
                           accuracy_of(Aim::projection_map)),
              flux_level())
        << kind;
  }
}
#endif

/// The variance of the flux per photon, beside that of the light's own distribution.
TEST(AimedEmission, PaysForSmallTargets) {
  for (const std::string& kind : light_kinds()) {
    const auto scene = scene_of(kind, target_sets()[0]);
    RunningStatistics own;
    Random random(13);
    add_flux(*scene, EmissionSampler(*scene), anywhere, 20'000, random, own);
    for (const Aim aim : aims) {
      RunningStatistics aimed;
      add_flux(*scene, aimed_at(*scene, aim), anywhere, 20'000, random, aimed);
      std::printf("  %-12s %-15s variance %.4f of that of the light's own distribution\n",
                  kind.c_str(), name_of(aim).c_str(), aimed.variance() / own.variance());
      EXPECT_LT(aimed.variance(), 0.7 * own.variance()) << kind;
    }
  }
}

TEST(AimedEmission, NothingWithoutTargets) {
  for (const std::string& kind : light_kinds()) {
    const auto scene = scene_of(kind, {"", {sphere(Vec3d(0, 0, 0), 1, test::black())}});
    EXPECT_TRUE(find_targets(*scene, Lobes::specular, 64).empty());
    const EmissionSampler aimed = aimed_at(*scene);
    EXPECT_TRUE(aimed.aimed());
    Random random(1);
    const EmittedRay ray = draw(aimed, random);
    EXPECT_TRUE(ray.flux.is_zero());
    EXPECT_EQ(ray.origin.ng, Vec3f(0, 0, 0));
    EXPECT_EQ(aimed.pdf(0, ray.origin, {0, 0, -1}), 0);
  }
}

TEST(AimedEmission, RaysOfInfiniteLightsStartOutside) {
  for (const std::string kind : {"directional", "constant"}) {
    const auto scene = scene_of(kind, target_sets()[2]);
    const EmissionSampler aimed = aimed_at(*scene);
    Random random(1);
    for (int i = 0; i < 1000; ++i)
      EXPECT_FALSE(scene->tracer().bounds().intersects(draw(aimed, random).ray.origin));
  }
}

/// Hundreds of targets are merged; nothing gets lost and no sample allocates.
TEST(AimedEmission, ManyTargets) {
  std::vector<ObjectPointer> objects;
  for (int i = 0; i < 300; ++i)
    objects.push_back(
        sphere(Vec3d(0.13 * (i % 20) - 1.3, 0.13 * (i / 20) - 1, 0), 0.05, mirror_bsdf()));
  for (const std::string& kind : light_kinds()) {
    const auto scene = scene_of(kind, {"", objects});
    const EmissionSampler aimed(*scene, find_targets(*scene, Lobes::specular, 1000));
    EXPECT_GT(flux_p_value(*scene, aimed, anywhere, 1.0), flux_level()) << kind;
    Random random(1);
    const int64_t before = test::allocation_count();
    for (int i = 0; i < 100; ++i) draw(aimed, random);
    EXPECT_EQ(test::allocation_count() - before, 0) << kind;
  }
}

}  // namespace
}  // namespace kaustik
