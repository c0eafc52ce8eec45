// `kaustik convert`: what it writes renders as what it has read.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Convert : public ProgramTest {
 protected:
  bool same_pixels(const std::string& a, const std::string& b) const {
    return compare_images(read_image(path(a)), read_image(path(b))).mse == 0;
  }
  /// By how much the pictures of two scenes differ at most, of what a pixel has.
  double difference(const std::string& a, const std::string& b) const {
    for (const auto& [scene, picture] : {std::pair(a, "a.pfm"), {b, "b.pfm"}})
      run_well({"render", scene, "--integrator", "path", "--passes", "1", "--spp", "4", "--seed",
                "1", "-q", "-o", picture});
    const Image first = read_image(path("a.pfm")), second = read_image(path("b.pfm"));
    const RgbView x = rgb_view(first), y = rgb_view(second);
    double largest = 0;
    for (size_t i = 0; i < first.pixel_count(); ++i)
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::fabs(double(x[i][c]) - double(y[i][c])) /
                                        (std::fabs(double(x[i][c])) + 1e-3));
    return largest;
  }
  void write_two_materials() const {
    write("two.obj",
          "mtllib two.mtl\nv -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 "
          "0\nvt 1 1\nusemtl red\nf 1/1 2/2 3/3 4/1\nusemtl ../blue\nf 2/1 5/2 6/3 3/1\n");
    write("two.mtl", "newmtl red\nKd 0.7 0.1 0.1\nnewmtl ../blue\nKd 0.1 0.2 0.7\n");
  }
};

std::string old_scene(const std::string& inside) {
  return "<scene version='0.6.0'><sensor type='perspective'><transform name='toWorld'><lookAt "
         "origin='0, 1, 4' target='0, 0.5, 0' up='0, 1, 0'/></transform><film type='hdrfilm'>"
         "<integer name='width' value='12'/><integer name='height' value='12'/></film></sensor>"
         "<emitter type='point'><point name='position' x='1' y='3' z='3'/></emitter>" +
         inside + "</scene>";
}

TEST_F(Convert, WritesTheSameScene) {
  write("old.xml",
        "<scene version=\"0.6.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\"><integer "
        "name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film></sensor>"
        "<shape type=\"sphere\"><transform name=\"toWorld\"><translate z=\"4\"/></transform>"
        "<emitter type=\"area\"/></shape></scene>");
  const RunResult converted = run_well({"convert", "old.xml", "-o", "new.xml"});
  EXPECT_TRUE(contains(converted.err, "wrote new.xml")) << converted.err;
  EXPECT_TRUE(contains(contents("new.xml"), "<scene version=\"3.0.0\">"));
  run_well({"render", "old.xml", "--spp", "4", "-o", "old.exr"});
  run_well({"render", "new.xml", "--spp", "4", "-o", "new.exr"});
  EXPECT_TRUE(same_pixels("old.exr", "new.exr"));
  const RunResult other = run({"convert", "old.xml", "-o", "new.obj"});
  EXPECT_TRUE(contains(other.err, "'new.obj' is not the name of an XML file")) << other.err;
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(run_well({"convert", "old.xml", "-o", "loud.XML"}).err,
                       "all meshes and pictures are named as before"));
  // A scene is not replaced by mistake, and never by itself.
  EXPECT_TRUE(contains(run({"convert", "old.xml", "-o", "new.xml"}).err, "--force"));
  run_well({"convert", "old.xml", "-o", "new.xml", "--force"});
  EXPECT_TRUE(contains(run({"convert", "old.xml", "-o", "old.xml", "--force"}).err,
                       "read by this command"));
}

TEST_F(Convert, MeshesInPartsAreFiles) {
  write_two_materials();
  write("old.xml", old_scene("<shape type='obj'><string name='filename' value='two.obj'/>"
                             "<transform name='toWorld'><rotate y='1' angle='20'/></transform>"
                             "</shape>"));
  std::filesystem::create_directory(path("out"));
  const RunResult converted = run_well({"convert", "old.xml", "-o", "out/new.xml"});
  EXPECT_TRUE(contains(converted.err, "wrote out/new_two_red.ply")) << converted.err;
  EXPECT_TRUE(contains(converted.err, "all other meshes and pictures")) << converted.err;
  EXPECT_FALSE(contains(contents("out/new.xml"), "material"));
  EXPECT_TRUE(contains(contents("out/new.xml"), "value=\"new_two_.._blue.ply\""))
      << contents("out/new.xml");
  EXPECT_EQ(difference("old.xml", "out/new.xml"), 0);
  // Other contents tell.
  std::string mesh = contents("out/new_two_red.ply");
  mesh[mesh.find("end_header") + 11 + 3] ^= 1;  // the first vertex, elsewhere
  write("out/new_two_red.ply", mesh);
  EXPECT_GT(difference("old.xml", "out/new.xml"), 0);
}

TEST_F(Convert, ReplacesNoMeshUntold) {
  write_two_materials();
  write("old.xml",
        old_scene("<shape type='obj'><string name='filename' value='two.obj'/></shape>"));
  write("new_two_red.ply", "somebody's");
  const RunResult refused = run({"convert", "old.xml", "-o", "new.xml"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "'new_two_red.ply' is there already")) << refused.err;
  EXPECT_EQ(contents("new_two_red.ply"), "somebody's");
  EXPECT_FALSE(exists("new.xml"));
  EXPECT_FALSE(exists("new_two_.._blue.ply"));
  run_well({"convert", "old.xml", "-o", "new.xml", "--force"});
  EXPECT_TRUE(contents("new_two_red.ply").starts_with("ply"));
}

/// A scene that cannot be written whole leaves nothing.
TEST_F(Convert, LeavesNoPartsBehind) {
  write_two_materials();
  write("broken.obj", "v 0 0 0\nf 1 2 3\n");
  write("old.xml",
        old_scene("<shape type='obj'><string name='filename' value='two.obj'/></shape><shape "
                  "type='obj'><string name='filename' value='broken.obj'/><integer "
                  "name='shapeIndex' value='0'/></shape>"));
  const std::vector<std::string> before = files();
  const RunResult failed = run({"convert", "old.xml", "-o", "new.xml"});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_TRUE(contains(failed.err, "broken.obj:2")) << failed.err;
  EXPECT_TRUE(contains(failed.err, "(named in old.xml:1:")) << failed.err;
  EXPECT_EQ(files(), before);
  // Of a file that is not there the scene's line is told.
  std::filesystem::remove(path("broken.obj"));
  const RunResult missing = run({"convert", "old.xml", "-o", "new.xml"});
  EXPECT_TRUE(contains(missing.err, "old.xml:1:")) << missing.err;
}

/// All else that becomes a file, in one scene.
TEST_F(Convert, FieldsAndPicturesAreFiles) {
  write("pic.ppm", "P3\n3 2\n255\n255 0 9 30 200 5 6 7 250\n9 90 200 40 50 200 255 255 255\n");
  write("colours.obj", "v -1 0 0 1 0 0\nv 0 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  const auto bitmap = [&](const std::string& name, const std::string& inside) {
    return "<texture type='bitmap'" + name + "><string name='filename' value='pic.ppm'/>" + inside +
           "</texture>";
  };
  const auto place = [](const std::string& x) {
    return "<transform name='toWorld'><scale value='0.5'/><translate x='" + x +
           "' y='0.4'/></transform>";
  };
  write(
      "old.xml",
      old_scene(
          "<shape type='heightfield'><texture type='scale'><float name='scale' value='0.3'/>" +
          bitmap("", "") + "</texture><integer name='width' value='7'/>" + place("-1") +
          "</shape><shape type='rectangle'>" + place("0") +
          "<bsdf type='diffuse'><texture type='scale' name='reflectance'><rgb name='scale' "
          "value='0.2, 0.8, 0.5'/>" +
          bitmap("", "<float name='uscale' value='2'/>") +
          "</texture></bsdf></shape><shape type='rectangle'>" + place("1") +
          "<bsdf type='blendbsdf'>" +
          bitmap(" name='weight'", "<string name='channel' value='r'/>") +
          "<bsdf type='diffuse'/><bsdf type='diffuse'>" +
          bitmap(" name='reflectance'", "<float name='gamma' value='1.5'/>") +
          "</bsdf></bsdf></shape><shape type='obj'><string name='filename' value='colours.obj'/>" +
          place("0.3") +
          "<bsdf type='twosided'><bsdf type='diffuse'><texture type='vertexcolors' "
          "name='reflectance'/></bsdf></bsdf></shape>"));
  const RunResult converted = run_well({"convert", "old.xml", "-o", "new.xml"});
  EXPECT_FALSE(contains(converted.err, "Mitsuba 3 has no")) << converted.err;
  const std::vector<std::string> written = files();
  for (const char* name :
       {"new_heightfield.ply", "new_colours.ply", "new_pic.exr", "new_pic_2.exr", "new_pic_3.exr"})
    EXPECT_TRUE(std::ranges::find(written, name) != written.end()) << name;
  // Products are rounded before filtering instead of after it.
  EXPECT_LT(difference("old.xml", "new.xml"), 1e-5);
}

/// What pbrt keeps in its text, or means in another way than Mitsuba.
TEST_F(Convert, GridsAndMeshesOfPbrtAreFiles) {
  write("pic.ppm", "P3\n2 1\n255\n255 0 9 30 200 5\n");
  write("old.pbrt", R"(LookAt 0 1 4 0 .5 0 0 1 0
    Camera "perspective" "float fov" 40
    Film "rgb" "integer xresolution" 12 "integer yresolution" 12
    WorldBegin
    LightSource "point" "rgb I" [9 9 9] "point3 from" [1 3 3]
    MakeNamedMedium "ball" "string type" "uniformgrid" "integer nx" 2 "float density" [1 3]
      "rgb sigma_a" [1 2 3] "rgb sigma_s" [3 2 1] "point3 p0" [-.5 0 -.5] "point3 p1" [.5 1 .5]
    MakeNamedMaterial "ball" "string type" "diffuse"
    Texture "t" "float" "imagemap" "string filename" "pic.ppm" "bool invert" true
    AttributeBegin
      Material "interface" MediumInterface "ball" ""
      Translate 0 .5 0 Shape "sphere" "float radius" .5
    AttributeEnd
    NamedMaterial "ball"
    Shape "trianglemesh" "point3 P" [-2 0 -2 2 0 -2 2 3 -2] "normal N" [0 0 -1 0 0 -1 0 0 -1]
      "point2 uv" [0 0 1 0 1 1] "texture alpha" "t"
    AreaLightSource "diffuse"
    Shape "trianglemesh" "point3 P" [-2 2 -1 2 2 -1 0 2 1] "normal N" [0 1 0 0 1 0 0 1 0])");
  run_well({"convert", "old.pbrt", "-o", "new.xml"});
  const std::vector<std::string> written = files();
  for (const char* name : {"new_gridvolume.vol", "new_mesh.ply", "new_mesh_2.ply", "new_pic.exr"})
    EXPECT_TRUE(std::ranges::find(written, name) != written.end()) << name;
  EXPECT_LT(difference("old.pbrt", "new.xml"), 1e-5);
}

/// Buffers that are no meshes: light from around, and a volume of samples.
TEST_F(Convert, SkiesAndPatternsOfRadianceAreFiles) {
  write("old.rad",
        "!gensky 6 21 14 +s\nskyfunc glow sky_glow 0 0 4 1 1 1 0\n"
        "sky_glow source sky 0 0 4 0 0 1 180\nvoid brightfunc ramp 2 Px/4+.5 . 0 0\n"
        "ramp plastic paint 0 0 5 .8 .5 .3 0 0\npaint ring floor 0 0 8 0 0 0 0 0 1 0 2\n"
        "paint sphere ball 0 0 4 0 0 .5 .5\n");
  write("old.rif", "scene= old.rad\nRESOLUTION= 12\nview= v -vp 0 -4 2 -vd 0 4 -2 -vh 50 -vv 50\n");
  const RunResult converted = run_well({"convert", "old.rif", "-o", "new.xml"});
  const std::vector<std::string> written = files();
  for (const char* name : {"new_bitmap.exr", "new_gridvolume.vol"})
    EXPECT_TRUE(std::ranges::find(written, name) != written.end()) << name << converted.err;
  EXPECT_LT(difference("old.rif", "new.xml"), 1e-6);
}

// A signal that comes between two of its files leaves none of them.
TEST_F(Convert, ASignalLeavesAllOrNothing) {
  std::string scene = "WorldBegin\nLightSource \"lava\"\n";
  constexpr int meshes = 400;
  for (int i = 0; i < meshes; ++i)
    scene += "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 " +
             std::to_string(i + 1) + "]\n";
  write("s.pbrt", scene);
  RunOptions how;
  how.interrupt_at = "lava";
  how.signals = {SIGTERM};
  const RunResult result = run({"convert", "s.pbrt", "-o", "s.xml"}, how);
  const size_t all = 2 + meshes;
  EXPECT_EQ(files().size(), exists("s.xml") ? all : 1u) << result.err;
  // Before it has begun to write and after the last file a signal ends it as usual.
  if (result.signal != SIGTERM) {
    EXPECT_EQ(result.exit_code, exists("s.xml") ? 0 : 75) << result.err;
  }
}

}  // namespace
}  // namespace kaustik::test
