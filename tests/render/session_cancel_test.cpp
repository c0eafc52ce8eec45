// Sessions that are stopped: what is finished stays, and the rest leaves no trace.

#include <gtest/gtest.h>

#include <atomic>

#include "kaustik/render/session.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

TEST(SessionCancel, CancellingKeepsTheFinishedPasses) {
  const auto scene = plain_scene();
  std::stop_source source;
  Script script;
  script.prepare = [&](const Pass& pass, SplatBuffer&) {
    if (pass.index == 3) source.request_stop();
  };
  script.sample = [](const Vec2f&, Sampler& sampler, SampleSink& sink) {
    sink.add(Component::direct, Spectrum(sampler.next_1d(), 0, 0, 0));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 10;
  settings.samples_per_pixel = 20;
  Session session(*scene, integrator, settings);
  const SessionReport report = session.run(source.get_token());
  EXPECT_TRUE(report.cancelled());
  EXPECT_FALSE(report.incomplete_pass);
  EXPECT_EQ(report.passes, 3u);

  Script calm = script;
  calm.prepare = [](const Pass&, SplatBuffer&) {};
  settings.passes = 3;
  settings.samples_per_pixel = 6;
  const Scripted calm_integrator(calm);
  Session whole(*scene, calm_integrator, settings);
  whole.run();
  EXPECT_TRUE(same_bits(session.film().image(), whole.film().image()));
}

/// Samples of 1 in every pixel, and splats that sum to 2; `cancel` is called for each sample with
/// its number, and in the light pass with 0.
Script unit_script(const std::function<void(int)>& cancel, std::atomic<int>& samples) {
  Script script;
  script.prepare = [&cancel](const Pass&, SplatBuffer& splats) {
    for (int i = 0; i < 4; ++i)
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
          splats.add({float(x) + 0.5f, float(y) + 0.5f}, Component::caustic, Spectrum(0.5f), {});
    cancel(0);
  };
  script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
    cancel(++samples);
    sink.add(Component::direct, Spectrum(1));
  };
  script.splats = true;
  return script;
}

// A stop in the first pass, whenever it comes, leaves the right picture of fewer samples or none.
TEST(SessionCancel, CancellingTheFirstPassLeavesARightPictureOrNone) {
  const auto scene = scene_with(film_of(40, 40, "<rfilter type=\"box\"/>"), room);
  constexpr int pixels = 40 * 40;
  struct Case {
    int at;
    bool picture, complete;
  };
  // One thread: then the sample that stops it is the last.
  for (const Case& c :
       {Case{0, false, false}, Case{1, false, false}, Case{pixels - 1, false, false},
        Case{pixels, true, false}, Case{pixels + 5, true, false}, Case{3 * pixels - 1, true, false},
        Case{5 * pixels - 1, true, false}, Case{5 * pixels, true, true}}) {
    SCOPED_TRACE(c.at);
    std::stop_source source;
    std::atomic<int> samples = 0;
    const std::function<void(int)> cancel = [&](int number) {
      if (number == c.at) source.request_stop();
    };
    const Scripted integrator(unit_script(cancel, samples));
    SessionSettings settings;
    settings.threads = 1;
    settings.passes = 2;
    settings.samples_per_pixel = 10;
    Session session(*scene, integrator, settings);
    const SessionReport report = session.run(source.get_token());
    EXPECT_TRUE(report.cancelled());
    EXPECT_EQ(report.passes, c.picture ? 1u : 0u);
    EXPECT_EQ(report.incomplete_pass, c.picture && !c.complete);
    EXPECT_EQ(session.film().samples_per_pixel(), uint64_t(c.picture ? c.at / pixels : 0));
    const Image image = session.film().image();
    for (const float value : image.channel(0)) ASSERT_EQ(value, c.picture ? 3 : 0);
  }
}

// Whoever abandons it gets the finished passes alone.
TEST(SessionCancel, AnAbandonedPassIsLeftOut) {
  const auto scene = scene_with(film_of(40, 40), room);
  constexpr int pixels = 40 * 40, in_pass = 2 * pixels;
  for (const int at : {in_pass - 5, 2 * in_pass - 5}) {
    SCOPED_TRACE(at);
    std::stop_source source;
    std::atomic<int> samples = 0;
    Session* running = nullptr;
    const std::function<void(int)> abandon = [&](int number) {
      if (number != at) return;
      running->abandon_pass();
      source.request_stop();
    };
    const Scripted integrator(unit_script(abandon, samples));
    SessionSettings settings;
    settings.threads = 1;
    settings.passes = 3;
    settings.samples_per_pass = 2;
    Session session(*scene, integrator, settings);
    running = &session;
    const SessionReport report = session.run(source.get_token());
    EXPECT_TRUE(report.cancelled());
    EXPECT_FALSE(report.incomplete_pass);
    EXPECT_EQ(report.part, 0);
    EXPECT_EQ(report.passes, uint32_t(at / in_pass));
  }
}

TEST(SessionCancel, APixelOfManySamplesCanBeCancelled) {
  const auto scene = scene_with(film_of(2, 2), room);
  std::stop_source source;
  std::atomic<int> samples = 0;
  Script script;
  script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
    if (++samples == 1000) source.request_stop();
    sink.add(Component::direct, Spectrum(1));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 2000000000;
  Session session(*scene, integrator, settings);
  session.run(source.get_token());
  EXPECT_LT(samples, 10000);
  EXPECT_FLOAT_EQ(session.film().image().at(0, 0, 0), 1);  // the mean of those that were taken
}

}  // namespace
}  // namespace kaustik
