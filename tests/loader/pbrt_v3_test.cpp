// Files of pbrt-v3.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/loader/object_parts.h"
#include "kaustik/loader/pbrt/colour_space.h"
#include "kaustik/loader/pbrt/shape_areas.h"
#include "kaustik/loader/pbrt/shapes.h"
#include "kaustik/loader/pbrt/upgrade.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

TEST(PbrtV3, Materials) {
  const auto type_of = [](const std::string& line) {
    const Object bsdf = *material(line);
    return bsdf.type == "twosided" ? only(bsdf, "bsdf").type : bsdf.type;
  };
  const Object matte = one_sided(*material("Material \"matte\" \"color Kd\" [.1 .2 .3]"));
  expect_rgb(value<Rgb>(matte, "reflectance"), .1, .2, .3);
  EXPECT_EQ(type_of("Material \"plastic\" \"color Kd\" [.1 .2 .3]"), "roughplastic");
  EXPECT_EQ(type_of("Material \"substrate\" \"float uroughness\" 0 \"float vroughness\" 0"),
            "roughplastic");
  EXPECT_EQ(type_of("Material \"uber\" \"color Ks\" [0 0 0]"), "diffuse");
  EXPECT_EQ(type_of("Material \"uber\""), "roughplastic");
  EXPECT_EQ(type_of("Material \"metal\""), "roughconductor");
  EXPECT_EQ(type_of("Material \"mirror\""), "conductor");
  EXPECT_EQ(type_of("Material \"translucent\""), "thinphong");
  EXPECT_EQ(type_of("Material \"disney\" \"color color\" [.1 .2 .3]"), "principled");
  EXPECT_EQ(type_of("Material \"kdsubsurface\""), "dielectric");
  const auto glass = material(
      "Material \"glass\" \"float index\" 1.7 \"color Kr\" [1 1 1] "
      "\"color Kt\" [.5 1 1]");
  EXPECT_EQ(value<double>(*glass, "int_ior"), 1.7);
  expect_rgb(value<Rgb>(*glass, "specular_transmittance"), .5, 1, 1);
}

TEST(PbrtV3, MixturesNameTheirFirstMaterialByTheAmount) {
  const auto mix = material(R"(
    MakeNamedMaterial "a" "string type" "matte"
    MakeNamedMaterial "b" "string type" "glass"
    Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "color amount" [.3 .3 .3])");
  EXPECT_NEAR(value<double>(*mix, "weight"), .3, 1e-12);
  EXPECT_EQ(mix->children[1].object->type, "twosided");  // of weight 0.3
}

TEST(PbrtV3, BlackbodiesHaveATemperatureAndAScale) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    LightSource "point" "blackbody I" [6500 100] "rgb scale" [2 2 2]
    AreaLightSource "area" "blackbody L" [3000 7] Shape "sphere"
    AreaLightSource "area" "rgb L" [1 1 1] "rgb scale" [3 3 3] Shape "sphere")");
  // The brightest wavelength has 1, times both. At 6500 K that is 446 nm; at 3000 K it is 966 nm,
  // and of visible light little is left.
  const auto intensity = value<SpectralCurve>(only(scene, "emitter"), "intensity");
  double most = 0;
  for (const auto& [nm, light] : intensity.samples) most = std::max(most, light);
  EXPECT_NEAR(most, 200, .01);
  const auto shapes = objects_of(scene, "shape");
  EXPECT_NEAR(pbrt::luminance(value<SpectralCurve>(only(*shapes[0], "emitter"), "radiance")),
              7 * .42, 7 * .005);
  expect_rgb(value<Rgb>(only(*shapes[1], "emitter"), "radiance"), 3, 3, 3);
  EXPECT_TRUE(scene.deviations.empty());
}

TEST(PbrtV3, SpectraOfLightCountAsTheyAre) {
  const std::string lamps = R"( WorldBegin
    LightSource "point" "spectrum I" [300 10 900 10]
    LightSource "distant" "blackbody L" [6500])";
  const auto luminance_in = [](const Description& scene, size_t i, const char* name) {
    return pbrt::luminance(value<SpectralCurve>(*objects_of(scene, "emitter")[i], name));
  };
  const Description old = parse_scene_of_pbrt("Film \"image\"" + lamps);
  EXPECT_NEAR(luminance_in(old, 0, "intensity"), 10, 1e-9);
  EXPECT_NEAR(luminance_in(old, 1, "irradiance"), 1, 1e-9);  // that v3 does not know
  const Description scene = parse_scene_of_pbrt("Film \"rgb\"" + lamps);
  EXPECT_NEAR(luminance_in(scene, 0, "intensity"), 1, 1e-9);
}

TEST(PbrtV3, RoughnessIsTurnedIntoSlopes) {
  const auto slope = [](const std::string& line) {
    const Object bsdf = *material(line);
    return value<double>(bsdf.type == "twosided" ? only(bsdf, "bsdf") : bsdf, "alpha");
  };
  // RoughnessToAlpha in core/microfacet.h of pbrt-v3, computed by hand.
  EXPECT_NEAR(slope("Material \"metal\""), .1388, 5e-4);
  EXPECT_NEAR(slope("Material \"metal\" \"float roughness\" .1"), .4620, 5e-4);
  EXPECT_NEAR(slope("Material \"plastic\" \"float roughness\" .5"), 1.1310, 2e-3);
  EXPECT_NEAR(slope("Material \"substrate\""), .4620, 5e-4);
  EXPECT_NEAR(slope("Material \"glass\" \"float uroughness\" .1 \"float vroughness\" .1"), .4620,
              5e-4);
  EXPECT_NEAR(slope("Material \"metal\" \"float roughness\" .1 \"bool remaproughness\" false"), .1,
              1e-12);
  EXPECT_EQ(material("Material \"glass\" \"float uroughness\" 0")->type, "dielectric");
  // Not so of v4.
  EXPECT_NEAR(slope("Material \"conductor\" \"float roughness\" .25"), .5, 1e-12);
}

TEST(PbrtV3, MetalsOfFilesThatAreNotThereAreThoseMetals) {
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Material \"metal\" \"spectrum eta\" \"spds/metals/Au.eta.spd\" \"spectrum k\" "
      "\"spds/metals/Au.k.spd\" Shape \"sphere\"");
  EXPECT_EQ(value<std::string>(one_sided(*bsdf_of(scene)), "material"), "au");
  EXPECT_TRUE(is_missing(scene, "material 'metal'", "Au.k.spd': the metal 'au' stands for it"));
}

TEST(PbrtV3, SpotsFallOffByAPowerOfTheCosine) {
  const Description scene = parse_scene_of_pbrt("Film \"image\" WorldBegin LightSource \"spot\"");
  EXPECT_EQ(value<std::string>(only(scene, "emitter"), "falloff"), "square");
  EXPECT_TRUE(is_approximated(scene, "light 'spot'", "less steeply"));
}

TEST(PbrtV3, ProjectedPicturesAreMultipliedByTheirLight) {
  const auto lamp = [](const std::string& parameters, bool is_coloured) {
    const Description scene = parse_scene_of_pbrt(
        "Film \"image\" WorldBegin LightSource \"projection\" \"string mapname\" \"x.exr\" " +
        parameters);
    EXPECT_EQ(is_approximated(scene, "light", "'I' makes its picture brighter"), is_coloured);
    return only(scene, "emitter");
  };
  EXPECT_NEAR(value<double>(lamp("", false), "scale"), 1 / std::numbers::pi, 1e-9);
  EXPECT_EQ(value<double>(lamp("", false), "fov"), 45);
  EXPECT_NEAR(value<double>(lamp("\"rgb I\" [8 8 8]", false), "scale"), 8 / std::numbers::pi, 1e-4);
  EXPECT_NEAR(value<double>(lamp("\"rgb I\" [0 1 0]", true), "scale"), .7152 / std::numbers::pi,
              1e-4);
}

TEST(PbrtV3, TheCameraIsInTheMediumAtTheEndOfTheWorld) {
  const Description scene = parse_scene_of_pbrt(R"(Film "image" Camera "perspective"
    MakeNamedMedium "fog" "string type" "homogeneous"
    MediumInterface "" "fog"
    WorldBegin Shape "sphere" WorldEnd)");
  EXPECT_EQ(only(only(scene, "sensor"), "medium").type, "homogeneous");
}

TEST(PbrtV3, ShuttersChangeNoBrightness) {
  const Description scene = parse_scene_of_pbrt(
      "Film \"image\" Camera \"perspective\" \"float shutterclose\" .25 WorldBegin");
  EXPECT_FALSE(find_property(only(only(scene, "sensor"), "film"), "iso"));
}

TEST(PbrtV3, ShapesThatV4HasNoMore) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Shape "cone" "float radius" 3 "float height" 4
    Shape "paraboloid" "float radius" 1 "float zmax" 2
    Shape "hyperboloid" "point p1" [1 0 0] "point p2" [1 0 2]
    Shape "heightfield" "integer nu" 3 "integer nv" 2 "float Pz" [0 0 0 1 1 1])");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 4u);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(*area_of(*shapes[0]), pi * 3 * 5, .1);  // π r s, of 96 flat sides
  // π r / (6 h²) ((r² + 4 h²)^(3/2) − r³)
  EXPECT_NEAR(*area_of(*shapes[1]), pi / 24 * (std::pow(17, 1.5) - 1), .05);
  EXPECT_NEAR(*area_of(*shapes[2]), 2 * pi * 2, .02);
  EXPECT_NEAR(*area_of(*shapes[3]), std::sqrt(2), 1e-6);
  EXPECT_TRUE(scene.deviations.empty());
  // They face outward: a wall of the hyperboloid that is a cylinder, and the cone.
  for (const size_t i : {0, 2}) EXPECT_GT(numbers_in<float>(*shapes[i], "normals")[0], .5) << i;
  EXPECT_THROW(parse_scene_of_pbrt("WorldBegin Shape \"heightfield\" \"float Pz\" [1]"), Error);
}

TEST(PbrtV3, AWholeScene) {
  const Description scene = parse_scene_of_pbrt(R"(
    LookAt 0 0 5 0 0 0 0 1 0
    Camera "perspective" "float fov" [39]
    Film "image" "integer xresolution" [64] "integer yresolution" [48] "string filename" "a.exr"
      "float scale" 2
    Sampler "02sequence" "integer pixelsamples" [16]
    SurfaceIntegrator "directlighting"
    PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2] "float alpha" [2]
    Accelerator "bvh"
    WorldBegin
    AttributeBegin
      AreaLightSource "area" "color L" [3 3 3] "integer nsamples" [4]
      Shape "disk"
    AttributeEnd
    LightSource "infinite" "color scale" [2 2 2] "color L" [1 1 1]
    Texture "t" "color" "imagemap" "string filename" "x.tga"
    Material "matte" "texture Kd" "t"
    Shape "trianglemesh" "point P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
    WorldEnd)");
  const Object& film = only(only(scene, "sensor"), "film");
  EXPECT_EQ(value<double>(film, "iso"), 200);
  EXPECT_EQ(value<double>(only(film, "rfilter"), "stddev"), .5);  // 1 / √(2 · 2)
  EXPECT_EQ(value<int64_t>(only(only(scene, "sensor"), "sampler"), "sample_count"), 16);
  expect_rgb(value<Rgb>(only(scene, "emitter"), "radiance"), 2, 2, 2);
  EXPECT_EQ(objects_of(scene, "shape").size(), 2u);
  EXPECT_TRUE(is_missing(scene, "'t'", "not there"));
}

// pbrt-v2's own scene of metal has one.
TEST(PbrtOldTextures, NegativeFactorsCountAsPositive) {
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin\nTexture \"tiles\" \"float\" \"checkerboard\"\n"
      "Texture \"s\" \"float\" \"scale\" \"texture tex1\" \"tiles\" \"float tex2\" [-.25]\n"
      "Material \"diffuse\" \"texture displacement\" \"s\"\nShape \"sphere\"\n");
  EXPECT_TRUE(is_approximated(scene, "s", "counts as positive"));
}

}  // namespace
}  // namespace kaustik::pbrt
