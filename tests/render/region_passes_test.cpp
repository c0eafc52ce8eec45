// Passes of regions beside those of the picture: the same light, random numbers of their own, the
// same bits.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "kaustik/render/film_errors.h"
#include "tests/render/region_testing.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

/// How blocks of the region compare, by its own passes and by others of the picture, whose blocks
/// are `off` pixels farther to the left.
struct Comparison {
  double largest_z = 0;
  double variances = 0;  ///< median of own over other: few blocks may have met rare events
};

Comparison compared(const Film& with_region, const Film& whole, int off) {
  const FilmErrors own(with_region.regions().at(0).film), other(whole);
  Comparison result;
  std::vector<double> ratios;
  for (int y = 0; y + 3 <= floor_region.height; y += 3)
    for (int x = 0; x + 3 <= floor_region.width; x += 3) {
      const KnownLuminance a = own.known(PixelRegion{x, y, 3, 3});
      const KnownLuminance b =
          other.known(PixelRegion{floor_region.x + x - off, floor_region.y + y, 3, 3});
      // Some caustics are not everywhere.
      if (!(a.deviation > 0 && b.deviation > 0)) continue;
      const double error = std::hypot(a.deviation, b.deviation);
      result.largest_z = std::max(result.largest_z, std::fabs(a.mean - b.mean) / error);
      ratios.push_back(std::pow(a.deviation / b.deviation, 2));
    }
  std::nth_element(ratios.begin(), ratios.begin() + std::ptrdiff_t(ratios.size() / 2),
                   ratios.end());
  result.variances = ratios[ratios.size() / 2];
  return result;
}

/// By Student's t of about 16 replicates, 12 blocks and 6 integrators, once in a thousand.
TEST(Regions, TheirPassesAgreeWithThoseOfThePicture) {
  constexpr double most_z = 6;
  const uint32_t passes = 16;
  for (const char* type : {"path", "lighttracer", "bdpt", "auto", "ppm", "photonmap"}) {
    const auto integrator = integrator_of(type);
    const Film refined =
        refined_film(*integrator, refined_settings(passes, {{floor_region, 2 * passes}}));
    ASSERT_EQ(refined.regions().size(), 1u);
    ASSERT_EQ(refined.regions()[0].film.pass_count(), 2 * passes);
    // Radii shrink with the passes: those that come next have nearly the region's.
    const Film next = refined_film(*integrator, refined_settings(passes, {}, passes));
    const Comparison same = compared(refined, next, 0), elsewhere = compared(refined, next, 5);
    std::printf(
        "  %s: |z| up to %.2f, of other places %.2f; variance over that of half as many "
        "passes of the picture %.2f\n",
        type, same.largest_z, elsewhere.largest_z, same.variances);
    EXPECT_LT(same.largest_z, most_z) << type;
    // Light of other places is another.
    EXPECT_GT(elsewhere.largest_z, most_z) << type;
    EXPECT_GT(same.variances, 0.1) << type;
    EXPECT_LT(same.variances, 1.2) << type;
  }
}

/// Gives regional passes the radii that passes of such numbers would have.
class Misled final : public Integrator {
 public:
  explicit Misled(std::unique_ptr<Integrator> inner) : inner_(std::move(inner)) {
    traits_ = inner_->traits();
  }
  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override {
    Pass misled = pass;
    misled.order.stage = pass_limit - 1;
    return inner_->prepare(misled, splats, stop, progress);
  }
  void sample(const PassState& state, const Vec2f& raster, Sampler& sampler,
              SampleSink& sink) const override {
    inner_->sample(state, raster, sampler, sink);
  }

 private:
  std::unique_ptr<Integrator> inner_;
};

TEST(Regions, RadiiOfTheirNumbersWouldShow) {
  const auto variances_of = [](const Integrator& integrator) {
    const Film refined = refined_film(integrator, refined_settings(16, {{floor_region, 32}}));
    const Film next = refined_film(integrator, refined_settings(16, {}, 16));
    return compared(refined, next, 0).variances;
  };
  const std::string caustic = set("components", "caustic");
  const double led = variances_of(*integrator_of("photonmap", caustic));
  const double misled = variances_of(Misled(integrator_of("photonmap", caustic)));
  std::printf("  variance over that of half as many passes of the picture %.2f, misled %.2f\n", led,
              misled);
  EXPECT_GT(led, 0.1);
  EXPECT_LT(led, 1.2);
  EXPECT_GT(misled, 1.2);
}

/// In a closed sphere that shines everywhere, L = 1/(1 − ρ) in all pixels.
void expect_truth_of_furnace(const char* type, uint64_t seeds) {
  constexpr int side = 8;
  constexpr double truth = 1 / (1 - 0.6);
  constexpr PixelRegion inside{2, 3, 4, 4}, across{0, 2, 5, 3};
  const TestScene scene(
      camera("0, 0, 0.4", "0, 0, 0", 90, side, "0, 1, 0") +
      sphere("0.1, 0.2, 0.1", 1, diffuse("0.6, 0.6, 0.6") + area_light("1, 1, 1"), true));
  const auto integrator = scene.integrator(type);
  int within = 0, around = 0, means = 0;
  RunningStatistics off;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    SessionSettings settings = refined_settings(16, {{inside, 16}});
    settings.seed = seed;
    settings.samples_per_pass = 4;
    Session session(scene.scene(), *integrator, settings);
    session.run();
    const FilmErrors errors(session.film());
    const auto holds = [](const KnownLuminance& known) {
      const ConfidenceInterval interval = known.interval();
      return std::fabs(interval.mean - truth) <= interval.half_width ? 1 : 0;
    };
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        (inside.holds(x, y) ? within : around) += holds(errors.known(size_t(y * side + x)));
    const KnownLuminance mean = errors.known(across);
    means += holds(mean);
    off.add(mean.mean - truth);
  }
  const double pixels = double(inside.pixel_count()) * double(seeds);
  const double others = double(side * side - inside.pixel_count()) * double(seeds);
  std::printf("  %s: of the region's pixels %.3f, of others %.3f, of means across %.3f\n", type,
              within / pixels, around / others, double(means) / double(seeds));
  const double least = slow_build ? 0.85 : 0.92;
  EXPECT_GT(within / pixels, least) << type;
  EXPECT_GT(around / others, least) << type;
  EXPECT_GT(double(means) / double(seeds), slow_build ? 0.6 : 0.85) << type;
  EXPECT_LT(std::fabs(off.mean()), 4 * off.standard_error()) << type;
}

TEST(Regions, IntervalsHoldTheTruthOfAFurnace) {
  expect_truth_of_furnace("path", slow_build ? 8 : 40);
}

TEST(Regions, IntervalsHoldTheTruthOfAFurnaceLong) {
  for (const char* type : {"path", "auto"}) expect_truth_of_furnace(type, slow_build ? 8 : 200);
}

TEST(Regions, VarianceFallsAsThatOfAsManyPasses) {
  const auto integrator = integrator_of("path");
  const int seeds = slow_build ? 10 : 60;
  const size_t pixels = size_t(floor_region.pixel_count());
  std::array<std::vector<RunningStatistics>, 3> of;
  for (auto& each : of) each.resize(pixels);
  for (int seed = 1; seed <= seeds; ++seed) {
    size_t which = 0;
    for (const auto& [whole, regional] :
         {std::pair{2u, 0u}, std::pair{2u, 6u}, std::pair{8u, 0u}}) {
      SessionSettings settings = refined_settings(whole);
      settings.seed = uint64_t(seed);
      if (regional > 0) settings.regions = {{floor_region, regional}};
      const Image image = refined_film(*integrator, settings).image(false);
      for (size_t i = 0; i < pixels; ++i)
        of[which][i].add(double(image.at(floor_region.x + int(i) % floor_region.width,
                                         floor_region.y + int(i) / floor_region.width, 1)));
      ++which;
    }
  }
  std::array<double, 3> variances{};
  for (size_t k = 0; k < 3; ++k)
    for (const RunningStatistics& pixel : of[k]) variances[k] += pixel.variance();
  std::printf("  variance of 2 passes with 6 of the region over that of 2: %.3f; of 8: %.3f\n",
              variances[1] / variances[0], variances[2] / variances[0]);
  EXPECT_NEAR(variances[1] / variances[0], 0.25, slow_build ? 0.15 : 0.05);
  EXPECT_NEAR(variances[1] / variances[2], 1, slow_build ? 0.5 : 0.15);
}

TEST(Regions, SameBitsWithAnyNumberOfThreads) {
  for (const char* type : {"path", "auto", "photonmap"}) {
    const auto integrator = integrator_of(type);
    SessionSettings settings = refined_settings(2, {{floor_region, 3}, {{0, 0, 9, 14}, 2}});
    settings.threads = 1;
    const std::vector<uint8_t> one = film_bytes(refined_film(*integrator, settings));
    for (const int threads : {2, 0}) {
      settings.threads = threads;
      EXPECT_EQ(film_bytes(refined_film(*integrator_of(type), settings)), one) << type;
    }
  }
}

/// No number is used twice: not of passes of the picture, nor of other orders or regions.
TEST(Regions, NoRandomNumberComesTwice) {
  const auto scene = plain_scene();
  std::mutex mutex;
  std::map<std::pair<float, float>, int> seen;
  std::vector<Pass> passes;
  Script script;
  script.prepare = [&](const Pass& pass, SplatBuffer&) { passes.push_back(pass); };
  script.sample = [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
    sink.add(Component::direct, {1, 2, 3, 0});
    if (std::floor(raster.x) != 5 || std::floor(raster.y) != 6) return;
    const Vec2f number = sampler.next_2d();
    const std::lock_guard lock(mutex);
    ++seen[{number.x, number.y}];
  };
  const Scripted integrator(script);
  SessionSettings settings = refined_settings(20, {{{3, 3, 8, 9}, 20}, {{5, 6, 1, 1}, 35}});
  settings.samples_per_pass = 64;
  Session session(*scene, integrator, settings);
  // More of the first one later: another order.
  session.run({}, {}, [&] {
    if (session.film().pass_count() == 17 && session.film().regional_pass_count() == 55) {
      ASSERT_TRUE(session.refine({{3, 3, 8, 9}, 18}));
    }
  });
  ASSERT_EQ(passes.size(), 20u + 20 + 35 + 18);
  // The filter takes pixels a little apart, so not all samples are seen.
  EXPECT_GT(seen.size(), 64u * 60);
  for (const auto& [number, count] : seen) ASSERT_EQ(count, 1);
  std::set<uint32_t> indices;
  for (const Pass& pass : passes) EXPECT_TRUE(indices.insert(pass.index).second);
  const auto regional =
      std::count_if(passes.begin(), passes.end(), [](const Pass& p) { return p.is_regional(); });
  EXPECT_EQ(regional, 73);
  const FilmRegion& first = session.film().regions()[0];
  ASSERT_EQ(first.orders.size(), 2u);
  EXPECT_EQ(first.orders[1].stage, 17u);
  for (const Pass& pass : passes)
    if (pass.is_regional()) {
      const bool is_late = pass.index - first_regional_pass >= first.orders[1].passes.begin;
      EXPECT_EQ(pass.stage(), is_late ? 17u : 1u);
    }
  // With one pass of the picture, they begin with the next replicate.
  EXPECT_EQ(first.orders[0].passes, (PassRange{1, 21}));
}

/// Their splats are dropped there, and the passes that come after them have learned nothing of
/// them.
TEST(Regions, PassesOfThePictureDoNotKnowOfThem) {
  for (const char* type : {"lighttracer", "bdpt", "auto", "photonmap"}) {
    const auto plain_integrator = integrator_of(type), integrator = integrator_of(type);
    const Image plain = refined_film(*plain_integrator, refined_settings(3)).image();
    const Image refined =
        refined_film(*integrator, refined_settings(3, {{floor_region, 4}})).image();
    bool differs = false;
    for (int y = 0; y < plain.height(); ++y)
      for (int x = 0; x < plain.width(); ++x)
        for (const char* channel : {"R", "G", "B", "caustic.R", "direct.G", "depth.Z"}) {
          const bool same = channel_at(plain, x, y, channel) == channel_at(refined, x, y, channel);
          if (floor_region.holds(x, y))
            differs = differs || !same;
          else
            ASSERT_TRUE(same) << type << ": " << channel << " at " << x << ", " << y;
        }
    EXPECT_TRUE(differs) << type;
    EXPECT_EQ(integrator->lessons(), plain_integrator->lessons()) << type;
  }
}

TEST(Regions, AreNamedInThePicture) {
  const Film film = refined_film(*integrator_of("path"), refined_settings(2, {{floor_region, 4}}));
  const Image image = film.image(false);
  const auto* text = image.find_metadata(regions_key);
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(std::get<std::string>(*text), "13 x 9 pixels at (5, 12): 4 passes");
  EXPECT_EQ(
      refined_film(*integrator_of("path"), refined_settings(2)).image().find_metadata(regions_key),
      nullptr);
}

}  // namespace
}  // namespace kaustik
