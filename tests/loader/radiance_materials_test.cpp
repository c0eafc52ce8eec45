// Materials of Radiance: closed forms of what they reflect and transmit.
#include "radiance_support.h"

namespace kaustik::radiance_test {
namespace {

const Object& bsdf_in(const Description& description) {
  return front_bsdf(sole_object(description, "shape"));
}

TEST(RadianceMaterials, RoughPlasticAndMetalAreWards) {
  const auto plastic = with_material("void plastic m 0 0 5 .5 .4 .2 .05 .1");
  EXPECT_EQ(bsdf_in(plastic).type, "ward");
  EXPECT_EQ(nested(sole_object(plastic, "shape"), "bsdf").type, "twosided");
  expect_colour(bsdf_in(plastic), "diffuse_reflectance", .475, .38, .19);
  expect_colour(bsdf_in(plastic), "specular_reflectance", .05, .05, .05);
  EXPECT_EQ(value<double>(bsdf_in(plastic), "alpha_u"), .1);
  const auto metal = with_material("void metal m 0 0 5 .5 .4 .2 .9 .1");
  expect_colour(bsdf_in(metal), "diffuse_reflectance", .05, .04, .02);
  expect_colour(bsdf_in(metal), "specular_reflectance", .45, .36, .18);
  EXPECT_EQ(deviations_but_view(plastic) + deviations_but_view(metal), 0u);
}

TEST(RadianceMaterials, SmoothPlasticIsCoated) {
  const auto scene = with_material("void plastic m 0 0 5 .5 .5 .5 .05 0");
  const Object& bsdf = bsdf_in(scene);
  EXPECT_EQ(bsdf.type, "plastic");
  const double n = *number_in(bsdf, "int_ior");
  EXPECT_NEAR(std::pow((n - 1) / (n + 1), 2), .05, 1e-9);
  // What the base throws back of what enters: ρ (1 − F) / (1 − ρ F), F by its integral.
  double outer = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double c = (i + 0.5) / 100'000, t = std::sqrt(1 - (1 - c * c) / (n * n));
    const double s = (c - n * t) / (c + n * t), p = (t - n * c) / (t + n * c);
    outer += (s * s + p * p) * c / 100'000;
  }
  const double inner = 1 - (1 - outer) / (n * n), base = colour_in(bsdf, "diffuse_reflectance")->r;
  EXPECT_NEAR(base * (1 - inner) / (1 - base * inner), .5, 1e-3);
}

TEST(RadianceMaterials, PlasticWithoutHighlightIsMatt) {
  EXPECT_EQ(bsdf_in(with_material("void plastic m 0 0 5 .5 .5 .5 0 .2")).type, "diffuse");
}

TEST(RadianceMaterials, GlassByTransmissivity) {
  // That of common glass: 0.96 for a transmittance of 88 %.
  const auto scene = with_material("void glass m 0 0 3 .96 .96 .96");
  const Object& pane = bsdf_in(scene);
  EXPECT_EQ(pane.type, "thindielectric");
  const double r = std::pow(.52 / 2.52, 2);
  const double clear_t = (1 - r) / (1 + r), clear_r = 2 * r / (1 + r);
  EXPECT_NEAR(colour_in(pane, "specular_transmittance")->g * clear_t, .88, .002);
  const double t = .96;
  EXPECT_NEAR(colour_in(pane, "specular_reflectance")->g * clear_r,
              r * (1 + (1 - 2 * r) * t * t) / (1 - r * r * t * t), 1e-9);
  EXPECT_EQ(deviations_but_view(scene), 0u);
}

TEST(RadianceMaterials, TransBySharesOfItsLight) {
  const auto scene = with_material("void trans m 0 0 7 .8 .6 .4 .1 .05 .5 .25");
  const Object& mixture = bsdf_in(scene);
  EXPECT_EQ(mixture.type, "mixturebsdf");
  std::vector<double> weights;
  for (std::string text = value<std::string>(mixture, "weights"); !text.empty();) {
    weights.push_back(std::stod(text));
    const size_t comma = text.find(',');
    text = comma == std::string::npos ? "" : text.substr(comma + 1);
  }
  ASSERT_EQ(weights.size(), 3u);
  const Object &sheet = *mixture.children[0].object, &through = *mixture.children[2].object;
  // Of the largest channel: C (1 − s) (1 − t), C (1 − s) t (1 − ts), C (1 − s) t ts.
  EXPECT_NEAR(weights[0] * colour_in(sheet, "diffuse_reflectance")->r, .8 * .9 * .5, 1e-9);
  EXPECT_NEAR(weights[0] * colour_in(sheet, "diffuse_transmittance")->b, .4 * .9 * .5 * .75, 1e-9);
  EXPECT_NEAR(weights[1], .1, 1e-9);
  EXPECT_NEAR(weights[2] * colour_in(through, "specular_transmittance")->g, .6 * .9 * .5 * .25,
              1e-9);
  EXPECT_NEAR(*number_in(through, "exponent"), 2 / (.05 * .05), 1e-6);
}

TEST(RadianceMaterials, DielectricsAbsorbPerLength) {
  const auto scene = with_material("void dielectric m 0 0 5 .5 .25 1 1.33 0");
  const Object& shape = sole_object(scene, "shape");
  EXPECT_EQ(*number_in(front_bsdf(shape), "int_ior"), 1.33);
  expect_colour(nested(shape, "medium", "interior"), "sigma_a", std::log(2), std::log(4), 0);
  // In a space that is twice as large it absorbs half as much per metre.
  TemporaryFolder folder;
  folder.write("g.rad", "void dielectric m 0 0 5 .5 .25 1 1.33 0\nm sphere s 0 0 4 0 0 0 1\n");
  const auto large = load_radiance(folder.write("a.rad", "!xform -s 2 g.rad\n"));
  expect_colour(nested(sole_object(large, "shape"), "medium", "interior"), "sigma_a",
                std::log(2) / 2, std::log(4) / 2, 0);
  EXPECT_THROW(
      nested(sole_object(with_material("void dielectric m 0 0 5 1 1 1 1.5 0"), "shape"), "medium"),
      std::runtime_error);
}

TEST(RadianceMaterials, LampsShineInFront) {
  const auto scene = with_material("void light m 0 0 3 10 20 30");
  const Object& lamp = sole_object(scene, "shape");
  expect_colour(nested(lamp, "emitter"), "radiance", 10, 20, 30);
  EXPECT_FALSE(find_property(nested(lamp, "emitter"), "two_sided"));
  expect_colour(front_bsdf(lamp), "reflectance", 0, 0, 0);
  EXPECT_TRUE(tells(with_material("void glow m 0 0 4 1 1 1 -1"), DeviationKind::approximated,
                    "glow 'm'", "lights the scene"));
  EXPECT_EQ(deviations_but_view(with_material("void glow m 0 0 4 1 1 1 0")), 0u);
}

TEST(RadianceMaterials, SpotlightsHaveHardEdges) {
  const auto scene = with_material("void spotlight m 0 0 7 100 100 100 40 0 0 1");
  const Object& spot = sole_object(scene, "emitter");
  EXPECT_EQ(spot.type, "spot");
  expect_colour(spot, "intensity", 100, 100, 100);  // of one square metre
  EXPECT_EQ(*number_in(spot, "cutoff_angle"), 20);
  EXPECT_EQ(value<std::string>(spot, "falloff"), "none");
  EXPECT_TRUE(tells(scene, DeviationKind::approximated, "spotlight 'm'", "a point"));
}

TEST(RadianceMaterials, IllumsDoNotLightTwice) {
  const auto window =
      with_material("void glass pane 0 0 3 .9 .9 .9\nvoid illum m 1 pane 0 3 5 5 5");
  EXPECT_EQ(bsdf_in(window).type, "thindielectric");
  EXPECT_TRUE(tells(window, DeviationKind::approximated, "illum 'm'", "does not shine"));
  const auto lamp = with_material("void illum m 0 0 3 5 5 5");
  EXPECT_FALSE(value<bool>(nested(sole_object(lamp, "shape"), "emitter"), "visible"));
  EXPECT_EQ(bsdf_in(lamp).type, "null");
}

TEST(RadianceMaterials, MirrorsAndMist) {
  const auto mirror = with_material("void mirror m 0 0 3 .9 .8 .7");
  EXPECT_EQ(bsdf_in(mirror).type, "conductor");
  expect_colour(bsdf_in(mirror), "specular_reflectance", .9, .8, .7);
  const auto mist = with_material("void mist m 0 0 7 .1 .2 .3 .9 .9 .9 .6");
  const Object& medium = nested(sole_object(mist, "shape"), "medium", "interior");
  expect_colour(medium, "sigma_t", .1, .2, .3);
  EXPECT_EQ(*number_in(nested(medium, "phase"), "g"), .6);
}

TEST(RadianceMaterials, LongHighlightsLieAlongTheirTangent) {
  const auto scene = with_material("void metal2 m 4 0 1 0 . 0 6 .9 .9 .9 1 .2 .05");
  const Object& shape = sole_object(scene, "shape");
  EXPECT_EQ(*number_in(front_bsdf(shape), "alpha_u"), .2);
  const auto positions = rad_numbers(shape, "positions"), uvs = rad_numbers(shape, "uv");
  for (size_t i = 0; i < uvs.size() / 2; ++i)
    EXPECT_NEAR(uvs[2 * i] - uvs[0], positions[3 * i + 1] - positions[1], 1e-6);
}

TEST(RadianceMaterials, MixturesBlend) {
  const std::string two = "void plastic a 0 0 5 .1 .1 .1 0 0\nvoid plastic b 0 0 5 .9 .9 .9 0 0\n";
  const auto scene = with_material(two + "void mixfunc m 4 a b .25 . 0 0");
  const Object& blend = bsdf_in(scene);
  EXPECT_EQ(blend.type, "blendbsdf");
  EXPECT_EQ(*number_in(blend, "weight"), .25);
  expect_colour(nested(*blend.children[1].object, "bsdf"), "reflectance", .1, .1, .1);
  const auto hole = with_material(two + "void mixfunc m 4 a void A1 . 0 1 .75");
  EXPECT_EQ(bsdf_in(hole).type, "mask");
  EXPECT_NEAR(*number_in(bsdf_in(hole), "opacity"), .75, 1e-9);
}

// A layer that sends on 40 % of light from anywhere evenly: its density is 0.4 / π everywhere.
TEST(RadianceMaterials, MeasuredLayersBySharesOfEvenLight) {
  TemporaryFolder folder;
  std::string numbers;
  for (int i = 0; i < 145 * 145; ++i) numbers += std::to_string(.4 / pi_d) + ", ";
  folder.write("sample.xml",
               "<WindowElement><Optical><Layer><WavelengthData><Wavelength>Visible</Wavelength>"
               "<WavelengthDataBlock><WavelengthDataDirection>Transmission Front"
               "</WavelengthDataDirection><ScatteringData>" +
                   numbers +
                   "</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical>"
                   "</WindowElement>");
  const auto scene = load_radiance(folder.write(
      "a.rad", "void BSDF m 6 0 sample.xml 0 0 1 . 0 0\nm polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n"));
  const Object& bsdf = front_bsdf(sole_object(scene, "shape"));
  EXPECT_NEAR(colour_in(bsdf, "diffuse_transmittance")->g, .4, 1e-4);
  expect_colour(bsdf, "diffuse_reflectance", 0, 0, 0);
  EXPECT_TRUE(tells(scene, DeviationKind::approximated, "BSDF 'm'", "evenly"));
}

TEST(RadianceMaterials, UnknownOnesAreTold) {
  for (const char* type : {"BSDF", "plasfunc", "ashik2", "prism1", "WGMDfunc", "antimatter"}) {
    const auto scene =
        with_material(std::string("void ") + type + " m 4 a b c d 0 8 .5 .5 .5 .1 .1 .1 1 1");
    EXPECT_GE(deviations_but_view(scene), 1u) << type;
  }
}

}  // namespace
}  // namespace kaustik::radiance_test
