// Camera samples go where those of passes before differed: how many, on paper, and that pictures
// stay right.

#include "kaustik/vcm/lessons/sample_learning.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "kaustik/render/film_errors.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

double mean(const std::vector<uint32_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size());
}

constexpr int blocks_across = 16;
constexpr double pairs_seen = 64;
const Vec2i blocks(blocks_across, blocks_across);
const std::vector<uint32_t> pixels_of_blocks(size_t(blocks_across) * blocks_across, 16);

SampleLearning::Sums sums(double variance, double rays) {
  return {pairs_seen, variance * pairs_seen, pairs_seen, rays * pairs_seen};
}

/// The left half of a picture has the variance `left`, the right `right`.
std::vector<SampleLearning::BlockSums> halves(double left, double right, double rays_left = 1) {
  std::vector<SampleLearning::BlockSums> result;
  for (int y = 0; y < blocks.y; ++y)
    for (int x = 0; x < blocks.x; ++x) {
      const SampleLearning::Sums seen = x < blocks.x / 2 ? sums(left, rays_left) : sums(right, 1);
      result.push_back({{seen, seen}});
    }
  return result;
}
SampleLearning::Counts counts(const std::vector<SampleLearning::BlockSums>& seen,
                              uint32_t samples) {
  return SampleLearning::counts(seen, pixels_of_blocks, blocks, samples);
}

TEST(SampleCounts, AreAlikeWhereNoiseIs) {
  EXPECT_TRUE(counts(halves(1, 1), 4).of_block.empty());
  EXPECT_TRUE(counts(halves(0, 0), 4).of_block.empty());
  EXPECT_TRUE(SampleLearning::counts({}, {}, {0, 0}, 4).of_block.empty());
  // One sample cannot be shared out.
  EXPECT_TRUE(counts(halves(1, 100), 1).of_block.empty());
}

TEST(SampleCounts, FollowTheNoise) {
  for (const uint32_t samples : {2u, 4u, 6u, 16u}) {
    SCOPED_TRACE(samples);
    const SampleLearning::Counts found = counts(halves(1, 25), samples);
    ASSERT_EQ(found.of_block.size(), pixels_of_blocks.size());
    EXPECT_GT(found.gain, 1.05);
    EXPECT_LE(mean(found.of_block), samples);
    EXPECT_GT(mean(found.of_block), 0.9 * samples);
    EXPECT_LT(found.of_block[0], samples);
    EXPECT_GT(found.of_block[blocks_across - 1], samples);
    for (const uint32_t count : found.of_block) {
      EXPECT_GE(count, std::max(1u, samples / 2));
      EXPECT_LE(count, 4 * samples);
    }
  }
}

/// The same noise for more rays is worth fewer samples.
TEST(SampleCounts, KnowTheCost) {
  const SampleLearning::Counts found = counts(halves(4, 4, 60), 4);
  ASSERT_FALSE(found.of_block.empty());
  uint32_t dear = 0, cheap = 0;
  for (size_t i = 0; i < found.of_block.size(); ++i)
    (int(i % blocks_across) < blocks.x / 2 ? dear : cheap) += found.of_block[i];
  EXPECT_GT(cheap, 2 * dear);
}

/// Where halves of the passes contradict each other nothing is known.
TEST(SampleCounts, AreAlikeWhereDifferencesAreChance) {
  std::mt19937 random(5);
  std::exponential_distribution<double> any(1);
  std::vector<SampleLearning::BlockSums> seen;
  for (size_t i = 0; i < pixels_of_blocks.size(); ++i)
    seen.push_back({{sums(std::pow(any(random), 3), 1), sums(std::pow(any(random), 3), 1)}});
  EXPECT_TRUE(counts(seen, 4).of_block.empty());
}

/// What pixels get in a pass.
std::vector<PixelSamples> samples_of(const TestScene& scene, const Integrator& integrator,
                                     uint32_t pass_index, uint32_t samples = 4) {
  const Pass pass{3, pass_index, samples};
  const bool splats = integrator.traits().splats;
  SplatBuffer buffer = splats ? SplatBuffer(scene.scene().film(), integrator.traits().components)
                              : SplatBuffer::nowhere();
  const auto state = integrator.prepare(pass, buffer, {}, {});
  std::vector<PixelSamples> result;
  const Vec2i size = scene.scene().film().crop_size;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      result.push_back(integrator.pixel_samples(*state, pass, {x, y}));
  return result;
}
std::vector<uint32_t> counts_of(const TestScene& scene, const Integrator& integrator,
                                uint32_t pass_index) {
  std::vector<uint32_t> counts;
  for (const PixelSamples& samples : samples_of(scene, integrator, pass_index))
    counts.push_back(samples.count);
  return counts;
}
bool are_alike(const std::vector<uint32_t>& counts) {
  return std::all_of(counts.begin(), counts.end(), [&](uint32_t c) { return c == counts[0]; });
}

/// A disk over a floor whose left half shines about as brightly as the right is lit: there is no
/// noise, while on the right all of it is that of light sampling, and the truth is known.
constexpr int side = 64;
std::string half_a_floor() {
  return camera("0, 0, 0.4", "0, 0, 0", 90, side, "0, 1, 0") +
         flat("rectangle", scale("1, 2, 1") + translate("1, 0, 0"), diffuse("0.7, 0.7, 0.7")) +
         flat("rectangle", scale("1, 2, 1") + translate("-1, 0, 0"),
              diffuse("0, 0, 0") + area_light("1.5, 1.5, 1.5")) +
         flat("disk", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
              diffuse("0, 0, 0") + area_light("4, 4, 4"));
}
double floor_luminance(int x, int y) {
  constexpr double a = 0.5, h = 1, radiance = 4, rho = 0.7, pixel = 0.8 / side;
  constexpr int n = 4;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double d_sq = std::pow(pixel * (x + (i + 0.5) / n - side / 2.0), 2) +
                          std::pow(pixel * (y + (j + 0.5) / n - side / 2.0), 2);
      const double s = d_sq + h * h + a * a;
      sum += std::numbers::pi * radiance / 2 *
             (1 - (d_sq + h * h - a * a) / std::sqrt(s * s - 4 * a * a * d_sq));
    }
  return rho / std::numbers::pi * sum / (n * n);
}

/// `auto`, but that every vertex samples one light, so that much noise is left.
std::unique_ptr<Integrator> with_one_light(const TestScene& scene,
                                           const std::string& settings = "") {
  return scene.integrator(
      "ppm", set("choose_light_paths", true) + set("choose_light_samples", false) + settings);
}

/// Passes of four samples.
Film rendered(const TestScene& scene, const Integrator& integrator, uint64_t seed, PassRange range,
              int threads = 0) {
  SessionSettings settings;
  settings.seed = seed;
  settings.first_pass = range.begin;
  settings.passes = range.end - range.begin;
  settings.samples_per_pass = 4;
  settings.threads = threads;
  Session session(scene.scene(), integrator, settings);
  session.run();
  return session.film();
}

constexpr uint64_t seeds = slow_build ? 12 : 64;
constexpr uint32_t passes_of_picture = slow_build ? 4 : 16;

/// 95 % intervals of all pixels of a picture.
struct Intervals {
  std::vector<ConfidenceInterval> of_pixel;
  double freedom;
};
std::vector<Intervals> intervals_of_floor(bool adaptive) {
  const TestScene scene(half_a_floor());
  const auto integrator = with_one_light(scene, set("adaptive", adaptive));
  EXPECT_EQ(are_alike(counts_of(scene, *integrator, 3)), !adaptive);
  std::vector<Intervals> pictures;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const Film film = rendered(scene, *integrator, seed, {0, passes_of_picture});
    const FilmErrors errors(film);
    pictures.push_back({{}, errors.freedom()});
    for (size_t i = 0; i < size_t(side) * side; ++i)
      pictures.back().of_pixel.push_back(errors.luminance(i));
  }
  return pictures;
}
/// For a right truth and for a wrong one.
const std::vector<Intervals>& adaptive_intervals() {
  static const std::vector<Intervals> pictures = intervals_of_floor(true);
  return pictures;
}

/// Of pictures of all seeds, pixel by pixel.
struct Measured {
  double chi_square = 0, expected = 0, deviation = 0;  ///< of the squares of Student's t
  double squared_errors = 0, estimated = 0;            ///< of single pictures, sums
  int held = 0, all = 0;                               ///< intervals of single pictures
  double z() const { return (chi_square - expected) / deviation; }
  double coverage() const { return double(held) / all; }
};
/// `planted`: factor of the truth.
Measured measure(const std::vector<Intervals>& pictures, double planted = 1) {
  Measured result;
  // The square of Student's t is that of F(1, ν).
  constexpr double nu = double(seeds) - 1;
  for (size_t i = 0; i < size_t(side) * side; ++i) {
    if (int(i) % side <= side / 2) continue;
    const double truth = planted * floor_luminance(int(i) % side, int(i) / side);
    RunningStatistics pixel;
    for (const Intervals& picture : pictures) {
      const ConfidenceInterval& interval = picture.of_pixel[i];
      pixel.add(interval.mean);
      result.held += std::fabs(interval.mean - truth) <= interval.half_width ? 1 : 0;
      ++result.all;
      result.squared_errors += std::pow(interval.mean - truth, 2);
      result.estimated +=
          std::pow(interval.half_width / student_t_quantile(0.975, picture.freedom), 2);
    }
    result.chi_square += std::pow((pixel.mean() - truth) / pixel.standard_error(), 2);
    result.expected += nu / (nu - 2);
    result.deviation += 2 * nu * nu * (nu - 1) / (std::pow(nu - 2, 2) * (nu - 4));
  }
  result.deviation = std::sqrt(result.deviation);
  std::printf(
      "  chi square of pixels %.0f ± %.0f, expected %.0f; %.2f %% of intervals hold; "
      "estimated over true variance %.3f\n",
      result.chi_square, result.deviation, result.expected, 100 * result.coverage(),
      result.estimated / result.squared_errors);
  return result;
}

/// The noise is half that of which lamp is chosen, not normal, and fewer than 95 % of the intervals
/// hold, with samples all alike too; but variances are right on average.
TEST(AdaptiveSamples, HaveNoBiasAndKnowTheirErrorLong) {
  const Measured right = measure(adaptive_intervals());
  EXPECT_LT(std::fabs(right.z()), 3.5);
  if (slow_build) return;
  EXPECT_GT(right.all, 20000);
  EXPECT_NEAR(right.estimated / right.squared_errors, 1, 0.05);
  EXPECT_GT(right.coverage(), measure(intervals_of_floor(false)).coverage() - 0.01);
}

/// The twin: a truth that is off by 1 %.
TEST(AdaptiveSamples, AWrongTruthIsFoundOutLong) {
  if (!slow_build) {
    EXPECT_GT(measure(adaptive_intervals(), 1.01).z(), 5);
  }
}

/// With a wall, which the floor lights.
std::string floor_and_wall() {
  return half_a_floor() + flat("rectangle",
                               scale("1, 2, 1") + rotate("0, 1, 0", -90) + translate("0.6, 0, 1"),
                               diffuse("0.7, 0.7, 0.7"));
}

/// All techniques' weights go by the mean count: those of a path sum to 1 where a pixel gets more.
/// (Disks so small that what merges has no bias to speak of.)
TEST(AdaptiveSamples, WeightsSumToOneLong) {
  const TestScene scene(floor_and_wall());
  const auto vcm = scene.integrator(
      "vcm", set("radius", 0.01) + set("light_paths", 1.0) + set("choose_light_samples", false));
  const std::vector<uint32_t> counts = counts_of(scene, *vcm, 8);
  const auto many = [&](int x, int y) { return counts[size_t(y * 64 + x)] > 4 ? 1.0 : 0.0; };
  ASSERT_FALSE(are_alike(counts));
  std::vector<Image> pictures;
  for (uint64_t seed = 1; seed <= measured_passes; ++seed)
    pictures.push_back(rendered(scene, *vcm, seed, {0, slow_build ? 4u : 12u}).image());
  const Passes found(std::move(pictures));
  const Passes path = render(scene, "path", "", {200, 7});
  expect_near_means("many samples", found.mean({""}, many), path.mean({""}, many), 0.005);
}

Film film_of(const TestScene& scene, PassRange range, int threads) {
  return rendered(scene, *with_one_light(scene), 3, range, threads);
}

/// Passes are the same whoever renders them, whether or not he has rendered those before.
TEST(AdaptiveSamples, SameBits) {
  const TestScene scene(floor_and_wall());
  const std::vector<uint32_t> counts = counts_of(scene, *with_one_light(scene), 5);
  EXPECT_FALSE(are_alike(counts));
  EXPECT_LE(mean(counts), 4);
  EXPECT_TRUE(are_alike(counts_of(scene, *with_one_light(scene), 1)));
  EXPECT_TRUE(are_alike(counts_of(scene, *with_one_light(scene, set("adaptive", false)), 5)));

  const Image whole = film_of(scene, {0, 6}, 1).image();
  Film parts = film_of(scene, {5, 6}, 2);
  parts.add(film_of(scene, {0, 3}, 0));
  parts.add(film_of(scene, {3, 5}, 2));
  const Image merged = parts.image();
  for (int c = 0; c < whole.channel_count(); ++c)
    EXPECT_EQ(std::memcmp(whole.channel(c).data(), merged.channel(c).data(),
                          whole.channel(c).size_bytes()),
              0)
        << c;
}

/// Also those of a later round of the replicates, with splats and connections.
TEST(AdaptiveSamples, SameBitsOfLaterPasses) {
  const TestScene scene(floor_and_wall());
  const uint32_t begin = replicate_count, end = begin + 2;
  const auto film = [&](PassRange range, int threads) {
    return rendered(scene, *scene.integrator("vcm"), 3, range, threads);
  };
  const Image whole = film({0, end}, 2).image();
  Film parts = film({begin, end}, 1);
  parts.add(film({0, begin}, 2));
  const Image merged = parts.image();
  for (int c = 0; c < whole.channel_count(); ++c)
    EXPECT_EQ(std::memcmp(whole.channel(c).data(), merged.channel(c).data(),
                          whole.channel(c).size_bytes()),
              0)
        << whole.channel_names()[size_t(c)];
}

/// No sample comes twice in a replicate.
TEST(AdaptiveSamples, IndicesAreNew) {
  const TestScene scene(floor_and_wall());
  const auto integrator = with_one_light(scene);
  for (const uint32_t replicate : {0u, 5u}) {
    std::vector<uint32_t> next(size_t(side) * side, 0);
    bool differ = false;
    for (uint32_t pass = replicate; pass < (slow_build ? 48 : 96); pass += replicate_count) {
      const std::vector<PixelSamples> samples = samples_of(scene, *integrator, pass);
      for (size_t i = 0; i < samples.size(); ++i) {
        EXPECT_GE(samples[i].first_index, next[i]) << pass;
        differ = differ || samples[i].count != samples[0].count;
        next[i] = samples[i].first_index + samples[i].count;
      }
    }
    EXPECT_TRUE(differ);
  }
}

}  // namespace
}  // namespace kaustik
