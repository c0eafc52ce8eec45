#pragma once
// What the tests of lights share: making lights and shapes, and histograms against densities.

#include <gtest/gtest.h>

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/light/light.h"

namespace kaustik::testing {

#ifdef KAUSTIK_SLOW_BUILD
inline constexpr int sample_share = 10;
#else
inline constexpr int sample_share = 1;
#endif
/// Below this a statistical check has failed.
inline constexpr double failure_level = 1e-5;
/// With a tenth of the samples a planted error of 2 % need not show.
inline constexpr bool twins_can_fail = sample_share == 1;
/// The p value of a check's twin with a planted error: it must fail, or the check is worth nothing.
inline void expect_twin_fails(double p_value) {
  if (twins_can_fail) {
    EXPECT_LT(p_value, failure_level);
  }
}

/// The same of a check that takes long: it is not made where it need not fail.
template <std::invocable Check>
void expect_twin_fails(const Check& check) {
  if (twins_can_fail) expect_twin_fails(double(check()));
}

/// Independent uniform numbers.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  float next() { return float(hash_mix(state_, ++count_) >> 40) * 0x1p-24f; }
  Vec2f next_2d() {
    const float x = next();
    return {x, next()};
  }
  Vec3f next_3d() {
    const Vec2f xy = next_2d();
    return {xy.x, xy.y, next()};
  }

 private:
  uint64_t state_, count_ = 0;
};

/// Scene bounds of tests: radius √3 · 2 around (1, 2, 3).
Bounds3f test_bounds();
/// A light by its type's name. Throws what create() throws, and Problems of the arguments.
std::unique_ptr<Light> make_light(const std::string& type, const std::vector<Property>& properties,
                                  std::shared_ptr<const Shape> shape = nullptr,
                                  const Bounds3f& scene_bounds = test_bounds(),
                                  std::shared_ptr<const EmissionPattern> pattern = nullptr);

/// Four fields of the uv square with radiances of their own, one of them dark.
std::shared_ptr<const EmissionPattern> fields_pattern();

/// An environment of a picture with one float per pixel and channel, row by row.
std::unique_ptr<Light> make_envmap(int width, int height, const std::vector<Rgb>& pixels,
                                   std::vector<Property> properties = {});
/// A picture with some bright pixels among dim ones.
std::vector<Rgb> spotted_pixels(int count);

/// A shape by its type's name.
std::shared_ptr<const Shape> make_shape(const std::string& type,
                                        const std::vector<Property>& properties);
/// Corners corner, corner + a, corner + a + b, corner + b; normal a × b.
std::shared_ptr<const Shape> make_quad(const Vec3f& corner, const Vec3f& a, const Vec3f& b);
std::shared_ptr<const Shape> make_disk(const Vec3f& center, const Vec3f& normal, float radius);
std::shared_ptr<const Shape> make_ball(const Vec3f& center, float radius);

/// Directions in the cone about an axis, cut into cells of equal solid angle.
struct DirectionGrid {
  Vec3f axis{0, 0, 1};
  float one_minus_cos = 2;  ///< of the cone's half angle; 2: the sphere
  int rings = 12, sectors = 16;
  int fine = 48;  ///< points per cell and side when a density is integrated
};
/// p value of `count` directions from `sample` (zero: none came) against their density per solid
/// angle. What misses the cone or is zero counts as one more cell.
double direction_p_value(const DirectionGrid& grid, int count, const std::function<Vec3f()>& sample,
                         const std::function<double(const Vec3f&)>& pdf_solid_angle);
/// The density with 2 % moved from one half of the cone to the other.
std::function<double(const Vec3f&)> with_planted_error(
    const DirectionGrid& grid, std::function<double(const Vec3f&)> pdf_solid_angle);

/// p value of `count` points in [0, 1)² against a uniform density, or one with 2 % moved from the
/// left half to the right one.
double square_p_value(int count, bool planted_error, const std::function<Vec2f()>& sample);

}  // namespace kaustik::testing
