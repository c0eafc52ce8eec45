// Numbers and machines at their ends: the program says what is wrong, and never ends by a signal.

#include <fmt/format.h>

#include "kaustik/base/processors.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Extremes : public ProgramTest {};

#ifndef KAUSTIK_SLOW_BUILD
TEST_F(Extremes, LittleMemoryIsToldWhereverItRunsOut) {
  write("scene.xml", small_scene());
  int ended = 0, told = 0;
  // From less than the program's own libraries take to enough: each thread takes some, too.
  const rlim_t most = 400 + 100 * rlim_t(usable_processors());
  for (rlim_t megabytes = 140; megabytes <= 400 || (ended == 0 && megabytes <= most);
       megabytes += megabytes < 400 ? 4 : megabytes / 16) {
    RunOptions options;
    options.memory_limit = megabytes << 20;
    const RunResult result = run({"info", "scene.xml"}, options);
    SCOPED_TRACE(fmt::format("{} MB: {}", megabytes, result.err));
    if (result.exit_code == 127) continue;  // its libraries did not fit
    EXPECT_NE(result.exit_code, -1);
    EXPECT_FALSE(contains(result.err, "terminate"));
    EXPECT_FALSE(contains(result.err, "processor"));
    ++(result.exit_code == 0 ? ended : told);
  }
  EXPECT_GT(ended, 0);
  EXPECT_GT(told, 0);
}
#endif

TEST_F(Extremes, TimesThatNobodyWaitsForAreRefused) {
  write("scene.xml", small_scene());
  for (const char* every : {"9.3e9s", "1e300", "1e300h"}) {
    const RunResult result =
        run({"render", "scene.xml", "-q", "--spp", "1", "-D", "size=4", "--checkpoint",
             std::string(every) + ".kpt", "--every", every, "-o", std::string(every) + ".pfm"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "up to 30 years")) << result.err;
  }
}

TEST_F(Extremes, WhatFloatsCannotCarryIsRefusedWithItsPlace) {
  const auto expect = [&](const std::string& inside, const std::string& message) {
    write("scene.xml", scene_with({inside}));
    const RunResult result = run({"render", "scene.xml", "-q", "--spp", "1", "-o", "a.pfm"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "scene.xml:2:")) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
  };
  expect(R"(<emitter type="point"><point name="position" value="2, -1e30, 1e6"/></emitter>)",
         "'position' is -1e+30");
  expect(
      R"(<shape type="sphere"><float name="radius" value="1e18"/><emitter type="area"/></shape>)",
      "'radius' is 1e+18");
  expect(R"(<medium type="homogeneous"><float name="scale" value="1e-38"/></medium>)", "too small");
}

}  // namespace
}  // namespace kaustik::test
