// Passes of four wavelengths teach what those of red, green and blue do.

#include "kaustik/vcm/lessons/probe_light.h"
#include "kaustik/vcm/lessons/radius_learning.h"
#include "kaustik/vcm/lessons/training_samples.h"
#include "kaustik/vcm/pass.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

const Wavelengths four(440, 500, 580, 660);

/// The probe's bsdf is asked at the wavelengths of the flux.
TEST(SpectralLessons, ProbesReflectTheLightOfThePass) {
  const TestScene floor(
      camera("0, -1, 1", "0, 0, 0", 30, 8) +
      flat("rectangle", "",
           "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:0.1, 800:0.9\"/>"
           "</bsdf>"));
  const PixelPlans plans(floor.scene());
  const PixelProbe& probe = plans.seen().probes()[0];
  LightVertexData vertex;
  vertex.direction = PackedDirection(probe.vertex.normal());
  const ProbeLight seen(probe, ComponentSet::all(), four);
  const double unit = 3 / double(white_light(four).sum());
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const auto in_lane = [&](int i) { return i == lane ? 2.0f : 0.0f; };
    vertex.flux = Spectrum(in_lane(0), in_lane(1), in_lane(2), in_lane(3));
    // Of a ramp.
    const double reflectance = 0.1 + 0.8 * (double(four[lane]) - 400) / 400;
    const double expected = 2 * reflectance / double(pi) * unit;
    EXPECT_NEAR(seen.sent(vertex), expected, 0.01 * expected) << lane;
  }
}

/// Pairs are taken in the light of the pass, and white light counts as in RGB mode.
TEST(SpectralLessons, PairsAreOfTheLightOfThePass) {
  const BlockGrid grid;
  const PixelFilter filter;
  const auto light_of = [&](const Wavelengths& wavelengths) {
    const Pass pass{5, 0, 4, wavelengths};
    const TakeSample take = [&](const Vec2f&, Sampler&, SampleSink& sink) {
      EXPECT_TRUE(sink.wavelengths() == wavelengths);
      sink.add(Component::direct, white_light(sink.wavelengths()) * 2);
    };
    return training_pair({.grid = grid,
                          .filter = filter,
                          .components = ComponentSet::all(),
                          .pass = pass,
                          .take = take},
                         {})
        .light;
  };
  EXPECT_DOUBLE_EQ(light_of({}), 6);
  EXPECT_NEAR(light_of(four), 6, 1e-5);
}

/// In a grey ball under white light all is as in RGB mode, whatever the wavelengths.
TEST(SpectralLessons, AreThoseOfRgbInGreyRooms) {
  const HollowBall ball;
  Problems problems;
  VcmSettings settings(Arguments(ppm_info(), {}, {}, problems));
  settings.edges = false;
  const auto plain = std::make_shared<const LightPathEmission>(ball.scene(), settings.aim);
  const FirstPlans first = VcmPlanner(ball.scene(), settings, plain).make(4, {});
  const LightPathUse use(ball.scene(), *plain, ComponentSet::all());
  struct Found {
    double of_disks = 0, of_use = 0, of_pairs = 0;
  };
  const auto found = [&](const Wavelengths& wavelengths) {
    VcmPass pass(ball.scene(), settings, first.plans, {3, 0, 4, wavelengths});
    SplatBuffer nowhere = SplatBuffer::nowhere();
    PassReport report;
    pass.trace_light({.remembered_paths = 1 << 15}, nowhere, {}, {}, report);
    EXPECT_TRUE(pass.light().wavelengths == wavelengths);
    Found result;
    const PixelPlans& pixels = first.plans->pixels;
    const std::vector<RadiusLearning::Sums> none(pixels.seen().probes().size());
    for (const auto& sums :
         RadiusLearning::sums_of(pixels, pass.light(), ComponentSet::all(), none))
      result.of_disks += sums.of[1].light.back();
    for (const LightPathUse::Arrival& arrival : use.seen_in(pass.light()).arrivals)
      result.of_use += double(arrival.light);
    const BlockGrid& grid = pixels.seen().grid();
    const TakeSample take = [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
      pass.sample(grid.window().in_crop(raster), sampler, sink);
    };
    for (uint32_t block = 0; block < grid.size(); ++block)
      result.of_pairs += training_pair({.grid = grid,
                                        .filter = ball.scene().film().filter,
                                        .components = ComponentSet::all(),
                                        .pass = pass.pass(),
                                        .take = take},
                                       {block, 0})
                             .light;
    return result;
  };
  const Found rgb = found({}), spectral = found(four);
  EXPECT_GT(std::min({rgb.of_disks, rgb.of_use, rgb.of_pairs}), 0);
  EXPECT_NEAR(spectral.of_disks / rgb.of_disks, 1, 0.01);
  EXPECT_NEAR(spectral.of_use / rgb.of_use, 1, 0.01);
  EXPECT_NEAR(spectral.of_pairs / rgb.of_pairs, 1, 0.01);
}

}  // namespace
}  // namespace kaustik
