// Scenes that change while they are rendered.

#include "kaustik/live/engine.h"

#include <gtest/gtest.h>

#include <thread>

#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"

namespace kaustik {
namespace {

using namespace test;
using namespace std::chrono_literals;

constexpr auto long_enough = 120s;

/// A room whose ball is at that height, by `path`.
Description room_with_ball(double height, int size = 24, const std::string& more = "") {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\">"
      "<float name=\"fov\" value=\"45\"/><transform name=\"to_world\"><lookat origin=\"0,-4,2\" "
      "target=\"0,0,0.5\" up=\"0,0,1\"/></transform>" +
          film_of(size, size) + "</sensor>" + room +
          "<shape type=\"sphere\"><float name=\"radius\" value=\"0.3\"/><point name=\"center\" "
          "x=\"1\""
          " y=\"0\" z=\"" +
          std::to_string(height) + "\"/></shape>" + more + "</scene>",
      "test.xml", "");
}

EngineSettings engine_settings(uint32_t passes) {
  EngineSettings settings;
  settings.session.passes = passes;
  settings.session.samples_per_pass = 1;
  settings.session.threads = 2;
  settings.snapshot_interval_s = 0;
  return settings;
}

/// What a job makes of it.
Image by_job(Description description, uint32_t passes) {
  JobSettings settings;
  settings.session = engine_settings(passes).session;
  Job job(std::move(description), std::move(settings));
  job.run();
  return job.image();
}

TEST(Engine, RendersWhatAJobDoes) {
  Engine engine(engine_settings(4));
  EXPECT_EQ(engine.status().state, EngineState::idle);
  EXPECT_EQ(engine.snapshot(), nullptr);
  EXPECT_EQ(engine.edit(room_with_ball(0.5)), 1u);
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  const EngineStatus status = engine.status();
  EXPECT_EQ(status.state, EngineState::finished);
  EXPECT_EQ(status.revision, 1u);
  EXPECT_FALSE(status.failure);
  const auto last = engine.snapshot();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->kind, Snapshot::Kind::passes);
  EXPECT_EQ(last->passes, 4u);
  EXPECT_TRUE(same_bits(last->picture, by_job(room_with_ball(0.5), 4)));
}

/// Seen from there, by `path`.
Description room_seen_from(const std::string& origin) {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\">"
      "<transform name=\"to_world\"><lookat origin=\"" +
          origin + "\" target=\"0,0,0.5\" up=\"0,0,1\"/></transform>" + film_of(24, 24) +
          "</sensor>" + room + "</scene>",
      "test.xml", "");
}

EngineSettings moving_settings(uint32_t passes, double rest_s) {
  EngineSettings settings = engine_settings(passes);
  settings.moving = recipe_of_moving_views();
  settings.rest_s = rest_s;
  return settings;
}

// While the camera moves another recipe holds.
TEST(Engine, ShowsViewsThatMoveByAnotherRecipe) {
  Engine engine(moving_settings(4, infinity));
  uint64_t number = 0;
  for (const char* origin : {"0,-4,2", "0.2,-4,2", "0.4,-4,2"}) {
    const uint64_t revision = engine.edit(room_seen_from(origin));
    engine.start();
    while (const auto next = engine.wait_for_snapshot(number, long_enough)) {
      number = next->number;
      EXPECT_TRUE(next->is_moving);
      if (next->revision == revision && next->kind != Snapshot::Kind::preview) break;
    }
  }
}

// Once it rests the picture is what it always is, whatever came between.
TEST(Engine, ViewsAtRestAreWhatTheyAlwaysAre) {
  Engine engine(moving_settings(4, 0.05));
  for (const char* origin : {"0,-4,2", "0.2,-4,2", "0.4,-4,2"}) {
    engine.edit(room_seen_from(origin));
    engine.start();
  }
  engine.stop();
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  const auto last = engine.snapshot();
  EXPECT_FALSE(last->is_moving);
  EXPECT_EQ(last->revision, 3u);
  EXPECT_TRUE(same_bits(last->picture, by_job(room_seen_from("0.4,-4,2"), 4)));
}

// However long the light takes: it is what the next move needs.
TEST(Engine, ShowsWhatMovesBeforeItRests) {
  // Whenever the scene is built it tells of this parameter: at rest when the view that moved has
  // been shown, and nothing is shown until that is built.
  const std::string unknown = "no_parameter_of_balls";
  const Engine* shown = nullptr;
  std::vector<std::shared_ptr<const Snapshot>> seen;
  const auto look = [&](const std::string& text) {
    if (text.find(unknown) != std::string::npos) seen.push_back(shown->snapshot());
  };
  EngineSettings settings = engine_settings(2);
  settings.moving = recipe_of_moving_views();
  settings.rest_s = 0.02;
  Engine engine(settings, {look, look});
  shown = &engine;
  engine.edit(room_with_ball(0.5, 24,
                             "<shape type=\"sphere\"><float name=\"" + unknown +
                                 "\" value=\"1\"/><float name=\"radius\" value=\"0.1\"/></shape>"));
  const auto start = std::chrono::steady_clock::now();
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_FALSE(engine.snapshot()->is_moving);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0], nullptr);
  // It would not be waited for longer.
  if (std::chrono::steady_clock::now() - start > 10s) GTEST_SKIP() << "the machine is too busy";
  ASSERT_NE(seen[1], nullptr);
  EXPECT_TRUE(seen[1]->is_moving);
  EXPECT_NE(seen[1]->kind, Snapshot::Kind::preview);
}

// What views at rest keep of light is their own: the next move has that of the move before.
TEST(Engine, MovesAgainWithTheSameLight) {
  EngineSettings settings = engine_settings(1);
  settings.moving = recipe_of_moving_views();
  settings.rest_s = 0.05;
  Engine engine(settings);
  uint64_t number = 0;
  for (const char* origin : {"0,-4,2", "0.2,-4,2"}) {
    Description description = room_seen_from(origin);
    override_integrator(description, "photonmap");
    const uint64_t revision = engine.edit(description);
    engine.start();
    int previews = 0;
    bool has_moved = false;
    while (const auto next = engine.wait_for_snapshot(number, long_enough)) {
      number = next->number;
      if (next->revision != revision) continue;
      previews += next->kind == Snapshot::Kind::preview ? 1 : 0;
      has_moved |= next->is_moving;
      if (!next->is_moving) break;
    }
    EXPECT_TRUE(has_moved);
    EXPECT_EQ(previews > 0, revision == 1);
    ASSERT_TRUE(engine.wait_until_done(long_enough));
  }
}

// What is shown of a camera at rest is never less than what was seen while it moved.
TEST(Engine, GoesFromMovingToRestByWholePasses) {
  Engine engine(moving_settings(2, 0.3));
  engine.edit(room_seen_from("0,-4,2"));
  engine.start();
  std::shared_ptr<const Snapshot> moving, next;
  while ((next = engine.wait_for_snapshot(next ? next->number : 0, long_enough)) && next->is_moving)
    moving = next;
  ASSERT_TRUE(next);
  if (moving && moving->kind != Snapshot::Kind::preview) {
    EXPECT_EQ(next->kind, Snapshot::Kind::passes);
  }
}

TEST(Engine, ARefusedRecipeOfMovingViewsLeavesTheViewAtRest) {
  EngineSettings settings = moving_settings(2, 0.05);
  settings.moving->settings.push_back(setting_from("integrator.nonsense=1", "test"));
  Engine engine(settings);
  engine.edit(room_seen_from("0,-4,2"));
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.status().state, EngineState::finished);
  EXPECT_TRUE(same_bits(engine.snapshot()->picture, by_job(room_seen_from("0,-4,2"), 2)));
}

TEST(Engine, TellsWhatItsFilmHolds) {
  EngineSettings settings = engine_settings(4);
  settings.layers_in_snapshots = false;
  Engine engine(settings);
  EXPECT_FALSE(engine.look_at_film([](const Film&) { FAIL(); }));
  EXPECT_FALSE(engine.finished_snapshot());
  EXPECT_EQ(engine.scene(), nullptr);
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  const Image whole = by_job(room_with_ball(0.5), 4);
  EXPECT_TRUE(
      engine.look_at_film([&](const Film& film) { EXPECT_TRUE(same_bits(film.image(), whole)); }));
  EXPECT_TRUE(same_bits(*engine.finished_snapshot(), whole));
  EXPECT_EQ(engine.scene()->film().crop_size.x, 24);
  const Image& picture = engine.snapshot()->picture;
  EXPECT_EQ(picture.find_channel("direct.R"), -1);
  EXPECT_EQ(picture.at(5, 5, 1), whole.at(5, 5, 1));
}

// Films of views that move take less memory, and are sooner added to.
TEST(Engine, KeepsNoLayersOfViewsThatMove) {
  EngineSettings settings = engine_settings(2);
  settings.moving = recipe_of_moving_views();
  settings.rest_s = 0.5;
  Engine engine(settings);
  engine.edit(room_seen_from("0,-4,2"));
  engine.start();
  bool has_moved = false;
  uint64_t number = 0;
  while (const auto next = engine.wait_for_snapshot(number, long_enough)) {
    number = next->number;
    if (!next->is_moving) break;
    has_moved = true;
    EXPECT_EQ(next->picture.find_channel("direct.R"), -1);
  }
  EXPECT_TRUE(has_moved);
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_GE(engine.snapshot()->picture.find_channel("direct.R"), 0);
}

TEST(Engine, NumbersItsSnapshots) {
  Engine engine(engine_settings(6));
  EXPECT_EQ(engine.wait_for_snapshot(0, 1ms), nullptr);
  engine.edit(room_with_ball(0.5));
  engine.start();
  uint64_t number = 0;
  uint32_t passes = 0;
  while (const auto next = engine.wait_for_snapshot(number, long_enough)) {
    EXPECT_GT(next->number, number);
    EXPECT_GE(next->passes, passes);
    number = next->number;
    passes = next->passes;
    if (passes == 6) break;
  }
  EXPECT_EQ(passes, 6u);
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.wait_for_snapshot(engine.snapshot()->number, 1ms), nullptr);
}

TEST(Engine, ShowsTheLastOfManyEdits) {
  Engine engine(engine_settings(3));
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(engine.wait_for_snapshot(0, long_enough));
  for (int i = 0; i < 50; ++i) engine.edit(room_with_ball(0.5 + 0.01 * i));
  EXPECT_EQ(engine.edit(room_with_ball(1.5)), 52u);
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.status().revision, 52u);
  EXPECT_EQ(engine.snapshot()->revision, 52u);
  EXPECT_TRUE(same_bits(engine.snapshot()->picture, by_job(room_with_ball(1.5), 3)));
}

/// Looks at the engine until it is so; fails after long_enough.
template <typename Predicate>
testing::AssertionResult comes_to(const Engine& engine, const Predicate& predicate) {
  const auto end = std::chrono::steady_clock::now() + long_enough;
  while (!predicate(engine.status())) {
    if (std::chrono::steady_clock::now() > end) return testing::AssertionFailure() << "in vain";
    std::this_thread::sleep_for(1ms);
  }
  return testing::AssertionSuccess();
}
bool is_paused(const EngineStatus& status) { return status.state == EngineState::paused; }

/// The picture before goes on with all of its passes, as if nothing had been said.
TEST(Engine, ARefusedEditHarmsNothing) {
  Engine engine(engine_settings(40));
  engine.pause();
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(comes_to(engine, is_paused));
  const uint64_t refused = engine.edit(room_with_ball(
      0.5, 24, "<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>"));
  ASSERT_TRUE(comes_to(engine, [](const EngineStatus& status) { return bool(status.refusal); }));
  ASSERT_TRUE(comes_to(engine, is_paused));
  engine.resume();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  const EngineStatus status = engine.status();
  EXPECT_EQ(status.state, EngineState::finished);
  EXPECT_EQ(status.revision, 1u);
  EXPECT_EQ(status.refused_revision, refused);
  EXPECT_FALSE(status.failure);
  ASSERT_TRUE(status.refusal) << "it is still told";
  try {
    std::rethrow_exception(status.refusal);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("radius"), std::string::npos) << error.what();
  }
  EXPECT_EQ(engine.snapshot()->passes, 40u);
  EXPECT_TRUE(same_bits(engine.snapshot()->picture, by_job(room_with_ball(0.5), 40)));
  // The next one is taken, and the refusal is forgotten.
  engine.edit(room_with_ball(1));
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_FALSE(engine.status().refusal);
  EXPECT_EQ(engine.snapshot()->revision, 3u);
}

TEST(Engine, AFirstEditThatIsRefusedFails) {
  Engine engine(engine_settings(2));
  EXPECT_THROW(engine.start(), std::logic_error);
  engine.edit(room_with_ball(
      0.5, 24, "<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>"));
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.status().state, EngineState::failed);
  EXPECT_TRUE(engine.status().refusal);
  EXPECT_EQ(engine.snapshot(), nullptr);
  engine.stop();
  ASSERT_TRUE(comes_to(
      engine, [](const EngineStatus& status) { return status.state == EngineState::idle; }));
}

/// Whoever reads the description while it is rendered sees it as it was.
TEST(Engine, LeavesTheDescriptionAsItIs) {
  EngineSettings settings = engine_settings(2);
  settings.recipe.settings.push_back({"film", "width", "10", "test"});
  Engine engine(settings);
  const Description description = room_with_ball(0.5);
  for (int i = 0; i < 2; ++i) {
    engine.edit(description);
    engine.start();
    ASSERT_TRUE(engine.wait_until_done(long_enough));
    EXPECT_EQ(engine.snapshot()->picture.width(), 10);
  }
  EXPECT_TRUE(same_bits(by_job(description, 2), by_job(room_with_ball(0.5), 2)));
}

/// Pauses cost nothing but time, wherever they come.
TEST(Engine, RestsWithoutChangingBits) {
  for (const char* integrator : {"path", "photonmap", "vcm", "lighttracer"}) {
    EngineSettings settings = engine_settings(30);
    settings.session.samples_per_pass = 3;
    settings.recipe.integrator = integrator;
    if (integrator == std::string("photonmap"))
      for (const char* count : {"caustic_photons", "global_photons"})
        settings.recipe.settings.push_back({"integrator", count, "3000", "test"});
    JobSettings job_settings;
    job_settings.session = settings.session;
    job_settings.record.recipe = settings.recipe;
    Job job(room_with_ball(0.5), std::move(job_settings));
    job.run();
    Engine engine(settings);
    engine.pause();
    engine.edit(room_with_ball(0.5));
    engine.start();
    ASSERT_TRUE(comes_to(engine, is_paused)) << integrator;
    EXPECT_FALSE(engine.wait_until_done(5ms));
    EXPECT_EQ(engine.status().progress.passes_done, 0u) << integrator;
    for (int i = 0; i < 100 && !engine.wait_until_done(1ms); ++i) {
      engine.resume();
      engine.wait_until_done(1ms);
      engine.pause();
      engine.snapshot();
    }
    engine.resume();
    ASSERT_TRUE(engine.wait_until_done(long_enough));
    EXPECT_TRUE(same_bits(engine.snapshot()->picture, job.image())) << integrator;
  }
}

TEST(Engine, IsEditedAndStoppedWhileItRests) {
  Engine engine(engine_settings(50));
  engine.pause();
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(comes_to(engine, is_paused));
  engine.edit(room_with_ball(1));
  ASSERT_TRUE(comes_to(engine, [](const EngineStatus& status) { return status.revision == 2; }));
  engine.stop();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.status().state, EngineState::idle);
  engine.resume();
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.snapshot()->passes, 50u);
  EXPECT_EQ(engine.snapshot()->revision, 2u);
}

TEST(Engine, StopsAndBeginsAnew) {
  Engine engine(engine_settings(1'000'000));
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(engine.wait_for_snapshot(2, long_enough));
  engine.stop();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  const auto last = engine.snapshot();
  EXPECT_EQ(engine.wait_for_snapshot(last->number, 20ms), nullptr);
  engine.start();
  EXPECT_TRUE(engine.wait_for_snapshot(last->number, long_enough));
  // Its destruction ends what goes on.
}

/// Who starts what is rendered already loses nothing.
TEST(Engine, IsStartedTwice) {
  Engine engine(engine_settings(1'000'000));
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(comes_to(
      engine, [](const EngineStatus& status) { return status.progress.passes_done > 20; }));
  engine.start();
  EXPECT_FALSE(engine.wait_until_done(20ms));
  EXPECT_GT(engine.status().progress.passes_done, 20u);
}

/// While edits keep coming there is something to be seen of them.
TEST(Engine, ShowsSomethingWhileEditsKeepComing) {
  Engine engine(engine_settings(1'000'000));
  engine.edit(room_with_ball(0.5));
  engine.start();
  const auto end = std::chrono::steady_clock::now() + long_enough;
  std::shared_ptr<const Snapshot> shown;
  for (int i = 0; !(shown && shown->revision > 3) && std::chrono::steady_clock::now() < end; ++i) {
    engine.edit(room_with_ball(0.5 + 0.001 * i));
    std::this_thread::sleep_for(1ms);
    shown = engine.snapshot();
  }
  ASSERT_TRUE(shown);
  EXPECT_GT(shown->revision, 3u);
}

/// Until that holds; false after a long time.
bool wait_for(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + long_enough;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

TEST(Engine, GivesRegionsMorePasses) {
  EngineSettings settings = engine_settings(0);
  settings.session.is_endless = true;
  Engine engine(settings);
  const RegionRequest request{{3, 4, 10, 9}, 6};
  EXPECT_FALSE(engine.can_refine());
  EXPECT_THROW(engine.refine(request), Error);
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(wait_for([&] { return engine.can_refine(); }));
  EXPECT_THROW(engine.refine({{20, 20, 10, 9}, 6}), Error);
  // There need not be a job that has a session yet.
  ASSERT_TRUE(wait_for([&] { return engine.look_at_film([](const Film&) {}); }));
  engine.pause();
  engine.refine(request);
  ASSERT_EQ(engine.status().regions.size(), 1u);
  const uint64_t shown = engine.snapshot() ? engine.snapshot()->number : 0;
  engine.resume();
  ASSERT_TRUE(wait_for([&] { return engine.status().regions[0].waiting == 0; }));
  EXPECT_EQ(engine.status().regions[0].passes, 6u);
  EXPECT_TRUE(engine.look_at_film([&](const Film& film) {
    ASSERT_EQ(film.regions().size(), 1u);
    EXPECT_TRUE(film.regions()[0].pixels == request.pixels);
    EXPECT_EQ(film.pass_count(5 * 24 + 5), film.pass_count() + 6);
  }));
  ASSERT_NE(engine.wait_for_snapshot(shown, 60s), nullptr);
  const auto saved = engine.finished_snapshot();
  ASSERT_TRUE(saved);
  ASSERT_NE(saved->find_metadata("regions"), nullptr);
  // An edit makes another picture.
  engine.edit(room_with_ball(0.6));
  ASSERT_TRUE(wait_for([&] { return engine.status().revision == 2; }));
  EXPECT_TRUE(engine.status().regions.empty());
  engine.stop();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_THROW(engine.refine(request), Error);
}

TEST(Engine, ViewsThatMoveHaveNoRegions) {
  EngineSettings settings = engine_settings(0);
  settings.session.is_endless = true;
  settings.moving = recipe_of_moving_views();
  settings.rest_s = 1e5;
  Engine engine(settings);
  engine.edit(room_with_ball(0.5));
  engine.start();
  ASSERT_TRUE(engine.wait_for_snapshot(0, 60s));
  EXPECT_FALSE(engine.can_refine());
  EXPECT_THROW(engine.refine({{3, 4, 10, 9}, 6}), Error);
}

TEST(Engine, IsDestroyedWhileItBuildsAndRests) {
  for (int i = 0; i < 10; ++i) {
    Engine engine(engine_settings(1'000'000));
    if (i % 2) engine.pause();
    engine.edit(room_with_ball(0.5));
    engine.start();
    if (i > 5) engine.wait_for_snapshot(0, 2ms);
    if (i % 3 == 0) engine.edit(room_with_ball(1));
  }
}

TEST(Engine, IsCommandedByManyThreads) {
  Engine engine(engine_settings(30));
  engine.edit(room_with_ball(0.5, 12));
  engine.start();
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&engine, k] {
      for (int i = 0; i < 30; ++i) {
        if (k == 0) engine.edit(room_with_ball(0.5 + 0.01 * i, 12));
        if (k == 1) i % 2 ? engine.pause() : engine.resume();
        if (k == 2) i % 7 ? engine.start() : engine.stop();
        engine.status();
        engine.snapshot();
        engine.wait_for_snapshot(uint64_t(i), 1ms);
      }
    });
  for (std::thread& thread : threads) thread.join();
  engine.resume();
  engine.start();
  ASSERT_TRUE(engine.wait_until_done(long_enough));
  EXPECT_EQ(engine.status().state, EngineState::finished);
  EXPECT_EQ(engine.snapshot()->passes, 30u);
}

}  // namespace
}  // namespace kaustik
