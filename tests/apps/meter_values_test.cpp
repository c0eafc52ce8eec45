// What `kaustik render` tells of meters: lux and cd/m², with intervals.

#include <cstdlib>
#include <sstream>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class MeterValues : public ProgramTest {
 protected:
  /// Below a sky of radiance 1 W/(sr·m²), where the irradiance is π W/m², or 562.345 lx.
  void write_scene(const std::string& sensor) const {
    write("scene.xml",
          "<scene version=\"3.0.0\"><integrator type=\"path\"/><emitter type=\"constant\"><rgb "
          "name=\"radiance\" value=\"1\"/></emitter>" +
              sensor + "</scene>");
  }
  RunResult rendered(const std::string& sensor, const std::string& passes = "16") const {
    write_scene(sensor);
    return run_well({"render", "scene.xml", "--passes", passes, "--spp", "4096", "--progress-file",
                     "events.jsonl", "-o", "a.exr"});
  }
  /// The number behind those words; 0: there is none.
  static double number_behind(const std::string& text, const std::string& words) {
    const size_t at = text.find(words);
    return at == std::string::npos ? 0 : std::atof(text.c_str() + at + words.size());
  }
  /// By some ten of its standard errors.
  static void expect_illuminance(double value) { EXPECT_NEAR(value, 562.345, 1.5); }
};

const std::string film =
    "<film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer name=\"height\" "
    "value=\"1\"/></film>";
const std::string point =
    "<sensor type=\"irradiancepoints\"><transform name=\"to_world\"><translate x=\"1\" y=\"2\" "
    "z=\"3\"/></transform></sensor>";

TEST_F(MeterValues, OfPointsAreIlluminances) {
  const RunResult result = rendered(point);
  expect_illuminance(number_behind(result.err, "illuminance: "));
  const double half_width = number_behind(result.err, " ± ");
  EXPECT_GT(half_width, 0);
  EXPECT_LT(half_width, 1.5);
  EXPECT_TRUE(contains(result.err, " lx (95 % confidence, 16 passes)\n")) << result.err;
  EXPECT_FALSE(contains(result.err, "mean of the picture")) << result.err;
  EXPECT_FALSE(contains(result.err, "wider than")) << result.err;
  const std::string events = contents("events.jsonl");
  expect_illuminance(number_behind(events, R"({"event":"measured","x":1,"y":2,"z":3,"value":)"));
  EXPECT_TRUE(contains(events, R"("unit":"lx"})")) << events;
}

TEST_F(MeterValues, OfShapesAreIlluminances) {
  const RunResult result = rendered(
      "<shape type=\"rectangle\"><bsdf type=\"diffuse\"/><sensor type=\"irradiancemeter\">" + film +
      "</sensor></shape>");
  expect_illuminance(number_behind(result.err, "illuminance: "));
  EXPECT_TRUE(contains(result.err, " lx (95 % confidence, 16 passes)\n")) << result.err;
}

TEST_F(MeterValues, OfRaysAreLuminances) {
  for (const char* type : {"radiancemeter", "fluencemeter"}) {
    const RunResult result =
        rendered("<sensor type=\"" + std::string(type) + "\">" + film + "</sensor>");
    EXPECT_TRUE(contains(result.err, "luminance: 179 ± ")) << result.err;
    EXPECT_TRUE(contains(result.err, " cd/m² (95 % confidence, 16 passes)\n")) << result.err;
  }
}

// One pass tells nothing of the error.
TEST_F(MeterValues, WideIntervalsAreToldWithWhatToDo) {
  const RunResult result = rendered(point, "1");
  EXPECT_TRUE(contains(result.err, " ± unknown lx (")) << result.err;
  EXPECT_TRUE(contains(result.err, "wider than ± 10 %") && contains(result.err, "--error 2%"))
      << result.err;
  EXPECT_TRUE(contains(contents("events.jsonl"), R"("half_width":null)"));
}

TEST_F(MeterValues, PicturesHaveNone) {
  const RunResult result = rendered("<sensor type=\"perspective\">" + film + "</sensor>");
  EXPECT_FALSE(contains(result.err, "luminance: ")) << result.err;
  EXPECT_TRUE(contains(result.err, "mean of the picture")) << result.err;
  EXPECT_FALSE(contains(contents("events.jsonl"), "measured"));
}

/// Up, and to the side, where half of what is below the horizon is missing: all of the sky shines.
TEST_F(MeterValues, OfAFileOfPointsAreATable) {
  write("points.txt", "# x y z  nx ny nz\n0 0 1  0 0 1\n2.5 0 1  1 0 0\n");
  write_scene(
      "<sensor type=\"irradiancepoints\"><string name=\"filename\" "
      "value=\"points.txt\"/></sensor>");
  const RunResult result = run_well({"render", "scene.xml", "--passes", "16", "--spp", "4096",
                                     "--progress-file", "events.jsonl", "-o", "lux.csv"});
  EXPECT_TRUE(contains(result.err, "wrote lux.csv")) << result.err;
  EXPECT_TRUE(contains(contents("events.jsonl"), R"({"event":"written","file":"lux.csv")"));
  std::istringstream table(contents("lux.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "x,y,z,value,half_width,unit");
  for (const std::string start : {"0,0,1,", "2.5,0,1,"}) {
    std::getline(table, line);
    ASSERT_TRUE(line.starts_with(start)) << line;
    EXPECT_TRUE(line.ends_with(",lx")) << line;
    expect_illuminance(number_behind(line, start));
  }
  EXPECT_FALSE(std::getline(table, line));
}

/// Whatever cameras the scene has. Who goes on from a checkpoint measures the same.
TEST_F(MeterValues, PointsAreGivenToAnyScene) {
  write("points.txt", "x y z nx ny nz\n0 0 1  0 0 1\n0 0 2  0 0 -1\n");
  write_scene("<sensor type=\"perspective\">" + film + "</sensor>");
  run_well({"render", "scene.xml", "--points", "points.txt", "--passes", "2", "--spp", "4096",
            "--checkpoint", "a.kpt"});
  const std::string table = contents("scene.csv");
  expect_illuminance(number_behind(table, "\n0,0,1,"));
  expect_illuminance(number_behind(table, "\n0,0,2,"));
  run_well({"resume", "a.kpt", "-o", "again.csv"});
  EXPECT_EQ(contents("again.csv"), table);
  write("points.txt", "0 0 1\n");
  const RunResult wrong = run({"render", "scene.xml", "--points", "points.txt", "--passes", "2"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.err, "points.txt:1: there are 3 numbers")) << wrong.err;
}

TEST_F(MeterValues, TablesAreOfMetersAlone) {
  write_scene("<sensor type=\"perspective\">" + film + "</sensor>");
  const RunResult result = run({"render", "scene.xml", "--passes", "1", "-o", "lux.csv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "'lux.csv' is a table of what a meter shows")) << result.err;
  EXPECT_TRUE(contains(result.err, "--camera ID")) << result.err;
  EXPECT_FALSE(exists("lux.csv"));
}

// A checkpoint has no scene with it.
TEST_F(MeterValues, TablesNeedTheScene) {
  write_scene(point);
  run_well({"render", "scene.xml", "--passes", "2", "--checkpoint", "a.kpt", "-o", "a.exr"});
  const RunResult merged = run({"merge", "a.kpt", "-o", "lux.csv"});
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_TRUE(contains(merged.err, "kaustik resume FILE.kpt -o lux.csv")) << merged.err;
  run_well({"resume", "a.kpt", "-o", "lux.csv"});
  EXPECT_TRUE(contains(contents("lux.csv"), "\n1,2,3,"));
}

// The size of a film that the scene lacks has no effect: points tell their own.
TEST_F(MeterValues, AFilmThatIsNotThereCanBeSet) {
  write_scene(point);
  const RunResult result = run_well({"render", "scene.xml", "--passes", "1", "--spp", "1", "--set",
                                     "film.width=3", "-o", "a.exr"});
  EXPECT_TRUE(contains(result.err, "without effect here: 'width' of the film of such a sensor"))
      << result.err;
}

}  // namespace
}  // namespace kaustik::test
