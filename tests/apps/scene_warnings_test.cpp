// What the program says of scenes whose picture will lack light.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class SceneWarnings : public ProgramTest {
 protected:
  /// What a render of a floor under `inside` says; it must succeed.
  std::string told(const std::string& inside, const std::string& integrator, bool floor = true) {
    write(
        "scene.xml",
        "<scene version=\"3.0.0\"><integrator type=\"" + integrator +
            "\"/><sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"0, -4, "
            "2\" target=\"0, 0, 0\" up=\"0, 0, 1\"/></transform><film type=\"hdrfilm\"><integer "
            "name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film></sensor>" +
            (floor ? "<shape type=\"rectangle\"/>" : "") + inside + "</scene>");
    return run_well({"render", "scene.xml", "-o", "a.exr", "--passes", "1", "--spp", "1"}).err;
  }
  static std::string lid(const std::string& bsdf, const std::string& shape = "rectangle") {
    return "<shape type=\"" + shape +
           "\"><transform name=\"to_world\"><scale value=\"0.5\"/><translate "
           "z=\"1\"/></transform>" +
           bsdf + "</shape>";
  }
};

const std::string point =
    "<emitter type=\"point\"><point name=\"position\" value=\"0, 0, 3\"/></emitter>";
const std::string sun =
    "<emitter type=\"directional\"><vector name=\"direction\" value=\"0, 0, -1\"/></emitter>";
const std::string ball =
    "<shape type=\"sphere\"><point name=\"center\" value=\"0, 0, 3\"/><float name=\"radius\" "
    "value=\"0.2\"/><emitter type=\"area\"/></shape>";
const std::string mask =
    "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf type=\"diffuse\"/></bsdf>";
const std::string glass = "<bsdf type=\"dielectric\"/>";
const std::string never = "never finds light of point, spot and directional lamps";

TEST_F(SceneWarnings, LampsBehindGlass) {
  for (const std::string& lamp : {point, sun})
    for (const std::string& cover : {lid(glass, "sphere"), lid(glass, "cube")}) {
      EXPECT_TRUE(contains(told(lamp + cover, "path"), never)) << lamp << cover;
      EXPECT_TRUE(contains(told(lamp + cover, "volpath"), never)) << lamp << cover;
      EXPECT_FALSE(contains(told(lamp + cover, "auto"), never)) << lamp << cover;
    }
  // All that a path finds.
  EXPECT_FALSE(contains(told(point, "path"), never));
  EXPECT_FALSE(contains(told(point + lid(mask), "path"), never));
  EXPECT_FALSE(contains(told(ball + lid(mask), "path"), never));
  EXPECT_FALSE(contains(told(point + lid("<bsdf type=\"diffuse\"/>"), "path"), never));
  EXPECT_FALSE(contains(told(point + lid("<bsdf type=\"null\"/>"), "path"), never));
  // Glass beside the light's way.
  EXPECT_FALSE(contains(told(point +
                                 "<shape type=\"sphere\"><point name=\"center\" value=\"0, 9, "
                                 "0\"/>" +
                                 glass + "</shape>",
                             "path"),
                        never));
}

TEST_F(SceneWarnings, ScenesWithoutShapes) {
  const std::string environment = "<emitter type=\"constant\"/>";
  for (const std::string integrator : {"auto", "path", "photonmap"})
    EXPECT_FALSE(contains(told(environment, integrator, false), "black")) << integrator;
  EXPECT_TRUE(contains(told(point, "path", false), "no shape that its lamps could light"));
  EXPECT_TRUE(contains(told("", "path", false), "the scene has no light"));
}

TEST_F(SceneWarnings, MitsubasNamesAreTold) {
  const std::string said = told(point, "volpathmis");
  EXPECT_TRUE(contains(said, "integrator 'volpathmis' is called path here")) << said;
  EXPECT_TRUE(contains(run_well({"help", "volpath"}).out, "renderer's name for 'path'"));
}

}  // namespace
}  // namespace kaustik::test
