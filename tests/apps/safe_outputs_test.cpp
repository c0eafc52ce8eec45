// What the program writes replaces nothing that is not meant, and nothing that fails costs the
// rest.
#include <algorithm>
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

TEST_F(SafeOutputs, StandardStreamsAreForScenesAndPicturesOnly) {
  run_well(render({"-o", "a.exr", "--checkpoint", "a.kpt"}));
  const std::string takes = "takes pictures only", from = "from which only scenes are read";
  refused(render({"-o", "b.exr", "--checkpoint", "-"}), takes);
  refused(render({"-o", "b.exr", "--checkpoint", "kpt:-", "--force"}), takes);
  refused({"photons", "scene.xml", "-o", "-"}, takes);
  refused({"photons", "scene.xml", "-o", "kpm:-", "--force"}, takes);
  refused({"merge", "a.kpt", "-o", "kpt:-"}, "unknown extension");
  refused({"compare", "a.exr", "a.exr", "-o", "-"}, "standard output is for the figures");
  refused({"compare", "a.exr", "a.exr", "-o", "png:-"}, "standard output is for the figures");
  for (const Words& words :
       {Words{"resume", "-"}, Words{"merge", "-", "-o", "b.exr"},
        Words{"merge", "a.kpt", "-", "-o", "b.exr"}, Words{"tonemap", "-", "-o", "b.png"},
        Words{"compare", "a.exr", "-"}, Words{"compare", "-", "a.exr"},
        Words{"denoise", "-", "-o", "b.exr"}, Words{"stitch", "a.exr", "-", "-o", "b.exr"}})
    refused(words, from);
  // The name is no other than before where it cannot be mistaken, nor is the picture's way.
  run_well(render({"-o", "b.exr", "--checkpoint", "./-"}));
  EXPECT_TRUE(exists("-"));
  EXPECT_TRUE(run_well({"merge", "a.kpt", "-o", "-"}).out == contents("a.exr"));
}

TEST_F(SafeOutputs, AReaderThatHasGoneEndsQuietly) {
  run_well(render({"-o", "a.exr", "-o", "a.pfm", "--checkpoint", "a.kpt"}));
  const std::string picture = contents("a.pfm"), checkpoint = contents("a.kpt");
  RunOptions gone;
  gone.closed_output = true;
  const RunResult result =
      run(render({"-o", "-", "-o", "b.pfm", "--checkpoint", "a.kpt", "--force"}), gone);
  EXPECT_EQ(result.signal, SIGPIPE);
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(contents("b.pfm") == picture);
  EXPECT_FALSE(contents("a.kpt").empty());
  for (const Words& words : {Words{"info", "scene.xml"}, Words{"tonemap", "a.exr", "-o", "-", "-q"},
                             Words{"denoise", "a.exr", "-o", "-"}, Words{"help"}}) {
    const RunResult other = run(words, gone);
    EXPECT_EQ(other.signal, SIGPIPE) << words[0];
    EXPECT_EQ(other.err, "") << words[0];
  }
  // What else fails is told, with its exit code.
  gone.file_size_limit = 100;
  const RunResult failed = run(render({"-o", "-", "-o", "c.pfm"}), gone);
  EXPECT_EQ(failed.exit_code, 1) << failed.err;
  EXPECT_TRUE(contains(failed.err, "c.pfm")) << failed.err;
}

TEST_F(SafeOutputs, AllThatASceneIsReadFromStays) {
  write("lamp.spd", "400 1\n700 2\n");
  write("defaults.xml", "<scene version=\"3.0.0\"><default name=\"size\" value=\"8\"/></scene>");
  write("whole.xml", scene_with({"<include filename=\"defaults.xml\"/><integrator type=\"path\"/>"
                                 "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"1\" "
                                 "z=\"2\"/><spectrum name=\"intensity\" filename=\"lamp.spd\"/>"
                                 "</emitter><texture type=\"checkerboard\"><float name=\"scale\" "
                                 "value=\"$size\"/></texture>"}));
  for (const char* file : {"lamp.spd", "defaults.xml", "whole.xml"})
    refused({"render", "whole.xml", "-q", "-o", "a.exr", "--force", "--checkpoint", file},
            "writing it would replace it");
}

TEST_F(SafeOutputs, ResumeReadsItsOptionsFirst) {
  run_well(render({"-o", "a.exr", "--checkpoint", "a.kpt"}));
  write("scene.xml", "this is no scene any more");
  refused({"resume", "a.kpt", "-q", "--time", "soon"}, "cannot read the time 'soon'");
  refused({"resume", "a.kpt", "-q", "--every", "often"}, "cannot read the time 'often'");
  refused({"resume", "a.kpt", "-q", "--error", "little"}, "cannot read the error 'little'");
}

// A picture for displays has the pixels that were rendered, whichever command makes it.
TEST_F(SafeOutputs, ACropIsShownAsTheCrop) {
  Words words = render({"-o", "a.exr", "-o", "a.png", "--float", "--tonemap", "srgb"});
  for (const char* setting :
       {"film.crop_width=5", "film.crop_height=3", "film.crop_offset_x=2", "film.crop_offset_y=4"})
    words.insert(words.end(), {"--set", setting});
  run_well(words);
  const Words shown = {"tonemap", "a.exr", "-q", "--operator", "srgb", "-o"};
  const auto tonemapped = [&](const std::string& name, const Words& more) {
    Words all = shown;
    all.push_back(name);
    all.insert(all.end(), more.begin(), more.end());
    run_well(all);
    return read_image(path(name));
  };
  const Image rendered = read_image(path("a.png")), crop = tonemapped("b.png", {});
  EXPECT_EQ(rendered.width(), 5);
  EXPECT_EQ(rendered.height(), 3);
  ASSERT_EQ(crop.width(), 5);
  ASSERT_EQ(crop.height(), 3);
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::ranges::equal(rendered.channel(c), crop.channel(c)));
  const Image whole = tonemapped("c.png", {"--display-window"});
  EXPECT_EQ(whole.width(), 8);
  EXPECT_EQ(whole.height(), 8);
  EXPECT_EQ(whole.at(2, 4, 1), crop.at(0, 0, 1));
  EXPECT_EQ(whole.at(1, 4, 1), 0);
  // In an EXR of others, what the file does not hold is black.
  Image other(4, 2, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) std::ranges::fill(other.channel(c), 0.5f);
  other.set_frame({9, 9, 1, 1});
  write_image(other, path("d.exr"));
  run_well({"tonemap", "d.exr", "-q", "-o", "d.png"});
  EXPECT_EQ(read_image(path("d.png")).width(), 9);
  run_well({"tonemap", "d.exr", "-q", "--data-window", "-o", "d.png"});
  EXPECT_EQ(read_image(path("d.png")).width(), 4);
  other.set_frame({9, 9, 20, 0});
  write_image(other, path("d.exr"));
  run_well({"tonemap", "d.exr", "-q", "-o", "d.png"});
  const Image black = read_image(path("d.png"));
  EXPECT_EQ(black.width(), 9);
  for (const float value : black.channel(0)) EXPECT_EQ(value, 0);
  refused({"tonemap", "d.exr", "-q", "--data-window", "-o", "d.png"}, "lies in the picture");
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
  refused({"tonemap", "a.exr", "-q", "--display-window", "-o", "b.png"}, "too large");
  run_well({"tonemap", "a.exr", "-q", "-o", "b.png"});
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
