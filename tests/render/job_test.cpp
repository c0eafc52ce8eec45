// Jobs: a render from a description, in its own thread.

#include "kaustik/render/job.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <chrono>

#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/finished_picture.h"
#include "kaustik/render/part_picture.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;

Description room_with(const std::string& integrator, int size = 24, const std::string& more = "") {
  const auto count = [](const std::string& name) {
    return "<integer name=\"" + name + "\" value=\"4000\"/>";
  };
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"" + integrator + "\">" +
          (integrator == "photonmap" ? count("caustic_photons") + count("global_photons") : "") +
          "</integrator><sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
          "<transform name=\"to_world\"><lookat origin=\"0,-4,2\" target=\"0,0,0.5\" "
          "up=\"0,0,1\"/></transform>" +
          film_of(size, size) + "</sensor>" + room + more + "</scene>",
      "test.xml", "");
}

JobSettings settings_for(uint32_t passes, uint32_t samples = 2) {
  JobSettings settings;
  settings.session.passes = passes;
  settings.session.samples_per_pass = samples;
  settings.session.threads = 2;
  return settings;
}

Image rendered(const std::string& integrator, uint32_t passes, int size = 24) {
  Job job(room_with(integrator, size), settings_for(passes));
  job.run();
  return job.image();
}

JobSettings settings_to(JobTask task) {
  JobSettings settings = settings_for(3);
  settings.task = task;
  settings.session.seed = 5;
  settings.record.program = "test";
  settings.record.recipe.scene = "rooms/./a.xml";
  settings.record.recipe.integrator = task == JobTask::learn ? "auto" : "photonmap";
  return settings;
}

// What the commands learn and photons do goes by the same preparation as a render.
TEST(Job, LearnsWhatTheRecipesIntegratorLearns) {
  Job job(room_with("path", 12), settings_to(JobTask::learn));
  const Learned learned = job.learn();
  EXPECT_EQ(learned.stored.integrator, "auto");
  EXPECT_EQ(learned.stored.program, "test");
  EXPECT_EQ(learned.stored.scene, "rooms/a.xml");
  EXPECT_EQ(learned.stored.lessons.passes, 3u);
  EXPECT_EQ(learned.stored.samples_per_pass, 2u);
  const PreparedScene prepared = prepare_scene(room_with("auto", 12), {}, true, {});
  const StoredLessons same =
      learn(prepared, {.seed = 5, .passes = 3, .samples_per_pass = 2, .threads = 1}).stored;
  EXPECT_EQ(digest_of(learned.stored.lessons), digest_of(same.lessons));
  EXPECT_EQ(learned.stored.digest.scene, same.digest.scene);
}

TEST(Job, TracesThePhotonsOfTheRecipesIntegrator) {
  const std::string path = "photons of a map that is not there.kpm";
  Description description = room_with("photonmap");
  find_integrator(description)->properties.push_back({"photon_map", path, {}});
  JobSettings settings = settings_to(JobTask::trace_photons);
  settings.record.recipe.settings.push_back({"integrator", "global_photons", "3000", "test"});
  Job job(std::move(description), std::move(settings));
  const TracedPhotons traced = job.trace_photons();
  EXPECT_EQ(traced.photons.settings.caustic_photons, 4000u);
  EXPECT_EQ(traced.photons.settings.global_photons, 3000u);
  EXPECT_EQ(traced.photons.seed, 5u);
  EXPECT_EQ(traced.photons.scene, "rooms/a.xml");
  EXPECT_GT(traced.photons.maps.caustic.size(), 100u);
  EXPECT_EQ(job.scene().surface_count(), 3u);
}

TEST(Job, DoesItsTaskAlone) {
  Job learns(room_with("auto", 4), settings_to(JobTask::learn));
  EXPECT_THROW(learns.run(), std::logic_error);
  EXPECT_THROW(learns.start(), std::logic_error);
  EXPECT_THROW(learns.trace_photons(), std::logic_error);
  EXPECT_THROW(learns.wait(), std::logic_error);
  Job renders(room_with("path", 4), settings_for(1));
  EXPECT_THROW(renders.learn(), std::logic_error);
  EXPECT_EQ(renders.run().report.passes, 1u);
  learns.cancel();
  EXPECT_THROW(learns.learn(), Error);
  EXPECT_THROW(learns.learn(), std::logic_error) << "it was begun before";
  // Of another scene it may be asked once more.
  learns.edit(room_with("auto", 4));
  EXPECT_GT(learns.learn().stored.lessons.passes, 0u);
}

TEST(Job, OnlyARenderGoesOn) {
  JobSettings settings = settings_to(JobTask::trace_photons);
  settings.learned.emplace();
  Job job(room_with("auto", 4), std::move(settings));
  EXPECT_THROW(job.trace_photons(), std::logic_error);
}

// The integrator is changed once, so what it has no use for is told once.
TEST(Job, ChangesTheIntegratorOnce) {
  std::vector<std::string> notes;
  JobSettings settings = settings_for(1);
  settings.record.recipe.integrator = "path";
  Job job(room_with("photonmap", 4), std::move(settings),
          {{[&](const std::string& text) { notes.push_back(text); }, {}}, {}, {}});
  job.run();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "integrator 'path' has no use for what the scene says of its 'photonmap': "
            "caustic_photons, global_photons");
}

TEST(Job, TwoAtOnceHaveTheBitsThatTheyHaveAlone) {
  for (const auto& [one, other] : {std::pair("path", "photonmap"), std::pair("vcm", "auto")}) {
    SCOPED_TRACE(one);
    const Image first = rendered(one, 3, 12), second = rendered(other, 3, 12);
    Job a(room_with(one, 12), settings_for(3)), b(room_with(other, 12), settings_for(3));
    a.start();
    b.start();
    EXPECT_EQ(b.wait().report.passes, 3u);
    EXPECT_EQ(a.wait().report.passes, 3u);
    EXPECT_TRUE(same_bits(a.image(), first));
    EXPECT_TRUE(same_bits(b.image(), second));
    EXPECT_FALSE(same_bits(first, second));
  }
}

TEST(Job, MakesTheChangesOfItsRecipe) {
  JobSettings settings = settings_for(2);
  settings.record.recipe.integrator = "path";
  settings.record.recipe.settings = {{"film", "width", "10", "test"},
                                     {"integrator", "max_depth", "2", "test"}};
  std::vector<std::string> warnings;
  Job job(room_with("photonmap"), settings,
          {{{}, [&](const std::string& text) { warnings.push_back(text); }}, {}, {}});
  const JobResult& result = job.run();
  EXPECT_EQ(job.image().width(), 10);
  EXPECT_EQ(result.record.view.integrator, "path");
  EXPECT_EQ(result.record.recipe.samples_per_pass, 2u);
  EXPECT_EQ(result.record.plan.passes, 2u);
  EXPECT_GT(result.record.seconds, 0);
}

TEST(Job, WaitThrowsWhatIsWrongWithTheScene) {
  Job wrong(room_with("pathh"), settings_for(1));
  wrong.start();
  EXPECT_THROW(wrong.wait(), Error);
  EXPECT_THROW(wrong.wait(), Error);
  EXPECT_FALSE(wrong.snapshot());
  Job here(room_with("pathh"), settings_for(1));
  EXPECT_THROW(here.prepare(), Error);
  EXPECT_THROW(Job(room_with("path"), settings_for(1)).wait(), std::logic_error);
}

/// Out of the light pass, the samples and between passes: the film holds what was there.
TEST(Job, WaitThrowsWhatCallbacksThrow) {
  for (const auto& [integrator, stage] :
       {std::pair("photonmap", Progress::Stage::light), std::pair("path", Progress::Stage::picture),
        std::pair("vcm", Progress::Stage::light)}) {
    SCOPED_TRACE(integrator);
    JobListener listener;
    listener.progress = [stage = stage](const Progress& progress) {
      if (progress.passes_done >= 1 && progress.stage == stage) throw std::runtime_error("enough");
    };
    // Large enough for progress to be told in every pass.
    Job job(room_with(integrator, 128), settings_for(50, 16), listener);
    job.start();
    EXPECT_THROW(job.wait(), std::runtime_error);
    EXPECT_GE(job.film().pass_count(), 1u);
    EXPECT_LT(job.film().pass_count(), 50u);
    EXPECT_TRUE(job.snapshot());
  }
  JobListener listener;
  listener.pass_done = [](const Film& film) {
    if (film.pass_count() == 2) throw 42;  // whatever it is
  };
  Job job(room_with("path"), settings_for(5), listener);
  job.start();
  EXPECT_THROW(job.wait(), int);
  EXPECT_EQ(job.film().pass_count(), 2u);
  EXPECT_TRUE(same_bits(job.image(), rendered("path", 2)));
}

TEST(Job, CancelEndsItSoon) {
  for (const std::string integrator : {"path", "photonmap", "vcm"}) {
    SCOPED_TRACE(integrator);
    std::atomic<bool> begun = false;
    JobListener listener;
    listener.progress = [&](const Progress&) { begun = true; };
    Job job(room_with(integrator, 200), settings_for(100000, 4), listener);
    job.start();
    while (!begun) std::this_thread::yield();
    job.cancel();
    EXPECT_TRUE(job.wait().report.cancelled());
  }
  // Before it begins, and by its destructor.
  Job unborn(room_with("path"), settings_for(100000));
  unborn.cancel();
  unborn.start();
  EXPECT_TRUE(unborn.wait().report.cancelled());
  Job forgotten(room_with("path"), settings_for(1000000));
  forgotten.start();
}

TEST(Job, SnapshotsAreThereWhileItRenders) {
  std::atomic<int> seen = 0;
  JobListener listener;
  Job* here = nullptr;
  listener.progress = [&](const Progress& progress) {
    if (progress.has_picture) seen += here->snapshot() ? 1 : 0;
  };
  Job job(room_with("path", 64), settings_for(1, 128), listener);
  here = &job;
  EXPECT_FALSE(job.snapshot());
  job.start();
  std::optional<Image> early;
  while (!(early = job.snapshot())) std::this_thread::yield();
  EXPECT_EQ(early->width(), 64);
  job.wait();
  EXPECT_GT(seen, 0);
  EXPECT_TRUE(same_bits(*job.snapshot(), job.image()));
  // Of less samples than there are now, but the lit floor is seen.
  EXPECT_FALSE(same_bits(*early, job.image()));
  EXPECT_GT(early->at(32, 50, 0), 0);
}

int64_t integer_of(const Image& image, const char* key) {
  return std::get<int64_t>(*image.find_metadata(key));
}

TEST(Job, FinishedSnapshotsTellWhatTheyShow) {
  JobListener listener;
  Job* here = nullptr;
  uint32_t passes = 0;
  listener.progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.samples_per_pixel, 2 * progress.passes_done);
  };
  listener.pass_done = [&](const Film& film) {
    const Image image = here->finished_snapshot().value();
    EXPECT_EQ(integer_of(image, "passes"), int64_t(++passes));
    EXPECT_EQ(integer_of(image, "samples_per_pixel"), int64_t(2 * passes));
    EXPECT_EQ(std::get<std::string>(*image.find_metadata("integrator")), "path");
    EXPECT_TRUE(image.find_metadata("render_seconds"));
    EXPECT_FALSE(image.find_metadata(incomplete_key));
    EXPECT_TRUE(same_bits(image, film.image()));
  };
  Job job(room_with("path"), settings_for(3), listener);
  here = &job;
  EXPECT_FALSE(job.finished_snapshot());
  job.run();
  EXPECT_EQ(passes, 3u);
}

TEST(Job, FinishedSnapshotsCountNoPauses) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  JobSettings settings = settings_for(1, 100'000);
  settings.session.gate = std::make_shared<Gate>();
  Gate& gate = *settings.session.gate;
  Job job(room_with("path", 64), std::move(settings));
  const Clock::time_point begin = Clock::now();
  job.start();
  while (!job.finished_snapshot()) std::this_thread::yield();
  gate.close();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::optional<Image> paused = job.finished_snapshot();
  gate.open();
  const double most = seconds_since(begin) - 0.3;
  EXPECT_LE(std::get<double>(*paused->find_metadata("render_seconds")), most);
  job.cancel();
  job.wait();
}

TEST(Job, AbandonedJobsKeepFinishedPassesOnly) {
  for (const bool is_abandoned : {false, true}) {
    Job job(room_with("path", 64), settings_for(1, 100'000));
    job.start();
    // Until every pixel has samples.
    std::optional<Image> shown;
    while (!(shown = job.finished_snapshot()) || integer_of(*shown, "samples_per_pixel") < 4)
      std::this_thread::yield();
    is_abandoned ? job.abandon() : job.cancel();
    const JobResult& result = job.wait();
    EXPECT_TRUE(result.report.cancelled());
    EXPECT_EQ(result.report.passes, is_abandoned ? 0u : 1u);
  }
}

TEST(Job, FinishedSnapshotsOfAFirstPassCountItsSamples) {
  constexpr uint32_t samples = 4096;
  Job job(room_with("path", 64), settings_for(1, samples));
  job.start();
  std::optional<Image> early;
  while (!(early = job.finished_snapshot())) std::this_thread::yield();
  EXPECT_EQ(integer_of(*early, "passes"), 0);
  EXPECT_LT(integer_of(*early, "samples_per_pixel"), int64_t(samples));
  // The samples that are counted are those that are shown.
  std::optional<Image> later;
  while (!(later = job.finished_snapshot()) || integer_of(*later, "samples_per_pixel") < 4)
    std::this_thread::yield();
  EXPECT_EQ(integer_of(*later, "passes"), 0);
  job.cancel();
  job.wait();
  // In the midst of a round some pixels have twice the samples of others.
  EXPECT_LE(integer_of(*later, "samples_per_pixel"), 2 * int64_t(job.film().samples_per_pixel()));
}

/// Before the light pass of a method that begins with one; what is rendered stays the same.
TEST(Job, PreviewsAreThereBeforeTheFirstLightPass) {
  for (const bool previews : {true, false}) {
    JobSettings settings = settings_for(2);
    settings.previews = previews;
    std::optional<Image> early;
    Job* here = nullptr;
    JobListener listener;
    listener.progress = [&](const Progress& progress) {
      if (!progress.has_picture && !early) early = here->snapshot();
    };
    Job job(room_with("photonmap"), settings, listener);
    here = &job;
    job.run();
    EXPECT_EQ(early.has_value(), previews);
    if (early) {
      EXPECT_EQ(early->channel_count(), 3);
      EXPECT_TRUE(early->find_metadata(incomplete_key));
      double sum = 0, exact = 0;
      const Image whole = job.image();
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
          sum += double(early->at(x, y, 1));
          exact += double(whole.at(x, y, 1));
        }
      // 576 paths: a tenth of the mean or two.
      EXPECT_NEAR(sum / exact, 1, 0.5);
    }
    EXPECT_TRUE(same_bits(job.image(), rendered("photonmap", 2)));
  }
}

/// By a clock that runs away once it was asked: the first look is no part of the film.
TEST(Job, TimeThatIsTooShortLeavesAFirstLook) {
  for (const std::string integrator : {"photonmap", "vcm", "path"})
    for (const bool is_short : {true, false}) {
      SCOPED_TRACE(integrator);
      std::atomic<int> asked = 0;
      JobSettings settings = settings_for(2);
      settings.session.seconds = 100;
      settings.session.clock = [&] { return asked++ > 0 && is_short ? 1000.0 : 0.0; };
      Job job(room_with(integrator, 40), settings);
      const JobResult& result = job.run();
      EXPECT_FALSE(result.report.cancelled());
      EXPECT_EQ(result.report.passes, is_short ? 0u : 2u);
      EXPECT_EQ(job.film().pass_count(), result.report.passes);
      const std::optional<Image> picture = job.snapshot();
      ASSERT_TRUE(picture);
      EXPECT_GT(picture->at(20, 34, 0), 0);  // the lit floor
      const auto says_it = [](const Image& image) {
        return image.find_metadata(incomplete_key) != nullptr;
      };
      EXPECT_EQ(says_it(*picture), is_short);
      EXPECT_EQ(says_it(finished_picture(*picture, result.record, {}, {})), is_short);
      if (!is_short) {
        EXPECT_TRUE(same_bits(job.image(), rendered(integrator, 2, 40)));
      }
    }
}

TEST(Job, EditsMakeAllAnew) {
  const std::string second_lamp =
      "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"-1\" z=\"2\"/></emitter>";
  const auto edited = [&] { return room_with("path", 24, second_lamp); };
  Job job(room_with("path"), settings_for(100000));
  job.start();
  while (!job.snapshot()) std::this_thread::yield();
  JobSettings settings = settings_for(3);
  Job limited(room_with("path"), settings);
  limited.run();
  const Image before = limited.image();
  limited.edit(edited());
  EXPECT_EQ(limited.wait().report.passes, 3u);
  Job alone(edited(), settings);
  alone.run();
  EXPECT_TRUE(same_bits(limited.image(), alone.image()));
  EXPECT_FALSE(same_bits(limited.image(), before));
  // One that runs goes on with the other scene; one that has failed begins again.
  job.edit(edited());
  while (!job.snapshot()) std::this_thread::yield();
  job.cancel();
  EXPECT_TRUE(job.wait().report.cancelled());
  Job wrong(room_with("pathh"), settings);
  wrong.start();
  EXPECT_THROW(wrong.wait(), Error);
  wrong.edit(room_with("path"));
  EXPECT_EQ(wrong.wait().report.passes, 3u);
  EXPECT_TRUE(same_bits(wrong.image(), before));
}

/// Of a room with a glass ball, by `photonmap`; `intensity` of its lamp, `more` in it.
Description glass_room_seen_from(const std::string& origin, const std::string& intensity = "5",
                                 const std::string& more = "") {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"photonmap\"><integer name=\"global_photons\" "
      "value=\"2000\"/><integer name=\"caustic_photons\" value=\"2000\"/></integrator>"
      "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"" +
          origin + "\" target=\"0,0,0.5\" up=\"0,0,1\"/></transform>" + film_of(16, 16) +
          "</sensor><shape type=\"rectangle\"><bsdf type=\"diffuse\"/></shape>"
          "<shape type=\"sphere\"><float name=\"radius\" value=\"0.3\"/><point name=\"center\" "
          "x=\"0\" y=\"0\" z=\"0.5\"/><bsdf type=\"dielectric\"/>" +
          more +
          "</shape><emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"1\" z=\"3\"/><rgb "
          "name=\"intensity\" value=\"" +
          intensity + "\"/></emitter></scene>",
      "test.xml", "");
}

// Photons that are kept while the camera moves are those that the picture would trace itself.
TEST(Job, LightThatIsKeptLeavesPicturesAsTheyAre) {
  const auto rendered = [](Description description, const JobLight* light, uint64_t seed = 7) {
    JobSettings settings;
    settings.session.seed = seed;
    settings.session.passes = 2;
    settings.session.samples_per_pass = 1;
    settings.keeps_light = light != nullptr;
    if (light) settings.light = *light;
    auto job = std::make_unique<Job>(std::move(description), std::move(settings));
    job->run();
    return job;
  };
  const JobLight none;
  const JobLight kept = rendered(glass_room_seen_from("0,-4,2"), &none)->kept_light();
  ASSERT_TRUE(kept.light);
  const auto moved = rendered(glass_room_seen_from("1,-4,2"), &kept);
  EXPECT_EQ(moved->kept_light().light, kept.light);
  EXPECT_TRUE(
      same_bits(moved->image(), rendered(glass_room_seen_from("1,-4,2"), nullptr)->image()));
  // Other light, and another seed, have photons of their own.
  const auto brighter = rendered(glass_room_seen_from("1,-4,2", "6"), &kept);
  EXPECT_NE(brighter->kept_light().light, kept.light);
  EXPECT_TRUE(same_bits(brighter->image(),
                        rendered(glass_room_seen_from("1,-4,2", "6"), nullptr)->image()));
  EXPECT_NE(rendered(glass_room_seen_from("1,-4,2"), &kept, 8)->kept_light().light, kept.light);
  // So have media, whose light belongs to the media of one scene.
  const std::string fog =
      "<medium name=\"interior\" type=\"homogeneous\"><float name=\"sigma_t\" value=\"4\"/>"
      "</medium>";
  const JobLight foggy = rendered(glass_room_seen_from("0,-4,2", "5", fog), &none)->kept_light();
  const auto moved_fog = rendered(glass_room_seen_from("1,-4,2", "5", fog), &foggy);
  EXPECT_TRUE(same_bits(moved_fog->image(),
                        rendered(glass_room_seen_from("1,-4,2", "5", fog), nullptr)->image()));
}

TEST(Job, GoesOnWithWhatItKeptInMemory) {
  JobSettings settings = settings_for(2);
  settings.record.recipe.integrator = "auto";
  Job without(room_with("path"), settings);
  without.run();
  EXPECT_THROW(without.checkpoint(), std::logic_error);

  settings.keeps_digest = true;
  Job first(room_with("path"), settings);
  first.run();
  JobSettings more = settings_for(5);
  more.begun = first.checkpoint();
  more.record = more.begun->record;
  Job second(room_with("path"), std::move(more));
  EXPECT_EQ(second.run().report.passes, 5u);
  EXPECT_TRUE(same_bits(second.image(), rendered("auto", 5)));

  settings.session.seconds = 1e-3;
  settings.session.passes.reset();
  Job none(room_with("path"), settings);
  none.run();
  EXPECT_THROW(none.checkpoint(), Error);
}

TEST(Job, FinishedImagesTellWhatTheyShow) {
  JobSettings settings = settings_for(3);
  settings.record.program = "test";
  Job job(room_with("path"), settings);
  job.run();
  const Image image = job.finished_image();
  EXPECT_TRUE(same_bits(image, job.image()));
  EXPECT_EQ(std::get<int64_t>(*image.find_metadata("passes")), 3);
  EXPECT_EQ(std::get<int64_t>(*image.find_metadata("samples_per_pixel")), 6);
}

TEST(Job, GoesOnWithACheckpoint) {
  const std::string file = (std::filesystem::temp_directory_path() /
                            ("kaustik_job_" + std::to_string(::getpid()) + ".kpt"))
                               .string();
  JobSettings settings = settings_for(2);
  settings.checkpoint = file;
  settings.record.program = "test";
  settings.record.recipe.integrator = "path";
  Job first(room_with("photonmap"), settings);
  EXPECT_FALSE(first.run().checkpoint_failure);
  EXPECT_THROW(first.edit(room_with("path")), std::logic_error);

  JobSettings more = settings_for(5);
  more.checkpoint = file;
  more.begun = read_checkpoint(file);
  more.record = more.begun->record;
  JobSettings other = settings_for(5);
  other.begun = read_checkpoint(file);
  other.record = other.begun->record;
  Job second(room_with("photonmap"), std::move(more));
  EXPECT_EQ(second.run().report.passes, 5u);
  EXPECT_TRUE(same_bits(second.image(), rendered("path", 5)));
  EXPECT_EQ(read_checkpoint(file).film.pass_count(), 5u);
  std::filesystem::remove(file);

  Job strange(room_with("path", 24, "<shape type=\"sphere\"/>"), std::move(other));
  EXPECT_THROW(strange.run(), Error);

  JobSettings nowhere = settings_for(1);
  nowhere.checkpoint = "/nowhere/at/all.kpt";
  Job unwritten(room_with("path"), nowhere);
  EXPECT_TRUE(unwritten.run().checkpoint_failure);
  EXPECT_EQ(unwritten.film().pass_count(), 1u);
}

}  // namespace
}  // namespace kaustik
