// pbrt's materials, spectra and textures.

#include <cmath>
#include <set>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/colour_space.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

TEST(PbrtMaterials, DiffuseIsSeenFromBothSides) {
  const auto bsdf = material("Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]");
  EXPECT_EQ(one_sided(*bsdf).type, "diffuse");
  expect_rgb(value<Rgb>(one_sided(*bsdf), "reflectance"), .1, .2, .3);
  EXPECT_EQ(value<double>(one_sided(*material("")), "reflectance"), .5);
}

TEST(PbrtMaterials, CoatedDiffuseIsNonlinearPlastic) {
  const Object smooth = one_sided(*material("Material \"coateddiffuse\""));
  EXPECT_EQ(smooth.type, "plastic");
  EXPECT_TRUE(value<bool>(smooth, "nonlinear"));
  EXPECT_EQ(value<double>(smooth, "int_ior"), 1.5);
  EXPECT_EQ(value<double>(smooth, "ext_ior"), 1);
  const Object rough = one_sided(*material("Material \"coateddiffuse\" \"float roughness\" .25"));
  EXPECT_EQ(rough.type, "roughplastic");
  EXPECT_EQ(value<std::string>(rough, "distribution"), "ggx");
  EXPECT_NEAR(value<double>(rough, "alpha"), .5, 1e-12);  // the root
  const Object plain = one_sided(*material(
      "Material \"coateddiffuse\" \"float roughness\" .25 \"bool remaproughness\" false"));
  EXPECT_EQ(value<double>(plain, "alpha"), .25);
}

TEST(PbrtMaterials, ConductorsOfMetalsReflectancesAndIndices) {
  EXPECT_EQ(value<std::string>(one_sided(*material("Material \"conductor\"")), "material"), "cu");
  const Object gold = one_sided(*material(
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" "
      "\"float uroughness\" .04 \"float vroughness\" .09"));
  EXPECT_EQ(gold.type, "roughconductor");
  EXPECT_EQ(value<std::string>(gold, "material"), "au");
  EXPECT_NEAR(value<double>(gold, "alpha_u"), .2, 1e-12);
  EXPECT_NEAR(value<double>(gold, "alpha_v"), .3, 1e-12);
  // At normal incidence ((η − 1)² + k²) / ((η + 1)² + k²).
  const Object grey = one_sided(*material("Material \"conductor\" \"rgb reflectance\" [.2 .5 .9]"));
  EXPECT_EQ(value<double>(grey, "eta"), 1);
  const Rgb k = value<Rgb>(grey, "k");
  const auto reflected = [](double x) { return x * x / (4 + x * x); };
  expect_rgb({reflected(k.r), reflected(k.g), reflected(k.b)}, .2, .5, .9);
  const Object indices =
      one_sided(*material("Material \"conductor\" \"rgb eta\" [1 2 3] \"rgb k\" [4 5 6]"));
  expect_rgb(value<Rgb>(indices, "eta"), 1, 2, 3);
  expect_rgb(value<Rgb>(indices, "k"), 4, 5, 6);
}

TEST(PbrtMaterials, DielectricsBorderOnNothing) {
  const auto glass = material("Material \"dielectric\"");
  EXPECT_EQ(glass->type, "dielectric");
  EXPECT_EQ(value<double>(*glass, "int_ior"), 1.5);
  EXPECT_EQ(value<double>(*glass, "ext_ior"), 1);
  EXPECT_EQ(material("Material \"dielectric\" \"float roughness\" .1")->type, "roughdielectric");
  EXPECT_EQ(material("Material \"thindielectric\" \"float eta\" 1.3")->type, "thindielectric");
  const Description named = parse_scene_of_pbrt(
      "WorldBegin Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" Shape \"sphere\"");
  EXPECT_NEAR(value<double>(*bsdf_of(named), "int_ior"), 1.5168, 1e-4);
  EXPECT_NEAR(value<double>(*bsdf_of(named), "abbe_number"), 64.17, 1e-9);
  EXPECT_TRUE(is_approximated(named, "dielectric", "Abbe number"));
  const auto curve =
      material("Material \"dielectric\" \"spectrum eta\" [ 486.1 1.62 587.6 1.61 656.3 1.60 ]");
  EXPECT_NEAR(value<double>(*curve, "int_ior"), 1.61, 1e-6);
  EXPECT_NEAR(value<double>(*curve, "abbe_number"), 30.5, 1e-6);
}

TEST(PbrtMaterials, DiffuseTransmission) {
  const auto sheet = material(
      "Material \"diffusetransmission\" \"rgb reflectance\" [.2 .2 .2] \"float scale\" .5");
  EXPECT_EQ(sheet->type, "thinphong");
  expect_rgb(value<Rgb>(*sheet, "diffuse_reflectance"), .1, .1, .1);
  EXPECT_EQ(value<double>(*sheet, "diffuse_transmittance"), .125);
  EXPECT_EQ(value<double>(*sheet, "specular_reflectance"), 0);
  // No more than arrives.
  const auto bright = material(
      "Material \"diffusetransmission\" \"rgb reflectance\" [.9 .5 .1] \"rgb transmittance\" "
      "[.6 .5 .1]");
  expect_rgb(value<Rgb>(*bright, "diffuse_reflectance"), .6, .5 / 1.5, .1 / 1.5);
  expect_rgb(value<Rgb>(*bright, "diffuse_transmittance"), .4, .5 / 1.5, .1 / 1.5);
}

TEST(PbrtMaterials, InterfacesAndMixtures) {
  for (const char* name : {"interface", "", "none"})
    EXPECT_EQ(material("Material \"" + std::string(name) + "\"")->type, "null");
  const auto mix = material(R"(
    MakeNamedMaterial "a" "string type" "diffuse"
    MakeNamedMaterial "b" "string type" "dielectric"
    Material "mix" "string materials" ["a" "b"] "float amount" .25)");
  EXPECT_EQ(mix->type, "blendbsdf");
  EXPECT_EQ(value<double>(*mix, "weight"), .25);
  ASSERT_EQ(mix->children.size(), 2u);
  EXPECT_EQ(mix->children[0].object->type, "twosided");
  EXPECT_EQ(mix->children[1].object->type, "dielectric");
}

TEST(PbrtMaterials, CoatedConductorIsACoatOverMetal) {
  const Object coat = one_sided(*material("Material \"coatedconductor\""));
  EXPECT_EQ(coat.type, "coating");
  EXPECT_EQ(value<double>(only(coat, "bsdf"), "ext_eta"), 1.5);  // indices under the coat
}

TEST(PbrtMaterials, SubsurfaceFillsTheBody) {
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Material \"subsurface\" \"rgb reflectance\" [.5 .5 .5] \"rgb mfp\" [.1 .2 .4] "
      "Shape \"sphere\"");
  const Object& sphere = only(scene, "shape");
  EXPECT_EQ(only(sphere, "bsdf").type, "dielectric");
  const Object& medium = child(sphere, "interior");
  expect_rgb(value<Rgb>(medium, "sigma_t"), 10, 5, 2.5);  // 1 / mfp
  // α = 1 − exp(−5.09406 a + 2.61188 a² − 4.31805 a³) at a = 0.5.
  EXPECT_NEAR(value<Rgb>(medium, "albedo").g, 1 - std::exp(-2.54703 + .65297 - .53975625), 1e-9);
}

TEST(PbrtMaterials, TexturesOfSkinLieUnderACoat) {
  const TemporaryFolder folder;
  folder.write("skin.png", "?");
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"skin.png\"\n"
      "Material \"subsurface\" \"texture reflectance\" \"t\" \"rgb mfp\" [.1 .2 .3] "
      "\"float roughness\" .01 Shape \"sphere\"",
      false, folder / "");
  const Object& coat = one_sided(*bsdf_of(scene));
  EXPECT_EQ(coat.type, "roughplastic");
  EXPECT_EQ(value<double>(coat, "int_ior"), 1.33);
  EXPECT_EQ(child(coat, "diffuse_reflectance").type, "bitmap");
  EXPECT_EQ(only(scene, "shape").children.size(), 1u);
  EXPECT_EQ(scene.deviations.size(), 1u);
  EXPECT_TRUE(is_approximated(scene, "subsurface", "does not spread"));
}

TEST(PbrtMaterials, MetalsUnderACoatBorderOnIt) {
  const Object coat = one_sided(*material(
      "Material \"coatedconductor\" \"rgb reflectance\" [.25 .5 .64] \"float interface.eta\" 2"));
  EXPECT_EQ(coat.type, "coating");
  const Object& metal = only(coat, "bsdf");
  // η = 1 and k = 2 √r / √(1 − r), both over the coat's index.
  EXPECT_EQ(value<double>(metal, "eta"), .5);
  expect_rgb(value<Rgb>(metal, "k"), 1 / std::sqrt(3), 1, 4. / 3, 1e-9);
  // So at normal incidence from within the coat ((η − 1)² + k²) / ((η + 1)² + k²) = 1.25 / 3.25.
  EXPECT_NEAR((.25 + 1) / (2.25 + 1), 1.25 / 3.25, 1e-12);
  const Object indices =
      only(one_sided(*material("Material \"coatedconductor\" \"rgb conductor.eta\" "
                               "[1 2 3] \"rgb conductor.k\" [4 5 6] "
                               "\"float interface.eta\" 2")),
           "bsdf");
  expect_rgb(value<Rgb>(indices, "eta"), .5, 1, 1.5);
  expect_rgb(value<Rgb>(indices, "k"), 2, 2.5, 3);
}

TEST(PbrtMaterials, IdsAreUnique) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    MakeNamedMedium "a" "string type" "homogeneous"
    MakeNamedMaterial "a" "string type" "diffuse"
    ObjectBegin "a" Shape "sphere" ObjectEnd
    NamedMaterial "a" MediumInterface "a" ""
    Shape "sphere"
    ObjectInstance "a")");
  const auto shapes = objects_of(scene, "shape");
  const std::set<std::string> ids = {only(*shapes[0], "bsdf").id, child(*shapes[0], "interior").id,
                                     shapes[1]->id};
  EXPECT_EQ(ids, (std::set<std::string>{"a", "a_2", "a_3"}));
}

TEST(PbrtMaterials, WhatIsNotHereIsTold) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Material "hair" Shape "sphere"
    Material "measured" "string filename" "x.bsdf" Shape "sphere"
    Material "cheese" Shape "sphere"
    Material "diffuse" "float reflectanse" .5 Shape "sphere"
    Material "coateddiffuse" "rgb albedo" [.5 .5 .5] Shape "sphere")");
  EXPECT_TRUE(is_approximated(scene, "'hair'", "glossy coat"));
  EXPECT_TRUE(is_approximated(scene, "'measured'", "not read"));
  EXPECT_TRUE(is_approximated(scene, "'cheese'", "no material"));
  EXPECT_TRUE(is_ignored(scene, "'diffuse'", "'reflectanse' has no effect"));
  EXPECT_TRUE(is_approximated(scene, "'coateddiffuse'", "scatters in it"));
  EXPECT_EQ(objects_of(scene, "shape").size(), 5u);
  EXPECT_THROW(parse_scene_of_pbrt("WorldBegin Material \"hair\" Shape \"sphere\"", true), Error);
}

TEST(PbrtSpectra, BlackbodiesAndSamplesHaveLuminanceOne) {
  for (const double kelvin : {2000., 6500., 12000.}) {
    SpectralCurve curve = pbrt::blackbody_curve(kelvin);
    const double whole = pbrt::luminance(curve);
    const Description scene =
        parse_scene_of_pbrt("WorldBegin LightSource \"point\" \"blackbody I\" " +
                            std::to_string(kelvin) + " \"float scale\" 3");
    EXPECT_NEAR(pbrt::luminance(value<SpectralCurve>(only(scene, "emitter"), "intensity")), 3, 1e-9)
        << whole;
  }
  const Description flat =
      parse_scene_of_pbrt("WorldBegin LightSource \"point\" \"spectrum I\" [360 7 830 7]");
  EXPECT_NEAR(value<SpectralCurve>(only(flat, "emitter"), "intensity").samples[0].second, 1, 1e-9);
  // Wien's law: its maximum is 1 where λT = 2.898 mm K.
  EXPECT_NEAR(pbrt::blackbody_curve(2897.771955e3 / 500).samples[28].second, 1, 1e-6);
}

TEST(PbrtSpectra, XyzIsTakenByTheMatrixOfRec709) {
  const Description scene =
      parse_scene_of_pbrt("WorldBegin LightSource \"point\" \"xyz I\" [.95047 1 1.08883]");
  expect_rgb(value<Rgb>(only(scene, "emitter"), "intensity"), 1, 1, 1, 1e-3);
}

TEST(PbrtSpectra, LongFilesAreNoMultiplier) {
  const TemporaryFolder folder;
  std::string samples;
  for (int i = 0; i < 50'000; ++i) samples += std::to_string(300 + i * .01) + " 0.5\n";
  folder.write("grey.spd", samples);
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 1'000; ++i)
    text += "Material \"diffuse\" \"spectrum reflectance\" \"grey.spd\" Shape \"sphere\"\n";
  EXPECT_NE(problems_of([&] { parse_scene_of_pbrt(text, false, folder / ""); })[0].message.find(
                "take more than"),
            std::string::npos);
}

TEST(PbrtSpectra, FilesAndNames) {
  const TemporaryFolder folder;
  folder.write("white.spd", "400 0.5\n700 0.5\n");
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"white.spd\" Shape \"sphere\" "
      "LightSource \"point\" \"spectrum I\" \"stdillum-D65\" "
      "LightSource \"distant\" \"spectrum L\" \"nothing\"",
      false, folder / "");
  EXPECT_EQ(value<SpectralCurve>(one_sided(*bsdf_of(scene)), "reflectance").samples.size(), 2u);
  expect_rgb(value<Rgb>(*objects_of(scene, "emitter")[0], "intensity"), 1, 1, 1, 2e-3);
  EXPECT_TRUE(is_missing(scene, "'distant'", "no spectrum 'nothing'"));
}

class PbrtTextures : public testing::Test {
 protected:
  PbrtTextures() {
    for (const char* name : {"a.png", "b.png", "c.exr", "n.tga"}) folder_.write(name, "?");
  }
  Description parsed(const std::string& lines) {
    return parse_scene_of_pbrt("WorldBegin\n" + lines + "\nShape \"sphere\"", false, folder_ / "");
  }
  /// The reflectance of a matt surface that has the texture "t".
  Description painted(const std::string& textures) {
    return parsed(textures + "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"");
  }
  TemporaryFolder folder_;
};

Vec3f uv_at(const Object& texture, float u, float v) {
  return value<Transform>(texture, "to_uv").point({u, v, 0});
}

TEST_F(PbrtTextures, PicturesBeginAtTheirLowerEdge) {
  const Description scene = painted(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"float uscale\" 2 "
      "\"float vscale\" 3 \"float udelta\" .1 \"float vdelta\" .2 \"string wrap\" \"clamp\" "
      "\"float scale\" .5");
  const Object& scaled = child(one_sided(*bsdf_of(scene)), "reflectance");
  EXPECT_EQ(scaled.type, "scale");
  EXPECT_EQ(value<double>(scaled, "scale"), .5);
  const Object& bitmap = child(scaled, "value");
  EXPECT_EQ(bitmap.type, "bitmap");
  EXPECT_EQ(value<std::string>(bitmap, "wrap_mode"), "clamp");
  EXPECT_NEAR(uv_at(bitmap, .25f, .5f).x, .6, 1e-6);
  EXPECT_NEAR(uv_at(bitmap, .25f, .5f).y, 1 - 1.7, 1e-6);
}

TEST_F(PbrtTextures, EncodingsCountForPngAlone) {
  const auto bitmap = [&](const std::string& file, const std::string& encoding) {
    const Description scene =
        painted("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + file +
                "\" \"string encoding\" \"" + encoding + "\"");
    return child(one_sided(*bsdf_of(scene)), "reflectance");
  };
  EXPECT_TRUE(value<bool>(bitmap("a.png", "linear"), "raw"));
  EXPECT_EQ(value<double>(bitmap("a.png", "gamma 1.8"), "gamma"), 1.8);
  for (const auto& [file, encoding] : {std::pair("n.tga", "linear"), {"a.png", "sRGB"}}) {
    const Object usual = bitmap(file, encoding);
    for (const Property& p : usual.properties)
      EXPECT_TRUE(p.name == "filename" || p.name == "to_uv") << p.name;
  }
}

TEST_F(PbrtTextures, RoughnessIsRootedByThePicturesPower) {
  const Description scene = parsed(
      "Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"c.exr\" \"float scale\" .25\n"
      "Material \"conductor\" \"texture roughness\" \"r\"");
  const Object& metal = one_sided(*bsdf_of(scene));
  EXPECT_EQ(metal.type, "roughconductor");
  const Object& scaled = child(metal, "alpha");
  EXPECT_EQ(value<double>(scaled, "scale"), .5);
  EXPECT_EQ(value<double>(child(scaled, "value"), "power"), .5);
}

TEST_F(PbrtTextures, PicturesForNumbersAreOpacityOrMeans) {
  const Description scene = parsed(
      "Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"bool invert\" true\n"
      "Material \"conductor\" \"texture roughness\" \"r\" \"bool remaproughness\" false");
  const Object& bitmap = child(one_sided(*bsdf_of(scene)), "alpha");
  EXPECT_EQ(value<std::string>(bitmap, "channel"), "number");
  EXPECT_TRUE(value<bool>(bitmap, "invert"));
  EXPECT_TRUE(scene.deviations.empty());
  const Description colour = painted(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"bool invert\" true");
  EXPECT_FALSE(find_property(child(one_sided(*bsdf_of(colour)), "reflectance"), "channel"));
}

TEST_F(PbrtTextures, TexturesOfColourAreRootedAsNumbers) {
  const Description scene = parsed(
      "Texture \"r\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n"
      "Material \"conductor\" \"texture roughness\" \"r\"");
  EXPECT_EQ(value<double>(child(one_sided(*bsdf_of(scene)), "alpha"), "power"), .5);
}

TEST_F(PbrtTextures, CurvesAreScaledByColours) {
  const Description scene = painted(
      "Texture \"c\" \"spectrum\" \"constant\" \"spectrum value\" [360 .5 830 .5]\n"
      "Texture \"t\" \"spectrum\" \"scale\" \"texture tex1\" \"c\" \"rgb tex2\" [.2 .4 .6]");
  // A flat curve is grey.
  expect_rgb(value<Rgb>(one_sided(*bsdf_of(scene)), "reflectance"), .1, .2, .3, 1e-4);
}

TEST_F(PbrtTextures, CheckerboardsHaveSquaresOfAUnit) {
  const Description scene = painted(
      "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.9 .9 .9] \"float uscale\" 4");
  const Object& board = child(one_sided(*bsdf_of(scene)), "reflectance");
  expect_rgb(value<Rgb>(board, "color0"), .9, .9, .9);
  EXPECT_EQ(value<double>(board, "color1"), 0);
  EXPECT_NEAR(uv_at(board, .25f, 0).x, .5, 1e-6);
  EXPECT_NEAR(uv_at(board, 0, 1).y, .5, 1e-6);
}

TEST_F(PbrtTextures, ConstantsScalesAndMixturesOfNumbersFold) {
  const Description scene = painted(R"(
    Texture "one" "spectrum" "constant" "rgb value" [.2 .4 .8]
    Texture "half" "spectrum" "scale" "texture tex" "one" "float scale" .5
    Texture "t" "spectrum" "mix" "texture tex1" "one" "texture tex2" "half" "float amount" .25)");
  expect_rgb(value<Rgb>(one_sided(*bsdf_of(scene)), "reflectance"), .175, .35, .7);
}

TEST_F(PbrtTextures, MixturesOfPicturesAreBlendsOfBsdfs) {
  const Description scene = painted(R"(
    Texture "a" "spectrum" "imagemap" "string filename" "a.png"
    Texture "b" "spectrum" "imagemap" "string filename" "b.png"
    Texture "w" "float" "imagemap" "string filename" "c.exr"
    Texture "t" "spectrum" "mix" "texture tex1" "a" "texture tex2" "b" "texture amount" "w")");
  const Object& blend = *bsdf_of(scene);
  EXPECT_EQ(blend.type, "blendbsdf");
  EXPECT_EQ(child(blend, "weight").type, "bitmap");
  ASSERT_EQ(blend.children.size(), 3u);
  for (const auto& [i, file] : {std::pair<size_t, const char*>(1, "a.png"), {2, "b.png"}}) {
    const Object& texture = child(one_sided(*blend.children[i].object), "reflectance");
    EXPECT_TRUE(value<std::string>(texture, "filename").ends_with(file));
  }
}

TEST_F(PbrtTextures, ProductsOfPicturesAreBlendsWithBlack) {
  const Description scene = painted(R"(
    Texture "a" "spectrum" "imagemap" "string filename" "a.png"
    Texture "w" "float" "imagemap" "string filename" "c.exr"
    Texture "t" "spectrum" "scale" "texture tex" "a" "texture scale" "w")");
  const Object& blend = *bsdf_of(scene);
  EXPECT_EQ(blend.type, "blendbsdf");
  EXPECT_EQ(value<double>(one_sided(*blend.children[1].object), "reflectance"), 0);
}

TEST_F(PbrtTextures, ManyMixturesEnd) {
  std::string lines = "Texture \"t0\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n";
  for (int i = 1; i < 20; ++i)
    lines += "Texture \"t" + std::to_string(i) + "\" \"spectrum\" \"mix\" \"texture tex1\" \"t" +
             std::to_string(i - 1) + "\" \"texture tex2\" \"t" + std::to_string(i - 1) + "\"\n";
  lines += "Texture \"t\" \"spectrum\" \"constant\" \"texture value\" \"t19\"";
  const Description scene = painted(lines);
  EXPECT_TRUE(is_approximated(scene, "diffuse", "many mixed textures"));
}

TEST_F(PbrtTextures, WhatIsMissingIsMagenta) {
  const Description scene =
      painted("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"nowhere.png\"");
  EXPECT_TRUE(is_missing(scene, "'t'", "'nowhere.png' is not there"));
  expect_rgb(value<Rgb>(child(one_sided(*bsdf_of(scene)), "reflectance"), "color0"), 1, 0, 1);
  const Description unnamed = painted("");
  EXPECT_TRUE(is_missing(unnamed, "diffuse", "no texture 't'"));
}

TEST_F(PbrtTextures, TheOthersAreTold) {
  for (const auto& [type, what] : {std::pair("fbm", "noise"),
                                   {"wrinkled", "noise"},
                                   {"windy", "noise"},
                                   {"dots", "left out"},
                                   {"directionmix", "mixed evenly"}}) {
    const Description scene = painted("Texture \"t\" \"spectrum\" \"" + std::string(type) + "\"");
    EXPECT_TRUE(is_approximated(scene, "'t'", what)) << type;
  }
  EXPECT_TRUE(is_missing(painted("Texture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"x\""),
                         "'t'", "Ptex"));
  EXPECT_THROW(painted("Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\""), Error);
}

TEST_F(PbrtTextures, BilinearTexturesHaveTheirCorners) {
  const Description scene =
      painted("Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [1 0 0] \"rgb v11\" [0 0 1]");
  const Object& bitmap = child(one_sided(*bsdf_of(scene)), "reflectance");
  // Rows from v = 1 on: v01, v11, v00, v10.
  EXPECT_EQ(numbers_in<float>(bitmap, "data"),
            (std::vector<float>{1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0}));
  EXPECT_NEAR(uv_at(bitmap, 0, 0).y, .75, 1e-6);
  EXPECT_NEAR(uv_at(bitmap, 1, 1).x, .75, 1e-6);
  EXPECT_NEAR(uv_at(bitmap, 1, 1).y, .25, 1e-6);
}

TEST_F(PbrtTextures, ReliefsLieOverTheWhole) {
  const Description bumps = parsed(
      "Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"c.exr\" \"float scale\" .01\n"
      "Material \"diffuse\" \"texture displacement\" \"h\"");
  EXPECT_EQ(bsdf_of(bumps)->type, "bumpmap");
  EXPECT_EQ(only(*bsdf_of(bumps), "bsdf").type, "twosided");
  const Description normals = parsed("Material \"diffuse\" \"string normalmap\" \"a.png\"");
  EXPECT_TRUE(value<bool>(child(*bsdf_of(normals), "normalmap"), "raw"));
  EXPECT_TRUE(is_missing(parsed("Material \"diffuse\" \"string normalmap\" \"x.png\""), "diffuse",
                         "'x.png' is not there"));
}

}  // namespace
}  // namespace kaustik::pbrt
