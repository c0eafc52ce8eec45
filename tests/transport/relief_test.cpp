// Bent normals and filtered textures, as vertices see them.

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/base/wave_field.h"
#include "kaustik/transport/light_path.h"
#include "kaustik/transport/vertex.h"
#include "kaustik/transport/visible_normal.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using test::scene_of;

SurfaceVertex seen(const Scene& scene, const Vec3f& at, const Vec3f& from,
                   const Footprint& footprint = {}, TransportMode mode = TransportMode::radiance) {
  const Ray ray{at + from * 3.0f, -from};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  SurfaceVertex vertex;
  vertex.meet(scene, ray, hit, mode, footprint, {});
  return vertex;
}

const std::string waves =
    "<bsdf type=\"bumpmap\"><texture type=\"waves\"><float name=\"amplitude\" value=\"0.01\"/>"
    "</texture>";
std::string rectangle(const std::string& bsdf, const std::string& transform = "") {
  return "<shape type=\"rectangle\"><transform name=\"to_world\">" + transform + "</transform>" +
         bsdf + "</shape>";
}

Vec3f expected_normal(const Vec2f& at, float width = 0, float amplitude = 0.01f) {
  WaveSettings settings;
  settings.amplitude = amplitude;
  const Vec2f slope = WaveField(settings).slope(at, width);
  return normalize(Vec3f(-slope.x, -slope.y, 1));
}

TEST(BumpMap, BendsToTheNormalOfTheWaves) {
  for (const std::string& nested :
       {std::string("<bsdf type=\"diffuse\"/>"), std::string("<bsdf type=\"dielectric\"/>")}) {
    const auto scene = scene_of(rectangle(waves + nested + "</bsdf>"));
    for (int i = 0; i < 50; ++i) {
      const Vec3f at(0.031f * float(i) - 0.8f, 0.4f - 0.017f * float(i), 0);
      // From above and from below: there is one interface, and it has one normal.
      for (const float side : {1.0f, -1.0f}) {
        const SurfaceVertex vertex = seen(*scene, at, {0, 0, side});
        EXPECT_LT(length(vertex.normal() - expected_normal({at.x, at.y})), 2e-3f);
        EXPECT_TRUE(vertex.has_relief());
        EXPECT_EQ(vertex.point().ng, Vec3f(0, 0, 1));
      }
    }
  }
}

/// Light that grazes water meets bent normals that face it: rarely it leaves with far more flux
/// than it came with, which photons may not carry.
TEST(BumpMap, FluxOfGrazingLightIsBounded) {
  const auto scene =
      scene_of(rectangle(waves + "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1\"/>"
                                 "</bsdf></bsdf>") +
               "<shape type=\"sphere\"><float name=\"radius\" value=\"9\"/></shape>");
  for (const float limit : {infinity, 3.0f}) {
    float most = 0;
    const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
      Sampler sampler(hash_mix(3, i), 0);
      const Vec2f u = sampler.next_2d();
      const Vec3f target(1.6f * u.x - 0.8f, 1.6f * u.y - 0.8f, 0);
      const Vec3f from = target + Vec3f(-2, 0, 0.002f);
      return LightPath(Ray{from, normalize(target - from)}, Spectrum(1), nullptr, Lobes::specular,
                       sampler, {});
    };
    const auto meet = [&](const LightVertex& at) {
      most = std::max(most, at.state.throughput.max_lane());
      return at.path_class.events() == 0 ? Lobes::all : Lobes::none;
    };
    LightPathLimits limits;
    limits.largest_weight = limit;
    trace_light_paths(*scene, 0, 4000, limits, emit, meet);
    if (limit < infinity) {
      EXPECT_FLOAT_EQ(most, limit);
    } else {
      EXPECT_GT(most, 10);
    }
  }
}

Footprint of_width(float width, bool scattered = false) {
  Footprint footprint;
  footprint.width = width;
  footprint.scattered = scattered;
  return footprint;
}

TEST(BumpMap, FlattensOverAFootprintButNotAfterScattering) {
  const auto scene = scene_of(rectangle(waves + "<bsdf type=\"diffuse\"/></bsdf>"));
  const Vec3f at(0.21f, 0.13f, 0);
  EXPECT_LT(length(seen(*scene, at, {0, 0, 1}, of_width(0.1f)).normal() -
                   expected_normal({at.x, at.y}, 0.1f)),
            2e-3f);
  EXPECT_LT(length(seen(*scene, at, {0, 0, 1}, of_width(10)).normal() - Vec3f(0, 0, 1)), 1e-4f);
  EXPECT_LT(length(seen(*scene, at, {0, 0, 1}, of_width(10, true)).normal() -
                   expected_normal({at.x, at.y})),
            2e-3f);
}

TEST(BumpMap, MovesWithInstances) {
  const std::string group = "<shape type=\"shapegroup\" id=\"g\">" +
                            rectangle(waves + "<bsdf type=\"diffuse\"/></bsdf>") + "</shape>";
  const auto scene =
      scene_of(group +
               "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">"
               "<scale value=\"2\"/><rotate x=\"1\" angle=\"90\"/>"
               "<translate value=\"0.3, 0, 0\"/></transform></shape>");
  // Heights are metres of the world, on waves that are twice as long: they are half as steep. The
  // group's (x, y, z) is the world's (2x + 0.3, −2z, 2y).
  for (int i = 0; i < 20; ++i) {
    const Vec2f local(0.04f * float(i) - 0.4f, 0.03f * float(i) - 0.3f);
    const SurfaceVertex vertex = seen(*scene, {2 * local.x + 0.3f, 0, 2 * local.y}, {0, -1, 0});
    const Vec3f n = expected_normal(local, 0, 0.005f);
    EXPECT_LT(length(vertex.normal() - Vec3f(n.x, -n.z, n.y)), 3e-3f);
  }
}

TEST(BumpMap, HeightsByTextureCoordinatesAreMetres) {
  // A checkerboard's steps are steep only at edges; between them the surface is flat. Bevels of
  // tiles by uv: 1 m high over 1 unit of uv, which is 2 m wide here: a slope of 2·(1 − d)/2.
  const auto scene = scene_of(rectangle(
      "<bsdf type=\"bumpmap\"><texture type=\"tiles\"><string name=\"projection\" value=\"uv\"/>"
      "<float name=\"tile_width\" value=\"10\"/><float name=\"tile_height\" value=\"10\"/>"
      "<float name=\"joint\" value=\"0\"/><float name=\"bevel\" value=\"1\"/>"
      "<float name=\"depth\" value=\"1\"/></texture><bsdf type=\"diffuse\"/></bsdf>"));
  const SurfaceVertex vertex = seen(*scene, {-0.6f, 0.5f, 0}, {0, 0, 1});  // uv (0.2, 0.75)
  EXPECT_LT(length(vertex.normal() - normalize(Vec3f(-0.8f, 0, 1))), 1e-3f);
}

TEST(BumpMap, StandsUpOnBothSidesOfATwosidedSurface) {
  const auto scene = scene_of(
      rectangle("<bsdf type=\"twosided\">" + waves + "<bsdf type=\"diffuse\"/></bsdf></bsdf>"));
  const Vec3f at(0.2f, -0.3f, 0);
  const Vec3f front = seen(*scene, at, {0, 0, 1}).facing_normal();
  const Vec3f back = seen(*scene, at, {0, 0, -1}).facing_normal();
  EXPECT_LT(length(front - Vec3f(back.x, back.y, -back.z)), 1e-4f);
}

TEST(NormalMap, TurnsColoursIntoNormals) {
  const auto scene = scene_of(
      rectangle("<bsdf type=\"normalmap\"><texture name=\"normalmap\" type=\"checkerboard\">"
                "<rgb name=\"color0\" value=\"0.75, 0.5, 1\"/>"
                "<rgb name=\"color1\" value=\"0.5, 0.25, 1\"/></texture>"
                "<bsdf type=\"diffuse\"/></bsdf>",
                "<rotate z=\"1\" angle=\"90\"/>"));
  // u runs along y.
  EXPECT_LT(
      length(seen(*scene, {0.5f, -0.5f, 0}, {0, 0, 1}).normal() - normalize(Vec3f(0, 0.5f, 1))),
      1e-3f);
  EXPECT_LT(
      length(seen(*scene, {-0.5f, -0.5f, 0}, {0, 0, 1}).normal() - normalize(Vec3f(0.5f, 0, 1))),
      1e-3f);
}

TEST(VisibleNormal, KeepsBothDirectionsAboveTheSurface) {
  int bent = 0;
  for (uint32_t i = 0; i < 20000; ++i) {
    Sampler sampler(3, i);
    const Vec3f ng = square_to_sphere(sampler.next_2d()), wo = square_to_sphere(sampler.next_2d());
    Vec3f n = square_to_sphere(sampler.next_2d());
    if (dot(n, ng) < 0) n = -n;
    const float side = dot(wo, ng) < 0 ? -1.0f : 1.0f;
    for (const bool mirrors : {false, true}) {
      const Vec3f v = visible_normal(n, ng, wo, mirrors);
      EXPECT_NEAR(length(v), 1, 1e-5f);
      EXPECT_GT(dot(v, ng), 0);
      EXPECT_GE(dot(wo, v) * side, 0);
      if (mirrors) {
        EXPECT_GE(dot(reflect(wo, v), ng) * side, -1e-6f);
      }
      // Where nothing is wrong, nothing is changed.
      const bool fine = dot(wo, n) * side > 0.011f && dot(n, ng) > 0.1f &&
                        (!mirrors || dot(reflect(wo, n), ng) * side > 0.011f);
      if (fine) {
        EXPECT_LT(length(v - n), 1e-6f);
      }
      bent += length(v - n) > 1e-3f;
    }
  }
  EXPECT_GT(bent, 1000);
}

TEST(VisibleNormal, IsContinuous) {
  const Vec3f ng(0, 0, 1), wo = normalize(Vec3f(1, 0.1f, 0.2f));
  for (const bool mirrors : {false, true}) {
    Vec3f last = ng;
    for (int i = 0; i < 2000; ++i) {
      const float angle = 1.5f * float(i) / 2000;
      const Vec3f v = visible_normal({-std::sin(angle), 0.001f, std::cos(angle)}, ng, wo, mirrors);
      EXPECT_LT(length(v - last), 0.01f);
      last = v;
    }
  }
}

// What light loses along one path does not depend on the end from which it is followed, with bent
// normals as well, as long as nothing is seen edge-on.
TEST(BumpMap, FluxAndRadianceAreTransportedAlike) {
  const auto scene = scene_of(rectangle(waves + "<bsdf type=\"diffuse\"/></bsdf>"));
  for (uint32_t i = 0; i < 300; ++i) {
    Sampler sampler(9, i);
    Vec3f a = square_to_sphere(sampler.next_2d()), b = square_to_sphere(sampler.next_2d());
    a.z = std::fabs(a.z) + 0.5f, b.z = std::fabs(b.z) + 0.5f;
    a = normalize(a), b = normalize(b);
    const Vec2f u = sampler.next_2d();
    const Vec3f at(u.x - 0.5f, u.y - 0.5f, 0);
    const double radiance = double(seen(*scene, at, b).eval_cosine(a, Lobes::all)[1]) * double(b.z);
    const double flux =
        double(seen(*scene, at, a, {}, TransportMode::flux).eval_cosine(b, Lobes::all)[1]) *
        double(a.z);
    ASSERT_GT(radiance, 0);
    EXPECT_NEAR(flux / radiance, 1, 1e-3);
  }
}

TEST(Footprint, FiltersTextures) {
  const auto scene = scene_of(rectangle(
      "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\">"
      "<rgb name=\"color0\" value=\"1\"/><rgb name=\"color1\" value=\"0\"/></texture></bsdf>"));
  const auto albedo = [&](const Vec3f& at, const Footprint& footprint) {
    return seen(*scene, at, {0, 0, 1}, footprint).albedo(Lobes::all)[0];
  };
  EXPECT_EQ(albedo({-0.05f, -0.5f, 0}, {}), 1);
  // 0.2 m are 0.1 of uv: a quarter of that lies beyond the edge at u = 0.5.
  EXPECT_NEAR(albedo({-0.05f, -0.5f, 0}, {0.2f, 0, false}), 0.75f, 1e-3f);
  EXPECT_NEAR(albedo({-0.05f, -0.5f, 0}, {100, 0, false}), 0.5f, 0.02f);
}

TEST(Footprint, IsTheCamerasWhereItSeesLightPaths) {
  const auto scene = scene_of(rectangle(
      "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\">"
      "<rgb name=\"color0\" value=\"1\"/><rgb name=\"color1\" value=\"0\"/></texture></bsdf>"));
  const Vec3f toward_camera = normalize(Vec3f(1, 0, 0.3f)), toward_lamp = {0, 0, 1};
  for (const float x : {-0.05f, 0.03f})
    for (const float width : {0.001f, 0.01f, 0.08f}) {
      const Vec3f at(x, -0.5f, 0);
      const SurfaceVertex camera = seen(*scene, at, toward_camera, {width, 0, false});
      SurfaceVertex light = seen(*scene, at, toward_lamp, {0.4f, 0, false}, TransportMode::flux);
      const auto difference = [&] {
        return std::fabs(light.albedo(Lobes::all)[0] - camera.albedo(Lobes::all)[0]);
      };
      EXPECT_GT(difference(), 0.01f) << x << " " << width;
      ASSERT_TRUE(light.has_textures());
      light.look_up_from(*scene, toward_camera, width);
      EXPECT_LT(difference(), 1e-4f) << x << " " << width;
    }
}

TEST(Footprint, GrowsByDistanceAndScattering) {
  Footprint f{0, 0.01f, false};
  f.travel(5);
  EXPECT_FLOAT_EQ(f.width, 0.05f);
  f.scatter(Lobes::delta, 0.3f);
  EXPECT_FLOAT_EQ(f.spread, 0.01f);
  EXPECT_FALSE(f.scattered);
  f.scatter(Lobes::diffuse, inv_pi);
  // The cone of a 64th of the chance: its solid angle is π/64.
  EXPECT_NEAR(f.spread, 2 * std::sqrt(1.0f / 64), 1e-4f);
  EXPECT_TRUE(f.scattered);
  const float before = f.spread;
  f.scatter(Lobes::glossy, 1e4f);
  EXPECT_FLOAT_EQ(f.spread, before);
}

TEST(Tangent, TurnsBrushedMetal) {
  const std::string brushed =
      "<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"0.05\"/>"
      "<float name=\"alpha_v\" value=\"0.5\"/></bsdf>";
  for (const float angle : {0.0f, 30.0f, 90.0f}) {
    const auto scene =
        scene_of(rectangle(brushed, "<rotate z=\"1\" angle=\"" + std::to_string(angle) + "\"/>"));
    const SurfaceVertex vertex = seen(*scene, {0.1f, 0.1f, 0}, {0, 0, 1});
    const float phi = angle * pi / 180;
    EXPECT_LT(length(vertex.frame().x - Vec3f(std::cos(phi), std::sin(phi), 0)), 1e-4f);
  }
}

}  // namespace
}  // namespace kaustik
