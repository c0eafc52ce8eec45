// Emission that was learned: its density, its samples, and what it brings.

#include "kaustik/photon/emission_learning.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kaustik/base/statistics.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

constexpr int samples = 200'000;

/// Two heaps of points, one of them tiny.
std::vector<GuideSquare::Point> heaps(int count) {
  Random random(11);
  std::vector<GuideSquare::Point> points;
  for (int i = 0; i < count; ++i) {
    const Vec2f u = random.pair();
    points.push_back(i % 2 == 0 ? GuideSquare::Point{Vec2f(0.3f, 0.8f) + u * 0.01f, 3}
                                : GuideSquare::Point{{0.6f + 0.3f * u.x, 0.1f + 0.4f * u.y}, 1});
  }
  return points;
}

/// `factor`: planted into the density.
double chi_square_of(const GuideSquare& square, float factor) {
  constexpr int side = 16;
  std::vector<double> found(side * side), expected(side * side);
  Random random(5);
  for (int i = 0; i < samples; ++i) {
    const Vec2f u = square.sample(random.pair());
    ++found[size_t(int(u.y * side) * side + int(u.x * side))];
  }
  constexpr int part = 256, fine = part * side;  // as fine as the leaves
  for (int y = 0; y < fine; ++y)
    for (int x = 0; x < fine; ++x)
      expected[size_t(y / part * side + x / part)] +=
          double(square.pdf({(float(x) + 0.5f) / fine, (float(y) + 0.5f) / fine})) * samples /
          (double(fine) * fine);
  // Cells are moved from one half of the square to the other.
  for (size_t i = 0; i < expected.size(); ++i)
    expected[i] *= i % side < side / 2 ? double(factor) : 2 - double(factor);
  return chi_square_p_value(found, expected);
}

TEST(GuideSquare, SamplesFollowTheDensity) {
  for (const int count : {1, 1000, 50'000}) {
    const GuideSquare square(heaps(count));
    EXPECT_GT(chi_square_of(square, 1), 1e-3)
        << count << " points, " << square.leaves() << " leaves";
  }
  EXPECT_LT(chi_square_of(GuideSquare(heaps(1000)), 1.06f), 1e-6);
}

TEST(GuideSquare, DensityIntegratesToOne) {
  const GuideSquare square(heaps(5000));
  constexpr int side = 4096;
  double sum = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      sum += double(square.pdf({(float(x) + 0.5f) / side, (float(y) + 0.5f) / side}));
  EXPECT_NEAR(sum / (double(side) * side), 1, 1e-5);
  EXPECT_EQ(square.pdf({-0.01f, 0.5f}), 0);
  EXPECT_EQ(square.pdf({0.5f, 1.0f}), 0);
}

/// The leaves bring the sum of weight / pdf down, nearly to what they promise.
TEST(GuideSquare, LessensTheSum) {
  const std::vector<GuideSquare::Point> points = heaps(20'000);
  const GuideSquare square(points);
  double uniform = 0, learned = 0;
  for (const GuideSquare::Point& p : heaps(40'000)) {
    uniform += p.weight;
    learned += p.weight / double(square.pdf(p.u));
  }
  EXPECT_LT(learned, 0.05 * uniform);
  EXPECT_NEAR(learned / 2, square.expected_sum(), 0.1 * square.expected_sum());
}

/// A light of every kind over a small target, and what rays that meet it have taught.
struct Lesson {
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<LightPathEmission> plain;
  std::unique_ptr<EmissionLearning> learning;
  std::shared_ptr<const LightPathEmission> learned;
};

bool meets_target(const Scene& scene, const LightPathStart& start) {
  Hit hit;
  return start.light >= 0 && scene.intersect(start.emitted.ray, hit) &&
         length_sq(start.emitted.ray.origin + start.emitted.ray.direction * hit.t -
                   Vec3f(0.3f, 0.1f, 0)) < sqr(0.31f);
}

Lesson lesson_of(const std::vector<ObjectPointer>& lights) {
  Lesson result;
  std::vector<ObjectPointer> objects = lights;
  objects.push_back(sphere(Vec3d(0.3, 0.1, 0), 0.3, black()));
  objects.push_back(
      placed("rectangle",
             Transform::translate(Vec3d(0, 0, -0.5)) * Transform::scale(Vec3d(4, 4, 1)), black()));
  result.scene = make_scene(objects);
  result.plain = std::make_unique<LightPathEmission>(*result.scene);
  result.learning = std::make_unique<EmissionLearning>(*result.plain);
  for (uint32_t i = 0; i < uint32_t(samples); ++i) {
    Sampler sampler(21, i);
    const LightPathStart start = result.plain->sample(sampler);
    if (meets_target(*result.scene, start))
      result.learning->add(start, double(start.emitted.flux.sum()));
  }
  result.learned = result.learning->learned();
  return result;
}

/// Lights with a place or a single direction.
std::vector<std::string> learned_kinds() {
  return {"point", "spot",        "rectangle",       "ball",
          "mesh",  "directional", "distributedspot", "two-sided ball"};
}

/// The density of a sample is what pdf() says, and the flux that meets the target is that of plain
/// emission; of the rays, five times as many meet it.
TEST(LearnedEmission, IsUnbiased) {
  for (const std::string& kind : learned_kinds()) {
    const Lesson lesson = lesson_of({light(kind)});
    ASSERT_TRUE(lesson.learned) << kind;
    RunningStatistics plain, learned;
    double plain_met = 0, learned_met = 0;
    for (uint32_t i = 0; i < uint32_t(samples); ++i) {
      Sampler a(31 + uint64_t(i), 0), b(0x10000000 + uint64_t(i), 0);
      const LightPathStart by_plain = lesson.plain->sample(a),
                           by_learned = lesson.learned->sample(b);
      const bool met = meets_target(*lesson.scene, by_learned);
      const bool plainly_met = meets_target(*lesson.scene, by_plain);
      plain.add(plainly_met ? double(by_plain.emitted.flux.sum()) : 0);
      learned.add(met ? double(by_learned.emitted.flux.sum()) : 0);
      plain_met += plainly_met ? 1 : 0;
      learned_met += met ? 1 : 0;
      if (!met) continue;
      const EmissionDensity again =
          lesson.learned->pdf(0, by_learned.emitted.origin, by_learned.emitted.ray.direction);
      EXPECT_EQ(again.rest, by_learned.density.rest) << kind;
    }
    const double error = std::hypot(plain.standard_error(), learned.standard_error());
    EXPECT_GT(z_test_p_value(learned.mean() - plain.mean(), error, 0), 1e-3) << kind;
    // And a wrong one is found out.
    EXPECT_LT(z_test_p_value(1.2 * learned.mean() - plain.mean(), error, 0), 1e-2) << kind;
    EXPECT_GT(learned_met, 5 * plain_met) << kind;
    EXPECT_LT(learned.variance(), 0.3 * plain.variance()) << kind;
  }
}

/// All that can be emitted without has at least a fifth of that density.
TEST(LearnedEmission, LeavesOutNothing) {
  for (const std::string& kind : learned_kinds()) {
    const Lesson lesson = lesson_of({light(kind), light("point")});
    ASSERT_TRUE(lesson.learned) << kind;
    for (uint32_t i = 0; i < 10'000; ++i) {
      Sampler sampler(41, i);
      const LightPathStart start = lesson.plain->sample(sampler);
      if (start.light < 0) continue;
      const EmissionDensity learned =
          lesson.learned->pdf(start.light, start.emitted.origin, start.emitted.ray.direction);
      EXPECT_GE(learned.rest, 0.199f * start.density.rest) << kind;
      EXPECT_EQ(learned.endpoint, start.density.endpoint) << kind;
    }
  }
}

/// Of twenty lamps that differ in nothing, the one that reaches the target is found.
TEST(LearnedEmission, ChoosesTheLamp) {
  std::vector<ObjectPointer> lamps;
  for (int i = 0; i < 20; ++i)
    lamps.push_back(object("emitter", "point", {{"position", Vec3d(0.3, 40.0 * i, 1)}}));
  const Lesson lesson = lesson_of(lamps);
  ASSERT_TRUE(lesson.learned);
  EXPECT_NEAR(lesson.plain->chance(0), 0.05, 1e-4);
  EXPECT_GT(lesson.learned->chance(0), 0.7f);
  double sum = 0;
  for (int i = 0; i < 20; ++i) sum += double(lesson.learned->chance(i));
  EXPECT_NEAR(sum, 1, 1e-5);
}

/// Where the plain emission is as good as any, nothing changes.
TEST(LearnedEmission, OnlyWhereItPays) {
  const auto scene = make_scene({light("ball")});
  const LightPathEmission plain(*scene);
  EmissionLearning learning(plain);
  EXPECT_FALSE(learning.learned());
  for (uint32_t i = 0; i < 5000; ++i) {
    Sampler sampler(51, i);
    learning.add(plain.sample(sampler), 1);
  }
  EXPECT_EQ(learning.size(), 5000u);
  EXPECT_FALSE(learning.learned());
}

}  // namespace
}  // namespace kaustik
