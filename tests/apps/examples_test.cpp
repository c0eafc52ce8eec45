// The scenes that kaustik example writes.

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "kaustik/image/image_io.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Examples : public ProgramTest {
 protected:
  /// Names of the examples, by the list of them.
  std::vector<std::string> examples() const {
    std::istringstream list(run_well({"example"}).out);
    std::vector<std::string> names;
    for (std::string line; std::getline(list, line) && line.starts_with("  ");)
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    return names;
  }
};

/// Sums of the luminances of a layer; −1: there is none.
double light_in(const Image& image, const std::string& layer) {
  const int channel = image.find_channel(layer.empty() ? "G" : layer + ".G");
  if (channel < 0) return -1;
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) sum += double(image.at(x, y, channel));
  return sum;
}

TEST_F(Examples, AreListed) {
  EXPECT_EQ(examples(), (std::vector<std::string>{"box", "caustic", "jewel", "pool", "room"}));
  std::istringstream list(run_well({"example"}).out);
  for (std::string line; std::getline(list, line) && !line.empty();) {
    EXPECT_LE(line.size(), 80u) << line;
    EXPECT_TRUE(line.ends_with('.')) << line;
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(Examples, AreWritten) {
  const RunResult result = run_well({"example", "caustic"});
  EXPECT_TRUE(contains(result.err, "kaustik render caustic.xml --time 20s -o caustic.png\n"))
      << result.err;
  EXPECT_TRUE(contains(result.err, "kaustik view caustic.xml\n")) << result.err;
  run_well({"example", "caustic", "-o", "it's mine.xml"});
  EXPECT_EQ(contents("it's mine.xml"), contents("caustic.xml"));
  EXPECT_TRUE(contains(run_well({"example", "box", "-o", "a b.xml"}).err, "render 'a b.xml'"));
  std::filesystem::create_directory(path("folder"));
  run_well({"example", "box", "-o", "folder/a.xml"});
  EXPECT_EQ(files(), (std::vector<std::string>{"a b.xml", "caustic.xml", "folder", "folder/a.xml",
                                               "it's mine.xml"}));
}

TEST_F(Examples, ReplaceNothing) {
  write("box.xml", "mine");
  const RunResult refused = run({"example", "box"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "--force")) << refused.err;
  EXPECT_EQ(contents("box.xml"), "mine");
  run_well({"example", "box", "--force"});
  EXPECT_TRUE(contents("box.xml").starts_with("<?xml")) << contents("box.xml");
}

TEST_F(Examples, WhatCannotBeWritten) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& part) {
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, part)) << result.err;
  };
  refused({"example", "jwel"}, "did you mean 'jewel'?");
  refused({"example", "box", "-o", "box.png"}, "end in .xml");
  refused({"example", "box", "-o", "-"}, "standard output");
  refused({"example", "box", "-o", "none/box.xml"}, "folder 'none'");
  refused({"example", "-o", "box.xml"}, "name");
  EXPECT_TRUE(files().empty());
}

/// As their comments say.
TEST_F(Examples, CanBeChanged) {
  const std::vector<std::vector<std::string>> changes = {{"box", "lamps=bulbs"},
                                                         {"caustic", "lamp_radius=0.03"},
                                                         {"jewel", "ior=2.42", "colour=0, 0, 0"},
                                                         {"pool", "ripples=0.002", "time=0.5"},
                                                         {"room", "sun=-1, -0.7, 0.45"}};
  for (const std::vector<std::string>& change : changes) {
    SCOPED_TRACE(change[0]);
    run_well({"example", change[0]});
    std::vector<std::string> arguments = {"info", change[0] + ".xml", "--strict"};
    const std::string before = run_well(arguments).out;
    for (size_t i = 1; i < change.size(); ++i) {
      EXPECT_TRUE(contains(contents(change[0] + ".xml"), " -D " + change[i].substr(0, 3)));
      arguments.insert(arguments.end(), {"-D", change[i]});
    }
    EXPECT_FALSE(contains(run_well(arguments).out, "warning"));
    EXPECT_FALSE(contains(before, "warning"));
  }
  EXPECT_FALSE(run_well({"info", "box.xml"}).out ==
               run_well({"info", "box.xml", "-D", "lamps=bulbs"}).out);
}

TEST_F(Examples, Render) {
  // The floor of a pool is seen through water: its caustics are in another layer.
  const std::set<std::string> with_caustics = {"box", "caustic", "jewel", "room"};
  for (const std::string& name : examples()) {
    SCOPED_TRACE(name);
    const std::string scene = name + ".xml", picture = name + ".exr";
    run_well({"example", name});
    const RunResult info = run_well({"info", scene, "--strict"});
    EXPECT_FALSE(contains(info.out + info.err, "warning")) << info.out << info.err;
    const RunResult result = run_well({"render", scene, "-q", "-D", "size=24", "--passes", "1",
                                       "--spp", "16", "--float", "-o", picture});
    EXPECT_FALSE(contains(result.err, "warning")) << result.err;
    const Image image = read_image(path(picture));
    EXPECT_EQ(image.width(), 24);
    EXPECT_EQ(image.height(), 24);
    size_t dark = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        const float value = image.at(x, y, image.find_channel("G"));
        EXPECT_TRUE(std::isfinite(value) && value >= 0);
        dark += value > 0 ? 0 : 1;
      }
    EXPECT_LT(dark, 24u * 24 / 20);
    if (with_caustics.contains(name)) {
      EXPECT_GT(light_in(image, "caustic"), 1e-3 * light_in(image, ""));
    } else {
      EXPECT_GT(light_in(image, "specular"), 0.1 * light_in(image, ""));
    }
  }
}

}  // namespace
}  // namespace kaustik::test
