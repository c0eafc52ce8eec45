// What glTF gives in candela, lux and cd/m² is seen as the closed forms want, over 179 lm/W.

#include <cmath>

#include "kaustik/loader/gltf/gltf_scene.h"
#include "tests/support/measure.h"

namespace kaustik::test {
namespace {

constexpr double efficacy = 179, pi_double = 3.14159265358979323846;

/// A matt square of albedo 0.5 in the plane z = 0, seen straight on from z = 4, of which one pixel
/// shows the middle. The square has no surface that shines: what it sends is 0.5 E/π.
std::string file_with(const std::string& node, const std::string& lamp,
                      const std::string& material = "") {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":48,
"uri":"data:;base64,AACAwAAAgMAAAAAAAACAQAAAgMAAAAAAAACAQAAAgEAAAAAAAACAwAAAgEAAAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":48}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0},{"camera":0,"translation":[0,0,4]},{)" +
         node + R"(}],"cameras":[{"type":"perspective","perspective":{"yfov":0.002,
"aspectRatio":1}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":6,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0},
"extensions":{"KHR_materials_specular":{"specularFactor":0})" +
         material + R"(}}],"extensions":{"KHR_lights_punctual":{"lights":[{)" + lamp + "}]}}}";
}

/// Radiance of the middle.
double seen(const std::string& text) {
  Description description = parse_gltf(text, "test.gltf", "");
  for (const Child& child : description.scene->children)
    for (const Child& film : child.object->children)
      for (Property& property : film.object->properties)
        if (property.name == "width" || property.name == "height") property.value = int64_t{2};
  return render(TestScene(description), "path", "", {16, 1, 1}).mean({""}).mean();
}
const std::string shines = R"("extensions":{"KHR_lights_punctual":{"light":0}})";

void expect_lux(double radiance, double lux) {
  // openpbr keeps a surface of index 1.001, which reflects a few millionths.
  EXPECT_NEAR(radiance, 0.5 * lux / pi_double / efficacy, 2e-4 * lux / efficacy);
}

TEST(GltfUnits, PointLampsAreInCandela) {
  const std::string lamp = R"("type":"point","intensity":800)";
  expect_lux(seen(file_with(shines + R"(,"translation":[0,0,2])", lamp)), 800 / 4.0);
  // From the side: the cosine over the square of the distance.
  expect_lux(seen(file_with(shines + R"(,"translation":[3,0,4])", lamp)), 800 * 0.8 / 25);
}

TEST(GltfUnits, LuminairesHaveTheCandelaOfTheirFile) {
  // 800 cd within 90° of the node's −z.
  const std::string profile =
      "SUVTTkE6TE0tNjMtMjAwMgpUSUxUPU5PTkUKMSAtMSAxIDMgMSAxIDIgMCAwIDAKMSAxIDAKMCA4OSA5"
      "MAowCjgwMCA4MDAgODAwCg==";
  const std::string lamp =
      "\"type\":\"point\"}]},\"EXT_lights_ies\":{\"lights\":[{"
      "\"uri\":\"data:application/x-ies-lm-63;base64," +
      profile + "\"";
  const std::string luminaire =
      R"("extensions":{"EXT_lights_ies":{"light":0,"multiplier":0.5}},"translation":[0,0,2])";
  expect_lux(seen(file_with(luminaire, lamp)), 400 / 4.0);
  // Turned by 180° about x.
  expect_lux(seen(file_with(luminaire + R"(,"rotation":[1,0,0,0])", lamp)), 0);
}

TEST(GltfUnits, DirectionalLampsAreInLux) {
  const std::string lamp = R"("type":"directional","intensity":1000)";
  expect_lux(seen(file_with(shines, lamp)), 1000);
  // Turned by 60° about y: half of it falls on the square.
  expect_lux(seen(file_with(shines + R"(,"rotation":[0,0.5,0,0.8660254037844386])", lamp)), 500);
}

TEST(GltfUnits, SpotsFallAsTheSquareOfACosinesStep) {
  const double inner = 0.2, outer = 0.7, turned = 0.5;
  const std::string lamp =
      R"("type":"spot","intensity":900,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.7})";
  const auto turn = [](double angle) {
    return R"(,"translation":[0,0,3],"rotation":[0,)" + std::to_string(std::sin(angle / 2)) +
           ",0," + std::to_string(std::cos(angle / 2)) + "]";
  };
  expect_lux(seen(file_with(shines + turn(0.1), lamp)), 900 / 9.0);
  const double step = (std::cos(turned) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
  expect_lux(seen(file_with(shines + turn(turned), lamp)), 900 / 9.0 * step * step);
  EXPECT_EQ(seen(file_with(shines + turn(0.75), lamp)), 0);
}

TEST(GltfUnits, EmissionIsInCandelaPerSquareMetre) {
  std::string text = file_with(shines, R"("type":"point","intensity":0)",
                               R"(,"KHR_materials_emissive_strength":{"emissiveStrength":350})");
  const std::string factor = R"("emissiveFactor":[0.5,0.5,0.5],"pbrMetallicRoughness")";
  text.replace(text.find("\"pbrMetallicRoughness\""), 22, factor);
  EXPECT_NEAR(seen(text), 175 / efficacy, 1e-5);
}

}  // namespace
}  // namespace kaustik::test
