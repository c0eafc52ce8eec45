// What light paths bring to the probes of a ball, where that is known on paper, and what paths made
// by hand teach.

#include "kaustik/vcm/lessons/light_path_use.h"
#include "kaustik/vcm/lessons/probe_light.h"
#include "kaustik/vcm/lessons/radius_learning.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

ComponentSet only(Component component) {
  ComponentSet set;
  set.add(component);
  return set;
}

/// What a light vertex sends from a probe is its flux times the bsdf, of components that are
/// wanted.
TEST(ProbeLight, IsFluxTimesBsdf) {
  const HollowBall ball;
  const PixelPlans plans(ball.scene());
  const PixelProbe& probe = plans.seen().probes()[7];
  LightVertexData vertex;
  vertex.flux = Spectrum(1, 2, 3, 0);
  vertex.direction = PackedDirection(probe.vertex.normal());
  vertex.specular = false;
  const auto sent = [&](ComponentSet wanted) { return ProbeLight(probe, wanted, {}).sent(vertex); };
  const double expected = 0.6 / double(pi) * (1 + 2 + 3);
  EXPECT_NEAR(sent(only(Component::indirect)), expected, 1e-5);
  EXPECT_EQ(sent(only(Component::caustic)), 0);
  vertex.specular = true;
  EXPECT_EQ(sent(only(Component::indirect)), 0);
  EXPECT_NEAR(sent(only(Component::caustic)), expected, 1e-5);
  EXPECT_NEAR(sent(ComponentSet::all()), expected, 1e-5);
}

/// The same where both lobes send something on.
TEST(ProbeLight, IsOfBothLobes) {
  const TestScene floor(camera("0, -1, 1", "0, 0, 0", 30, 8) +
                        flat("rectangle", "", phong(0.4, 0.3, 8)));
  const PixelPlans plans(floor.scene());
  const PixelProbe& probe = plans.seen().probes()[0];
  const Vec3f from = normalize(Vec3f(0.1f, 0.8f, 0.9f));
  LightVertexData vertex;
  vertex.flux = Spectrum(1, 1, 1, 0);
  vertex.direction = PackedDirection(from);
  vertex.specular = false;
  const auto sent = [&](ComponentSet wanted) { return ProbeLight(probe, wanted, {}).sent(vertex); };
  const float diffuse = probe.vertex.eval(from, Lobes::diffuse).sum();
  const float glossy = probe.vertex.eval(from, Lobes::glossy).sum();
  EXPECT_GT(std::min(diffuse, glossy), 0.05f);
  EXPECT_NEAR(sent(only(Component::indirect)), diffuse, 1e-3f * diffuse);
  EXPECT_NEAR(sent(only(Component::specular)), glossy, 1e-2f * glossy);
  EXPECT_NEAR(sent(ComponentSet::all()), diffuse + glossy, 1e-2f * (diffuse + glossy));
  vertex.direction = PackedDirection({0, 0, -1});
  EXPECT_EQ(sent(ComponentSet::all()), 0);
}

constexpr uint32_t lesson_passes = slow_build ? 4 : 24;

/// Light that a pass brings to a probe, over its paths, is that of more than one event.
TEST(LightPathUse, SeesTheLightOfABall) {
  const HollowBall ball(20);
  const LightPathUse use(ball.scene(), ball.emission(), ComponentSet::all());
  RunningStatistics light;
  for (uint32_t number = 0; number < lesson_passes; ++number) {
    constexpr uint32_t paths = 4000;
    const LightPathUse::Seen seen =
        use.seen_in(ball.trace(merging_weights(paths, 0.1f), paths, number, 1 << 20));
    EXPECT_EQ(seen.paths, paths);
    double sum = 0;
    uint32_t last = 0;
    for (const LightPathUse::Arrival& arrival : seen.arrivals) {
      sum += double(arrival.light);
      last = std::max(last, arrival.probe);
      ASSERT_GT(arrival.vertex, arrival.path + 1);
    }
    light.add(sum / paths / (last + 1));
  }
  expect_known_mean("light of a probe", light, HollowBall::radiance_from(2), 0.12);
}

/// Sums within growing disks grow as their areas, and have no side.
TEST(RadiusLearning, SumsUpTheLightOfABall) {
  const HollowBall ball(5);
  const PixelPlans plans(ball.scene());
  constexpr uint32_t paths = 20'000;
  constexpr size_t widest = RadiusLearning::level_count - 1, other = 1;
  std::array<RunningStatistics, 2> light, vertices;
  RunningStatistics aside;
  const std::array<size_t, 2> levels{widest, widest - 4};
  for (uint32_t number = 0; number < lesson_passes; ++number) {
    const auto sums = RadiusLearning::sums_of(
        plans, ball.trace(merging_weights(paths, 0.1f), paths, number, 1 << 20),
        ComponentSet::all(), std::vector<RadiusLearning::Sums>(plans.seen().probes().size()));
    std::array<double, 2> of_light{}, of_vertices{};
    double x = 0;
    for (size_t p = 0; p < sums.size(); ++p) {
      const double pixel = sqr(double(plans.seen().probes()[p].pixel_width));
      x += sums[p].of[other].x[widest] / sums[p].of[other].light[widest] / double(sums.size());
      for (size_t k = 0; k < 2; ++k) {
        // Twice the area of the level before.
        const double area = double(pi) * pixel * std::exp2(double(levels[k]));
        of_light[k] += sums[p].of[other].light[levels[k]] / area / paths / double(sums.size());
        of_vertices[k] += sums[p].vertices[levels[k]] / area / paths / double(sums.size());
      }
      EXPECT_EQ(sums[p].of[0].light[widest], 0) << "nothing is focused";
    }
    aside.add(x);
    for (size_t k = 0; k < 2; ++k) {
      light[k].add(of_light[k]);
      vertices[k].add(of_vertices[k]);
    }
  }
  const double density = HollowBall::density() * HollowBall::mergeable(100);
  for (size_t k = 0; k < 2; ++k) {
    expect_known_mean("light by area", light[k], HollowBall::radiance_from(2), 0.15);
    expect_known_mean("vertices by area", vertices[k], density, 0.15);
  }
  EXPECT_GT(t_test_p_value(aside, 0), analytic_level);
}

/// A pass that was stopped teaches nothing; the same pass teaches where it was not.
TEST(LightPathUse, LearnsNothingOnceStopped) {
  const HollowBall ball;
  LightPathUse use(ball.scene(), ball.emission(), ComponentSet::all());
  constexpr uint32_t paths = 256;
  const LightVertices light = ball.trace(merging_weights(paths, 0.1f), paths, 0, paths);
  std::stop_source stop;
  stop.request_stop();
  use.learn(light, stop.get_token());
  use.learn_scattering(light, stop.get_token());
  EXPECT_EQ(use.emission().size(), 0u);
  EXPECT_EQ(use.noise().guided, 0);
  use.learn(light, {});
  EXPECT_GT(use.emission().size(), 0u);
  EXPECT_GT(use.noise().guided, 0);
}

/// Boxes to search by hold every probe.
TEST(LightPathUse, TargetsHoldAllProbes) {
  const HollowBall ball;
  const auto targets = LightPathUse(ball.scene(), ball.emission(), ComponentSet::all()).targets();
  EXPECT_EQ(targets.size(), 32u);
  const PixelPlans plans(ball.scene());
  for (const PixelProbe& probe : plans.seen().probes())
    EXPECT_TRUE(std::any_of(targets.begin(), targets.end(), [&](const AimTarget& target) {
      return target.box.intersects(probe.vertex.position());
    }));
}

/// What light paths of the ball teach: they leave the lamp in a cone of 26°, are scattered once,
/// and bring light of 1 to one of 36 probes each. Guided ones come there `density` times as often.
class TaughtByHand : public testing::Test {
 protected:
  static constexpr uint32_t paths = 36 * 60;

  TaughtByHand() {
    use_ = std::make_unique<LightPathUse>(ball_.scene(), *plain_, only(Component::indirect));
  }
  void teach(float density) {
    LightPathUse::Seen seen;
    seen.paths = paths;
    for (uint32_t number = 0; seen.beginnings.size() < paths; ++number) {
      Sampler sampler = Sampler::at(1, 0, Stream::training, 0, number);
      const LightPathStart start = plain_->sample(sampler, {});
      if (start.emitted.ray.direction.z < 0.9f) continue;
      const auto i = uint32_t(seen.beginnings.size());
      const uint32_t begin = 3 * i;
      seen.beginnings.push_back({begin, start});
      LightScattering event;
      event.path = begin;
      event.at = 1;
      event.number = i;
      event.position = start.emitted.ray.direction;
      event.normal = -event.position;
      event.next = {0.6f, 0, -0.8f};
      event.pdf = density;
      event.pdf_unguided = 1;
      seen.scatterings.push_back(event);
      seen.arrivals.push_back({i % 36, begin, begin + 2, 1});
    }
    use_->learn(seen);
  }

  HollowBall ball_;
  std::shared_ptr<const LightPathEmission> plain_ =
      std::make_shared<const LightPathEmission>(ball_.scene());
  std::unique_ptr<LightPathUse> use_;
};

/// A path is of use by what it brings, over the light of the probe and the mean, 1/36 each.
TEST_F(TaughtByHand, NoiseIsTheSumOfSquaredUses) {
  for (const float density : {1.0f, 3.0f, 0.5f}) {
    teach(density);
    const double guided = double(paths) * sqr(36.0 / 2);
    EXPECT_NEAR(use_->noise().guided, guided, 1e-6 * guided);
    EXPECT_NEAR(use_->noise().unguided, double(density) * guided, 1e-6 * guided);
  }
  EXPECT_EQ(use_->emission().size(), 3 * paths);
  EXPECT_EQ(use_->scattering().size(), 3 * paths);
  use_->forget_emission();
  EXPECT_EQ(use_->emission().size(), 0u);
}

/// Scattering is guided where that leaves less noise, if it was before; emission in any case.
TEST_F(TaughtByHand, PlansAreGuidedByIt) {
  const auto before = std::make_shared<const ScatterGuide>(ScatterGuide::Parts());
  const auto guided = [&](std::shared_ptr<const ScatterGuide> scattering) {
    return LightGuides{.emission = plain_, .scattering = std::move(scattering)}.guided_by(*use_);
  };
  EXPECT_EQ(guided(before).emission, plain_);
  EXPECT_EQ(guided(before).scattering, nullptr);
  teach(3);
  const LightGuides guides = guided(before);
  ASSERT_NE(guides.emission, plain_);
  const SurfacePoint lamp;
  EXPECT_GT(guides.emission->pdf(0, lamp, {0, 0, 1}).rest,
            3 * plain_->pdf(0, lamp, {0, 0, 1}).rest);
  EXPECT_TRUE(guides.scattering && guides.scattering != before);
  EXPECT_EQ(guided(nullptr).scattering, nullptr);
  teach(0.5f);
  EXPECT_EQ(guided(before).scattering, nullptr);
}

}  // namespace
}  // namespace kaustik
