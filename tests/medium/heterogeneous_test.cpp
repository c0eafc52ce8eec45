// Flights through a density that varies, against closed forms and quadrature.

#include "kaustik/medium/heterogeneous.h"

#include <gtest/gtest.h>

#include <array>

#include "kaustik/base/statistics.h"
#include "kaustik/medium/medium_kinds.h"
#include "kaustik/medium/segment_transmittance.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int flight_count = 20'000;
constexpr double planted_flight_error = 0.1;
#else
constexpr int flight_count = 200'000;
constexpr double planted_flight_error = 0.03;
#endif
constexpr double flight_level = 1e-4;

using Filter = GridVolume::Filter;
using Wrap = GridVolume::Wrap;
using VolumePointer = std::shared_ptr<const Volume>;

VolumePointer grid_of(const VolumeSamples& samples, Filter filter = Filter::trilinear,
                      const Transform& placed = Transform()) {
  return std::make_shared<const Volume>(GridVolume(samples, filter, Wrap::clamp, placed));
}
VolumePointer constant(double value) {
  return std::make_shared<const Volume>(Volume::Color(Rgb{value, value, value}));
}
/// From 1 to 5 along x: between the middles of the cells at the ends the density is 1 + 4 x.
VolumeSamples ramp_samples() {
  VolumeSamples samples{{32, 1, 1}, 1, {}, {}};
  for (int x = 0; x < 32; ++x) samples.values.push_back(1 + 4 * (float(x) + 0.5f) / 32);
  return samples;
}

std::shared_ptr<const Medium> make(
    const MediumType& type, const std::vector<Property>& properties,
    const std::vector<std::pair<std::string, VolumePointer>>& given) {
  Problems problems;
  const Arguments arguments(type.info, properties, {}, problems);
  problems.throw_if_any();
  MediumInputs inputs{.arguments = arguments, .phase = isotropic_phase_function()};
  for (const auto& [name, volume] : given) inputs.volumes[name] = {volume, place_in(name)};
  return type.create(inputs);
}
std::shared_ptr<const Medium> cloud(const std::vector<std::pair<std::string, VolumePointer>>& given,
                                    double scale = 1, double albedo = 0.75) {
  std::vector<Property> properties = {{"scale", Value(scale), {}}};
  if (albedo != 0.75) properties.push_back({"albedo", Value(albedo), {}});
  return make(heterogeneous_type(), properties, given);
}

const MediumSegment across{{0.1f, 0.5f, 0.5f}, {1, 0, 0}, 0.8f};
constexpr double scale = 0.7;
/// Of the ramp: ∫ scale (1 + 4 x) dx from 0.1 on.
double ramp_depth(double distance) {
  const double x = 0.1 + distance;
  return scale * (x - 0.1 + 2 * (x * x - 0.01));
}

/// What is left in lane 1, as for many points of the segment.
float measured_left(const Medium& medium, const MediumSegment& whole, float distance) {
  const Wavelengths rgb;
  const Sampler sampler(1, 2);
  Scratch scratch;
  return SegmentTransmittance(medium, whole, rgb, sampler, scratch).to(distance)[1];
}

TEST(heterogeneous, a_linear_density_has_its_closed_form) {
  const auto medium = cloud({{"sigma_t", grid_of(ramp_samples())}}, scale);
  const Sampler sampler(1, 2);
  for (const float length : {0.0f, 0.01f, 0.3f, 0.8f}) {
    const double expected = std::exp(-ramp_depth(double(length)));
    const MediumSegment part{across.origin, across.direction, length};
    EXPECT_NEAR(medium->transmittance(part, {}, sampler)[1], expected, 2e-6);
    EXPECT_NEAR(measured_left(*medium, across, length), expected, 2e-6);
    RunningStatistics rough;
    for (int i = 0; i < flight_count / 10; ++i)
      rough.add(
          double(medium->rough_transmittance(part, {}, Sampler(hash_mix(30, uint64_t(i)), 0))[1]));
    EXPECT_GT(z_test_p_value(rough, expected), flight_level) << length;
    EXPECT_LT(z_test_p_value(rough, expected * (1 + planted_flight_error)), flight_level);
  }
  EXPECT_NEAR(medium->extinction({0.5f, 0.5f, 0.5f}, {})[0], scale * 3, 1e-5);
  EXPECT_NEAR(medium->scattering({0.5f, 0.5f, 0.5f}, {})[0], 0.75 * scale * 3, 1e-5);
  EXPECT_EQ(medium->extinction({1.5f, 0.5f, 0.5f}, {}), Spectrum(0));
  EXPECT_GT(medium->mean_extinction({1.5f, 0.5f, 0.5f}), 0);
  // Outside it is clear, however far light goes.
  EXPECT_EQ(medium->transmittance({{2, 0.5f, 0.5f}, {1, 0, 0}, infinity}, {}, sampler),
            Spectrum(1));
}

TEST(heterogeneous, flights_have_their_density) {
  const auto medium = cloud({{"sigma_t", grid_of(ramp_samples())}}, scale);
  constexpr int cells = 20;
  for (const bool surely : {false, true}) {
    std::vector<double> hits(cells, 0.0), expected(cells, 0.0);
    double scattered = 0;
    RunningStatistics passed, weights;
    for (int i = 0; i < flight_count; ++i) {
      Sampler sampler(hash_mix(31, uint64_t(i)), 0);
      const Medium::Flight flight = surely
                                        ? medium->sample_collision(across, Spectrum(1), {}, sampler)
                                        : medium->sample_flight(across, Spectrum(1), {}, sampler);
      ASSERT_LE(flight.distance, across.length);
      passed.add(flight.scattered ? 0 : double(flight.weight[0]));
      weights.add(flight.scattered ? double(flight.weight[0]) : 0);
      if (!flight.scattered) continue;
      scattered += 1;
      hits[size_t(std::min(int(flight.distance / across.length * cells), cells - 1))] += 1;
    }
    const double end = std::exp(-ramp_depth(0.8));
    const auto left = [&](int i) { return std::exp(-ramp_depth(0.8 * i / cells)); };
    for (int i = 0; i < cells; ++i)
      expected[size_t(i)] = scattered * (left(i) - left(i + 1)) / (1 - end);
    EXPECT_GT(chi_square_p_value(hits, expected), flight_level);
    for (size_t i = 0; i < cells; ++i)
      expected[i] *= i % 2 ? 1 + planted_flight_error : 1 - planted_flight_error;
    EXPECT_LT(chi_square_p_value(hits, expected), flight_level);
    if (surely) {
      EXPECT_EQ(scattered, flight_count);
      EXPECT_NEAR(weights.mean(), 0.75 * (1 - end), 1e-5);
    } else {
      EXPECT_GT(z_test_p_value(weights, 0.75 * (1 - end)), flight_level);
      EXPECT_GT(z_test_p_value(passed, end), flight_level);
    }
  }
}

/// Of three lanes at once, with an albedo that varies: the means of the weights are what the
/// medium scatters, by quadrature.
TEST(heterogeneous, weights_hold_the_albedo_of_the_place) {
  const VolumeSamples albedos{{2, 1, 1}, 3, {0.9f, 0.2f, 0, 0.1f, 0.8f, 1}, {}};
  const auto medium =
      cloud({{"sigma_t", grid_of(ramp_samples())}, {"albedo", grid_of(albedos)}}, scale);
  const Spectrum shares(0.2f, 1, 0.5f, 0);
  std::array<RunningStatistics, 3> flown, collided;
  for (int i = 0; i < flight_count; ++i) {
    Sampler sampler(hash_mix(32, uint64_t(i)), 0);
    const Medium::Flight flight = medium->sample_flight(across, shares, {}, sampler);
    const Medium::Flight collision = medium->sample_collision(across, shares, {}, sampler);
    for (int lane = 0; lane < 3; ++lane) {
      flown[size_t(lane)].add(flight.scattered ? double(flight.weight[lane]) : 0);
      collided[size_t(lane)].add(double(collision.weight[lane]));
    }
  }
  for (int lane = 0; lane < 3; ++lane) {
    double expected = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
      const double s = 0.8 * (i + 0.5) / steps, x = 0.1 + s;
      const double share = std::clamp(2 * x - 0.5, 0.0, 1.0);
      const double albedo = (1 - share) * double(albedos.values[size_t(lane)]) +
                            share * double(albedos.values[size_t(lane) + 3]);
      expected += 0.8 / steps * albedo * scale * (1 + 4 * x) * std::exp(-ramp_depth(s));
    }
    for (const RunningStatistics& found : {flown[size_t(lane)], collided[size_t(lane)]}) {
      EXPECT_GT(z_test_p_value(found, expected), flight_level) << lane;
      EXPECT_LT(z_test_p_value(found, expected * (1 + planted_flight_error)), flight_level) << lane;
    }
  }
}

/// A grid of one value is what a homogeneous medium is, number by number.
TEST(heterogeneous, a_constant_grid_is_homogeneous) {
  const HomogeneousMedium same{SpectralValue(2.0f), SpectralValue(1.5f)};
  for (const Filter filter : {Filter::trilinear, Filter::nearest})
    for (const auto& medium :
         {cloud({{"sigma_t", grid_of({{3, 2, 1}, 1, std::vector<float>(6, 4), {}}, filter)}}, 0.5),
          cloud({{"sigma_t", constant(4)}}, 0.5)})
      for (int i = 0; i < 500; ++i) {
        Sampler a(41, uint32_t(i)), b(41, uint32_t(i));
        const Medium::Flight one = medium->sample_flight(across, Spectrum(1), {}, a);
        const Medium::Flight other = same.sample_flight(across, Spectrum(1), {}, b);
        ASSERT_EQ(one.scattered, other.scattered);
        EXPECT_NEAR(one.distance, other.distance, 1e-6f);
        EXPECT_NEAR(one.weight[0], other.weight[0], 1e-5f);
        const Medium::Flight sure = medium->sample_collision(across, Spectrum(1), {}, a);
        const Medium::Flight as_sure = same.sample_collision(across, Spectrum(1), {}, b);
        EXPECT_NEAR(sure.distance, as_sure.distance, 2e-6f);
        EXPECT_NEAR(sure.weight[0], as_sure.weight[0], 1e-5f);
      }
}

TEST(heterogeneous, transmittances_to_many_points_are_those_to_each) {
  const auto medium = cloud({{"sigma_t", grid_of(ramp_samples())}}, scale);
  const MediumSegment whole{{-0.3f, 0.2f, 0.1f}, normalize(Vec3f(1, 0.3f, 0.4f)), 2};
  const Sampler sampler(1, 2);
  const Wavelengths rgb;
  Scratch scratch;
  SegmentTransmittance left(*medium, whole, rgb, sampler, scratch);
  for (int i = 0; i <= 100; ++i) {
    const float distance = float(i) / 50;
    const MediumSegment part{whole.origin, whole.direction, distance};
    EXPECT_NEAR(left.to(distance)[1], measured_left(*medium, part, distance), 2e-6f);
  }
}

TEST(heterogeneous, is_known_again) {
  const VolumePointer one = grid_of(ramp_samples()), other = grid_of(ramp_samples());
  const auto medium = cloud({{"sigma_t", one}}, scale);
  EXPECT_TRUE(medium->is_like(*cloud({{"sigma_t", one}}, scale)));
  EXPECT_FALSE(medium->is_like(*cloud({{"sigma_t", other}}, scale)));
  EXPECT_FALSE(medium->is_like(*cloud({{"sigma_t", one}}, 2 * scale)));
  EXPECT_FALSE(medium->is_like(*cloud({{"sigma_t", one}}, scale, 0.5)));
}

TEST(heterogeneous, a_homogeneous_medium_may_have_an_albedo_that_varies) {
  const VolumePointer albedo = grid_of({{2, 1, 1}, 1, {0.25f, 0.75f}, {}});
  const auto medium = make(homogeneous_type(), {{"sigma_t", Value(2.0), {}}}, {{"albedo", albedo}});
  EXPECT_FLOAT_EQ(medium->scattering({0.5f, 0, 0}, {})[0], 1);
  EXPECT_FLOAT_EQ(medium->scattering({9, 0, 0}, {})[0], 1.5f);
  EXPECT_FLOAT_EQ(medium->extinction({9, 0, 0}, {})[0], 2);
  const auto constants =
      make(homogeneous_type(), {}, {{"sigma_t", constant(3)}, {"albedo", constant(0.5)}});
  EXPECT_FLOAT_EQ(constants->scattering({}, {})[0], 1.5f);
}

TEST(heterogeneous, one_colour_times_a_density_is_taken_apart) {
  const auto medium =
      cloud({{"sigma_t", grid_of({{2, 1, 1}, 3, {0.4f, 0.8f, 1.6f, 0.1f, 0.2f, 0.4f}, {}})}}, 2);
  const Spectrum sigma = medium->extinction({0.25f, 0.5f, 0.5f}, {});
  EXPECT_NEAR(sigma[0], 0.8f, 1e-5f);
  EXPECT_NEAR(sigma[1], 1.6f, 1e-5f);
  EXPECT_NEAR(sigma[2], 3.2f, 1e-5f);
}

TEST(heterogeneous, what_does_nothing_is_vacuum) {
  EXPECT_EQ(cloud({{"sigma_t", grid_of({{1, 1, 1}, 1, {0}, {}})}}), nullptr);
  EXPECT_EQ(cloud({{"sigma_t", grid_of({{1, 1, 1}, 3, {0, 0, 0}, {}})}}), nullptr);
  EXPECT_EQ(cloud({{"sigma_t", grid_of(ramp_samples())}}, 0), nullptr);
  EXPECT_FALSE(cloud({{"albedo", grid_of({{1, 1, 1}, 1, {0}, {}})}})->scatters());
}

TEST(heterogeneous, says_what_is_wrong_with_its_grids) {
  const auto expect = [](const std::string& name, const VolumeSamples& samples,
                         const std::string& message, double scale_of_it = 1) {
    try {
      cloud({{name, grid_of(samples)}}, scale_of_it);
      ADD_FAILURE() << "no error: " << message;
    } catch (const Error& error) {
      const Problem& problem = error.problems().front();
      EXPECT_NE(problem.message.find(message), std::string::npos) << problem.message;
      EXPECT_FALSE(problem.remedy.empty());
    }
  };
  expect("sigma_t", {{2, 1, 1}, 1, {1, -0.5f}, {}}, "-0.5");
  expect("sigma_t", {{2, 1, 1}, 3, {1, 1, 1, 0, 1, 1}, {}}, "differ");
  expect("sigma_t", {{1, 1, 1}, 6, {1, 1, 1, 1, 1, 1}, {}}, "6 channels");
  expect("sigma_t", {{1, 1, 1}, 1, {1e-35f}, {}}, "1e-35");
  expect("sigma_t", {{1, 1, 1}, 1, {1e20f}, {}}, "too large");
  expect("albedo", {{2, 1, 1}, 1, {1, 1.5f}, {}}, "1.5");
  expect("albedo", {{2, 1, 1}, 1, {1, -0.25f}, {}}, "-0.25");
  expect("albedo", {{1, 1, 1}, 6, {1, 1, 1, 1, 1, 1}, {}}, "6 channels");
  EXPECT_THROW(make(homogeneous_type(), {}, {{"sigma_t", grid_of(ramp_samples())}}), Error);
  EXPECT_THROW(cloud({{"albedo", constant(2)}}), Error);
  EXPECT_THROW(cloud({{"albedo", constant(0.5)}}, 1, 0.25), Error);
}

}  // namespace
}  // namespace kaustik
