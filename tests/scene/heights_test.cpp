// Textures in shapes: heights of a height field; in other shapes they mean nothing here.

#include <fstream>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::test {
namespace {

std::string field(const std::string& inside) {
  return any_camera + std::string("\n<shape type=\"heightfield\">") + inside + "</shape>";
}
const TriangleMesh& mesh_of(const Scene& scene) { return *scene.tracer().shape(0).mesh(); }

/// Three columns of grey in two rows: 0.1 to 0.6.
std::string picture_in(const TemporaryFolder& folder) {
  std::ofstream file(folder.path("steps.pfm"), std::ios::binary);
  file << "Pf\n3 2\n-1.0\n";
  for (const float value : {0.4f, 0.5f, 0.6f, 0.1f, 0.2f, 0.3f})
    file.write(reinterpret_cast<const char*>(&value), sizeof(value));
  return "<string name=\"filename\" value=\"" + folder.path("steps.pfm") + "\"/>";
}

TEST(Heights, ComeFromTextures) {
  const TemporaryFolder folder;
  const std::string bitmap = "<texture type=\"bitmap\">" + picture_in(folder) + "</texture>";
  const auto scene = scene_of(field(bitmap + "<float name=\"scale\" value=\"10\"/>"));
  EXPECT_TRUE(scene->warnings().empty());
  ASSERT_EQ(mesh_of(*scene).positions.size(), 6u);
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(mesh_of(*scene).positions[size_t(i)].z, i + 1, 1e-4f) << i;
  // Times a factor, and by reference.
  const auto scaled =
      scene_of("<texture id=\"t\" type=\"scale\"><float name=\"scale\" value=\"5\"/>" + bitmap +
               "</texture>" + field("<ref id=\"t\"/>"));
  ASSERT_EQ(mesh_of(*scaled).positions.size(), 6u);
  EXPECT_NEAR(mesh_of(*scaled).positions[5].z, 3, 1e-4f);
  // As many as the shape says; of a pattern so many, else 256.
  const std::string sizes =
      "<integer name=\"width\" value=\"5\"/><integer name=\"height\" value=\"4\"/>";
  EXPECT_EQ(mesh_of(*scene_of(field(bitmap + sizes))).positions.size(), 20u);
  const std::string board =
      "<texture type=\"checkerboard\"><rgb name=\"color0\" value=\"0.25\"/>"
      "</texture>";
  EXPECT_EQ(mesh_of(*scene_of(field(board + sizes))).positions.size(), 20u);
  const auto usual = scene_of(field(board));
  EXPECT_EQ(mesh_of(*usual).positions.size(), 256u * 256u);
  EXPECT_NEAR(mesh_of(*usual).positions[0].z, 0.25f, 1e-6f);
  EXPECT_NEAR(mesh_of(*usual).positions[255].z, 0.2f, 1e-6f);
}

TEST(Heights, OfFilesOfMitsuba06) {
  const TemporaryFolder folder;
  const std::string text =
      "<scene version=\"0.6.0\"><sensor type=\"perspective\"/><shape type=\"heightfield\">" +
      picture_in(folder) +
      "<float name=\"scale\" value=\"2\"/><boolean name=\"shadingNormals\" value=\"false\"/>"
      "<transform name=\"toWorld\"><scale value=\"3\"/></transform></shape></scene>";
  const auto scene = build_scene(parse_mitsuba_xml(text, "t.xml", ""));
  ASSERT_EQ(mesh_of(*scene).positions.size(), 6u);
  EXPECT_LT(length(mesh_of(*scene).positions[5] - Vec3f(3, 3, 3.6f)), 1e-5f);
  EXPECT_TRUE(mesh_of(*scene).normals.empty());
}

TEST(Heights, AreMadeAnewWhereTheirTextureChanges) {
  const auto described = [](const std::string& color) {
    return description_of(field("<texture type=\"checkerboard\"><rgb name=\"color0\" value=\"" +
                                color +
                                "\"/></texture><integer name=\"width\" value=\"2\"/>"
                                "<integer name=\"height\" value=\"2\"/>"));
  };
  const auto first = build_scene(described("0.5"));
  const auto same = build_scene(described("0.5"), first);
  EXPECT_EQ(same->build_counts().shapes, 0);
  const auto other = build_scene(described("0.75"), first);
  EXPECT_EQ(other->build_counts().shapes, 1);
  EXPECT_NEAR(mesh_of(*other).positions[0].z, 0.75f, 1e-6f);
}

TEST(Heights, AreGivenOnce) {
  const TemporaryFolder folder;
  const std::string board = "<texture type=\"checkerboard\"/>";
  const auto problem = [](const std::string& text, const std::string& message) {
    const std::vector<Problem> problems = test::problems_of(text);
    ASSERT_FALSE(problems.empty()) << message;
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty()) << problems[0].message;
  };
  problem(field(board + board), "second texture");
  problem(field(board + picture_in(folder)), "filename");
  problem(field(""), "filename");
  problem(field("<texture type=\"chekerboard\"/>"), "unknown texture type");
  problem(field(board + "<integer name=\"width\" value=\"100000\"/>"), "'width' is 100000");
}

// What is refused is not made before: as many heights would take the memory of any machine.
TEST(Heights, OfHostileSizes) {
  for (const std::string texture : {"<texture type=\"checkerboard\"/>", ""})
    for (const std::string size : {"1000000000", "9223372036854775807", "-5", "1", "0"}) {
      const std::vector<Problem> problems =
          test::problems_of(field(texture + "<integer name=\"width\" value=\"" + size +
                                  "\"/><integer name=\"height\" value=\"" + size + "\"/>"));
      ASSERT_GE(problems.size(), 2u);
      EXPECT_NE(problems[0].message.find("'width' is "), std::string::npos) << problems[0].message;
      EXPECT_NE(problems[1].message.find("'height' is "), std::string::npos) << problems[1].message;
      for (const Problem& p : problems) EXPECT_FALSE(p.remedy.empty()) << p.message;
    }
}

/// Attributes of shapes that Mitsuba keeps for integrators.
TEST(Heights, AreNoneInOtherShapes) {
  const std::string painted =
      "\n<shape type=\"sphere\"><texture type=\"bitmap\" name=\"vertex_color\"/></shape>";
  const auto scene = scene_of(any_camera + painted + painted);
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_EQ(scene->warnings()[0], "test.xml:3:22: a texture in shape 'sphere' has no effect");
}

}  // namespace
}  // namespace kaustik::test
