// Choosing among many lights, against brute force over all of them.

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;
using Lights = std::vector<std::unique_ptr<Light>>;

/// A light with a place, of a kind and strength that vary a lot with `i`; every eleventh is dark.
std::unique_ptr<Light> random_local_light(int i, Random& random) {
  const double strength = i % 11 == 10 ? 0.0 : std::exp(6.0 * random.next() - 3.0);
  const Vec3f position = random.next_3d() * 10.0f;
  const Vec3f direction = normalize(random.next_3d() - Vec3f(0.5f));
  const std::vector<Property> radiance = {{"radiance", Value(strength), {}}};
  const float size = 0.05f + 0.5f * random.next();
  const std::vector<Property> intensity = {{"intensity", Value(strength), {}}};
  switch (i % 8) {
    case 0:
      return make_light(
          "point", {{"intensity", Value(strength), {}}, {"position", Value(Vec3d(position)), {}}});
    case 1:
      return make_light("area", radiance, make_disk(position, direction, size));
    case 2:
      return make_light("area", radiance, make_ball(position, size));
    case 3:
      return make_light("area", radiance,
                        make_quad(position, Frame(direction).x * size, Frame(direction).y * size));
    case 4: {
      auto properties = radiance;
      properties.push_back({"two_sided", Value(true), {}});
      return make_light("area", properties, make_disk(position, direction, size));
    }
    case 5: {
      auto properties = intensity;
      properties.push_back({"position", Value(Vec3d(position)), {}});
      properties.push_back({"radius", Value(double(size)), {}});
      return make_light("distributed", properties);
    }
    default: {
      const Frame frame(direction);
      const Vec3d at(position);
      return make_light(
          i % 8 == 6 ? "spot" : "distributedspot",
          {{"intensity", Value(strength), {}},
           {"cutoff_angle", Value(5.0 + 60.0 * random.next()), {}},
           {"to_world", Value(Transform::look_at(at, at + Vec3d(direction), Vec3d(frame.x))), {}}});
    }
  }
}

Lights random_lights(int local, int infinite, uint64_t seed) {
  Random random(seed);
  Lights lights;
  for (int i = 0; i < local; ++i) lights.push_back(random_local_light(i, random));
  for (int i = 0; i < infinite; ++i) {
    const Value strength(0.1 + random.next());
    const Vec3d direction(random.next_3d() - Vec3f(0.5f));
    if (i % 2 == 0)
      lights.push_back(make_light("constant", {{"radiance", strength, {}}}));
    else
      lights.push_back(make_light(
          "directional", {{"irradiance", strength, {}}, {"direction", Value(direction), {}}}));
  }
  return lights;
}

struct Query {
  Vec3f reference, normal;
};

Query random_query(Random& random) {
  Query q{random.next_3d() * 14.0f - Vec3f(2), normalize(random.next_3d() - Vec3f(0.5f))};
  if (random.next() < 0.3f) q.normal = Vec3f(0, 0, 0);
  return q;
}

struct Population {
  int local, infinite;
};
const Population populations[] = {{1, 0}, {2, 0},  {16, 0}, {49, 0},   {1000, 0}, {10'000, 1},
                                  {3, 2}, {30, 3}, {70, 3}, {1000, 2}, {0, 1},    {0, 20}};

/// A direct light estimate without visibility; `cosine` where there is a surface.
double contribution(const Light& light, const Query& q, const Vec2f& u) {
  const LightSample s = light.sample_toward(q.reference, u);
  if (!(s.pdf_solid_angle > 0)) return 0;
  const double cosine = length_sq(q.normal) > 0 ? std::max(dot(q.normal, s.direction), 0.0f) : 1.0;
  return double(s.radiance.sum()) * cosine / s.pdf_solid_angle;
}

TEST(LightSelector, ProbabilitiesSumToOne) {
  for (const auto& [local, infinite] : populations) {
    SCOPED_TRACE(local);
    const Lights lights = random_lights(local, infinite, 5);
    const LightSelector selector(lights);
    Random random(7);
    for (int i = 0; i < 100 / sample_share; ++i) {
      const Query q = random_query(random);
      double sum = 0;
      for (int light = 0; light < int(lights.size()); ++light)
        sum += double(selector.probability(q.reference, q.normal, light));
      ASSERT_NEAR(sum, 1, 1e-5);
    }
  }
}

TEST(LightSelector, ChoiceReportsItsProbabilityExactly) {
  for (const auto& [local, infinite] : populations) {
    SCOPED_TRACE(local);
    const Lights lights = random_lights(local, infinite, 5);
    const LightSelector selector(lights);
    Random random(9);
    for (int i = 0; i < 20'000 / sample_share; ++i) {
      const Query q = random_query(random);
      float u = i == 0 ? 0.0f : i == 1 ? one_minus_epsilon : random.next();
      const auto choice = selector.choose(q.reference, q.normal, u);
      ASSERT_GE(choice.light, 0);
      ASSERT_GT(choice.probability, 0);
      ASSERT_EQ(choice.probability, selector.probability(q.reference, q.normal, choice.light));
      ASSERT_GT(lights[size_t(choice.light)]->traits().power.sum(), 0);
      ASSERT_TRUE(u >= 0 && u < 1);
    }
  }
}

/// p values of the chosen lights, and of the numbers left over, at one point.
struct ChoiceTest {
  double lights = 0, leftover = 0, planted_error = 0;
};

ChoiceTest test_choices(const Lights& lights, const LightSelector& selector, const Query& q,
                        int count) {
  std::vector<double> observed(lights.size(), 0.0), expected, wrong;
  std::vector<double> leftover(20, 0.0), uniform(20, count / 20.0);
  Random random(15);
  for (int i = 0; i < count; ++i) {
    float u = random.next();
    observed[size_t(selector.choose(q.reference, q.normal, u).light)] += 1;
    leftover[size_t(u * 20)] += 1;
  }
  bool high = false;
  for (int light = 0; light < int(lights.size()); ++light) {
    expected.push_back(count * double(selector.probability(q.reference, q.normal, light)));
    if (expected.back() > 0) high = !high;
    wrong.push_back(expected.back() * (high ? 1.02 : 0.98));
  }
  return {chi_square_p_value(observed, expected), chi_square_p_value(leftover, uniform),
          chi_square_p_value(observed, wrong)};
}

float highest_chance(const LightSelector& selector, const Lights& lights, const Query& q) {
  float highest = 0;
  for (int light = 0; light < int(lights.size()); ++light)
    highest = std::max(highest, selector.probability(q.reference, q.normal, light));
  return highest;
}

TEST(LightSelector, ChoosesByItsProbabilities) {
  for (const auto& [local, infinite] : populations) {
    if (local + infinite < 2) continue;
    SCOPED_TRACE(::testing::Message() << local << " + " << infinite);
    const Lights lights = random_lights(local, infinite, 5);
    const LightSelector selector(lights);
    Random random(13);
    for (int i = 0; i < 2; ++i) {
      Query q = random_query(random);
      // Where one light has nearly all the chance, the twin's error would not show.
      while (highest_chance(selector, lights, q) > 0.9f) q = random_query(random);
      const ChoiceTest test = test_choices(lights, selector, q, 1'000'000 / sample_share);
      EXPECT_GT(test.lights, failure_level);
      EXPECT_GT(test.leftover, failure_level);
      // Of very many lights most are pooled, errors of both signs together.
      if (local <= 1000) expect_twin_fails(test.planted_error);
    }
  }
}

TEST(LightSelector, EveryLightThatReachesThePointHasAChance) {
  for (const auto& [local, infinite] : populations) {
    if (local > 1000) continue;
    SCOPED_TRACE(local);
    const Lights lights = random_lights(local, infinite, 21);
    const LightSelector selector(lights);
    Random random(23);
    int reached = 0;
    for (int i = 0; i < 300 / sample_share; ++i) {
      const Query q = random_query(random);
      for (int light = 0; light < int(lights.size()); ++light) {
        double most = 0;
        for (int k = 0; k < 4; ++k)
          most = std::max(most, contribution(*lights[size_t(light)], q, random.next_2d()));
        if (most == 0) continue;
        ++reached;
        ASSERT_GT(selector.probability(q.reference, q.normal, light), 0);
      }
    }
    EXPECT_GT(reached, 0);
  }
}

TEST(LightSelector, TheEstimateAgreesWithTheSumOverAllLights) {
  const Lights lights = random_lights(200, 2, 31);
  const LightSelector selector(lights);
  const Query q{{4, 5, 6}, {0, 0, -1}};
  Random random(33);
  RunningStatistics all, chosen;
  for (int i = 0; i < 40'000 / sample_share; ++i) {
    double sum = 0;
    for (const auto& light : lights) sum += contribution(*light, q, random.next_2d());
    all.add(sum);
  }
  for (int i = 0; i < 3'000'000 / sample_share; ++i) {
    float u = random.next();
    const auto choice = selector.choose(q.reference, q.normal, u);
    chosen.add(contribution(*lights[size_t(choice.light)], q, {u, random.next()}) /
               choice.probability);
  }
  const double error = std::hypot(all.standard_error(), chosen.standard_error());
  EXPECT_GT(z_test_p_value(chosen.mean(), error, all.mean()), failure_level);
  if (!twins_can_fail) return;
  EXPECT_LT(error, 0.003 * all.mean());
  expect_twin_fails(z_test_p_value(1.02 * chosen.mean(), error, all.mean()));
}

/// Mean over random points of the variance of a one-light estimate, relative to the squared sum.
double relative_variance(const Lights& lights,
                         const std::function<double(const Query&, int)>& probability) {
  Random random(35);
  double total = 0;
  const int queries = 200 / sample_share;
  for (int i = 0; i < queries; ++i) {
    const Query q = random_query(random);
    double sum = 0, second_moment = 0;
    for (int light = 0; light < int(lights.size()); ++light) {
      const double c = contribution(*lights[size_t(light)], q, {0.5f, 0.5f});
      if (c > 0) second_moment += c * c / probability(q, light);
      sum += c;
    }
    if (sum > 0) total += second_moment / (sum * sum) - 1;
  }
  return total / queries;
}

TEST(LightSelector, TheTreeIsFarBetterThanPowerForManyLights) {
  for (const int count : {1000, 10'000}) {
    const Lights lights = random_lights(count, 0, 37);
    const LightSelector selector(lights);
    double power = 0;
    for (const auto& light : lights) power += light->traits().power.sum();
    const double by_tree = relative_variance(lights, [&](const Query& q, int light) {
      return selector.probability(q.reference, q.normal, light);
    });
    const double by_power = relative_variance(lights, [&](const Query&, int light) {
      return lights[size_t(light)]->traits().power.sum() / power;
    });
    std::printf("  relative variance, %d lights: by tree %.3g, by power %.3g\n", count, by_tree,
                by_power);
    EXPECT_LT(by_tree, 0.2 * by_power);
  }
}

/// What is not in a big tree's deep nodes is compared with all others.
TEST(LightSelector, DozensOfLightsAreEachChosenByWhatTheyGive) {
  Lights lights;
  Random places(61);
  for (int i = 0; i < 40; ++i)
    lights.push_back(make_light("point", {{"position", Value(Vec3d(places.next_3d())), {}}}));
  const LightSelector selector(lights);
  const LightQuery query({0.5f, 0.5f, 5}, {0, 0, -1});
  double sum = 0;
  for (const auto& light : lights) sum += double(light->expected_irradiance(query));
  for (int i = 0; i < 40; ++i)
    EXPECT_NEAR(selector.probability(query.reference, query.normal, i),
                lights[size_t(i)]->expected_irradiance(query) / sum, 1e-6);
}

TEST(LightSelector, WithoutPowerThereIsNoChoice) {
  for (const int count : {0, 1, 16, 40}) {
    Lights lights;
    for (int i = 0; i < count; ++i)
      lights.push_back(make_light("point", {{"intensity", Value(0.0), {}}}));
    const LightSelector selector(lights);
    float u = 0.3f;
    const auto choice = selector.choose({0, 0, 0}, {0, 0, 1}, u);
    EXPECT_EQ(choice.light, -1);
    EXPECT_EQ(choice.probability, 0);
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(selector.probability(Vec3f(0, 0, 0), Vec3f(0, 0, 0), i), 0);
  }
}

TEST(LightSelector, AFewLightsAreChosenByWhatTheyGive) {
  Lights lights;
  for (const double strength : {1.0, 0.0, 3.0})
    lights.push_back(make_light("point", {{"intensity", Value(Rgb{0, 0, strength}), {}}}));
  const LightSelector selector(lights);
  EXPECT_FLOAT_EQ(selector.probability({9, 9, 9}, Vec3f(0, 0, 0), 0), 0.25f);
  EXPECT_EQ(selector.probability({9, 9, 9}, Vec3f(0, 0, 0), 1), 0);
  EXPECT_FLOAT_EQ(selector.probability({9, 9, 9}, Vec3f(0, 0, 0), 2), 0.75f);
}

TEST(LightSelector, NearLampsComeBeforeFarOnes) {
  Lights lights;
  for (const double x : {0.0, 10.0})
    lights.push_back(make_light("point", {{"position", Value(Vec3d(x, 0, 0)), {}}}));
  const LightSelector selector(lights);
  EXPECT_GT(selector.probability({1, 0, 0}, Vec3f(0, 0, 0), 0), 0.95f);
  EXPECT_GT(selector.probability({1, 0, 0}, Vec3f(0, 0, 0), 1), 0.02f);
  EXPECT_FLOAT_EQ(selector.probability({5, 0, 0}, Vec3f(0, 0, 0), 0), 0.5f);
}

/// In a room with a window the sky's light mostly meets walls, which nobody knows here.
TEST(LightSelector, ABrightSkyDoesNotStarveLamps) {
  for (const int lamps : {1, 3, 40}) {
    Lights lights;
    lights.push_back(make_light("constant", {{"radiance", Value(1000.0), {}}}));
    for (int i = 0; i < lamps; ++i)
      lights.push_back(make_light("point", {{"position", Value(Vec3d(i, 0, 1)), {}}}));
    const LightSelector selector(lights);
    EXPECT_NEAR(selector.probability({0, 0, 0}, {0, 0, 1}, 0), 0.8, 1e-6);
  }
}

TEST(LightSelector, OneLightCostsNoChoice) {
  Lights lights;
  lights.push_back(make_light("point", {{"intensity", Value(0.0), {}}}));
  lights.push_back(make_light("constant", {}));
  const LightSelector selector(lights);
  float u = 0.25f;
  const auto choice = selector.choose({0, 0, 0}, {0, 0, 1}, u);
  EXPECT_EQ(choice.light, 1);
  EXPECT_EQ(choice.probability, 1);
  EXPECT_EQ(u, 0.25f);
}

/// A wall at x = 5 parts the lights with a place, and the points, into two rooms.
bool is_seen(const Light& light, const Vec3f& from) {
  return light.is_infinite() || (center(light.traits().bounds.position).x < 5) == (from.x < 5);
}

/// What probes find in the two rooms.
LightVisibility two_rooms(const Lights& lights) {
  Random random(51);
  std::vector<LightVisibility::Probe> probes;
  std::vector<float> expected, found;
  for (int i = 0; i < 40'000; ++i) {
    const Vec3f direction = normalize(random.next_3d() - Vec3f(0.5f));
    probes.push_back({random.next_3d() * 14.0f - Vec3f(2), direction});
    for (const auto& light : lights) {
      expected.push_back(light->expected_irradiance({probes.back().position, direction}));
      found.push_back(is_seen(*light, probes.back().position) ? expected.back() : 0.0f);
    }
  }
  return {probes, lights.size(), expected, found};
}

TEST(LightSelector, LearnedChoicesAreReportedExactly) {
  for (const auto& [local, infinite] : {Population{2, 0}, {3, 2}, {30, 3}}) {
    SCOPED_TRACE(local);
    const Lights lights = random_lights(local, infinite, 5);
    LightSelector selector(lights);
    selector.learn(two_rooms(lights));
    Random random(55);
    for (int i = 0; i < 100; ++i) {
      const Query q = random_query(random);
      double sum = 0;
      for (int light = 0; light < int(lights.size()); ++light) {
        const float probability = selector.probability(q.reference, q.normal, light);
        sum += probability;
        if (contribution(*lights[size_t(light)], q, {0.5f, 0.5f}) > 0) {
          ASSERT_GT(probability, 0);
        }
      }
      ASSERT_NEAR(sum, 1, 1e-5);
      for (int k = 0; k < 20; ++k) {
        float u = random.next();
        const auto choice = selector.choose(q.reference, q.normal, u);
        ASSERT_EQ(choice.probability, selector.probability(q.reference, q.normal, choice.light));
        ASSERT_TRUE(u >= 0 && u < 1);
      }
    }
    const ChoiceTest test =
        test_choices(lights, selector, random_query(random), 1'000'000 / sample_share);
    EXPECT_GT(test.lights, failure_level);
    EXPECT_GT(test.leftover, failure_level);
    expect_twin_fails(test.planted_error);
  }
}

/// A sun that shines into one half of a room is chosen in the other no more often than the lamp
/// that is seen there, however bright it is; but it may be, for it may come through a gap that no
/// probe has met.
TEST(LightSelector, WhereTheSunNeverComesItTakesNoMoreThanTheBestLamp) {
  Lights lights;
  lights.push_back(make_light(
      "point", {{"position", Value(Vec3d(5, 5, 5)), {}}, {"intensity", Value(10.0), {}}}));
  lights.push_back(make_light(
      "directional", {{"direction", Value(Vec3d(0, 0, -1)), {}}, {"irradiance", Value(10.0), {}}}));
  Random random(61);
  std::vector<LightVisibility::Probe> probes;
  std::vector<float> expected, found;
  const Vec3f up(0, 0, 1);
  for (int i = 0; i < 8192; ++i) {
    const Vec3f place = random.next_3d() * 10.0f;
    probes.push_back({Vec3f(place.x, place.y, 0), up});
    for (const auto& light : lights) {
      expected.push_back(light->expected_irradiance({probes.back().position, up}));
      const bool arrives = !light->is_infinite() || place.x < 5;
      found.push_back(arrives ? expected.back() : 0.0f);
    }
  }
  LightSelector selector(lights);
  selector.learn({probes, lights.size(), expected, found});
  EXPECT_GT(selector.probability({2, 5, 0}, up, 1), 0.9);
  EXPECT_LT(selector.probability({8, 5, 0}, up, 1), 0.51);
  EXPECT_GT(selector.probability({8, 5, 0}, up, 1), 0);
}

TEST(LightSelector, LearnsWhichLightsAreSeen) {
  Random places(53);
  Lights lights;
  for (int i = 0; i < 30; ++i)
    lights.push_back(
        make_light("point", {{"position", Value(Vec3d(places.next_3d() * 10.0f)), {}}}));
  LightSelector learned(lights);
  ASSERT_TRUE(learned.can_learn());
  learned.learn(two_rooms(lights));
  const LightSelector ignorant(lights);
  const auto variance_of = [&](const LightSelector& selector) {
    Random random(57);
    double total = 0;
    int queries = 0;
    for (int i = 0; i < 2000 / sample_share; ++i) {
      const Query q = random_query(random);
      double sum = 0, second_moment = 0;
      for (int light = 0; light < int(lights.size()); ++light) {
        if (!is_seen(*lights[size_t(light)], q.reference)) continue;
        const double c = contribution(*lights[size_t(light)], q, {0.5f, 0.5f});
        if (c > 0)
          second_moment += c * c / double(selector.probability(q.reference, q.normal, light));
        sum += c;
      }
      if (sum > 0) total += second_moment / (sum * sum) - 1, ++queries;
    }
    return total / queries;
  };
  const double by_learned = variance_of(learned), by_ignorant = variance_of(ignorant);
  std::printf("  relative variance: ignorant %.3f, learned %.3f\n", by_ignorant, by_learned);
  EXPECT_LT(by_learned, 0.7 * by_ignorant);
}

TEST(LightSelector, LearnsNothingOfTooManyOrTooFew) {
  for (const int count : {1, 65}) {
    Lights shining;
    for (int i = 0; i < count; ++i) shining.push_back(make_light("point", {}));
    EXPECT_FALSE(LightSelector(shining).can_learn()) << count;
  }
}

TEST(LightSelector, LightsAtOnePlaceAreAllFound) {
  Lights lights;
  for (int i = 0; i < 1000; ++i)
    lights.push_back(make_light("point", {{"intensity", Value(1.0), {}}}));
  const LightSelector selector(lights);
  for (const Vec3f& reference : {Vec3f(0, 0, 0), Vec3f(1, 2, 3)})
    for (int i = 0; i < 1000; ++i)
      ASSERT_NEAR(selector.probability(reference, {0, 0, 1}, i), 1e-3, 3e-4);
}

}  // namespace
}  // namespace kaustik
