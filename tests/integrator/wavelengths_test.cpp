// Transport at four wavelengths: every lane has its closed form, and the film's edge its colour.

#include "kaustik/base/color.h"
#include "kaustik/base/spectral_value.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/transport/light_path.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const Wavelengths four(440, 500, 580, 660);

using Lanes = std::array<RunningStatistics, Spectrum::lane_count>;

/// What the pixels of some passes have in the mean, per pass and lane. Light that is splatted
/// becomes RGB as it is: this looks at camera samples alone.
Lanes measure(const Scene& scene, const Integrator& integrator, int samples,
              const Wavelengths& wavelengths = four) {
  Lanes result;
  const Vec2i size = scene.film().crop_size;
  for (uint32_t index = 0; index < measured_passes; ++index) {
    const Pass pass{5, index, uint32_t(samples), wavelengths};
    SplatBuffer splats(scene.film(), ComponentSet());
    const auto state = integrator.prepare(pass, splats, {}, {});
    Spectrum sum;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        for (int i = 0; i < samples; ++i) {
          Sampler sampler = Sampler::at(pass.seed, index, Stream::camera,
                                        uint64_t(y) * 1000 + uint64_t(x), uint32_t(i));
          const Vec2f u = sampler.next_2d();
          SampleSink sink(ComponentSet::all(), wavelengths);
          integrator.sample(*state, {float(x) + u.x, float(y) + u.y}, sampler, sink);
          for (int c = 0; c < component_count; ++c) sum += sink.radiance(Component(c));
        }
    for (int lane = 0; lane < Spectrum::lane_count; ++lane)
      result[size_t(lane)].add(double(sum[lane]) / (double(size.x) * size.y * samples));
  }
  return result;
}

std::string spectrum(const std::string& name, const std::string& samples) {
  return "<spectrum name=\"" + name + "\" value=\"" + samples + "\"/>";
}

/// A closed sphere that emits 1 everywhere and reflects ρ(λ), a ramp: L = 1/(1 − ρ).
std::string furnace(int size) {
  return camera("0.2, 0.1, -0.3", "1, 0.3, 0.2", 80, size) +
         sphere("0, 0, 0", 1,
                "<bsdf type=\"diffuse\">" + spectrum("reflectance", "400:0.1, 800:0.9") +
                    "</bsdf><emitter type=\"area\">" + spectrum("radiance", "400:1, 800:1") +
                    "</emitter>",
                true);
}
double reflectance_at(double nm) { return 0.1 + 0.8 * (nm - 400) / 400; }

void expect_furnace(const std::string& type, const std::string& parameters, int samples,
                    double tolerance) {
  const TestScene scene(furnace(8));
  const Lanes lanes = measure(scene.scene(), *scene.integrator(type, parameters), samples);
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const double expected = 1 / (1 - reflectance_at(double(four[lane])));
    expect_near_means(type + " lane " + std::to_string(lane),
                      Comparison(lanes[size_t(lane)], expected), tolerance);
  }
}

TEST(TransportWavelengths, PathFindsEveryLaneOfAFurnace) { expect_furnace("path", "", 64, 0.005); }
TEST(TransportWavelengths, PhotonMapFindsEveryLaneOfAFurnace) {
  expect_furnace(
      "photonmap",
      set("global_photons", 8000) + set("caustic_photons", 0) + set("global_neighbors", 12), 16,
      0.02);
}
TEST(TransportWavelengths, MergingFindsEveryLaneOfAFurnace) {
  expect_furnace("vcm", set("splats", false) + set("connections", false) + set("light_paths", 1.0),
                 64, 0.02);
}

// The mean over wavelengths of what the film's edge makes of lanes is the colour of the spectrum.
TEST(TransportWavelengths, TheFilmShowsTheColourOfTheSpectrum) {
  const TestScene scene(furnace(2));
  const auto path = scene.integrator("path");
  const auto state = path->prepare(
      {1, 0, 1, {}}, *std::make_unique<SplatBuffer>(scene.scene().film(), ComponentSet()), {}, {});
  constexpr uint32_t count = slow_build ? 4000 : 40000;
  std::array<RunningStatistics, 3> found;
  for (uint32_t i = 0; i < count; ++i) {
    Sampler sampler(17, i);
    const Vec2f u = sampler.next_2d();
    const Wavelengths wavelengths = Wavelengths::spaced(sampler.next_1d());
    SampleSink sink(ComponentSet::all(), wavelengths);
    path->sample(*state, u * 2.0f, sampler, sink);
    Spectrum sum;
    for (int c = 0; c < component_count; ++c) sum += sink.radiance(Component(c));
    const Spectrum rgb = rgb_from_lanes(sum, wavelengths);
    for (int channel = 0; channel < 3; ++channel) found[size_t(channel)].add(double(rgb[channel]));
  }
  SpectralCurve curve;
  for (int nm = 400; nm <= 800; ++nm)  // beyond these nothing shines
    curve.samples.emplace_back(nm, 1 / (1 - reflectance_at(nm)));
  const Rgb expected = rgb_from_emission(curve);
  const double channels[] = {expected.r, expected.g, expected.b};
  for (size_t channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(found[channel].mean(), channels[channel], 0.02 * channels[channel]) << channel;
  EXPECT_GT(channels[0], 1.5 * channels[2]);
}

/// Cauchy's formula, stronger than any glass.
class Cauchy final : public SpectralFunction {
 public:
  double at(double nm) const override { return 1.4 + 3e4 / (nm * nm); }
};

/// A scene whose glass spheres are replaced by some that disperse.
Scene dispersing(const std::string& inside) {
  const Description description = description_of(inside);
  Scene::Parts parts = SceneBuilder(int64_t(1) << 30).build(*description.scene);
  const auto white = make_constant_texture(SpectralValue(1.0f));
  for (Surface& surface : parts.surfaces)
    if (surface.traits.transmits) {
      surface.bsdf = make_dielectric(dispersive_ior(std::make_shared<Cauchy>()),
                                     SpectralValue(1.0f), white, white);
      surface.traits = surface.bsdf->traits();
    }
  return Scene(std::move(parts));
}

// Glass in white light from everywhere can't be seen, whatever its index: in no lane.
TEST(TransportWavelengths, GlassThatDispersesIsInvisibleInAFurnace) {
  const Scene scene = dispersing(camera("0, 0, 3", "0, 0, 0", 30, 8, "0, 1, 0") +
                                 sphere("0, 0, 0", 1, glass()) + "<emitter type=\"constant\">" +
                                 spectrum("radiance", "400:1, 800:1") + "</emitter>");
  std::vector<std::string> warnings;
  const auto path = make_integrator(description_of("<integrator type=\"path\"/>"), scene, warnings);
  const Lanes lanes = measure(scene, *path, 100);
  for (int lane = 0; lane < Spectrum::lane_count; ++lane)
    expect_mean("lane " + std::to_string(lane), lanes[size_t(lane)], 1);
}

// A prism: the lanes of one beam come out at places of their own, those of their indices.
TEST(TransportWavelengths, APrismSpreadsTheLanes) {
  const Scene scene =
      dispersing(camera("0, 0, 5", "0, 0, 0", 30, 4, "0, 1, 0") +
                 flat("rectangle", scale("5, 5, 1"), glass()) +
                 flat("rectangle", scale("50, 50, 1") + translate("0, 0, -1"), diffuse("0.5")));
  const Vec3f along = normalize(Vec3f(1, 0, -1));
  std::array<int, 4> seen{};
  const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
    return LightPath({{-1, 0, 1}, along, infinity}, Spectrum(1), nullptr, Lobes::specular,
                     Sampler(hash_mix(2, i), 0), four);
  };
  std::array<double, 4> energy{};
  constexpr uint32_t count = 20'000;
  trace_light_paths(scene, 0, count, {}, emit, [&](const LightVertex& at) {
    if (at.vertex.transmits()) return Lobes::all;
    for (int lane = 0; lane < 4; ++lane) {
      if (!at.state.wavelengths.is_alive(lane)) {
        EXPECT_EQ(at.state.throughput[lane], 0);
        continue;
      }
      ++seen[size_t(lane)];
      energy[size_t(lane)] += double(at.state.throughput[lane]) / count;
      const double sine = std::sqrt(0.5) / Cauchy().at(double(four[lane]));
      EXPECT_NEAR(at.vertex.position().x, sine / std::sqrt(1 - sine * sine), 1e-4);
    }
    EXPECT_EQ(at.state.wavelengths.alive_count(), 1);
    return Lobes::none;
  });
  for (int lane = 0; lane < 4; ++lane) {
    const float reflected =
        fresnel_dielectric(std::sqrt(0.5f), float(Cauchy().at(double(four[lane])))).reflectance;
    EXPECT_NEAR(seen[size_t(lane)], count * (1 - 0.1) / 4, 0.15 * count / 4) << lane;
    EXPECT_NEAR(energy[size_t(lane)], 1 - double(reflected), 0.06) << lane;
  }
}

/// Ambient light is a curve until it is asked for its lanes.
TEST(TransportWavelengths, AmbientLightIsACurve) {
  const TestScene scene(camera("0, 0, 2", "0, 0, 0", 20, 4, "0, 1, 0") +
                        flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  for (const char* type : {"localphong", "raytracing"}) {
    const auto integrator = scene.integrator(type, spectrum("ambient", "400:1, 800:3"));
    const Lanes lanes = measure(scene.scene(), *integrator, 1);
    for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
      const double expected = 0.5 * (1 + 2 * (double(four[lane]) - 400) / 400);
      EXPECT_NEAR(lanes[size_t(lane)].mean(), expected, 1e-4 * expected) << type << ' ' << lane;
    }
  }
}

}  // namespace
}  // namespace kaustik
