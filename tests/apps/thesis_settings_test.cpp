// The thesis's variables of the environment and its two options.

#include <fstream>
#include <regex>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class ThesisSettings : public ProgramTest {
 protected:
  ThesisSettings() {
    write("scene.xml", small_scene("<default name=\"cache\" value=\"false\"/>"
                                   "<integrator type=\"photonmap\">"
                                   "<integer name=\"global_photons\" value=\"400\"/>"
                                   "<integer name=\"caustic_photons\" value=\"500\"/>"
                                   "<integer name=\"diffuse_samples\" value=\"2\"/>"
                                   "<boolean name=\"irradiance_cache\" value=\"$cache\"/>"
                                   "<string name=\"cache_metric\" value=\"split_sphere\"/>"
                                   "<float name=\"cache_minimum_spacing\" value=\"0.1\"/>"
                                   "<string name=\"specular_sampling\" value=\"perfect\"/>"
                                   "<integer name=\"max_eye_level\" value=\"2\"/>"
                                   "</integrator>" +
                                   wall_and_beads()));
  }
  /// Something that light is sent on to, and more to aim at than there are boxes.
  static std::string wall_and_beads() {
    std::string objects =
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/>"
        "<rotate x=\"1\" angle=\"90\"/><translate y=\"1.5\"/></transform></shape>";
    for (int i = 0; i < 140; ++i)
      objects += "<shape type=\"sphere\"><point name=\"center\" x=\"" +
                 std::to_string(-1.4 + 0.02 * i) +
                 "\" y=\"1\" z=\"0.2\"/><float name=\"radius\" value=\"0.01\"/>"
                 "<bsdf type=\"dielectric\"/></shape>";
    return objects;
  }
  RunResult render(const std::vector<std::string>& environment,
                   const std::vector<std::string>& arguments = {}) const {
    std::vector<std::string> all = {"render", "scene.xml", "-D", "size=8", "--passes",
                                    "1",      "--spp",     "1",  "-q",     "--reproducible"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    RunOptions options;
    options.environment = environment;
    return run(all, options);
  }
  struct Rendered {
    std::string picture, told;
  };
  Rendered picture_of(const std::vector<std::string>& environment,
                      std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-o", "a.pfm"});
    const RunResult result = render(environment, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return {contents("a.pfm"), result.err};
  }
  /// The same picture, to the bit, and not that of the scene file alone.
  void expect_same(const std::vector<std::string>& environment,
                   const std::vector<std::string>& arguments,
                   const std::vector<std::string>& other_arguments) const {
    const std::string picture = picture_of(environment, arguments).picture;
    EXPECT_EQ(picture, picture_of({}, other_arguments).picture);
    EXPECT_NE(picture, picture_of({}, {}).picture);
  }
  void expect_refused(const std::string& variable, std::initializer_list<const char*> parts) const {
    const RunResult result = render({variable});
    EXPECT_EQ(result.exit_code, 2) << variable;
    for (const char* part : parts)
      EXPECT_TRUE(contains(result.err, part)) << part << "\n" << result.err;
  }
};

struct Row {
  std::string variable, parameters, example;  ///< the first, third and fourth column
};

/// The table of the page.
std::vector<Row> rows_of_the_page() {
  std::ifstream page(KAUSTIK_SOURCE_DIR "/docs/thesis/parameters.md");
  EXPECT_TRUE(page);
  const std::regex row(R"(^\| `([A-Za-z.]+)`[^|]*\|[^|]*\| ([^|]*) \| `([^`]+)` \|$)");
  std::vector<Row> rows;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) rows.push_back({match[1], match[2], match[3]});
  }
  return rows;
}

TEST_F(ThesisSettings, ThePageNamesThemAll) {
  const std::vector<Row> rows = rows_of_the_page();
  EXPECT_EQ(rows.size(), 16u);
  const std::string help = run_well({"help", "thesis"}).out;
  for (const Row& row : rows) {
    EXPECT_TRUE(row.example.starts_with(row.variable + "=")) << row.example;
    EXPECT_TRUE(contains(help, "  " + row.variable)) << row.variable;
  }
  const std::regex in_help("\n  (photonMap|max)[.A-Za-z]+");
  EXPECT_EQ(std::distance(std::sregex_iterator(help.begin(), help.end(), in_help), {}),
            std::ptrdiff_t(rows.size()));
}

/// Each row's example sets the parameter that the page names, and the picture is that of the
/// parameter, which is another than without it.
TEST_F(ThesisSettings, EachDoesWhatThePageSays) {
  for (const Row& row : rows_of_the_page()) {
    std::vector<std::string> with;
    if (row.variable == "photonMap.minDist") with = {"-D", "cache=true"};
    const auto [picture, told] = picture_of({row.example}, with);
    const std::regex sentence(row.variable + " of the environment: ([a-z_]+) = (\\S+)");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(told, match, sentence)) << row.variable << "\n" << told;
    const std::string parameter = match[1], value = match[2];
    EXPECT_TRUE(row.parameters.starts_with("`" + parameter)) << row.variable;
    EXPECT_NE(picture, picture_of({}, with).picture) << row.variable;
    with.insert(with.end(), {"--set", "integrator." + parameter + "=" + value});
    EXPECT_EQ(picture, picture_of({}, with).picture) << row.variable;
  }
}

TEST_F(ThesisSettings, AreParametersOfPhotonmap) {
  expect_same({"photonMap.numGlobal=0"}, {}, {"--set", "integrator.global_neighbors=0"});
  expect_same(
      {"photonMap.specularSampling=NONE", "photonMap.numCaustic=5"}, {},
      {"--set", "integrator.specular_sampling=none", "--set", "integrator.caustic_neighbors=5"});
  expect_same({"photonMap.reradiate="}, {}, {"--set", "integrator.reradiate=true"});
  expect_same({"photonMap.distribQuality=0"}, {}, {"--set", "integrator.aim_targets=32"});
  expect_same({}, {"-l", "1", "-e", "1"},
              {"--set", "integrator.max_light_level=1", "--set", "integrator.max_eye_level=1"});
}
/// More than 2 is the same as 2, which is the default.
TEST_F(ThesisSettings, GreatestQuality) {
  const auto quality = [&](const char* value) {
    return picture_of({std::string("photonMap.distribQuality=") + value}, {}).picture;
  };
  EXPECT_EQ(quality("2"), quality("9"));
  EXPECT_NE(quality("1"), quality("9"));
}
/// File < environment < command line; and each shows.
TEST_F(ThesisSettings, WhichOneWins) {
  const std::vector<std::string> off = {"photonMap.totalGlobal=0"};
  expect_same(off, {}, {"--set", "integrator.global_photons=0"});
  expect_same(off, {"--set", "integrator.global_photons=300"},
              {"--set", "integrator.global_photons=300"});
  expect_same({"maxLightLevel=1"}, {"-l", "2"}, {"-l", "2"});
  expect_same({}, {"-l", "2", "--set", "integrator.max_light_level=1"}, {"-l", "1"});
  EXPECT_NE(picture_of({}, {"-l", "2"}).picture, picture_of({}, {"-l", "1"}).picture);
}
TEST_F(ThesisSettings, OfOtherIntegratorsAreTold) {
  const RunResult result = render({"photonMap.numGlobal=80"}, {"--integrator", "path"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "no effect with integrator 'path'")) << result.err;
  EXPECT_FALSE(contains(render({}, {"--integrator", "path"}).err, "no effect"));
}
TEST_F(ThesisSettings, Mistakes) {
  expect_refused("photonMap.numGlobal=-1", {"photonMap.numGlobal=-1", "0 to 100000"});
  expect_refused("photonMap.numGlobal=many", {"photonMap.numGlobal=many", "integer"});
  expect_refused("photonMap.numGlobal=", {"cannot be ''"});
  expect_refused("photonMap.specularSampling=some", {"some", "none, perfect, importance"});
  expect_refused("photonMap.causticFilter=0.5", {"photonMap.causticFilter=0.5", "1"});
  expect_refused("photonMap.reradiate=no", {"unset it"});
  expect_refused("photonMap.distribQuality=-1", {"whole number, 0 or larger"});
  expect_refused("maxLightLevel=0", {"maxLightLevel", "1 or larger"});
  expect_refused("photonMap.numGlobl=80", {"did you mean 'photonMap.numGlobal'?"});
  expect_refused("photonmap.numGlobal=80", {"did you mean 'photonMap.numGlobal'?"});
  EXPECT_EQ(render({}, {"-l", "0"}).exit_code, 2);
  EXPECT_EQ(render({}, {"-e", "-1"}).exit_code, 2);
  EXPECT_TRUE(contains(render({}, {"--integrator", "path", "-e", "1"}).err,
                       "command line: -e 1: integrator 'path' has no parameter"));
}

}  // namespace
}  // namespace kaustik::test
