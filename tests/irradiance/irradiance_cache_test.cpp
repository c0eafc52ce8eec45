#include "kaustik/irradiance/irradiance_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <stdexcept>

#include "kaustik/base/parallel.h"
#include "kaustik/base/statistics.h"
#include "kaustik/irradiance/record_octree.h"
#include "tests/irradiance/test_sources.h"

namespace kaustik {
namespace {

using test::RectangleSource;
using test::RoomSource;
using test::surface_point;
using test::UniformSource;

#ifdef KAUSTIK_SLOW_BUILD
constexpr int resolution = 40;
#else
constexpr int resolution = 100;
#endif

const Vec3f z_axis(0, 0, 1);

CachePoint cache_point(const Vec3f& position, const Vec3f& normal, float pixel_width = 0) {
  return {surface_point(position, normal), normal, pixel_width, 1};
}

/// A square grid of points on the plane z = 0 over [0, 1]².
std::vector<CachePoint> floor_points(int n, float pixel_width = 0) {
  std::vector<CachePoint> points;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      points.push_back(cache_point({(float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n), 0},
                                   z_axis, pixel_width));
  return points;
}

/// What a camera in the middle of one wall of the room sees, some points on the ball.
std::vector<CachePoint> room_points(int n) {
  const RoomSource room;
  const Vec3f eye(0.5f, 0.02f, 0.5f);
  std::vector<CachePoint> points;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec3f d = normalize(
          Vec3f(2 * (float(x) + 0.5f) / float(n) - 1, 1, 2 * (float(y) + 0.5f) / float(n) - 1));
      Sampler sampler(1, 1);
      const float distance = room.incoming(surface_point(eye, z_axis), d, sampler).distance;
      const Vec3f p = eye + d * distance;
      Vec3f normal(0, 0, 0);
      if (length(p - room.ball_center) < 1.001f * room.ball_radius)
        normal = normalize(p - room.ball_center);
      else
        for (int axis = 0; axis < 3 && length_sq(normal) == 0; ++axis)
          normal[axis] = p[axis] > 0.9999f ? -1.0f : p[axis] < 0.0001f ? 1.0f : 0.0f;
      points.push_back(cache_point(p, normal, 2 * distance / float(n)));
    }
  return points;
}

CacheSettings settings_with(float quality, int samples,
                            CacheMetric metric = CacheMetric::split_sphere) {
  CacheSettings settings;
  settings.metric = metric;
  settings.quality = quality;
  settings.hemisphere.samples = samples;
  return settings;
}

size_t fill(IrradianceCache& cache, const std::vector<CachePoint>& points,
            const RadianceSource& source, uint32_t round = 0) {
  return cache.fill_round(points, source, Sampler(17, 3), round, {});
}

TEST(irradiance_cache, uniform_light_everywhere) {
  IrradianceCache cache(settings_with(0.15f, 50));
  const auto points = floor_points(30);
  const size_t inserted = fill(cache, points, UniformSource(Spectrum(1, 2, 3, 0)));
  EXPECT_EQ(inserted, cache.record_count());
  EXPECT_GT(inserted, 0u);
  EXPECT_LT(inserted, 100u);
  EXPECT_EQ(cache.rays_traced(), 50 * inserted);
  for (const CachePoint& p : points) {
    Spectrum e;
    ASSERT_TRUE(cache.interpolate(p, e));
    for (int lane = 0; lane < 4; ++lane)
      EXPECT_NEAR(e[lane], pi * Spectrum(1, 2, 3, 0)[lane], 1e-4f);
  }
}

TEST(irradiance_cache, serves_all_points_of_all_rounds) {
  const RoomSource room;
  const auto points = room_points(resolution);
  const std::vector<CachePoint> half(points.begin(), points.begin() + long(points.size() / 2));
  IrradianceCache cache(settings_with(0.15f, 100));
  const size_t first = fill(cache, half, room, 0);
  EXPECT_EQ(fill(cache, half, room, 1), 0u);
  const size_t second = fill(cache, points, room, 2);
  EXPECT_GT(second, 0u);
  EXPECT_EQ(cache.record_count(), first + second);
  EXPECT_LT(cache.record_count(), points.size() / 3);
  for (const CachePoint& p : points) {
    Spectrum e;
    ASSERT_TRUE(cache.interpolate(p, e));
  }
  EXPECT_GT(cache.size_in_bytes(), 100 * cache.record_count());
}

/// Root of the mean squared relative error on the floor below a bright rectangle.
double floor_error(const CacheSettings& settings, size_t* records = nullptr) {
  const RectangleSource source;
  IrradianceCache cache(settings);
  fill(cache, floor_points(50), source);
  if (records) *records = cache.record_count();
  double sum = 0;
  const auto probes = floor_points(33);
  for (const CachePoint& p : probes) {
    Spectrum e;
    EXPECT_TRUE(cache.interpolate(p, e));
    const double exact = source.form_integral(Vec3d(p.point.position), Vec3d(0, 0, 1));
    sum += std::pow(double(e[0]) / exact - 1, 2);
  }
  return std::sqrt(sum / double(probes.size()));
}

void expect_error_falls(CacheMetric metric, const float (&qualities)[3]) {
  size_t coarse_records, medium_records, fine_records;
  const double coarse = floor_error(settings_with(qualities[0], 2500, metric), &coarse_records);
  const double medium = floor_error(settings_with(qualities[1], 2500, metric), &medium_records);
  const double fine = floor_error(settings_with(qualities[2], 2500, metric), &fine_records);
  EXPECT_LT(coarse_records, medium_records);
  EXPECT_LT(medium_records, fine_records);
  EXPECT_LT(medium, 0.7 * coarse);
  EXPECT_LT(fine, 0.7 * medium);
  EXPECT_LT(fine, 0.015);
}

TEST(irradiance_cache, error_falls_with_quality) {
  expect_error_falls(CacheMetric::split_sphere, {0.6f, 0.3f, 0.1f});
  expect_error_falls(CacheMetric::hessian, {2.4f, 1.2f, 0.6f});
}

/// The second derivative tells what gradients leave out: without them, distances serve.
TEST(irradiance_cache, without_gradients_distances_tell) {
  CacheSettings settings = settings_with(0.3f, 400, CacheMetric::hessian);
  size_t with_gradients, records, by_distance;
  floor_error(settings, &with_gradients);
  settings.gradients = false;
  const double error = floor_error(settings, &records);
  settings.metric = CacheMetric::split_sphere;
  EXPECT_EQ(error, floor_error(settings, &by_distance));
  EXPECT_EQ(records, by_distance);
  EXPECT_NE(records, with_gradients);
}

TEST(irradiance_cache, gradients_make_it_better) {
  for (const CacheMetric metric : {CacheMetric::split_sphere, CacheMetric::hessian}) {
    CacheSettings settings = settings_with(0.3f, 2500, metric);
    const double with = floor_error(settings);
    settings.gradients = false;
    EXPECT_LT(with, 0.7 * floor_error(settings));
  }
}

TEST(irradiance_cache, hessian_spends_records_better) {
  size_t by_distance, by_hessian;
  const double error_by_distance =
      floor_error(settings_with(0.25f, 2500, CacheMetric::split_sphere), &by_distance);
  const double error_by_hessian =
      floor_error(settings_with(0.6f, 2500, CacheMetric::hessian), &by_hessian);
  EXPECT_LE(by_hessian, by_distance * 13 / 10);
  EXPECT_LT(error_by_hessian, 0.7 * error_by_distance);
}

TEST(irradiance_cache, neighbours_clamp_and_minimum_distances_are_shorter) {
  const RoomSource room;
  const auto points = room_points(resolution);
  const auto records = [&](bool clamping, bool minimum) {
    CacheSettings settings = settings_with(0.3f, 60);
    settings.neighbor_clamping = clamping;
    settings.minimum_distance = minimum;
    settings.maximum_spacing = 1000;
    settings.minimum_spacing = 0;
    settings.gradients = false;
    IrradianceCache cache(settings);
    fill(cache, points, room);
    return cache.record_count();
  };
  EXPECT_GT(records(true, false), records(false, false) * 11 / 10);
  EXPECT_GT(records(false, true), records(false, false) * 11 / 10);
}

TEST(irradiance_cache, points_that_tolerate_more_ask_for_fewer_records) {
  const RoomSource room;
  auto points = room_points(resolution);
  const auto records = [&](float tolerance) {
    for (CachePoint& p : points) p.tolerance = tolerance;
    IrradianceCache cache(settings_with(0.3f, 60));
    fill(cache, points, room);
    for (const CachePoint& p : points) {
      Spectrum e;
      EXPECT_TRUE(cache.interpolate(p, e));
    }
    return cache.record_count();
  };
  EXPECT_LT(records(1.5f), records(1) * 8 / 10);
  EXPECT_EQ(records(100), records(RecordOctree::overlap));
  EXPECT_EQ(records(0), records(1));
}

/// A record that was made for wide pixels reaches far for those who see it so, and not for who
/// looks from nearby, whose points get records of their own.
TEST(irradiance_cache, who_sees_more_sharply_gets_records_of_its_own) {
  const RoomSource room;
  const auto far = floor_points(resolution, 0.1f), near = floor_points(resolution, 0.005f);
  IrradianceCache for_near(settings_with(0.3f, 60)), for_both(settings_with(0.3f, 60));
  fill(for_near, near, room);
  fill(for_both, far, room);
  const size_t wide = for_both.record_count();
  const auto unserved = [&](const std::vector<CachePoint>& points) {
    return std::count_if(points.begin(), points.end(),
                         [&](const CachePoint& p) { return !for_both.serves(p); });
  };
  EXPECT_EQ(unserved(far), 0);
  EXPECT_GT(unserved(near), int64_t(near.size() / 2));
  fill(for_both, near, room);
  EXPECT_EQ(unserved(near), 0);
  EXPECT_GT(for_both.record_count() - wide, for_near.record_count() / 2);
}

TEST(irradiance_cache, sides_do_not_share) {
  IrradianceCache cache(settings_with(0.3f, 50));
  fill(cache, floor_points(30), UniformSource(Spectrum(1), 1));
  Spectrum e;
  EXPECT_TRUE(cache.interpolate(cache_point({0.5f, 0.5f, 0}, z_axis), e));
  EXPECT_FALSE(cache.interpolate(cache_point({0.5f, 0.5f, 0}, -z_axis), e));
  EXPECT_FALSE(cache.interpolate(cache_point({0.5f, 0.5f, 0}, {1, 0, 0}), e));
  // Below the floor (it looks out from under it) nearer than above.
  EXPECT_FALSE(cache.interpolate(cache_point({0.5f, 0.5f, -0.1f}, z_axis), e));
  EXPECT_TRUE(cache.interpolate(cache_point({0.5f, 0.5f, 0.1f}, z_axis), e));
  EXPECT_FALSE(cache.interpolate(cache_point({0.5f, 0.5f, 0.3f}, z_axis), e));
}

/// How far a single record is used when what it sees is `distance` away.
float measured_reach(CacheSettings settings, float distance, float pixel_width) {
  IrradianceCache cache(settings);
  fill(cache, {cache_point({0, 0, 0}, z_axis, pixel_width)}, UniformSource(Spectrum(1), distance));
  float reach = 0;
  Spectrum e;
  while (reach < 1000 && cache.interpolate(cache_point({reach, 0, 0}, z_axis), e)) reach += 0.01f;
  return reach / RecordOctree::overlap;
}

TEST(irradiance_cache, spacing_is_kept) {
  CacheSettings settings = settings_with(0.2f, 50);
  settings.minimum_spacing = 3;
  settings.maximum_spacing = 20;
  EXPECT_NEAR(measured_reach(settings, 10, 0.25f), 2, 0.02f);  // a R
  EXPECT_NEAR(measured_reach(settings, 0.001f, 0.25f), 0.75f, 0.02f);
  EXPECT_NEAR(measured_reach(settings, 1000, 0.25f), 5, 0.02f);
  EXPECT_NEAR(measured_reach(settings, infinity, 0.25f), 5, 0.02f);
}

TEST(irradiance_cache, grooves_do_not_darken_what_lies_beside_them) {
  // A floor under even light, with a groove far thinner than the least spacing, from which little
  // of the light is seen.
  class GroovedFloor : public RadianceSource {
   public:
    static bool in_groove(float x) { return std::fabs(x - 0.5f) < 0.001f; }
    Incoming incoming(const SurfacePoint& from, const Vec3f& direction, Sampler&) const override {
      if (in_groove(from.position.x) && direction.z < 0.9f) return {Spectrum(), 0.001f};
      return {Spectrum(1.0f), 1 / direction.z};
    }
  };
  for (const CacheMetric metric : {CacheMetric::split_sphere, CacheMetric::hessian}) {
    IrradianceCache cache(settings_with(0.25f, 64, metric));
    const std::vector<CachePoint> floor = floor_points(resolution, 1.0f / resolution);
    fill(cache, floor, GroovedFloor(), 0);
    std::vector<CachePoint> groove;
    for (int i = 0; i < resolution; ++i)
      groove.push_back(
          cache_point({0.5f, (float(i) + 0.5f) / resolution, 0}, z_axis, 1.0f / resolution));
    // The normal of one side of the groove, as far from the floor's as records may be shared.
    for (CachePoint& p : groove) p.normal = p.point.ns = p.point.ng = normalize({0.35f, 0, 1});
    EXPECT_GT(fill(cache, groove, GroovedFloor(), 1), 10u);
    fill(cache, floor, GroovedFloor(), 2);  // the groove has clamped its neighbours' reach
    // Within the least spacing of the groove, and beyond.
    RunningStatistics beside, away;
    for (const CachePoint& p : floor) {
      Spectrum irradiance;
      ASSERT_TRUE(cache.interpolate(p, irradiance));
      const bool near = std::fabs(p.point.position.x - 0.5f) < 3.0f / resolution;
      (near ? beside : away).add(double(irradiance[0]));
    }
    EXPECT_NEAR(beside.mean(), pi, 0.06 * pi);
    EXPECT_NEAR(away.mean(), pi, 0.005 * pi);
    for (const CachePoint& p : groove) {
      Spectrum irradiance;
      ASSERT_TRUE(cache.interpolate(p, irradiance));
    }
  }
}

TEST(irradiance_cache, has_no_seams) {
  const RectangleSource source;
  IrradianceCache cache(settings_with(0.3f, 100));
  fill(cache, floor_points(50), source);
  float previous = 0, largest_step = 0, lowest = infinity, highest = 0;
  const int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    Spectrum e;
    const float x = 0.01f + 0.98f * float(i) / float(steps);
    ASSERT_TRUE(cache.interpolate(cache_point({x, 0.3f, 0}, z_axis), e));
    if (i > 0) largest_step = std::max(largest_step, std::fabs(e[0] - previous));
    previous = e[0];
    lowest = std::min(lowest, e[0]);
    highest = std::max(highest, e[0]);
  }
  EXPECT_LT(largest_step, 0.002f * (highest - lowest));
}

TEST(irradiance_cache, same_bits_for_any_number_of_threads) {
  const RoomSource room;
  const auto points = room_points(resolution);
  const auto results = [&](int threads) {
    std::vector<Spectrum> values(points.size());
    with_threads(threads, [&] {
      IrradianceCache cache(settings_with(0.2f, 60));
      fill(cache, points, room, 0);
      for (size_t i = 0; i < points.size(); ++i)
        EXPECT_TRUE(cache.interpolate(points[i], values[i]));
      values.push_back(Spectrum(float(cache.record_count())));
    });
    return values;
  };
  const auto one = results(1), two = results(2), four = results(4);
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(Spectrum)), 0);
  EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(Spectrum)), 0);
}

TEST(irradiance_cache, is_not_poisoned) {
  class Broken : public RoomSource {
   public:
    Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& s) const override {
      Incoming in = RoomSource::incoming(from, d, s);
      const float u = s.next_1d();
      if (u < 0.02f) in.radiance = Spectrum(std::nanf(""));
      if (u > 0.98f) in.radiance = Spectrum(infinity);
      if (u > 0.5f && u < 0.52f) in.distance = 0;
      if (u > 0.6f && u < 0.62f) in.radiance = Spectrum(-1e30f, 1e38f, 0, 0);
      return in;
    }
  };
  auto points = room_points(resolution);
  points[7].point.position.x = std::nanf("");
  points[8].normal.y = infinity;
  points[9].pixel_width = std::nanf("");
  IrradianceCache cache(settings_with(0.3f, 60));
  fill(cache, points, Broken());
  EXPECT_GT(cache.rays_dropped(), 0u);
  for (const CachePoint& p : points) {
    Spectrum e;
    if (!cache.interpolate(p, e)) continue;
    EXPECT_TRUE(e.is_finite());
    for (int lane = 0; lane < 4; ++lane) EXPECT_GE(e[lane], 0);
  }
}

TEST(irradiance_cache, darkness_and_nothing) {
  IrradianceCache cache(settings_with(0.3f, 50));
  Spectrum e;
  EXPECT_FALSE(cache.interpolate(cache_point({0, 0, 0}, z_axis), e));
  EXPECT_EQ(fill(cache, {}, UniformSource(Spectrum(1))), 0u);
  EXPECT_FALSE(cache.interpolate(cache_point({0, 0, 0}, z_axis), e, 10));
  const auto points = floor_points(10);
  EXPECT_GT(fill(cache, points, UniformSource(Spectrum(0), 1)), 0u);
  for (const CachePoint& p : points) {
    ASSERT_TRUE(cache.interpolate(p, e));
    EXPECT_TRUE(e.is_zero());
  }
}

TEST(irradiance_cache, stops_when_asked) {
  class Stopping : public UniformSource {
   public:
    using UniformSource::UniformSource;
    mutable std::stop_source stop;
    mutable std::atomic<int> rays{0};
    int stop_after = 0;
    Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& s) const override {
      if (++rays == stop_after) stop.request_stop();
      return UniformSource::incoming(from, d, s);
    }
  };
  const auto points = floor_points(100, 0.01f);
  Stopping source(Spectrum(1), 0.05f);
  source.stop_after = 2000;
  IrradianceCache cache(settings_with(0.2f, 100));
  cache.fill_round(points, source, Sampler(1, 1), 0, source.stop.get_token());
  EXPECT_GE(source.rays, 2000);
  EXPECT_LT(source.rays, 4000);
  const int rays = source.rays;
  EXPECT_EQ(cache.fill_round(points, source, Sampler(1, 1), 1, source.stop.get_token()), 0u);
  EXPECT_EQ(source.rays, rays);
  EXPECT_GT(cache.fill_round(points, source, Sampler(1, 1), 2, {}), 50u);
}

TEST(irradiance_cache, refuses_senseless_settings) {
  CacheSettings settings;
  settings.quality = 0;
  EXPECT_THROW(IrradianceCache{settings}, std::invalid_argument);
  settings.quality = std::nanf("");
  EXPECT_THROW(IrradianceCache{settings}, std::invalid_argument);
  settings = {};
  settings.minimum_spacing = 50;
  EXPECT_THROW(IrradianceCache{settings}, std::invalid_argument);
}

}  // namespace
}  // namespace kaustik
