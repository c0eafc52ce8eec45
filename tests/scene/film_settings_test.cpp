// Pixel filters: what is sampled is what is evaluated.

#include "kaustik/scene/film_settings.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/scene/filter_kinds.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr uint32_t sample_count = 20000;
constexpr float planted_scale = 1.1f;
#else
constexpr uint32_t sample_count = 200000;
constexpr float planted_scale = 1.02f;
#endif

struct FilterCase {
  std::string name;
  PixelFilter filter;
};

/// Each row with its usual values, and some with others.
std::vector<FilterCase> filters() {
  std::vector<FilterCase> result = {{"wide box", box_filter(1.7f)},
                                    {"wide tent", tent_filter(2.5f)},
                                    {"cut gaussian", gaussian_filter(0.8f, 1)}};
  for (const FilterType& type : filter_types()) {
    Problems problems;
    const Arguments arguments(type.info, {}, {}, problems);
    problems.throw_if_any();
    result.push_back({type.info.name, type.create(arguments)});
  }
  return result;
}

/// Chi-square of offsets scaled by `scale` against the filter's density, over 24 × 24 cells of a
/// square a little larger than the filter.
double p_value(const PixelFilter& filter, float scale) {
  constexpr int cells = 24, steps = 16;
  const double side = 2.1 * double(filter.radius()), cell = side / cells;
  std::vector<double> observed(cells * cells), expected(cells * cells);
  for (uint32_t i = 0; i < sample_count; ++i) {
    // Independent points: a stratified sequence would fit too well.
    const Vec2f offset = filter.sample(Sampler(hash_mix(7, i), 0).next_2d()) * scale;
    const int x = int((double(offset.x) + side / 2) / cell);
    const int y = int((double(offset.y) + side / 2) / cell);
    if (x < 0 || y < 0 || x >= cells || y >= cells) return 0;
    ++observed[size_t(y * cells + x)];
  }
  for (int y = 0; y < cells * steps; ++y)
    for (int x = 0; x < cells * steps; ++x) {
      const auto at = [&](int i) { return float((i + 0.5) * cell / steps - side / 2); };
      expected[size_t(y / steps * cells + x / steps)] +=
          double(filter.eval({at(x), at(y)})) * cell * cell / (steps * steps);
    }
  double mass = 0;
  for (double& e : expected) {
    mass += e;
    e *= sample_count;
  }
  EXPECT_NEAR(mass, 1, 0.01) << "the filter is not normalised";
  for (double& e : expected) e /= mass;
  return chi_square_p_value(observed, expected);
}

TEST(PixelFilter, TypesAreDescribed) { test::expect_rows_of("rfilter", filter_types()); }

TEST(PixelFilter, IsAPixelWideUnlessSaid) {
  EXPECT_EQ(PixelFilter().radius(), 0.5f);
  EXPECT_EQ(PixelFilter().eval({0.4f, -0.4f}), 1);
}

TEST(PixelFilter, SamplesFollowTheDensity) {
  for (const FilterCase& c : filters()) EXPECT_GT(p_value(c.filter, 1), 1e-3) << c.name;
}

// The twin: offsets that are a little too wide do not pass.
TEST(PixelFilter, WrongSamplesWouldBeFound) {
  for (const FilterCase& c : filters()) EXPECT_LT(p_value(c.filter, planted_scale), 1e-3) << c.name;
}

TEST(PixelFilter, IntegratesToOne) {
  for (const FilterCase& c : filters()) {
    constexpr int steps = 4001;
    const double side = 2 * double(c.filter.radius());
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      sum += double(c.filter.eval({float((i + 0.5) / steps * side - side / 2), 0}));
    // Along one axis: the other factor is the density at zero.
    EXPECT_NEAR(sum * side / steps, std::sqrt(double(c.filter.eval({0, 0}))), 1e-3) << c.name;
  }
}

TEST(PixelFilter, EndsAtItsRadius) {
  for (const FilterCase& c : filters()) {
    EXPECT_EQ(c.filter.eval({c.filter.radius() * 1.001f, 0}), 0) << c.name;
    EXPECT_EQ(c.filter.eval({0, -c.filter.radius() * 1.001f}), 0) << c.name;
    EXPECT_GT(c.filter.eval({c.filter.radius() * 0.99f, 0}), 0) << c.name;
    for (const float u : {0.0f, 1e-6f, 0.5f, one_minus_epsilon}) {
      const Vec2f offset = c.filter.sample({u, one_minus_epsilon - u});
      EXPECT_LE(std::fabs(offset.x), c.filter.radius() * 1.0001f) << c.name;
      EXPECT_LE(std::fabs(offset.y), c.filter.radius() * 1.0001f) << c.name;
    }
    EXPECT_NEAR(c.filter.sample({0.5f, 0.5f}).x, 0, 1e-5) << c.name;
  }
}

PixelFilter filter_named(const std::string& name, const std::vector<Property>& properties = {}) {
  for (const FilterType& type : filter_types()) {
    if (type.info.name != name) continue;
    Problems problems;
    const Arguments arguments(type.info, properties, {}, problems);
    problems.throw_if_any();
    return type.create(arguments);
  }
  throw std::invalid_argument("no filter " + name);
}

// Of a filter with negative lobes the one in the middle stays: in its shape up to its first zero.
TEST(PixelFilter, WithNegativeLobesKeepsTheOneInTheMiddle) {
  EXPECT_NEAR(filter_named("catmullrom").radius(), 1, 1e-6);
  EXPECT_NEAR(filter_named("lanczos").radius(), 1, 1e-6);
  // Without negative lobes all of it: the cubic B-spline, 2/3 in the middle and 1/6 beside it.
  const PixelFilter spline = filter_named("mitchell", {{"B", 1.0, {}}, {"C", 0.0, {}}});
  EXPECT_NEAR(spline.radius(), 2, 1e-3);
  EXPECT_NEAR(spline.eval({0, 0}), 4.0 / 9, 1e-4);
  EXPECT_NEAR(spline.eval({1, 0}), 2.0 / 3 / 6, 1e-4);
  // Mitchell and Netravali's own: 8/9 in the middle, 77/144 halfway to the next pixel.
  const PixelFilter mitchell = filter_named("mitchell");
  EXPECT_GT(mitchell.radius(), 1);
  EXPECT_LT(mitchell.radius(), 1.2);
  EXPECT_NEAR(mitchell.eval({0.5f, 0}) / mitchell.eval({0, 0}), 77.0 / 144 / (8.0 / 9), 1e-4);
  for (const char* name : {"mitchell", "catmullrom", "lanczos"})
    EXPECT_TRUE(filter_named(name).is_cut()) << name;
  for (const char* name : {"box", "tent", "gaussian"})
    EXPECT_FALSE(filter_named(name).is_cut()) << name;
  EXPECT_FALSE(spline.is_cut());
  EXPECT_FALSE(filter_named("lanczos", {{"lobes", int64_t(1), {}}}).is_cut());
}

}  // namespace
}  // namespace kaustik
