// Emission that was learned: its density, its samples, and what it brings.

#include "kaustik/vcm/lessons/emission_learning.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kaustik/base/statistics.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

constexpr int samples = 200'000;
#ifdef KAUSTIK_SLOW_BUILD
constexpr int unbiased_samples = 100'000;
#else
constexpr int unbiased_samples = 500'000;
#endif

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
    const LightPathStart start = result.plain->sample(sampler, {});
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

constexpr int heights = 4, turns = 16;

/// Which of as many equal parts of the light's flux a ray belongs to: by its turn about the normal,
/// or the light's axis, and where it is known how much leaves at which height, by that.
size_t part_of(const std::string& kind, const EmittedRay& ray) {
  const Vec3f local =
      ray.on_surface ? Frame(ray.origin.ng).to_local(ray.ray.direction) : ray.ray.direction;
  const double turn = std::atan2(double(local.y), double(local.x)) / (2 * std::numbers::pi) + 0.5;
  const auto z = double(local.z);
  const auto index = [](double x, int count) {
    return size_t(std::clamp(int(x * count), 0, count - 1));
  };
  if (ray.on_surface) return index(z * z, heights) * turns + index(turn, turns);
  if (kind == "point") return index((z + 1) / 2, heights) * turns + index(turn, turns);
  return index(turn, heights * turns);
}

/// What a light of radiance, intensity or irradiance 1 sends to the target, W; 0: no closed form.
double flux_to_target(const std::string& kind) {
  constexpr double r_sq = 0.3 * 0.3, pi_d = std::numbers::pi;
  const double distance_sq = 0.3 * 0.3 + 0.1 * 0.1 + 2 * 2;
  if (kind == "point" || kind == "spot") return 2 * pi_d * (1 - std::sqrt(1 - r_sq / distance_sq));
  if (kind == "directional") return pi_d * r_sq;
  constexpr int steps = 400;
  double sum = 0;
  if (kind == "rectangle") {
    // The ball is above the horizon of all its points, which send it π (r/d)² cosθ per area.
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double x = 0.8 * ((i + 0.5) / steps - 0.5) - 0.3;
        const double y = 0.6 * ((j + 0.5) / steps - 0.5) - 0.1;
        sum += pi_d * r_sq * 2 / std::pow(x * x + y * y + 4, 1.5);
      }
    return sum * 0.8 * 0.6 / (steps * steps);
  }
  if (kind != "mesh") {
    // Over all directions, where the shadows of two balls of the same radius overlap. (The target
    // lies within the beam of spots.)
    const double diameter = 0.6, largest = std::asin(diameter / std::sqrt(distance_sq));
    for (int i = 0; i < steps; ++i) {
      const double angle = largest * (i + 0.5) / steps;
      const double apart = std::sqrt(distance_sq) * std::sin(angle);
      const double lens = 2 * r_sq * std::acos(apart / diameter) -
                          apart / 2 * std::sqrt(diameter * diameter - apart * apart);
      sum += 2 * pi_d * std::sin(angle) * lens;
    }
    const double radiance = kind == "distributedspot" ? 1 / (pi_d * r_sq) : 1;
    return radiance * sum * largest / steps;
  }
  return 0;
}

/// Sums of emitted light over density, which have the mean of the flux whatever the density is.
struct Emitted {
  RunningStatistics all, to_target;
  std::vector<double> parts, part_squares;
  double met = 0;  ///< rays that meet the target
};
Emitted emitted(const LightPathEmission& emission, const std::string& kind, uint64_t seed,
                int count) {
  Emitted result;
  result.parts.resize(heights * turns);
  result.part_squares.resize(heights * turns);
  for (uint64_t i = 0; i < uint64_t(count); ++i) {
    Sampler sampler((seed + i) * 0x9e3779b97f4a7c15ull, 0);
    const LightPathStart start = emission.sample(sampler, {});
    const bool met = meets_target(emission.scene(), start);
    const double flux = start.light < 0 ? 0.0 : double(start.emitted.flux[1]);
    result.all.add(flux);
    result.to_target.add(met ? flux : 0.0);
    result.met += met ? 1 : 0;
    if (start.light < 0) continue;
    const size_t part = part_of(kind, start.emitted);
    result.parts[part] += flux;
    result.part_squares[part] += flux * flux;
  }
  return result;
}

/// That densities are `planted` times too large. Of light with a single direction, whose beam has
/// no end, only the target is known.
double p_value(const Emitted& found, const std::string& kind, double power, double planted) {
  std::vector<double> p_values;
  if (const double known = flux_to_target(kind); known > 0)
    p_values.push_back(z_test_p_value(found.to_target, known * planted));
  if (kind != "directional") {
    p_values.push_back(z_test_p_value(found.all, power * planted));
    const auto count = double(found.all.count());
    const double expected = power * planted / double(found.parts.size());
    double chi_square = 0;
    for (size_t i = 0; i < found.parts.size(); ++i) {
      const double mean = found.parts[i] / count;
      const double variance = (found.part_squares[i] / count - mean * mean) / count;
      chi_square += variance > 0 ? (mean - expected) * (mean - expected) / variance : 1e6;
    }
    p_values.push_back(chi_square_p_value(chi_square, int(found.parts.size())));
  }
  return double(p_values.size()) * *std::min_element(p_values.begin(), p_values.end());
}

/// Flux over density is that of the light: in all, in parts of equal flux, and on the target.
TEST(LearnedEmission, IsUnbiased) {
  const double level = sidak_level(0.01, int(learned_kinds().size()));
  for (const std::string& kind : learned_kinds()) {
    const Lesson lesson = lesson_of({light(kind)});
    ASSERT_TRUE(lesson.learned) << kind;
    const double power = double(lesson.scene->lights()[0]->traits().power[1]);
    const Emitted found = emitted(*lesson.learned, kind, 1, unbiased_samples);
    EXPECT_GT(p_value(found, kind, power, 1), level) << kind;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(p_value(found, kind, power, 1.02), level) << kind << ": an error of 2 % goes unseen";
#endif
  }
}

/// More rays meet the target, with less noise, and no other flux.
TEST(LearnedEmission, FindsTheTarget) {
  for (const std::string& kind : learned_kinds()) {
    const Lesson lesson = lesson_of({light(kind)});
    ASSERT_TRUE(lesson.learned) << kind;
    const Emitted plain = emitted(*lesson.plain, kind, 31, samples);
    const Emitted learned = emitted(*lesson.learned, kind, 0x10000000, samples);
    EXPECT_GT(learned.met, 5 * plain.met) << kind;
    EXPECT_LT(learned.to_target.variance(), 0.3 * plain.to_target.variance()) << kind;
    const double error =
        std::hypot(plain.to_target.standard_error(), learned.to_target.standard_error());
    EXPECT_GT(z_test_p_value(learned.to_target.mean(), error, plain.to_target.mean()), 1e-3)
        << kind;
  }
}

/// What sample() says of its density is what pdf() says, but where rounding puts a ray into the
/// next leaf.
TEST(GuidedLight, SamplesKnowTheirDensity) {
  std::vector<GuideSquare::Point> points = heaps(5000);
  Random anywhere(13);
  for (int i = 0; i < 5000; ++i) points.push_back({anywhere.pair(), 30});
  for (const std::string& kind : learned_kinds()) {
    const auto scene = make_scene({light(kind), sphere(Vec3d(0.3, 0.1, 0), 0.3, black())});
    const Light& of = *scene->lights()[0];
    const GuidedLight guided(
        std::make_shared<const GuideMap>(of, shape_of(*scene, of), scene->tracer().bounds()),
        GuideSquare(points));
    Random random(7);
    int emitting = 0, different = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec2f u_position = random.pair(), u_direction = random.pair();
      const EmittedRay ray = guided.sample(u_position, u_direction, 0.5f, {});
      if (ray.flux.is_zero()) continue;
      ++emitting;
      const double told = double(ray.pdf_position) * double(ray.pdf_direction);
      const double density = double(guided.pdf(ray.origin, ray.ray.direction));
      if (!(std::fabs(density - told) < 1e-3 * told)) ++different;
    }
    EXPECT_GT(emitting, 1000) << kind;
    EXPECT_LT(different, 0.002 * emitting) << kind;
  }
}

/// All that can be emitted without has at least a fifth of that density.
TEST(LearnedEmission, LeavesOutNothing) {
  for (const std::string& kind : learned_kinds()) {
    const Lesson lesson = lesson_of({light(kind), light("point")});
    ASSERT_TRUE(lesson.learned) << kind;
    for (uint32_t i = 0; i < 10'000; ++i) {
      Sampler sampler(41, i);
      const LightPathStart start = lesson.plain->sample(sampler, {});
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
    learning.add(plain.sample(sampler, {}), 1);
  }
  EXPECT_EQ(learning.size(), 5000u);
  EXPECT_FALSE(learning.learned());
}

/// What is learned of a point lamp over a floor with a small mirror ball, half of whose rays are
/// aimed at the ball, where rays are of use that meet the ball, or those that don't.
std::shared_ptr<const LightPathEmission> learned_beside_a_ball(const LightPathEmission& plain,
                                                               bool at_ball, uint32_t count) {
  EmissionLearning learning(plain);
  for (uint32_t i = 0; i < count; ++i) {
    Sampler sampler(22, i);
    const LightPathStart start = plain.sample(sampler, {});
    Hit hit;
    if (start.light < 0 || !plain.scene().intersect(start.emitted.ray, hit)) continue;
    const Vec3f at = start.emitted.ray.origin + start.emitted.ray.direction * hit.t;
    if ((at.z > -0.49f) == at_ball) learning.add(start, double(start.emitted.flux.sum()));
  }
  return learning.learned();
}

TEST(EmissionLearning, AimsLessWhereItIsOfNoUse) {
  const auto scene =
      make_scene({object("emitter", "point", {{"position", Vec3d(0, 0, 2)}}),
                  sphere(Vec3d(0.3, 0.1, 0), 0.1, mirror_bsdf()),
                  placed("rectangle",
                         Transform::translate(Vec3d(0, 0, -0.5)) * Transform::scale(Vec3d(4, 4, 1)),
                         black())});
  const LightPathEmission plain(*scene);
  ASSERT_EQ(plain.aimed_share(0), 0.5f);
  EXPECT_FALSE(learned_beside_a_ball(plain, true, 20'000)) << "what is aimed is as good as any";
  const auto elsewhere = learned_beside_a_ball(plain, false, 20'000);
  ASSERT_TRUE(elsewhere);
  EXPECT_EQ(elsewhere->aimed_share(0), 0.1f);
}

/// All rays of two lamps are of use alike, so there is nothing to guide; but rays that are aimed
/// take from the others.
TEST(EmissionLearning, AimsLessWhereNothingElsePays) {
  const auto lamp = [](double x, double intensity) {
    return object(
        "emitter", "point",
        {{"position", Vec3d(x, 0, 2)}, {"intensity", Rgb{intensity, intensity, intensity}}});
  };
  const auto scene =
      make_scene({lamp(0, 1), lamp(0.5, 3), sphere(Vec3d(0.3, 0.1, 0), 0.1, mirror_bsdf()),
                  sphere(Vec3d(0, 0, 2), 5, black())});
  const LightPathEmission plain(*scene);
  EmissionLearning learning(plain);
  for (uint32_t i = 0; i < 20'000; ++i) {
    Sampler sampler(23, i);
    const LightPathStart start = plain.sample(sampler, {});
    if (start.light >= 0) learning.add(start, double(start.emitted.flux.sum()));
  }
  const auto learned = learning.learned();
  ASSERT_TRUE(learned);
  for (const int light : {0, 1}) {
    EXPECT_EQ(plain.aimed_share(light), 0.5f);
    EXPECT_EQ(learned->aimed_share(light), 0.1f);
    EXPECT_NEAR(learned->chance(light), plain.chance(light), 1e-6);
  }
  // Σ f² q/p of even use: a plain share of 1/2 leaves twice the least, 9/10 a tenth more.
  EXPECT_NEAR(learning.second_moment(*learned) / learning.second_moment(plain), 0.5 / 0.9, 0.02);
  // Unbiased: 4π times the intensities, of three lanes.
  RunningStatistics power;
  for (uint32_t i = 0; i < 50'000; ++i) {
    Sampler sampler(24, i);
    power.add(double(learned->sample(sampler, {}).emitted.flux.sum()));
  }
  EXPECT_NEAR(power.mean(), 4 * std::numbers::pi * 4 * 3, 4 * power.standard_error());
  EXPECT_LT(power.standard_error(), 0.01 * power.mean());
}

}  // namespace
}  // namespace kaustik
