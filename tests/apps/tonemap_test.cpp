// kaustik tonemap: what it reads and writes, what it says.

#include <bit>
#include <limits>

#include "kaustik/base/memory.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A grey PFM of these values, one row.
std::string pfm(const std::vector<float>& values) {
  std::string file = "Pf\n" + std::to_string(values.size()) + " 1\n-1.0\n";
  for (const float value : values) {
    const auto bits = std::bit_cast<uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) file += char(bits >> shift & 0xff);
  }
  return file;
}

/// The bytes of a PPM after its header.
std::string pixels(const std::string& ppm) {
  size_t at = 0;
  for (int line = 0; line < 3; ++line) at = ppm.find_first_of(" \n", at) + 1;
  return ppm.substr(ppm.find('\n', at) + 1);
}

/// A grey HDR of old runs that claims 494 million pixels in 91 KB.
std::string bomb() {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 7600 +X 65000\n";
  // A pixel, and as often again as two digits to the base of 256 tell: 231 + 253 · 256.
  const std::string line("\200\200\200\200\1\1\1\347\1\1\1\375", 12);
  for (int y = 0; y < 7600; ++y) file += line;
  return file;
}

class Tonemap : public ProgramTest {
 protected:
  Tonemap() {
    write("a.pfm", pfm({0.25f, 0.5f, 2}));
    write("b.pfm", pfm({1, 0}));
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
    SCOPED_TRACE(message);
    const auto before = files();
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    EXPECT_TRUE(contains(result.err, "remedy: ")) << result.err;
    EXPECT_EQ(files(), before);
  }
};

TEST_F(Tonemap, OnePictureInSeveralFormats) {
  run_well({"tonemap", "a.pfm", "-o", "a.png", "-o", "a.jpg", "-o", "a.ppm", "-o", "a.tif"});
  EXPECT_EQ(contents("a.png").substr(1, 3), "PNG");
  EXPECT_EQ(contents("a.jpg").substr(0, 2), "\xff\xd8");
  EXPECT_EQ(contents("a.ppm").substr(0, 2), "P6");
  EXPECT_EQ(contents("a.tif").substr(0, 2), "II");
}

TEST_F(Tonemap, SeveralPictures) {
  run_well({"tonemap", "a.pfm", "b.pfm", "-o", "1.ppm", "-o", "2.ppm", "--operator", "srgb"});
  EXPECT_EQ(pixels(contents("2.ppm")), std::string("\xff\xff\xff\0\0\0", 6));
  write("out/x", "");
  run_well({"tonemap", "a.pfm", "b.pfm", "-o", "out"});
  EXPECT_TRUE(exists("out/a.png"));
  EXPECT_TRUE(exists("out/b.png"));
  expect_refused({"tonemap", "a.pfm", "b.pfm", "-o", "c.png"}, "2 images to read, but 1 to write");
  expect_refused({"tonemap", "a.pfm", "b.pfm", "-o", "c.png", "-o", "./c.png"}, "written twice");
  expect_refused({"tonemap", "a.pfm", "-o", "c.exr"}, "no format for displays");
}

TEST_F(Tonemap, ParametersOfOperators) {
  run_well({"tonemap", "a.pfm", "-o", "1.ppm", "--operator", "linear", "--set", "exposure=-1"});
  run_well({"tonemap", "a.pfm", "-o", "2.ppm", "--operator", "linear", "--exposure", "-1"});
  EXPECT_EQ(contents("1.ppm"), contents("2.ppm"));
  run_well({"tonemap", "a.pfm", "-o", "3.ppm", "--set", "human=true", "--display-maximum", "200"});
  expect_refused({"tonemap", "a.pfm", "-o", "4.ppm", "--set", "humen=true"},
                 "no parameter 'humen'");
  expect_refused({"tonemap", "a.pfm", "-o", "4.ppm", "--set", "human=perhaps"}, "human");
  expect_refused({"tonemap", "a.pfm", "-o", "4.ppm", "--operator", "aces", "--display-range", "9"},
                 "no parameter 'display_range'");
  EXPECT_TRUE(contains(run_well({"help", "reinhard"}).out, "sharpening"));
}

TEST_F(Tonemap, TellsWhatIsAssumedAndWhatCannotBeShown) {
  const std::string note = "no field of view in its metadata: 50° across assumed";
  EXPECT_TRUE(contains(run_well({"tonemap", "a.pfm", "-o", "a.png"}).err, note));
  EXPECT_FALSE(contains(run_well({"tonemap", "a.pfm", "-o", "a.png", "--fov", "30"}).err, note));
  EXPECT_FALSE(contains(run_well({"tonemap", "a.pfm", "-o", "a.png", "-q"}).err, note));
  EXPECT_EQ(run_well({"tonemap", "a.pfm", "-o", "a.png", "--operator", "aces"}).err, "");
  const float infinite = std::numeric_limits<float>::infinity();
  write("bad.pfm", pfm({nan, nan, infinite, -1, 1}));
  const RunResult bad = run_well({"tonemap", "bad.pfm", "-o", "bad.ppm", "--operator", "srgb"});
  EXPECT_TRUE(contains(bad.err, "bad.pfm: 2 pixels not a number: shown black")) << bad.err;
  EXPECT_TRUE(contains(bad.err, "bad.pfm: 1 pixel infinite: shown white")) << bad.err;
  EXPECT_TRUE(contains(bad.err, "bad.pfm: 1 pixel of negative luminance")) << bad.err;
  EXPECT_EQ(pixels(contents("bad.ppm")),
            std::string("\0\0\0\0\0\0\xff\xff\xff\0\0\0\xff\xff\xff", 15));
}

TEST_F(Tonemap, TruncatedPicturesLeaveNothing) {
  write("scene.xml", small_scene());
  run_well(
      {"render", "scene.xml", "-q", "--spp", "1", "-o", "a.exr", "-o", "a.hdr", "-o", "a.tif"});
  for (const std::string name : {"a.exr", "a.hdr", "a.tif", "a.pfm"})
    for (const double part : {0.1, 0.5, 0.98}) {
      const std::string whole = contents(name);
      write("cut", whole.substr(0, size_t(double(whole.size()) * part)));
      expect_refused({"tonemap", "cut", "-o", "cut.png"}, "cannot read image 'cut'");
    }
}

TEST_F(Tonemap, LogLuvAndRadianceKeepTheFieldOfViewOrTellThatTheyDoNot) {
  write("scene.xml", small_scene());
  run_well(
      {"render", "scene.xml", "-q", "--spp", "1", "-o", "a.exr", "-o", "a.hdr", "-o", "a.tif"});
  EXPECT_EQ(run_well({"tonemap", "a.exr", "-o", "1.png"}).err, "");
  EXPECT_EQ(run_well({"tonemap", "a.tif", "-o", "2.png"}).err, "");
  run_well({"tonemap", "a.hdr", "-o", "3.png", "--fov", "40"});
}

TEST_F(Tonemap, RenderTakesTheSameParameters) {
  write("scene.xml", small_scene());
  run_well({"render", "scene.xml", "-q", "--spp", "1", "--float", "-o", "a.exr", "-o", "a.ppm",
            "--tonemap", "reinhard", "--set", "tonemap.key=0.3", "--set",
            "integrator.max_depth=3"});
  run_well({"tonemap", "a.exr", "-o", "b.ppm", "--operator", "reinhard", "--set", "key=0.3"});
  EXPECT_EQ(contents("a.ppm"), contents("b.ppm"));
  expect_refused({"render", "scene.xml", "-o", "c.png", "--set", "tonemap.kee=0.3"},
                 "no parameter 'kee'");
}

TEST_F(Tonemap, FalseColour) {
  run_well({"tonemap", "a.pfm", "-o", "f.png", "--operator", "falsecolor"});
  expect_refused({"tonemap", "a.pfm", "-o", "g.png", "--operator", "falsecolor", "--set",
                  "minimum=5", "--set", "maximum=4"},
                 "from 5 to 4");
}

/// What a command needs beside a picture counts: it is refused before the machine's memory is
/// spent.
TEST_F(Tonemap, PicturesThatWouldTakeAllMemory) {
  if (physical_memory_bytes() > int64_t(40) << 30) GTEST_SKIP() << "this machine has enough";
  write("bomb.hdr", bomb());
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"tonemap", "bomb.hdr", "-o", "c.png"},
        {"compare", "bomb.hdr", "bomb.hdr"}}) {
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("65000 x 7600 pixels"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace kaustik::test
