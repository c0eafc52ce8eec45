// Mitsuba's `merge`, shapes that are not here, and files of meshes that are read side by side.

#include "kaustik/scene/merged_shapes.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

std::string merge(const std::string& inside) {
  return "<shape type=\"merge\">" + inside + "</shape>";
}
const std::string shining_disk = "<shape type=\"disk\"><emitter type=\"area\"/></shape>";

TEST(MergedShapes, StandThereThemselves) {
  const auto scene = scene_of(
      any_camera + merge("<shape type=\"cube\"/>" + merge(shining_disk) + any_shape) + any_shape);
  EXPECT_EQ(scene->surface_count(), 4u);
  ASSERT_EQ(scene->lights().size(), 1u);
  EXPECT_EQ(scene->lights()[0]->traits().shape, 1);
  // In groups as well, and none is nothing.
  const auto grouped =
      scene_of(any_camera + merge("") + "<shape type=\"shapegroup\" id=\"g\">" +
               merge("<shape type=\"cube\"/>" + std::string(any_shape)) + "</shape>" +
               "<shape type=\"instance\"><ref id=\"g\"/></shape><shape type=\"instance\"><ref "
               "id=\"g\"/></shape>");
  EXPECT_EQ(grouped->surface_count(), 2u);
  EXPECT_EQ(grouped->tracer().geometry().instances.size(), 2u);
}

TEST(MergedShapes, WithoutOneTheSceneStaysAsItIs) {
  const Description description = description_of(any_camera + std::string(any_shape));
  EXPECT_EQ(without_merges(description.scene), description.scene);
}

TEST(MergedShapes, HoldNothingElse) {
  expect_problem(any_camera + merge("\n<bsdf type=\"diffuse\"/>"), "3:1", "cannot hold a bsdf");
  // 2⁵⁰ of them.
  std::string inside = "<shape type=\"merge\" id=\"m0\">" + std::string(any_shape) + "</shape>";
  for (int i = 1; i <= 50; ++i) {
    const std::string ref = "<ref id=\"m" + std::to_string(i - 1) + "\"/>";
    inside += "<shape type=\"merge\" id=\"m" + std::to_string(i) + "\">" + ref + ref + "</shape>";
  }
  const std::vector<Problem> problems = problems_of(any_camera + inside);
  EXPECT_NE(problems.at(0).message.find("hold more than"), std::string::npos);
}

/// A program may make a description that holds itself.
TEST(MergedShapes, ThatHoldThemselvesAreRefused) {
  const Description description = description_of(any_camera + merge(any_shape));
  const auto merged = description.scene->children.at(1).object;
  merged->children.push_back({"", merged});
  EXPECT_THROW(build_scene(description), Error);
  merged->children.pop_back();  // or it would never be gone
}

TEST(ForeignShapes, AreToldWithWhatToDo) {
  const auto warning_of = [](const std::string& type) {
    const auto scene =
        scene_of(any_camera + std::string(any_shape) + "\n<shape type=\"" + type + "\"/>");
    EXPECT_EQ(scene->warnings().size(), 1u);
    return scene->warnings().empty() ? "" : scene->warnings()[0];
  };
  EXPECT_NE(warning_of("hair").find("as a mesh of tubes"), std::string::npos);
  EXPECT_NE(warning_of("deformable").find("export it at one time"), std::string::npos);
  EXPECT_EQ(warning_of("hare"), "test.xml:3:1: Kaustik does not know shape 'hare': it is left out");
  Description strict =
      description_of(any_camera + std::string(any_shape) + "\n<shape type=\"hair\"/>");
  strict.is_strict = true;
  EXPECT_THROW(build_scene(strict), Error);
}

class MeshFiles : public testing::Test {
 protected:
  std::string shape(const std::string& file) {
    return "<shape type=\"obj\"><string name=\"filename\" value=\"" + folder_.path(file) +
           "\"/></shape>\n";
  }
  void write(const std::string& file, const std::string& text) {
    std::ofstream(folder_.path(file)) << text;
  }
  TemporaryFolder folder_;
};

/// In the order of the scene, whichever is read first.
TEST_F(MeshFiles, AreReadSideBySideAndToldInOrder) {
  std::string shapes;
  for (int i = 0; i < 40; ++i) {
    const std::string name = std::to_string(i) + ".obj";
    std::string text = "v 0 0 " + std::to_string(i) + "\nv 1 0 0\nv 0 1 0\n";
    for (int face = 0; face < 1 + 1000 * ((i * 7) % 5); ++face) text += "f 1 2 3\n";
    write(name, text + (i % 10 == 3 ? "f 1 2 4\n" : i % 10 == 5 ? "what 1\n" : ""));
    if (i % 10 != 3) shapes += shape(name);
  }
  const auto scene = scene_of(any_camera + shapes);
  ASSERT_EQ(scene->surface_count(), 36u);
  EXPECT_EQ(scene->tracer().shape(1).bounds().max.z, 1);
  EXPECT_EQ(scene->tracer().shape(35).bounds().max.z, 39);
  EXPECT_EQ(scene->build_counts().shapes, 36);
  size_t remarks = 0;
  for (const std::string& warning : scene->warnings()) {
    if (warning.find("'what'") == std::string::npos) continue;
    EXPECT_NE(warning.find("/" + std::to_string(5 + 10 * remarks) + ".obj"), std::string::npos);
    ++remarks;
  }
  EXPECT_EQ(remarks, 4u);
  std::string broken;
  for (const char* name : {"1.obj", "23.obj", "none.obj", "3.obj", "2.obj"}) broken += shape(name);
  const std::vector<Problem> problems = problems_of(any_camera + broken);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].message.find("(named in test.xml:3:"), std::string::npos)
      << problems[0].message;
  EXPECT_EQ(*problems[1].place.file, folder_.path("3.obj"));
}

/// A shining_disk that an instance distorts is a shining_disk of that form.
TEST(PlacedLamps, MayBeDistorted) {
  const std::string group =
      "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"><emitter type=\"area\"><float "
      "name=\"radiance\" value=\"2\"/></emitter></shape></shape>";
  const auto scene = scene_of(any_camera + group +
                              "<shape type=\"instance\"><ref id=\"g\"/><transform "
                              "name=\"to_world\"><scale value=\"1, 1, 0.5\"/></transform></shape>");
  ASSERT_EQ(scene->lights().size(), 1u);
  const double e = std::sqrt(0.75), pi_d = std::numbers::pi;
  const double area = 2 * pi_d * (1 + 0.25 / e * std::atanh(e));
  EXPECT_NEAR(scene->lights()[0]->traits().power[0], 2 * pi_d * area, 1e-4 * area);
}

}  // namespace
}  // namespace kaustik
