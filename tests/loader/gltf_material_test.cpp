// Materials of glTF: what they become, by their values.

#include <cmath>

#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

const std::string picture =
    R"("images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],"textures":[{"source":0}])";

TEST(GltfMaterials, TheDefaultIsRoughMetal) {
  const GltfMaterial material("");
  EXPECT_EQ(material.bsdf().type, "twosided");
  EXPECT_EQ(material.core().type, "openpbr");
  EXPECT_EQ(value<Rgb>(material.core(), "base_color"), (Rgb{1, 1, 1}));
  EXPECT_EQ(value<double>(material.core(), "base_metalness"), 1);
  EXPECT_EQ(value<double>(material.core(), "specular_roughness"), 1);
  EXPECT_EQ(value<double>(material.core(), "specular_ior"), 1.5);
  const Description none = parse_gltf_text(one_triangle());
  EXPECT_EQ(core_of(only_in(*none.scene, "shape")).properties.size(),
            material.core().properties.size());
}

TEST(GltfMaterials, FactorsMultiplyTextures) {
  const GltfMaterial material(R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],
      "baseColorTexture":{"index":0},"metallicFactor":0.5,"roughnessFactor":1,
      "metallicRoughnessTexture":{"index":0}})",
                              picture);
  const Object& core = material.core();
  const Object& color = child_named(core, "base_color");
  EXPECT_EQ(color.type, "scale");
  EXPECT_EQ(value<Rgb>(color, "scale"), (Rgb{0.5, 0.25, 1}));
  const Object& bitmap = child_named(color, "value");
  EXPECT_EQ(bitmap.type, "bitmap");
  EXPECT_EQ(find_property(bitmap, "raw"), nullptr);
  const auto& bytes = value<std::shared_ptr<const Array>>(bitmap, "data");
  EXPECT_EQ(bytes->extents(), std::vector<size_t>{8});
  EXPECT_EQ(int(bytes->bytes()[1]), 'P');
  const Object& roughness = child_named(core, "specular_roughness");
  EXPECT_EQ(value<std::string>(roughness, "channel"), "g");
  EXPECT_TRUE(value<bool>(roughness, "raw"));
  const Object& metal = child_named(core, "base_metalness");
  EXPECT_EQ(value<Rgb>(metal, "scale"), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(value<std::string>(child_named(metal, "value"), "channel"), "b");
  EXPECT_EQ(value<std::shared_ptr<const Array>>(roughness, "data"), bytes);  // decoded from one
}

TEST(GltfTextures, SamplersAndTransforms) {
  const GltfMaterial material(
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{
      "KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.5707963267948966,"scale":[2,4]}}}})",
      R"("images":[{"uri":"data:;base64,AAAA"}],"textures":[{"source":0,"sampler":0}],
      "samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}])");
  const Object& bitmap = child_named(material.core(), "base_color");
  EXPECT_EQ(value<std::string>(bitmap, "wrap_mode_u"), "clamp");
  EXPECT_EQ(value<std::string>(bitmap, "wrap_mode_v"), "mirror");
  EXPECT_EQ(value<std::string>(bitmap, "filter_type"), "nearest");
  // Anticlockwise as one looks at the picture: what ran right runs up, toward −v.
  const auto& to_uv = value<Transform>(bitmap, "to_uv");
  EXPECT_LT(length(to_uv.point(Vec3f(1, 0, 0)) - Vec3f(0.5, -1.75, 0)), 1e-6f);
  EXPECT_LT(length(to_uv.point(Vec3f(0, 1, 0)) - Vec3f(4.5, 0.25, 0)), 1e-6f);
}

/// The extension's example: the lower left quarter of the picture, turned clockwise.
TEST(GltfTextures, TransformsOfTheSpecificationsExample) {
  const GltfMaterial material(
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{
      "KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]}}}})",
      picture);
  const auto& to_uv = value<Transform>(child_named(material.core(), "base_color"), "to_uv");
  EXPECT_LT(length(to_uv.point(Vec3f(0, 0, 0)) - Vec3f(0, 1, 0)), 1e-6f);
  EXPECT_LT(length(to_uv.point(Vec3f(1, 0, 0)) - Vec3f(0, 0.5, 0)), 1e-6f);
  EXPECT_LT(length(to_uv.point(Vec3f(1, 1, 0)) - Vec3f(0.5, 0.5, 0)), 1e-6f);
}

TEST(GltfTextures, OtherCoordinatesAreTakenFromTheMesh) {
  GltfBuffer buffer;
  buffer.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  buffer.add<float>({0, 0, 0, 0, 0, 0}, "VEC2", 2);
  buffer.add<float>({0, 1, 1, 1, 0, 0}, "VEC2", 2);
  const Description description = parse_gltf_text(buffer.as_json(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,
      "TEXCOORD_1":2},"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":
      {"index":0,"texCoord":1}},"normalTexture":{"index":0}}],)" +
      picture));
  EXPECT_EQ(floats_of(only_in(*description.scene, "shape"), "uv"),
            (std::vector<float>{0, 1, 1, 1, 0, 0}));
  EXPECT_TRUE(has_deviation(description, DeviationKind::approximated, "texture coordinates"));
}

TEST(GltfTextures, MissingPicturesAreMagentaCheckers) {
  const GltfMaterial material(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0},
      "metallicRoughnessTexture":{"index":0},"roughnessFactor":0.5})",
                              R"("images":[{"uri":"no.png"}],"textures":[{"source":0}])");
  EXPECT_EQ(child_named(material.core(), "base_color").type, "checkerboard");
  EXPECT_EQ(value<double>(material.core(), "specular_roughness"), 0.5);
  EXPECT_TRUE(has_deviation(material.description(), DeviationKind::missing, "no file 'no.png'"));
}

TEST(GltfMaterials, NormalMapsHaveTheirStrength) {
  const GltfMaterial material(R"("normalTexture":{"index":0,"scale":0.5})", picture);
  const Object& relief = only_in(material.bsdf(), "bsdf");
  EXPECT_EQ(relief.type, "normalmap");
  EXPECT_EQ(value<double>(relief, "strength"), 0.5);
  EXPECT_TRUE(value<bool>(child_named(relief, "normalmap"), "raw"));
}

TEST(GltfMaterials, AlphaMakesHoles) {
  const std::string color = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]},)";
  EXPECT_EQ(GltfMaterial(color + R"("alphaMode":"OPAQUE")").bsdf().type, "twosided");
  const GltfMaterial blend(color + R"("alphaMode":"BLEND")");
  EXPECT_EQ(blend.bsdf().type, "mask");
  EXPECT_EQ(value<double>(blend.bsdf(), "opacity"), 0.25);
  EXPECT_EQ(find_property(blend.bsdf(), "cutoff"), nullptr);
  const GltfMaterial mask(
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"alphaMode":"MASK",
      "alphaCutoff":0.75)",
      picture);
  EXPECT_EQ(value<double>(mask.bsdf(), "cutoff"), 0.75);
  EXPECT_EQ(value<std::string>(child_named(mask.bsdf(), "opacity"), "channel"), "a");
}

TEST(GltfMaterials, EmissionIsInCandelasPerSquareMetre) {
  const GltfMaterial material(R"("emissiveFactor":[1,0.5,0],"doubleSided":true,
      "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":358}})");
  const Object& emitter = only_in(material.shape(), "emitter");
  EXPECT_EQ(emitter.type, "area");
  EXPECT_EQ(value<Rgb>(emitter, "radiance"), (Rgb{2, 1, 0}));
  EXPECT_TRUE(value<bool>(emitter, "two_sided"));
  EXPECT_TRUE(objects_in(*material.description().scene, "emitter").empty());  // no studio
}

TEST(GltfMaterials, FaintEmissionGoesWithTheStudio) {
  const GltfMaterial material(R"("emissiveFactor":[1,1,1])");
  const Object& emitter = only_in(material.shape(), "emitter");
  EXPECT_EQ(value<Rgb>(emitter, "radiance"), (Rgb{1 / 179.0, 1 / 179.0, 1 / 179.0}));
  EXPECT_EQ(value<double>(emitter, "scale"), 160);
  EXPECT_EQ(only_in(*material.description().scene, "emitter").type, "constant");
  EXPECT_TRUE(has_deviation(material.description(), DeviationKind::approximated, "160 times"));
}

const std::string transmission = R"("KHR_materials_transmission":{"transmissionFactor":1})";

std::string glass(const std::string& more, double roughness = 0) {
  return R"("pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":)" +
         std::to_string(roughness) + R"(},"extensions":{)" + transmission + more + "}";
}

TEST(GltfGlass, IsAPaneByTheLetter) {
  EXPECT_EQ(GltfMaterial(glass("")).bsdf().type, "thindielectric");
  const GltfMaterial ground(glass("", 0.5));
  EXPECT_EQ(ground.bsdf().type, "openpbr");
  EXPECT_TRUE(value<bool>(ground.bsdf(), "geometry_thin_walled"));
  EXPECT_EQ(value<double>(ground.bsdf(), "transmission_weight"), 1);
  LoadOptions solid;
  solid.definitions = {{"gltf.glass", "solid"}};
  EXPECT_EQ(GltfMaterial(glass(""), "", solid).bsdf().type, "dielectric");
}

TEST(GltfGlass, IsNoLessForExtensionsThatDoNothing) {
  const std::string nothing =
      R"(,"KHR_materials_specular":{"specularFactor":1},"KHR_materials_clearcoat":{"clearcoatFactor":0},
      "KHR_materials_sheen":{"sheenColorFactor":[0,0,0]})";
  EXPECT_EQ(GltfMaterial(glass(nothing)).bsdf().type, "thindielectric");
  EXPECT_EQ(
      GltfMaterial(glass(R"(,"KHR_materials_clearcoat":{"clearcoatFactor":0.5})")).bsdf().type,
      "openpbr");
}

TEST(GltfGlass, WithAThicknessIsABody) {
  const std::string volume =
      R"(,"KHR_materials_ior":{"ior":1.7},"KHR_materials_volume":{"thicknessFactor":0.1,
      "attenuationDistance":0.5,"attenuationColor":[1,0.5,0.25]})";
  const GltfMaterial material(glass(volume));
  EXPECT_EQ(material.bsdf().type, "dielectric");
  EXPECT_EQ(value<double>(material.bsdf(), "int_ior"), 1.7);
  EXPECT_EQ(value<double>(material.bsdf(), "ext_ior"), 1.0);
  const Object& medium = child_named(material.shape(), "interior");
  EXPECT_EQ(medium.type, "homogeneous");
  // exp(−σ · 0.5) is the colour.
  const Rgb sigma = value<Rgb>(medium, "sigma_a");
  EXPECT_NEAR(sigma.r, 0, 1e-12);
  EXPECT_NEAR(sigma.g, 2 * std::log(2.0), 1e-12);
  EXPECT_NEAR(sigma.b, 4 * std::log(2.0), 1e-12);
  EXPECT_EQ(value<Rgb>(medium, "sigma_s"), (Rgb{}));
  const GltfMaterial rough(glass(volume, 0.5));
  EXPECT_EQ(rough.bsdf().type, "roughdielectric");
  EXPECT_EQ(value<std::string>(rough.bsdf(), "distribution"), "ggx");
  EXPECT_NEAR(value<double>(rough.bsdf(), "alpha"), 0.25, 1e-12);
  LoadOptions thin;
  thin.definitions = {{"gltf.glass", "thin"}};
  const GltfMaterial pane(glass(volume), "", thin);
  EXPECT_EQ(pane.bsdf().type, "thindielectric");
  EXPECT_EQ(objects_in(pane.shape(), "medium").size(), 0u);
}

/// A tetrahedron, whose last face may be missing; vertices are not shared.
Description tetrahedron(int faces, const LoadOptions& options = {}) {
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int order[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::vector<float> positions;
  for (int face = 0; face < faces; ++face)
    for (const int corner : order[face])
      positions.insert(positions.end(), corners[corner], corners[corner] + 3);
  GltfBuffer buffer;
  buffer.add(positions, "VEC3", 3);
  return parse_gltf_text(
      buffer.as_json(
          R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},
          "material":0}]}],"materials":[{)" +
          glass("") + "}]"),
      options);
}

TEST(GltfGlass, OfClosedMeshesIsABody) {
  const Description closed = tetrahedron(4), open = tetrahedron(3);
  EXPECT_EQ(only_in(only_in(*closed.scene, "shape"), "bsdf").type, "dielectric");
  EXPECT_TRUE(has_deviation(closed, DeviationKind::approximated, "solid glass"));
  EXPECT_EQ(only_in(only_in(*open.scene, "shape"), "bsdf").type, "thindielectric");
  LoadOptions thin;
  thin.definitions = {{"gltf.glass", "thin"}};
  const Description panes = tetrahedron(4, thin);
  EXPECT_EQ(only_in(only_in(*panes.scene, "shape"), "bsdf").type, "thindielectric");
}

TEST(GltfMaterials, LayersAreThoseOfOpenPbr) {
  const GltfMaterial material(R"("pbrMetallicRoughness":{"metallicFactor":0},"extensions":{
      "KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.25},
      "KHR_materials_sheen":{"sheenColorFactor":[1,0,0.5],"sheenRoughnessFactor":0.75},
      "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,0.5,0]}})");
  const Object& core = material.core();
  EXPECT_EQ(value<double>(core, "coat_weight"), 0.5);
  EXPECT_EQ(value<double>(core, "coat_roughness"), 0.25);
  EXPECT_EQ(value<double>(core, "coat_ior"), 1.5);
  EXPECT_EQ(value<double>(core, "fuzz_weight"), 1);
  EXPECT_EQ(value<Rgb>(core, "fuzz_color"), (Rgb{1, 0, 0.5}));
  EXPECT_EQ(value<double>(core, "fuzz_roughness"), 0.5625);  // the width, in glTF the square
  EXPECT_EQ(value<double>(core, "specular_weight"), 0.5);
  EXPECT_EQ(value<Rgb>(core, "specular_color"), (Rgb{1, 0.5, 0}));
}

double specular_ior(const std::string& extensions) {
  return value<double>(
      GltfMaterial(R"("pbrMetallicRoughness":{"metallicFactor":0},"extensions":{)" + extensions +
                   "}")
          .core(),
      "specular_ior");
}
/// The share of light that it reflects straight on.
double normal_reflectance(const std::string& extensions) {
  const double ior = specular_ior(extensions);
  return (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
}

TEST(GltfMaterials, SpecularFactorsSetWhatIsReflectedStraightOn) {
  EXPECT_NEAR(normal_reflectance(""), 0.04, 1e-12);
  EXPECT_NEAR(normal_reflectance(R"("KHR_materials_ior":{"ior":3})"), 0.25, 1e-12);
  EXPECT_EQ(specular_ior(R"("KHR_materials_specular":{"specularFactor":0})"), 1);
  const std::string twice = R"("KHR_materials_specular":{"specularColorFactor":[2,1,0]})";
  EXPECT_NEAR(normal_reflectance(twice), 0.08, 1e-12);
  EXPECT_EQ(
      value<Rgb>(GltfMaterial(R"("pbrMetallicRoughness":{"metallicFactor":0},"extensions":{)" +
                              twice + "}")
                     .core(),
                 "specular_color"),
      (Rgb{1, 0.5, 0}));
  // An index of 0 stands for all light, of which the colour leaves its share.
  EXPECT_NEAR(normal_reflectance(
                  R"("KHR_materials_ior":{"ior":0},"KHR_materials_specular":{"specularColorFactor":
                     [0.5,0.5,0.5]})"),
              0.5, 1e-12);
}

TEST(GltfMaterials, BeneathAFullCoatTheBaseReflectsAsInAir) {
  const double bare = specular_ior(R"("KHR_materials_ior":{"ior":1.6})");
  const double coated = specular_ior(
      R"("KHR_materials_ior":{"ior":1.6},"KHR_materials_clearcoat":{"clearcoatFactor":1})");
  EXPECT_NEAR(coated / 1.5, bare, 1e-12);
}

TEST(GltfMaterials, SheenTakesFromTheBaseWhatItsColourReflects) {
  const GltfMaterial material(R"("extensions":{"KHR_materials_sheen":{"sheenColorFactor":
      [0.2,0.1,0.05],"sheenRoughnessFactor":0.5}})");
  EXPECT_EQ(value<double>(material.core(), "fuzz_weight"), 0.2);
  EXPECT_EQ(value<Rgb>(material.core(), "fuzz_color"), (Rgb{1, 0.5, 0.25}));
  EXPECT_EQ(value<double>(material.core(), "fuzz_roughness"), 0.25);
  EXPECT_EQ(find_property(GltfMaterial(R"("extensions":{"KHR_materials_sheen":{}})").core(),
                          "fuzz_weight"),
            nullptr);
}

TEST(GltfMaterials, AnisotropyKeepsBothSlopes) {
  const GltfMaterial material(R"("pbrMetallicRoughness":{"roughnessFactor":0.5},"extensions":{
      "KHR_materials_anisotropy":{"anisotropyStrength":0.6}})");
  // Burley's: α over and times √(1 − 0.9 a).
  const double r = value<double>(material.core(), "specular_roughness");
  const double a = value<double>(material.core(), "specular_roughness_anisotropy");
  const double aspect = std::sqrt(1 - 0.9 * a);
  EXPECT_NEAR(r * r * aspect, 0.25, 1e-12);
  EXPECT_NEAR(r * r / aspect, 0.25 + 0.75 * 0.36, 1e-12);
}

TEST(GltfMaterials, SheetsLetScatteredLightThrough) {
  const GltfMaterial material(R"("pbrMetallicRoughness":{"metallicFactor":0},"extensions":{
      "KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.5,
      "diffuseTransmissionColorFactor":[0,1,0]}})");
  EXPECT_EQ(material.bsdf().type, "openpbr");
  EXPECT_TRUE(value<bool>(material.bsdf(), "geometry_thin_walled"));
  EXPECT_EQ(value<double>(material.bsdf(), "subsurface_weight"), 0.5);
  EXPECT_EQ(value<Rgb>(material.bsdf(), "subsurface_color"), (Rgb{0, 1, 0}));
}

TEST(GltfMaterials, SpecularAndGlossinessReflectTheirColourStraightOn) {
  const GltfMaterial material(R"("extensions":{"KHR_materials_pbrSpecularGlossiness":{
      "diffuseFactor":[0.5,0,0,1],"specularFactor":[0.16,0.08,0.04],"glossinessFactor":0.75}})");
  const double ior = value<double>(material.core(), "specular_ior");
  EXPECT_NEAR(std::pow((ior - 1) / (ior + 1), 2), 0.16, 1e-12);
  EXPECT_EQ(value<Rgb>(material.core(), "specular_color"), (Rgb{1, 0.5, 0.25}));
  EXPECT_EQ(value<double>(material.core(), "specular_roughness"), 0.25);
}

TEST(GltfMaterials, SpecularAndGlossinessGoFirst) {
  const std::string archived =
      R"("extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,0.25,0,0.5]}})";
  const std::string plain = R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1])";
  const GltfMaterial both(plain + R"(},"alphaMode":"BLEND",)" + archived);
  EXPECT_EQ(value<Rgb>(both.core(), "base_color"), (Rgb{0.5, 0.25, 0}));
  EXPECT_EQ(value<double>(both.bsdf(), "opacity"), 0.5);
  // But where the other model has its roughness as a picture.
  const GltfMaterial picture_of_it(
      plain + R"(,"metallicRoughnessTexture":{"index":0}},)" + archived, picture);
  EXPECT_EQ(value<Rgb>(picture_of_it.core(), "base_color"), (Rgb{1, 1, 1}));
}

TEST(GltfMaterials, ACutoffBeyondOneLeavesNothing) {
  const GltfMaterial material(R"("alphaMode":"MASK","alphaCutoff":1.5)");
  EXPECT_EQ(value<double>(material.bsdf(), "opacity"), 0);
  EXPECT_EQ(find_property(material.bsdf(), "cutoff"), nullptr);
}

TEST(GltfMaterials, WithoutItsShareASheetIsOpaque) {
  EXPECT_EQ(GltfMaterial(R"("extensions":{"KHR_materials_diffuse_transmission":{}})").bsdf().type,
            "twosided");
}

TEST(GltfMaterials, GlassDispersesByItsAbbeNumber) {
  const GltfMaterial glass(
      R"("pbrMetallicRoughness":{"roughnessFactor":0,"metallicFactor":0},"extensions":{
         "KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":1},
         "KHR_materials_dispersion":{"dispersion":0.5}})");
  EXPECT_EQ(std::get<double>(find_property(glass.bsdf(), "abbe_number")->value), 40);
}

TEST(GltfMaterials, WhatIsNotRenderedIsTold) {
  const auto tells = [](const std::string& members, const std::string& text,
                        DeviationKind kind = DeviationKind::ignored) {
    return has_deviation(GltfMaterial(members).description(), kind, text);
  };
  EXPECT_TRUE(tells(R"("name":"soap","extensions":{"KHR_materials_iridescence":{}})",
                    "material 'soap': its KHR_materials_iridescence"));
  EXPECT_TRUE(tells(R"("extensions":{"KHR_materials_dispersion":{}})", "dispersion"));
  EXPECT_TRUE(
      tells(R"("extensions":{"KHR_materials_unlit":{}})", "unlit", DeviationKind::approximated));
  EXPECT_TRUE(tells(R"("pbrMetallicRoughness":{"roughnessFactor":7})", "'roughnessFactor' is 7",
                    DeviationKind::approximated));
}

TEST(GltfMaterials, VariantsAreChosenByName) {
  const std::string rest =
      R"("materials":[{"name":"a"},{"name":"b","pbrMetallicRoughness":{"metallicFactor":0}}],
      "extensions":{"KHR_materials_variants":{"variants":[{"name":"day"},{"name":"night"}]}})";
  const std::string primitive = R"(,"material":0,"extensions":{"KHR_materials_variants":{"mappings":
      [{"material":1,"variants":[1]}]}})";
  const auto metalness = [&](const LoadOptions& options) {
    const Description description = parse_gltf_text(one_triangle(rest, primitive), options);
    return value<double>(core_of(only_in(*description.scene, "shape")), "base_metalness");
  };
  LoadOptions options;
  EXPECT_EQ(metalness(options), 1);
  options.definitions = {{"gltf.variant", "night"}};
  EXPECT_EQ(metalness(options), 0);
  options.definitions = {{"gltf.variant", "nigth"}};
  EXPECT_NE(problems_of([&] { metalness(options); })[0].remedy.find("night"), std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
