// Lights that are meshes: densities of their triangles, and what choosing them by the point gains;
// lights with two sides.

#include <gtest/gtest.h>

#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/ray_tracer.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

/// A gutter along x, open downward: half a tube of radius 1 and `length`, its inside shining.
std::shared_ptr<const Shape> make_gutter(float length, int around, int along) {
  TriangleMesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= around; ++j) {
      const float angle = pi * float(j) / float(around);
      mesh.positions.push_back(
          {length * float(i) / float(along), std::cos(angle), std::sin(angle)});
    }
  const auto node = [&](int i, int j) { return uint32_t(i * (around + 1) + j); };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({node(i, j), node(i + 1, j), node(i, j + 1)});
      mesh.triangles.push_back({node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  auto shape = std::make_shared<MeshShape>(mesh);
  const ShapeSample s = shape->sample_area({0.3f, 0.3f});
  if (dot(s.point.ng, Vec3f(0, s.point.position.y, s.point.position.z)) < 0) return shape;
  for (auto& corner : mesh.triangles) std::swap(corner[1], corner[2]);
  return std::make_shared<MeshShape>(mesh);
}

std::unique_ptr<Light> make_area(std::shared_ptr<const Shape> shape, bool two_sided = false) {
  return make_light("area", {{"radiance", Value(1.0), {}}, {"two_sided", Value(two_sided), {}}},
                    std::move(shape));
}

LightQuery query_at(int level) { return {{0.5f, 0.2f, 0.1f}, {0, 0, 1}, level}; }

TEST(MeshLight, PointsFollowTheirDensityAtEveryLevel) {
  const auto gutter = make_gutter(6, 8, 12);
  const auto light = make_area(gutter);
  const RayTracer tracer({{gutter}, {}, {}});
  for (const int level : {0, 1, 3}) {
    SCOPED_TRACE(level);
    const LightQuery query = query_at(level);
    Random random(11);
    const auto sample = [&] {
      const LightSample s = light->sample_toward(query, random.next_2d());
      return s.pdf_solid_angle > 0 ? s.direction : Vec3f(0, 0, 0);
    };
    const auto pdf = [&](const Vec3f& direction) -> double {
      const Ray ray{query.reference, direction};
      Hit hit;
      if (!tracer.intersect(ray, hit)) return 0;
      return light->pdf_toward(query, tracer.surface_point(ray, hit));
    };
    DirectionGrid grid;
    grid.fine = 64;
    const int count = 500'000 / sample_share;
    EXPECT_GT(direction_p_value(grid, count, sample, pdf), failure_level);
    expect_twin_fails(direction_p_value(grid, count, sample, with_planted_error(grid, pdf)));
  }
}

TEST(MeshLight, ReportsTheDensityThatItAnswersLater) {
  const auto light = make_area(make_gutter(6, 8, 12));
  Random random(13);
  for (int i = 0; i < 3000; ++i) {
    const LightQuery query = query_at(i % 4);
    const LightSample s = light->sample_toward(query, random.next_2d());
    if (!(s.pdf_solid_angle > 0)) continue;
    ASSERT_FLOAT_EQ(s.pdf_solid_angle, light->pdf_toward(query, s.point));
  }
}

/// Irradiance of one sample: its mean, and its variance over the squared mean.
RunningStatistics irradiance(const std::function<LightSample(const Vec2f&)>& sample, int count) {
  RunningStatistics result;
  Random random(17);
  for (int i = 0; i < count / sample_share; ++i) {
    const LightSample s = sample(random.next_2d());
    result.add(s.pdf_solid_angle > 0
                   ? s.radiance[0] * std::max(0.0f, s.direction.z) / s.pdf_solid_angle
                   : 0.0);
  }
  return result;
}

double relative_variance(const RunningStatistics& s) {
  return s.variance() / (s.mean() * s.mean());
}

TEST(MeshLight, FacesBringLessNoiseThanArea) {
  const auto gutter = make_gutter(40, 16, 60);  // from one end most of it is far away
  const auto light = make_area(gutter);
  const auto by_area = irradiance(
      [&](const Vec2f& u) {
        const LightQuery query = query_at(0);
        LightSample result;
        float pdf = 0;
        const ShapeSample s = gutter->sample_area(u);
        const Vec3f to_light = s.point.position - query.reference;
        result.direction = normalize(to_light);
        pdf = gutter->pdf_toward(query.reference, s.point);
        if (dot(s.point.ng, result.direction) < 0) {
          result.radiance = Spectrum(1);
          result.pdf_solid_angle = pdf;
        }
        return result;
      },
      2'000'000);
  std::array<RunningStatistics, 2> by_faces;
  for (const int level : {0, 1})
    by_faces[size_t(level)] = irradiance(
        [&](const Vec2f& u) { return light->sample_toward(query_at(level), u); }, 200'000);
  for (const RunningStatistics& s : by_faces) {
    const double error = std::hypot(s.standard_error(), by_area.standard_error());
    EXPECT_GT(z_test_p_value(s.mean(), error, by_area.mean()), failure_level);
    expect_twin_fails(z_test_p_value(1.03 * s.mean(), error, by_area.mean()));
  }
  std::printf("  relative variance: by area %.3f, by faces %.3f, at level 1 %.3f\n",
              relative_variance(by_area), relative_variance(by_faces[0]),
              relative_variance(by_faces[1]));
  EXPECT_LT(relative_variance(by_faces[0]), 0.05 * relative_variance(by_area));
  EXPECT_LT(relative_variance(by_faces[1]), 0.3 * relative_variance(by_area));
}

TEST(TwoSided, ShinesBothWays) {
  const auto sheet = make_area(make_disk({0, 0, 1}, {0, 0, 1}, 0.5f), true);
  const double expected = std::numbers::pi * 0.25 / 1.25;  // of a disk over its axis
  for (const float z : {0.0f, 2.0f}) {
    Random random(19);
    RunningStatistics below;
    for (int i = 0; i < 200'000 / sample_share; ++i) {
      const LightSample s = sheet->sample_toward(Vec3f(0, 0, z), random.next_2d());
      below.add(s.radiance[0] * std::fabs(s.direction.z) / s.pdf_solid_angle);
      ASSERT_FLOAT_EQ(s.pdf_solid_angle, sheet->pdf_toward(Vec3f(0, 0, z), s.point));
      ASSERT_EQ(s.radiance, sheet->emitted(s.point, -s.direction, {}));
    }
    EXPECT_GT(z_test_p_value(below, expected), failure_level);
    expect_twin_fails(z_test_p_value(below, 1.02 * expected));
  }
  EXPECT_NEAR(sheet->traits().power[0], 2 * pi * pi * 0.25, 1e-4);
}

TEST(TwoSided, EmitsAsMuchBehindAsBefore) {
  const auto sheet = make_area(make_disk({0, 0, 1}, {0, 0, 1}, 0.5f), true);
  Random random(23);
  RunningStatistics before, behind;
  for (int i = 0; i < 400'000 / sample_share; ++i) {
    const Vec2f u = random.next_2d();
    const EmissionSample s = sheet->sample_emission(u, random.next_2d(), {});
    ASSERT_FLOAT_EQ(s.pdf_position, sheet->emission_pdf_position(s.point));
    ASSERT_NEAR(s.pdf_direction, sheet->emission_pdf_direction(s.point, s.direction), 1e-5);
    before.add(s.direction.z > 0 ? s.flux[0] : 0.0);
    behind.add(s.direction.z < 0 ? s.flux[0] : 0.0);
  }
  const double half = 0.5 * sheet->traits().power[0];
  for (const RunningStatistics& side : {before, behind}) {
    EXPECT_GT(z_test_p_value(side, half), failure_level);
    expect_twin_fails(z_test_p_value(side, 1.02 * half));
  }
}

}  // namespace
}  // namespace kaustik
