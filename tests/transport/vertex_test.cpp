// Vertices: sides, frames, and that flux and radiance are transported alike along one path.

#include "kaustik/transport/vertex.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "kaustik/transport/direct_light.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using test::scene_of;

/// The vertex that a ray from `from` (a unit direction from the origin) meets at the origin.
SurfaceVertex vertex_seen_from(const Scene& scene, const Vec3f& from, TransportMode mode) {
  const Ray ray{from * 3.0f, -from};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  EXPECT_NEAR(hit.t, 3, 1e-4);
  return {scene, ray, hit, mode};
}

const std::string mixed_phong =
    "<bsdf type=\"phong\"><float name=\"exponent\" value=\"9\"/>"
    "<rgb name=\"diffuse_reflectance\" value=\"0.5,0.4,0.3\"/>"
    "<rgb name=\"specular_reflectance\" value=\"0.3\"/></bsdf>";

std::string flat(const std::string& bsdf) {
  return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

/// One large triangle around the origin whose vertex normals lean over: the shading normal there is
/// (0.5, 0.2, 1) normalised, the geometric one +z.
class Leaning {
 public:
  Leaning() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kaustik_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    std::ofstream(folder_ / "leaning.obj")
        << "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nvn 0.5 0.2 1\nf 1//1 2//1 3//1\n";
  }
  ~Leaning() { std::filesystem::remove_all(folder_); }
  std::string shape(const std::string& bsdf) const {
    return fmt::format(
        "<shape type=\"obj\"><string name=\"filename\" value=\"{}/leaning.obj\"/>{}</shape>",
        folder_.string(), bsdf);
  }

 private:
  std::filesystem::path folder_;
};

/// A direction over the plane z = 0, not too flat.
Vec3f upward(Sampler& sampler) {
  Vec3f direction = square_to_sphere(sampler.next_2d());
  direction.z = std::fabs(direction.z) + 0.1f;
  return normalize(direction);
}

TEST(SurfaceVertex, KnowsItsSideAndFrame) {
  const auto scene = scene_of(flat("") + "<emitter type=\"point\"/>");
  const Vec3f above = normalize({0.3f, 0.2f, 1}), below = normalize({0.3f, 0.2f, -1});
  const SurfaceVertex front = vertex_seen_from(*scene, above, TransportMode::radiance);
  EXPECT_TRUE(front.on_front());
  EXPECT_EQ(front.light(), -1);
  EXPECT_LT(length(front.wo() - above), 1e-6f);
  EXPECT_LT(length(front.facing_normal() - Vec3f(0, 0, 1)), 1e-6f);
  EXPECT_GT(front.frame().to_local(front.wo()).z, 0);
  const SurfaceVertex back = vertex_seen_from(*scene, below, TransportMode::radiance);
  EXPECT_FALSE(back.on_front());
  EXPECT_LT(length(back.facing_normal() - Vec3f(0, 0, -1)), 1e-6f);
  EXPECT_LT(back.frame().to_local(back.wo()).z, 0);
}

TEST(SurfaceVertex, DiffuseLightByTheFormula) {
  const auto scene =
      scene_of(flat("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.6\"/></bsdf>"));
  const SurfaceVertex vertex =
      vertex_seen_from(*scene, normalize({1, 2, 3}), TransportMode::radiance);
  const Vec3f wi = normalize({-1, 1, 2});
  EXPECT_NEAR(vertex.eval(wi, Lobes::all)[0], 0.6f * inv_pi, 1e-6f);
  EXPECT_NEAR(vertex.diffuse_value()[0], 0.6f * inv_pi, 1e-6f);
  EXPECT_NEAR(vertex.eval_cosine(wi, Lobes::all)[0], 0.6f * inv_pi * wi.z, 1e-6f);
  EXPECT_NEAR(vertex.pdf(wi, Lobes::all), inv_pi * wi.z, 1e-6f);
  for (const Vec3f& through : {Vec3f(-wi), Vec3f(0, 0, -1)}) {
    EXPECT_TRUE(vertex.eval_cosine(through, Lobes::all).is_zero());
    EXPECT_EQ(vertex.pdf(through, Lobes::all), 0);
  }
  EXPECT_TRUE(vertex.eval_cosine(wi, Lobes::specular).is_zero());
}

/// Samples of one lobe: weight times density is f·cosine.
void expect_consistent_samples(const SurfaceVertex& vertex, Lobes lobes) {
  int scattered = 0;
  for (uint32_t i = 0; i < 2000; ++i) {
    Sampler sampler(8, i);
    const Vec2f u_lobe = sampler.next_2d();
    const BsdfSample sample = vertex.sample(u_lobe.x, sampler.next_2d(), lobes);
    if (sample.event == Lobes::none) continue;
    ++scattered;
    EXPECT_TRUE(any(sample.event & lobes));
    EXPECT_NEAR(length(sample.wi), 1, 1e-4);
    const Spectrum expected = vertex.eval_cosine(sample.wi, lobes);
    const Spectrum found = sample.weight * sample.pdf_solid_angle;
    for (int lane = 0; lane < 3; ++lane)
      EXPECT_NEAR(found[lane], expected[lane], 1e-3f * expected[lane] + 1e-5f);
    EXPECT_NEAR(vertex.pdf(sample.wi, lobes), sample.pdf_solid_angle,
                1e-3f * sample.pdf_solid_angle + 1e-5f);
  }
  EXPECT_GT(scattered, 1000);
}

TEST(SurfaceVertex, SamplesAreWhatIsEvaluated) {
  const Leaning leaning;
  for (const std::string& shape : {flat(mixed_phong), leaning.shape(mixed_phong)}) {
    const auto scene = scene_of(shape);
    for (const auto mode : {TransportMode::radiance, TransportMode::flux})
      for (const Lobes lobes : {Lobes::diffuse, Lobes::glossy})
        expect_consistent_samples(vertex_seen_from(*scene, normalize({0.4f, -0.3f, 1}), mode),
                                  lobes);
  }
}

/// What light loses from a to b over a vertex at the origin, measured on the surface: for radiance
/// with the camera at b, for flux with the light at a. Without shading normals both are f·cosines.
double transported_as_radiance(const Scene& scene, const Vec3f& a, const Vec3f& b) {
  const SurfaceVertex vertex = vertex_seen_from(scene, b, TransportMode::radiance);
  return double(vertex.eval_cosine(a, Lobes::all)[1]) * abs_dot(b, vertex.point().ng);
}
double transported_as_flux(const Scene& scene, const Vec3f& a, const Vec3f& b, bool adjoint) {
  const SurfaceVertex vertex = vertex_seen_from(scene, a, TransportMode::flux);
  const double f_cosine =
      adjoint ? double(vertex.eval_cosine(b, Lobes::all)[1])
              : double(vertex.eval(b, Lobes::all)[1] * std::fabs(vertex.frame().to_local(b).z));
  return f_cosine * abs_dot(a, vertex.point().ng);
}

/// Largest relative difference of the two over many pairs of directions that the shading normal
/// does not deny: there the camera's vertices take the geometric normal instead, light's get none.
double largest_difference(const Scene& scene, bool adjoint) {
  double largest = 0;
  for (uint32_t i = 0; i < 500; ++i) {
    Sampler sampler(9, i);
    const Vec3f a = upward(sampler), b = upward(sampler);
    const Vec3f normal = vertex_seen_from(scene, {0, 0, 1}, TransportMode::radiance).normal();
    if (dot(a, normal) <= 0 || dot(b, normal) <= 0) continue;
    const double radiance = transported_as_radiance(scene, a, b);
    const double flux = transported_as_flux(scene, a, b, adjoint);
    EXPECT_EQ(radiance == 0, flux == 0);
    if (radiance > 0) largest = std::max(largest, std::fabs(flux / radiance - 1));
  }
  return largest;
}

TEST(SurfaceVertex, FluxAndRadianceAreTransportedAlike) {
  const Leaning leaning;
  for (const std::string& bsdf : {std::string("<bsdf type=\"diffuse\"/>"), mixed_phong}) {
    EXPECT_LT(largest_difference(*scene_of(flat(bsdf)), true), 1e-3);
    EXPECT_LT(largest_difference(*scene_of(leaning.shape(bsdf)), true), 1e-3);
  }
}

// The twin: without the factor for shading normals they are not.
TEST(SurfaceVertex, AMissingAdjointFactorWouldBeFound) {
  const Leaning leaning;
  EXPECT_GT(largest_difference(*scene_of(leaning.shape("<bsdf type=\"diffuse\"/>")), false), 0.1);
}

TEST(SurfaceVertex, NoLightLeaksWhereTheNormalsDisagree) {
  const Leaning leaning;
  const auto scene = scene_of(leaning.shape("<bsdf type=\"diffuse\"/>"));
  const SurfaceVertex vertex = vertex_seen_from(*scene, Vec3f(0, 0, 1), TransportMode::radiance);
  EXPECT_LT(length(vertex.normal() - normalize({0.5f, 0.2f, 1})), 1e-3f);
  const Vec3f above_surface_only = normalize({-1, 0, 0.2f});
  const Vec3f above_shading_only = normalize({1, 0, -0.2f});
  ASSERT_LT(dot(above_surface_only, vertex.normal()), 0);
  ASSERT_GT(dot(above_shading_only, vertex.normal()), 0);
  for (const Vec3f& wi : {above_surface_only, above_shading_only}) {
    EXPECT_TRUE(vertex.eval_cosine(wi, Lobes::all).is_zero());
    EXPECT_EQ(vertex.pdf(wi, Lobes::all), 0);
  }
}

TEST(SurfaceVertex, ValuesAreWhatIsAskedForOneByOne) {
  const Leaning leaning;
  const std::string bumpy =
      "<bsdf type=\"bumpmap\"><texture type=\"waves\" name=\"texture\">"
      "<float name=\"amplitude\" value=\"0.3\"/></texture>" +
      mixed_phong + "</bsdf>";
  for (const std::string& shape : {leaning.shape(mixed_phong), flat(bumpy)}) {
    const auto scene = scene_of(shape + "<emitter type=\"point\"/>");
    int not_black = 0, black = 0;
    for (int i = 0; i < 500; ++i) {
      Sampler sampler(17, uint64_t(i));
      const SurfaceVertex vertex =
          vertex_seen_from(*scene, upward(sampler), TransportMode::radiance);
      const Vec3f wi = square_to_sphere(sampler.next_2d());
      const BsdfValues values = vertex.values(wi);
      std::vector<Vec3f> many(100, wi);
      many[99] = -wi;
      std::vector<BsdfValues> at_once(1);
      vertex.values(many, at_once);
      ASSERT_EQ(at_once.size(), 100u);
      EXPECT_EQ(at_once[0], values);
      EXPECT_EQ(at_once[98], values);
      EXPECT_EQ(at_once[99], vertex.values(-wi));
      for (int lane = 0; lane < 4; ++lane)
        for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy})
          EXPECT_NEAR(values.of(lobe)[lane], vertex.eval(wi, lobe)[lane], 1e-6);
      EXPECT_NEAR(values.pdf, vertex.pdf(wi, Lobes::all), 1e-6);
      EXPECT_NEAR(values.pdf_reverse, vertex.pdf_reverse(wi, Lobes::all), 1e-6);
      ++(values.pdf > 0 ? not_black : black);
    }
    EXPECT_GT(not_black, 100);
    EXPECT_GT(black, 100);
  }
}

TEST(SurfaceVertex, SilhouettesFallBackToTheGeometricNormal) {
  const Leaning leaning;
  const auto scene = scene_of(leaning.shape("<bsdf type=\"diffuse\"/>"));
  // On the front of the surface, behind the shading normal.
  const SurfaceVertex vertex =
      vertex_seen_from(*scene, normalize({-1, 0, 0.2f}), TransportMode::radiance);
  EXPECT_LT(length(vertex.normal() - Vec3f(0, 0, 1)), 1e-5f);
  EXPECT_GT(vertex.eval_cosine({0, 0, 1}, Lobes::all)[0], 0);
}

TEST(SurfaceVertex, RefractionScalesRadianceOnly) {
  const auto scene = scene_of(flat("<bsdf type=\"dielectric\"/>"));
  const Vec3f above = normalize({0.3f, 0, 1});
  double scale[2] = {0, 0};
  for (const auto mode : {TransportMode::radiance, TransportMode::flux})
    for (uint32_t i = 0; i < 200; ++i) {
      Sampler sampler(10, i);
      const Vec2f u = sampler.next_2d();
      const BsdfSample sample =
          vertex_seen_from(*scene, above, mode).sample(u.x, sampler.next_2d(), Lobes::all);
      if (sample.transmission) scale[mode == TransportMode::flux] = double(sample.weight[0]);
    }
  ASSERT_GT(scale[1], 0);
  EXPECT_NEAR(scale[0] / scale[1], 1 / std::pow(1.5046 / 1.000277, 2), 1e-3);
}

TEST(ChooseLobes, FollowsTheAlbedos) {
  const auto scene = scene_of(flat(mixed_phong));
  const SurfaceVertex vertex =
      vertex_seen_from(*scene, normalize({0.2f, 0, 1}), TransportMode::radiance);
  const float probability = diffuse_probability(vertex);
  EXPECT_GT(probability, 0.3f);
  EXPECT_LT(probability, 0.9f);
  constexpr int count = 20000;
  int diffuse = 0;
  RunningStatistics rest;
  for (int i = 0; i < count; ++i) {
    float u = (float(i) + 0.5f) / count;
    const LobeChoice choice = choose_lobes(vertex, u);
    diffuse += choice.lobes == Lobes::diffuse ? 1 : 0;
    EXPECT_FLOAT_EQ(choice.probability,
                    choice.lobes == Lobes::diffuse ? probability : 1 - probability);
    EXPECT_GE(u, 0);
    EXPECT_LT(u, 1);
    rest.add(double(u));
  }
  EXPECT_NEAR(double(diffuse) / count, probability, 1e-3);
  EXPECT_NEAR(rest.mean(), 0.5, 1e-3);  // what is left of the number is uniform again
  EXPECT_NEAR(rest.variance(), 1.0 / 12, 1e-3);
  EXPECT_EQ(diffuse_probability(vertex_seen_from(*scene_of(flat("<bsdf type=\"diffuse\"/>")),
                                                 {0, 0, 1}, TransportMode::radiance)),
            1);
  EXPECT_EQ(diffuse_probability(vertex_seen_from(*scene_of(flat("<bsdf type=\"conductor\"/>")),
                                                 {0, 0, 1}, TransportMode::radiance)),
            0);
}

/// Irradiance at the origin by sampled direct light, over the closed form for a disk of radius 0.5
/// at height 1: π L sin².
TEST(DirectLight, IrradianceOfADisk) {
  const auto scene =
      scene_of(flat("") +
               "<shape type=\"disk\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
               "<rotate x=\"1\" angle=\"180\"/><translate z=\"1\"/></transform>"
               "<emitter type=\"area\"><rgb name=\"radiance\" value=\"3\"/></emitter></shape>");
  const SurfaceVertex vertex =
      vertex_seen_from(*scene, normalize({3, 0, 1}), TransportMode::radiance);
  RunningStatistics irradiance;
  for (uint32_t i = 0; i < 20000; ++i) {
    Sampler sampler(hash_mix(11, i), 0);
    DirectLight light;
    ASSERT_TRUE(sample_direct_light(*scene, vertex, sampler, light));
    EXPECT_FALSE(scene->occluded(light.shadow_ray));
    irradiance.add(double(light.radiance[0]) * double(light.wi.z));
    if (i % 100 == 0) {
      Hit hit;
      const Ray ray = spawn_ray(vertex.point(), light.wi);
      ASSERT_TRUE(scene->intersect(ray, hit));
      EXPECT_NEAR(direct_light_pdf(*scene, light_query(vertex), LightChoice::one, 0,
                                   scene->tracer().surface_point(ray, hit)),
                  light.pdf_solid_angle, 1e-3f * light.pdf_solid_angle);
    }
  }
  const double expected = std::numbers::pi * 3 * 0.25 / 1.25;
  EXPECT_LT(irradiance.standard_error(), 0.003 * expected);
  EXPECT_GT(z_test_p_value(irradiance, expected), 1e-3);
  EXPECT_LT(z_test_p_value(irradiance, 1.02 * expected), 1e-3);
}

/// Every light sampled, over the sum of closed forms: a disk of radius 0.5 at height 1 (π L sin²)
/// and a point light at height 2 (I/h²). More samples go to the light that brings more, every light
/// has one at least, and the mean stays.
TEST(DirectLight, IrradianceByEveryLight) {
  const auto scene =
      scene_of(flat("") +
               "<shape type=\"disk\"><transform name=\"to_world\"><scale value=\"0.5\"/>"
               "<rotate x=\"1\" angle=\"180\"/><translate z=\"1\"/></transform>"
               "<emitter type=\"area\"><rgb name=\"radiance\" value=\"3\"/></emitter></shape>"
               "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"2\"/>"
               "<rgb name=\"intensity\" value=\"0.2\"/></emitter>");
  const SurfaceVertex vertex =
      vertex_seen_from(*scene, normalize({3, 0, 1}), TransportMode::radiance);
  const double disk = std::numbers::pi * 3 * 0.25 / 1.25, point = 0.2 / 4;
  std::vector<double> variances;
  for (const int samples : {1, 8}) {
    RunningStatistics irradiance;
    int taken = 0, of_disk = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
      Sampler sampler(hash_mix(12, i), 0);
      irradiance.add(sample_direct_lights<double>(
          *scene, vertex, {LightChoice::all, samples}, sampler,
          [&](const DirectLight& light, ShadowAnswer&) {
            ++taken;
            of_disk += light.light == 0;
            return double(light.radiance[0]) * double(light.light == 1 ? 1.0f : light.wi.z);
          }));
    }
    const LightShares shares(*scene, vertex, samples);
    const std::vector<int> counts{shares.samples_of(0), shares.samples_of(1)};
    EXPECT_EQ(counts, (samples == 1 ? std::vector<int>{1, 1} : std::vector<int>{8, 1}));
    EXPECT_EQ(taken, 20000 * (counts[0] + counts[1]));
    EXPECT_GE(of_disk, taken / 2);
    EXPECT_LT(irradiance.standard_error(), 0.003 * (disk + point));
    EXPECT_GT(z_test_p_value(irradiance, disk + point), 1e-3) << samples;
    EXPECT_LT(z_test_p_value(irradiance, 1.02 * (disk + point)), 1e-3) << samples;
    variances.push_back(irradiance.variance());
  }
  EXPECT_LT(variances[1], 0.5 * variances[0]);
}

TEST(DirectLight, MisWeightsSumToOne) {
  for (const float a : {0.0f, 1e-3f, 1.0f, 50.0f})
    for (const float b : {1e-3f, 1.0f, 700.0f})
      EXPECT_FLOAT_EQ(mis_weight(a, b) + mis_weight(b, a), 1);
  EXPECT_EQ(mis_weight(0, 0), 0);
}

}  // namespace
}  // namespace kaustik
