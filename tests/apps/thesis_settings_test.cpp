// The thesis's variables of the environment and its two options.

#include <fstream>
#include <regex>

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class ThesisSettings : public ProgramTest {
 protected:
  ThesisSettings() {
    write("scene.xml", small_scene("<integrator type=\"photonmap\">"
                                   "<integer name=\"global_photons\" value=\"500\"/>"
                                   "<integer name=\"caustic_photons\" value=\"500\"/>"
                                   "<integer name=\"diffuse_samples\" value=\"2\"/>"
                                   "<boolean name=\"irradiance_cache\" value=\"false\"/>"
                                   "</integrator>"));
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
  /// The same picture, to the bit.
  void expect_same(const std::vector<std::string>& environment,
                   const std::vector<std::string>& arguments,
                   const std::vector<std::string>& other_arguments) const {
    const auto picture = [&](const std::vector<std::string>& variables,
                             std::vector<std::string> with, const std::string& name) {
      with.insert(with.end(), {"-o", name});
      const RunResult result = render(variables, with);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return contents(name);
    };
    EXPECT_EQ(picture(environment, arguments, "a.pfm"), picture({}, other_arguments, "b.pfm"));
  }
  void expect_refused(const std::string& variable, std::initializer_list<const char*> parts) const {
    const RunResult result = render({variable});
    EXPECT_EQ(result.exit_code, 2) << variable;
    for (const char* part : parts)
      EXPECT_TRUE(contains(result.err, part)) << part << "\n" << result.err;
  }
};

/// Every row of the page, as its example has it, and every variable that the program knows.
TEST_F(ThesisSettings, ThePageNamesThemAll) {
  std::ifstream page(KAUSTIK_SOURCE_DIR "/docs/thesis/parameters.md");
  ASSERT_TRUE(page);
  const std::regex row(R"(^\| `([A-Za-z.]+)`.*\| `([^`]+)` \|$)");
  std::vector<std::string> names, examples;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    names.push_back(match[1]);
    examples.push_back(match[2]);
    EXPECT_TRUE(examples.back().starts_with(names.back() + "=")) << line;
  }
  EXPECT_EQ(names.size(), 16u);
  const RunResult result = render(examples);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string help = run_well({"help", "thesis"}).out;
  for (const std::string& name : names) {
    EXPECT_TRUE(contains(result.err, name + " of the environment")) << name;
    EXPECT_TRUE(contains(help, "  " + name)) << name;
  }
  const std::regex in_help("\n  (photonMap|max)[.A-Za-z]+");
  EXPECT_EQ(std::distance(std::sregex_iterator(help.begin(), help.end(), in_help), {}),
            std::ptrdiff_t(names.size()));
}

TEST_F(ThesisSettings, AreParametersOfPhotonmap) {
  expect_same({"photonMap.numGlobal=0"}, {}, {"--set", "integrator.global_neighbors=0"});
  expect_same(
      {"photonMap.specularSampling=NONE", "photonMap.numCaustic=5"}, {},
      {"--set", "integrator.specular_sampling=none", "--set", "integrator.caustic_neighbors=5"});
  expect_same({"photonMap.reradiate="}, {}, {"--set", "integrator.reradiate=true"});
  expect_same({"photonMap.distribQuality=9"}, {}, {"--set", "integrator.aim_targets=128"});
  expect_same({}, {"-l", "1", "-e", "2"},
              {"--set", "integrator.max_light_level=1", "--set", "integrator.max_eye_level=2"});
}
/// File < environment < command line; and each shows.
TEST_F(ThesisSettings, WhichOneWins) {
  const std::vector<std::string> off = {"photonMap.totalGlobal=0"};
  expect_same(off, {}, {"--set", "integrator.global_photons=0"});
  expect_same(off, {"--set", "integrator.global_photons=500"}, {});
  expect_same({"maxLightLevel=1"}, {"-l", "3"}, {"-l", "3"});
  expect_same({}, {"-l", "3", "--set", "integrator.max_light_level=1"}, {"-l", "1"});
}
TEST_F(ThesisSettings, OfOtherIntegratorsAreTold) {
  const RunResult result = render({"photonMap.numGlobal=80"}, {"--integrator", "path"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "no effect with integrator 'path'")) << result.err;
  EXPECT_EQ(render({}, {"--integrator", "path"}).err, "");
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
