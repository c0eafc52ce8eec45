// The weights of all ways of finding one path sum to 1.

#include "kaustik/transport/path_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace kaustik {
namespace {

/// A whole path x₁ … xₙ with what every technique would find out about it.
struct WholePath {
  std::vector<PathVertex> vertices;  ///< x₁ … xₙ
  float pdf_next_event = 0, first_merge_area = 0, first_survival = 1, first_light_samples = 1;
};

/// Densities over some magnitudes; the light's point has no event.
WholePath random_path(std::mt19937& random, size_t length, double delta_share,
                      double medium_share = 0) {
  std::uniform_real_distribution<float> exponent(-2, 2), unit(0, 1);
  const auto density = [&] { return std::pow(10.0f, exponent(random)); };
  WholePath path;
  path.vertices.resize(length);
  for (PathVertex& vertex : path.vertices) {
    vertex.pdf_camera = density();
    vertex.pdf_light = density();
    vertex.delta = double(unit(random)) < delta_share;
    if (double(unit(random)) < medium_share) {
      vertex.delta = false;
      vertex.mean_free_path = density();
      vertex.merge_volume = 1e-4f * density() * vertex.mean_free_path;
    }
  }
  path.vertices.back().delta = false;
  path.vertices.back().mean_free_path = 0;
  path.pdf_next_event = density();
  path.first_merge_area = 1e-4f * density();
  path.first_survival = 0.05f + 0.95f * unit(random);
  path.first_light_samples = float(1 + length % 4);
  return path;
}

/// The halves with t vertices on the camera's side, as each side finds them: a vertex knows only
/// what the path up to it can know.
struct Halves {
  Halves(const WholePath& path, size_t t, const PathWeights& weights) {
    const std::vector<PathVertex>& all = path.vertices;
    const size_t n = all.size();
    for (size_t i = 1; i <= t; ++i) {
      camera.push_back(all[i - 1]);
      const bool after_delta = i >= 2 && all[i - 2].delta;
      camera.back().spread = i == 1
                                 ? 1
                                 : weights.spread_after(camera[i - 2].spread, all[i - 1].pdf_camera,
                                                        all[i - 1], after_delta);
      if (i + 1 >= t) camera.back().pdf_light = -1;  // not known yet
    }
    for (size_t i = n; i > t; --i) {
      light.push_back(all[i - 1]);
      if (i <= t + 2) light.back().pdf_camera = -1;
    }
    halves.camera = camera;
    halves.light = light;
    if (t >= 1) halves.pdf_light_last = all[t - 1].pdf_light;
    if (t >= 2) halves.pdf_light_before_last = all[t - 2].pdf_light;
    if (t < n) halves.pdf_camera_last = all[t].pdf_camera;
    if (t + 1 < n) halves.pdf_camera_before_last = all[t + 1].pdf_camera;
    halves.pdf_next_event = path.pdf_next_event;
    halves.first_merge_area = path.first_merge_area;
    halves.first_survival = path.first_survival;
    halves.first_light_samples = path.first_light_samples;
  }
  std::vector<PathVertex> camera, light;
  PathHalves halves;
};

/// Sum over the techniques that can find the path.
double sum_of_weights(const WholePath& path, const PathWeights& weights, int& techniques) {
  const Techniques& on = weights.settings().techniques;
  const size_t n = path.vertices.size();
  const auto is_delta = [&](size_t i) { return path.vertices[i - 1].delta; };
  double sum = 0;
  techniques = 0;
  const auto add = [&](float weight) {
    sum += double(weight);
    if (weight > 0) ++techniques;
  };
  if (on.unidirectional) add(weights.unidirectional(Halves(path, n, weights).halves));
  if (on.next_event && n >= 2 && !is_delta(n - 1))
    add(weights.next_event(Halves(path, n - 1, weights).halves));
  if (on.splats && n >= 3 && !is_delta(1)) add(weights.splat(Halves(path, 0, weights).halves));
  for (size_t t = 1; t + 1 <= n; ++t) {
    const Halves halves(path, t, weights);
    const bool in_medium = path.vertices[t - 1].mean_free_path > 0;
    if (on.connections && t + 2 <= n && !is_delta(t) && !is_delta(t + 1))
      add(weights.connection(halves.halves));
    if (on.merging && (t + 2 <= n || in_medium) && !is_delta(t)) add(weights.merge(halves.halves));
  }
  return sum;
}

PathWeights::Settings settings_of(unsigned mask, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  PathWeights::Settings settings;
  settings.techniques = {(mask & 1) != 0, (mask & 2) != 0, (mask & 4) != 0, (mask & 8) != 0,
                         (mask & 16) != 0};
  settings.light_paths = 1 + 1e5f * unit(random);
  settings.connections = 0.1f + unit(random);
  settings.merge_area = 1e-3f * unit(random);
  settings.accepted_area = 0.1f * unit(random);
  settings.first_medium_share = unit(random);
  settings.least_spread = unit(random) < 0.5f ? 0.0f : 0.1f;
  return settings;
}

TEST(PathWeights, SumToOne) {
  std::mt19937 random(1);
  int paths = 0, found_in_several_ways = 0;
  for (int i = 0; i < 20'000; ++i) {
    const unsigned mask = 1 + random() % 31;
    const PathWeights weights(settings_of(mask, random));
    const WholePath path =
        random_path(random, 1 + random() % 7, i % 3 == 0 ? 0.0 : 0.3, i % 2 == 0 ? 0.0 : 0.5);
    int techniques = 0;
    const double sum = sum_of_weights(path, weights, techniques);
    if (techniques == 0) continue;
    ++paths;
    if (techniques > 1) ++found_in_several_ways;
    ASSERT_NEAR(sum, 1, 1e-4) << "mask " << mask << ", " << path.vertices.size() << " vertices";
  }
  EXPECT_GT(paths, 15'000);
  EXPECT_GT(found_in_several_ways, 10'000);
}

/// What merges weighs the same by what is known of the light path beforehand.
TEST(PathWeights, LightTailsTellTheRest) {
  std::mt19937 random(7);
  int compared = 0, with_later_merges = 0;
  for (int i = 0; i < 20'000; ++i) {
    const PathWeights weights(settings_of(16 | (random() % 16), random));
    const WholePath path =
        random_path(random, 3 + random() % 6, i % 3 == 0 ? 0.0 : 0.3, i % 2 == 0 ? 0.0 : 0.3);
    const size_t n = path.vertices.size(), t = 1 + random() % (n - 2);
    if (path.vertices[t - 1].delta || path.vertices[t - 1].mean_free_path > 0) continue;
    Halves halves(path, t, weights);
    const float expected = weights.merge(halves.halves);
    const float to_previous = 0.1f + float(i % 7);
    PathHalves known;
    const PathVertex any_vertex{};
    known.camera = {&any_vertex, 1};
    known.light = halves.light;
    known.pdf_light_last = halves.halves.pdf_light_last;
    known.pdf_camera_last = to_previous;
    known.pdf_camera_before_last = halves.halves.pdf_camera_before_last;
    known.pdf_next_event = path.pdf_next_event;
    std::vector<PathWeights::LaterMerge> merges(3);  // of others
    const PathWeights::LightTail tail = weights.light_tail(known, merges);
    ASSERT_EQ(tail.merges, 3u);
    ASSERT_EQ(tail.merges + tail.count, merges.size());
    halves.halves.pdf_camera_before_last = halves.halves.pdf_next_event = -1;
    const float found =
        weights.merge(halves.halves, tail, std::span(merges).subspan(tail.merges, tail.count));
    ASSERT_NEAR(found, expected, 1e-4f * expected) << n << " vertices, " << t;
    ++compared;
    if (tail.count > 0 && expected > 0) ++with_later_merges;
  }
  EXPECT_GT(compared, 8'000);
  EXPECT_GT(with_later_merges, 3'000);
}

/// A technique that takes another radius for granted than the others weighs otherwise.
TEST(PathWeights, NoticeAnotherRadius) {
  std::mt19937 random(2);
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    PathWeights::Settings settings = settings_of(31, random);
    const PathWeights weights(settings);
    const WholePath path = random_path(random, 4, 0);
    Halves halves(path, 1, weights);
    const double right = double(weights.merge(halves.halves));
    halves.halves.first_merge_area *= 1.5f;
    largest = std::max(largest, std::fabs(double(weights.merge(halves.halves)) - right));
  }
  EXPECT_GT(largest, 0.05);
}

/// Several samples of lights at the first vertex find what one finds, so many times as often.
TEST(PathWeights, SamplesOfLightsAtTheFirstVertexCountByTheirNumber) {
  PathWeights::Settings settings;
  const PathWeights weights(settings);
  WholePath path;
  path.vertices.resize(2);
  path.vertices[1].pdf_camera = 3;
  path.vertices[1].pdf_light = 0.5f;
  path.pdf_next_event = 2;
  path.first_light_samples = 4;
  const auto expect_samples = [&](double samples) {
    const double ratio = 3 / (samples * 2);
    EXPECT_NEAR(weights.next_event(Halves(path, path.vertices.size() - 1, weights).halves),
                1 / (1 + ratio * ratio), 1e-5);
  };
  expect_samples(4);
  // After a mirror it is the second vertex …
  path.vertices.insert(path.vertices.begin(), path.vertices[0]);
  path.vertices[0] = {.pdf_camera = 1, .pdf_light = 1, .delta = true};
  path.vertices[1] = {.pdf_camera = 1, .pdf_light = 1};
  expect_samples(4);
  // … but after another event no longer the first, and in a medium there is one.
  path.vertices[0].delta = false;
  expect_samples(1);
  path.vertices[0].delta = true;
  path.vertices[1].mean_free_path = 1;
  expect_samples(1);
}

/// Whether a path goes on is asked behind what it comes to from its first vertex that is not delta:
/// a lamp there is met in any case.
TEST(PathWeights, LampsAreMetRightBehindTheFirstVertex) {
  std::mt19937 random(4);
  double largest_behind = 0, largest_beyond = 0;
  for (int i = 0; i < 200; ++i) {
    const PathWeights weights(settings_of(31, random));
    WholePath path = random_path(random, 4, 0);
    const auto change = [&] {
      path.first_survival = 1;
      const float whole = weights.unidirectional(Halves(path, 4, weights).halves);
      path.first_survival = 0.02f;
      return std::fabs(double(weights.unidirectional(Halves(path, 4, weights).halves) - whole));
    };
    largest_beyond = std::max(largest_beyond, change());
    path.vertices[0].delta = path.vertices[1].delta = true;
    largest_behind = std::max(largest_behind, change());
  }
  EXPECT_LT(largest_behind, 1e-5);
  EXPECT_GT(largest_beyond, 0.1);
}

/// The same path and settings in a scene `scale` times as large.
void rescale(float scale, WholePath& path, PathWeights::Settings& settings) {
  const float area = scale * scale;
  for (PathVertex& vertex : path.vertices) {
    vertex.pdf_camera /= area;
    vertex.pdf_light /= area;
  }
  path.pdf_next_event /= area;
  path.first_merge_area *= area;
  settings.merge_area *= area;
  settings.accepted_area *= area;
}

/// What is stored with a light path's vertex and what the camera's vertex tells make up the weight
/// of merging at a first vertex, in scenes of any size.
TEST(PathWeights, OfMattSurfaces) {
  std::mt19937 random(3);
  int compared = 0;
  for (int i = 0; i < 5000; ++i) {
    PathWeights::Settings settings = settings_of(16 + random() % 16, random);
    WholePath path = random_path(random, 3 + random() % 5, 0.3);
    rescale(std::pow(10.0f, float(random() % 15) - 7), path, settings);
    const PathWeights weights(settings);
    const size_t n = path.vertices.size(), t = 1 + random() % (n - 2);
    // The camera's path comes to x_t by delta events alone.
    for (size_t k = 1; k <= t; ++k) path.vertices[k - 1].delta = k < t;
    const Halves halves(path, t, weights);
    const float expected = weights.merge(halves.halves);
    if (!(expected > 1e-6f)) continue;
    ++compared;
    static constexpr PathVertex any{};
    PathHalves stored = halves.halves;
    stored.camera = {&any, 1};
    stored.first_merge_area = -1;
    stored.first_survival = 1;
    const PathWeights::MattMerge merge = weights.matt_merge(stored);
    const PathWeights::MattVertex vertex =
        weights.matt_vertex(halves.camera, path.first_merge_area, path.first_survival);
    const float weight = 1 / (vertex.base + merge.connection * vertex.on_connection +
                              merge.beyond * vertex.on_beyond);
    ASSERT_NEAR(weight / expected, 1, 1e-4) << n << " vertices, merged at " << t;
  }
  EXPECT_GT(compared, 3000);
}

/// With light sampled and met alone it is the power heuristic of path tracing.
TEST(PathWeights, OfPathTracing) {
  const PathWeights weights(PathWeights::Settings{{true, true, false, false, false}});
  WholePath path;
  path.vertices.resize(2);
  path.vertices[0].pdf_camera = 3;
  path.vertices[1].pdf_camera = 2;
  path.vertices[1].pdf_light = 0.7f;
  path.pdf_next_event = 5;
  EXPECT_NEAR(weights.unidirectional(Halves(path, 2, weights).halves), 4.0 / 29, 1e-6);
  EXPECT_NEAR(weights.next_event(Halves(path, 1, weights).halves), 25.0 / 29, 1e-6);
}

}  // namespace
}  // namespace kaustik
