// Several processes that share a picture's passes: the same bits as of one. Here they are threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "kaustik/render/film_reduction.h"
#include "kaustik/render/job.h"
#include "kaustik/render/team_messages.h"
#include "tests/support/counted_clock.h"
#include "tests/support/film.h"
#include "tests/support/local_team.h"
#include "tests/support/same_bits.h"
#include "tests/support/scripted_integrator.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

Description team_room(const std::string& integrator) {
  return parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><integrator type=\"" + integrator +
          "\"/><sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/>"
          "<transform name=\"to_world\"><lookat origin=\"0,-4,2\" target=\"0,0,0.5\" "
          "up=\"0,0,1\"/></transform>" +
          film_of(12, 12) + "</sensor>" + room + "</scene>",
      "test.xml", "");
}

/// What the leader has in the end.
struct Outcome {
  Image image;
  Lessons lessons;
  SessionReport report;
};

class TeamTest : public testing::Test {
 protected:
  static JobSettings settings_of(uint32_t passes) {
    JobSettings settings;
    settings.session.passes = passes;
    settings.session.samples_per_pass = 2;
    settings.session.threads = 1;
    settings.keeps_passes = true;
    return settings;
  }

  static Outcome outcome_of(Job& job) {
    Outcome outcome;
    outcome.report = job.run().report;
    outcome.image = job.image();
    outcome.lessons = job.checkpoint().lessons;
    return outcome;
  }

  static Outcome alone(const std::string& integrator, JobSettings settings) {
    Job job(team_room(integrator), std::move(settings));
    return outcome_of(job);
  }

  static Outcome together(uint32_t members, const std::string& integrator,
                          const JobSettings& settings) {
    Outcome outcome;
    LocalTeam(members).run([&](const std::shared_ptr<Team>& member) {
      JobSettings own = settings;
      own.session.team = member;
      Job job(team_room(integrator), std::move(own));
      if (member->is_led_here())
        outcome = outcome_of(job);
      else
        job.run();
    });
    return outcome;
  }

  TemporaryFolder folder_;
};

class TeamBits : public TeamTest, public testing::WithParamInterface<const char*> {};

TEST_P(TeamBits, AreThoseOfOne) {
  // Beyond several epochs, and not a multiple of the members.
  const JobSettings settings = settings_of(21);
  const Outcome one = alone(GetParam(), settings);
  for (const uint32_t members : {1, 2, 3, 4, 7}) {
    const Outcome all = together(members, GetParam(), settings);
    EXPECT_TRUE(same_bits(all.image, one.image)) << members;
    EXPECT_EQ(all.lessons, one.lessons) << members;
    EXPECT_EQ(all.report.passes, 21u);
    EXPECT_EQ(all.report.end, SessionEnd::passes);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, TeamBits,
                         testing::Values("path", "auto", "bdpt", "ppm", "photonmap"));

TEST_F(TeamTest, StopsWhereOneWouldByItsError) {
  JobSettings settings = settings_of(0);
  settings.session.passes.reset();
  settings.session.error = 0.2;
  const Outcome one = alone("path", settings);
  ASSERT_EQ(one.report.end, SessionEnd::error);
  const Outcome all = together(3, "path", settings);
  EXPECT_EQ(all.report.end, SessionEnd::error);
  EXPECT_EQ(all.report.passes, one.report.passes);
  EXPECT_TRUE(same_bits(all.image, one.image));
}

TEST_F(TeamTest, GoesOnWithACheckpointOfAnyNumber) {
  const Outcome one = alone("auto", settings_of(13));
  JobSettings begin = settings_of(5);
  begin.checkpoint = folder_.path("a.kpt");
  begin.every_s = 0;
  together(3, "auto", begin);
  Checkpoint begun = read_checkpoint(folder_.path("a.kpt"));
  EXPECT_EQ(begun.film.passes().text(), "0–4");
  EXPECT_EQ(begun.lessons.passes, 5u);
  JobSettings more = settings_of(13);
  more.record = begun.record;
  more.begun = std::move(begun);
  EXPECT_TRUE(same_bits(together(2, "auto", more).image, one.image));
}

/// Half a second a pass, by clocks of their own.
TEST_F(TeamTest, WhoDiesTakesNoMoreThanTheInterval) {
  constexpr double interval_s = 10, pass_s = 0.5;
  const auto scene = scene_with(film_of(64, 4), room);
  std::vector<double> moments{0};
  double end_s = 0;
  LocalTeam(3).run([&](const std::shared_ptr<Team>& member) {
    CountedClock clock;
    Script script;
    script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
      clock.advance(0.5);
      sink.add(Component::direct, Spectrum(2));
    };
    SessionSettings settings = settings_of(300).session;
    settings.samples_per_pass = 4;
    settings.clock = clock.reader();
    settings.team = member;
    settings.team_interval_s = interval_s;
    const Scripted integrator(script);
    Session session(*scene, integrator, settings);
    session.run({}, {}, [&] {
      if (member->is_led_here()) moments.push_back(clock.reader()());
    });
    if (member->is_led_here()) end_s = clock.reader()();
  });
  EXPECT_DOUBLE_EQ(moments.back(), end_s);
  EXPECT_GE(moments.size(), 5u);
  for (size_t i = 1; i < moments.size(); ++i)
    EXPECT_LE(moments[i] - moments[i - 1], interval_s + pass_s) << i;
}

/// Every other pass takes nine times as long, and is twice as bright: none is left out for that.
TEST_F(TeamTest, TimeEndsItWithoutBias) {
  const auto scene = scene_with(film_of(64, 4), room);
  LocalTeam(3).run([&](const std::shared_ptr<Team>& member) {
    CountedClock clock;
    uint32_t index = 0;
    Script script;
    script.prepare = [&](const Pass& pass, SplatBuffer&) { index = pass.index; };
    script.sample = [&](const Vec2f&, Sampler&, SampleSink& sink) {
      clock.advance(index % 2 == 0 ? 0.5 : 4.5);
      sink.add(Component::direct, Spectrum(index % 2 == 0 ? 1 : 2));
    };
    SessionSettings settings;
    settings.threads = 1;
    settings.samples_per_pass = 4;
    settings.clock = clock.reader();
    settings.team = member;
    settings.seconds = 60;
    const Scripted integrator(script);
    Session session(*scene, integrator, settings);
    const SessionReport report = session.run();
    if (!member->is_led_here()) return;
    EXPECT_EQ(report.end, SessionEnd::time);
    const PassSet passes = session.film().passes();
    ASSERT_EQ(passes.ranges().size(), 1u);
    EXPECT_EQ(passes.ranges()[0].begin, 0u);
    const uint32_t count = passes.count();
    EXPECT_GT(count, 15u);
    EXPECT_LT(clock.reader()(), 66);
    const float mean = float(count + count / 2) / float(count);
    EXPECT_FLOAT_EQ(session.film().image().at(0, 0, 0), mean);
  });
}

TEST_F(TeamTest, OneWhoStopsStopsAll) {
  for (const uint32_t who : {0, 1, 2}) {
    Outcome outcome;
    LocalTeam(3).run([&](const std::shared_ptr<Team>& member) {
      JobSettings own = settings_of(1000000);
      own.session.team = member;
      Job job(team_room("path"), std::move(own));
      job.prepare();
      std::jthread other;
      if (member->rank() == who)
        other = std::jthread([&] {
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
          job.cancel();
        });
      if (member->is_led_here())
        outcome = outcome_of(job);
      else
        EXPECT_EQ(job.run().report.end, SessionEnd::cancelled);
    });
    EXPECT_EQ(outcome.report.end, SessionEnd::cancelled);
    EXPECT_LT(outcome.report.passes, 1000000u);
  }
}

TEST_F(TeamTest, OtherScenesAreRefused) {
  std::atomic<int> refused = 0;
  LocalTeam(3).run([&](const std::shared_ptr<Team>& member) {
    JobSettings own = settings_of(2);
    own.session.team = member;
    Job job(team_room(member->rank() == 2 ? "bdpt" : "path"), std::move(own));
    try {
      job.prepare();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("process 2 has another scene"), std::string::npos)
          << error.what();
      ++refused;
    }
  });
  EXPECT_EQ(refused, 3);
}

TEST_F(TeamTest, FilmsAreAddedUp) {
  const auto film_with = [](PassRange passes) {
    Film film(film_of_size(40, 19), {ComponentSet::all()});
    for (uint32_t pass = passes.begin; pass < passes.end; ++pass)
      film.add_pass(tiled(grey_pixels(float(1 + pass), size_t{40} * 19), film), pass, 2);
    return film;
  };
  const Film whole = film_with({0, 6});
  LocalTeam(3).run([&](const std::shared_ptr<Team>& member) {
    Film film = film_with({2 * member->rank(), 2 * member->rank() + 2});
    add_films(*member, film);
    if (!member->is_led_here()) {
      EXPECT_EQ(film.pass_count(), 0u);
      return;
    }
    EXPECT_EQ(film.passes().text(), "0–5");
    EXPECT_EQ(film.samples_per_pixel(), 12u);
    EXPECT_TRUE(same_bits(film.image(), whole.image()));
  });
}

TEST(TeamMessages, ComeBackAsTheyWere) {
  TeamOrder order{TeamOrder::Kind::render, SessionEnd::time, {}, {2, 0, 2}, {3, {1, 2, 3}}};
  order.passes.add({2, 5});
  order.passes.add({9, 10});
  const TeamOrder read = TeamOrder::from(order.bytes());
  EXPECT_EQ(read.kind, order.kind);
  EXPECT_EQ(read.end, order.end);
  EXPECT_EQ(read.lessons, order.lessons);
  EXPECT_EQ(read.of_member(0), (std::vector<uint32_t>{2, 3}));
  EXPECT_TRUE(read.of_member(1).empty());
  EXPECT_EQ(read.of_member(2), (std::vector<uint32_t>{4, 9}));
  std::vector<uint8_t> bytes = order.bytes();
  bytes.pop_back();
  EXPECT_THROW(TeamOrder::from(bytes), Error);

  TeamReport report;
  report.passes = {{4, {7, 8}}, {6, {}}};
  report.is_stopped = true;
  report.rays = 5;
  const TeamReport back = TeamReport::from(report.bytes());
  ASSERT_EQ(back.passes.size(), 2u);
  EXPECT_EQ(back.passes[0].taught, (std::vector<uint8_t>{7, 8}));
  EXPECT_EQ(back.passes[1].pass, 6u);
  EXPECT_TRUE(back.is_stopped);
  EXPECT_EQ(back.rays, 5u);
}

}  // namespace
}  // namespace kaustik
