// How many threads are used, and what is told of it.

#include <cstdio>
#include <cstdlib>

#include "kaustik/base/processors.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Threads : public ProgramTest {
 protected:
  Threads() { write("scene.xml", small_scene()); }
  void SetUp() override {
    if (processors().of_machine < 2) GTEST_SKIP() << "needs two processors";
    if (std::system("taskset -V >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs taskset";
  }
  /// What the program says, on both streams, when it is bound to one processor.
  std::string said_on_one_processor(const std::string& arguments) const {
    const std::string command =
        "cd '" + path("") + "' && taskset -c $(taskset -cp $$ | sed 's/.*: //; s/[^0-9].*//') " +
        KAUSTIK_PROGRAM + " " + arguments + " 2>&1";
    std::FILE* const pipe = ::popen(command.c_str(), "r");
    std::string text;
    char buffer[4096];
    while (const size_t count = std::fread(buffer, 1, sizeof buffer, pipe))
      text.append(buffer, count);
    EXPECT_EQ(::pclose(pipe), 0) << text;
    return text;
  }
  static std::string of_machine() { return std::to_string(processors().of_machine); }
};

TEST_F(Threads, WhoIsBoundToOneProcessorIsWarned) {
  const std::string render = "render scene.xml -D size=8 --passes 1 --spp 1 -o a.exr ";
  const std::string warning = "this process is bound to 1 of " + of_machine() + " cores";
  EXPECT_TRUE(contains(said_on_one_processor(render), warning));
  const std::string quiet = said_on_one_processor(render + "-q");
  EXPECT_TRUE(contains(quiet, warning)) << quiet;
  EXPECT_TRUE(contains(quiet, "remedy: ")) << quiet;
  // Who says so means it.
  const std::string meant = said_on_one_processor(render + "--threads 1");
  EXPECT_FALSE(contains(meant, "cores")) << meant;
  const std::string many = said_on_one_processor(render + "--threads 4096");
  EXPECT_TRUE(contains(many, "--threads 4096: this process may run 1 at a time")) << many;
}

TEST_F(Threads, ProgramsAreToldOfThem) {
  const std::string facts = said_on_one_processor("--version --json");
  EXPECT_TRUE(contains(facts, "\"threads\":1") || contains(facts, "\"threads\": 1")) << facts;
}

TEST_F(Threads, WhereAllAreUsedNothingIsSaid) {
  if (usable_processors() < processors().of_machine) GTEST_SKIP() << "not all may be used here";
  const RunResult result = run_well(
      {"render", "scene.xml", "-D", "size=8", "--passes", "1", "--spp", "1", "-o", "a.exr"});
  EXPECT_FALSE(contains(result.err, "cores")) << result.err;
}

}  // namespace
}  // namespace kaustik::test
