// The session: which passes it plans, that they are complete and the same whoever computes them,
// and how it stops.

#include "kaustik/render/session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "tests/support/counted_clock.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

std::unique_ptr<Integrator> integrator_for(const Scene& scene, const std::string& type,
                                           const std::string& parameters = "") {
  std::vector<std::string> warnings;
  return make_integrator(parse_mitsuba_xml("<scene version=\"3.0.0\"><integrator type=\"" + type +
                                               "\">" + parameters + "</integrator></scene>",
                                           "test.xml", ""),
                         scene, warnings);
}

Image rendered(const Scene& scene, const Integrator& integrator, const SessionSettings& settings) {
  Session session(scene, integrator, settings);
  session.run();
  return session.film().image();
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.channel_names(), b.channel_names());
  for (int c = 0; c < a.channel_count(); ++c)
    ASSERT_TRUE(std::equal(a.channel(c).begin(), a.channel(c).end(), b.channel(c).begin()))
        << a.channel_names()[size_t(c)];
}

TEST(Session, PlansPassesAndSamples) {
  struct Case {
    std::optional<uint32_t> passes, samples;
    int scene_samples;
    uint32_t expected_passes, expected_samples;
  };
  const std::optional<uint32_t> none;
  // The scripted integrator takes 4 samples per pass where nobody asks for anything.
  for (const Case& c : {Case{none, none, 0, 16, 4}, Case{3, none, 0, 3, 4}, Case{none, 1, 0, 1, 1},
                        Case{none, 4, 0, 4, 1}, Case{none, 8, 0, 4, 2}, Case{none, 64, 0, 16, 4},
                        Case{none, 256, 0, 16, 16}, Case{none, 640, 0, 40, 16},
                        Case{none, 1000, 0, 63, 16}, Case{none, none, 8, 4, 2},
                        Case{none, 16, 8, 4, 4}, Case{5, none, 10, 5, 2}, Case{2, 6, 0, 2, 3},
                        Case{8, 2, 0, 2, 1}, Case{none, 7, 0, 4, 2}, Case{none, 28, 0, 7, 4}}) {
    const auto scene = plain_scene(c.scene_samples);
    const Scripted integrator{Script()};
    SessionSettings settings;
    settings.passes = c.passes;
    settings.samples_per_pixel = c.samples;
    Session session(*scene, integrator, settings);
    const SessionReport report = session.run();
    EXPECT_EQ(report.passes, c.expected_passes);
    EXPECT_EQ(report.samples_per_pass, c.expected_samples);
    EXPECT_EQ(session.film().pass_count(), c.expected_passes);
    EXPECT_FALSE(report.cancelled());
  }
}

TEST(Session, EveryPixelGetsItsSamplesWithinItsFilter) {
  const auto scene = scene_with(film_of(21, 17, "<rfilter type=\"tent\"/>"), room);
  std::atomic<int> outside = 0, total = 0;
  Script script;
  script.sample = [&](const Vec2f& raster, Sampler&, SampleSink& sink) {
    ++total;
    if (raster.x < -0.5f || raster.y < -0.5f || raster.x > 21.5f || raster.y > 17.5f) ++outside;
    sink.add(Component::direct, {1, 2, 3, 0});
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 3;
  settings.samples_per_pixel = 15;
  const Image image = rendered(*scene, integrator, settings);
  EXPECT_EQ(total, 15 * 21 * 17);
  EXPECT_EQ(outside, 0);
  for (const float value : image.channel(image.find_channel("G"))) EXPECT_FLOAT_EQ(value, 2);
  for (const float value : image.channel(image.find_channel("direct.B"))) EXPECT_FLOAT_EQ(value, 3);
  for (const float value : image.channel(image.find_channel("caustic.B"))) EXPECT_EQ(value, 0);
}

TEST(Session, ManySamplesAreSummedWithoutLoss) {
  const auto scene = scene_with(film_of(1, 1), room);
  Script script;
  script.sample = [](const Vec2f&, Sampler&, SampleSink& sink) {
    sink.add(Component::direct, Spectrum(0.1f, 0.1f, 0.1f, 0));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 3000000;
  const Image image = rendered(*scene, integrator, settings);
  EXPECT_NEAR(image.at(0, 0, 0), 0.1f, 1e-4f);  // one float sum would be off by 6 %
}

TEST(Session, ThreadsMakeNoDifference) {
  const auto scene = plain_scene();
  for (const char* type : {"path", "lighttracer", "photonmap"}) {
    SCOPED_TRACE(type);
    const auto integrator = integrator_for(
        *scene, type,
        std::string(type) == "photonmap" ? "<integer name=\"global_photons\" value=\"5000\"/>"
                                           "<integer name=\"caustic_photons\" value=\"5000\"/>"
                                         : "");
    SessionSettings settings;
    settings.passes = 2;
    settings.samples_per_pixel = 4;
    settings.seed = 3;
    settings.threads = 1;
    const Image one = rendered(*scene, *integrator, settings);
    for (const int threads : {2, 0}) {
      settings.threads = threads;
      expect_same_bits(rendered(*scene, *integrator, settings), one);
    }
    settings.seed = 4;
    const Image other = rendered(*scene, *integrator, settings);
    EXPECT_FALSE(
        std::equal(one.channel(0).begin(), one.channel(0).end(), other.channel(0).begin()));
  }
}

TEST(Session, PassesAreTheSameWhoeverComputesThem) {
  const auto scene = plain_scene();
  const auto integrator = integrator_for(*scene, "path");
  const auto passes = [&](uint32_t first, uint32_t count) {
    SessionSettings settings;
    settings.first_pass = first;
    settings.passes = count;
    settings.samples_per_pixel = 2 * count;
    return rendered(*scene, *integrator, settings);
  };
  const Image all = passes(0, 4), head = passes(0, 3), tail = passes(3, 1);
  for (int c = 0; c < 3; ++c)
    for (size_t i = 0; i < all.pixel_count(); ++i)
      EXPECT_NEAR(all.channel(c)[i], (3 * head.channel(c)[i] + tail.channel(c)[i]) / 4,
                  1e-6f * all.channel(c)[i] + 1e-9f);
  EXPECT_FALSE(std::equal(head.channel(0).begin(), head.channel(0).end(), tail.channel(0).begin()));
}

// A crop window holds what the whole picture holds there. (The raster positions differ in their
// last bits, so a path now and then takes another turn.)
TEST(Session, CropWindowsShowTheSamePixels) {
  const auto whole = scene_with(film_of(40, 36), room);
  const auto part = scene_with(
      film_of(
          40, 36,
          "<integer name=\"crop_offset_x\" value=\"11\"/><integer name=\"crop_offset_y\" "
          "value=\"9\"/><integer name=\"crop_width\" value=\"19\"/><integer name=\"crop_height\" "
          "value=\"22\"/>"),
      room);
  SessionSettings settings;
  settings.passes = 2;
  settings.samples_per_pixel = 8;
  const Image full = rendered(*whole, *integrator_for(*whole, "path"), settings);
  const Image crop = rendered(*part, *integrator_for(*part, "path"), settings);
  ASSERT_EQ(crop.width(), 19);
  ASSERT_EQ(crop.height(), 22);
  int different = 0, lit = 0;
  for (int y = 0; y < 22; ++y)
    for (int x = 0; x < 19; ++x) {
      const float expected = full.at(x + 11, y + 9, 0);
      lit += expected > 0 ? 1 : 0;
      different += std::fabs(crop.at(x, y, 0) - expected) > 1e-3f * expected + 1e-6f ? 1 : 0;
    }
  EXPECT_GT(lit, 100);
  EXPECT_LE(different, 19 * 22 / 50);
}

// That the samples of a first pass are taken in rounds changes no bit.
TEST(Session, AFirstPassHasTheBitsOfTheSamePassLater) {
  const auto scene = plain_scene();
  const auto integrator = integrator_for(*scene, "path");
  SessionSettings settings;
  settings.passes = 2;
  settings.samples_per_pixel = 2 * 300;
  Session both(*scene, *integrator, settings);
  both.run();
  settings.first_pass = 1;
  settings.passes = 1;
  settings.samples_per_pixel = 300;
  Session later(*scene, *integrator, settings);
  later.run();
  settings.first_pass = 0;
  settings.passes = 2;
  settings.samples_per_pixel = 600;
  Film begun = later.film();
  Session first_last(*scene, *integrator, settings, std::move(begun));
  first_last.run();
  expect_same_bits(both.film().image(), first_last.film().image());
}

// Many samples make many passes: none takes longer, or more light paths, than four of the usual.
TEST(Session, ManySamplesMakeManyPasses) {
  const Scripted integrator{Script()};
  const auto plan = [&](const Scene& scene, SessionSettings settings) {
    const Session session(scene, integrator, settings);
    return std::pair(session.planned_passes(), session.samples_per_pass());
  };
  const auto small = plain_scene(), large = scene_with(film_of(1024, 1024), room);
  SessionSettings settings;
  settings.samples_per_pixel = 100000;
  EXPECT_EQ(plan(*small, settings), std::pair(6250u, 16u));
  EXPECT_EQ(plan(*large, settings), std::pair(25000u, 4u));
  settings.samples_per_pixel = 1 << 30;
  EXPECT_EQ(plan(*small, settings), std::pair(1u << 26, 16u));
  settings.samples_per_pixel = 64;
  EXPECT_EQ(plan(*large, settings), std::pair(16u, 4u));
  // Limits of time and error are looked at between passes: these are as short as without samples.
  settings.samples_per_pixel = 100000;
  settings.seconds = 1;
  EXPECT_EQ(plan(*small, settings), std::pair(25000u, 4u));
  settings.seconds.reset();
  settings.error = 0.01;
  EXPECT_EQ(plan(*small, settings), std::pair(25000u, 4u));
  settings.samples_per_pixel = 3;
  EXPECT_EQ(plan(*small, settings), std::pair(1u, 3u));
  // Who says how many passes there are says how large they are.
  settings.samples_per_pixel = 100000;
  settings.passes = 2;
  EXPECT_EQ(plan(*small, settings), std::pair(2u, 50000u));
}

// Who looks on ends it, not the number of samples that the scene asks for.
TEST(Session, EndlessOnesGoOn) {
  Script script;
  const auto scene = scene_with(
      film_of(4, 4) +
          "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"3\"/></sampler>",
      room);
  const Scripted integrator{script};
  SessionSettings settings;
  EXPECT_EQ(Session(*scene, integrator, settings).planned_passes(), 3u);
  settings.is_endless = true;
  Session session(*scene, integrator, settings);
  EXPECT_EQ(session.planned_passes(), 0u);
  EXPECT_EQ(session.samples_per_pass(), integrator.traits().default_samples_per_pass);
  std::stop_source stop;
  const SessionReport report = session.run(stop.get_token(), {}, [&] {
    if (session.film().pass_count() == 20) stop.request_stop();
  });
  EXPECT_EQ(report.end, SessionEnd::cancelled);
  EXPECT_EQ(report.passes, 20u);
}

// A large first pass is cut when the time is over, but not below a sample of each pixel.
TEST(Session, ALargeFirstPassEndsInTime) {
  const auto scene = scene_with(film_of(2, 2, "<rfilter type=\"box\"/>"), room);
  CountedClock clock;
  Script script;
  script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
    clock.advance(2);
    sink.add(Component::direct, Spectrum(1));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.threads = 1;
  settings.passes = 1;
  settings.samples_per_pixel = 100000;
  for (const double seconds : {1e-6, 0.2}) {
    settings.seconds = seconds;
    Session session(*scene, integrator, settings);
    const SessionReport report = session.run();
    EXPECT_FALSE(report.cancelled());
    EXPECT_TRUE(report.incomplete_pass);
    EXPECT_EQ(report.passes, 1u);
    // 2 ms for each of 4 pixels; of the last round, as long as all before, not all pixels have had
    // theirs.
    EXPECT_GE(session.film().samples_per_pixel(), std::max(1u, uint32_t(seconds / 0.016)));
    EXPECT_LT(session.film().samples_per_pixel(), 200u);
    EXPECT_EQ(session.film().image().at(1, 1, 0), 1);
  }
}

TEST(Session, StopsInTime) {
  const auto scene = plain_scene();
  CountedClock clock;
  Script script;
  script.prepare = [&](const Pass&, SplatBuffer&) { clock.advance(20); };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.seconds = 0.3;
  Session session(*scene, integrator, settings);
  const SessionReport report = session.run();
  EXPECT_GE(report.passes, 14u);  // 20 ms each
  EXPECT_LE(report.passes, 15u);
  EXPECT_FALSE(report.cancelled());

  settings.seconds = 1e-6;
  Session hasty(*scene, integrator, settings);
  EXPECT_EQ(hasty.run().passes, 1u);  // one pass at least

  settings.seconds = 1000;
  settings.passes = 2;
  Session limited(*scene, integrator, settings);
  EXPECT_EQ(limited.run().passes, 2u);
}

/// An error that falls as 1/√passes is looked at after 16, 32, 64 … passes only.
TEST(Session, StopsAtItsError) {
  const auto scene = plain_scene();
  Script script;
  script.sample = [](const Vec2f&, Sampler& sampler, SampleSink& sink) {
    // Past the pairs that are stratified numbers are independent.
    for (uint32_t i = 0; i < Sampler::stratified_pairs; ++i) sampler.next_2d();
    sink.add(Component::direct, Spectrum(0.5f + sampler.next_1d()));
  };
  const Scripted integrator(script);
  const auto passes = [&](double error, std::optional<uint32_t> most = {}) {
    SessionSettings settings;
    settings.error = error;
    settings.passes = most;
    settings.samples_per_pass = 1;
    Session session(*scene, integrator, settings);
    const SessionReport report = session.run();
    EXPECT_EQ(report.picture_error, session.film().picture_error());
    EXPECT_TRUE(most || report.picture_error <= error);
    return report.passes;
  };
  // Standard error of one pass: √(1/12) = 0.289.
  EXPECT_EQ(passes(0.5), 16u);
  EXPECT_EQ(passes(0.08), 16u);
  EXPECT_EQ(passes(0.06), 32u);
  EXPECT_EQ(passes(0.03), 128u);
  EXPECT_EQ(passes(0.03, 50), 50u);
  EXPECT_EQ(passes(0.5, 3), 3u);
}

TEST(Session, BiasGoesToItsLayer) {
  const auto scene = plain_scene();
  Script script;
  script.estimates_bias = true;
  script.sample = [](const Vec2f&, Sampler&, SampleSink& sink) {
    sink.add(Component::caustic, Spectrum(2));
    sink.add_bias(Spectrum(0.25f));
    sink.add_bias(Spectrum(-0.5f));
  };
  SessionSettings settings;
  settings.passes = 3;
  const Image image = rendered(*scene, Scripted(script), settings);
  ASSERT_GE(image.find_channel("bias.G"), 0);
  EXPECT_FLOAT_EQ(image.at(5, 5, image.find_channel("bias.G")), -0.25f);
  // The same everywhere, as where light is smooth.
  EXPECT_FLOAT_EQ(image.at(5, 5, image.find_channel("error.G")), 0.25f * 2 / 3);
}

TEST(Session, TellsItsProgress) {
  const auto scene = plain_scene();
  CountedClock clock;
  Script script;
  script.prepare = [&](const Pass&, SplatBuffer&) { clock.advance(120); };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.clock = clock.reader();
  settings.passes = 5;
  std::mutex mutex;
  std::vector<Progress> told;
  Session session(*scene, integrator, settings);
  session.run({}, [&](const Progress& progress) {
    ASSERT_TRUE(mutex.try_lock()) << "called from two threads at once";
    told.push_back(progress);
    mutex.unlock();
  });
  ASSERT_GE(told.size(), 3u);
  for (size_t i = 1; i < told.size(); ++i) {
    EXPECT_GE(told[i].fraction, told[i - 1].fraction);
    EXPECT_GE(told[i].elapsed_s, told[i - 1].elapsed_s);
    EXPECT_EQ(told[i].passes_total, 5u);
    EXPECT_GT(told[i].memory_bytes, 0u);
  }
  EXPECT_EQ(told.back().stage, Progress::Stage::done);
  EXPECT_EQ(told.back().fraction, 1);
  EXPECT_EQ(told.back().passes_done, 5u);
}

TEST(Session, ShowsItsFilmAfterEveryPass) {
  const auto scene = plain_scene();
  const auto integrator = integrator_for(*scene, "path");
  SessionSettings settings;
  settings.passes = 5;
  settings.samples_per_pixel = 5;
  Session session(*scene, *integrator, settings);
  std::stop_source stop;
  std::vector<Image> seen;
  const SessionReport report = session.run(stop.get_token(), {}, [&] {
    EXPECT_EQ(session.film().pass_count(), seen.size() + 1);
    seen.push_back(session.film().image());
    if (seen.size() == 3) stop.request_stop();
  });
  EXPECT_EQ(report.passes, 3u);
  ASSERT_EQ(seen.size(), 3u);
  expect_same_bits(seen.back(), session.film().image());
  settings.passes = 2;
  settings.samples_per_pixel = 2;
  expect_same_bits(seen[1], rendered(*scene, *integrator, settings));
}

TEST(Session, LetsOthersLookAtItsFilm) {
  const auto scene = plain_scene();
  const auto integrator = integrator_for(*scene, "path");
  SessionSettings settings;
  settings.passes = 40;
  settings.samples_per_pass = 1;
  Session session(*scene, *integrator, settings);
  EXPECT_FALSE(session.look_at_film([](const Film&) { FAIL(); }));
  std::atomic<bool> has_ended = false;
  uint32_t last = 0;
  std::thread other([&] {
    // Whole passes only, each time as many or more.
    while (!has_ended)
      session.look_at_film([&](const Film& film) {
        EXPECT_GE(film.pass_count(), last);
        last = film.pass_count();
        EXPECT_EQ(film.samples_per_pixel(), last);
        EXPECT_GT(film.total(0, 0) + film.total(film.pixel_count() / 2, 0), 0);
      });
  });
  session.run();
  has_ended = true;
  other.join();
  EXPECT_TRUE(session.look_at_film([](const Film& film) { EXPECT_EQ(film.pass_count(), 40u); }));
  EXPECT_EQ(session.snapshot(nullptr, false)->channel_count(), 7);
}

TEST(Session, SamplesThatAreNotFiniteAreCountedAndLeftOut) {
  const auto scene = plain_scene();
  Script script;
  script.sample = [](const Vec2f& raster, Sampler&, SampleSink& sink) {
    const bool bad = raster.x < 1 && raster.x >= 0 && raster.y < 1 && raster.y >= 0;
    sink.add(Component::direct, Spectrum(bad ? infinity : 1.0f));
    sink.add(Component::caustic, Spectrum(2));
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 16;
  Session session(*scene, integrator, settings);
  const SessionReport report = session.run();
  EXPECT_GT(report.dropped_samples, 0u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("not finite"), std::string::npos);
  const Image image = session.film().image();
  for (int c = 0; c < 3; ++c)
    for (const float value : image.channel(c)) EXPECT_TRUE(std::isfinite(value));
  EXPECT_FLOAT_EQ(image.at(10, 10, 0), 3);
  EXPECT_FLOAT_EQ(image.at(0, 0, image.find_channel("caustic.R")), 2);
}

TEST(Session, WarningsAreToldOnce) {
  const auto scene = plain_scene();
  Script script;
  script.warnings = {"the map is empty", "the moon is full"};
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 4;
  Session session(*scene, integrator, settings);
  EXPECT_EQ(session.run().warnings, script.warnings);
}

TEST(Session, SplatsCountOncePerPass) {
  const auto scene = scene_with(film_of(8, 8, "<rfilter type=\"box\"/>"), room);
  Script script;
  script.splats = true;
  script.prepare = [](const Pass& pass, SplatBuffer& splats) {
    splats.add({3.5f, 4.5f}, Component::caustic, Spectrum(float(pass.index + 1)), {});
  };
  const Scripted integrator(script);
  SessionSettings settings;
  settings.passes = 3;
  const Image image = rendered(*scene, integrator, settings);
  EXPECT_FLOAT_EQ(image.at(3, 4, image.find_channel("caustic.G")), 2);  // the mean of 1, 2, 3
  EXPECT_FLOAT_EQ(image.at(3, 4, 1), 4);                                // beside what is sampled
  EXPECT_FLOAT_EQ(image.at(4, 4, 1), 2);
}

TEST(MakeIntegrator, ChoosesAndChecks) {
  const auto scene = plain_scene();
  std::vector<std::string> warnings;
  const Description nothing = parse_mitsuba_xml("<scene version=\"3.0.0\"/>", "test.xml", "");
  EXPECT_EQ(make_integrator(nothing, *scene, warnings)->traits().default_samples_per_pass,
            integrator_for(*scene, "auto")->traits().default_samples_per_pass);
  EXPECT_EQ(integrator_type(nothing, *scene), "auto");
  EXPECT_TRUE(warnings.empty());
  const auto refused = [&](const std::string& inside) -> std::string {
    try {
      make_integrator(
          parse_mitsuba_xml("<scene version=\"3.0.0\">" + inside + "</scene>", "test.xml", ""),
          *scene, warnings);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refused("<integrator type=\"paht\"/>").find("did you mean 'path'?"), std::string::npos);
  EXPECT_EQ(refused("<integrator type=\"path\"><float name=\"depth\" value=\"1\"/></integrator>"),
            "");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("no parameter 'depth': it is left out"), std::string::npos);
  warnings.clear();
  EXPECT_NE(refused("<integrator type=\"path\"><shape type=\"cube\"/></integrator>")
                .find("cannot hold a shape"),
            std::string::npos);
  EXPECT_NE(refused("<integrator type=\"path\"/><integrator type=\"path\"/>").find("second"),
            std::string::npos);
  EXPECT_EQ(refused("<integrator type=\"path\"><boolean name=\"strict_normals\" value=\"true\"/>"
                    "</integrator>"),
            "");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("strict_normals"), std::string::npos);
}

/// What denoisers go by is of the surface behind clear glass, seen through it or in a mirror.
TEST(Session, AlbedoAndNormalAreOfTheFirstRoughSurface) {
  const std::string floor =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/></transform>"
      "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.3, 0.6, 0.2\"/></bsdf></shape>"
      "<emitter type=\"constant\"/>";
  const std::string pane =
      "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/>"
      "<rotate x=\"1\" angle=\"69.44\"/><translate y=\"-2\" z=\"1.25\"/></transform>"
      "<bsdf type=\"dielectric\"/></shape>";
  for (const char* type : {"photonmap", "path"}) {
    const auto bare = scene_with(film_of(8, 8), floor),
               glazed = scene_with(film_of(8, 8), floor + pane);
    const auto picture = [&](const Scene& scene) {
      const auto integrator = integrator_for(scene, type);
      SessionSettings settings;
      settings.passes = 1;
      settings.samples_per_pixel = 64;
      Session session(scene, *integrator, settings);
      session.run();
      return session.film().image();
    };
    const Image behind = picture(*glazed), direct = picture(*bare);
    const auto at = [](const Image& image, const char* name) {
      return image.at(4, 4, image.find_channel(name));
    };
    EXPECT_NEAR(at(direct, "albedo.G"), 0.6f, 0.01f) << type;
    EXPECT_NEAR(at(direct, "N.Z"), 1, 0.01f) << type;
    // 24 of 25 samples go through the pane, the others meet nothing but it: the mean lies that far
    // from the floor's albedo toward 1, and from its normal toward the pane's.
    EXPECT_NEAR(at(behind, "albedo.R"), 0.3f + 0.7f / 25, 0.06f) << type;
    EXPECT_NEAR(at(behind, "albedo.G"), 0.6f + 0.4f / 25, 0.04f) << type;
    EXPECT_NEAR(at(behind, "N.Z"), 1 - 0.65f / 25, 0.06f) << type;
    EXPECT_LT(at(behind, "depth.Z"), 0.6f * at(direct, "depth.Z")) << type;
  }
}

}  // namespace
}  // namespace kaustik
