#include "kaustik/irradiance/hemisphere.h"

#include <gtest/gtest.h>

#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "tests/irradiance/test_sources.h"

namespace kaustik {
namespace {

using test::RectangleSource;
using test::surface_point;
using test::UniformSource;

#ifdef KAUSTIK_SLOW_BUILD
constexpr int hemisphere_effort = 1;
#else
constexpr int hemisphere_effort = 10;
#endif

const Vec3f up(0, 0, 1);

TEST(hemisphere_grid, has_at_most_the_wanted_cells) {
  for (int samples = 1; samples < 3000; ++samples) {
    const HemisphereGrid grid = HemisphereGrid::for_samples(samples);
    EXPECT_LE(grid.count(), samples);
    EXPECT_GE(grid.count(), 1);
    if (samples < 50) continue;
    EXPECT_GT(grid.count(), samples * 8 / 10);
    EXPECT_NEAR(float(grid.phi_cells) / float(grid.theta_cells), pi, 0.8f);
  }
}

TEST(hemisphere_grid, finds_the_cell_of_a_direction) {
  const HemisphereGrid grid{7, 22};
  for (int cell = 0; cell < grid.count(); ++cell) {
    for (int i = 0; i < 16; ++i) {
      const Vec2f st(0.05f + 0.3f * float(i % 4), 0.05f + 0.3f * float(i / 4));
      const Vec3f d = grid.direction(cell, st);
      EXPECT_NEAR(length(d), 1, 1e-6f);
      EXPECT_EQ(grid.cell_of(d), cell);
    }
    EXPECT_GT(grid.direction(cell, Vec2f(one_minus_epsilon)).z, 0);
  }
}

TEST(hemisphere_grid, cells_have_equal_projected_solid_angle) {
  const HemisphereGrid grid{6, 19};
  std::vector<double> hits(size_t(grid.count()), 0.0);
  const uint32_t count = 20000 * hemisphere_effort;
  for (uint32_t i = 0; i < count; ++i)
    ++hits[size_t(grid.cell_of(
        square_to_cosine_hemisphere(Sampler::at(3, 0, Stream::training, i, 0).next_2d())))];
  const std::vector<double> expected(hits.size(), double(count) / double(hits.size()));
  EXPECT_GT(chi_square_p_value(hits, expected), 1e-3);
}

TEST(hemisphere, uniform_light_is_exact) {
  const UniformSource source(Spectrum(1, 2, 0.5f, 0), 3);
  const HemisphereEstimate e = sample_hemisphere(source, surface_point({1, 2, 3}, up), up,
                                                 HemisphereSettings{}, Sampler(1, 2));
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(e.irradiance[lane], pi * Spectrum(1, 2, 0.5f, 0)[lane], 1e-5f);
  EXPECT_EQ(e.irradiance[3], 0);
  EXPECT_NEAR(e.harmonic_distance, 3, 1e-5f);
  EXPECT_EQ(e.minimum_distance, 3);
  EXPECT_EQ(e.rays, 200u);
  EXPECT_EQ(e.dropped, 0u);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_LT(length(e.translation_gradient[lane]), 1e-5f);
    EXPECT_LT(length(e.rotation_gradient[lane]), 1e-5f);
  }
}

TEST(hemisphere, open_sky_has_no_distance) {
  const HemisphereEstimate e = sample_hemisphere(
      UniformSource(Spectrum(1)), surface_point({0, 0, 0}, up), up, {}, Sampler(1, 2));
  EXPECT_EQ(e.harmonic_distance, infinity);
  EXPECT_EQ(e.minimum_distance, infinity);
}

TEST(hemisphere, one_sample_is_enough) {
  HemisphereSettings settings;
  settings.samples = 1;
  const HemisphereEstimate e = sample_hemisphere(
      UniformSource(Spectrum(1), 2), surface_point({0, 0, 0}, up), up, settings, Sampler(1, 2));
  EXPECT_NEAR(e.irradiance[0], pi, 1e-5f);
  EXPECT_EQ(e.rays, 1u);
}

/// Statistics over replicates of irradiance and of both gradients in lane 0.
struct Replicates {
  RunningStatistics irradiance, translation[3], rotation[3];
};

Replicates replicate(const RadianceSource& source, const Vec3f& normal, int samples, int count) {
  Replicates r;
  HemisphereSettings settings;
  settings.samples = samples;
  const SurfacePoint at = surface_point({0, 0, 0}, normal);
  for (int i = 0; i < count; ++i) {
    const auto e = sample_hemisphere(source, at, normal, settings, Sampler(hash_mix(9, i), 0));
    r.irradiance.add(double(e.irradiance[0]));
    for (int axis = 0; axis < 3; ++axis) {
      r.translation[axis].add(double(e.translation_gradient[0][axis]));
      r.rotation[axis].add(double(e.rotation_gradient[0][axis]));
    }
  }
  return r;
}

/// Knows where the lamp is, and likes some cells for no reason.
class AimedRectangle : public RectangleSource {
 public:
  bool importance(const SurfacePoint&, const Frame& frame, const HemisphereGrid& grid, Scratch&,
                  std::vector<float>& cell_importance) const override {
    cell_importance.assign(size_t(grid.count()), 0.0f);
    cell_importance[size_t(grid.cell_of(normalize(frame.to_local(Vec3f(0.4f, 0.05f, 0.5f)))))] = 5;
    for (size_t i = 0; i < cell_importance.size(); i += 3) cell_importance[i] += 1;
    return true;
  }
};

TEST(hemisphere, irradiance_is_unbiased_with_and_without_importance) {
  const Vec3f normal = normalize(Vec3f(0.2f, -0.1f, 1));
  const AimedRectangle aimed;
  const RectangleSource plain;
  const double expected = plain.form_integral(Vec3d(0, 0, 0), Vec3d(normal));
  for (const RadianceSource* source :
       {static_cast<const RadianceSource*>(&plain), static_cast<const RadianceSource*>(&aimed)}) {
    const Replicates r = replicate(*source, normal, 200, 300 * hemisphere_effort);
    const RunningStatistics& e = r.irradiance;
    EXPECT_GT(z_test_p_value(e, expected), 1e-3) << e.mean() << " vs " << expected;
    if (hemisphere_effort < 10) continue;
    EXPECT_LT(e.standard_error() / e.mean(), 0.003);
    EXPECT_LT(z_test_p_value(e, 1.02 * expected), 1e-3);
  }
}

TEST(hemisphere, extra_samples_follow_the_importance) {
  // Counts rays by cell; every cell must have one.
  class Counting : public AimedRectangle {
   public:
    mutable std::vector<int> rays;
    mutable HemisphereGrid grid;
    bool importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& g,
                    Scratch& scratch, std::vector<float>& cell_importance) const override {
      grid = g;
      rays.assign(size_t(g.count()), 0);
      return AimedRectangle::importance(at, frame, g, scratch, cell_importance);
    }
    Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& s) const override {
      ++rays[size_t(grid.cell_of(d))];  // the frame of +z is the world's
      return AimedRectangle::incoming(from, d, s);
    }
  };
  const Counting source;
  HemisphereSettings settings;
  settings.samples = 400;
  settings.importance_share = 0.5f;
  const auto e =
      sample_hemisphere(source, surface_point({0, 0, 0}, up), up, settings, Sampler(4, 4));
  EXPECT_EQ(e.rays, 400u);
  for (const int rays : source.rays) EXPECT_GE(rays, 1);
  EXPECT_LE(source.grid.count(), 200);
  const int lamp = source.grid.cell_of(normalize(Vec3f(0.4f, 0.05f, 0.5f)));
  EXPECT_GT(source.rays[size_t(lamp)], 8);
  EXPECT_EQ(source.rays[size_t(lamp == 1 ? 2 : 1)], 1);
}

/// Derivatives of the closed form by central differences.
struct Differences {
  double translation[3], rotation[3];
};

Differences differences(const RectangleSource& source, const Vec3f& normal) {
  Differences d;
  const Vec3d n(normal);
  const double h = 1e-4;
  for (int i = 0; i < 3; ++i) {
    Vec3d axis(0, 0, 0);
    axis[i] = 1;
    const Vec3d tangent = axis - n * n.dot(axis);  // gradients lie in the tangent plane
    d.translation[i] =
        (source.form_integral(tangent * h, n) - source.form_integral(tangent * -h, n)) / (2 * h);
    const Vec3d turned = n + tangent.cross(n) * h, back = n - tangent.cross(n) * h;
    d.rotation[i] = (source.form_integral(Vec3d(0, 0, 0), turned) -
                     source.form_integral(Vec3d(0, 0, 0), back)) /
                    (2 * h);
  }
  return d;
}

/// The largest deviation over three axes beyond 4 standard errors, as a share of the gradient's
/// length.
double deviation(const RunningStatistics (&measured)[3], const double (&expected)[3]) {
  double size_sq = 0, worst = 0;
  for (const double e : expected) size_sq += e * e;
  for (int i = 0; i < 3; ++i) {
    const double beyond =
        std::fabs(measured[i].mean() - expected[i]) - 4 * measured[i].standard_error();
    worst = std::max(worst, beyond);
  }
  return worst / std::sqrt(size_sq);
}

// The gradients of cell means are those of a hemisphere in steps: their deviation shrinks with the
// cells, and is stated here as a share of the gradient's length. A planted error of 2 % shows.
TEST(hemisphere, gradients_match_finite_differences) {
  const RectangleSource source;
  const Vec3f normal = normalize(Vec3f(0.2f, -0.1f, 1));
  const Differences expected = differences(source, normal);
  const Replicates coarse = replicate(source, normal, 400, 200 * hemisphere_effort);
  const Replicates fine = replicate(source, normal, 6400, 20 * hemisphere_effort);
  EXPECT_LT(deviation(coarse.translation, expected.translation), 0.04);
  EXPECT_LT(deviation(fine.translation, expected.translation), 0.008);
  EXPECT_LT(deviation(coarse.rotation, expected.rotation), 0.006);
  EXPECT_LT(deviation(fine.rotation, expected.rotation), 0.002);

  Differences planted = expected;
  for (double& d : planted.translation) d *= 1.02;
  for (double& d : planted.rotation) d *= 1.02;
  EXPECT_GT(deviation(fine.translation, planted.translation), 0.008);
  EXPECT_GT(deviation(fine.rotation, planted.rotation), 0.002);
}

TEST(hemisphere, leaves_out_what_is_not_finite) {
  class Broken : public UniformSource {
   public:
    using UniformSource::UniformSource;
    Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& s) const override {
      Incoming in = UniformSource::incoming(from, d, s);
      const float u = s.next_1d();
      if (u < 0.1f) in.radiance.set(1, std::nanf(""));
      if (u > 0.9f) in.radiance.set(2, infinity);
      if (u > 0.4f && u < 0.5f) in.distance = std::nanf("");
      if (u > 0.5f && u < 0.6f) in.distance = 0;
      return in;
    }
  };
  HemisphereSettings settings;
  settings.samples = 1000;
  const auto e = sample_hemisphere(Broken(Spectrum(1), 2), surface_point({0, 0, 0}, up), up,
                                   settings, Sampler(1, 1));
  EXPECT_NEAR(e.dropped, 200, 60);
  EXPECT_TRUE(e.irradiance.is_finite());
  EXPECT_NEAR(e.irradiance[0], pi * (1 - float(e.dropped) / 1000), 0.05f);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_TRUE(is_finite(e.translation_gradient[lane]));
    EXPECT_TRUE(is_finite(e.rotation_gradient[lane]));
  }
  EXPECT_FALSE(std::isnan(e.harmonic_distance));
  EXPECT_FALSE(std::isnan(e.minimum_distance));
}

TEST(hemisphere, nothing_arrives_from_below_the_geometric_surface) {
  const Vec3f normal = normalize(Vec3f(std::sin(pi / 6), 0, std::cos(pi / 6)));
  for (const float side : {1.0f, -1.0f}) {
    HemisphereSettings settings;
    settings.samples = 20000;
    const auto e =
        sample_hemisphere(UniformSource(Spectrum(1), 2), surface_point({0, 0, 0}, up * side),
                          normal, settings, Sampler(1, 1));
    // Of the disk of projected directions, half and half an ellipse remain.
    EXPECT_NEAR(e.irradiance[0], pi * (1 + std::cos(pi / 6)) / 2, 0.01f);
    EXPECT_LT(e.rays, 19900u);
    EXPECT_LT(length(e.translation_gradient[0]), 1e-3f);
  }
}

}  // namespace
}  // namespace kaustik
