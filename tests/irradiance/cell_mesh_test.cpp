#include "kaustik/irradiance/cell_mesh.h"

#include <gtest/gtest.h>

#include <functional>

#include "kaustik/base/statistics.h"
#include "tests/irradiance/test_sources.h"

namespace kaustik {
namespace {

using test::HiddenSkySource;
using test::RectangleSource;
using test::surface_point;
using test::UniformSource;

#ifdef KAUSTIK_SLOW_BUILD
constexpr int effort = 1;
#else
constexpr int effort = 10;
#endif

/// Irradiance at a point with a normal, in closed form.
using ClosedForm = std::function<double(const Vec3d&, const Vec3d&)>;

/// xx, xy, yy of the tangent frame.
struct Second {
  double values[3];
};

/// Second derivatives of the closed form at the origin by central differences.
Second differences(const ClosedForm& irradiance, const Vec3f& normal) {
  const Frame frame(normal);
  const Vec3d n(normal), x(frame.x), y(frame.y);
  const double h = 1e-3;
  const auto at = [&](int i, int j) { return irradiance((x * i + y * j) * h, n); };
  return {{(at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (h * h),
           (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h * h),
           (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (h * h)}};
}

/// The largest deviation of the mean over `count` hemispheres beyond 4 standard errors, as a share
/// of the Hessian's size.
double deviation(const RadianceSource& source, const Vec3f& normal, const Second& expected,
                 int samples, int count) {
  HemisphereSettings settings;
  settings.samples = samples;
  settings.hessian = true;
  RunningStatistics measured[3];
  for (int i = 0; i < count; ++i) {
    const auto e = sample_hemisphere(source, surface_point({0, 0, 0}, normal), normal, settings,
                                     Sampler(hash_mix(7, uint64_t(i)), 0));
    measured[0].add(double(e.translation_hessian.xx[0]));
    measured[1].add(double(e.translation_hessian.xy[0]));
    measured[2].add(double(e.translation_hessian.yy[0]));
  }
  double size = 0, worst = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max(size, std::fabs(expected.values[i]));
    worst = std::max(worst, std::fabs(measured[i].mean() - expected.values[i]) -
                                4 * measured[i].standard_error());
  }
  return worst / size;
}

// Triangles have one radiance each, and edges lie within half a cell of where they are: deviations
// shrink with the cells, and a planted error of 10 % shows.
TEST(translation_hessian, of_a_lamp_matches_finite_differences) {
  const RectangleSource source;
  for (const Vec3f& normal : {Vec3f(0, 0, 1), normalize(Vec3f(0.2f, -0.1f, 1))}) {
    Second expected = differences(
        [&](const Vec3d& p, const Vec3d& n) { return source.form_integral(p, n); }, normal);
    EXPECT_LT(deviation(source, normal, expected, 400, 50 * effort), 0.15);
    EXPECT_LT(deviation(source, normal, expected, 6400, 10 * effort), 0.02);
    for (double& value : expected.values) value *= 1.1;
    EXPECT_GT(deviation(source, normal, expected, 6400, 10 * effort), 0.02);
  }
}

// The edge of the screen belongs to the screen, four times nearer than the sky that it hides.
TEST(translation_hessian, of_a_screen_in_front_of_a_bright_sky_matches_finite_differences) {
  const HiddenSkySource source;
  const Vec3f normal(0, 0, 1);
  Second expected =
      differences([&](const Vec3d& p, const Vec3d& n) { return source.irradiance(p, n); }, normal);
  EXPECT_LT(deviation(source, normal, expected, 400, 50 * effort), 0.22);
  EXPECT_LT(deviation(source, normal, expected, 6400, 10 * effort), 0.05);
  for (double& value : expected.values) value *= 1.1;
  EXPECT_GT(deviation(source, normal, expected, 6400, 10 * effort), 0.05);
}

TEST(translation_hessian, vanishes_in_even_light_and_under_an_open_sky) {
  HemisphereSettings settings;
  settings.hessian = true;
  const Vec3f normal(0, 0, 1);
  for (const float distance : {2.0f, infinity}) {
    const auto e =
        sample_hemisphere(UniformSource(Spectrum(1), distance), surface_point({0, 0, 0}, normal),
                          normal, settings, Sampler(3, 3));
    for (const Spectrum& s :
         {e.translation_hessian.xx, e.translation_hessian.xy, e.translation_hessian.yy})
      EXPECT_LT(std::fabs(s[0]), 1e-5f);
  }
}

TEST(translation_hessian, is_finite_whatever_the_rays_meet) {
  class Broken : public UniformSource {
   public:
    using UniformSource::UniformSource;
    Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& s) const override {
      Incoming in = UniformSource::incoming(from, d, s);
      const float u = s.next_1d();
      if (u < 0.1f) in.radiance = Spectrum(std::nanf(""));
      if (u > 0.4f && u < 0.5f) in.distance = std::nanf("");
      if (u > 0.5f && u < 0.6f) in.distance = 0;
      if (u > 0.6f && u < 0.7f) in.distance = infinity;
      if (u > 0.7f) in.radiance = Spectrum(u);
      return in;
    }
  };
  const Vec3f normal(0, 0, 1);
  HemisphereSettings settings;
  settings.hessian = true;
  for (const int samples : {1, 5, 200}) {
    settings.samples = samples;
    const auto e = sample_hemisphere(Broken(Spectrum(1), 2), surface_point({0, 0, 0}, normal),
                                     normal, settings, Sampler(1, 1));
    EXPECT_TRUE(e.translation_hessian.xx.is_finite());
    EXPECT_TRUE(e.translation_hessian.xy.is_finite());
    EXPECT_TRUE(e.translation_hessian.yy.is_finite());
  }
}

}  // namespace
}  // namespace kaustik
