// A medium at four wavelengths, against the law of Beer and Lambert.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kaustik/base/statistics.h"
#include "kaustik/medium/medium_kinds.h"

namespace kaustik {
namespace {

const Wavelengths four(440, 500, 580, 660);
/// 0 at 400 nm, 1 at 800 nm.
const SpectralCurve ramp{{{400, 0}, {800, 1}}};
const Spectrum ramp_lanes(0.1f, 0.25f, 0.45f, 0.65f);

std::shared_ptr<const Medium> make_medium(const MediumType& type,
                                          const std::vector<Property>& properties) {
  Problems problems;
  const Arguments arguments(type.info, properties, {}, problems);
  problems.throw_if_any();
  return type.create({arguments, isotropic_phase_function()});
}

std::shared_ptr<const Medium> make_homogeneous(const std::vector<Property>& properties) {
  return make_medium(homogeneous_type(), properties);
}

std::shared_ptr<const Medium> haze() {
  return make_homogeneous(
      {{"sigma_t", Value(ramp), {}}, {"albedo", Value(0.5), {}}, {"scale", Value(2.0), {}}});
}

/// With a place of its own for density and for the albedo.
std::shared_ptr<const Medium> patchy_cloud() {
  using Filter = GridVolume::Filter;
  using Wrap = GridVolume::Wrap;
  const auto volume = [](const VolumeSamples& samples) {
    return std::make_shared<const Volume>(GridVolume(samples, Filter::trilinear, Wrap::clamp,
                                                     Transform::translate({-0.4, -0.5, 0.1})));
  };
  Problems problems;
  const Arguments arguments(heterogeneous_type().info, {}, {}, problems);
  return heterogeneous_type().create(
      {.arguments = arguments,
       .phase = isotropic_phase_function(),
       .volumes = {
           {"sigma_t", {volume({{2, 1, 3}, 1, {0.1f, 0.2f, 3, 1, 0.5f, 2}, {}}), {}}},
           {"albedo", {volume({{1, 1, 2}, 3, {0.9f, 0.5f, 0.3f, 0.2f, 1, 0.1f}, {}}), {}}}}});
}

/// Of each row one with its usual values; and haze.
std::vector<std::shared_ptr<const Medium>> media_of_all_types() {
  std::vector<std::shared_ptr<const Medium>> media = {haze(), patchy_cloud()};
  for (const MediumType& type : medium_types()) media.push_back(make_medium(type, {}));
  return media;
}

MediumSegment of_length(float length) { return {{0, 0, 0}, {0, 0, 1}, length}; }

void expect_lanes(const Spectrum& found, const Spectrum& expected) {
  for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(found[lane], expected[lane], 1e-6f) << lane;
}

TEST(medium_wavelengths, coefficients_stay_curves) {
  const auto medium = haze();
  expect_lanes(medium->extinction({}, four), ramp_lanes * 2);
  expect_lanes(medium->scattering({}, four), ramp_lanes);
  EXPECT_NE(medium->extinction({}, {}), medium->extinction({}, four));
  const auto by_parts =
      make_homogeneous({{"sigma_s", Value(ramp), {}}, {"sigma_a", Value(0.5), {}}});
  expect_lanes(by_parts->extinction({}, four), ramp_lanes + Spectrum(0.5f));
  expect_lanes(by_parts->scattering({}, four), ramp_lanes);
  // What densities are counted by does not follow the wavelengths.
  EXPECT_FLOAT_EQ(medium->mean_extinction({}), medium->extinction({}, {}).sum() / 4);
}

TEST(medium_wavelengths, transmittance_follows_the_curve) {
  Sampler sampler(1, 2);
  const Spectrum left = haze()->transmittance(of_length(1.5f), four, sampler);
  expect_lanes(left, exp(ramp_lanes * -3.0f));
}

TEST(medium_wavelengths, flights_have_the_right_weights_in_every_lane) {
  const auto medium = haze();
  constexpr int count = 20000;
  std::array<RunningStatistics, 4> scattered, passed, collided;
  const Spectrum shares(1, 0.5f, 0.2f, 1);
  for (int i = 0; i < count; ++i) {
    Sampler sampler(7, uint32_t(i));
    const Medium::Flight flight = medium->sample_flight(of_length(1.5f), shares, four, sampler);
    const Medium::Flight collision =
        medium->sample_collision(of_length(1.5f), shares, four, sampler);
    for (int lane = 0; lane < 4; ++lane) {
      scattered[size_t(lane)].add(flight.scattered ? double(flight.weight[lane]) : 0.0);
      passed[size_t(lane)].add(flight.scattered ? 0.0 : double(flight.weight[lane]));
      collided[size_t(lane)].add(double(collision.weight[lane]));
    }
  }
  for (int lane = 0; lane < 4; ++lane) {
    const double left = std::exp(-3.0 * double(ramp_lanes[lane])), gone = 0.5 * (1 - left);
    const size_t i = size_t(lane);
    // The numbers are stratified: much better than by their standard errors.
    EXPECT_NEAR(passed[i].mean(), left, 1e-3) << lane;
    EXPECT_NEAR(scattered[i].mean(), gone, 1e-3) << lane;
    EXPECT_NEAR(collided[i].mean(), gone, 1e-3) << lane;
    EXPECT_GT(std::fabs(passed[i].mean() - std::exp(-3.0 * 1.03 * double(ramp_lanes[lane]))), 1e-3);
  }
}

/// Chance that values with the mean zero have a mean as far from it (Student's t, two-sided).
double chance_of_zero(const RunningStatistics& values) {
  if (values.mean() == 0) return 1;
  const double t = std::fabs(values.mean()) / values.standard_error();
  return 2 * student_t_cdf(-t, double(values.count() - 1));
}

// What all media promise, whatever they are made of: light passes as flights pass, and is scattered
// as if it were sure to be. An error of 1 % of either would be found. The numbers of one run are
// stratified, so each run counts as one value.
TEST(medium_wavelengths, flights_agree_with_transmittances_in_all_media) {
  constexpr int runs = 16, flights = 4096;
  const Spectrum shares(1, 0.5f, 0.2f, 1);
  const auto media = media_of_all_types();
  const double level = sidak_level(1e-4, int(media.size()) * 8);
  for (const auto& medium : media) {
    ASSERT_NE(medium, nullptr);
    const MediumSegment segment = of_length(0.8f);
    std::array<RunningStatistics, 4> passed_too_much, scattered_too_much, passed_wrong,
        scattered_wrong;
    for (int run = 0; run < runs; ++run) {
      std::array<RunningStatistics, 4> left, passed, scattered, collided;
      for (int i = 0; i < flights; ++i) {
        Sampler sampler{uint64_t(run), uint32_t(i)};
        const Spectrum transmittance = medium->transmittance(segment, four, sampler);
        const Medium::Flight flight = medium->sample_flight(segment, shares, four, sampler);
        const Medium::Flight collision = medium->sample_collision(segment, shares, four, sampler);
        EXPECT_EQ(collision.scattered, medium->scatters());
        for (size_t lane = 0; lane < 4; ++lane) {
          const double weight = double(flight.weight[int(lane)]);
          left[lane].add(double(transmittance[int(lane)]));
          passed[lane].add(flight.scattered ? 0 : weight);
          scattered[lane].add(flight.scattered ? weight : 0);
          collided[lane].add(double(collision.weight[int(lane)]));
        }
      }
      for (size_t lane = 0; lane < 4; ++lane) {
        passed_too_much[lane].add(passed[lane].mean() - left[lane].mean());
        scattered_too_much[lane].add(scattered[lane].mean() - collided[lane].mean());
        passed_wrong[lane].add(passed[lane].mean() - 1.01 * left[lane].mean());
        scattered_wrong[lane].add(scattered[lane].mean() - 1.01 * collided[lane].mean());
      }
    }
    for (size_t lane = 0; lane < 4; ++lane) {
      EXPECT_GT(chance_of_zero(passed_too_much[lane]), level) << lane;
      EXPECT_GT(chance_of_zero(scattered_too_much[lane]), level) << lane;
      EXPECT_LT(chance_of_zero(passed_wrong[lane]), level) << lane;
      if (medium->scatters()) {
        EXPECT_LT(chance_of_zero(scattered_wrong[lane]), level) << lane;
      }
    }
  }
}

TEST(medium_wavelengths, flights_take_one_pair_of_numbers_and_transmittances_none) {
  for (const auto& medium : media_of_all_types()) {
    Sampler sampler(3, 4), same(3, 4);
    medium->transmittance(of_length(1), four, sampler);
    medium->sample_flight(of_length(1), Spectrum(1), four, sampler);
    medium->sample_collision(of_length(1), Spectrum(1), {}, sampler);
    same.skip_pair(), same.skip_pair();
    EXPECT_EQ(sampler.next_2d(), same.next_2d());
  }
}

TEST(medium_wavelengths, media_of_one_colour_may_differ) {
  const auto medium = haze();
  EXPECT_TRUE(medium->is_like(*haze()));
  for (const auto& one : media_of_all_types()) EXPECT_TRUE(one->is_like(*one));
  const Spectrum rgb = medium->extinction({}, {});
  const auto metamer =
      make_homogeneous({{"sigma_t", Value(Rgb{double(rgb[0]), double(rgb[1]), double(rgb[2])}), {}},
                        {"albedo", Value(0.5), {}}});
  EXPECT_FALSE(medium->is_like(*metamer));
}

TEST(medium_wavelengths, what_does_nothing_is_vacuum) {
  EXPECT_EQ(make_homogeneous({{"sigma_t", Value(0.0), {}}}), nullptr);
}

}  // namespace
}  // namespace kaustik
