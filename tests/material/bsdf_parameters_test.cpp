#include <gtest/gtest.h>

#include "kaustik/base/color.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

std::string message_of(const std::string& type, const std::vector<Property>& properties,
                       std::vector<std::shared_ptr<const Bsdf>> nested = {}) {
  try {
    make_bsdf(type, properties, std::move(nested));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

Property at(const std::string& name, Value value, int line) {
  return {name, std::move(value), place_in("scene.xml", line, 7)};
}

TEST(bsdf_parameters, unknown_name) {
  EXPECT_EQ(message_of("diffuse", {at("reflectnce", 0.5, 4)}),
            "scene.xml:4:7: bsdf 'diffuse' has no parameter 'reflectnce'\n"
            "  remedy: did you mean 'reflectance'? Valid: reflectance");
}

TEST(bsdf_parameters, out_of_range) {
  EXPECT_EQ(message_of("diffuse", {at("reflectance", Rgb{0.5, 1.2, 0}, 4)}),
            "scene.xml:4:7: 'reflectance' is 1.2, outside its range\n"
            "  remedy: give a value from 0 to 1");
  EXPECT_EQ(message_of("roughconductor", {at("alpha", -0.5, 4)}),
            "scene.xml:4:7: 'alpha' is -0.5, outside its range\n"
            "  remedy: give a value from 0 to 10");
}

TEST(bsdf_parameters, unknown_material) {
  const std::string text = message_of("dielectric", {at("int_ior", std::string("watr"), 4)});
  EXPECT_EQ(text.substr(0, text.find("Valid")),
            "scene.xml:4:7: 'int_ior' cannot be 'watr'\n  remedy: did you mean 'water'? ");
  const std::string of_metal = message_of("conductor", {at("material", std::string("Auu"), 4)});
  EXPECT_EQ(of_metal.substr(0, of_metal.find("alas")),
            "scene.xml:4:7: 'material' cannot be 'auu'\n"
            "  remedy: did you mean 'au'? Valid: none, ag, al, ");
}

TEST(bsdf_parameters, phong_that_reflects_more_than_arrives) {
  EXPECT_EQ(message_of("phong", {at("diffuse_reflectance", 0.7, 4),
                                 at("specular_reflectance", Rgb{0.1, 0.5, 0.1}, 5)}),
            "scene.xml:4:7: 'diffuse_reflectance' and 'specular_reflectance' add up to 1.2, more "
            "light than arrives\n  remedy: make their sum at most 1 in every channel");
  EXPECT_EQ(message_of("phong", {at("diffuse_reflectance", Rgb{1, 0, 0}, 4),
                                 at("specular_reflectance", Rgb{0, 1, 0.5}, 5)}),
            "no error");
}

TEST(bsdf_parameters, conductor_that_contradicts_itself) {
  EXPECT_EQ(message_of("conductor", {at("material", std::string("Au"), 4), at("eta", 1.2, 5)}),
            "scene.xml:4:7: 'material' is given together with 'eta' or 'k'\n"
            "  remedy: keep the material or both of 'eta' and 'k'");
  EXPECT_EQ(message_of("conductor", {at("k", 1.2, 5)}),
            "scene.xml:5:7: 'k' is given without 'eta'\n  remedy: give both or neither");
  EXPECT_EQ(message_of("conductor", {at("eta", Rgb{0, 1, 1}, 5), at("k", Rgb{0, 1, 1}, 6)}),
            "scene.xml:5:7: 'eta' and 'k' are both 0 in one channel\n"
            "  remedy: use material 'none' for a perfect mirror");
}

TEST(bsdf_parameters, metal_that_is_given_twice) {
  EXPECT_EQ(
      message_of("conductor", {at("reflectance", 0.8, 4), at("material", std::string("Au"), 5)}),
      "scene.xml:4:7: 'reflectance' is given together with 'material', 'eta', 'k' or "
      "'ext_eta'\n  remedy: keep the reflectance or the others");
  EXPECT_EQ(message_of("roughconductor", {at("edge_tint", 0.8, 4)}),
            "scene.xml:4:7: 'edge_tint' is given without 'reflectance'\n"
            "  remedy: give both, or reflectance alone");
}

// Mitsuba 0.6 divides by the index of the surroundings.
TEST(bsdf_parameters, conductor_under_water) {
  const auto wet = make_bsdf("conductor", {property("eta", 1.333), property("k", 2.666),
                                           property("ext_eta", std::string("water"))});
  EXPECT_NEAR(wet->albedo({}, {0, 0, 1}, Lobes::all)[1], 4.0 / (4 + 4), 1e-4);
}

TEST(bsdf_parameters, types_to_come_have_a_remedy) {
  for (const char* type : {"hair", "measured", "bsdfdata", "polarizer"})
    EXPECT_FALSE(remedy_for_bsdf_to_come(type).empty()) << type;
  EXPECT_TRUE(remedy_for_bsdf_to_come("difuse").empty());
  for (const BsdfType& type : bsdf_types())
    EXPECT_TRUE(remedy_for_bsdf_to_come(type.info.name).empty()) << type.info.name;
}

TEST(bsdf_parameters, roughness_that_contradicts_itself) {
  EXPECT_EQ(message_of("roughconductor", {at("alpha", 0.2, 4), at("alpha_u", 0.2, 5)}),
            "scene.xml:4:7: 'alpha' is given together with 'alpha_u' or 'alpha_v'\n"
            "  remedy: keep alpha or both of the others");
  EXPECT_EQ(message_of("roughconductor", {at("alpha_v", 0.2, 5)}),
            "scene.xml:5:7: 'alpha_v' is given without 'alpha_u'\n"
            "  remedy: give both, or alpha alone");
}

TEST(bsdf_parameters, twosided_glass) {
  EXPECT_EQ(message_of("twosided", {}, {make_bsdf("dielectric")}),
            "scene.xml:3:5: bsdf 'twosided' holds one that transmits light\n"
            "  remedy: use that one without 'twosided'; it has two sides already");
}

TEST(bsdf_parameters, coating_over_glass) {
  const auto glass = make_bsdf("dielectric");
  EXPECT_EQ(make_bsdf("coating", {}, {glass}), glass);
}

TEST(bsdf_parameters, spectra_become_colours) {
  const SpectralCurve curve{{{400, 0.1}, {700, 0.8}}};
  const auto bsdf = make_bsdf("diffuse", {property("reflectance", curve)});
  const Rgb c = rgb_from_reflectance(curve);
  EXPECT_EQ(bsdf->albedo({}, {0, 0, 1}, Lobes::all),
            Spectrum(float(c.r), float(c.g), float(c.b), 0));
  const auto metal =
      make_bsdf("conductor", {property("eta", SpectralCurve{{{550, 0.4}}}), property("k", 3.0)});
  const double r = (0.36 + 9) / (1.96 + 9);
  EXPECT_NEAR(metal->albedo({}, {0, 0, 1}, Lobes::all)[1], r, 1e-4);
}

// Two textures whose largest values add up to 1.5 are scaled together.
TEST(bsdf_parameters, phong_scales_textures_that_reflect_too_much) {
  class Ramp final : public Texture {
   public:
    Spectrum eval(const TextureCoordinates& c, const Wavelengths&) const override {
      return Spectrum(c.uv.x, c.uv.x, c.uv.x, 0);
    }
    float maximum() const override { return 1; }
    Spectrum mean() const override { return Spectrum(0.5f, 0.5f, 0.5f, 0); }
    HeightGradient height_gradient(const TextureCoordinates&) const override { return {}; }
  };
  for (const BsdfType& type : bsdf_types()) {
    if (type.info.name != "phong") continue;
    Problems problems;
    const Arguments arguments(type.info, {}, {}, problems);
    const auto texture = [](std::string_view name) -> std::shared_ptr<const Texture> {
      if (name == "diffuse_reflectance") return std::make_shared<Ramp>();
      return make_constant_texture(SpectralValue::reflectance(Rgb{0.5, 0.5, 0.5}));
    };
    const auto bsdf = type.create({arguments, {}, texture});
    BsdfContext right;
    right.move_to({.uv = {1, 0}}, {});
    EXPECT_NEAR(bsdf->albedo(right, {0, 0, 1}, Lobes::diffuse)[0], 1 / 1.5f, 1e-6f);
    const BsdfContext left;
    EXPECT_EQ(bsdf->albedo(left, {0, 0, 1}, Lobes::diffuse)[0], 0);
  }
}

}  // namespace
}  // namespace kaustik
