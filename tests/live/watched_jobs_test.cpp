// Jobs that somebody else runs, as those who watch see them.
#include "kaustik/live/watched_jobs.h"

#include <gtest/gtest.h>

#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/film.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik::test {
namespace {

using namespace std::chrono_literals;

Description small_room() {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\">"
      "<float name=\"fov\" value=\"45\"/><transform name=\"to_world\"><lookat origin=\"0,-4,2\" "
      "target=\"0,0,0.5\" up=\"0,0,1\"/></transform>" +
          film_of(12, 10) + "</sensor>" + room + "</scene>",
      "test.xml", "");
}

/// A job and its course, as an owner notes it.
struct OwnedJob {
  explicit OwnedJob(uint32_t passes) : gate(std::make_shared<Gate>()) {
    JobSettings settings;
    settings.session.passes = passes;
    settings.session.samples_per_pass = 1;
    settings.session.threads = 2;
    settings.session.gate = gate;
    JobListener listener;
    listener.progress = [this](const Progress& progress) {
      const std::lock_guard lock(mutex);
      course.progress = progress;
    };
    listener.ended = [this](const std::exception_ptr& failure) {
      const std::lock_guard lock(mutex);
      course.failure = failure;
      course.has_ended = true;
    };
    job = std::make_shared<Job>(small_room(), std::move(settings), std::move(listener));
  }
  JobCourse now() {
    const std::lock_guard lock(mutex);
    course.is_paused = gate->is_closed();
    return course;
  }

  std::mutex mutex;
  JobCourse course;
  std::shared_ptr<Gate> gate;
  std::shared_ptr<Job> job;
};

TEST(WatchedJobs, NothingIsShownBefore) {
  const WatchedJobs watched;
  EXPECT_EQ(watched.status().state, EngineState::idle);
  EXPECT_EQ(watched.status().revision, 0u);
  EXPECT_EQ(watched.wait_for_snapshot(0, 0ms), nullptr);
  EXPECT_EQ(watched.scene(), nullptr);
  EXPECT_FALSE(watched.look_at_film([](const Film&) {}));
  EXPECT_FALSE(watched.finished_snapshot());
}

TEST(WatchedJobs, ShowsTheFilmOfTheJob) {
  OwnedJob owned(3);
  WatchedJobs watched;
  EXPECT_EQ(watched.show(owned.job, [&] { return owned.now(); }), 1u);
  // Its scene is not built yet.
  EXPECT_EQ(watched.status().state, EngineState::building);
  EXPECT_EQ(watched.scene(), nullptr);
  owned.job->run();
  const auto snapshot = watched.wait_for_snapshot(0, 20s);
  ASSERT_TRUE(snapshot);
  EXPECT_EQ(snapshot->kind, Snapshot::Kind::passes);
  EXPECT_EQ(snapshot->passes, 3u);
  EXPECT_EQ(snapshot->revision, 1u);
  EXPECT_EQ(watched.scene(), owned.job->shared_scene());
  EXPECT_EQ(snapshot->scene, watched.scene());
  const Film* shown = nullptr;
  EXPECT_TRUE(watched.look_at_film([&](const Film& film) { shown = &film; }));
  EXPECT_EQ(shown, &owned.job->film());
  EXPECT_TRUE(same_bits(snapshot->picture, *owned.job->snapshot(false)));
  const EngineStatus status = watched.status();
  EXPECT_EQ(status.state, EngineState::finished);
  EXPECT_EQ(status.progress.passes_done, 3u);
  EXPECT_FALSE(status.failure);
  // Nothing new comes.
  EXPECT_EQ(watched.wait_for_snapshot(snapshot->number, 0ms), nullptr);

  OwnedJob next(2);
  EXPECT_EQ(watched.show(next.job, [&] { return next.now(); }), 2u);
  next.job->run();
  const auto later = watched.wait_for_snapshot(snapshot->number, 20s);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->revision, 2u);
  EXPECT_EQ(later->passes, 2u);
  EXPECT_GT(later->number, snapshot->number);
}

TEST(WatchedJobs, PausedAndCancelled) {
  OwnedJob owned(1u << 28);
  WatchedJobs watched;
  watched.show(owned.job, [&] { return owned.now(); });
  owned.job->start();
  const auto first = watched.wait_for_snapshot(0, 20s);
  ASSERT_TRUE(first);
  owned.gate->close();
  EXPECT_EQ(watched.status().state, EngineState::paused);
  owned.gate->open();
  EXPECT_EQ(watched.status().state, EngineState::rendering);
  EXPECT_TRUE(watched.wait_for_snapshot(first->number, 20s));
  owned.job->cancel();
  owned.job->wait();
  EXPECT_EQ(watched.status().state, EngineState::finished);
}

}  // namespace
}  // namespace kaustik::test
