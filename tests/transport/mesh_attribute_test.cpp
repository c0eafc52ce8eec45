// Colours of a mesh where rays meet it: as it stands, placed, and as an instance.

#include <gtest/gtest.h>

#include <fstream>

#include "kaustik/transport/vertex.h"
#include "tests/support/temporary_folder.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using test::scene_of;

/// Red rises along x, green along y; the third corner of each face is blue besides.
std::string coloured_square(const test::TemporaryFolder& folder, const std::string& to_world) {
  std::ofstream(folder.path("square.ply"))
      << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty float r\nproperty float g\nproperty float b\n"
         "element face 2\nproperty list uchar int vertex_indices\nproperty float part_x\n"
         "end_header\n0 0 0 0 0 0\n1 0 0 1 0 0\n1 1 0 1 1 0\n0 1 0 0 1 0\n"
         "3 0 1 2 0.25\n3 0 2 3 0.75\n";
  return "<shape type=\"ply\"><string name=\"filename\" value=\"" + folder.path("square.ply") +
         "\"/><transform name=\"to_world\">" + to_world +
         "</transform><bsdf type=\"twosided\"><bsdf type=\"diffuse\">"
         "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" "
         "value=\"ATTRIBUTE\"/></texture></bsdf></bsdf></shape>";
}

Spectrum colour_at(const Scene& scene, const Vec3f& at) {
  const Ray ray{at + Vec3f(0, 0, 3), {0, 0, -1}};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  SurfaceVertex vertex;
  vertex.meet(scene, ray, hit, TransportMode::radiance);
  return vertex.albedo(Lobes::all);
}

std::string shown_by(std::string text, const std::string& attribute) {
  return text.replace(text.find("ATTRIBUTE"), 9, attribute);
}

TEST(MeshAttributeVertex, HasTheColourOfItsPlace) {
  const test::TemporaryFolder folder;
  const std::string plain = coloured_square(folder, "");
  const std::string moved = coloured_square(folder, "<scale value=\"0.5\"/><translate x=\"4\"/>");
  const std::string instance =
      "<shape type=\"shapegroup\" id=\"g\">" + plain +
      "</shape><shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">"
      "<scale value=\"2\"/><translate y=\"-5\"/></transform></shape>";
  struct Placed {
    std::string text;
    Vec3f origin;
    float scale;
  };
  for (const Placed& placed : {Placed{plain, {0, 0, 0}, 1}, Placed{moved, {4, 0, 0}, 0.5f},
                               Placed{instance, {0, -5, 0}, 2}}) {
    const auto colours = scene_of(shown_by(placed.text, "vertex_color"));
    const auto parts = scene_of(shown_by(placed.text, "face_part"));
    for (float x = 0.05f; x < 1; x += 0.1f)
      for (float y = 0.02f; y < 1; y += 0.1f) {
        const Vec3f at = placed.origin + Vec3f(x, y, 0) * placed.scale;
        const Spectrum colour = colour_at(*colours, at);
        EXPECT_NEAR(colour[0], x, 1e-5f);
        EXPECT_NEAR(colour[1], y, 1e-5f);
        EXPECT_NEAR(colour[2], 0, 1e-5f);
        EXPECT_EQ(colour_at(*parts, at)[0], x > y ? 0.25f : 0.75f);
      }
  }
}

/// As heights they are a plane that rises: the normal leans by its slope, at any scale of an
/// instance.
TEST(MeshAttributeVertex, BendsNormalsByTheSlopeOfItsHeights) {
  const test::TemporaryFolder folder;
  std::string relief = coloured_square(folder, "");
  relief = shown_by(relief, "vertex_color");
  relief.replace(relief.find("<bsdf type=\"twosided\"><bsdf type=\"diffuse\">"), 43,
                 "<bsdf type=\"bumpmap\"><bsdf type=\"diffuse\"/>");
  relief.replace(relief.find("</bsdf></bsdf>"), 14, "</bsdf>");
  const auto scene = scene_of(relief);
  const Ray ray{{0.3f, 0.6f, 3}, {0, 0, -1}};
  Hit hit;
  ASSERT_TRUE(scene->intersect(ray, hit));
  SurfaceVertex vertex;
  vertex.meet(*scene, ray, hit, TransportMode::radiance);
  const Vec3f slope(luminance_of({1, 0, 0, 0}), luminance_of({0, 1, 0, 0}), 0);
  EXPECT_LT(length(vertex.normal() - normalize(Vec3f(0, 0, 1) - slope)), 1e-5f);
}

}  // namespace
}  // namespace kaustik
