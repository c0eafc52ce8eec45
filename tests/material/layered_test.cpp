// Closed forms of sheets, of Ward's highlight, of mixtures and of layered surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/material/cloth_fuzz.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/relief.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

Vec3f tilted(double degrees, float side = 1) {
  const double theta = degrees * std::numbers::pi / 180;
  return {float(std::sin(theta)), 0, side * float(std::cos(theta))};
}

// ---- sheets ----

TEST(principledthin, lets_half_of_what_is_matt_through) {
  // Without roughness and flatness what comes back is Burley's base, what goes on is Lambert's.
  const auto paper = make_bsdf(
      "principledthin", {property("base_color", Rgb{0.8, 0.4, 0.2}), property("diff_trans", 1.0)});
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f wo = tilted(30, side), on = tilted(-50, -side);
    EXPECT_NEAR(paper->eval(radiance(), wo, on, Lobes::all)[0], 0.5 * 0.8 * inv_pi, 1e-6);
    EXPECT_NEAR(paper->eval(radiance(), wo, on, Lobes::all)[2], 0.5 * 0.2 * inv_pi, 1e-6);
  }
  EXPECT_FALSE(make_bsdf("principledthin")->traits().transmits);
}

/// One side reflects 0.04: as in Mitsuba the other one is left out. What passes smooth glass is no
/// event.
TEST(principledthin, is_a_pane_where_it_is_glassy) {
  for (const bool is_smooth : {true, false}) {
    const auto pane =
        make_bsdf("principledthin",
                  {property("base_color", Rgb{0.9, 0.5, 0.2}), property("eta", 1.5),
                   property("spec_trans", 1.0), property("roughness", is_smooth ? 0.02 : 0.06)});
    EXPECT_EQ(pane->traits().passes_straight, is_smooth);
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = tilted(1, side);
      RunningStatistics back, on;
      int astray = 0;
      for (uint32_t i = 0; i < 4096; ++i) {
        Sampler sampler(5, i);
        const float u_lobe = sampler.next_1d();
        const BsdfSample s = pane->sample(radiance(), wo, u_lobe, sampler.next_2d(), Lobes::all);
        back.add(s.transmission ? 0 : double(s.weight[1]));
        on.add(s.transmission ? double(s.weight[1]) : 0);
        if (!s.transmission) continue;
        astray += length(s.wi + wo) > 0.05f;
        ASSERT_EQ(s.eta, 1);
      }
      EXPECT_LT(astray, 40);  // by GGX's long tail
      EXPECT_NEAR(back.mean(), 0.04, 0.003);
      EXPECT_NEAR(on.mean(), is_smooth ? 0 : 0.96 * 0.5, 0.005);
      EXPECT_NEAR(pane->straight(radiance(), wo)[1], is_smooth ? 0.96 * 0.5 : 0, 1e-4);
    }
  }
}

// ---- Ward ----

TEST(ward, has_its_height_at_the_normal_whatever_its_variant) {
  const Vec3f up(0, 0, 1);
  for (const char* variant : {"balanced", "ward", "ward-duer"}) {
    const auto bsdf = make_bsdf(
        "ward", {property("variant", variant), property("alpha_u", 0.1), property("alpha_v", 0.3),
                 property("specular_reflectance", 0.4), property("diffuse_reflectance", 0.0)});
    EXPECT_NEAR(bsdf->eval(radiance(), up, up, Lobes::all)[0],
                0.4 / (4 * std::numbers::pi * 0.1 * 0.3), 1e-3)
        << variant;
  }
}

// Ward 1992, equation 5b, where it reflects less than arrives.
TEST(ward, is_as_published) {
  const double alpha = 0.2;
  const auto bsdf = make_bsdf(
      "ward", {property("variant", "ward"), property("alpha_u", alpha), property("alpha_v", alpha),
               property("specular_reflectance", 1.0), property("diffuse_reflectance", 0.0)});
  const Vec3f wo = tilted(40), wi = tilted(-30);
  const double delta = 5 * std::numbers::pi / 180;  // of the normal between both
  const double expected = std::exp(-std::pow(std::tan(delta) / alpha, 2)) /
                          (4 * std::numbers::pi * alpha * alpha * std::sqrt(double(wo.z * wi.z)));
  EXPECT_NEAR(bsdf->eval(radiance(), wo, wi, Lobes::all)[0], expected, 1e-4 * expected);
}

TEST(ward, weights_of_samples_are_bounded) {
  for (const char* variant : {"balanced", "ward", "ward-duer"})
    for (const double alpha : {0.01, 0.2, 1.0}) {
      const auto bsdf =
          make_bsdf("ward", {property("variant", variant), property("alpha_u", alpha),
                             property("alpha_v", alpha), property("specular_reflectance", 1.0),
                             property("diffuse_reflectance", 0.0)});
      for (const double degrees : {0.0, 60.0, 85.0, 89.9})
        for (uint32_t i = 0; i < 512; ++i) {
          Sampler sampler(7, i);
          const BsdfSample s =
              bsdf->sample(radiance(), tilted(degrees), 0.5f, sampler.next_2d(), Lobes::all);
          ASSERT_LE(s.weight.max_lane(), 2.01f) << variant << " " << alpha << " " << degrees;
        }
    }
}

// ---- mixtures ----

TEST(mixturebsdf, absorbs_what_weights_lack_of_one) {
  const auto white = make_bsdf("diffuse", {property("reflectance", 1.0)}),
             grey = make_bsdf("diffuse", {property("reflectance", 0.5)});
  const auto of = [&](const std::string& weights) {
    return make_bsdf("mixturebsdf", {property("weights", weights)}, {white, grey});
  };
  const Vec3f up(0, 0, 1);
  EXPECT_NEAR(of("0.5, 0.2")->albedo(radiance(), up, Lobes::all)[0], 0.6, 1e-6);
  EXPECT_NEAR(of("0.5 0.5")->albedo(radiance(), up, Lobes::all)[0], 0.75, 1e-6);
  EXPECT_NEAR(of("0, 0.5")->albedo(radiance(), up, Lobes::all)[0], 0.25, 1e-6);
  EXPECT_NEAR(of("1.5, 0.5")->albedo(radiance(), up, Lobes::all)[0], 0.875, 1e-6);
  for (const char* wrong :
       {"0.5", "0.5, 0.2, 0.1", "0.5, x", "-0.5, 1", "0, 0", "nan, 1", "", "1e"})
    EXPECT_THROW(of(wrong), Error) << wrong;
}

// What passes `null` goes straight on in a mixture, too.
TEST(mixturebsdf, lets_light_pass_null) {
  const auto nothing = make_bsdf("null"),
             white = make_bsdf("diffuse", {property("reflectance", 1.0)});
  const Vec3f wo = tilted(40);
  for (const auto& mixed :
       {make_bsdf("mixturebsdf", {property("weights", "0.25, 0.75")}, {white, nothing}),
        make_bsdf("blendbsdf", {property("weight", 0.75)}, {white, nothing}),
        make_bsdf("mask", {property("opacity", 0.5)},
                  {make_bsdf("blendbsdf", {property("weight", 0.5)}, {white, nothing})})}) {
    EXPECT_TRUE(mixed->traits().transmits);
    EXPECT_NEAR(mixed->albedo(radiance(), wo, Lobes::diffuse)[0], 0.25, 1e-6);
    EXPECT_TRUE(mixed->traits().passes_straight);
    EXPECT_NEAR(mixed->straight(radiance(), wo)[0], 0.75, 1e-6);
    EXPECT_EQ(mixed->albedo(radiance(), wo, Lobes::delta)[0], 0);
    const BsdfSample sample = mixed->sample(radiance(), wo, 0.1f, {0.5f, 0.5f}, Lobes::all);
    ASSERT_EQ(sample.event, Lobes::diffuse);
    EXPECT_NEAR(sample.weight[0], 0.25, 1e-6);
  }
}

// With a cutoff a surface is there or not.
TEST(mask, cuts_by_opacity) {
  const auto white = make_bsdf("diffuse", {property("reflectance", 1.0)});
  const auto ramp =
      make_texture("checkerboard", {property("color0", 0.4), property("color1", 0.2)});
  const auto at = [](float u) {
    TextureCoordinates where;
    where.uv = {u, 0.25f};
    return BsdfContext(where, TransportMode::radiance, {});
  };
  const auto holes = [&](double cutoff) {
    return make_bsdf("mask", {property("cutoff", cutoff)}, {white}, {{"opacity", ramp}});
  };
  for (const float u : {0.25f, 0.75f}) {
    const bool is_bright = ramp->scalar(at(u).texture()) > 0.3f;
    EXPECT_EQ(holes(0.3)->albedo(at(u), {0, 0, 1}, Lobes::diffuse)[0], is_bright ? 1 : 0);
    EXPECT_EQ(holes(0.3)->straight(at(u), {0, 0, 1})[0], is_bright ? 0 : 1);
    EXPECT_EQ(holes(0.1)->albedo(at(u), {0, 0, 1}, Lobes::diffuse)[0], 1);
  }
}

// ---- relief ----

TEST(normalmap, leans_as_strongly_as_it_is_told) {
  const auto lean = make_constant_texture(SpectralValue::reflectance(Rgb{0.75, 0.75, 1}));
  const auto matt = make_bsdf("diffuse");
  ReliefPoint point;
  point.normal = {0, 0, 1};
  point.dpdu = {2, 0, 0};
  point.dpdv = {0, -1, 0};  // the picture is not mirrored
  const auto normal = [&](std::vector<Property> properties) {
    return make_bsdf("normalmap", properties, {matt}, {{"normalmap", lean}})
        ->relief(true)
        ->normal(point);
  };
  const auto near = [](const Vec3f& a, const Vec3f& b) { return length(a - normalize(b)) < 1e-6f; };
  EXPECT_TRUE(near(normal({}), {0.5f, 0.5f, 1}));
  EXPECT_TRUE(near(normal({property("strength", 0.5)}), {0.25f, 0.25f, 1}));
  EXPECT_TRUE(near(normal({property("against_v", true)}), {0.5f, 0.5f, 1}));
  point.dpdv = {0, 1, 0};
  EXPECT_TRUE(near(normal({}), {0.5f, 0.5f, 1}));
  EXPECT_TRUE(near(normal({property("against_v", true)}), {0.5f, -0.5f, 1}));
}

// ---- coats over anything ----

// The table of what leaves is made at uv (0, 0), where this gloss is black.
TEST(coating, over_gloss_that_is_black_in_a_corner) {
  const auto board =
      make_texture("checkerboard", {property("color0", 0.0), property("color1", 1.0)});
  const auto gold =
      make_bsdf("roughconductor", {property("alpha", 0.2)}, {}, {{"specular_reflectance", board}});
  const auto coated = make_bsdf("coating", {property("int_ior", 1.5)}, {gold});
  TextureCoordinates beside;
  beside.uv = {0.75f, 0.25f};
  const BsdfContext bright(beside, TransportMode::radiance, {});
  ASSERT_GT(gold->albedo(bright, tilted(30), Lobes::all)[0], 0.5);
  ASSERT_TRUE(gold->albedo({}, tilted(30), Lobes::all).is_zero());
  EXPECT_GT(coated->albedo(bright, tilted(30), Lobes::glossy)[0], 0.5);
  EXPECT_GT(coated->pdf(bright, tilted(30), tilted(-30), Lobes::all), 0.1);
}

TEST(coating, over_matt_loses_what_it_throws_back) {
  const auto coated = make_bsdf("coating", {property("int_ior", 1.5), property("ext_ior", 1.0)},
                                {make_bsdf("diffuse", {property("reflectance", 0.5)})});
  // As 'plastic' without the light that comes again: what even light meets from inside is n² less
  // than what leaves; Kaustik's own quadrature is compared with Walsh's form elsewhere.
  const double leaves = (1 - double(reflectance_of_even_light(1.5f))) / 2.25;
  EXPECT_NEAR(coated->albedo(radiance(), tilted(0), Lobes::diffuse)[0], 0.96 * 0.5 * leaves, 1e-4);
  EXPECT_NEAR(coated->eval(radiance(), tilted(0), tilted(0), Lobes::all)[0] * pi,
              0.5 * 0.96 * 0.96 / 2.25, 1e-5);
}

TEST(coating, absorbs_along_the_refracted_way) {
  const auto mirror = make_bsdf("conductor");
  const auto coated = make_bsdf("coating",
                                {property("int_ior", 1.5), property("ext_ior", 1.0),
                                 property("sigma_a", Rgb{0.2, 1, 3}), property("thickness", 0.5)},
                                {mirror});
  const Vec3f wo = tilted(60);
  const double inside = std::sqrt(1 - 0.75 / 2.25),
               reflected = double(fresnel_dielectric(wo.z, 1.5f).reflectance);
  const double sigma[] = {0.2, 1, 3};
  for (size_t lane = 0; lane < 3; ++lane) {
    const double through = (1 - reflected) * std::exp(-0.5 * sigma[lane] / inside);
    EXPECT_NEAR(coated->albedo(radiance(), wo, Lobes::all)[int(lane)],
                reflected + through * through, 1e-5);
  }
}

// ---- openpbr ----

std::shared_ptr<const Bsdf> open_pbr(std::vector<Property> properties) {
  return make_bsdf("openpbr", properties);
}

// What is matt makes up for what the layers above it lose: white is white. Of a rough matt part one
// factor keeps all directions below 1, so that some lose a little.
TEST(openpbr, matt_white_is_white) {
  for (const double roughness : {0.0, 0.3, 0.7, 1.0})
    for (const double diffuse_roughness : {0.0, 1.0})
      for (const double coat : {0.0, 1.0})
        for (const double fuzz : {0.0, 0.7}) {
          const auto bsdf = open_pbr(
              {property("base_color", 1.0), property("specular_roughness", roughness),
               property("base_diffuse_roughness", diffuse_roughness), property("coat_weight", coat),
               property("coat_roughness", 0.3), property("fuzz_weight", fuzz)});
          for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
            const float albedo = bsdf->albedo(radiance(), tilted(degrees), Lobes::all)[1];
            EXPECT_GE(albedo, diffuse_roughness > 0 ? 0.97f : 0.98f)
                << roughness << " " << diffuse_roughness << " " << coat << " " << fuzz << " "
                << degrees;
            EXPECT_LE(albedo, diffuse_roughness > 0 ? 1.001f : 1.0001f)
                << roughness << " " << diffuse_roughness << " " << coat << " " << fuzz << " "
                << degrees;
          }
        }
}

// "Interfaced Lambertian" (Elias et al. 2001): what comes through a smooth coat from a matt base
// is what 'plastic' has, where its index is the base's too.
TEST(openpbr, a_smooth_coat_over_matt_is_plastic) {
  const Rgb color{0.8, 0.4, 0.1};
  const auto coated = open_pbr({property("base_color", color), property("specular_ior", 1.5),
                                property("coat_ior", 1.5), property("coat_weight", 1.0)});
  const auto plastic =
      make_bsdf("plastic", {property("diffuse_reflectance", color), property("int_ior", 1.5),
                            property("ext_ior", 1.0), property("nonlinear", true)});
  for (const double degrees : {0.0, 40.0, 70.0}) {
    const Vec3f wo = tilted(degrees), wi = tilted(-25);
    for (int lane = 0; lane < 3; ++lane) {
      const float expected = plastic->eval(radiance(), wo, wi, Lobes::diffuse)[lane];
      EXPECT_NEAR(coated->eval(radiance(), wo, wi, Lobes::diffuse)[lane], expected,
                  0.02f * expected);
    }
  }
  // Without darkening it is as bright as without a coat, but for what that reflects.
  const auto bright = open_pbr({property("base_color", color), property("specular_ior", 1.5),
                                property("coat_ior", 1.5), property("coat_weight", 1.0),
                                property("coat_darkening", 0.0)});
  EXPECT_NEAR(bright->albedo(radiance(), tilted(0), Lobes::diffuse)[1], 0.96 * 0.4, 2e-3);
}

// Kutz, Hašan and Edmondson 2021: the base's colour at the normal, the specular colour times as
// much as by Schlick at a cosine of 1/7.
TEST(openpbr, metal_has_its_two_colours) {
  const auto metal =
      open_pbr({property("base_color", Rgb{0.9, 0.6, 0.3}), property("base_metalness", 1.0),
                property("specular_color", Rgb{0.5, 0.8, 1}), property("specular_roughness", 0.0)});
  const Spectrum normal = metal->albedo(radiance(), tilted(0), Lobes::all);
  const Vec3f edge(std::sqrt(48.0f) / 7, 0, 1.0f / 7);
  const Spectrum at_edge = metal->albedo(radiance(), edge, Lobes::all);
  const double colors[] = {0.9, 0.6, 0.3}, tints[] = {0.5, 0.8, 1};
  for (size_t lane = 0; lane < 3; ++lane) {
    EXPECT_NEAR(normal[int(lane)], colors[lane], 0.005);
    const double schlick = colors[lane] + (1 - colors[lane]) * std::pow(6.0 / 7, 5);
    EXPECT_NEAR(at_edge[int(lane)], tints[lane] * schlick, 0.02);
  }
}

TEST(openpbr, glass_reflects_and_refracts_as_glass_does) {
  const auto smooth = open_pbr({property("transmission_weight", 1.0), property("specular_ior", 1.5),
                                property("specular_roughness", 0.0)});
  const auto glass = make_bsdf("dielectric", {property("int_ior", 1.5), property("ext_ior", 1.0)});
  for (const double degrees : {0.0, 30.0, 60.0})
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = tilted(degrees, side);
      const float reflectance = fresnel_dielectric(wo.z, 1.5f).reflectance;
      RunningStatistics back;
      int astray = 0;
      for (uint32_t i = 0; i < 4096; ++i) {
        Sampler sampler(11, i);
        const float u_lobe = sampler.next_1d();
        const BsdfSample s = smooth->sample(flux(), wo, u_lobe, sampler.next_2d(), Lobes::all);
        back.add(s.transmission ? 0 : double(s.weight[0]));
        if (!s.transmission || degrees == 60.0) continue;
        const BsdfSample sharp = glass->sample(flux(), wo, one_minus_epsilon, {}, Lobes::all);
        ASSERT_NEAR(s.eta, sharp.eta, 1e-6f);
        astray += length(s.wi - sharp.wi) > 0.05f;
      }
      EXPECT_LT(astray, 40);  // by GGX's long tail
      EXPECT_NEAR(back.mean(), reflectance, 0.02) << degrees << " " << side;
    }
}

// Of a sheet both sides reflect: 2R/(1 + R), and the rest goes on with its colour: straight, unless
// the sheet is rough.
TEST(openpbr, a_sheet_of_glass_is_a_pane) {
  for (const bool is_smooth : {true, false}) {
    const auto pane = open_pbr({property("transmission_weight", 1.0), property("specular_ior", 1.5),
                                property("specular_roughness", is_smooth ? 0.0 : 0.06),
                                property("geometry_thin_walled", true),
                                property("transmission_color", Rgb{0.9, 0.6, 0.3})});
    EXPECT_EQ(pane->traits().passes_straight, is_smooth);
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = tilted(0, side);
      const Spectrum straight = pane->straight(radiance(), wo),
                     albedo = pane->albedo(radiance(), wo, Lobes::all);
      const double back = 0.08 / 1.04;
      EXPECT_NEAR(straight[0] + albedo[0], back + 0.9 * (1 - back), 0.005);
      EXPECT_NEAR(straight[2] + albedo[2], back + 0.3 * (1 - back), 0.005);
      EXPECT_NEAR(straight[0], is_smooth ? 0.9 * (1 - back) : 0, 1e-5);
    }
  }
}

// Its layers lie on both sides.
TEST(openpbr, what_goes_straight_through_a_coated_pane_passes_two_coats) {
  const auto pane = [](double coat) {
    return open_pbr({property("transmission_weight", 1.0), property("geometry_thin_walled", true),
                     property("specular_roughness", 0.0), property("coat_weight", coat),
                     property("coat_roughness", 0.0), property("coat_color", Rgb{0.5, 1, 1})});
  };
  const auto bare = pane(0), coated = pane(1);
  for (const double degrees : {0.0, 60.0}) {
    const Vec3f wo = tilted(degrees);
    const Spectrum through = coated->straight(radiance(), wo);
    EXPECT_LT(through[1], bare->straight(radiance(), wo)[1]);
    EXPECT_NEAR(through[0] / through[1], 0.5, 1e-4);
    EXPECT_LE(through[1] + coated->albedo(radiance(), wo, Lobes::all)[1], 1.001);
  }
}

TEST(openpbr, its_opacity_makes_holes) {
  const auto half = open_pbr({property("geometry_opacity", 0.25)});
  EXPECT_TRUE(half->traits().transmits);
  EXPECT_NEAR(half->straight(radiance(), tilted(20))[0], 0.75, 1e-6);
}

TEST(cloth_fuzz, never_reflects_more_than_arrives_and_most_at_grazing_angles) {
  for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    float last = 1.0001f;
    for (const float cosine : {1e-6f, 0.01f, 0.1f, 0.3f, 0.7f, 1.0f}) {
      const float albedo = cloth_fuzz_albedo(cosine, roughness);
      EXPECT_LE(albedo, last) << roughness << " " << cosine;
      EXPECT_GE(albedo, 0);
      last = albedo;
    }
  }
}

// ---- names of Mitsuba 0.6 ----

TEST(distributions, of_mitsuba_0_6_are_beckmann) {
  std::vector<std::string> warnings;
  const auto warned_of = [&](const std::string& type, const std::vector<Property>& properties) {
    warnings.clear();
    return make_bsdf(type, properties, {}, {},
                     [&](const std::string& message) { warnings.push_back(message); });
  };
  const auto phong =
      warned_of("roughconductor", {property("distribution", "phong"), property("alpha", 0.2)});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "distribution 'phong' of bsdf 'roughconductor' is 'beckmann' of the same "
            "alpha here");
  const auto beckmann = warned_of("roughconductor", {property("alpha", 0.2)});
  EXPECT_TRUE(warnings.empty());
  const Vec3f wo = tilted(30), wi = tilted(-20);
  EXPECT_EQ(phong->eval(radiance(), wo, wi, Lobes::all),
            beckmann->eval(radiance(), wo, wi, Lobes::all));
  const auto polarised =
      warned_of("pplastic", {property("alpha_u", 0.1), property("alpha_v", 0.4)});
  EXPECT_EQ(warnings.size(), 1u);
  const auto plastic = make_bsdf("roughplastic", {property("alpha", 0.2)});
  EXPECT_NEAR(polarised->eval(radiance(), wo, wi, Lobes::all)[0],
              plastic->eval(radiance(), wo, wi, Lobes::all)[0], 1e-5f);
}

// ---- what a context remembers ----

TEST(bsdf_context, remembers_a_number_however_many_textures_it_was_asked_for) {
  const BsdfContext context;
  std::vector<std::shared_ptr<const Texture>> textures;
  for (int i = 0; i < 20; ++i) {
    textures.push_back(make_texture("checkerboard"));
    context.value_of(*textures.back());
  }
  int asked = 0;
  const auto number = [&](const void* key) {
    return context.number_of(key, [&] { return float(++asked); });
  };
  EXPECT_EQ(number(&textures[0]), 1);
  EXPECT_EQ(number(&textures[0]), 1);
  EXPECT_EQ(number(&textures[1]), 2);
  EXPECT_EQ(number(&textures[0]), 1);
  BsdfContext moved = context;
  moved.move_to({}, {});
  EXPECT_EQ(moved.number_of(&textures[0], [] { return 7.0f; }), 7);
}

}  // namespace
}  // namespace kaustik
