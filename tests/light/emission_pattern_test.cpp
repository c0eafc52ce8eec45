// Area lights whose radiance varies over their surface.

#include "kaustik/light/emission_pattern.h"

#include <gtest/gtest.h>

#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/ray_tracer.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

/// Four fields of the uv square, each with a radiance of its own.
class Fields final : public EmissionPattern {
 public:
  Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
    return spectrum_from_rgb(1, 2, 3) * of(at.uv.x > 0.5f, at.uv.y > 0.5f);
  }
  float maximum() const override { return 15; }
  static float of(int i, int j) {
    constexpr float values[2][2] = {{0, 5}, {1, 0.2f}};
    return values[i][j];
  }
};

std::unique_ptr<Light> make_patterned(
    std::shared_ptr<const Shape> shape, double scale = 1, bool two_sided = false,
    std::shared_ptr<const EmissionPattern> pattern = std::make_shared<Fields>()) {
  return make_light("area", {{"scale", Value(scale), {}}, {"two_sided", Value(two_sided), {}}},
                    std::move(shape), test_bounds(), std::move(pattern));
}

/// Of a surface that faces a rectangle of the sides a and b in the distance 1, by the radiance of
/// the rectangle, whose corner is over it: Howell, Catalog of Radiation Heat Transfer
/// Configuration Factors, B-3, times π.
double irradiance_under_corner(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return 0.5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb));
}

void expect_flux(const RunningStatistics& values, double expected, double factor = 1.02) {
  EXPECT_GT(z_test_p_value(values, expected), failure_level)
      << values.mean() << " ± " << values.standard_error() << ", not " << expected;
  expect_twin_fails(z_test_p_value(values, factor * expected));
}

/// Under a rectangle of four fields: the sum over them.
TEST(EmissionPattern, IrradianceIsTheSumOverTheParts) {
  const double a = 0.6, b = 0.4;
  // Faces down; u along +x, v along −y.
  const auto light = make_patterned(
      make_quad({float(-a), float(b), 1}, {float(2 * a), 0, 0}, {0, float(-2 * b), 0}), 3);
  double expected = 0;
  for (const int i : {0, 1})
    for (const int j : {0, 1})
      expected += 3 * double(Fields::of(i, j)) * irradiance_under_corner(a, b);
  Random random(3);
  RunningStatistics irradiance;
  for (int i = 0; i < 400'000 / sample_share; ++i) {
    const LightSample s = light->sample_toward(Vec3f(0, 0, 0), random.next_2d());
    irradiance.add(s.radiance[0] * s.direction.z / s.pdf_solid_angle);
  }
  expect_flux(irradiance, expected);
  // By a quadrature that edges of the pattern cut through.
  const double power = 2 * 3 * std::numbers::pi * 4 * a * b * (6.2 / 4);
  EXPECT_NEAR(light->traits().power[1], power, 1e-3 * power);
}

/// What leaves by emitted rays is the power, from each field its own share.
TEST(EmissionPattern, EmitsItsPower) {
  const auto quad = make_quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0});
  for (const bool two_sided : {false, true}) {
    const auto light = make_patterned(quad, 1, two_sided);
    Random random(5);
    RunningStatistics total, field;
    for (int i = 0; i < 400'000 / sample_share; ++i) {
      const Vec2f u = random.next_2d();
      const EmissionSample s = light->sample_emission(u, random.next_2d(), {});
      total.add(s.flux[0]);
      field.add(s.point.position.x < 1 && s.point.position.y > 0.5f ? s.flux[0] : 0);
      ASSERT_NEAR((light->emitted(s.point, s.direction, {}) *
                   (dot(s.point.ng, s.direction) / (s.pdf_position * s.pdf_direction)))[0],
                  s.flux[0], 1e-4f * s.flux[0]);
    }
    const double sides = two_sided ? 2 : 1;
    expect_flux(total, double(light->traits().power[0]));
    expect_flux(field, sides * std::numbers::pi * 0.5 * 5);
  }
}

/// Samples, rays that meet the light and emitted rays find the same at a point, on every shape.
TEST(EmissionPattern, IsTheSameForWhoeverAsks) {
  class Waves final : public EmissionPattern {
   public:
    Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
      return Spectrum(2 + std::sin(7 * at.uv.x + 5 * at.uv.y));
    }
    float maximum() const override { return 3; }
  };
  const std::vector<std::pair<const char*, std::vector<Property>>> shapes = {
      {"rectangle", {}}, {"cube", {}}, {"disk", {}}, {"sphere", {}}, {"cylinder", {}}};
  for (const auto& [type, properties] : shapes) {
    SCOPED_TRACE(type);
    const auto shape = make_shape(type, properties);
    const auto light = make_patterned(shape, 2, true, std::make_shared<Waves>());
    const RayTracer tracer({{shape}, {}, {}});
    Random random(7);
    int met = 0;
    const auto expect_seen = [&](const Vec3f& from, const Vec3f& direction,
                                 const SurfacePoint& point, float radiance) {
      const Ray ray{from, direction};
      Hit hit;
      // Grazing rays meet what lies beside the point.
      if (!tracer.intersect(ray, hit) || std::fabs(dot(point.ng, direction)) < 0.05f) return;
      const SurfacePoint seen = tracer.surface_point(ray, hit);
      if (length(seen.position - point.position) > 1e-4f) return;
      // Where the coordinates start anew either side may be met.
      if (std::fabs(seen.uv.x - point.uv.x) + std::fabs(seen.uv.y - point.uv.y) > 0.5f) return;
      ++met;
      ASSERT_NEAR(light->emitted(seen, -direction, {})[0], radiance, 2e-2f);
    };
    const Vec3f reference(2.5f, 1.3f, 2);
    for (int i = 0; i < 2000; ++i) {
      const LightSample s = light->sample_toward(reference, random.next_2d());
      if (s.pdf_solid_angle > 0) expect_seen(reference, s.direction, s.point, s.radiance[0]);
      const Vec2f u = random.next_2d();
      const EmissionSample e = light->sample_emission(u, random.next_2d(), {});
      if (e.pdf_direction > 0)
        expect_seen(e.point.position + e.direction * 0.01f, -e.direction, e.point,
                    light->emitted(e.point, e.direction, {})[0]);
    }
    EXPECT_GT(met, 1000);
  }
}

/// A dark sheet of many triangles with a bright field in a corner: its triangles are chosen more
/// often, and the mean stays.
TEST(EmissionPattern, MeshesAreSampledByRadiance) {
  class Corner final : public EmissionPattern {
   public:
    Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
      return Spectrum(at.position.x < 0.25f && at.position.y < 0.25f ? 8.0f : 0.5f);
    }
    float maximum() const override { return 8; }
  };
  TriangleMesh mesh;
  constexpr int side = 16;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) mesh.positions.push_back({float(i) / side, float(j) / side, 0});
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const auto corner = uint32_t(j * (side + 1) + i);
      mesh.triangles.push_back({corner, corner + 1, corner + side + 2});
      mesh.triangles.push_back({corner, corner + side + 2, corner + side + 1});
    }
  const auto sheet = std::make_shared<MeshShape>(mesh);
  const auto light = make_patterned(sheet, 1, true, std::make_shared<Corner>());
  const LightQuery query({0.5f, 0.5f, -0.5f}, {0, 0, 1});
  Random random(11);
  RunningStatistics by_light, by_area;
  for (int i = 0; i < 400'000 / sample_share; ++i) {
    const LightSample s = light->sample_toward(query, random.next_2d());
    ASSERT_FLOAT_EQ(s.pdf_solid_angle, light->pdf_toward(query, s.point));
    by_light.add(s.radiance[0] * s.direction.z / s.pdf_solid_angle);
    const ShapeSample a = sheet->sample_area(random.next_2d());
    const Vec3f to_light = a.point.position - query.reference;
    by_area.add(Corner().radiance(a.point, {})[0] * sqr(to_light.z) / sqr(length_sq(to_light)));
  }
  const double error = std::hypot(by_light.standard_error(), by_area.standard_error());
  EXPECT_GT(z_test_p_value(by_light.mean(), error, by_area.mean()), failure_level);
  expect_twin_fails(z_test_p_value(1.03 * by_light.mean(), error, by_area.mean()));
  EXPECT_LT(by_light.variance(), 0.2 * by_area.variance());
}

/// Bright in one corner of its square, where little of the shape lies.
class BrightCorner final : public EmissionPattern {
 public:
  Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
    return Spectrum(at.uv.x < 0.25f && at.uv.y < 0.25f ? 20.0f : 0.1f);
  }
  float maximum() const override { return 20; }
};

struct PatternedShape {
  std::string name;
  std::shared_ptr<const Shape> shape;
};
std::vector<PatternedShape> shapes_with_tables() {
  const Value placed(Transform::translate({0.5, 0.2, 2}) * Transform::rotate({1, 2, 3}, 40) *
                     Transform::scale({0.4, 0.4, 0.4}));
  return {{"quad", make_quad({-1, -1, 2}, {0.3f, 2, 0.5f}, {2, 0, 0})},
          {"disk", make_disk({0.5f, 0, 1.5f}, normalize(Vec3f(0.3f, 0.2f, -1)), 0.8f)},
          {"sphere", make_ball({0.3f, 0.4f, 2}, 0.7f)},
          {"cube", make_shape("cube", {{"to_world", placed, {}}})}};
}

/// By the numbers that sample_area() takes for the points.
TEST(EmissionPattern, PointsFollowTheirDensity) {
  for (const PatternedShape& test : shapes_with_tables())
    for (const bool two_sided : {false, true}) {
      SCOPED_TRACE(test.name);
      const auto light = make_patterned(test.shape, 1, two_sided, std::make_shared<BrightCorner>());
      constexpr int side = 16, fine = 32, count = 400'000 / sample_share;
      std::vector<double> observed(side * side), expected(side * side);
      Random random(13);
      const auto cell_of = [&](const SurfacePoint& point) {
        const Vec2f p = *test.shape->area_coordinates(point);
        return size_t(std::clamp(int(p.y * side), 0, side - 1) * side +
                      std::clamp(int(p.x * side), 0, side - 1));
      };
      for (int i = 0; i < count; ++i) {
        const EmissionSample s = light->placed().sample_origin(random.next_2d());
        ASSERT_GT(s.pdf_position, 0);
        observed[cell_of(s.point)] += 1;
      }
      const double weight = double(count) * double(test.shape->area()) * (two_sided ? 2 : 1) /
                            (side * side * fine * fine);
      for (int y = 0; y < side * fine; ++y)
        for (int x = 0; x < side * fine; ++x) {
          const Vec2f u((float(x) + 0.5f) / (side * fine), (float(y) + 0.5f) / (side * fine));
          expected[size_t(y / fine * side + x / fine)] +=
              weight * double(light->emission_pdf_position(test.shape->sample_area(u).point));
        }
      EXPECT_GT(chi_square_p_value(observed, expected), failure_level);
      for (size_t i = 0; i < expected.size(); ++i) expected[i] *= i % side < side / 2 ? 1.03 : 0.97;
      expect_twin_fails(chi_square_p_value(observed, expected));
    }
}

/// Without edges, which the sums over cells of directions would only half see.
class SmoothSpot final : public EmissionPattern {
 public:
  Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
    const float distance_sq = sqr(at.uv.x - 0.35f) + sqr(at.uv.y - 0.45f);
    return Spectrum(0.2f + 3 * std::exp(-20 * distance_sq));
  }
  float maximum() const override { return 3.2f; }
};

TEST(EmissionPattern, DirectionsFollowTheirDensity) {
  const Vec3f reference(0.2f, -0.1f, 0.0f);
  for (const PatternedShape& test : shapes_with_tables()) {
    if (test.name == "sphere") continue;  // at its outline the density has no bound
    SCOPED_TRACE(test.name);
    const auto light = make_patterned(test.shape, 1, false, std::make_shared<SmoothSpot>());
    const RayTracer tracer({{test.shape}, {}, {}});
    DirectionGrid grid;
    grid.axis = normalize(center(test.shape->bounds()) - reference);
    grid.one_minus_cos = test.name == "quad" ? 0.7f : 0.3f;
    Random random(17);
    const auto sample = [&] {
      const LightSample s = light->sample_toward(reference, random.next_2d());
      return s.pdf_solid_angle > 0 ? s.direction : Vec3f(0, 0, 0);
    };
    const auto pdf = [&](const Vec3f& d) -> double {
      const Ray ray{reference, d};
      Hit hit;
      if (!tracer.intersect(ray, hit)) return 0;
      return double(light->pdf_toward(reference, tracer.surface_point(ray, hit)));
    };
    const int count = 400'000 / sample_share;
    EXPECT_GT(direction_p_value(grid, count, sample, pdf), failure_level);
    expect_twin_fails(direction_p_value(grid, count, sample, with_planted_error(grid, pdf)));
  }
}

/// A mostly black picture on a lamp: light is found where it is bright, and its mean stays.
TEST(EmissionPattern, IsSampledWhereItIsBright) {
  for (const PatternedShape& test : shapes_with_tables()) {
    SCOPED_TRACE(test.name);
    const auto pattern = std::make_shared<BrightCorner>();
    const auto light = make_patterned(test.shape, 1, false, pattern);
    const LightQuery query(Vec3f(0.2f, -0.1f, 0), Vec3f(0, 0, 1));
    Random random(19);
    RunningStatistics by_pattern, by_geometry;
    for (int i = 0; i < 200'000 / sample_share; ++i) {
      const LightSample s = light->sample_toward(query, random.next_2d());
      by_pattern.add(s.pdf_solid_angle > 0
                         ? s.radiance[0] * std::max(0.0f, s.direction.z) / s.pdf_solid_angle
                         : 0.0f);
      float pdf = 0;
      const ShapeSample g = test.shape->sample_toward(query.reference, random.next_2d(), pdf);
      const Vec3f way = normalize(g.point.position - query.reference);
      const bool faces = pdf > 0 && dot(g.point.ng, way) < 0;
      by_geometry.add(faces ? pattern->radiance(g.point, {})[0] * std::max(0.0f, way.z) / pdf
                            : 0.0f);
    }
    const double error = std::hypot(by_pattern.standard_error(), by_geometry.standard_error());
    EXPECT_GT(z_test_p_value(by_pattern.mean(), error, by_geometry.mean()), failure_level);
    expect_twin_fails(z_test_p_value(1.2 * by_pattern.mean(), error, by_geometry.mean()));
    // The corner of a cube's faces, or of a sphere's square, is nowhere or far from where it is.
    if (test.name == "quad" || test.name == "disk") {
      EXPECT_LT(by_pattern.variance(), 0.3 * by_geometry.variance());
    }
  }
}

/// A spot that no point of the quadrature finds is no reason to leave the light out.
TEST(EmissionPattern, IsNotDarkWhereOnlyASpotShines) {
  class Spot final : public EmissionPattern {
   public:
    explicit Spot(float value) : value_(value) {}
    Spectrum radiance(const SurfacePoint&, const Wavelengths&) const override { return {}; }
    float maximum() const override { return value_; }

   private:
    float value_;
  };
  const auto quad = make_quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0});
  const auto spotted = make_patterned(quad, 1, false, std::make_shared<Spot>(1e4f));
  EXPECT_GT(spotted->traits().power[0], 0);
  EXPECT_GT(spotted->expected_irradiance({{1, 0.5f, 1}, {0, 0, -1}}), 0);
  EXPECT_TRUE(
      make_patterned(quad, 1, false, std::make_shared<Spot>(0.0f))->traits().power.is_zero());
}

}  // namespace
}  // namespace kaustik
