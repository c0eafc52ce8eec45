// Damaged files: whatever the bytes, the reader returns a description or throws kaustik::Error.

#include "tests/loader/damage.h"
#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

const std::string& rest() {
  static const std::string text = R"("scene":0,"scenes":[{"nodes":[0,1,3]}],
"nodes":[{"mesh":0,"children":[2],"rotation":[0,0,0,1]},{"mesh":0,"skin":0,"camera":0},
{"translation":[0,1,0],"scale":[1,2,3],"mesh":1,"weights":[0.5],
"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":1,"extensions":{"EXT_mesh_gpu_instancing":
{"attributes":{"TRANSLATION":0}}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"COLOR_0":3},
"indices":1,"material":0}]},{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":4},"mode":5,
"targets":[{"POSITION":0}],"material":1}]}],
"skins":[{"joints":[0,2]}],"cameras":[{"type":"perspective","perspective":{"yfov":0.8}}],
"materials":[{"name":"a","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.2,0.5],
"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}},
"alphaMode":"MASK","emissiveFactor":[1,1,1]},{"extensions":{"KHR_materials_transmission":
{"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,
"attenuationColor":[0.5,1,1]},"KHR_materials_sheen":{"sheenColorFactor":[1,1,1]}}}],
"animations":[{"channels":[{"sampler":0,"target":{"node":2,"path":"translation"}},{"sampler":1,
"target":{"node":2,"path":"weights"}}],"samplers":[{"input":5,"output":0},{"input":5,"output":5,
"interpolation":"STEP"}]}],
"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],"images":[{"bufferView":4}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":5}]}})";
  return text;
}

GltfBuffer buffer() {
  GltfBuffer made;
  made.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  made.add<uint16_t>({0, 1, 2}, "SCALAR", 1);
  made.add<uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", 4);
  made.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0}, "VEC4", 4);
  made.add<float>({0, 1, 1, 1, 0, 0}, "VEC2", 2);
  made.add<float>({0, 1, 2}, "SCALAR", 1);
  return made;
}

/// False if the text was refused as it should be.
bool survives(const std::string& text) {
  LoadOptions options;
  options.definitions = {{"gltf.time", "0.5"}};
  return is_accepted(
      [&] { return parse_gltf_text(text, options, "/nonexistent").scene != nullptr; });
}

const int rounds = damage_rounds(3000, 300);

TEST(GltfFuzz, TheWholeSceneIsSound) {
  EXPECT_TRUE(survives(buffer().as_json(rest())));
  EXPECT_TRUE(survives(buffer().as_glb(rest())));
}

TEST(GltfFuzz, FlippedBytes) {
  for (const std::string& sound : {buffer().as_json(rest()), buffer().as_glb(rest())}) {
    const int refused = count_refused(sound, 1, rounds, 4, flip_byte, survives);
    EXPECT_GT(refused, rounds / 4);
    EXPECT_LT(refused, rounds);
  }
}

/// Such changes keep the JSON sound, and what it says is odd.
TEST(GltfFuzz, OtherNumbersAndWords) {
  const std::vector<std::string> others = {"-1",   "1e300", "0",      "99999999999", "null",
                                           "true", "\"\"",  "[]",     "{}",          "0.5",
                                           "[0]",  "5",     "[1,2,3]"};
  const std::string digits = "0123456789";
  const auto change = [&](std::string& text, std::mt19937& random) {
    const size_t at = text.find_first_of(digits, random() % text.size());
    if (at == text.npos || text[at - 1] == '_' || text[at - 1] == 'C') return;
    const size_t end = text.find_first_not_of(digits + ".", at);
    text.replace(at, end - at, others[random() % others.size()]);
  };
  const int refused = count_refused(buffer().as_json(rest()), 2, rounds, 3, change, survives);
  EXPECT_LT(refused, rounds - rounds / 20);
}

TEST(GltfFuzz, ExchangedPieces) {
  const std::string sound = buffer().as_json(rest());
  count_refused(sound, 3, rounds, 3, exchanged_piece(sound), survives);
}

}  // namespace
}  // namespace kaustik::test
