// `kaustik batch`: the variants of a study.

#include <sstream>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Batches : public ProgramTest {
 protected:
  /// Under a sky of radiance $sky the irradiance is π times that: 562.345 lx of 1.
  void write_study(const std::string& factors, const std::string& more = "") const {
    write("scene.xml",
          "<scene version=\"3.0.0\"><default name=\"sky\" value=\"1\"/>"
          "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"$sky\"/></emitter>"
          "<sensor type=\"irradiancepoints\" id=\"up\"/>"
          "<sensor type=\"perspective\" id=\"view\"><film type=\"hdrfilm\"><integer "
          "name=\"width\" value=\"4\"/><integer name=\"height\" value=\"3\"/></film></sensor>"
          "</scene>");
    write("study.json",
          "{\"scene\": \"scene.xml\", \"options\": {\"integrator\": \"path\", \"passes\": 16, "
          "\"spp\": 256}, \"factors\": [" +
              factors + "]" + more + "}");
  }
  std::vector<std::string> lines_of(const std::string& file) const {
    std::istringstream text(contents(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
};

const std::string skies = R"({"define": "sky", "values": [1, 2], "names": ["dim", "bright"]})";
const std::string cameras = R"({"option": "camera", "values": ["up", "view"]})";

double value_in(const std::string& row, size_t column) {
  std::istringstream cells(row);
  std::string cell;
  for (size_t i = 0; i <= column; ++i) std::getline(cells, cell, ',');
  return std::atof(cell.c_str());
}

TEST_F(Batches, RenderEachCombinationAndMakeATable) {
  write_study(skies + "," + cameras);
  const RunResult result = run_well({"batch", "study.json"});
  EXPECT_TRUE(contains(result.err, "4 of 4: sky-bright_camera-view")) << result.err;
  EXPECT_TRUE(exists("study/sky-dim_camera-up.exr"));
  const auto rows = lines_of("study/table.csv");
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0],
            "part,sky,camera,x,y,z,value,half_width,unit,passes,samples_per_pixel,seconds");
  EXPECT_TRUE(rows[1].starts_with("sky-dim_camera-up,dim,up,0,0,0,")) << rows[1];
  EXPECT_TRUE(rows[2].starts_with("sky-dim_camera-view,dim,view,,,,179,")) << rows[2];
  EXPECT_TRUE(contains(rows[1], ",lx,16,256,")) << rows[1];
  EXPECT_TRUE(contains(rows[2], ",cd/m²,16,256,")) << rows[2];
  // Half the width of the interval is by the noise of 256 samples of a cosine.
  EXPECT_NEAR(value_in(rows[1], 6), 562.345, 6);
  EXPECT_NEAR(value_in(rows[3], 6), 2 * 562.345, 12);
  EXPECT_NEAR(value_in(rows[4], 6), 2 * 179, 1e-3);
}

TEST_F(Batches, DoNothingTwice) {
  write_study(skies);
  run_well({"batch", "study.json"});
  const RunResult again = run_well({"batch", "study.json"});
  EXPECT_TRUE(contains(again.err, "1 of 2: sky-dim is there")) << again.err;
  EXPECT_FALSE(contains(again.err, "wrote study/sky-dim.exr")) << again.err;
  // Another command is another picture.
  write_study(skies, R"(, "seed": "each")");
  EXPECT_TRUE(contains(run_well({"batch", "study.json"}).err, "wrote study/sky-dim.exr"));
  EXPECT_TRUE(
      contains(run_well({"batch", "study.json", "--force"}).err, "wrote study/sky-dim.exr"));
}

TEST_F(Batches, AreSharedOutAmongMachines) {
  write_study(skies);
  const RunResult one = run_well({"batch", "study.json", "--part", "2/2"});
  EXPECT_FALSE(exists("study/sky-dim.exr")) << one.err;
  EXPECT_TRUE(exists("study/sky-bright.exr"));
  EXPECT_FALSE(exists("study/table.csv"));
  const RunResult table = run_well({"batch", "study.json", "--table"});
  EXPECT_TRUE(contains(table.err, "sky-dim is not done")) << table.err;
  EXPECT_EQ(lines_of("study/table.csv").size(), 2u);
  run_well({"batch", "study.json", "--part", "1/2"});
  run_well({"batch", "study.json", "--table"});
  EXPECT_EQ(lines_of("study/table.csv").size(), 3u);
}

TEST_F(Batches, AreListedAsCommands) {
  write_study(R"({"define": "sky", "values": ["1, 0, 0"]})");
  const RunResult result = run_well({"batch", "study.json", "--list"});
  EXPECT_EQ(result.out,
            "kaustik render scene.xml --integrator=path --passes=16 --spp=256 -D 'sky=1, 0, 0' -o "
            "study/sky-1--0--0.exr --progress-file study/sky-1--0--0.jsonl\n");
  EXPECT_FALSE(exists("study"));
}

// One that fails does not cost the others.
TEST_F(Batches, GoOnBeyondFailures) {
  write_study(R"({"option": "camera", "values": ["nobody", "view"]})");
  const RunResult result = run({"batch", "study.json"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "nobody")) << result.err;
  EXPECT_TRUE(contains(result.err, "1 of 2 variants failed: camera-nobody")) << result.err;
  EXPECT_TRUE(exists("study/camera-view.exr"));
  EXPECT_FALSE(exists("study/table.csv"));
}

/// What one variant has told is not told of the next.
TEST_F(Batches, FailuresTellNothingOfOthers) {
  write_study(R"({"option": "camera", "values": ["view", "nobody"]})");
  run({"batch", "study.json"});
  EXPECT_TRUE(contains(contents("study/camera-view.jsonl"), "\"mean\":"));
  EXPECT_FALSE(contains(contents("study/camera-nobody.jsonl"), "\"mean\":"));
}

/// Ctrl-C ends the study, not the variant alone.
TEST_F(Batches, EndEarly) {
  write_study(R"({"option": "passes", "values": [100000, 2]})");
  std::string text = contents("study.json");
  const std::string end = "\"passes\": 16, \"spp\": 256";
  text.replace(text.find(end), end.size(), "\"denoise\": true");
  write("study.json", text);
  RunOptions options;
  options.interrupt_at = "1 of 2: passes-100000";
  options.interrupt_delay_s = 1;
  const RunResult result = run({"batch", "study.json"}, options);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_FALSE(contains(result.err, "2 of 2")) << result.err;
  EXPECT_FALSE(exists("study/table.csv"));
  EXPECT_FALSE(exists("study/passes-100000.command"));
}

/// From wherever it is called, and under whatever name.
TEST_F(Batches, AreDoneWhereverTheyAreCalledFrom) {
  write_study(skies);
  run_well({"batch", "study.json"});
  EXPECT_TRUE(contains(run_well({"batch", "./study.json"}).err, "2 of 2: sky-bright is there"));
  EXPECT_TRUE(contains(run_well({"batch", path("study.json")}).err, "sky-bright is there"));
  // What it told is part of it.
  std::filesystem::remove(path("study/sky-dim.jsonl"));
  EXPECT_TRUE(contains(run_well({"batch", "study.json"}).err, "wrote study/sky-dim.exr"));
}

TEST_F(Batches, MistakesAreToldBeforeAnythingIsRendered) {
  const auto failure_of = [&](const std::string& factors) {
    write_study(factors);
    const RunResult result = run({"batch", "study.json"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(exists("study"));
    return result.err;
  };
  const std::string unknown = failure_of(R"({"option": "integrater", "values": ["path"]})");
  EXPECT_TRUE(contains(unknown, "study.json:1:")) << unknown;
  EXPECT_TRUE(contains(unknown, "render has no option --integrater")) << unknown;
  EXPECT_TRUE(contains(unknown, "integrator")) << unknown;
  EXPECT_TRUE(contains(failure_of(R"({"option": "output", "values": ["a.exr"]})"),
                       "the study itself chooses --output"));
  EXPECT_TRUE(
      contains(failure_of(R"({"option": "spp", "values": [1, 2]})"), "--spp is given twice"));
  EXPECT_TRUE(contains(failure_of(R"({"define": "sky", "values": ["1,2", "1;2"]})"),
                       "two variants would be called 'sky-1-2'"));
  EXPECT_TRUE(contains(run({"batch", "study.json", "--table"}).err, "two variants"));
}

TEST_F(Batches, WithoutFactorsAreOnePicture) {
  write_study("");
  run_well({"batch", "study.json"});
  EXPECT_TRUE(exists("study/picture.exr"));
  EXPECT_EQ(lines_of("study/table.csv").size(), 2u);
}

}  // namespace
}  // namespace kaustik::test
