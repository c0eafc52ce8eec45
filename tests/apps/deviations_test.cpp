// What the program tells of scenes that are not rendered as they are written.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Deviations : public ProgramTest {
 protected:
  Deviations() {
    write(
        "scene.pbrt",
        "LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 "
        "\"integer yresolution\" 8 WorldBegin LightSource \"infinite\"\n"
        "Material \"hair\"\nShape \"sphere\"\nMaterial \"measured\"\nShape \"sphere\"\n"
        "Option \"odd\" 1\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no.png\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"trianglemesh\" \"point3 P\" "
        "[0 0 0 1 0 0 0 1 0]\n");
  }
};

TEST_F(Deviations, InfoListsAllAndCountsThem) {
  const std::string out = run_well({"info", "scene.pbrt"}).out;
  EXPECT_TRUE(contains(out, "approximated: material 'hair': hair is rendered as a glossy coat"))
      << out;
  EXPECT_TRUE(contains(out, "(scene.pbrt:2:1)")) << out;
  EXPECT_TRUE(contains(out, "ignored: option 'odd'")) << out;
  EXPECT_TRUE(contains(out, "missing: texture 't': picture 'no.png' is not there")) << out;
  EXPECT_TRUE(out.ends_with("2 approximated, 1 ignored, 1 missing\n")) << out;
}

TEST_F(Deviations, RenderTellsTheFirst) {
  const std::string err =
      run_well({"render", "scene.pbrt", "-o", "a.exr", "--passes", "1", "--spp", "1"}).err;
  EXPECT_TRUE(contains(err, "2 approximated, 1 ignored, 1 missing")) << err;
  EXPECT_TRUE(contains(err, "no.png")) << err;  // what is missing before all
  EXPECT_TRUE(contains(err, "and 1 more: kaustik info lists them")) << err;
}

TEST_F(Deviations, StrictRefusesThem) {
  const RunResult result = run({"render", "scene.pbrt", "-o", "a.exr", "--strict"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "hair is rendered")) << result.err;
}

TEST_F(Deviations, ConvertTellsThemAndWritesBuffersAsFiles) {
  const std::string err = run_well({"convert", "scene.pbrt", "-o", "new.xml"}).err;
  for (const char* text : {"hair is rendered", "option 'odd'", "no.png", "new_mesh.ply"})
    EXPECT_TRUE(contains(err, text)) << text << "\n" << err;
  EXPECT_TRUE(contains(contents("new.xml"), "new_mesh.ply"));
  EXPECT_TRUE(contains(run_well({"info", "new.xml"}).out, "1 triangles"));
}

}  // namespace
}  // namespace kaustik::test
