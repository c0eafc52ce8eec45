// Files of glTF beside the same scenes in Mitsuba's XML: both make the same of lamps, cameras and
// materials, and shapes of the same size.

#include <filesystem>

#include "kaustik/loader/gltf/gltf_scene.h"
#include "kaustik/scene/scene.h"
#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

std::string twin(const std::string& name) {
  return std::string(KAUSTIK_SOURCE_DIR) + "/tests/loader/twins/gltf/" + name;
}

std::vector<double> numbers_in(const Value& value) {
  if (const auto* rgb = std::get_if<Rgb>(&value)) return {rgb->r, rgb->g, rgb->b};
  if (const auto* point = std::get_if<Vec3d>(&value)) return {point->x, point->y, point->z};
  if (const auto* number = std::get_if<double>(&value)) return {*number};
  if (const auto* integer = std::get_if<int64_t>(&value)) return {double(*integer)};
  std::vector<double> numbers;
  if (const auto* transform = std::get_if<Transform>(&value))
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) numbers.push_back(transform->at(row, column));
  return numbers;
}

/// Whether both have the same properties and children, whatever the order and the names of shapes.
void expect_same(const Object& a, const Object& b) {
  SCOPED_TRACE(a.family + " " + a.type + " at " + text_of(b.place));
  EXPECT_EQ(a.family, b.family);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.properties.size(), b.properties.size());
  for (const Property& property : a.properties) {
    SCOPED_TRACE(property.name);
    const Property* other = find_property(b, property.name);
    ASSERT_TRUE(other);
    const std::vector<double> own = numbers_in(property.value), others = numbers_in(other->value);
    ASSERT_EQ(own.size(), others.size());
    for (size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(own[i], others[i], 1e-5);
    if (const auto* text = std::get_if<std::string>(&property.value)) {
      EXPECT_EQ(*text, std::get<std::string>(other->value));
    }
  }
  ASSERT_EQ(a.children.size(), b.children.size());
  for (size_t i = 0; i < a.children.size(); ++i) {
    EXPECT_EQ(a.children[i].name, b.children[i].name);
    expect_same(*a.children[i].object, *b.children[i].object);
  }
}

TEST(GltfTwins, AreTheSameScenes) {
  const Description gltf = load_gltf(twin("room.gltf"));
  const Description xml = load_mitsuba_xml(twin("room.xml"));
  for (const char* family : {"sensor", "emitter"}) {
    const auto of_gltf = objects_in(*gltf.scene, family), of_xml = objects_in(*xml.scene, family);
    ASSERT_EQ(of_gltf.size(), of_xml.size());
    for (size_t i = 0; i < of_gltf.size(); ++i) expect_same(*of_gltf[i], *of_xml[i]);
  }
  // Meshes are rectangles there: their materials, lamps and sizes are the same.
  const auto built = build_scene(gltf), built_twin = build_scene(xml);
  const auto of_gltf = objects_in(*gltf.scene, "shape"), of_xml = objects_in(*xml.scene, "shape");
  ASSERT_EQ(of_gltf.size(), of_xml.size());
  for (size_t i = 0; i < of_gltf.size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(of_gltf[i]->children.size(), of_xml[i]->children.size());
    for (size_t k = 0; k < of_gltf[i]->children.size(); ++k)
      expect_same(*of_gltf[i]->children[k].object, *of_xml[i]->children[k].object);
    const Bounds3f own = built->tracer().shape(uint32_t(i)).bounds();
    const Bounds3f others = built_twin->tracer().shape(uint32_t(i)).bounds();
    EXPECT_LT(length(own.min - others.min) + length(own.max - others.max), 1e-5f);
    EXPECT_NEAR(built->tracer().shape(uint32_t(i)).area(),
                built_twin->tracer().shape(uint32_t(i)).area(), 1e-5);
  }
  EXPECT_TRUE(gltf.deviations.empty()) << gltf.deviations[0].what;
}

}  // namespace
}  // namespace kaustik::test
