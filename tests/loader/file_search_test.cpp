// Files that are not where a scene says.

#include "kaustik/loader/file_search.h"

#include "kaustik/loader/mitsuba_xml.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

class FilesLike : public testing::Test {
 protected:
  FilesLike() {
    folder_.write("scene/Mesh.obj", "");
    folder_.write("scene/Textures/Wood.PNG", "");
    folder_.write("scene/both.png", "");
    folder_.write("scene/both.exr", "");
    folder_.write("scene/note.txt", "");
    folder_.write("more/lamp.obj", "");
    folder_.write("secret/other.obj", "");
  }
  /// Relative to the folder of all; "" for none.
  std::string found(const std::string& name) {
    const auto path = search_.find_like(name, {folder_ / "scene", folder_ / "more"});
    return path ? path->string().substr((folder_ / "").size()) : "";
  }

  TemporaryFolder folder_;
  FileSearch search_;
};

TEST_F(FilesLike, WithoutBlanks) { EXPECT_EQ(found(" Mesh.obj\t"), "scene/Mesh.obj"); }

TEST_F(FilesLike, OfOtherComputers) {
  EXPECT_EQ(found("C:\\Users\\me\\Mesh.obj"), "scene/Mesh.obj");
  EXPECT_EQ(found("/home/me/scene/lamp.obj"), "more/lamp.obj");
  EXPECT_EQ(found("\\\\server\\share\\lamp.obj"), "more/lamp.obj");
  // As deep as they lie there.
  EXPECT_EQ(found("C:\\Users\\me\\textures\\wood.png"), "scene/Textures/Wood.PNG");
  EXPECT_EQ(found("/home/me/scene/Textures/Wood.PNG"), "scene/Textures/Wood.PNG");
  EXPECT_EQ(found("C:\\Users\\me\\..\\Mesh.obj"), "scene/Mesh.obj");
}

TEST_F(FilesLike, WithoutRegardToCase) {
  EXPECT_EQ(found("mesh.OBJ"), "scene/Mesh.obj");
  EXPECT_EQ(found("textures/wood.png"), "scene/Textures/Wood.PNG");
  EXPECT_EQ(found("textures\\wood.png"), "scene/Textures/Wood.PNG");
  EXPECT_EQ(found("D:\\LAMP.OBJ"), "more/lamp.obj");
  EXPECT_EQ(found(folder_ / "scene/NOTE.TXT"), "scene/note.txt");
}

TEST_F(FilesLike, PicturesOfAnotherFormat) {
  EXPECT_EQ(found("both.tga"), "scene/both.exr");
  EXPECT_EQ(found("both.dds"), "scene/both.exr");
  EXPECT_EQ(found("textures/wood.jpg"), "scene/Textures/Wood.PNG");
  EXPECT_EQ(found("both.obj"), "");
  EXPECT_EQ(found("note.png"), "");
}

TEST_F(FilesLike, AreLookedForNowhereElse) {
  for (const char* name : {"", " ", "other.obj", "/", "C:\\", "nothing.obj", "Textures", "scene/",
                           "/secret/other.obj"})
    EXPECT_EQ(found(name), "") << name;
}

TEST_F(FilesLike, AreToldOnce) {
  const std::string path = folder_.write(
      "scene/scene.xml", in_scene("<shape type='obj'><string name='filename' value='mesh.obj'/>"
                                  "</shape><shape type='obj'><string name='filename' "
                                  "value='Mesh.obj'/></shape>"));
  const Description description = load_mitsuba_xml(path);
  ASSERT_EQ(description.warnings.size(), 1u);
  EXPECT_NE(description.warnings[0].find("there is no file 'mesh.obj': '" +
                                         (folder_ / "scene/Mesh.obj") + "' stands for it"),
            std::string::npos)
      << description.warnings[0];
  EXPECT_EQ(value<std::string>(*description.scene->children.at(0).object, "filename"),
            folder_ / "scene/Mesh.obj");
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_EQ(
      value<std::string>(*load_mitsuba_xml(path, strict).scene->children.at(0).object, "filename"),
      folder_ / "scene/mesh.obj");
}

}  // namespace
}  // namespace kaustik
