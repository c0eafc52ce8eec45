// What signals leave: a right picture of however few samples, or the old file, and an exit code.
#include <algorithm>
#include <cmath>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

constexpr int ended_early = 75;

class Signals : public ProgramTest {
 protected:
  Signals() {
    write("scene.xml", small_scene());
    write("old.exr", "old");
  }
  /// A render that never ends by itself, stopped after a while.
  RunResult stopped(const std::vector<std::string>& options, RunOptions how) const {
    std::vector<std::string> words = {"render", "scene.xml", "-o", "old.exr"};
    words.insert(words.end(), options.begin(), options.end());
    if (how.interrupt_at.empty()) how.interrupt_at = "pass 0";
    return run(words, how);
  }
  double mean_of(const std::string& name) const {
    const Image image = read_image(path(name));
    double sum = 0;
    for (const float value : image.channel(image.find_channel("G"))) sum += double(value);
    return sum / double(image.pixel_count());
  }
  int64_t integer_of(const std::string& name, const std::string& key) const {
    return std::get<int64_t>(*read_image(path(name)).find_metadata(key));
  }
  /// What the program says of how well it knows the mean of a picture, relative; 0 if nothing.
  static double told_noise(const std::string& text) {
    const std::string start = "mean of the picture: ±";
    const size_t found = text.find(start);
    return found == std::string::npos ? 0 : std::stod(text.substr(found + start.size())) / 100;
  }
};

TEST_F(Signals, AnyOfThemKeepsWhatIsFinished) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    RunOptions how;
    how.terminal_columns = {120};  // where progress is told often
    how.interrupt_at = "pass [1-9]";
    how.signals = {signal, signal};  // as some send it: to the process and to its group
    const RunResult result = stopped({"--passes", "1000000", "--spp", "1000000"}, how);
    EXPECT_EQ(result.exit_code, ended_early) << result.err;
    EXPECT_TRUE(contains(result.err, "cancelled: writing what is finished")) << result.err;
    const Image image = read_image(path("old.exr"));
    EXPECT_EQ(image.find_metadata("incomplete"), nullptr);
    EXPECT_GT(std::get<int64_t>(*image.find_metadata("passes")), 0);
  }
}

TEST_F(Signals, AnotherOneEndsAtOnce) {
#ifdef KAUSTIK_THREAD_SANITIZER
  GTEST_SKIP() << "the thread sanitizer delivers signals late";
#endif
  RunOptions how;
  how.interrupt_delay_s = 0.1;
  how.signals = {SIGINT, SIGTERM};
  const RunResult result = stopped({"--passes", "1", "--spp", "100000000"}, how);
  // The system may deliver the later one first.
  EXPECT_TRUE(result.signal == SIGTERM || result.signal == SIGINT) << result.err;
  EXPECT_EQ(contents("old.exr"), "old");
}

// A script's background job is started with SIGINT ignored, and Ctrl-C is not meant for it.
TEST_F(Signals, WhatIsIgnoredStaysSo) {
  for (const auto& [ignored, other] :
       {std::pair(SIGINT, SIGTERM), std::pair(SIGHUP, SIGINT), std::pair(SIGTERM, SIGINT)}) {
    SCOPED_TRACE(ignored);
    RunOptions how;
    how.terminal_columns = {120};
    how.interrupt_at = "pass [1-9]";
    how.ignored_signal = ignored;
    how.signals = {ignored, ignored, other};  // would end at once if the first one counted
    const RunResult result = stopped({"--passes", "1000000", "--spp", "1000000"}, how);
    EXPECT_EQ(result.exit_code, ended_early) << result.signal << result.err;
  }
}

// The picture is the mean of the samples that were taken, or there is none.
TEST_F(Signals, TheFirstPassLeavesARightPictureOrTheOldOne) {
  for (const std::string integrator : {"path", "bdpt", "lighttracer", "auto"}) {
    SCOPED_TRACE(integrator);
    const std::vector<std::string> method = {"--integrator", integrator};
    std::vector<std::string> reference = {"render", "scene.xml", "--passes", "8",
                                          "--spp",  "32",        "-o",       "whole.exr"};
    reference.insert(reference.end(), method.begin(), method.end());
    const double noise = told_noise(run_well(reference).err);
    ASSERT_GT(noise, 0);
    const int64_t samples = integer_of("whole.exr", "samples_per_pixel");
    for (const double delay_s : {0.05, 0.4}) {
      write("old.exr", "old");
      RunOptions how;
      how.interrupt_delay_s = delay_s;
      std::vector<std::string> one_pass = {"--passes", "1", "--spp", "100000000"};
      one_pass.insert(one_pass.end(), method.begin(), method.end());
      const RunResult result = stopped(one_pass, how);
      EXPECT_EQ(result.exit_code, ended_early) << result.err;
      if (contents("old.exr") == "old") {
        EXPECT_TRUE(contains(result.err, "nothing is written")) << result.err;
        continue;
      }
      const Image image = read_image(path("old.exr"));
      EXPECT_NE(image.find_metadata("incomplete"), nullptr);
      const int64_t fewer = integer_of("old.exr", "samples_per_pixel");
      ASSERT_GE(fewer, 1);
      // Light paths are those of one pass of eight, however many the samples.
      const double more_noise = std::sqrt(std::max(8.0, double(samples) / double(fewer)));
      // Black parts, or splats of a part of the paths, would take more off than noise does: three
      // times what 95 % of pictures stay within.
      EXPECT_NEAR(mean_of("old.exr") / mean_of("whole.exr"), 1, 0.1 + 3 * noise * more_noise)
          << fewer << " samples";
    }
  }
}

TEST_F(Signals, HelpHasTheTableOfExitCodes) {
  EXPECT_TRUE(contains(run_well({"--help"}).out, "75    ended early"));
}

// The line that is kept up to date never goes over the terminal's edge, also after it has moved.
TEST_F(Signals, TheProgressLineKeepsToTheTerminal) {
  for (const std::vector<int>& columns :
       {std::vector<int>{40}, std::vector<int>{12}, std::vector<int>{120, 30}}) {
    RunOptions how;
    how.terminal_columns = columns;
    how.interrupt_at = "(\r[^\r]* %[^\r]*){10}";
    const RunResult result = run({"render", "scene.xml", "-o", "a.exr", "--time", "10m"}, how);
    EXPECT_EQ(result.exit_code, ended_early) << result.err;
    size_t begin = 0, lines = 0;
    while ((begin = result.err.find("\r", begin)) != std::string::npos) {
      ++begin;
      const size_t end = result.err.find_first_of("\r\n", begin);
      const std::string line = result.err.substr(begin, end - begin);
      if (!contains(line, " %") || contains(line, "mean") || contains(line, "error of")) continue;
      // The first ones may come before the terminal is made narrower.
      if (++lines > 5) {
        EXPECT_LT(line.size(), size_t(columns.back())) << line;
      }
    }
    EXPECT_GT(lines, 5u) << result.err;
  }
}

}  // namespace
}  // namespace kaustik::test
