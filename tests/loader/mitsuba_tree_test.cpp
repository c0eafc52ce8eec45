// Objects, nesting, ids, references, definitions, names of files, places.

#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

TEST(MitsubaTree, ObjectsWithPlaces) {
  const auto scene =
      parse(
          "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
          "<!-- a comment -->\n"
          "<scene version=\"3.0.0\">\n"
          "\t<shape type=\"sphere\" id=\"ball\" name=\"main\">\n"
          "    <float name=\"radius\" value=\"2\"/><bsdf type=\"diffuse\" name=\"surface\"/>\n"
          "  </shape>\n"
          "</scene>")
          .scene;
  EXPECT_EQ(scene->family, "scene");
  EXPECT_EQ(scene->type, "");
  EXPECT_EQ(text_of(scene->place), "test.xml:3:1");
  ASSERT_EQ(scene->children.size(), 1u);
  EXPECT_EQ(scene->children[0].name, "main");
  const Object& ball = *scene->children[0].object;
  EXPECT_EQ(ball.family, "shape");
  EXPECT_EQ(ball.type, "sphere");
  EXPECT_EQ(ball.id, "ball");
  EXPECT_EQ(text_of(ball.place), "test.xml:4:2");
  EXPECT_EQ(text_of(property(ball, "radius").place), "test.xml:5:5");
  EXPECT_EQ(ball.children.at(0).name, "surface");
  EXPECT_EQ(text_of(ball.children[0].object->place), "test.xml:5:37");
}

TEST(MitsubaTree, EveryFamily) {
  for (const std::string family : {"shape", "bsdf", "emitter", "sensor", "film", "rfilter",
                                   "sampler", "integrator", "texture", "medium", "phase", "volume"})
    EXPECT_EQ(parse_inside("<" + family + " type='t'/>").scene->children.at(0).object->family,
              family);
}

TEST(MitsubaTree, ByteOrderMarkCommentsAndCdata) {
  const auto scene =
      parse(
          "\xef\xbb\xbf<scene version='3.0.0'><!-- < & --><![CDATA[ < & ]]><shape type='\xc3\xbc'/>"
          "</scene>")
          .scene;
  ASSERT_EQ(scene->children.size(), 1u);
  EXPECT_EQ(scene->children[0].object->type, "ü");
  EXPECT_EQ(text_of(scene->place), "test.xml:1:1");
}

TEST(MitsubaTree, ReferencesShareOneObjectAlsoForward) {
  const auto scene = parse_inside(
                         "<shape type='a'><ref id='white' name='inside'/></shape>\n"
                         "<bsdf type='diffuse' id='white'/>\n"
                         "<shape type='b'><ref id='white'/></shape>")
                         .scene;
  const Child& first = scene->children[0].object->children.at(0);
  EXPECT_EQ(first.name, "inside");
  EXPECT_EQ(first.object, scene->children[1].object);
  EXPECT_EQ(scene->children[2].object->children.at(0).object, scene->children[1].object);
}

TEST(MitsubaTree, AliasesAreOtherIds) {
  const auto scene = parse_inside(
                         "<bsdf type='diffuse' id='white'/>\n"
                         "<alias id='paper' as='page'/><alias id='white' as='paper'/>\n"
                         "<shape type='a'><ref id='page'/></shape>")
                         .scene;
  EXPECT_EQ(scene->children.at(1).object->children.at(0).object, scene->children[0].object);
}

TEST(MitsubaTree, DefaultsAndDefinitions) {
  const std::string text = in_scene(
      "<default name='spp' value='16'/><default name='sppx' value='5'/>\n"
      "<sampler type='$kind$spp'><integer name='n' value='$spp$sppx'/>"
      "<string name='price' value='\\$spp a\\b'/></sampler>");
  const auto sampler = parse(text, {{{"kind", "k"}, {"spp", "3"}}}).scene->children.at(0).object;
  EXPECT_EQ(sampler->type, "k3");
  EXPECT_EQ(value<int64_t>(*sampler, "n"), 35);
  EXPECT_EQ(value<std::string>(*sampler, "price"), "$spp a\\b");
}

TEST(MitsubaTree, DefaultsMayUseEarlierOnes) {
  const auto scene = parse_inside(
                         "<default name='a' value='2'/><default name='b' value='$a.5'/>"
                         "<shape type='s'><float name='x' value='$b'/></shape>")
                         .scene;
  EXPECT_EQ(value<double>(*scene->children.at(0).object, "x"), 2.5);
}

TEST(MitsubaTree, FileNamesAreRelativeToTheScene) {
  const std::string text = in_scene(
      "<shape type='ply'><string name='filename' value='m/a.ply'/>"
      "<string name='other' value='m/a.ply'/></shape>"
      "<shape type='ply'><string name='filename' value='/abs/b.ply'/></shape>"
      "<integrator type='photonmap'><string name='photon_map' value='m/a.kpm'/></integrator>");
  const auto scene = parse_mitsuba_xml(text, "t.xml", "some/folder").scene;
  EXPECT_EQ(value<std::string>(*scene->children[0].object, "filename"), "some/folder/m/a.ply");
  EXPECT_EQ(value<std::string>(*scene->children[0].object, "other"), "m/a.ply");
  EXPECT_EQ(value<std::string>(*scene->children[1].object, "filename"), "/abs/b.ply");
  EXPECT_EQ(value<std::string>(*scene->children[2].object, "photon_map"), "some/folder/m/a.kpm");
  EXPECT_EQ(value<std::string>(*parse(text).scene->children[0].object, "filename"), "m/a.ply");
}

TEST(MitsubaTree, PathAddsASearchFolder) {
  const TemporaryFolder folder;
  folder.write("library/a.ply", "");
  folder.write("b.ply", "");
  const std::string path = folder.write(
      "scene.xml", in_scene("<path value='library'/>"
                            "<shape type='ply'><string name='filename' value='a.ply'/></shape>"
                            "<shape type='ply'><string name='filename' value='b.ply'/></shape>"
                            "<shape type='ply'><string name='filename' value='c.ply'/></shape>"));
  const auto scene = load_mitsuba_xml(path).scene;
  EXPECT_EQ(value<std::string>(*scene->children[0].object, "filename"), folder / "library/a.ply");
  EXPECT_EQ(value<std::string>(*scene->children[1].object, "filename"), folder / "b.ply");
  EXPECT_EQ(value<std::string>(*scene->children[2].object, "filename"), folder / "c.ply");
}

TEST(MitsubaTree, IncludedScenesAndObjects) {
  const TemporaryFolder folder;
  folder.write("parts/walls.xml",
               in_scene("<default name='r' value='2'/><bsdf type='diffuse' id='white'/>\n"
                        "<shape type='ply'><string name='filename' value='w.ply'/></shape>\n"
                        "<include filename='lamp.xml' name='lamp'/>"));
  folder.write("parts/lamp.xml",
               "<emitter version=\"3.0.0\" type=\"point\" id=\"lamp\">"
               "<float name=\"x\" value=\"$r\"/></emitter>");
  const std::string path = folder.write(
      "scene.xml",
      in_scene("<include filename='parts/walls.xml'/>\n<shape type='a'><ref id='white'/></shape>"));
  const auto scene = load_mitsuba_xml(path, {{{"r", "7"}}}).scene;
  ASSERT_EQ(scene->children.size(), 4u);
  EXPECT_EQ(value<std::string>(*scene->children[1].object, "filename"), folder / "parts/w.ply");
  EXPECT_EQ(scene->children[2].name, "lamp");
  EXPECT_EQ(scene->children[2].object->id, "lamp");
  EXPECT_EQ(value<double>(*scene->children[2].object, "x"), 7);
  EXPECT_EQ(scene->children[3].object->children.at(0).object, scene->children[0].object);
  EXPECT_EQ(text_of(scene->children[1].object->place), folder / "parts/walls.xml:3:1");
}

TEST(MitsubaTree, TextBetweenElementsIsLeftOut) {
  EXPECT_NE(lenient_warning(in_scene("<shape type='s'>\n  3\n</shape>")).find("test.xml:3:3: text"),
            std::string::npos);
}

TEST(MitsubaTree, ReflectancesMakeNoLight) {
  const auto scene = parse(
      in_scene("<bsdf type='diffuse' id='a'><rgb name='reflectance' value='255, 127.5, 0'/></bsdf>"
               "<bsdf type='diffuse' id='b'><float name='reflectance' value='1'/></bsdf>"
               "<emitter type='point'><rgb name='intensity' value='255'/></emitter>",
               "0.6.0"));
  const Rgb scaled = value<Rgb>(*scene.scene->children.at(0).object, "reflectance");
  EXPECT_DOUBLE_EQ(scaled.r, 0.99);
  EXPECT_DOUBLE_EQ(scaled.g, 0.495);
  EXPECT_EQ(value<double>(*scene.scene->children.at(1).object, "reflectance"), 1);
  EXPECT_EQ(value<Rgb>(*scene.scene->children.at(2).object, "intensity").r, 255);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("'reflectance' is above 1"), std::string::npos);
}

TEST(MitsubaTree, OfSeveralSensorsOneComesFirst) {
  const std::string sensors =
      "<sensor type='a'/><shape type='s'/><sensor type='b'/><sensor type='c'/><emitter type='t'/>";
  const auto types = [&](const std::string& version) {
    const auto scene = parse(in_scene(sensors, version)).scene;
    std::string result;
    for (const Child& child : scene->children) result += child.object->type;
    return result;
  };
  EXPECT_EQ(types("3.0.0"), "asbct");
  EXPECT_EQ(types("2.0.0"), "asbct");
  EXPECT_EQ(types("0.6.0"), "casbt");
  EXPECT_EQ(parse(in_scene("<emitter type='s'/>", "0.6.0")).scene->children.size(), 1u);
}

// A scene without an emitter is dark in Mitsuba 2 and 3, but not before.
TEST(MitsubaTree, FileNamesMayHaveBackslashes) {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("meshes/a.obj", "");
  const std::string path = folder.write(
      "scene.xml", in_scene("<shape type='obj'><string name='filename' value='meshes\\a.obj'/>"
                            "</shape>"));
  EXPECT_EQ(value<std::string>(*load_mitsuba_xml(path).scene->children.at(0).object, "filename"),
            mesh);
}

}  // namespace
}  // namespace kaustik
