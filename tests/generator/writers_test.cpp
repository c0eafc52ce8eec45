#include <gtest/gtest.h>

#include <string_view>

#include "kit/primitives.h"
#include "kit/scene_folder.h"

namespace kaustik::scenes {
namespace {

std::string as_text(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(PlyWriter, SizesFollowTheLayout) {
  const Mesh cube = box({0, 0, 0}, {1, 1, 1});
  const auto body = [&](const PlyLayout& layout) {
    const std::string text = as_text(ply_bytes(cube, layout));
    return text.size() - (text.find("end_header\n") + 11);
  };
  constexpr size_t faces = 12 * (1 + 3 * 2);
  EXPECT_EQ(body({.normals = Normals::flat, .uvs = false}), 8 * 12 + faces);
  EXPECT_EQ(body({.normals = Normals::stored, .uvs = false}), 24 * 24 + faces);
  EXPECT_EQ(body({.normals = Normals::stored, .uvs = true}), 24 * 32 + faces);
}

TEST(PlyWriter, LastBitsOfCoordinatesDontShow) {
  Mesh mesh = ball({0, 0, 0}, 1, 16);
  const auto bytes = ply_bytes(mesh, {});
  for (Vertex& v : mesh.vertices) v.position += Vec3d(1e-12);
  EXPECT_EQ(ply_bytes(mesh, {}), bytes);
  for (Vertex& v : mesh.vertices) v.position += Vec3d(1e-3);
  EXPECT_NE(ply_bytes(mesh, {}), bytes);
}

TEST(XmlWriter, ShortElementsStandOnOneLineAndCommentsBefore) {
  Xml scene("scene", {{"version", "3.0.0"}});
  scene.add(object("bsdf", "diffuse", {rgb("reflectance", {0.5, 0.25, 0.125})}, "paint")
                .said("Paint & varnish."));
  scene.add(object("shape", "sphere",
                   {number("radius", 0.1), ref("paint"), transform({translate({0, 0, 1})})}));
  EXPECT_EQ(scene.text(), R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">

  <!-- Paint & varnish. -->
  <bsdf type="diffuse" id="paint"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf>
  <shape type="sphere">
    <float name="radius" value="0.1"/>
    <ref id="paint"/>
    <transform name="to_world"><translate x="0" y="0" z="1"/></transform>
  </shape>
</scene>
)");
}

TEST(XmlWriter, LinesKeepToAHundredColumnsAndValuesAreEscaped) {
  Xml scene("scene");
  scene.add(text("a", "<\"&").said(std::string(40, 'x') + " " + std::string(70, 'y')));
  const std::string out = scene.text();
  EXPECT_NE(out.find("value=\"&lt;&quot;&amp;\""), std::string::npos);
  for (size_t begin = 0, end; (end = out.find('\n', begin)) != std::string::npos; begin = end + 1)
    EXPECT_LE(end - begin, 100u);
}

TEST(SceneFolder, FilesAndMeshesAreNamedOnce) {
  SceneFolder scene("hut", "A hut.");
  scene.add_bsdf("wood", object("bsdf", "diffuse"));
  scene.add_mesh("wall", box({0, 0, 0}, {1, 1, 1}), "wood", {.normals = Normals::flat});
  EXPECT_THROW(scene.write_mesh("wall", box({0, 0, 0}, {1, 1, 1})), std::logic_error);
  EXPECT_THROW(scene.shape("roof", "wood"), std::logic_error);
  const auto files = scene.files();
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].path, "meshes/wall.ply");
  EXPECT_EQ(files[1].path, "hut.xml");
  EXPECT_NE(as_text(files[1].bytes).find("face_normals"), std::string::npos);
}

TEST(Lamps, WattsAreTheLuminousFluxOver179) {
  const Vec3d color(1, 0.8, 0.5);
  EXPECT_NEAR(luminance(lamp_radiance(50, 0.2, color)) * pi_d * 0.2, 50, 1e-9);
  EXPECT_NEAR(luminance(lamp_intensity(50, cone_solid_angle(30), color)) * cone_solid_angle(30), 50,
              1e-9);
  EXPECT_NEAR(cone_solid_angle(180), 4 * pi_d, 1e-12);
}

TEST(Pictures, ArePaintedAlikeFromTheSameSeed) {
  const Picture a = geometric_composition(16, 12, 3), b = geometric_composition(16, 12, 3);
  EXPECT_EQ(ppm_bytes(a), ppm_bytes(b));
  EXPECT_NE(ppm_bytes(a), ppm_bytes(geometric_composition(16, 12, 4)));
  EXPECT_EQ(as_text(ppm_bytes(a)).substr(0, 13), "P6\n16 12\n255\n");
  EXPECT_EQ(ppm_bytes(a).size(), 13 + 16 * 12 * 3u);
}

}  // namespace
}  // namespace kaustik::scenes
