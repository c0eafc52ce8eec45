// Transforms, attributes, includes, instances: what pbrt's directives do.

#include <zlib.h>

#include "kaustik/loader/scene_format.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

Transform placed_by(const std::string& lines) {
  const Description scene = parse_scene_of_pbrt("WorldBegin\n" + lines + "\nShape \"sphere\"");
  const Object& sphere = only(scene, "shape");
  for (const Property& p : sphere.properties)
    if (p.name == "to_world") return std::get<Transform>(p.value);
  return {};
}

TEST(PbrtDirectives, TransformsComeAfterOneAnother) {
  expect_same(placed_by("Translate 1 2 3 Scale 2 2 2"),
              Transform::translate({1, 2, 3}) * Transform::scale({2, 2, 2}));
  expect_same(placed_by("Rotate 90 0 0 1"), Transform::rotate({0, 0, 1}, 90));
  // Column by column.
  expect_same(placed_by("Translate 9 9 9 Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]"),
              Transform::translate({4, 5, 6}));
  expect_same(placed_by("Scale 2 2 2 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]"),
              Transform::scale({2, 2, 2}) * Transform::translate({4, 5, 6}));
  expect_same(placed_by("Translate 1 1 1 Identity"), Transform());
}

TEST(PbrtDirectives, RotateAboutNoAxisTurnsNothing) {
  expect_same(placed_by("Translate 1 2 3 Rotate 15 0 0 0"), Transform::translate({1, 2, 3}));
  EXPECT_TRUE(is_ignored(parse_scene_of_pbrt("Rotate 15 0 0 0"), "Rotate", "axis is zero"));
}

TEST(PbrtDirectives, LookAtTakesTheWorldToTheCamera) {
  // From (0, 0, 5) toward the origin: x of the world is on the left there.
  const Transform t = placed_by("LookAt 0 0 5 0 0 0 0 1 0");
  const Vec3f eye = t.point({0, 0, 5}), right = t.vector({1, 0, 0}), target = t.point({0, 0, 0});
  EXPECT_NEAR(length(eye), 0, 1e-6);
  EXPECT_NEAR(right.x, -1, 1e-6);
  EXPECT_NEAR(target.z, 5, 1e-6);
}

TEST(PbrtDirectives, NamedCoordinateSystems) {
  const std::string before = "LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\"\n";
  const Description scene =
      parse_scene_of_pbrt(before + "WorldBegin CoordSysTransform \"camera\" Shape \"sphere\"");
  const Transform t = value<Transform>(only(scene, "shape"), "to_world");
  EXPECT_NEAR(t.point({0, 0, 0}).z, 5, 1e-6);  // from the camera to the world
  expect_same(
      placed_by("Translate 1 0 0 CoordinateSystem \"a\" Translate 5 0 0 CoordSysTransform \"a\""),
      Transform::translate({1, 0, 0}));
  expect_same(placed_by("Translate 1 0 0 CoordSysTransform \"world\""), Transform());
}

TEST(PbrtDirectives, AttributesAreKeptAndRestored) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Material "diffuse" "float reflectance" .2
    AttributeBegin
      Translate 1 0 0
      Material "conductor"
      AreaLightSource "diffuse"
      ReverseOrientation
      Shape "sphere"
    AttributeEnd
    Shape "sphere" "float radius" 2
    TransformBegin Translate 3 0 0 Material "dielectric" TransformEnd
    Shape "sphere" "float radius" 3)");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_TRUE(value<bool>(*shapes[0], "flip_normals"));
  EXPECT_EQ(only(*shapes[0], "emitter").type, "area");
  EXPECT_EQ(shapes[1]->properties.size(), 1u);  // its radius
  EXPECT_EQ(value<double>(one_sided(only(*shapes[1], "bsdf")), "reflectance"), .2);
  EXPECT_EQ(only(*shapes[2], "bsdf").type, "dielectric");  // transforms alone are restored
  EXPECT_EQ(shapes[2]->properties.size(), 1u);
}

TEST(PbrtDirectives, AttributeGivesDefaults) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    AttributeBegin
      Attribute "shape" "float radius" 4
      Attribute "material" "float reflectance" .125
      Material "diffuse"
      Shape "sphere"
      Shape "sphere" "float radius" 5
    AttributeEnd
    Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  EXPECT_EQ(value<double>(*shapes[0], "radius"), 4);
  EXPECT_EQ(value<double>(one_sided(only(*shapes[0], "bsdf")), "reflectance"), .125);
  EXPECT_EQ(value<double>(*shapes[1], "radius"), 5);
  EXPECT_TRUE(shapes[2]->properties.empty());
  EXPECT_TRUE(scene.deviations.empty());
}

TEST(PbrtDirectives, InstancesPlaceGroups) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    ObjectBegin "tree"
      Translate 0 1 0
      Shape "sphere"
      AreaLightSource "diffuse"
      Shape "sphere" "float radius" .5
    ObjectEnd
    Translate 2 0 0
    ObjectInstance "tree"
    Scale 3 3 3
    ObjectInstance "tree"
    ObjectInstance "bush")");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0]->type, "shapegroup");
  EXPECT_EQ(shapes[0]->id, "tree");
  ASSERT_EQ(shapes[0]->children.size(), 2u);
  expect_same(value<Transform>(*shapes[0]->children[0].object, "to_world"),
              Transform::translate({0, 1, 0}));
  EXPECT_EQ(shapes[1]->children[0].object, shapes[0]);
  expect_same(value<Transform>(*shapes[2], "to_world"),
              Transform::translate({2, 0, 0}) * Transform::scale({3, 3, 3}));
  EXPECT_TRUE(is_ignored(scene, "area light", "left out"));
  EXPECT_TRUE(is_missing(scene, "'bush'", "not defined"));
}

TEST(PbrtDirectives, MotionStandsStill) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    ActiveTransform EndTime Translate 5 0 0 ActiveTransform All Translate 0 1 0
    Shape "sphere"
    TransformTimes 0 1)");
  expect_same(value<Transform>(only(scene, "shape"), "to_world"), Transform::translate({0, 1, 0}));
  EXPECT_TRUE(is_approximated(scene, "sphere", "stands still"));
}

TEST(PbrtDirectives, IncludesAreTextAndImportsAreNot) {
  const TemporaryFolder folder;
  folder.write("sub/part.pbrt", "Translate 1 0 0\nInclude \"sub/inner.pbrt\"\n");
  folder.write("sub/inner.pbrt", "Shape \"sphere\"\n");
  const std::string path = folder.write("main.pbrt",
                                        "WorldBegin\nInclude \"sub/part.pbrt\"\nShape \"sphere\"\n"
                                        "Import \"sub/part.pbrt\"\nShape \"sphere\"\n");
  const Description scene = load_scene(path);
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 4u);
  const double wanted[] = {1, 1, 2, 1};
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(value<Transform>(*shapes[i], "to_world").at(0, 3), wanted[i]) << i;
  EXPECT_EQ(scene.sources.size(), 3u);
}

TEST(PbrtDirectives, PackedFilesAreRead) {
  const TemporaryFolder folder;
  const std::string text = "WorldBegin\nShape \"sphere\" \"float radius\" 7\n";
  const std::string path = folder / "packed.pbrt.gz";
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), unsigned(text.size()));
  gzclose(file);
  EXPECT_EQ(value<double>(only(load_scene(path), "shape"), "radius"), 7);
  const std::string outer = folder.write("outer.pbrt", "WorldBegin Import \"packed.pbrt.gz\"");
  EXPECT_EQ(value<double>(only(load_scene(outer), "shape"), "radius"), 7);
}

TEST(PbrtDirectives, DefinitionsMayFollowTheirUse) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    NamedMaterial "later" Shape "sphere"
    MakeNamedMaterial "later" "string type" "conductor"
    NamedMaterial "never" Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  EXPECT_EQ(one_sided(only(*shapes[0], "bsdf")).type, "conductor");
  EXPECT_EQ(one_sided(only(*shapes[1], "bsdf")).type, "diffuse");
  EXPECT_TRUE(is_missing(scene, "'never'", "not defined"));
}

TEST(PbrtDirectives, OfSeveralDefinitionsTheLastBeforeTheUseCounts) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Texture "t" "float" "constant" "float value" .25
    Material "diffusetransmission" "texture scale" "x"
    Texture "c" "spectrum" "constant" "rgb value" [.1 .1 .1]
    Material "diffuse" "texture reflectance" "c" Shape "sphere"
    Texture "c" "spectrum" "constant" "rgb value" [.2 .2 .2]
    Material "diffuse" "texture reflectance" "c" Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  expect_rgb(value<Rgb>(one_sided(only(*shapes[0], "bsdf")), "reflectance"), .1, .1, .1);
  expect_rgb(value<Rgb>(one_sided(only(*shapes[1], "bsdf")), "reflectance"), .2, .2, .2);
}

TEST(PbrtDirectives, ColourSpacesAreTakenToRec709) {
  const auto reflectance = [](const std::string& space, const std::string& rgb) {
    return value<Rgb>(
        one_sided(*material("ColorSpace \"" + space +
                            "\" Material \"diffuse\" \"rgb reflectance\" [" + rgb + "]")),
        "reflectance");
  };
  for (const char* space : {"srgb", "rec2020", "dci-p3", "aces2065-1"})
    expect_rgb(reflectance(space, "1 1 1"), 1, 1, 1, 1e-9);
  expect_rgb(reflectance("srgb", ".2 .3 .4"), .2, .3, .4);
  // ITU-R BT.2087, the matrix from BT.2020 to BT.709.
  expect_rgb(reflectance("rec2020", ".2 .3 .3"), .2 * 1.6605 - .3 * .5876 - .3 * .0728,
             -.2 * .1246 + .3 * 1.1329 - .3 * .0083, -.2 * .0182 - .3 * .1006 + .3 * 1.1187, 2e-4);
}

}  // namespace
}  // namespace kaustik::pbrt
