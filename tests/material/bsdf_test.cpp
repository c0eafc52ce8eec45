// Properties that every bsdf has, tested on the whole table of instances.

#include "kaustik/material/bsdf.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "kaustik/material/density_check.h"
#include "tests/material/bsdf_support.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

using namespace test;

/// One question to a bsdf: where light leaves to, and which lobes are meant.
struct Case {
  Vec3f wo;
  Lobes lobes;
  std::string text;
};

/// Whether it is made of many lobes, which other instances have one by one.
bool is_mixed(const Bsdf& bsdf) {
  static const std::set<std::string> names = {
      "sheet_all_lobes",   "textured_phong",   "mask_half",
      "blend_paper_glass", "principled_glass", "mixture_of_three",
      "thin_frosted_pane", "openpbr_sheet",    "openpbr_coated_glass"};
  for (const BsdfInstance& instance : bsdf_instances())
    if (instance.bsdf.get() == &bsdf) return names.contains(instance.name);
  return false;
}

#ifdef KAUSTIK_SLOW_BUILD
constexpr bool is_slow_build = true;
#else
constexpr bool is_slow_build = false;
#endif

/// On the outside and on the inside, where something comes back from there. At length at every
/// angle. Else what takes long is asked at half of the angles, a steep and a grazing one; and where
/// programs run slowly, at the one from the outside, at the other from the inside.
std::vector<Case> cases_of(const Bsdf& bsdf, const Effort& effort) {
  std::vector<Case> cases;
  const bool is_quick = effort.samples < at_length.samples;
  const size_t step = is_quick && (is_slow_build || is_mixed(bsdf)) ? 2 : 1;
  for (size_t i = step - 1; i < outgoing_directions().size(); i += step)
    for (const float side : {1.0f, -1.0f}) {
      if (is_quick && is_slow_build && (side > 0) != (i == step - 1)) continue;
      for (const Lobes lobes : lobe_sets(bsdf)) {
        const Vec3f& outside = outgoing_directions()[i];
        const Vec3f wo(outside.x, outside.y, side * outside.z);
        if (bsdf.albedo({}, wo, lobes).is_zero()) continue;
        cases.push_back(
            {wo, lobes, "wo.z " + std::to_string(wo.z) + ", lobes " + std::to_string(int(lobes))});
      }
    }
  return cases;
}

int count_of_cases(const Effort& effort) {
  int count = 0;
  for (const BsdfInstance& i : bsdf_instances()) count += int(cases_of(*i.bsdf, effort).size());
  return count;
}

/// The level of one test out of the `tests_per_case` for every case, such that all of them together
/// fail with a chance of 1 % where everything is right.
double level(const Effort& effort, int tests_per_case) {
  static const int quick_cases = count_of_cases(quick), cases = count_of_cases(at_length);
  return sidak_level(0.01,
                     (effort.samples < at_length.samples ? quick_cases : cases) * tests_per_case);
}

/// Independent points: the tests below assume that.
Sampler sampler_of(uint64_t key, int i) { return {hash_mix(key, uint64_t(i)), 0}; }

BsdfSample draw(const Bsdf& bsdf, const BsdfContext& context, const Case& c, Sampler sampler) {
  const float u_lobe = sampler.next_1d();
  return bsdf.sample(context, c.wo, u_lobe, sampler.next_2d(), c.lobes);
}

class EveryBsdf : public testing::TestWithParam<BsdfInstance> {
 protected:
  void expect_samples_as_the_density_says(const Effort& effort) const;
  void expect_mean_weights_that_are_integrals(const Effort& effort) const;
  void expect_albedos_that_are_mean_weights(const Effort& effort) const;
  const Bsdf& bsdf() const { return *GetParam().bsdf; }
  bool has_density() const { return any(bsdf().traits().lobes & (Lobes::diffuse | Lobes::glossy)); }
};

// ---- what many samples give ----

struct Drawn {
  CellCounts cells;
  /// Weight by event (diffuse, glossy, delta) and lane; zero for the samples of other events.
  std::array<std::array<RunningStatistics, 3>, 3> weights;
  std::array<RunningStatistics, 3> all_weights;
};

constexpr std::array<Lobes, 3> single_lobes = {Lobes::diffuse, Lobes::glossy, Lobes::delta};

/// Of many lobes each gets its share of the samples only.
int samples_for(const Bsdf& bsdf, const Effort& effort) {
  return is_mixed(bsdf) ? 3 * effort.samples : effort.samples;
}

Drawn draw_many(const Bsdf& bsdf, const Case& c, int samples) {
  const DirectionGrid grid(c.wo);
  Drawn result;
  result.cells.resize(grid.size() + 1);
  for (int i = 0; i < samples; ++i) {
    const BsdfSample s = draw(bsdf, flux(), c, sampler_of(1, i));
    result.cells[counted_cell(s, grid)] += 1;
    for (size_t lane = 0; lane < 3; ++lane) {
      const double weight = s.weight[int(lane)];
      result.all_weights[lane].add(weight);
      for (size_t event = 0; event < 3; ++event)
        result.weights[event][lane].add(s.event == single_lobes[event] ? weight : 0);
    }
  }
  return result;
}

/// The same for every test that asks.
const Drawn& drawn(const Bsdf& bsdf, const Case& c, const Effort& effort) {
  static std::map<std::tuple<const Bsdf*, std::string, int>, Drawn> memory;
  const int samples = samples_for(bsdf, effort);
  const auto key = std::make_tuple(&bsdf, c.text, samples);
  const auto found = memory.find(key);
  return found != memory.end() ? found->second
                               : memory.emplace(key, draw_many(bsdf, c, samples)).first->second;
}

CellCounts expected_cells(const Bsdf& bsdf, const Case& c, int samples) {
  CellCounts cells = expected_counts(bsdf, c.wo, c.lobes, DirectionGrid(c.wo), samples);
  EXPECT_LT(std::accumulate(cells.begin(), cells.end() - 1, 0.0), (1 + 2e-4) * samples)
      << "the density is more than 1";
  return cells;
}

/// Every other cell has some percent more, the others as much less.
CellCounts with_planted_error(CellCounts cells, double error) {
  for (size_t i = 0; i < cells.size(); ++i) cells[i] *= i % 2 ? 1 + error : 1 - error;
  return cells;
}

void EveryBsdf::expect_samples_as_the_density_says(const Effort& effort) const {
  if (!has_density()) return;  // delta lobes have none
  const int samples = samples_for(bsdf(), effort);
  for (const Case& c : cases_of(bsdf(), effort)) {
    SCOPED_TRACE(c.text);
    const CellCounts& observed = drawn(bsdf(), c, effort).cells;
    const CellCounts expected = expected_cells(bsdf(), c, samples);
    if (expected.back() > 0.999 * samples) continue;  // by delta lobes alone
    EXPECT_GT(density_p_value(observed, expected), level(effort, 1));
    const CellCounts wrong = with_planted_error(expected, effort.planted_error);
    EXPECT_LT(density_p_value(observed, wrong), level(effort, 1));
  }
}

TEST_P(EveryBsdf, samples_as_its_density_says) { expect_samples_as_the_density_says(quick); }

TEST_P(EveryBsdf, samples_as_its_density_saysLong) {
  expect_samples_as_the_density_says(at_length);
}

// ---- weights ----

TEST_P(EveryBsdf, weight_is_value_times_cosine_over_density) {
  for (const Case& c : cases_of(bsdf(), quick)) {
    SCOPED_TRACE(c.text);
    const Lobes asked = c.lobes & bsdf().traits().lobes;
    const bool one_lobe =
        asked == Lobes::diffuse || asked == Lobes::glossy || asked == Lobes::delta;
    for (int i = 0; i < 2000; ++i) {
      const BsdfSample s = draw(bsdf(), {}, c, sampler_of(2, i));
      ASSERT_TRUE(s.weight.is_finite());
      if (s.event == Lobes::none) {
        ASSERT_TRUE(s.weight.is_zero());
        continue;
      }
      ASSERT_TRUE(s.event == Lobes::diffuse || s.event == Lobes::glossy || s.event == Lobes::delta);
      ASSERT_TRUE(any(s.event & c.lobes));
      ASSERT_NEAR(length(s.wi), 1, 1e-5f);
      ASSERT_EQ(s.transmission, s.wi.z * c.wo.z < 0);
      const Spectrum f = bsdf().eval({}, c.wo, s.wi, c.lobes);
      const float pdf = bsdf().pdf({}, c.wo, s.wi, c.lobes);
      if (s.event == Lobes::delta) {
        ASSERT_TRUE(bsdf().eval({}, c.wo, s.wi, Lobes::delta).is_zero());
        ASSERT_EQ(bsdf().pdf({}, c.wo, s.wi, Lobes::delta), 0);
        continue;
      }
      // Half vectors at grazing angles lose digits; one of two kinds of arithmetic is not enough.
      ASSERT_NEAR(s.pdf_solid_angle, pdf, 0.01f * pdf + 1e-6f);
      if (!one_lobe) continue;
      for (int lane = 0; lane < 3; ++lane) {
        const float expected = f[lane] * std::fabs(s.wi.z) / pdf;
        ASSERT_NEAR(s.weight[lane], expected, 0.002f * expected + 1e-6f);
      }
    }
  }
}

Vec3d integrate_value(const Bsdf& bsdf, const Vec3f& wo, Lobes lobes) {
  const DirectionGrid grid(wo);
  Vec3d sum(0, 0, 0);
  for (size_t cell = 0; cell < grid.size(); ++cell)
    sum += grid.integrate(cell, [&](const Vec3f& wi) {
      const Spectrum f = bsdf.eval(flux(), wo, wi, lobes) * std::fabs(wi.z);
      return Vec3d(f[0], f[1], f[2]);
    });
  return sum;
}

/// The same whether the lobe is asked for alone or with others.
const Vec3d& integral_of_value(const Bsdf& bsdf, const Vec3f& wo, Lobes lobes) {
  static std::map<std::tuple<const Bsdf*, float, float, float, Lobes>, Vec3d> memory;
  const auto key = std::make_tuple(&bsdf, wo.x, wo.y, wo.z, lobes);
  const auto found = memory.find(key);
  return found != memory.end()
             ? found->second
             : memory.emplace(key, integrate_value(bsdf, wo, lobes)).first->second;
}

void EveryBsdf::expect_mean_weights_that_are_integrals(const Effort& effort) const {
  if (!has_density()) return;  // delta lobes have none
  for (const Case& c : cases_of(bsdf(), effort))
    for (size_t event = 0; event < 2; ++event) {
      if (!any(single_lobes[event] & c.lobes & bsdf().traits().lobes)) continue;
      SCOPED_TRACE(c.text + ", event " + std::to_string(event));
      const Vec3d& expected = integral_of_value(bsdf(), c.wo, single_lobes[event]);
      // Of a lobe that few samples meet only a larger error shows.
      const Spectrum lobe = bsdf().albedo({}, c.wo, single_lobes[event]),
                     all = bsdf().albedo({}, c.wo, c.lobes);
      const double error_found = effort.planted_error * std::sqrt(double(all.sum() / lobe.sum()));
      for (int lane = 0; lane < 3; ++lane) {
        SCOPED_TRACE(lane);
        const RunningStatistics& weight = drawn(bsdf(), c, effort).weights[event][size_t(lane)];
        // The quadrature is good to 1e-4; without variance that is all there is to see.
        const double error = std::hypot(weight.standard_error(), 5e-5 * expected[lane]);
        const double wrong = expected[lane] * (1 + error_found);
        EXPECT_GT(z_test_p_value(weight.mean(), error, expected[lane]), level(effort, 6));
        if (expected[lane] > 0) {
          EXPECT_LT(z_test_p_value(weight.mean(), error, wrong), level(effort, 6));
        }
      }
    }
}

TEST_P(EveryBsdf, mean_weight_of_each_event_is_the_integral_of_its_lobe) {
  expect_mean_weights_that_are_integrals(quick);
}

TEST_P(EveryBsdf, mean_weight_of_each_event_is_the_integral_of_its_lobeLong) {
  expect_mean_weights_that_are_integrals(at_length);
}

void EveryBsdf::expect_albedos_that_are_mean_weights(const Effort& effort) const {
  for (const Case& c : cases_of(bsdf(), effort)) {
    SCOPED_TRACE(c.text);
    const Spectrum albedo = bsdf().albedo({}, c.wo, c.lobes);
    EXPECT_LE(albedo.max_lane(), 1.0f + 1e-5f);
    EXPECT_EQ(albedo[3], 0);
    const bool estimated = any(c.lobes & bsdf().traits().lobes & Lobes::glossy);
    for (size_t lane = 0; lane < 3; ++lane) {
      const RunningStatistics& weight = drawn(bsdf(), c, effort).all_weights[lane];
      const double noise = 5 * weight.standard_error() + 2e-6;
      const double error = estimated ? GetParam().albedo_error * weight.mean() : 0;
      EXPECT_NEAR(albedo[int(lane)], weight.mean(), error + noise);
      EXPECT_LE(weight.mean(), 1 + noise);
    }
  }
}

TEST_P(EveryBsdf, albedo_is_the_mean_weight_and_at_most_one) {
  expect_albedos_that_are_mean_weights(quick);
}

TEST_P(EveryBsdf, albedo_is_the_mean_weight_and_at_most_oneLong) {
  expect_albedos_that_are_mean_weights(at_length);
}

// ---- symmetry and restrictions ----

/// What radiance meets one way, flux meets the other way. Without refraction the two are the same.
TEST_P(EveryBsdf, is_reciprocal) {
  for (int i = 0; i < 20000; ++i) {
    Sampler sampler = sampler_of(4, i);
    const Vec2f u = sampler.next_2d(), v = sampler.next_2d();
    const auto on_sphere = [](const Vec2f& p) {
      const float z = 2 * p.x - 1, r = safe_sqrt(1 - z * z), phi = 2 * pi * p.y;
      return Vec3f(r * std::cos(phi), r * std::sin(phi), z);
    };
    const Vec3f a = on_sphere(u), b = on_sphere(v);
    for (const Lobes lobes : lobe_sets(bsdf())) {
      const Spectrum ab = bsdf().eval({}, a, b, lobes), ba = bsdf().eval(flux(), b, a, lobes);
      for (int lane = 0; lane < 3; ++lane) {
        ASSERT_GE(ab[lane], 0);
        ASSERT_NEAR(ab[lane], ba[lane], 1e-4f * ab[lane] + 1e-7f);
      }
    }
  }
}

/// From both sides, in places where a lobe is and anywhere on the sphere.
TEST_P(EveryBsdf, values_are_what_is_asked_for_one_by_one) {
  const auto near = [](float value, float expected) {
    return std::fabs(value - expected) <= 1e-4f * expected + 1e-12f;
  };
  int asked = 0;
  for (const Vec3f& outside : outgoing_directions())
    for (int i = 0; i < 400; ++i) {
      Sampler sampler = sampler_of(6, i);
      const Vec3f wo(outside.x, outside.y, i % 2 ? outside.z : -outside.z);
      const Vec3f anywhere = square_to_sphere(sampler.next_2d());
      const float u_lobe = sampler.next_1d();
      const BsdfSample s = bsdf().sample({}, wo, u_lobe, sampler.next_2d(), Lobes::all);
      const std::array both{anywhere, s.event == Lobes::none ? anywhere : s.wi};
      std::array written_over = both;
      std::array<BsdfValues, 2> at_once;
      bsdf().all_values({}, wo, written_over, at_once);
      for (size_t k = 0; k < both.size(); ++k) {
        const Vec3f& wi = both[k];
        const BsdfValues values = bsdf().values({}, wo, wi);
        ASSERT_EQ(at_once[k], values);
        for (int lane = 0; lane < 4; ++lane) {
          ASSERT_PRED2(near, values.diffuse[lane], bsdf().eval({}, wo, wi, Lobes::diffuse)[lane]);
          ASSERT_PRED2(near, values.glossy[lane], bsdf().eval({}, wo, wi, Lobes::glossy)[lane]);
        }
        const float pdf = bsdf().pdf({}, wo, wi, Lobes::all);
        ASSERT_PRED2(near, values.pdf, pdf);
        ASSERT_PRED2(near, values.pdf_reverse, bsdf().pdf({}, wi, wo, Lobes::all));
        asked += pdf > 0;
      }
    }
  EXPECT_EQ(asked > 0, has_density());
}

TEST_P(EveryBsdf, lobes_add_up) {
  const Lobes parts[] = {Lobes::diffuse, Lobes::glossy, Lobes::delta};
  for (int i = 0; i < 2000; ++i) {
    Sampler sampler = sampler_of(5, i);
    const auto direction = [&] {
      const Vec2f u = sampler.next_2d();
      const float r = safe_sqrt(1 - u.x * u.x);
      return Vec3f(r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), u.x);
    };
    const Vec3f wo = direction(), wi = direction();
    Spectrum f, albedo;
    for (const Lobes part : parts) {
      f += bsdf().eval({}, wo, wi, part);
      albedo += bsdf().albedo({}, wo, part);
      if (!any(part & bsdf().traits().lobes)) {
        EXPECT_TRUE(bsdf().eval({}, wo, wi, part).is_zero());
      }
    }
    const Spectrum all = bsdf().eval({}, wo, wi, Lobes::all);
    const Spectrum whole = bsdf().albedo({}, wo, Lobes::all);
    for (int lane = 0; lane < 4; ++lane) {
      ASSERT_NEAR(f[lane], all[lane], 1e-5f * all[lane]);
      ASSERT_NEAR(albedo[lane], whole[lane], 1e-5f);
    }
  }
}

TEST_P(EveryBsdf, answers_nothing_where_nothing_is_scattered) {
  for (const Vec3f& outside : outgoing_directions())
    for (const float side : {1.0f, -1.0f})
      for (const Lobes lobes : {Lobes::none, Lobes::diffuse, Lobes::glossy, Lobes::delta}) {
        const Vec3f wo(outside.x, outside.y, side * outside.z), wi(0.1f, -0.3f, std::sqrt(0.9f));
        const bool has_lobe = any(lobes & bsdf().traits().lobes);
        if (has_lobe && !bsdf().albedo({}, wo, lobes).is_zero()) continue;
        EXPECT_TRUE(bsdf().albedo({}, wo, lobes).is_zero());
        EXPECT_TRUE(bsdf().eval({}, wo, wi, lobes).is_zero());
        EXPECT_EQ(bsdf().pdf({}, wo, wi, lobes), 0);
        const BsdfSample s = bsdf().sample({}, wo, 0.3f, {0.2f, 0.7f}, lobes);
        EXPECT_EQ(s.event, Lobes::none);
        EXPECT_TRUE(s.weight.is_zero());
      }
}

TEST_P(EveryBsdf, stays_finite_at_the_ends_of_the_square) {
  const float ends[] = {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon};
  std::vector<Vec3f> directions = outgoing_directions();
  directions.push_back({1, 0, 0});
  directions.push_back({std::sqrt(1 - 1e-12f), 0, 1e-6f});
  for (const Vec3f& wo : directions)
    for (const float side : {1.0f, -1.0f})
      for (const float a : ends)
        for (const float b : ends)
          for (const float c : ends) {
            const BsdfSample s =
                bsdf().sample({}, {wo.x, wo.y, side * wo.z}, a, {b, c}, Lobes::all);
            ASSERT_TRUE(s.weight.is_finite());
            ASSERT_TRUE(is_finite(s.wi));
            ASSERT_TRUE(std::isfinite(s.pdf_solid_angle));
            ASSERT_LE(s.weight.max_lane(), 1e4f);
          }
}

INSTANTIATE_TEST_SUITE_P(Instances, EveryBsdf, testing::ValuesIn(bsdf_instances()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

/// Counts how often it is asked.
class Counting final : public Bsdf {
 public:
  Counting() : Bsdf({.lobes = Lobes::diffuse}) {}
  Spectrum eval(const BsdfContext&, const Vec3f&, const Vec3f&, Lobes lobes) const override {
    return ++asked, Spectrum(any(lobes & Lobes::diffuse) ? inv_pi : 0.0f);
  }
  float pdf(const BsdfContext&, const Vec3f&, const Vec3f& wi, Lobes) const override {
    return ++asked, wi.z * inv_pi;
  }
  BsdfSample sample(const BsdfContext&, const Vec3f&, float, const Vec2f&, Lobes) const override {
    ++asked;
    return {{0, 0, 1}, Spectrum(1), inv_pi, Lobes::diffuse};
  }
  Spectrum albedo(const BsdfContext&, const Vec3f&, Lobes) const override {
    return ++asked, Spectrum(1);
  }
  mutable int64_t asked = 0;
};

/// A sample of a chain of blends asks each bsdf a few times,
/// however deep the chain is.
TEST(blendbsdf, a_chain_asks_each_bsdf_a_few_times) {
  const auto leaf = std::make_shared<Counting>();
  std::shared_ptr<const Bsdf> chain = leaf;
  for (int i = 0; i < 60; ++i) chain = make_bsdf("blendbsdf", {}, {chain, leaf});
  EXPECT_EQ(chain->traits().size, 121);
  leaf->asked = 0;
  for (const float u : {0.0f, 0.3f, 0.999f}) {  // by the leaf at the bottom, and by outer ones
    leaf->asked = 0;
    EXPECT_EQ(chain->sample({}, {0, 0, 1}, u, {0.5f, 0.5f}, Lobes::all).event, Lobes::diffuse);
    EXPECT_LE(leaf->asked, 61 * 8) << u;
  }
}

TEST(bsdf_types, are_rows) { expect_rows_of("bsdf", bsdf_types()); }

}  // namespace
}  // namespace kaustik
