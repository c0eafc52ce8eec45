// Pictures that spots and projectors throw: where they fall, how bright, how rays are shared out.

#include "kaustik/light/slide.h"

#include "kaustik/base/warp.h"
#include "kaustik/light/power_distribution.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

/// Bright in the upper right quarter of the picture (u over 1/2, v under 1/2), else dim.
class Quarters final : public EmissionPattern {
 public:
  explicit Quarters(float picture_aspect = 1) : aspect_(picture_aspect) {}
  Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
    return spectrum_from_rgb(1, 2, 3) * of(at.uv);
  }
  float maximum() const override { return 12; }
  float aspect() const override { return aspect_; }
  static float of(const Vec2f& uv) { return uv.x > 0.5f && uv.y < 0.5f ? 4.0f : 0.25f; }
  static constexpr double mean = (4 + 3 * 0.25) / 4;

 private:
  float aspect_;
};

std::unique_ptr<Light> make_thrown(const std::string& type, std::vector<Property> properties,
                                   std::shared_ptr<const EmissionPattern> picture) {
  return make_light(type, properties, nullptr, test_bounds(), std::move(picture));
}

/// Irradiance on the plane across the axis at the distance `depth`, at x and y of the light's
/// space.
double on_plane(const Light& light, const Vec3f& at, int lane = 0) {
  const LightSample s = light.sample_toward(LightQuery(at, {0, 0, -1}), {0.5f, 0.5f});
  return s.pdf_solid_angle > 0 ? double(s.radiance[lane]) * -double(s.direction.z) : 0;
}

TEST(SquareDistribution, FollowsItsWeights) {
  const std::vector<double> weights = {0, 1, 2, 0, 0, 5, 0, 0};
  const SquareDistribution distribution(4, 2, weights, 0.2);
  Random random(3);
  std::vector<double> observed(32), expected;
  constexpr int count = 400'000 / sample_share;
  for (int i = 0; i < count; ++i) {
    const Vec2f p = distribution.sample(random.next_2d());
    ASSERT_TRUE(p.x >= 0 && p.y >= 0 && p.x < 1 && p.y < 1);
    observed[size_t(p.y * 4) * 8 + size_t(p.x * 8)] += 1;
  }
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      const double weight = 0.8 * weights[size_t(y / 2 * 4 + x / 2)] / 8 + 0.2 / 8;
      const Vec2f middle((float(x) + 0.5f) / 8, (float(y) + 0.5f) / 4);
      EXPECT_FLOAT_EQ(distribution.pdf(middle), float(8 * weight));
      expected.push_back(count * weight / 4);
    }
  EXPECT_GT(chi_square_p_value(observed, expected), failure_level);
  for (size_t i = 0; i < expected.size(); ++i) expected[i] *= i % 2 ? 1.03 : 0.97;
  expect_twin_fails(chi_square_p_value(observed, expected));
  EXPECT_EQ(distribution.pdf({-0.01f, 0.5f}), 0);
  EXPECT_EQ(distribution.pdf({0.5f, 1.01f}), 0);
}

TEST(SquareDistribution, WithoutWeightsIsUniform) {
  const SquareDistribution distribution(3, 3, std::vector<double>(9), 0.1);
  EXPECT_FLOAT_EQ(distribution.pdf({0.1f, 0.9f}), 1);
  const Vec2f p = distribution.sample({0.25f, 0.75f});
  EXPECT_NEAR(p.x, 0.25f, 1e-6f);
  EXPECT_NEAR(p.y, 0.75f, 1e-6f);
  const Vec2f last = distribution.sample({one_minus_epsilon, one_minus_epsilon});
  EXPECT_LT(last.x, 1);
  EXPECT_LT(last.y, 1);
}

/// A white screen at the distance 1 is seen with the picture's values: it gets π times them.
TEST(Projector, LightsAPlaneEvenly) {
  const auto light = make_light("projector", {{"irradiance", Value(Rgb{1, 2, 3}), {}},
                                              {"scale", Value(0.5), {}},
                                              {"fov", Value(60.0), {}}});
  const double half = std::tan(std::numbers::pi / 6);
  for (const double x : {-0.99, -0.4, 0.0, 0.7, 0.99})
    for (const double y : {-0.99, 0.2, 0.99})
      for (const float depth : {1.0f, 3.0f}) {
        const Vec3f at(float(x * half) * depth, float(y * half) * depth, depth);
        for (int lane = 0; lane < 3; ++lane)
          EXPECT_NEAR(on_plane(*light, at, lane),
                      0.5 * (lane + 1) * std::numbers::pi / depth / depth, 1e-5);
      }
  EXPECT_EQ(on_plane(*light, {float(1.01 * half), 0, 1}), 0);
  EXPECT_EQ(on_plane(*light, {0, float(-1.01 * half), 1}), 0);
  EXPECT_EQ(on_plane(*light, {0, 0, -1}), 0);
  EXPECT_NEAR(light->traits().power[1], std::numbers::pi * 4 * half * half, 1e-4);
}

/// By emitted rays: what falls on each part of a plane, W/m², with its error.
TEST(Projector, EmitsWhatLightsThePlane) {
  const auto light =
      make_thrown("projector", {{"fov", Value(70.0), {}}}, std::make_shared<Quarters>(1.5f));
  const double half_x = std::tan(35 * std::numbers::pi / 180), half_y = half_x / 1.5;
  constexpr int side = 4;
  std::vector<RunningStatistics> parts(side * side);
  Random random(7);
  for (int i = 0; i < 200'000 / sample_share; ++i) {
    const EmissionSample s = light->sample_emission({}, random.next_2d(), {});
    ASSERT_GT(s.direction.z, 0);
    // In the light's space +x is to the left of the picture, +y is up.
    const double u = 0.5 - 0.5 * double(s.direction.x / s.direction.z) / half_x,
                 v = 0.5 - 0.5 * double(s.direction.y / s.direction.z) / half_y;
    const int column = std::clamp(int(u * side), 0, side - 1),
              row = std::clamp(int(v * side), 0, side - 1);
    for (int part = 0; part < side * side; ++part)
      parts[size_t(part)].add(part == row * side + column ? double(s.flux[0]) : 0.0);
  }
  const double area = 4 * half_x * half_y / (side * side);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double value = column >= side / 2 && row < side / 2 ? 4 : 0.25;
      const RunningStatistics& found = parts[size_t(row * side + column)];
      EXPECT_GT(z_test_p_value(found, std::numbers::pi * value * area), failure_level)
          << row << ", " << column << ": " << found.mean() << " ± " << found.standard_error();
      if (value > 1)
        expect_twin_fails(z_test_p_value(found, 1.05 * std::numbers::pi * value * area));
    }
  const double power = std::numbers::pi * Quarters::mean * 4 * half_x * half_y;
  EXPECT_NEAR(light->traits().power[0], power, 1e-3 * power);
}

/// The upper right quarter of the picture as a camera at the same place would see it.
TEST(Projector, ThrowsThePictureUpright) {
  const Transform to_world = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  const auto light =
      make_thrown("projector", {{"to_world", Value(to_world), {}}}, std::make_shared<Quarters>());
  const auto at = [&](float x, float y) {
    return light->sample_toward(Vec3f(x, y, 0), {0, 0}).radiance[0];
  };
  // Seen from +z toward the origin with +y up, +x is to the right.
  EXPECT_GT(at(0.3f, 0.3f), 10 * at(-0.3f, 0.3f));
  EXPECT_GT(at(0.3f, 0.3f), 10 * at(0.3f, -0.3f));
  EXPECT_NEAR(at(-0.3f, 0.3f), at(-0.3f, -0.3f), 1e-6f);
}

TEST(Projector, TakesTheFieldOfViewsOfCameras) {
  const auto reach = [](std::vector<Property> properties) {
    return make_thrown("projector", std::move(properties), std::make_shared<Quarters>(2.0f))
        ->traits()
        .bounds.cos_angle;
  };
  const double t = std::tan(20 * std::numbers::pi / 180);
  const auto corner = [](double x, double y) { return 1 / std::sqrt(1 + x * x + y * y); };
  EXPECT_NEAR(reach({{"fov", Value(40.0), {}}}), corner(t, t / 2), 1e-6);
  EXPECT_NEAR(reach({{"fov", Value(40.0), {}}, {"fov_axis", Value(std::string("y")), {}}}),
              corner(2 * t, t), 1e-6);
  EXPECT_NEAR(reach({{"focal_length", Value(std::string("35mm")), {}}}),
              std::cos(std::atan(std::hypot(36.0, 24.0) / 70)), 1e-6);
  EXPECT_NEAR(reach({}), std::cos(std::atan(std::hypot(36.0, 24.0) / 100)), 1e-6);
}

/// A mostly black picture sends its rays where it is bright.
TEST(Projector, SharesRaysOutByThePicture) {
  class Dot final : public EmissionPattern {
   public:
    Spectrum radiance(const SurfacePoint& at, const Wavelengths&) const override {
      return is_lit(at.uv) ? spectrum_from_rgb(9, 9, 9) : Spectrum();
    }
    float maximum() const override { return 9; }
    static bool is_lit(const Vec2f& uv) {
      return std::fabs(uv.x - 0.3f) < 0.02f && std::fabs(uv.y - 0.6f) < 0.02f;
    }
  };
  const auto light = make_thrown("projector", {}, std::make_shared<Dot>());
  Random random(11);
  int lit = 0;
  for (int i = 0; i < 2000; ++i)
    lit += !light->sample_emission({}, random.next_2d(), {}).flux.is_zero();
  EXPECT_GT(lit, 1600);
  EXPECT_EQ(light->expected_irradiance(LightQuery({0, 0, 2}, {0, 0, -1})), 0);
}

/// uv = 1/2 ± x/(2 z tan(cutoff)), as Mitsuba has it.
TEST(SpotLight, ThrowsATextureAlongItsCone) {
  const auto light = make_thrown("spot",
                                 {{"intensity", Value(Rgb{2, 2, 2}), {}},
                                  {"cutoff_angle", Value(40.0), {}},
                                  {"beam_width", Value(40.0), {}}},
                                 std::make_shared<Quarters>());
  const double t = std::tan(40 * std::numbers::pi / 180);
  for (const double u : {0.2, 0.45, 0.55, 0.8})
    for (const double v : {0.2, 0.45, 0.55, 0.8}) {
      const Vec3f direction =
          normalize(Vec3f(float((2 * u - 1) * t), float((2 * v - 1) * t), 1.0f));
      EXPECT_FLOAT_EQ(light->emitted({}, direction, {})[0], 2 * Quarters::of({float(u), float(v)}));
    }
  EXPECT_TRUE(light->emitted({}, normalize(Vec3f(float(1.01 * t), 0, 1)), {}).is_zero());
  // The mean over the quarters of the cone: each is a quarter of it.
  const double cone = 2 * std::numbers::pi * (1 - std::cos(40 * std::numbers::pi / 180));
  EXPECT_NEAR(light->traits().power[0], 2 * Quarters::mean * cone, 2e-3 * Quarters::mean * cone);
  EXPECT_NEAR(light->traits().power[2] / light->traits().power[0], 3, 1e-4);
}

TEST(SpotLight, MayBeTinted) {
  const auto light =
      make_light("spot", {{"intensity", Value(2.0), {}}, {"texture", Value(Rgb{0.1, 0.5, 1}), {}}});
  const Spectrum seen = light->emitted({}, {0, 0, 1}, {});
  EXPECT_FLOAT_EQ(seen[0], 0.2f);
  EXPECT_FLOAT_EQ(seen[1], 1);
  EXPECT_FLOAT_EQ(seen[2], 2);
}

TEST(SpotLight, WideOnesThrowNoPicture) {
  try {
    make_thrown("spot", {{"cutoff_angle", Value(90.0), {}}}, std::make_shared<Quarters>());
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("throws no picture"), std::string::npos);
  }
}

/// 1 in the beam; between it and the cutoff by the formulas of the formats.
TEST(SpotLight, FallsOffAsAsked) {
  const double beam = 20 * std::numbers::pi / 180, cutoff = 50 * std::numbers::pi / 180;
  const auto expected = [&](const std::string& falloff, double angle) {
    if (angle <= beam) return 1.0;
    if (angle >= cutoff) return 0.0;
    const double t = (std::cos(angle) - std::cos(cutoff)) / (std::cos(beam) - std::cos(cutoff));
    return falloff == "linear"   ? (cutoff - angle) / (cutoff - beam)
           : falloff == "smooth" ? t * t * (3 - 2 * t)
           : falloff == "square" ? t * t
                                 : 1.0;
  };
  for (const std::string falloff : {"linear", "smooth", "square", "none"}) {
    SCOPED_TRACE(falloff);
    const auto light = make_light("spot", {{"cutoff_angle", Value(50.0), {}},
                                           {"beam_width", Value(20.0), {}},
                                           {"falloff", Value(falloff), {}}});
    double power = 0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) {
      const double angle = (i + 0.5) / steps * std::numbers::pi / 2;
      const Vec3f direction(float(std::sin(angle)), 0, float(std::cos(angle)));
      const double found = double(light->emitted({}, direction, {})[0]);
      ASSERT_NEAR(found, expected(falloff, angle), 1e-4) << angle;
      power += 2 * std::numbers::pi * std::sin(angle) * found * std::numbers::pi / 2 / steps;
    }
    EXPECT_NEAR(light->traits().power[0], power, 1e-3 * power);
  }
}

}  // namespace
}  // namespace kaustik
