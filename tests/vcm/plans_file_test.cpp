// Plans as bytes: what comes back, and what is refused.
#include "kaustik/vcm/plan/plans_file.h"

#include "kaustik/base/error.h"
#include "kaustik/vcm/plan/plans.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

class PlansFile : public testing::Test {
 protected:
  static constexpr uint32_t samples = 4;

  PlansFile()
      : scene_(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16) +
               flat("rectangle", "", diffuse("0.5, 0.5, 0.5")) +
               flat("rectangle",
                    scale("0.1, 0.1, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.25"),
                    diffuse("0, 0, 0") + area_light("40, 36, 32")) +
               sphere("0.2, -0.05, 0.401", 0.4, glass())),
        settings_(Arguments(ppm_info(), {}, {}, problems_)),
        plain_(std::make_shared<const LightPathEmission>(scene_.scene(), settings_.aim)) {}

  VcmPlans made() const {
    return *VcmPlanner(scene_.scene(), settings_, plain_).make(samples, {}).plans;
  }
  /// Those of the first pass with so many samples in one block, written and read.
  VcmPlans with_count(uint32_t count) const {
    VcmPlans plans = made();
    const size_t blocks = plans.pixels.seen().grid().size();
    SampleSpread spread{2, std::vector<uint32_t>(blocks, samples), std::vector<uint32_t>(blocks, 0),
                        std::vector<uint32_t>(blocks, samples)};
    spread.counts.back() = count;
    plans.pixels.set_spread(std::make_shared<const SampleSpread>(std::move(spread)));
    return written_and_read(plans);
  }
  /// Those that sample so many lights in one block.
  VcmPlans with_light_samples(int count) const {
    return with_block([&](PixelPlan& plan) { plan.light_samples = count; });
  }
  /// Those with one block changed.
  template <typename Change>
  VcmPlans with_block(const Change& change) const {
    VcmPlans plans = made();
    std::vector<PixelPlan> pixels = plans.pixels.plans();
    change(pixels.back());
    plans.pixels = plans.pixels.with(std::move(pixels));
    return written_and_read(plans);
  }
  VcmPlans written_and_read(const VcmPlans& plans) const {
    ByteWriter writer;
    write_plans(writer, plans);
    ByteReader reader(writer.bytes(), "plans");
    return PlansReader(reader, scene_.scene(), settings_, *plain_).next();
  }

  TestScene scene_;
  Problems problems_;
  VcmSettings settings_;
  std::shared_ptr<const LightPathEmission> plain_;
};

TEST_F(PlansFile, PlansComeBack) {
  const VcmPlans plans = made(), read = with_count(3);
  EXPECT_EQ(read.samples_per_pixel, samples);
  EXPECT_EQ(read.light_paths, plans.light_paths);
  EXPECT_EQ(read.pixels.other_area(), plans.pixels.other_area());
  EXPECT_EQ(read.pixels.spread()->counts.back(), 3u);
  ASSERT_EQ(read.pixels.plans().size(), plans.pixels.plans().size());
  for (size_t i = 0; i < plans.pixels.plans().size(); ++i)
    EXPECT_EQ(read.pixels.plans()[i].merge_area, plans.pixels.plans()[i].merge_area) << i;
}

/// A block without samples would be black, one of very many would take for ever.
TEST_F(PlansFile, CountsOfSamplesHaveBounds) {
  EXPECT_NO_THROW(with_count(1));
  EXPECT_NO_THROW(with_count(4 * samples));
  EXPECT_THROW(with_count(0), Error);
  EXPECT_THROW(with_count(4 * samples + 1), Error);
}
TEST_F(PlansFile, CountsOfLightsHaveBounds) {
  EXPECT_EQ(with_light_samples(1).pixels.plans().back().light_samples, 1);
  EXPECT_EQ(with_light_samples(16).pixels.plans().back().light_samples, 16);
  EXPECT_THROW(with_light_samples(0), Error);
  EXPECT_THROW(with_light_samples(17), Error);
}

/// Weights are divided by what pixels share, and the pilot's light by what is covered.
TEST_F(PlansFile, WhatWeightsGoByHasBounds) {
  const auto with = [&](float covered, float in_common) {
    return with_block([&](PixelPlan& plan) {
      plan.covered = covered;
      plan.merging_in_common = in_common;
    });
  };
  EXPECT_EQ(with(0.5f, 2).pixels.plans().back().counted_area(1),
            made().pixels.plans().back().merge_area * 0.5f / 2);
  for (const float covered : {0.0f, 1.5f, NAN}) EXPECT_THROW(with(covered, 1), Error) << covered;
  for (const float in_common : {0.5f, infinity, NAN})
    EXPECT_THROW(with(1, in_common), Error) << in_common;
}

/// A pilot that tells of nothing, or of a cache that errs by less than nothing, would choose at
/// random.
TEST_F(PlansFile, PilotsHaveBounds) {
  const auto with = [&](const auto& change) {
    VcmPlans plans = made();
    VcmPilot pilot = *plans.pilot;
    change(pilot);
    plans.pilot = std::make_shared<const VcmPilot>(std::move(pilot));
    return written_and_read(plans);
  };
  EXPECT_NO_THROW(with([](VcmPilot&) {}));
  EXPECT_THROW(with([](VcmPilot& pilot) { pilot.light_share = 0; }), Error);
  EXPECT_THROW(with([](VcmPilot& pilot) { pilot.costs.pixels = NAN; }), Error);
  const auto with_variance = [&](float variance) {
    return with([&](VcmPilot& pilot) {
      const size_t probes = pilot.probes.size();
      pilot.cache_trials[0] = {std::vector<uint8_t>(probes, 1),
                               std::vector<float>(probes, variance), std::vector<float>(probes, 1),
                               1};
    });
  };
  EXPECT_NO_THROW(with_variance(0));
  EXPECT_THROW(with_variance(-1), Error);
  EXPECT_THROW(with_variance(NAN), Error);
}

}  // namespace
}  // namespace kaustik
