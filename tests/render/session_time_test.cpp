// Sessions that are limited by time, and what is to be seen of them meanwhile.

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "kaustik/render/part_picture.h"
#include "kaustik/render/session.h"
#include "tests/support/counted_clock.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

bool is_everywhere(const Image& image, float value) {
  for (const float pixel : image.channel(0))
    if (std::abs(pixel - value) > 1e-5f * value) return false;
  return true;
}

/// 256 pixels in four tiles whose samples take 0.5 ms each: 0.5 s a pass of 4.
struct Slow {
  CountedClock clock;
  std::shared_ptr<const Scene> scene = scene_with(film_of(64, 4), room);
  SessionSettings settings;
  Script script;

  Slow() {
    settings.threads = 2;
    settings.clock = clock.reader();
    script.sample = [this](const Vec2f&, Sampler&, SampleSink& sink) {
      clock.advance(0.5);
      sink.add(Component::direct, Spectrum(2));
    };
  }
};

TEST(SessionTime, EndsInTimeWithAPart) {
  Slow slow;
  const Scripted integrator(slow.script);
  slow.settings.seconds = 0.9;
  slow.settings.samples_per_pass = 4;
  Session session(*slow.scene, integrator, slow.settings);
  const SessionReport report = session.run();
  EXPECT_EQ(report.passes, 1u);
  EXPECT_GT(report.part, 0);
  EXPECT_EQ(report.end, SessionEnd::time);
  EXPECT_FALSE(report.incomplete_pass);
  EXPECT_EQ(report.passes, session.film().pass_count());
  EXPECT_TRUE(is_everywhere(session.image(), 2));
  EXPECT_LT(report.part, 1);
}

/// The part of a pass counts as what it is: pass 0 shows 1, pass 1 shows 4.
TEST(SessionTime, PartsCountAsTheShareOfTheirSamples) {
  const auto scene = scene_with(film_of(32, 4), room);
  std::atomic<uint32_t> pass_index = 0;
  CountedClock clock;
  Script script;
  script.prepare = [&](const Pass& pass, SplatBuffer&) { pass_index = pass.index; };
  script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
    clock.advance(pass_index == 0 ? 0.25 : 1);  // slower than the first: it is cut
    sink.add(Component::direct, Spectrum(pass_index == 0 ? 1 : 4));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.threads = 2;
  settings.seconds = 0.36;
  settings.samples_per_pass = 4;
  Session session(*scene, integrator, settings);
  const SessionReport report = session.run();
  ASSERT_EQ(report.passes, 1u);
  ASSERT_GT(report.part, 0);
  const double expected = (1 + 4 * report.part) / (1 + report.part);
  EXPECT_TRUE(is_everywhere(session.image(), float(expected)))
      << session.image().at(0, 0, 0) << " instead of " << expected;
  EXPECT_TRUE(is_everywhere(session.film().image(), 1));
}

/// A session of 0.3 s whose light passes take so many ms and whose samples take no time.
SessionReport report_of_light_passes(const std::function<int(uint32_t index)>& milliseconds) {
  const auto scene = plain_scene();
  CountedClock clock;
  Script script;
  script.prepare = [&](const Pass& pass, SplatBuffer&) { clock.advance(milliseconds(pass.index)); };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.seconds = 0.3;
  settings.samples_per_pass = 1;
  return Session(*scene, integrator, settings).run();
}

// The script can't be stopped, but what it has made is not used any more.
TEST(SessionTime, LightPassesThatWouldBeLateAreGivenUp) {
  const SessionReport report =
      report_of_light_passes([](uint32_t index) { return index == 2 ? 600 : 10; });
  EXPECT_EQ(report.passes, 2u);
  EXPECT_EQ(report.part, 0);
  EXPECT_EQ(report.end, SessionEnd::time);
}

/// A third pass of 0.12 s would be late, so none begins: it is the time that ends the session.
TEST(SessionTime, EndsEarlyWhereTheNextPassWouldBeLate) {
  const SessionReport report = report_of_light_passes([](uint32_t) { return 120; });
  EXPECT_EQ(report.passes, 2u);
  EXPECT_LT(report.seconds, 0.3);
  EXPECT_EQ(report.end, SessionEnd::time);
}

TEST(SessionTime, PlansNoLongerPassesThanThereIsTime) {
  const auto samples = [](double seconds, int size, bool keeps) {
    const auto scene = scene_with(film_of(size, size), room);
    const Scripted integrator{Script()};
    SessionSettings settings;
    settings.seconds = seconds;
    settings.keeps_passes = keeps;
    return Session(*scene, integrator, settings).samples_per_pass();
  };
  EXPECT_EQ(samples(1, 200, false), 4u);  // the integrator's
  EXPECT_EQ(samples(0.06, 200, false), 1u);
  EXPECT_EQ(samples(0.45, 200, false), 2u);
  EXPECT_EQ(samples(1e-6, 8, false), 1u);
  EXPECT_EQ(samples(0.06, 200, true), 4u);  // others will go on with them
}

TEST(SessionTime, SnapshotsOfTheFirstPassAreWholePictures) {
  Slow slow;
  const Scripted integrator(slow.script);
  slow.settings.passes = 1;
  slow.settings.samples_per_pixel = 4;
  Session session(*slow.scene, integrator, slow.settings);
  EXPECT_FALSE(session.snapshot());
  std::atomic<bool> ended = false;
  std::atomic<int> whole = 0, other = 0;
  const auto look = [&] {
    if (const auto image = session.snapshot()) ++(is_everywhere(*image, 2) ? whole : other);
  };
  std::thread viewer([&] {
    while (!ended) look();
  });
  // Between tiles, since their samples take long.
  session.run({}, [&](const Progress&) { look(); });
  ended = true;
  viewer.join();
  EXPECT_GE(whole, 2);
  EXPECT_EQ(other, 0);
  EXPECT_TRUE(same_bits(*session.snapshot(), session.film().image()));
}

/// Nor do they change what is rendered, whoever asks for them.
TEST(SessionTime, SnapshotsChangeNothing) {
  const auto scene = scene_with(film_of(40, 40), room);
  Script script;
  script.sample = [](const Vec2f&, Sampler& sampler, SampleSink& sink) {
    sink.add(Component::direct, Spectrum(sampler.next_1d()));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 3;
  settings.samples_per_pixel = 1200;
  Session alone(*scene, integrator, settings);
  alone.run();
  Session seen(*scene, integrator, settings);
  std::atomic<bool> ended = false;
  std::thread viewer([&] {
    while (!ended) seen.snapshot();
  });
  int in_callbacks = 0;
  seen.run(
      {}, [&](const Progress&) { in_callbacks += seen.snapshot() ? 1 : 0; },
      [&] { in_callbacks += seen.snapshot() ? 1 : 0; });
  ended = true;
  viewer.join();
  EXPECT_GE(in_callbacks, 3);
  EXPECT_TRUE(same_bits(alone.film().image(), seen.film().image()));
  // The twin: another seed is another picture.
  settings.seed = 1;
  Session other(*scene, integrator, settings);
  other.run();
  EXPECT_FALSE(same_bits(alone.film().image(), other.film().image()));
}

TEST(SessionTime, ExceptionsOfCallbacksEndIt) {
  Slow slow;
  const Scripted integrator(slow.script);
  slow.settings.passes = 5;
  slow.settings.samples_per_pass = 2;
  for (const bool in_progress : {true, false}) {
    Session session(*slow.scene, integrator, slow.settings);
    int passes = 0;
    const auto fail = [&] { throw std::runtime_error("enough"); };
    EXPECT_THROW(session.run(
                     {},
                     [&](const Progress& progress) {
                       if (in_progress && progress.passes_done >= 2) fail();
                     },
                     [&] {
                       if (++passes == 2 && !in_progress) fail();
                     }),
                 std::runtime_error);
    EXPECT_GE(session.film().pass_count(), 2u);
    EXPECT_LT(session.film().pass_count(), 5u);
    EXPECT_TRUE(is_everywhere(*session.snapshot(), 2));
  }
}

/// 4096 samples of a millisecond each, but no more than a second or so.
TEST(SessionTime, AFirstPassThatWouldBeLateIsNoFilmButHasASnapshot) {
  CountedClock clock;
  const auto scene = scene_with(film_of(64, 64), room);
  Script script;
  script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
    clock.advance(1);
    sink.add(Component::direct, Spectrum(2));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.threads = 2;
  for (const double seconds : {0.1, 10.0}) {
    settings.seconds = seconds;
    Session session(*scene, integrator, settings);
    const double begin = clock.reader()();
    const SessionReport report = session.run();
    const bool is_late = seconds < 1;
    EXPECT_FALSE(report.cancelled());
    EXPECT_FALSE(report.incomplete_pass && is_late);
    EXPECT_EQ(report.passes, is_late ? 0u : 1u);
    EXPECT_EQ(session.film().pass_count(), report.passes);
    EXPECT_LT(clock.reader()() - begin, is_late ? 1.1 : 1.1 * seconds);
    // A sixteenth of the pixels at least have samples, and show them to the others.
    const std::optional<Image> picture = session.snapshot();
    ASSERT_TRUE(picture);
    EXPECT_TRUE(is_everywhere(*picture, 2));
    EXPECT_EQ(picture->find_metadata(incomplete_key) != nullptr, is_late);
  }
}

/// Tells nothing of its progress until it is stopped.
class Silent final : public Integrator {
 public:
  explicit Silent(CountedClock& clock) : clock_(clock) {}
  std::unique_ptr<PassState> prepare(const Pass&, SplatBuffer&, std::stop_token stop,
                                     const ProgressFunction&) const override {
    clock_.advance(3000);
    // What is never stopped ends, too.
    const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!stop.stop_requested() && std::chrono::steady_clock::now() < last)
      std::this_thread::yield();
    was_stopped = stop.stop_requested();
    return std::make_unique<PassState>();
  }
  void sample(const PassState&, const Vec2f&, Sampler&, SampleSink&) const override {}

  mutable std::atomic<bool> was_stopped{false};

 private:
  CountedClock& clock_;
};

TEST(SessionTime, FirstLightPassesAreHaltedThatTellNothing) {
  CountedClock clock;
  const auto scene = plain_scene();
  const Silent integrator(clock);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.seconds = 2;
  Session session(*scene, integrator, settings);
  const SessionReport report = session.run();
  EXPECT_TRUE(integrator.was_stopped);
  EXPECT_EQ(report.passes, 0u);
  EXPECT_FALSE(report.cancelled());
  EXPECT_FALSE(session.snapshot());
}

/// What fails in a thread of the session's own reaches who has called run().
TEST(SessionTime, AClockThatFailsInALightPassEndsIt) {
  CountedClock clock;
  const auto scene = plain_scene();
  const Silent integrator(clock);
  SessionSettings settings;
  std::atomic<bool> failed = false;
  settings.clock = [&, read = clock.reader()] {
    const double now = read();
    if (now > 1 && !failed.exchange(true)) throw std::runtime_error("the clock has failed once");
    return now;
  };
  settings.seconds = 2;
  Session session(*scene, integrator, settings);
  EXPECT_THROW(session.run(), std::runtime_error);
  EXPECT_TRUE(integrator.was_stopped);
  EXPECT_EQ(session.film().pass_count(), 0u);
}

/// The half that the part's pass belongs to has it, the other one does not.
TEST(PartPicture, AddsToItsHalf) {
  PassPixel pixel;
  pixel.radiance[size_t(Component::direct)] = {10, 10, 10, 0};
  for (const uint32_t replicate : {4u, 5u}) {
    Image image(1, 1, {"direct.R", "odd.direct", "odd.share"});
    image.at(0, 0, 0) = 3;
    image.at(0, 0, 1) = 2;
    image.at(0, 0, 2) = 0.25f;  // one pass of four
    PartPicture(image, 0.5, replicate).put(0, 0, pixel, 4);
    const bool is_odd = replicate == 5;
    EXPECT_NEAR(image.at(0, 0, 0), (4 * 3 + 0.5 * 10) / 4.5, 1e-5);
    EXPECT_NEAR(image.at(0, 0, 1), is_odd ? (2 + 0.5 * 10) / 1.5 : 2, 1e-5);
    EXPECT_NEAR(image.at(0, 0, 2), is_odd ? 1.5 / 4.5 : 1 / 4.5, 1e-6);
  }
}

TEST(PartPicture, WeighsByShares) {
  Image image(1, 1,
              {"R", "G", "B", "caustic.G", "albedo.B", "N.Y", "depth.Z", "error.R", "bias.B",
               "noise.mirrored", "emission.A"});
  for (int c = 0; c < image.channel_count(); ++c) image.at(0, 0, c) = 3;
  PassPixel pixel;
  pixel.radiance[size_t(Component::caustic)] = {1, 2, 3, 0};
  pixel.radiance[size_t(Component::direct)] = {10, 20, 30, 0};
  pixel.first_hit.albedo = {0.1f, 0.2f, 0.3f, 0};
  pixel.first_hit.normal = {4, 5, 6};
  pixel.first_hit.depth = 7;
  pixel.first_hit.lamps = 0.25f;
  pixel.bias = {8, 9, 10, 0};
  PartPicture(image, 0.5).put(0, 0, pixel, 3);
  const auto mean = [](double part) { return float((3 * 3 + 0.5 * part) / 3.5); };
  const float fallen = 3 * std::sqrt(3 / 3.5f);
  const float expected[] = {mean(11), mean(22), mean(33), mean(2), mean(0.3), mean(5),
                            mean(7),  fallen,   mean(10), fallen,  mean(0.25)};
  for (int c = 0; c < image.channel_count(); ++c)
    EXPECT_NEAR(image.at(0, 0, c), expected[c], 1e-5f) << image.channel_names()[size_t(c)];
}

}  // namespace
}  // namespace kaustik
