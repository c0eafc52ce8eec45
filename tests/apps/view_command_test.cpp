// The program that serves a view, from its start to its end.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class ViewCommand : public ProgramTest {
 protected:
  ViewCommand() { write("scene.xml", small_scene()); }
};

TEST_F(ViewCommand, PrintsItsAddressAndEndsBySignals) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunOptions how;
    how.interrupt_at = "Ctrl-C ends it";
    how.signals = {signal};
    how.environment = {"DISPLAY=", "WAYLAND_DISPLAY="};
    const RunResult result = run({"view", "scene.xml", "--threads", "1"}, how);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out.rfind("http://127.0.0.1:", 0), 0u) << result.out;
    const size_t token = result.out.find("/#token=");
    ASSERT_NE(token, std::string::npos) << result.out;
    EXPECT_EQ(result.out.size() - token, 8 + 32 + 1u);
    EXPECT_EQ(files(), std::vector<std::string>{"scene.xml"});
  }
}

TEST_F(ViewCommand, TokensOfTheEnvironmentStay) {
  RunOptions how;
  how.interrupt_at = "Ctrl-C ends it";
  how.environment = {"KAUSTIK_VIEW_TOKEN=a-token_of-20-letters"};
  const RunResult result = run({"view", "scene.xml", "--no-browser"}, how);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "/#token=a-token_of-20-letters\n")) << result.out;
  for (const char* token : {"short", "a token with some spaces", "a/token/of/some/length"}) {
    how.environment = {std::string("KAUSTIK_VIEW_TOKEN=") + token};
    const RunResult refused = run({"view", "scene.xml"}, how);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(contains(refused.err, "KAUSTIK_VIEW_TOKEN")) << refused.err;
  }
}

TEST_F(ViewCommand, WarnsOfWhoElseMayCome) {
  RunOptions how;
  how.interrupt_at = "Ctrl-C ends it";
  const RunResult result = run({"view", "scene.xml", "--listen", "0.0.0.0", "--no-browser"}, how);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "warning")) << result.err;
  EXPECT_TRUE(contains(result.err, "open to other machines")) << result.err;
}

TEST_F(ViewCommand, WhatIsWrongIsToldAtOnce) {
  write("broken.xml", scene_with({.inside = "<shape type=\"sphere\"><float name=\"radius\" "
                                            "value=\"-1\"/></shape>"}));
  const std::vector<std::vector<std::string>> wrong = {
      {"view", "missing.xml"},
      {"view", "broken.xml"},
      {"view", "scene.xml", "--output", "nowhere"},
      {"view", "scene.xml", "--listen", "somewhere"},
      {"view", "scene.xml", "--port", "70000"},
      {"view", "scene.xml", "--set", "nothing.radius=1"},
      {"view", "scene.xml", "--set", "film.width=-1"},
      {"view", "scene.xml", "--integrator", "magic"}};
  for (const auto& words : wrong) {
    const RunResult result = run(words, {});
    EXPECT_EQ(result.exit_code, 2) << words.back() << ": " << result.err;
    EXPECT_FALSE(result.timed_out) << words.back();
  }
}

}  // namespace
}  // namespace kaustik::test
