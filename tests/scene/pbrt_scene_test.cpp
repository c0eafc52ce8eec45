// Scenes of pbrt are built without a word: all that its reader writes is what the tables take; and
// what is seen lies where pbrt shows it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kaustik/loader/pbrt_scene.h"
#include "kaustik/scene/scene.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

std::shared_ptr<const Scene> built(const std::string& text, const std::string& folder = "") {
  return build_scene(parse_pbrt(text, "test.pbrt", folder));
}

/// Of a ball of the material under a lamp; nothing may be told by the builder.
void expect_sound(const std::string& lines) {
  SCOPED_TRACE(lines);
  try {
    const auto scene = built(
        "LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin LightSource \"point\" "
        "\"point3 from\" [0 5 5]\n" +
        lines + "\nShape \"sphere\"\n");
    for (const std::string& warning : scene->warnings()) ADD_FAILURE() << warning;
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
}

TEST(PbrtScene, AllMaterialsAreBuilt) {
  for (const char* type : {"diffuse",     "coateddiffuse",   "conductor",
                           "dielectric",  "thindielectric",  "diffusetransmission",
                           "hair",        "interface",       "measured",
                           "subsurface",  "coatedconductor", "matte",
                           "plastic",     "substrate",       "uber",
                           "glass",       "metal",           "mirror",
                           "translucent", "kdsubsurface",    "disney",
                           "fourier"})
    for (const char* roughness : {"", "\"float roughness\" .2"})
      expect_sound(fmt::format("Material \"{}\" {}", type, roughness));
  for (const char* spectrum :
       {"\"rgb reflectance\" [.1 .2 .3]", "\"spectrum reflectance\" [400 .1 700 .9]",
        "\"blackbody reflectance\" 3000", "\"spectrum reflectance\" \"stdillum-A\""})
    for (const char* type : {"diffuse", "coateddiffuse", "conductor", "diffusetransmission"})
      expect_sound(fmt::format("Material \"{}\" {}", type, spectrum));
  for (const char* eta : {"\"spectrum eta\" \"metal-TiO2-eta\"",
                          "\"spectrum eta\" [400 1 700 2] "
                          "\"rgb k\" [1 2 3]",
                          "\"float eta\" 2 \"float k\" 3"})
    expect_sound(fmt::format("Material \"conductor\" {}", eta));
  expect_sound(
      "Material \"coatedconductor\" \"float conductor.roughness\" .3 "
      "\"float interface.roughness\" .1 \"rgb conductor.eta\" [1 2 3] "
      "\"rgb conductor.k\" [3 3 3]");
}

TEST(PbrtScene, AllTexturesAreBuilt) {
  for (const char* texture : {"constant", "checkerboard", "dots", "fbm", "wrinkled", "windy",
                              "marble", "bilerp", "directionmix", "ptex", "imagemap"})
    expect_sound(
        fmt::format("Texture \"t\" \"spectrum\" \"{}\"\nMaterial \"diffuse\" "
                    "\"texture reflectance\" \"t\"",
                    texture));
  const std::string two =
      "Texture \"a\" \"spectrum\" \"checkerboard\"\nTexture \"b\" \"spectrum\" \"bilerp\"\n"
      "Texture \"w\" \"float\" \"checkerboard\" \"float uscale\" 3\n";
  expect_sound(two +
               "Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"a\" \"texture tex2\" "
               "\"b\" \"texture amount\" \"w\"\nMaterial \"coateddiffuse\" \"texture "
               "reflectance\" \"t\"");
  expect_sound(two +
               "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"texture scale\" "
               "\"w\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"");
  expect_sound(two + "Material \"diffuse\" \"texture displacement\" \"w\"");
  expect_sound(two + "Material \"conductor\" \"texture roughness\" \"w\"");
  expect_sound(two +
               "Material \"dielectric\" \"texture uroughness\" \"w\" \"float vroughness\" .1");
  expect_sound(two + "Material \"conductor\" \"texture reflectance\" \"a\"");
}

TEST(PbrtScene, AllLampsShapesAndMediaAreBuilt) {
  for (const char* lamp :
       {"\"point\" \"float power\" 10", "\"spot\"", "\"spot\" \"float coneangle\" 120",
        "\"distant\" \"blackbody L\" 5000", "\"infinite\"", "\"goniometric\"",
        "\"projection\" \"string filename\" \"x\""})
    expect_sound(fmt::format("LightSource {}", lamp));
  for (const char* shape :
       {"\"sphere\" \"float zmax\" .5", "\"cylinder\"", "\"cylinder\" \"float phimax\" 200",
        "\"disk\"", "\"disk\" \"float innerradius\" .5",
        "\"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]",
        "\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]",
        "\"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 1]",
        "\"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 2 1 3]"})
    for (const char* lamp : {"", "AreaLightSource \"diffuse\" \"float power\" 5"})
      expect_sound(fmt::format("AttributeBegin {}\nShape {}\nAttributeEnd", lamp, shape));
  expect_sound("Texture \"w\" \"float\" \"checkerboard\" Shape \"disk\" \"texture alpha\" \"w\"");
  expect_sound(
      "ObjectBegin \"o\" Shape \"disk\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\" "
      "Translate 3 0 0 ObjectInstance \"o\"");
  for (const char* medium :
       {"\"homogeneous\"", "\"homogeneous\" \"string preset\" \"Skin1\"",
        "\"homogeneous\" \"spectrum sigma_a\" [400 1 700 2] \"float g\" -.5",
        "\"uniformgrid\" \"integer nx\" 2 \"float density\" [0 1] \"rgb sigma_a\" [1 2 3]",
        "\"rgbgrid\" \"rgb sigma_a\" [1 2 3]", "\"cloud\" \"point3 p1\" [1 .1 .1]"})
    expect_sound(
        fmt::format("MakeNamedMedium \"m\" \"string type\" {}\nMediumInterface \"m\" \"\" "
                    "Material \"interface\"",
                    medium));
}

TEST(PbrtScene, AllCamerasAreBuilt) {
  for (const char* camera : {"\"perspective\" \"float lensradius\" .1",
                             "\"perspective\" \"float screenwindow\" [0 1 0 1]", "\"orthographic\"",
                             "\"orthographic\" \"float lensradius\" .1", "\"spherical\"",
                             "\"realistic\" \"string lensfile\" \"x\"", "\"environment\""})
    for (const char* film : {"",
                             "Film \"rgb\" \"integer xresolution\" 50 \"float cropwindow\" "
                             "[.2 .4 0 1] \"float iso\" 50"})
      for (const char* filter : {"box", "triangle", "gaussian", "mitchell", "sinc"}) {
        SCOPED_TRACE(camera);
        EXPECT_NO_THROW(
            built(fmt::format("Scale -1 1 1 LookAt 0 0 5 0 0 0 0 1 0 Camera {} {} "
                              "PixelFilter \"{}\" WorldBegin Shape \"sphere\"",
                              camera, film, filter)));
      }
}

/// Shapes that the camera sees through the middle of nine parts of the picture, row by row.
std::string chart(const Scene& scene) {
  std::string seen;
  const Vec2i size = scene.film().size;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const Vec2f raster((float(column) + .5f) / 3 * float(size.x),
                         (float(row) + .5f) / 3 * float(size.y));
      const CameraRay ray = scene.camera().sample_ray(raster, {});
      Hit hit;
      seen += scene.tracer().intersect(ray, hit) ? char('a' + hit.shape) : '.';
    }
  return seen;
}

/// Balls a above, b right, c below, d left of the middle, in the space of pbrt's camera.
std::string balls(const std::string& before) {
  return before + R"( Film "rgb" "integer xresolution" 90 "integer yresolution" 90
    WorldBegin CoordSysTransform "camera" Translate 0 0 10
    AttributeBegin Translate 0 5 0 Shape "sphere" AttributeEnd
    AttributeBegin Translate 5 0 0 Shape "sphere" AttributeEnd
    AttributeBegin Translate 0 -5 0 Shape "sphere" AttributeEnd
    AttributeBegin Translate -5 0 0 Shape "sphere" AttributeEnd)";
}

TEST(PbrtScene, CamerasShowUpAboveAndRightOnTheRight) {
  for (const char* place : {"", "LookAt 1 2 3 0 0 0 0 0 1", "Scale -1 1 1 LookAt 1 2 3 0 0 0 0 0 1",
                            "Rotate 30 1 2 3 Translate 4 5 6"}) {
    // tan 36.87° = 0.75, and two thirds of that at the middle of the outer parts.
    const std::string fov = "\"float fov\" 73.74";
    EXPECT_EQ(chart(*built(balls(fmt::format("{} Camera \"perspective\" {}", place, fov)))),
              ".a.d.b.c.")
        << place;
    EXPECT_EQ(
        chart(*built(balls(fmt::format(
            "{} Camera \"orthographic\" \"float screenwindow\" [-7.5 7.5 -7.5 7.5]", place)))),
        ".a.d.b.c.")
        << place;
  }
  // The window's middle is the right ball.
  EXPECT_EQ(chart(*built(balls("Camera \"orthographic\" \"float screenwindow\" [-2.5 12.5 -7.5 "
                               "7.5]"))),
            "a...b.c..");
  EXPECT_EQ(chart(*built(balls("Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" "
                               "[-.75 .75 -.25 1.25]"))),
            "....a.d.b");
}

TEST(PbrtScene, NormalsAreThoseOfPbrt) {
  // Which side is the front: of a triangle wound anticlockwise seen from +z.
  const auto front = [](const std::string& before) {
    const auto scene =
        built("WorldBegin " + before + " Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]");
    const TriangleMesh& mesh = *scene->tracer().shape(0).mesh();
    const auto& t = mesh.triangles[0];
    return cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                 mesh.positions[t[2]] - mesh.positions[t[0]])
                       .z > 0
               ? 1
               : -1;
  };
  EXPECT_EQ(front(""), 1);
  EXPECT_EQ(front("ReverseOrientation"), -1);
  EXPECT_EQ(front("Scale -1 1 1"), 1);  // the mesh is mirrored with its front
  EXPECT_EQ(front("Scale -1 1 1 ReverseOrientation"), -1);
}

}  // namespace
}  // namespace kaustik::test
