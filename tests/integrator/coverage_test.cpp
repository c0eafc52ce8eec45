// How often the intervals that the film gives hold the truth.

#include <map>

#include "kaustik/render/film_errors.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr int side = 8;
constexpr uint64_t least_seeds = 64;
constexpr uint64_t seeds = slow_build ? 8 : 96;

/// A picture that is known pixel by pixel.
struct KnownScene {
  std::string text;
  std::function<double(int x, int y)> luminance;
};

/// Intervals that hold the truth, and how they compare with the errors that were made.
struct Coverage {
  int held = 0, all = 0;
  int held_over_passes = 0;  ///< if passes were taken for independent
  double squared_errors = 0, by_replicates = 0, over_passes = 0;  ///< sums of variances
  double share() const { return double(held) / all; }
};

void add(const Film& film, const KnownScene& known, Coverage& coverage) {
  const FilmErrors errors(film);
  const double n = film.pass_count();
  const double t_replicates = student_t_quantile(0.975, errors.freedom());
  const double t_passes = student_t_quantile(0.975, n - 1);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto pixel = size_t(y * side + x);
      const ConfidenceInterval interval = errors.luminance(pixel);
      const double mean_square = film.luminance_squares(pixel) / n;
      const double over_passes =
          std::max(0.0, mean_square - interval.mean * interval.mean) / (n - 1);
      if (over_passes <= 1e-12 * mean_square) continue;  // known without noise
      const double error = std::fabs(interval.mean - known.luminance(x, y));
      ++coverage.all;
      coverage.held += error <= interval.half_width ? 1 : 0;
      coverage.held_over_passes += error <= t_passes * std::sqrt(over_passes) ? 1 : 0;
      coverage.squared_errors += error * error;
      coverage.over_passes += over_passes;
      coverage.by_replicates += std::pow(interval.half_width / t_replicates, 2);
    }
}

void print(const char* type, uint32_t passes, const Coverage& coverage) {
  std::printf(
      "  %s, %2u passes: of %d intervals %.2f %% hold the truth (%.2f %% if passes were "
      "independent); estimated over true variance %.3f (%.3f)\n",
      type, passes, coverage.all, 100 * coverage.share(),
      100.0 * coverage.held_over_passes / coverage.all,
      coverage.by_replicates / coverage.squared_errors,
      coverage.over_passes / coverage.squared_errors);
}

/// After each of these numbers of passes, the last one the largest.
std::map<uint32_t, Coverage> coverage_of(const KnownScene& known, const char* type,
                                         const std::vector<uint32_t>& passes,
                                         uint64_t seed_count = seeds,
                                         const std::string& parameters = "") {
  const TestScene scene(camera("0, 0, 0.4", "0, 0, 0", 90, side, "0, 1, 0") + known.text);
  const auto integrator = scene.integrator(type, parameters);
  std::map<uint32_t, Coverage> result;
  for (uint64_t seed = 1; seed <= seed_count; ++seed) {
    SessionSettings settings;
    settings.seed = seed;
    settings.passes = passes.back();
    settings.samples_per_pass = 4;
    Session session(scene.scene(), *integrator, settings);
    session.run({}, {}, [&] {
      const uint32_t done = session.film().pass_count();
      if (std::find(passes.begin(), passes.end(), done) != passes.end())
        add(session.film(), known, result[done]);
    });
  }
  for (const auto& [done, coverage] : result) print(type, done, coverage);
  return result;
}
Coverage coverage_of(const KnownScene& known, uint32_t passes) {
  return coverage_of(known, "path", {passes}).at(passes);
}

/// A disk that shines on a floor, as in analytic_test.cpp: the noise of light sampling.
KnownScene disk_over_plane() {
  constexpr double a = 0.5, h = 1, radiance = 4, rho = 0.7, pixel = 0.8 / side;
  const auto irradiance = [](double d_sq) {
    const double s = d_sq + h * h + a * a;
    return std::numbers::pi * radiance / 2 *
           (1 - (d_sq + h * h - a * a) / std::sqrt(s * s - 4 * a * a * d_sq));
  };
  return {flat("rectangle", scale("2, 2, 1"), diffuse("0.7, 0.7, 0.7")) +
              flat("disk", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 1"),
                   diffuse("0, 0, 0") + area_light("4, 4, 4")),
          [irradiance](int x, int y) {
            constexpr int n = 20;
            double sum = 0;
            for (int i = 0; i < n; ++i)
              for (int j = 0; j < n; ++j)
                sum += irradiance(std::pow(pixel * (x + (i + 0.5) / n - side / 2.0), 2) +
                                  std::pow(pixel * (y + (j + 0.5) / n - side / 2.0), 2));
            return rho / std::numbers::pi * sum / (n * n);
          }};
}

/// A closed sphere that shines everywhere, L = 1/(1 − ρ): all the noise is that of Russian
/// roulette.
KnownScene furnace() {
  return {sphere("0.1, 0.2, 0.1", 1, diffuse("0.6, 0.6, 0.6") + area_light("1, 1, 1"), true),
          [](int, int) { return 1 / (1 - 0.6); }};
}

/// A lamp of intensity I in the middle of a diffuse sphere: E = I/(R² (1 − ρ)). All of it but what
/// comes straight from the lamp is merged.
KnownScene diffuse_sphere() {
  return {sphere("0, 0, 0", 1, diffuse("0.6, 0.6, 0.6"), true) + point_light("0, 0, 0", 1),
          [](int, int) { return 0.6 / std::numbers::pi / (1 - 0.6); }};
}

void expect_covered(const Coverage& coverage, double most = 0.97) {
  if (slow_build) return;
  EXPECT_GE(coverage.all, int(least_seeds) * side * side);
  EXPECT_GT(coverage.share(), 0.93);
  EXPECT_LT(coverage.share(), most);
}

TEST(Coverage, OnePassPerReplicate) { expect_covered(coverage_of(disk_over_plane(), 16)); }

TEST(Coverage, SomeReplicatesHaveTwoPasses) { expect_covered(coverage_of(disk_over_plane(), 24)); }

/// The two passes of a replicate stratify one another: taken for independent, they would make the
/// error look larger than it is.
TEST(Coverage, TwoPassesPerReplicate) {
  const Coverage coverage = coverage_of(disk_over_plane(), 32);
  expect_covered(coverage);
  if (slow_build) return;
  EXPECT_GT(double(coverage.held_over_passes) / coverage.all, 0.97);
}

/// Intervals are by Student's t, which takes means for normal. Where the noise is that of rare
/// events few samples often see none of these: what neighbours have seen makes up for it.
TEST(Coverage, RareEvents) {
  const Coverage coverage = coverage_of(furnace(), 16);
  expect_covered(coverage);
  if (slow_build) return;
  EXPECT_NEAR(coverage.by_replicates / coverage.squared_errors, 1, 0.1);
}

/// Intervals of what is merged, widened by what its bias is told to be. That is known so badly that
/// intervals are a little too wide.
TEST(Coverage, MergedLight) {
  const auto coverages =
      coverage_of(diffuse_sphere(), "ppm", {16, 32}, slow_build ? seeds : least_seeds,
                  set("indirect_cache", "never"));
  for (const auto& [passes, coverage] : coverages) expect_covered(coverage, 0.975);
}

/// Few records serve all pixels, so these err together; what still merges between them has a bias
/// that is told too wide.
TEST(Coverage, CachedLight) {
  const auto coverages =
      coverage_of(diffuse_sphere(), "ppm", {16, 32}, slow_build ? seeds : least_seeds,
                  set("indirect_cache", "always"));
  for (const auto& [passes, coverage] : coverages) expect_covered(coverage, 0.99);
}

/// The twin: a truth that is off by 1 % is found out.
TEST(Coverage, AWrongTruthIsHeldMoreRarely) {
  const KnownScene right = disk_over_plane();
  const KnownScene wrong{right.text, [&](int x, int y) { return 1.01 * right.luminance(x, y); }};
  EXPECT_LT(coverage_of(wrong, 16).share(), 0.93);
}

}  // namespace
}  // namespace kaustik
