// kaustik learn, and renders with what it has learned.

#include "tests/apps/arguments.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class LearnCommand : public ProgramTest {
 protected:
  LearnCommand() { write("scene.xml", small_scene("<integrator type=\"auto\"/>")); }
  static Arguments learn(const Arguments& more = {}) {
    return with({"learn", "scene.xml", "-q", "-D", "size=10", "-o", "a.kln", "--passes", "4"},
                more);
  }
  static Arguments render(const std::string& name, const Arguments& more = {}) {
    return with({"render", "scene.xml", "-q", "--reproducible", "-D", "size=10", "--learned",
                 "a.kln", "-o", name + ".exr", "--force", "--checkpoint", name + ".kpt"},
                more);
  }
  void expect_refused(const Arguments& arguments, const std::string& message) const {
    SCOPED_TRACE(message);
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    EXPECT_EQ(files(), before);
  }

 private:
  static Arguments with(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
};

TEST_F(LearnCommand, SharesLessonsAmongRenders) {
  run_well(learn());
  const std::string lessons = contents("a.kln");
  run_well(render("whole", {"--passes", "6"}));
  run_well(render("one", {"--passes", "2"}));
  run_well(render("two", {"--first-pass", "2", "--passes", "4"}));
  run_well({"merge", "two.kpt", "one.kpt", "-o", "sum.exr", "-o", "sum.kpt"});
  const std::string whole = contents("whole.exr");
  ASSERT_FALSE(whole.empty());
  EXPECT_TRUE(contents("sum.exr") == whole);
  // The checkpoint has the lessons: the file may be gone.
  std::filesystem::remove(path("a.kln"));
  run_well({"resume", "one.kpt", "-q", "--passes", "6"});
  EXPECT_TRUE(contents("one.exr") == whole);
  // The same again, whatever the number of threads.
  run_well(learn({"--threads", "1"}));
  EXPECT_EQ(contents("a.kln"), lessons);
}

TEST_F(LearnCommand, TellsWhatItDid) {
  Arguments loud = learn();
  std::erase(loud, "-q");
  const RunResult result = run_well(loud);
  EXPECT_TRUE(contains(result.err, "wrote a.kln: what 4 passes of 4 samples a pixel taught auto"))
      << result.err;
}

TEST_F(LearnCommand, WhatDoesNotFitIsRefused) {
  run_well(learn());
  expect_refused(render("x", {"--set", "film.width=12"}),
                 "a.kln: its lessons are of another scene");
  expect_refused(render("x", {"--integrator", "vcm"}), "a.kln: its lessons are of integrator auto");
  expect_refused(render("x", {"--set", "integrator.max_depth=3"}), "with other parameters");
  expect_refused({"render", "scene.xml", "--learned", "scene.xml"},
                 "scene.xml: this is not a file of lessons");
  expect_refused({"render", "scene.xml", "--learned", "none.kln"}, "none.kln");
  expect_refused({"learn", "scene.xml", "-o", "scene.xml"}, "scene.xml");
  expect_refused({"learn", "scene.xml", "-o", "b.kln", "--integrator", "path"},
                 "integrator path learns nothing");
}

}  // namespace
}  // namespace kaustik::test
