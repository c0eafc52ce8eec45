// Scenes of glTF are built without a word: all that its reader writes is what the tables take.

#include <gtest/gtest.h>

#include "kaustik/loader/gltf/gltf_scene.h"
#include "kaustik/scene/scene.h"

namespace kaustik::test {
namespace {

std::string file_with(const std::string& material) {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":60,
"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},
"material":0}]}],"images":[{"uri":"no.png"}],"textures":[{"source":0}],
"materials":[{)" +
         material + "}]}";
}

void expect_sound(const std::string& material) {
  SCOPED_TRACE(material);
  try {
    const auto scene = build_scene(parse_gltf(file_with(material), "test.gltf", "/nonexistent"));
    for (const std::string& warning : scene->warnings()) ADD_FAILURE() << warning;
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
}

TEST(GltfScene, AllMaterialsAreBuilt) {
  for (const char* base : {R"("pbrMetallicRoughness":{"metallicFactor":0})",
                           R"("pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0})",
                           R"("pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,0.5]},
                              "alphaMode":"BLEND")",
                           R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
                              "alphaMode":"MASK","alphaCutoff":0.2)",
                           R"("emissiveFactor":[1,1,0.5],"emissiveTexture":{"index":0},
                              "doubleSided":true)"}) {
    expect_sound(base);
    for (const char* extension :
         {R"("KHR_materials_transmission":{"transmissionFactor":1})",
          R"("KHR_materials_transmission":{"transmissionFactor":0.5},"KHR_materials_volume":
             {"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[0.5,0.2,0]})",
          R"("KHR_materials_ior":{"ior":0})", R"("KHR_materials_ior":{"ior":1})",
          R"("KHR_materials_ior":{"ior":2.4},"KHR_materials_clearcoat":{"clearcoatFactor":1})",
          R"("KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[3,2,1]})",
          R"("KHR_materials_specular":{"specularColorFactor":[0,0,0]})",
          R"("KHR_materials_specular":{"specularFactor":0},"KHR_materials_clearcoat":
             {"clearcoatFactor":1})",
          R"("KHR_materials_sheen":{"sheenColorFactor":[0.5,0.2,0],"sheenRoughnessFactor":1})",
          R"("KHR_materials_anisotropy":{"anisotropyStrength":1})",
          R"("KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.5})",
          R"("KHR_materials_iridescence":{"iridescenceFactor":1})",
          R"("KHR_materials_dispersion":{"dispersion":0.3})", R"("KHR_materials_unlit":{})",
          R"("KHR_materials_emissive_strength":{"emissiveStrength":5})",
          R"("KHR_materials_pbrSpecularGlossiness":{"specularFactor":[1,0,0]})"})
      expect_sound(std::string(base) + ",\"extensions\":{" + extension + "}");
  }
}

}  // namespace
}  // namespace kaustik::test
