// What the program writes replaces nothing that is not meant, and nothing that fails costs the
// rest.
#include <filesystem>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class SafeOutputs : public ProgramTest {
 protected:
  SafeOutputs() { write("scene.xml", small_scene()); }
  static Words render(const Words& more, const std::string& scene = "scene.xml") {
    Words words = {"render", scene,      "-q", "--reproducible", "-D",
                   "size=8", "--passes", "2",  "--spp",          "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// All names, with the contents of files.
  std::vector<std::string> snapshot() const {
    std::vector<std::string> all;
    for (const std::string& file : files())
      all.push_back(file + (fs::is_regular_file(path(file)) ? contents(file) : ""));
    return all;
  }
  /// Expects a refusal that says so, and that every file stays.
  void refused(const Words& words, const std::string& message, RunOptions how = {}) const {
    SCOPED_TRACE(message);
    const std::vector<std::string> before = snapshot();
    const RunResult result = run(words, how);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    EXPECT_TRUE(before == snapshot());
  }
};

TEST_F(SafeOutputs, NothingIsWrittenTwice) {
  fs::create_directories(path("sub"));
  fs::create_symlink("a.exr", path("link.exr"));
  refused(render({"-o", "a.exr", "-o", "a.exr"}), "would be written twice");
  refused(render({"-o", "a.exr", "-o", "sub/../a.exr"}), "one file");
  refused(render({"-o", "a.exr", "-o", "link.exr"}), "one file");
  refused(render({"-o", "a.exr", "--checkpoint", "./a.exr"}), "one file");
  refused(render({"-o", "-", "-o", "png:-"}), "would be written twice");
}

TEST_F(SafeOutputs, WhatIsReadStays) {
  run_well(render({"-o", "a.exr", "-o", "a.ppm"}));
  write("textured.xml",
        scene_with({"<default name=\"size\" value=\"8\"/><integrator type=\"path\"/><shape "
                    "type=\"sphere\"><bsdf type=\"diffuse\">"
                    "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
                    "value=\"a.ppm\"/></texture></bsdf></shape>"}));
  const std::string says = "writing it would replace it";
  refused(render({"-o", "a.ppm"}, "textured.xml"), says);
  refused(render({"-o", "b.exr", "--checkpoint", "scene.xml"}), says);
  refused({"photons", "scene.xml", "-o", "scene.xml"}, says);
  refused({"photons", "scene.xml", "-o", "a.exr"}, "is not a photon map");
  refused({"compare", "a.exr", "a.exr", "-o", "a.exr"}, says);
  refused({"denoise", "a.exr", "-o", "a.exr"}, "--force");
  refused({"tonemap", "a.ppm", "-o", "a.ppm"}, "--force");
  run_well({"tonemap", "a.ppm", "-o", "a.ppm", "--force", "-q"});
}

TEST_F(SafeOutputs, ACheckpointIsNotReplaced) {
  const Words first = render({"-o", "a.exr", "--checkpoint", "a.kpt"});
  run_well(first);
  refused(first, "kaustik resume a.kpt");
  refused(render({"-o", "a.exr", "--checkpoint", "a.exr"}), "would be written twice");
  refused({"merge", "a.kpt", "-o", "a.kpt"}, "--force");
  write("other.kpt", contents("a.kpt"));
  refused({"merge", "a.kpt", "-o", "other.kpt"}, "is a checkpoint");
  run_well({"merge", "a.kpt", "-o", "other.kpt", "--force"});
  Words forced = first;
  forced.push_back("--force");
  run_well(forced);
}

TEST_F(SafeOutputs, ResumeWritesFarAwayOnlyWhenTold) {
  fs::create_directories(path("kept"));
  fs::create_symlink("..", path("kept/up"));
  for (const std::string& far : Words{"a.exr", path("b.exr"), "kept/up/c.exr", "kept/../d.exr"}) {
    run_well(render({"-o", far, "--force", "--checkpoint", "kept/a.kpt"}));
    refused({"resume", "kept/a.kpt", "-q"}, "outside its own folder");
    run_well({"resume", "kept/a.kpt", "-q", "-o", far});
  }
  run_well(render({"-o", "kept/near.exr", "--force", "--checkpoint", "kept/a.kpt"}));
  const RunResult near = run_well({"resume", "kept/a.kpt"});
  EXPECT_TRUE(contains(near.err, "to be written: kept/near.exr (replacing what is there)"))
      << near.err;
}

TEST_F(SafeOutputs, OneThatFailsDoesNotCostTheOthers) {
  RunOptions small_files;
  small_files.file_size_limit = 2000;
  const RunResult result = run(
      render({"-o", "a.exr", "-o", "b.exr", "-o", "c.ppm", "--checkpoint", "a.kpt"}), small_files);
  EXPECT_EQ(result.exit_code, 1);
  for (const char* failed : {"a.kpt", "a.exr", "b.exr"})
    EXPECT_TRUE(contains(result.err, std::string("cannot write '") + failed + "'")) << result.err;
  EXPECT_EQ(read_image(path("c.ppm")).width(), 8);

  run_well(render({"-o", "good.exr"}));
  write("bad.exr", "no picture");
  fs::create_directories(path("shown"));
  const RunResult shown = run({"tonemap", "bad.exr", "good.exr", "-o", "shown", "-q"});
  EXPECT_EQ(shown.exit_code, 2);
  EXPECT_TRUE(exists("shown/good.png"));
}

TEST_F(SafeOutputs, MergedCheckpointsDoNotDependOnTheOrder) {
  const auto part = [&](const std::string& name, const std::string& first, const Words& more) {
    Words words = {"render",   "scene.xml", "-q",    "-D", "size=8",       "--first-pass", first,
                   "--passes", "2",         "--spp", "2",  "--checkpoint", name + ".kpt"};
    words.insert(words.end(), more.begin(), more.end());
    run_well(words);
  };
  part("a", "0", {"-o", "a.exr", "--tonemap", "linear"});
  part("b", "2", {"-o", "b.exr", "--tonemap", "srgb"});
  part("c", "4", {"-o", "a.exr"});
  run_well({"merge", "a.kpt", "b.kpt", "c.kpt", "-o", "abc.kpt"});
  run_well({"merge", "c.kpt", "b.kpt", "a.kpt", "-o", "cba.kpt"});
  run_well({"merge", "c.kpt", "a.kpt", "-o", "ca.kpt"});
  run_well({"merge", "ca.kpt", "b.kpt", "-o", "cab.kpt"});
  EXPECT_TRUE(contents("abc.kpt") == contents("cba.kpt"));
  EXPECT_TRUE(contents("abc.kpt") == contents("cab.kpt"));
  refused({"resume", "abc.kpt", "-q"}, "names no picture");
  run_well({"merge", "b.kpt", "a.kpt", "-o", "ab.kpt", "-o", "ab.exr"});
  fs::remove(path("ab.exr"));
  run_well({"resume", "ab.kpt", "-q"});
  EXPECT_TRUE(exists("ab.exr"));
}

TEST_F(SafeOutputs, StandardStreamsTakeScenesAndGivePictures) {
  RunOptions piped;
  piped.input = small_scene();
  run_well(render({"-o", "a.exr", "-o", "a.pfm"}));
  const RunResult streamed = run(render({"-o", "pfm:-"}, "-"), piped);
  EXPECT_EQ(streamed.exit_code, 0) << streamed.err;
  EXPECT_TRUE(streamed.out == contents("a.pfm"));
  EXPECT_TRUE(run_well(render({"-o", "-"})).out == contents("a.exr"));
  EXPECT_TRUE(contains(run_well({"tonemap", "a.exr", "-q", "-o", "-"}).out, "PNG"));
  const RunResult report = run({"info", "-"}, piped);
  EXPECT_TRUE(report.out == run_well({"info", "scene.xml"}).out);
  refused(render({}, "-"), "no name", piped);
  piped.input = "<scene";
  refused({"info", "-"}, "standard input:1", piped);
  refused(render({"-o", "xyz:-"}), "unknown extension");
}

TEST_F(SafeOutputs, WhatCannotBePrintedIsAFailure) {
  RunOptions full;
  full.full_output = true;
  run_well(render({"-o", "a.exr"}));
  for (const Words& words :
       {Words{"info", "scene.xml"}, Words{"help"}, Words{"help", "photonmap"}, Words{"--version"},
        Words{"--help"}, Words{"compare", "a.exr", "a.exr"}, render({"-o", "-"})}) {
    const RunResult result = run(words, full);
    EXPECT_EQ(result.exit_code, 1) << words[0];
    EXPECT_TRUE(contains(result.err, "cannot write to standard output")) << result.err;
  }
}

TEST_F(SafeOutputs, AFullStandardOutputHidesNoOtherFailure) {
  RunOptions full;
  full.full_output = true;
  full.file_size_limit = 100;
  const RunResult result = run(render({"-o", "-", "-o", "a.pfm"}), full);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(contains(result.err, "cannot write to standard output")) << result.err;
  EXPECT_TRUE(contains(result.err, "cannot write 'a.pfm'") ||
              contains(result.err, "a.pfm': File too large"))
      << result.err;
}

TEST_F(SafeOutputs, AnEmptyNameIsRefusedInWords) {
  refused({"tonemap", "", "-o", "a.png"}, "name of a file is empty");
}

TEST_F(SafeOutputs, AWindowOfAPictureTooLargeForOneImageIsWritten) {
  Words words = render({"-o", "a.exr", "--set", "film.width=100000", "--set", "film.height=90000"});
  for (const char* name : {"film.crop_width=4", "film.crop_height=4", "film.crop_offset_x=50000",
                           "film.crop_offset_y=60000"})
    words.insert(words.end(), {"--set", name});
  run_well(words);
  const Image image = read_image(path("a.exr"));
  EXPECT_EQ(image.width(), 4);
  EXPECT_EQ(image.height(), 4);
  EXPECT_TRUE((image.frame() == PictureFrame{100000, 90000, 50000, 60000}));
  refused({"stitch", "a.exr", "-o", "b.exr"}, "too large");
  refused({"tonemap", "a.exr", "-q", "-o", "b.png"}, "too large");
  run_well({"tonemap", "a.exr", "-q", "--data-window", "-o", "b.png"});
}

TEST_F(SafeOutputs, OptionsSayWhatIsNoNumberAndFilesTheirCommand) {
  refused({"render", "scene.xml", "--spp", "abc"}, "'abc' is not a whole number");
  refused({"render", "scene.xml", "--spp", "1.5"}, "'1.5' is not a whole number");
  refused({"render", "scene.xml", "--spp", "0"}, "0 is out of range");
  refused({"render", "scene.xml", "--passes", "99999999999999999999"}, "is out of range");
  refused({"tonemap", "scene.xml", "-o", "a.png", "--fov", "wide"}, "'wide' is not a number");
  refused({"scene.xml"}, "kaustik render scene.xml");
  refused({"a.kpt"}, "kaustik resume a.kpt");
  for (const char* time : {"1m1", "1s1m", "1m1m", "-1s", "1x", "s", "", "1e99h", "nan", "0m0s"})
    refused({"render", "scene.xml", std::string("--time=") + time}, "time");
  for (const char* time : {"0h0m0.01s", "0m0.01s", "0.0001min", "0.01"})
    run_well({"render", "scene.xml", "-q", "-D", "size=4", "--spp", "1", "--time", time});
}

}  // namespace
}  // namespace kaustik::test
