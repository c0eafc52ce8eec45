// The running picture elsewhere: in the terminal, in tev, in its files before the end.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"
#include "tests/apps/small_terminal.h"
#include "tests/support/fake_tev.h"

namespace kaustik::test {
namespace {

class Views : public ProgramTest {
 protected:
  Views() { write("scene.xml", small_scene()); }
  /// In a terminal of 100 columns and 24 rows, as tests have.
  static RunOptions in_terminal(const std::string& kind, const std::string& colours = "truecolor") {
    RunOptions how;
    how.terminal_columns = {100};
    how.environment = {"TERM=" + kind, "COLORTERM=" + colours, "TMUX=",
                       "STY=",         "TERM_PROGRAM=",        "KITTY_WINDOW_ID="};
    return how;
  }
  int64_t integer_of(const std::string& name, const std::string& key) const {
    return std::get<int64_t>(*read_image(path(name)).find_metadata(key));
  }
  static size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      ++count;
    return count;
  }
};

// What the terminal shows at the end: the picture, the line of progress below it, and messages that
// came meanwhile above it.
TEST_F(Views, ThePreviewAndTheBarShareTheTerminal) {
  RunOptions how = in_terminal("xterm-256color");
  how.interrupt_at = "pass [2-9]";
  how.signals = {SIGUSR1};
  how.interrupt_again_at = "as it is now; the render goes on(\r[^\r]*){8}";
  how.later_signals = {SIGTERM};
  const RunResult result = run({"render", "scene.xml", "--preview", "--passes", "1000000", "--spp",
                                "1000000", "-o", "a.exr"},
                               how);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  SmallTerminal terminal(100, 24);
  terminal.send(result.err);
  EXPECT_EQ(terminal.unknown(), std::vector<std::string>());
  const std::vector<std::string> lines = terminal.lines();
  const std::string all = [&] {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }();
  // 24 × 24 pixels: a character shows two.
  const std::string row = [] {
    std::string text;
    for (int i = 0; i < 24; ++i) text += "▀";
    return text;
  }();
  const auto first = std::find(lines.begin(), lines.end(), row);
  ASSERT_NE(first, lines.end()) << all;
  ASSERT_GE(lines.end() - first, 13) << all;
  EXPECT_EQ(std::count(first, first + 12, row), 12) << all;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), row), 12) << "one picture:\n" << all;
  EXPECT_TRUE(std::regex_match(*(first + 12), std::regex("\\[#*-*\\] +[0-9]+ %  pass [0-9].*")))
      << all;
  const size_t note = all.find("info: wrote a.exr as it is now; the render goes on\n");
  ASSERT_NE(note, std::string::npos) << all;
  EXPECT_LT(note, all.find(row)) << all;
  EXPECT_GT(all.find("wrote a.exr\n"), all.find(row)) << all;
  EXPECT_EQ(count_of(all, " %  pass "), 1u) << all;
}

TEST_F(Views, ThePreviewSpeaksTheTerminalsLanguage) {
  const auto shown = [&](const RunOptions& how, const std::string& option) {
    const RunResult result =
        run({"render", "scene.xml", option, "--passes", "2", "-o", "a.exr"}, how);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "wrote a.exr")) << result.err;
    return result.err;
  };
  EXPECT_TRUE(contains(shown(in_terminal("xterm-kitty"), "--preview"), "\x1b_Ga=T,f=100,"));
  EXPECT_TRUE(contains(shown(in_terminal("foot"), "--preview"), "\x1bP0;1;0q"));
  EXPECT_TRUE(contains(shown(in_terminal("xterm", ""), "--preview"), "\x1b[38;5;"));
  EXPECT_TRUE(contains(shown(in_terminal("xterm"), "--preview"), "\x1b[38;2;"));
  EXPECT_TRUE(contains(shown(in_terminal("xterm-kitty"), "--preview=blocks"), "▀"));
  EXPECT_TRUE(contains(shown(in_terminal("xterm"), "--preview=iterm"), "\x1b]1337;File="));
  // Where it cannot be: a word, and no control sequences.
  const std::string dumb = shown(in_terminal("dumb"), "--preview");
  EXPECT_TRUE(contains(dumb, "no preview: ")) << dumb;
  EXPECT_FALSE(contains(dumb, "\x1b")) << dumb;
  const std::string piped = shown({}, "--preview=kitty");
  EXPECT_TRUE(contains(piped, "no preview: standard error is no terminal")) << piped;
  EXPECT_FALSE(contains(piped, "\x1b")) << piped;
}

TEST_F(Views, BadViewsAreErrors) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--preview=kity"}, {"--tev", "a:b"}, {"--tev", ""}, {"--tev", "a b"}}) {
    std::vector<std::string> words = {"render", "scene.xml", "-o", "a.exr"};
    words.insert(words.end(), options.begin(), options.end());
    const RunResult result = run(words);
    EXPECT_EQ(result.exit_code, 2) << options[0] << result.err;
    EXPECT_TRUE(contains(result.err, "remedy: ")) << result.err;
  }
  const RunResult both =
      run({"render", "scene.xml", "--preview", "--progress", "json", "-o", "a.exr"},
          in_terminal("xterm"));
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_TRUE(contains(both.err, "--progress-file")) << both.err;
}

// The render has the same bits, whoever looks.
TEST_F(Views, ThePictureIsTheSame) {
  const std::vector<std::string> words = {"render", "scene.xml", "--integrator",
                                          "auto",   "--passes",  "3",
                                          "--spp",  "6",         "--reproducible"};
  const auto rendered = [&](const std::vector<std::string>& more, const RunOptions& how) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    EXPECT_EQ(run(all, how).exit_code, 0);
    return contents("a.exr");
  };
  const std::string alone = rendered({"-o", "a.exr"}, {});
  EXPECT_TRUE(alone == rendered({"-o", "a.exr", "--preview"}, in_terminal("xterm")));
}

TEST_F(Views, TevShowsWhatIsWritten) {
  FakeTev viewer;
  const RunResult result =
      run({"render", "scene.xml", "--tev", "127.0.0.1:" + std::to_string(viewer.port()), "--passes",
           "3", "--spp", "3", "--float", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(contains(result.err, "warning")) << result.err;
  const Image image = read_image(path("a.exr"));
  const auto is_last = [&] {
    const auto pictures = viewer.pictures();
    const auto found = pictures.find("a.exr");
    if (found == pictures.end()) return false;
    for (const char* name : {"R", "G", "B"}) {
      const auto expected = image.channel(image.find_channel(name));
      if (!std::equal(expected.begin(), expected.end(), found->second.channels.at(name).begin(),
                      found->second.channels.at(name).end()))
        return false;
    }
    return true;
  };
  for (int i = 0; i < 1000 && !is_last(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(is_last());
  EXPECT_EQ(viewer.complaint(), "");
}

TEST_F(Views, ViewersThatFailCostAWarning) {
  uint16_t free_port = 0;
  { free_port = FakeTev().port(); }
  const RunResult none =
      run({"render", "scene.xml", "--tev", "127.0.0.1:" + std::to_string(free_port), "--passes",
           "2", "-o", "a.exr"});
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_EQ(count_of(none.err, "warning: "), 1u) << none.err;
  EXPECT_TRUE(contains(none.err, "the render goes on without it")) << none.err;
  EXPECT_TRUE(contains(none.err, "wrote a.exr")) << none.err;
  FakeTev closing(ViewerManner::closes_early);
  const RunResult closed =
      run({"render", "scene.xml", "--tev", "127.0.0.1:" + std::to_string(closing.port()), "--time",
           "1s", "-o", "a.exr"});
  EXPECT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_EQ(count_of(closed.err, "no picture in the viewer"), 1u) << closed.err;
}

TEST_F(Views, ASignalWritesThePictureAndTheRenderGoesOn) {
  RunOptions how;
  how.terminal_columns = {120};  // where progress is told often
  how.interrupt_at = "pass [1-9]";
  how.signals = {SIGUSR1};
  how.interrupt_again_at = "as it is now; the render goes on(\r[^\r]*pass [0-9][^\r]*){8}";
  how.later_signals = {SIGINT};
  const RunResult result = run({"render", "scene.xml", "-o", "a.exr", "-o", "b.png", "--passes",
                                "1000000", "--spp", "1000000", "--progress-file", "p.jsonl"},
                               how);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  std::vector<nlohmann::json> written;
  std::istringstream lines(contents("p.jsonl"));
  for (std::string line; std::getline(lines, line);)
    if (const auto event = nlohmann::json::parse(line); event["event"] == "written")
      written.push_back(event);
  ASSERT_EQ(written.size(), 4u) << contents("p.jsonl");
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(written[i]["file"], i % 2 == 0 ? "a.exr" : "b.png");
    EXPECT_EQ(written[i]["state"], i < 2 ? "so far" : "ended early");
  }
  EXPECT_GE(written[0]["passes"].get<int>(), 1);
  EXPECT_GT(written[2]["passes"].get<int>(), written[0]["passes"].get<int>());
  EXPECT_EQ(integer_of("a.exr", "passes"), written[2]["passes"].get<int>());
}

TEST_F(Views, ASignalInTheFirstPassWritesWhatThereIs) {
  RunOptions how;
  how.interrupt_at = "pass 0";
  how.interrupt_delay_s = 0.3;
  how.signals = {SIGUSR1};
  how.interrupt_again_at = "as it is now";
  how.later_signals = {SIGTERM, SIGINT};  // at once: nothing is written over it
  const RunResult result =
      run({"render", "scene.xml", "-o", "a.exr", "--passes", "1", "--spp", "100000000"}, how);
#ifndef KAUSTIK_THREAD_SANITIZER
  EXPECT_NE(result.signal, 0) << result.exit_code << result.err;
#endif
  const Image image = read_image(path("a.exr"));
  EXPECT_EQ(image.width(), 24);
  EXPECT_EQ(integer_of("a.exr", "passes"), 0);
  float brightest = 0;
  for (const float value : image.channel(image.find_channel("G")))
    brightest = std::max(brightest, value);
  EXPECT_GT(brightest, 0);
}

TEST_F(Views, SignalsThatAreIgnoredStaySo) {
  RunOptions how;
  how.interrupt_at = "pass 0";
  how.ignored_signal = SIGUSR1;
  how.signals = {SIGUSR1};
  const RunResult result =
      run({"render", "scene.xml", "-o", "a.exr", "--time", "1s", "--progress", "plain"}, how);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(contains(result.err, "as it is now")) << result.err;
  // Other commands only take note of it.
  EXPECT_EQ(run({"help"}).exit_code, 0);
}

}  // namespace
}  // namespace kaustik::test
