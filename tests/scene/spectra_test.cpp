// Spectra that stand as objects where a colour may: their values on lamps and on surfaces.

#include "kaustik/scene/spectrum_types.h"

#include "kaustik/base/spectral_value.h"
#include "tests/scene/scene_support.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

using namespace test;

std::string spectrum(const std::string& type, const std::string& name, const std::string& inside) {
  return "<spectrum type=\"" + type + "\" name=\"" + name + "\">" + inside + "</spectrum>";
}
std::string number(const std::string& name, double value) {
  return "<float name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
}
std::string text(const std::string& name, const std::string& value) {
  return "<string name=\"" + name + "\" value=\"" + value + "\"/>";
}

/// Of a point light that holds this.
Spectrum intensity(const std::string& inside) {
  const auto scene = scene_of(any_camera + std::string(any_shape) + "<emitter type=\"point\">" +
                              inside + "</emitter>");
  return scene->lights().at(0)->emitted({}, {0, 0, 1}, {});
}
/// Of a matt sphere that holds this.
Spectrum albedo(const std::string& inside) {
  const auto scene = scene_of(any_camera +
                              std::string("<shape type=\"sphere\"><bsdf "
                                          "type=\"diffuse\">") +
                              inside + "</bsdf></shape>");
  return scene->surface(0).bsdf->albedo({}, {0, 0, 1}, Lobes::all);
}

void expect_rgb(const Spectrum& found, double r, double g, double b, double tolerance = 1e-5) {
  const double expected[] = {r, g, b};
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(double(found[lane]), expected[lane], tolerance * (std::fabs(expected[lane]) + 1e-6))
        << lane;
}
double luminance(const Spectrum& c) {
  return 0.2126729 * double(c[0]) + 0.7151522 * double(c[1]) + 0.0721750 * double(c[2]);
}

TEST(Spectra, NamesOfAllTypes) {
  test::expect_rows_of("texture", spectrum_types());
  for (const SpectrumType& type : spectrum_types())
    for (const TextureType& texture : texture_types()) EXPECT_NE(type.info.name, texture.info.name);
}

/// The candela was once defined by platinum that freezes, at 2041.4 K: 60 cd/cm². A watt at 555 nm
/// is 683 lm, and the eye's sensitivity over all wavelengths sums up to 106.857 nm.
TEST(Spectra, ABlackBodyAtThePlatinumPointHasSixtyCandelasPerSquareCentimetre) {
  const Spectrum c = intensity(spectrum("blackbody", "intensity", number("temperature", 2041.4)));
  const double candelas_per_cm2 = luminance(c) * 106.857 * 683 * 1e-4;
  RecordProperty("candelas_per_cm2", std::to_string(candelas_per_cm2));
  EXPECT_NEAR(candelas_per_cm2, 60, 0.6);
  // Twice as much, and nothing where nobody sees it.
  expect_rgb(intensity(spectrum("blackbody", "intensity",
                                number("temperature", 2041.4) + number("scale", 2))),
             2 * double(c[0]), 2 * double(c[1]), 2 * double(c[2]));
  EXPECT_TRUE(intensity(spectrum("blackbody", "intensity",
                                 number("temperature", 2000) + number("wavelength_min", 900) +
                                     number("wavelength_max", 2000)))
                  .is_zero());
}

/// Chromaticities of Wyszecki and Stiles, Color Science, table 1(3.11).
TEST(Spectra, ABlackBodyHasItsColour) {
  const Spectrum c = intensity(spectrum("blackbody", "intensity", number("temperature", 5000)));
  const double r = double(c[0]), g = double(c[1]), b = double(c[2]);
  const double x = 0.4124564 * r + 0.3575761 * g + 0.1804375 * b, y = luminance(c),
               z = 0.0193339 * r + 0.1191920 * g + 0.9503041 * b;
  EXPECT_NEAR(x / (x + y + z), 0.3451, 2e-4);
  EXPECT_NEAR(y / (x + y + z), 0.3516, 2e-4);
  // Planck's law for 5000 K at 555 nm, where the eye sees most, is 12740 W/(sr·m²·nm).
  EXPECT_NEAR(y, 12740, 200);
}

/// Of a range what lies in it is left, and nothing else.
TEST(Spectra, ABlackBodyMayBeCut) {
  const Wavelengths four(440, 555, 600, 700);
  const auto part = [&](double low, double high) {
    const auto scene =
        scene_of(any_camera + std::string(any_shape) + "<emitter type=\"point\">" +
                 spectrum("blackbody", "intensity",
                          number("temperature", 4000) + number("wavelength_min", low) +
                              number("wavelength_max", high)) +
                 "</emitter>");
    return scene->lights().at(0)->emitted({}, {0, 0, 1}, four);
  };
  const Spectrum blue = part(360, 555.5), red = part(555.5, 830);
  for (int lane = 0; lane < 4; ++lane) {
    const auto planck = float(blackbody(4000)->at(double(four[lane])));
    EXPECT_NEAR(blue[lane], lane < 2 ? planck : 0, 1e-5f * planck) << lane;
    EXPECT_NEAR(red[lane], lane < 2 ? 0 : planck, 1e-5f * planck) << lane;
  }
}

TEST(Spectra, LightOfEachType) {
  expect_rgb(intensity(spectrum("uniform", "intensity", number("value", 3))), 3, 3, 3);
  expect_rgb(intensity("<spectrum name=\"intensity\" value=\"2\"/>"), 2 * 1.2048, 2 * 0.9484,
             2 * 0.9087, 1e-3);
  expect_rgb(intensity("<float name=\"intensity\" value=\"2\"/>"), 2, 2, 2);
  expect_rgb(intensity(spectrum("d65", "intensity", "")), 1, 1, 1);
  expect_rgb(intensity(spectrum("d65", "", number("scale", 4))), 4, 4, 4);
  expect_rgb(intensity(spectrum("d65", "intensity",
                                number("scale", 2) + "<rgb name=\"color\" value=\"0.2 0.4 3\"/>")),
             0.4, 0.8, 6);
  expect_rgb(intensity(spectrum("srgb", "intensity", "<rgb name=\"color\" value=\"1 2 3\"/>")), 1,
             2, 3);
  expect_rgb(intensity(spectrum("rawconstant", "intensity", number("value", 7))), 7, 7, 7);
  expect_rgb(
      intensity(spectrum("rawconstant", "intensity", "<vector name=\"value\" value=\"1, 2, 3\"/>")),
      1, 2, 3);
}

/// A curve is the same in all its spellings, and light is zero beyond its ends.
TEST(Spectra, CurvesOfLight) {
  const Spectrum curve =
      intensity("<spectrum name=\"intensity\" value=\"400:1, 500:3, 600:2, 700:2\"/>");
  const double rgb[] = {double(curve[0]), double(curve[1]), double(curve[2])};
  expect_rgb(
      intensity(spectrum("irregular", "intensity",
                         text("wavelengths", "400, 500, 600, 700") + text("values", "1 3 2 2"))),
      rgb[0], rgb[1], rgb[2]);
  expect_rgb(intensity(spectrum("regular", "intensity",
                                number("wavelength_min", 400) + number("wavelength_max", 700) +
                                    text("values", "1, 3, 2, 2"))),
             rgb[0], rgb[1], rgb[2]);
  expect_rgb(intensity("<spectrum name=\"intensity\" value=\"399:0, 400:1, 500:3, 600:2, 700:2, "
                       "701:0\"/>"),
             rgb[0], rgb[1], rgb[2]);
  // Under daylight a curve that is 1 everywhere is daylight.
  const std::string one = spectrum(
      "regular", "share",
      number("wavelength_min", 360) + number("wavelength_max", 830) + text("values", "1, 1"));
  expect_rgb(intensity(spectrum("d65", "intensity", one + number("scale", 3))), 3, 3, 3, 1e-3);
}

TEST(Spectra, ReflectancesOfEachType) {
  expect_rgb(albedo(spectrum("uniform", "reflectance", number("value", 0.3))), 0.3, 0.3, 0.3);
  expect_rgb(albedo("<spectrum name=\"reflectance\" value=\"0.3\"/>"), 0.3, 0.3, 0.3);
  expect_rgb(albedo(spectrum("srgb", "reflectance", "<rgb name=\"color\" value=\".1 .2 .3\"/>")),
             0.1, 0.2, 0.3);
  expect_rgb(albedo(spectrum("rawconstant", "reflectance",
                             "<vector name=\"value\" value=\".1, .2, .3\"/>")),
             0.1, 0.2, 0.3);
  // Seen under daylight a constant curve is grey …
  const auto regular = [](double low, double high) {
    return albedo(spectrum("regular", "reflectance",
                           number("wavelength_min", low) + number("wavelength_max", high) +
                               text("values", "0.4, 0.4")));
  };
  expect_rgb(regular(360, 830), 0.4, 0.4, 0.4);
  // … but what it does not reach is black.
  EXPECT_LT(regular(360, 600)[0], 0.2f);
  EXPECT_NEAR(regular(360, 600)[2], 0.4f, 0.02f);
}

TEST(Spectra, MayBeShared) {
  const std::string hot =
      "<spectrum type=\"blackbody\" id=\"hot\">" + number("temperature", 3000) + "</spectrum>";
  const Spectrum shared = [&] {
    const auto scene = scene_of(hot + any_camera + any_shape +
                                "<emitter type=\"point\"><ref id=\"hot\" name=\"intensity\"/>"
                                "</emitter>");
    return scene->lights().at(0)->emitted({}, {0, 0, 1}, {});
  }();
  EXPECT_EQ(shared, intensity(spectrum("blackbody", "intensity", number("temperature", 3000))));
}

/// Light of the colours of a texture.
TEST(Spectra, DaylightMayHoldATexture) {
  const std::string checkerboard =
      R"(<texture name="radiance" type="checkerboard"><rgb name="color0" value="0.9"/>
         <rgb name="color1" value="0.1"/></texture>)";
  const auto power = [](const std::string& inside) {
    const auto scene = scene_of(any_camera +
                                std::string("<shape type=\"rectangle\"><emitter "
                                            "type=\"area\">") +
                                inside + "</emitter></shape>");
    return scene->lights().at(0)->traits().power;
  };
  EXPECT_EQ(power(spectrum("d65", "radiance", checkerboard)), power(checkerboard));
}

TEST(Spectra, StandForNumbersToo) {
  const auto scene =
      scene_of(any_camera +
               std::string("<shape type=\"sphere\"><bsdf "
                           "type=\"roughconductor\">") +
               spectrum("rawconstant", "alpha", number("value", 0.4)) + "</bsdf></shape>");
  EXPECT_NE(scene, nullptr);
}

TEST(Spectra, WhatIsWrong) {
  const std::string begin = any_camera + std::string(any_shape) + "<emitter type=\"point\">\n";
  const auto expect = [&](const std::string& type, const std::string& inside,
                          const std::string& place, const std::string& message) {
    expect_problem(begin + spectrum(type, "intensity", inside) + "</emitter>", place, message);
  };
  expect("blackbody", "", "3:1", "temperature");
  expect("blackbody", number("temperature", -1), "3:45", "outside its range");
  expect(
      "blackbody",
      number("temperature", 3000) + number("wavelength_min", 700) + number("wavelength_max", 600),
      "3:141", "not above");
  expect("irregular", text("wavelengths", "400, 500") + text("values", "1"), "3:90", "fewer");
  expect("irregular", text("wavelengths", "400, 500, 600") + text("values", "1, 2"), "3:95",
         "2 values at 3");
  expect("irregular", text("wavelengths", "500, 400") + text("values", "1, 2"), "3:45",
         "400 follows 500");
  expect("irregular", text("wavelengths", "-5, 400") + text("values", "1, 2"), "3:45",
         "not positive");
  expect("irregular", text("wavelengths", "400, nan") + text("values", "1, 2"), "3:45",
         "no finite number");
  expect("uniform", "<texture name=\"x\" type=\"checkerboard\"/>" + number("value", 1), "3:43",
         "cannot hold a texture");
  // What holds it sees that light is never negative.
  expect("uniform", number("value", -2), "3:1", "'intensity' is -2");
  expect_problem(begin + spectrum("uniform", "intensity", number("value", 1)) +
                     spectrum("uniform", "intensity", number("value", 1)) + "</emitter>",
                 "3:92", "given twice");
  expect_problem(begin + spectrum("blakbody", "intensity", "") + "</emitter>", "3:1",
                 "unknown texture type 'blakbody'");
}

/// Each holds the one before twice: looked at once each.
TEST(Spectra, NestedManyTimesAreLookedAtOnce) {
  auto inner = std::make_shared<Object>(Object{"texture", "d65", "", {}, {}, {}});
  for (int i = 0; i < 60; ++i)
    inner = std::make_shared<Object>(
        Object{"texture", "d65", "", {}, {{"a", inner}, {"b", inner}}, {}});
  const Description description = description_of(any_camera + std::string(any_shape));
  description.scene->children.push_back({"", inner});
  EXPECT_THROW(build_scene(description), Error);
}

}  // namespace
}  // namespace kaustik
