// Files that cannot be written: found before the work starts where possible, never half a file,
// never an old one lost.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Output : public ProgramTest {
 protected:
  Output() { write("scene.xml", small_scene()); }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& message,
                      const std::string& remedy) const {
    SCOPED_TRACE(arguments.back());
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err << "\nexpected: " << message;
    EXPECT_TRUE(contains(result.err, "remedy: ")) << result.err;
    EXPECT_TRUE(contains(result.err, remedy)) << result.err << "\nexpected: " << remedy;
    EXPECT_FALSE(contains(result.err, "pass ")) << "the render had started: " << result.err;
    EXPECT_EQ(files(), before);
  }
};

TEST_F(Output, PlacesThatCannotBeWrittenAreFoundBeforeTheRender) {
  write("file", "precious");
  const auto render = [](const std::string& output) {
    return std::vector<std::string>{"render", "scene.xml", "-o", output};
  };
  expect_refused(render("none/out.exr"), "folder 'none'", "mkdir -p 'none'");
  expect_refused(render("file/out.exr"), "'file' is a file, not a folder", "in a folder");
  expect_refused(render("file/below/out.exr"), "folder 'file/below'", "choose");
  expect_refused(render("out.gif"), "out.gif", ".png");
  expect_refused(render("out"), "out", ".png");
  write("folder.exr/x", "");
  expect_refused(render("folder.exr"), "it is a folder", "give the name of a file");
  expect_refused({"render", "scene.xml", "-o", "good.exr", "-o", "none/out.png"}, "folder 'none'",
                 "mkdir");
  expect_refused({"photons", "scene.xml", "-o", "file/out.kpm"}, "'file' is a file", "in a folder");
  EXPECT_EQ(contents("file"), "precious");
}

TEST_F(Output, OtherCommandsLookBeforeTheyReadToo) {
  run_well({"render", "scene.xml", "-q", "-o", "a.exr"});
  expect_refused({"tonemap", "a.exr", "-o", "none/out.png"}, "folder 'none'", "mkdir");
  expect_refused({"compare", "a.exr", "a.exr", "-o", "none/out.png"}, "folder 'none'", "mkdir");
  expect_refused({"denoise", "a.exr", "-o", "none/out.exr"}, "folder 'none'", "mkdir");
}

TEST_F(Output, AFullDiskHarmsNothing) {
  RunOptions full;
  full.file_size_limit = 300;
  run_well({"render", "scene.xml", "-q", "-o", "made.exr"});
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", "scene.xml", "-q", "-o", "old.exr"},
        {"render", "scene.xml", "-q", "-o", "old.png"},
        {"render", "scene.xml", "-q", "-o", "old.tif"},
        {"render", "scene.xml", "-q", "-o", "old.hdr"},
        {"photons", "scene.xml", "--force", "-o", "old.kpm"},
        {"tonemap", "made.exr", "-o", "old.png"},
        {"denoise", "made.exr", "-o", "old.exr"},
        {"compare", "made.exr", "made.exr", "-o", "old.exr"}}) {
    const std::string& output = arguments.back();
    SCOPED_TRACE(arguments[0] + " " + output);
    write(output, "precious");
    const auto before = files();
    const RunResult result = run(arguments, full);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(contains(result.err, "cannot write '") && contains(result.err, output))
        << result.err;
    EXPECT_TRUE(contains(result.err, "remedy: free some space")) << result.err;
    EXPECT_EQ(files(), before);
    EXPECT_EQ(contents(output), "precious");
  }
}

TEST_F(Output, AFullDiskLeavesTheOutputsThatWereWritten) {
  RunOptions full;
  full.file_size_limit = 4000;
  const RunResult result = run({"render", "scene.xml", "-q", "-o", "a.ppm", "-o", "b.exr"}, full);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(contains(result.err, "b.exr")) << result.err;
  EXPECT_TRUE(exists("a.ppm"));
  EXPECT_EQ(files(), (std::vector<std::string>{"a.ppm", "scene.xml"}));
}

TEST_F(Output, OldFilesAreReplacedByGoodOnes) {
  write("out.png", "old");
  run_well({"render", "scene.xml", "-q", "-o", "out.png"});
  EXPECT_EQ(contents("out.png").substr(1, 3), "PNG");
  EXPECT_EQ(files(), (std::vector<std::string>{"out.png", "scene.xml"}));
}

}  // namespace
}  // namespace kaustik::test
