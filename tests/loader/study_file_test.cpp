// Files of studies: what they vary, and what is told of mistakes.

#include "kaustik/loader/study_file.h"

#include "kaustik/base/error.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

class StudyFiles : public testing::Test {
 protected:
  Study read(const std::string& text) { return read_study(folder_.write("lamps.json", text)); }
  /// "line: message" and the remedy.
  std::string failure_of(const std::string& text) {
    try {
      read(text);
    } catch (const Error& error) {
      const Problem& problem = error.problems().front();
      EXPECT_FALSE(problem.remedy.empty()) << problem.message;
      return std::to_string(problem.place.line) + ": " + problem.message;
    }
    return "read";
  }
  TemporaryFolder folder_;
};

TEST_F(StudyFiles, NameScenesFoldersAndOptions) {
  const Study study = read(R"({"scene": "room.xml",
    "options": {"time": "60s", "spp": 64, "set": ["a.b=1", "c.d=2"], "denoise": true,
                "strict": false}})");
  EXPECT_EQ(study.scene, folder_ / "room.xml");
  EXPECT_EQ(study.folder, folder_ / "lamps");
  EXPECT_EQ(study.outputs, std::vector<std::string>{"exr"});
  ASSERT_EQ(study.options.size(), 4u);  // what is false is left out
  EXPECT_EQ(study.options[0].setting.name, "time");
  EXPECT_EQ(study.options[1].values, std::vector<std::string>{"64"});
  EXPECT_EQ(study.options[2].values, (std::vector<std::string>{"a.b=1", "c.d=2"}));
  EXPECT_TRUE(study.options[3].values.empty());
  EXPECT_EQ(study.variant_count(), 1u);
  EXPECT_FALSE(study.has_seed_for_each);
}

TEST_F(StudyFiles, MultiplyTheirFactors) {
  const Study study = read(R"({"scene": "/s.xml", "folder": "/out", "outputs": ["exr", ".csv"],
    "seed": "each", "factors": [
      {"define": "hour", "values": [9, 12.5, "noon"]},
      {"set": "pane.int_ior", "values": [1.4, 1.6], "names": ["thin", "dense"]},
      {"option": "camera", "values": ["desk"], "name": "view"},
      {"define": "frame", "first": 8, "last": 10}]})");
  EXPECT_EQ(study.scene, "/s.xml");
  EXPECT_EQ(study.folder, "/out");
  EXPECT_EQ(study.outputs, (std::vector<std::string>{"exr", "csv"}));
  EXPECT_TRUE(study.has_seed_for_each);
  EXPECT_EQ(study.variant_count(), 18u);
  ASSERT_EQ(study.factors.size(), 4u);
  EXPECT_EQ(study.factors[0].values[1].text, "12.5");
  EXPECT_EQ(study.factors[1].label, "int_ior");
  EXPECT_EQ(study.factors[1].values[1].text, "1.6");
  EXPECT_EQ(study.factors[1].values[1].label, "dense");
  EXPECT_EQ(study.factors[2].label, "view");
  EXPECT_EQ(study.factors[3].values[0].text, "8");
  EXPECT_EQ(study.factors[3].values[0].label, "08");
}

TEST_F(StudyFiles, MistakesAreToldWithTheirLine) {
  EXPECT_EQ(failure_of("{}"), "1: the study names no scene");
  EXPECT_EQ(failure_of("{\"scene\": \"a.xml\",\n\"factor\": []}"), "2: there is no 'factor' here");
  EXPECT_EQ(failure_of("{\"scene\": \"a.xml\",\n\"options\": 3}"), "2: 'options' is no object");
  EXPECT_EQ(failure_of(R"({"scene": "a.xml", "seed": "none"})"), "1: there is no seed 'none'");
  EXPECT_EQ(failure_of(R"({"scene": "a.xml", "outputs": ["../x"]})"),
            "1: '../x' is no extension of a file");
  const auto of_factor = [&](const std::string& factor) {
    return failure_of(R"({"scene": "a.xml", "factors": [)" + factor + "]}");
  };
  EXPECT_EQ(of_factor(R"({"values": [1]})"), "1: a factor says one thing that it changes");
  EXPECT_EQ(of_factor(R"({"define": "a", "set": "b.c", "values": [1]})"),
            "1: a factor says one thing that it changes");
  EXPECT_EQ(of_factor(R"({"define": "a"})"), "1: the factor has no values");
  EXPECT_EQ(of_factor(R"({"define": "a", "values": []})"), "1: 'values' is no list of values");
  EXPECT_EQ(of_factor(R"({"define": "a", "values": [1, 2], "names": ["x"]})"),
            "1: there are 1 names for 2 values");
  EXPECT_EQ(of_factor(R"({"define": "a", "values": [[1]]})"), "1: this is no single value");
  EXPECT_EQ(of_factor(R"({"define": "a", "first": 3, "last": 1})"),
            "1: there are no frames from 3 to 1");
  EXPECT_EQ(of_factor(R"({"define": "a", "first": 1, "last": 2, "names": ["x", "y"]})"),
            "1: numbers that are counted have no names");
  EXPECT_EQ(failure_of(R"({"scene": "a.xml", "options": {"spp": []}})"), "1: 'spp' has no value");
  EXPECT_EQ(of_factor(R"({"define": "a", "values": [1]}, {"set": "b.a", "values": [1]})"),
            "1: two factors are called 'a'");
  const std::string thousand = R"({"define": "a", "first": 1, "last": 1001})";
  EXPECT_EQ(of_factor(thousand + R"(, {"define": "b", "first": 1, "last": 1000})"),
            "1: the study has more than 1000000 variants");
  EXPECT_EQ(failure_of("{\"scene\": \"a.xml\",\n}").substr(0, 2), "2:");
}

}  // namespace
}  // namespace kaustik
