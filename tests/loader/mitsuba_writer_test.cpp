// Scenes that are written as XML are the same when they are read again.

#include "kaustik/loader/mitsuba_writer.h"

#include <cmath>
#include <filesystem>

#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/description_digest.h"
#include "kaustik/scene/type_tables.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

std::string written(const Description& description, const std::string& folder = {}) {
  return mitsuba_xml(description, scene_types(), folder);
}

DescriptionDigest digest_of(const Description& description) {
  return description_digest(description, scene_types());
}

// Files are named from another folder, and their contents count.
TEST(MitsubaWriter, ShippedScenesComeBack) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(KAUSTIK_SOURCE_DIR "/scenes")) {
    const fs::path file = entry.path() / (entry.path().filename().string() + ".xml");
    if (!fs::exists(file)) continue;
    SCOPED_TRACE(file.string());
    const TemporaryFolder folder;
    const Description scene = load_scene(file.string());
    const std::string copy = folder.write("copy.xml", written(scene, folder / ""));
    EXPECT_EQ(digest_of(load_scene(copy)), digest_of(scene));
    ++count;
  }
  EXPECT_GT(count, 5);
}

TEST(MitsubaWriter, ValuesOfEveryKindComeBack) {
  const std::string text = in_scene(
      "<shape type='sphere' id='ball'><float name='a' value='0.1'/><integer name='b' value='-3'/>"
      "<boolean name='c' value='true'/><string name='d' value='\\$ &lt;x&gt; &amp; &quot;&#10;y'/>"
      "<point name='e' value='1, 2e-30, 3e30'/><rgb name='f' value='0.1, 0.2, 0.3'/>"
      "<spectrum name='g' value='400:0.1, 500.5:0.2'/>"
      "<transform name='h'><rotate x='1' y='2' angle='33'/><translate z='0.1'/></transform>"
      "<bsdf type='diffuse' name='inside'/></shape>");
  const Description scene = parse(text);
  EXPECT_EQ(digest_of(parse(written(scene))), digest_of(scene));
  // The twin: a last digit that is lost would be found.
  Description changed = parse(text);
  changed.scene->children[0].object->properties[0].value = std::nextafter(0.1, 1.0);
  EXPECT_NE(digest_of(changed), digest_of(scene));
}

TEST(MitsubaWriter, SharedObjectsStayShared) {
  const Description scene = parse_inside(
      "<shape type='sphere'><ref id='paint'/></shape><bsdf type='diffuse' id='paint'/>"
      "<shape type='cube'><bsdf type='diffuse' id='inner'/></shape>"
      "<shape type='disk'><ref id='inner' name='x'/></shape>");
  const std::string text = written(scene);
  const auto again = parse(text).scene;
  EXPECT_EQ(digest_of(parse(text)), digest_of(scene));
  EXPECT_EQ(again->children[0].object->children[0].object, again->children[1].object);
  EXPECT_EQ(again->children[2].object->children[0].object,
            again->children[3].object->children[0].object);
  // What stands at the top is written there.
  EXPECT_NE(text.find("  <bsdf type=\"diffuse\" id=\"paint\" />\n  <shape"), std::string::npos)
      << text;
}

TEST(MitsubaWriter, SharedObjectsWithoutAnIdGetOne) {
  Description scene = parse_inside("<shape type='sphere' id='bsdf_1'/><shape type='cube'/>");
  const auto paint = std::make_shared<Object>();
  paint->family = "bsdf";
  paint->type = "diffuse";
  for (const Child& shape : scene.scene->children) shape.object->children.push_back({"", paint});
  const auto again = parse(written(scene)).scene;
  EXPECT_EQ(again->children[0].object->children[0].object->id, "bsdf_2");
  EXPECT_EQ(again->children[0].object->children[0].object,
            again->children[1].object->children[0].object);
}

TEST(MitsubaWriter, FilesBelowTheFolderAreNamedFromThere) {
  const TemporaryFolder folder;
  folder.write("meshes/a.obj", "");
  const std::string path = folder.write(
      "scene.xml", in_scene("<shape type='obj'><string name='filename' value='meshes/a.obj'/>"
                            "</shape>"));
  const Description scene = load_scene(path);
  EXPECT_NE(written(scene, folder / "").find("\"meshes/a.obj\""), std::string::npos);
  EXPECT_NE(written(scene, folder / "meshes").find("\"a.obj\""), std::string::npos);
  EXPECT_NE(written(scene, folder / "other").find("\"" + folder / "meshes/a.obj" + "\""),
            std::string::npos);
}

TEST(MitsubaWriter, WhatXmlCannotHoldIsTold) {
  Description scene = parse_inside("<shape type='sphere'/>");
  auto& properties = scene.scene->children[0].object->properties;
  properties = {{"vertices", Array::of<float>({1}, {1}), {}}};
  expect_problem(problems_of([&] { written(scene); }), "", "'vertices' is a buffer", "PLY");
}

}  // namespace
}  // namespace kaustik
