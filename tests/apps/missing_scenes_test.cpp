// Scenes that are not where they are looked for, and files that are none.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class MissingScenes : public ProgramTest {
 protected:
  void expect_refused(const std::string& scene, const std::vector<std::string>& parts,
                      const std::string& command = "info") const {
    SCOPED_TRACE(scene);
    const RunResult result = run({command, scene});
    EXPECT_EQ(result.exit_code, 2);
    for (const std::string& part : parts) EXPECT_TRUE(contains(result.err, part)) << result.err;
  }
};

TEST_F(MissingScenes, AreLookedForNearby) {
  write("garden.xml", scene_with({}));
  write("house/kitchen.xml", scene_with({}));
  expect_refused("gardn.xml", {"cannot read 'gardn.xml'", "did you mean 'garden.xml'?",
                               "scenes here:\n    garden.xml\n    house/kitchen.xml\n"});
  expect_refused("garden", {"did you mean 'garden.xml'?"});
  expect_refused("kitchen.xml", {"did you mean 'house/kitchen.xml'?"});
  expect_refused("house/kitchn.xml", {"did you mean 'house/kitchen.xml'?",
                                      "scenes in 'house':\n    house/kitchen.xml"});
  expect_refused("none/deep/garden.xml", {"did you mean 'garden.xml'?"});
  expect_refused("caustic.xml", {"kaustik example caustic"});
  // Of the source tree, in which the program lies.
  expect_refused("metal_rng.xml", {"scenes/metal_ring/metal_ring.xml'?"});
  expect_refused("ring.xml", {"scenes/metal_ring/metal_ring.xml'?"});
  expect_refused("qwertyuiop.xml", {"check the name", "kaustik example"});
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"render", "gardn.xml"},
                                                    {"view", "gardn.xml"},
                                                    {"photons", "gardn.xml", "-o", "a.kpm"},
                                                    {"learn", "gardn.xml", "-o", "a.kln"},
                                                    {"convert", "gardn.xml", "-o", "a.xml"}}) {
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_TRUE(contains(result.err, "did you mean 'garden.xml'?")) << result.err;
  }
}

TEST_F(MissingScenes, AnEmptyNameIsNone) {
  for (const char* command : {"info", "render", "view"})
    expect_refused("", {"the name of the scene is empty", "kaustik example"}, command);
}

TEST_F(MissingScenes, FoldersAreListed) {
  std::filesystem::create_directory(path("empty"));
  expect_refused("empty", {"it is a folder", "no scene in it", "kaustik example"});
  for (int i = 0; i < 11; ++i) write("many/" + std::to_string(i + 10) + ".xml.gz", "");
  write("many/picture.exr", "");
  expect_refused("many", {"it is a folder", "give a scene in it:\n    many/10.xml.gz\n",
                          "many/17.xml.gz\n    and 3 more\n"});
  expect_refused(".", {"many/10.xml.gz"});
}

TEST_F(MissingScenes, OtherFilesAreToldWhatTheyAreFor) {
  for (const char* name : {"a.exr", "a.PNG", "a.kpt", "a.kpm", "a.kln", "a.blend"})
    write(name, "?");
  expect_refused("a.exr", {"kaustik tonemap a.exr -o PICTURE.png", "Mitsuba XML (.xml)"}, "view");
  expect_refused("a.PNG", {"kaustik tonemap a.PNG"}, "view");
  expect_refused("a.kpt", {"kaustik resume a.kpt"});
  expect_refused("a.kpm", {"integrator.photon_map=a.kpm"});
  expect_refused("a.kln", {"--learned a.kln"});
  expect_refused("a.blend", {"no scene in a format", "Mitsuba XML (.xml)"});
  const RunResult command = run({"a.kpt"});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_TRUE(contains(command.err, "'a.kpt' is no command") &&
              contains(command.err, "kaustik resume a.kpt"))
      << command.err;
}

}  // namespace
}  // namespace kaustik::test
