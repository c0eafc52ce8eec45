// Regions with passes of their own: the mean, its errors, the same bits in parts as at once.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <tuple>

#include "kaustik/base/checksum.h"
#include "kaustik/image/photometry.h"
#include "kaustik/render/checkpoint.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/session.h"
#include "tests/support/measure.h"
#include "tests/support/pass_of.h"
#include "tests/support/same_bits.h"
#include "tests/support/scene_text.h"
#include "tests/support/scripted_integrator.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

// Tiles of the picture are cut, and so are those of the regions, which overlap.
constexpr int picture_width = 37, picture_height = 22;
constexpr PixelRegion first_region{7, 9, 21, 8}, second_region{12, 3, 20, 9};

FilmSettings settings_of_film(int w = picture_width, int h = picture_height) {
  FilmSettings settings;
  settings.size = settings.crop_size = {w, h};
  return settings;
}

using RegionPixels = std::vector<PassPixel>;

/// Noise of each pixel, and noise that all pixels of a pass share as they share photons.
class MadeUpPasses {
 public:
  explicit MadeUpPasses(uint32_t seed, float shared = 0) : generator_(seed), shared_(shared) {}
  RegionPixels next(size_t count) {
    std::normal_distribution<float> normal(0, 1);
    const float off = shared_ * normal(generator_);
    RegionPixels pixels(count);
    for (PassPixel& pixel : pixels) {
      const float value = 3 + off + normal(generator_);
      pixel.radiance[size_t(Component::direct)] = {value, value, value, 0};
      pixel.radiance[size_t(Component::caustic)] = {0.5f * value, 0, 0.125f, 0};
      pixel.first_hit.depth = value;
    }
    return pixels;
  }

 private:
  std::mt19937 generator_;
  float shared_;
};

Pass regional_pass(const Film& film, const PixelRegion& region, uint32_t stage) {
  Pass pass = film.next_regional_pass(region, stage);
  pass.samples_per_pixel = 1;
  return pass;
}

void add_regional(Film& film, const PixelRegion& region, const RegionPixels& pixels,
                  uint32_t stage) {
  film.add_regional_pass(region, pass_of(pixels, {region.width, region.height}),
                         regional_pass(film, region, stage));
}

/// A film, and the same passes pixel by pixel.
struct FilmAndPasses {
  Film film{settings_of_film(), {ComponentSet::all()}};
  struct Value {
    uint32_t replicate;
    float value;
  };
  std::vector<std::vector<Value>> values =
      std::vector<std::vector<Value>>(size_t(picture_width) * picture_height);

  void add_whole(uint32_t index, const RegionPixels& pixels) {
    film.add_pass(pass_of(pixels, {picture_width, picture_height}), index);
    for (size_t i = 0; i < pixels.size(); ++i) values[i].push_back(value_of(index, pixels[i]));
  }
  void add(const PixelRegion& region, const RegionPixels& pixels, uint32_t stage) {
    const uint32_t index = regional_pass(film, region, stage).index;
    add_regional(film, region, pixels, stage);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const size_t x = size_t(region.x) + i % size_t(region.width);
      const size_t y = size_t(region.y) + i / size_t(region.width);
      values[y * picture_width + x].push_back(value_of(index, pixels[i]));
    }
  }
  static Value value_of(uint32_t index, const PassPixel& pixel) {
    const Spectrum sum =
        pixel.radiance[size_t(Component::direct)] + pixel.radiance[size_t(Component::caustic)];
    return {index % replicate_count, photopic(Vec3f(sum[0], sum[1], sum[2]))};
  }
};

FilmAndPasses film_with_regions(uint32_t seed = 1) {
  FilmAndPasses result;
  MadeUpPasses passes(seed);
  for (uint32_t i = 0; i < 5; ++i)
    result.add_whole(i, passes.next(size_t(picture_width) * picture_height));
  for (int i = 0; i < 7; ++i)
    result.add(first_region, passes.next(size_t(first_region.pixel_count())), 5);
  for (int i = 0; i < 3; ++i)
    result.add(second_region, passes.next(size_t(second_region.pixel_count())), 5);
  return result;
}

float channel_at(const Image& image, int x, int y, const std::string& channel) {
  return image.at(x, y, image.find_channel(channel));
}

TEST(Regions, PixelsAreTheMeanOfAllTheirPasses) {
  const FilmAndPasses made = film_with_regions();
  const Image image = made.film.image();
  std::set<size_t> counts;
  for (int y = 0; y < picture_height; ++y)
    for (int x = 0; x < picture_width; ++x) {
      const size_t pixel = size_t(y) * picture_width + size_t(x);
      const auto& values = made.values[pixel];
      counts.insert(values.size());
      ASSERT_EQ(made.film.pass_count(pixel), values.size());
      RunningStatistics all;
      for (const auto& value : values) all.add(double(value.value));
      const Vec3f rgb(channel_at(image, x, y, "R"), channel_at(image, x, y, "G"),
                      channel_at(image, x, y, "B"));
      ASSERT_NEAR(photopic(rgb), all.mean(), 1e-5) << x << ", " << y;
      ASSERT_NEAR(channel_at(image, x, y, "depth.Z"), channel_at(image, x, y, "G"), 1e-5);
      ASSERT_EQ(float(made.film.total(pixel, 1) / double(values.size())), rgb.y);
      // Each replicate has at most a pass or two.
      const KnownLuminance known = FilmErrors(made.film).known(PixelRegion{x, y, 1, 1});
      ASSERT_NEAR(known.mean, all.mean(), 1e-5);
    }
  EXPECT_EQ(counts, (std::set<size_t>{5, 8, 12, 15}));
}

TEST(Regions, OutsideOfThemNoBitIsAnother) {
  const FilmAndPasses made = film_with_regions();
  FilmAndPasses plain;
  MadeUpPasses passes(1);
  for (uint32_t i = 0; i < 5; ++i)
    plain.add_whole(i, passes.next(size_t(picture_width) * picture_height));
  const Image image = made.film.image(), expected = plain.film.image();
  ASSERT_EQ(image.channel_names(), expected.channel_names());
  size_t changed = 0;
  for (int c = 0; c < image.channel_count(); ++c) {
    // Errors go by the pixels around, too.
    const bool is_error = image.channel_names()[size_t(c)].starts_with("error");
    for (int y = 0; y < picture_height; ++y)
      for (int x = 0; x < picture_width; ++x) {
        const int reach = is_error ? 2 : 0;
        const PixelRegion around{x - reach, y - reach, 2 * reach + 1, 2 * reach + 1};
        if (around.meets(first_region) || around.meets(second_region))
          changed += image.at(x, y, c) != expected.at(x, y, c) ? 1 : 0;
        else
          ASSERT_EQ(image.at(x, y, c), expected.at(x, y, c)) << x << ", " << y;
      }
  }
  EXPECT_GT(changed, size_t(first_region.pixel_count()));
}

/// Of a region that lies on four parts with other passes each, whose replicates share their noise.
TEST(Regions, ErrorsOfAMeanAcrossBordersComeFromItsReplicates) {
  const FilmAndPasses made = film_with_regions();
  const PixelRegion asked{4, 2, 20, 12};
  // The mean is a weighted sum of all values; what a replicate is off by is its share of it.
  std::array<double, replicate_count> off{};
  double mean = 0;
  for (int y = asked.y; y < asked.y + asked.height; ++y)
    for (int x = asked.x; x < asked.x + asked.width; ++x) {
      const auto& values = made.values[size_t(y) * picture_width + size_t(x)];
      for (const auto& value : values)
        mean += double(value.value) / double(values.size()) / double(asked.pixel_count());
    }
  for (const size_t count : {5u, 8u, 12u, 15u}) {
    double sum = 0, squares = 0;
    size_t pixels = 0;
    std::array<double, replicate_count> sums{}, passes{};
    for (int y = asked.y; y < asked.y + asked.height; ++y)
      for (int x = asked.x; x < asked.x + asked.width; ++x) {
        const auto& values = made.values[size_t(y) * picture_width + size_t(x)];
        if (values.size() != count) continue;
        ++pixels;
        passes = {};
        for (const auto& value : values) {
          sums[value.replicate] += double(value.value);
          passes[value.replicate] += 1;
          sum += double(value.value);
        }
      }
    ASSERT_GT(pixels, 0u);
    const double n = double(count);
    for (const double of_replicate : passes) squares += of_replicate * of_replicate / (n * n);
    const double scale = count == 5 ? 5.0 / 4 : 1 / (1 - squares);
    for (size_t r = 0; r < replicate_count; ++r)
      off[r] +=
          std::sqrt(scale) * (sums[r] - passes[r] * sum / n) / n / double(asked.pixel_count());
  }
  double variance = 0;
  for (const double of_replicate : off) variance += of_replicate * of_replicate;
  const KnownLuminance known = FilmErrors(made.film).known(asked);
  EXPECT_NEAR(known.mean, mean, 1e-6);
  EXPECT_NEAR(known.deviation, std::sqrt(variance), 1e-6);
  EXPECT_GE(known.freedom, 4);
  EXPECT_LE(known.freedom, 15);
}

struct Held {
  int pixels = 0, means = 0, apart = 0, pictures = 0;
};

/// How many intervals hold the truth, which is 3 (and half of that in red).
Held intervals_that_hold(int seeds, float shared, uint32_t whole, uint32_t regional) {
  constexpr int side = 9;
  constexpr PixelRegion inside{3, 2, 5, 7}, across{1, 1, 8, 6};
  const double truth = double(photopic(Vec3f(4.5f, 3, 3.125f)));
  Held held;
  for (int seed = 0; seed < seeds; ++seed) {
    Film film(settings_of_film(side, side), {ComponentSet::all()});
    MadeUpPasses passes(uint32_t(seed) + 77, shared);
    for (uint32_t i = 0; i < whole; ++i)
      film.add_pass(pass_of(passes.next(size_t(side) * side), {side, side}), i);
    for (uint32_t i = 0; i < regional; ++i)
      add_regional(film, inside, passes.next(size_t(inside.pixel_count())), whole);
    const FilmErrors errors(film);
    const auto holds = [&](const ConfidenceInterval& interval) {
      return std::fabs(interval.mean - truth) <= interval.half_width ? 1 : 0;
    };
    held.pixels += holds(errors.known(size_t{5} * side + 5).interval());
    const KnownLuminance mean = errors.known(across);
    held.means += holds(mean.interval());
    held.pictures += std::fabs(errors.known(PixelRegion{0, 0, side, side}).mean - truth) <=
                             film.mean_error() * errors.known(PixelRegion{0, 0, side, side}).mean
                         ? 1
                         : 0;
    // As if the region were independent of what is around it.
    const double share = double(5 * 5) / double(across.pixel_count());
    const double within = errors.known(PixelRegion{3, 2, 5, 5}).deviation * share;
    const double around = errors.known(PixelRegion{1, 1, 8, 1}).deviation * (1 - share);
    held.apart +=
        holds({mean.mean, student_t_quantile(0.975, mean.freedom) * std::hypot(within, around)});
  }
  return held;
}

void expect_coverage(int seeds, double least, double most) {
  const auto share = [&](int held) { return double(held) / seeds; };
  for (const auto& [whole, regional, shared] :
       {std::tuple{8u, 8u, 1.0f}, std::tuple{4u, 28u, 0.0f}, std::tuple{20u, 5u, 1.0f}}) {
    const Held held = intervals_that_hold(seeds, shared, whole, regional);
    std::printf(
        "  %u passes and %u of the region, shared noise %.0f: pixel %.3f, mean across %.3f, "
        "picture %.3f\n",
        whole, regional, double(shared), share(held.pixels), share(held.means),
        share(held.pictures));
    for (const int each : {held.pixels, held.means, held.pictures}) {
      EXPECT_GE(share(each), least);
      EXPECT_LE(share(each), most);
    }
  }
  // What shares its noise is not independent: that must show.
  if (slow_build) return;
  const double apart = share(intervals_that_hold(seeds, 3, 8, 8).apart);
  std::printf("  as if parts were independent %.3f\n", apart);
  EXPECT_LT(apart, least);
}

/// Three standard deviations of the counts.
TEST(Regions, IntervalsHoldTheTruthAcrossBorders) {
  if (slow_build)
    expect_coverage(40, 0.84, 1);
  else
    expect_coverage(250, 0.908, 0.992);
}

/// As of pictures: docs/errors.md.
TEST(Regions, IntervalsHoldTheTruthAcrossBordersLong) { expect_coverage(3000, 0.93, 0.97); }

/// A glass ball over a floor: every component but media.
const TestScene& ball() {
  static const TestScene scene(
      camera("0, -4, 2", "0, 0, 0.5", 45, 24) + flat("rectangle", scale("3"), diffuse("0.5")) +
      sphere("0, 0, 0.6", 0.6, glass()) +
      flat("rectangle", scale("0.5") + rotate("1, 0, 0", 180) + translate("0, 0, 3"),
           area_light("9")));
  return scene;
}

std::unique_ptr<Integrator> integrator_of(const std::string& type, std::string parameters = "") {
  if (type == "photonmap")
    parameters +=
        set("global_photons", 2000) + set("caustic_photons", 2000) + set("cache_samples", 16);
  return ball().integrator(type, parameters);
}

constexpr PixelRegion floor_region{5, 12, 13, 9};

SessionSettings refined_settings(uint32_t passes, std::vector<RegionRequest> regions = {},
                                 uint32_t first = 0) {
  SessionSettings settings;
  settings.seed = 5;
  settings.first_pass = first;
  settings.passes = passes;
  settings.samples_per_pass = 2;
  settings.regions = std::move(regions);
  return settings;
}

Film refined_film(const Integrator& integrator, const SessionSettings& settings) {
  Session session(ball().scene(), integrator, settings);
  session.run();
  return session.film();
}

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

std::vector<uint8_t> film_bytes(const Film& film) { return checkpoint_bytes({}, film); }

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

RenderRecord record_for(uint32_t passes, uint32_t first = 0) {
  RenderRecord record;
  record.recipe.seed = 5;
  record.recipe.samples_per_pass = 2;
  record.plan = {first, passes, {}, {}};
  return record;
}

/// Stopped within the region's passes, kept in a file, and gone on with.
TEST(Regions, ResumedOnesHaveTheSameBits) {
  const TemporaryFolder folder;
  for (const char* type : {"path", "auto", "ppm", "photonmap"}) {
    const auto integrator = integrator_of(type);
    // After the second pass five of the region, after the third two.
    const auto ask = [](Session& session) {
      const Film& film = session.film();
      const uint32_t asked = film.regional_pass_count();
      if (film.pass_count() == 2 && asked == 0) {
        EXPECT_TRUE(session.refine({floor_region, 5}));
      }
      if (film.pass_count() == 3 && asked == 5) {
        EXPECT_TRUE(session.refine({floor_region, 2}));
      }
    };
    Session whole(ball().scene(), *integrator, refined_settings(4));
    whole.run({}, {}, [&] { ask(whole); });
    ASSERT_EQ(whole.film().regional_pass_count(), 7u);

    const auto before = integrator_of(type);
    std::stop_source stop;
    Session begun(ball().scene(), *before, refined_settings(4));
    const SessionReport report = begun.run(stop.get_token(), {}, [&] {
      ask(begun);
      if (begun.film().regional_pass_count() == 3) stop.request_stop();
    });
    ASSERT_EQ(begun.film().regional_pass_count(), 3u);
    EXPECT_EQ(report.picture_error, begun.film().picture_error());
    const std::string path = folder.path(std::string(type) + ".kpt");
    write_checkpoint(path, record_for(4), begun.film(), before->lessons());

    Checkpoint kept = read_checkpoint(path);
    const auto after = integrator_of(type);
    if (!kept.lessons.empty()) after->go_on_with(kept.lessons, LessonUse::go_on);
    Session resumed(ball().scene(), *after, refined_settings(4, {{floor_region, 2}}),
                    std::move(kept.film));
    resumed.run({}, {}, [&] { ask(resumed); });
    EXPECT_EQ(film_bytes(resumed.film()), film_bytes(whole.film())) << type;
    EXPECT_TRUE(same_bits(resumed.film().image(), whole.film().image())) << type;
    EXPECT_EQ(resumed.film().picture_error(), whole.film().picture_error());
  }
}

TEST(Regions, PartsAreMergedInAnyOrder) {
  const auto integrator = integrator_of("path");
  constexpr PixelRegion elsewhere{0, 0, 5, 6};
  const Film a = refined_film(*integrator, refined_settings(2, {{floor_region, 3}}));
  const Film b = refined_film(*integrator, refined_settings(2, {{elsewhere, 4}}, 2));
  const Film plain = refined_film(*integrator, refined_settings(4));
  Checkpoint ab{record_for(2), a, {}}, ba{record_for(2, 2), b, {}};
  merge_checkpoint(ab, "a.kpt", {record_for(2, 2), b, {}}, "b.kpt");
  merge_checkpoint(ba, "b.kpt", {record_for(2), a, {}}, "a.kpt");
  EXPECT_EQ(film_bytes(ab.film), film_bytes(ba.film));
  ASSERT_EQ(ab.film.regions().size(), 2u);
  EXPECT_TRUE(ab.film.regions()[0].pixels == elsewhere);
  const Image merged = ab.film.image(), expected = plain.image();
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      if (!floor_region.holds(x, y) && !elsewhere.holds(x, y)) {
        ASSERT_EQ(channel_at(merged, x, y, "G"), channel_at(expected, x, y, "G"));
      }
  // Within, the sums are those of all passes.
  for (const auto& [x, y] : {std::pair(12, 17), std::pair(2, 3)}) {
    const size_t pixel = size_t(y) * 24 + size_t(x);
    EXPECT_EQ(ab.film.pass_count(pixel), floor_region.holds(x, y) ? 7u : 8u);
    const auto own = [&](const Film& film) { return film.total(pixel, 1); };
    EXPECT_DOUBLE_EQ(own(ab.film), own(a) + own(b));
    EXPECT_NE(channel_at(merged, x, y, "G"), channel_at(expected, x, y, "G"));
  }
  // The same passes of the same pixels.
  const Film again = refined_film(*integrator, refined_settings(2, {{{10, 15, 3, 3}, 3}}, 2));
  Checkpoint twice{record_for(2), a, {}};
  ASSERT_EQ(a.twice_in_regions(again).count(), 2u);
  try {
    merge_checkpoint(twice, "a.kpt", {record_for(2, 2), again, {}}, "c.kpt");
    FAIL() << "passes of regions came twice";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("given before"), std::string::npos) << error.what();
  }
}

TEST(Regions, DamagedFilesAreRefused) {
  const Film film = refined_film(*integrator_of("path"), refined_settings(2, {{floor_region, 3}}));
  const std::vector<uint8_t> good = checkpoint_bytes(record_for(2), film);
  EXPECT_EQ(film_bytes(parse_checkpoint(good, "good.kpt").film), film_bytes(film));
  const auto with_checksum = [](std::vector<uint8_t> bytes) {
    const uint64_t sum = checksum(std::span(bytes).first(bytes.size() - sizeof(uint64_t)));
    std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
    return bytes;
  };
  // The region's row: its place, its orders, its size.
  const PixelRegion& r = floor_region;
  const std::vector<int32_t> row = {r.x, r.y, 1, 0, 1, 4, 1, r.width};
  const auto* first = reinterpret_cast<const uint8_t*>(row.data());
  const auto at = std::search(good.begin(), good.end(), first, first + row.size() * 4);
  ASSERT_NE(at, good.end());
  const auto place = at - good.begin();
  int refused = 0;
  for (const auto& [offset, value] : std::vector<std::pair<int, int32_t>>{{0, -1},
                                                                          {0, 12},
                                                                          {0, 1 << 30},
                                                                          {4, 16},
                                                                          {8, 0},
                                                                          {8, 1 << 30},
                                                                          {16, 5},
                                                                          {16, 2},
                                                                          {20, -1},
                                                                          {20, 6},
                                                                          {24, -1},
                                                                          {28, 0},
                                                                          {28, 1 << 30},
                                                                          {-8, 2},
                                                                          {-8, 0}}) {
    std::vector<uint8_t> bad = good;
    std::memcpy(bad.data() + place + offset, &value, sizeof value);
    EXPECT_THROW(parse_checkpoint(with_checksum(bad), "bad.kpt"), Error) << offset << ": " << value;
    ++refused;
  }
  EXPECT_EQ(refused, 15);
  for (size_t size = size_t(place); size < good.size(); size += 97) {
    std::vector<uint8_t> cut(good.begin(), good.begin() + std::ptrdiff_t(size));
    cut.resize(cut.size() + sizeof(uint64_t));
    EXPECT_THROW(parse_checkpoint(with_checksum(cut), "cut.kpt"), Error);
  }
  std::mt19937 generator(3);
  for (int i = 0; i < 300; ++i) {
    std::vector<uint8_t> flipped = good;
    const size_t where = size_t(place) + generator() % (good.size() - size_t(place) - 8);
    flipped[where] ^= uint8_t(1u << generator() % 8);
    try {
      parse_checkpoint(with_checksum(flipped), "flipped.kpt").film.image();
    } catch (const Error&) {
    }
  }
}

// Pixels would count it twice, and be told to have less noise than they have.
TEST(Regions, AFileWithAPassTwiceForTheSamePixelsIsRefused) {
  const auto film_of = [](bool is_same_pass) {
    FilmAndPasses all;
    MadeUpPasses passes(1);
    all.add_whole(0, passes.next(size_t(picture_width) * picture_height));
    Pass pass = regional_pass(all.film, first_region, 1);
    for (const PixelRegion& region : {first_region, second_region}) {
      if (!is_same_pass) pass = regional_pass(all.film, region, 1);
      const RegionPixels pixels = passes.next(size_t(region.pixel_count()));
      all.film.add_regional_pass(region, pass_of(pixels, {region.width, region.height}), pass);
    }
    return std::move(all.film);
  };
  EXPECT_NO_THROW(parse_checkpoint(film_bytes(film_of(false)), "good.kpt"));
  EXPECT_THROW(parse_checkpoint(film_bytes(film_of(true)), "twice.kpt"), Error);
}

// No pixel is left that has the passes of the picture alone.
TEST(Regions, ThatCoverThePictureMakeItsErrorKnown) {
  for (const int height : {picture_height, picture_height - 1}) {
    FilmAndPasses all;
    MadeUpPasses passes(1);
    all.add_whole(0, passes.next(size_t(picture_width) * picture_height));
    const PixelRegion region{0, 0, picture_width, height};
    for (int i = 0; i < 15; ++i) all.add(region, passes.next(size_t(region.pixel_count())), 1);
    EXPECT_EQ(std::isfinite(all.film.mean_error()), height == picture_height);
    EXPECT_EQ(std::isfinite(all.film.picture_error()), height == picture_height);
  }
}

TEST(Regions, BadRequestsAreRefused) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(1));
  for (const RegionRequest& bad :
       std::vector<RegionRequest>{{{0, 0, 4, 4}, 0},
                                  {{0, 0, 4, 4}, most_region_passes + 1},
                                  {{-1, 0, 4, 4}, 1},
                                  {{0, 0, 25, 4}, 1},
                                  {{20, 0, 5, 1}, 1},
                                  {{0, 23, 1, 2}, 1},
                                  {{24, 0, 1, 1}, 1},
                                  {{0, 0, 0, 1}, 1},
                                  {{2147483647, 2147483647, 2147483647, 2147483647}, 1}})
    EXPECT_THROW((void)session.refine(bad), Error) << bad.pixels.text();
  EXPECT_TRUE(session.regions().empty());
  EXPECT_TRUE(session.refine({floor_region, most_region_passes}));
  EXPECT_THROW((void)session.refine({floor_region, 1}), Error);
  // Four times the picture, and no more.
  Session many(ball().scene(), *integrator, refined_settings(1));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(many.refine({{0, 0, 24, 24 - i}, 1}));
  EXPECT_TRUE(many.refine({{0, 0, 24, 3}, 1}));
  EXPECT_THROW((void)many.refine({{0, 0, 24, 5}, 1}), Error);
  EXPECT_TRUE(many.refine({{0, 0, 24, 3}, 1}));
  EXPECT_EQ(many.regions().size(), 5u);
}

TEST(Regions, WaitForThePictureAndEndWithIt) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(3, {{floor_region, 2}}));
  std::vector<std::pair<uint32_t, uint32_t>> seen;
  const SessionReport report = session.run({}, {}, [&] {
    seen.emplace_back(session.film().pass_count(), session.film().regional_pass_count());
  });
  using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;
  EXPECT_EQ(seen, (Pairs{{1, 0}, {1, 1}, {1, 2}, {2, 2}, {3, 2}}));
  EXPECT_EQ(report.passes, 3u);
  EXPECT_EQ(report.regional_passes, 2u);
  EXPECT_EQ(report.end, SessionEnd::passes);
  // Nobody would take them.
  EXPECT_FALSE(session.refine({floor_region, 4}));
  EXPECT_EQ(session.regions()[0].waiting, 0u);
}

TEST(Regions, AskedForAfterTheLastPassAreRendered) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(2));
  session.run({}, {}, [&] {
    if (session.film().pass_count() == 2 && session.film().regions().empty()) {
      EXPECT_TRUE(session.refine({floor_region, 4}));
    }
  });
  EXPECT_EQ(session.film().pass_count(), 2u);
  EXPECT_EQ(session.film().regional_pass_count(), 4u);
}

// Whoever asks as it ends gets what was promised, or a no.
TEST(Regions, NoneIsLostAtTheEnd) {
  const auto integrator = integrator_of("path");
  uint32_t refused = 0;
  for (int i = 0; i < 20; ++i) {
    Session session(ball().scene(), *integrator, refined_settings(1));
    std::atomic<bool> has_pass = false;
    uint32_t taken = 0;
    std::thread asking([&] {
      while (!has_pass) std::this_thread::yield();
      while (taken < 50 && session.refine({{3, 20, 2, 2}, 1})) ++taken;
    });
    session.run({}, {}, [&] { has_pass = true; });
    asking.join();
    refused += taken < 50 ? 1 : 0;
    ASSERT_EQ(session.film().regional_pass_count(), taken);
  }
  EXPECT_GT(refused, 0u);
}

TEST(Regions, ProgressNeverFallsBack) {
  const auto integrator = integrator_of("path");
  // Beside passes of the picture, then by themselves.
  std::optional<Film> film;
  for (int run = 0; run < 2; ++run) {
    SessionSettings settings = refined_settings(4, {{floor_region, 20}});
    // Time flies, so that every tile is told.
    settings.clock = [begin = std::chrono::steady_clock::now()] {
      return 1e4 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    Session session = film ? Session(ball().scene(), *integrator, settings, std::move(*film))
                           : Session(ball().scene(), *integrator, settings);
    std::vector<double> fractions;
    session.run({}, [&](const Progress& progress) { fractions.push_back(progress.fraction); });
    ASSERT_GT(fractions.size(), 10u);
    for (size_t i = 1; i < fractions.size(); ++i)
      EXPECT_GE(fractions[i], fractions[i - 1] - 0.01) << run << ": " << i;
    EXPECT_LT(fractions.front(), 0.1);
    EXPECT_GT(fractions[fractions.size() - 2], 0.85);
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_EQ(session.film().regional_pass_count(), 20u * unsigned(run + 1));
    film = session.film();
  }
}

}  // namespace
}  // namespace kaustik
