// Regions that a session is asked for: which requests it takes, and when it renders them.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/render/region_testing.h"

namespace kaustik {
namespace {

using namespace test;

TEST(Regions, BadRequestsAreRefused) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(1));
  for (const RegionRequest& bad :
       std::vector<RegionRequest>{{{0, 0, 4, 4}, 0},
                                  {{0, 0, 4, 4}, most_region_passes + 1},
                                  {{-1, 0, 4, 4}, 1},
                                  {{0, 0, 25, 4}, 1},
                                  {{20, 0, 5, 1}, 1},
                                  {{0, 23, 1, 2}, 1},
                                  {{24, 0, 1, 1}, 1},
                                  {{0, 0, 0, 1}, 1},
                                  {{2147483647, 2147483647, 2147483647, 2147483647}, 1}})
    EXPECT_THROW((void)session.refine(bad), Error) << bad.pixels.text();
  EXPECT_TRUE(session.regions().empty());
  EXPECT_TRUE(session.refine({floor_region, most_region_passes}));
  EXPECT_THROW((void)session.refine({floor_region, 1}), Error);
  // Four times the picture, and no more.
  Session many(ball().scene(), *integrator, refined_settings(1));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(many.refine({{0, 0, 24, 24 - i}, 1}));
  EXPECT_TRUE(many.refine({{0, 0, 24, 3}, 1}));
  EXPECT_THROW((void)many.refine({{0, 0, 24, 5}, 1}), Error);
  EXPECT_TRUE(many.refine({{0, 0, 24, 3}, 1}));
  EXPECT_EQ(many.regions().size(), 5u);
}

TEST(Regions, WaitForThePictureAndEndWithIt) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(3, {{floor_region, 2}}));
  std::vector<std::pair<uint32_t, uint32_t>> seen;
  const SessionReport report = session.run({}, {}, [&] {
    seen.emplace_back(session.film().pass_count(), session.film().regional_pass_count());
  });
  using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;
  EXPECT_EQ(seen, (Pairs{{1, 0}, {1, 1}, {1, 2}, {2, 2}, {3, 2}}));
  EXPECT_EQ(report.passes, 3u);
  EXPECT_EQ(report.regional_passes, 2u);
  EXPECT_EQ(report.end, SessionEnd::passes);
  // Nobody would take them.
  EXPECT_FALSE(session.refine({floor_region, 4}));
  EXPECT_EQ(session.regions()[0].waiting, 0u);
}

TEST(Regions, AskedForAfterTheLastPassAreRendered) {
  const auto integrator = integrator_of("path");
  Session session(ball().scene(), *integrator, refined_settings(2));
  session.run({}, {}, [&] {
    if (session.film().pass_count() == 2 && session.film().regions().empty()) {
      EXPECT_TRUE(session.refine({floor_region, 4}));
    }
  });
  EXPECT_EQ(session.film().pass_count(), 2u);
  EXPECT_EQ(session.film().regional_pass_count(), 4u);
}

// Whoever asks as it ends gets what was promised, or a no.
TEST(Regions, NoneIsLostAtTheEnd) {
  const auto integrator = integrator_of("path");
  uint32_t refused = 0;
  for (int i = 0; i < 20; ++i) {
    Session session(ball().scene(), *integrator, refined_settings(1));
    std::atomic<bool> has_pass = false;
    uint32_t taken = 0;
    std::thread asking([&] {
      while (!has_pass) std::this_thread::yield();
      while (taken < 50 && session.refine({{3, 20, 2, 2}, 1})) ++taken;
    });
    session.run({}, {}, [&] { has_pass = true; });
    asking.join();
    refused += taken < 50 ? 1 : 0;
    ASSERT_EQ(session.film().regional_pass_count(), taken);
  }
  EXPECT_GT(refused, 0u);
}

TEST(Regions, ProgressNeverFallsBack) {
  const auto integrator = integrator_of("path");
  // Beside passes of the picture, then by themselves.
  std::optional<Film> film;
  for (int run = 0; run < 2; ++run) {
    SessionSettings settings = refined_settings(4, {{{0, 0, 24, 20}, 20}});
    // Time flies, so that every tile is told.
    settings.clock = [begin = std::chrono::steady_clock::now()] {
      return 1e4 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    Session session = film ? Session(ball().scene(), *integrator, settings, std::move(*film))
                           : Session(ball().scene(), *integrator, settings);
    std::vector<double> fractions;
    session.run({}, [&](const Progress& progress) { fractions.push_back(progress.fraction); });
    ASSERT_GT(fractions.size(), 10u);
    // Passes of the region that counted as some of the picture would go up and back by a fifth; a
    // better guess of what light passes take moves it by less.
    for (size_t i = 1; i < fractions.size(); ++i)
      EXPECT_GE(fractions[i], fractions[i - 1] - 0.06) << run << ": " << i;
    EXPECT_LT(fractions.front(), 0.1);
    EXPECT_GT(fractions[fractions.size() - 2], 0.85);
    EXPECT_EQ(fractions.back(), 1);
    EXPECT_EQ(session.film().regional_pass_count(), 20u * unsigned(run + 1));
    film = session.film();
  }
}

}  // namespace
}  // namespace kaustik
