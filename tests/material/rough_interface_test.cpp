// A rough boundary whose index differs from lane to lane, against such boundaries of one index.
#include "kaustik/material/rough_interface.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/material/fresnel.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

const Wavelengths lanes_nm(440, 500, 580, 660);

/// Much more than glass has, so that lanes part.
class SteepIndex final : public SpectralFunction {
 public:
  double at(double nm) const override { return 1.3 + 8e4 / (nm * nm); }
};

RoughFacets frosted(float alpha = 0.15f) {
  const auto texture = make_constant_texture(SpectralValue(alpha));
  return {RoughFacets::Kind::ggx, texture, texture};
}
RoughInterface dispersive() {
  return {frosted(), dispersive_ior(std::make_shared<SteepIndex>()), SpectralValue(1.0f)};
}
RoughInterface of_lane(int lane) {
  return {frosted(), SpectralValue(float(SteepIndex().at(double(lanes_nm[lane])))),
          SpectralValue(1.0f)};
}

const InterfaceFactors factors{Spectrum(1), Spectrum(1)};

BsdfContext about(const Wavelengths& wavelengths) { return {{}, TransportMode::flux, wavelengths}; }

/// On both sides.
std::vector<Vec3f> both_sides_of_boundary() {
  std::vector<Vec3f> all;
  for (const Vec3f& w : outgoing_directions())
    for (const float side : {1.0f, -1.0f}) all.emplace_back(w.x, w.y, side * w.z);
  return all;
}

/// Directions that the boundary samples, and some others.
Vec3f direction_of(const RoughInterface& boundary, const Vec3f& wo, uint32_t i) {
  Sampler sampler(13, i);
  const float u_lobe = sampler.next_1d();
  const BsdfSample s = boundary.sample(about(lanes_nm), factors, wo, u_lobe, sampler.next_2d());
  if (s.event != Lobes::none) return s.wi;
  const float z = 2 * sampler.next_1d() - 1, phi = 2 * pi * u_lobe, r = safe_sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(dispersive_interface, each_lane_has_the_value_of_its_own_index) {
  const RoughInterface boundary = dispersive();
  std::vector<RoughInterface> single;
  for (int lane = 0; lane < 4; ++lane) single.push_back(of_lane(lane));
  int parted = 0;
  for (const Vec3f& wo : both_sides_of_boundary())
    for (uint32_t i = 0; i < 200; ++i) {
      const Vec3f wi = direction_of(boundary, wo, i);
      const BsdfValues values = boundary.values(about(lanes_nm), factors, wo, wi);
      float pdf = 0, pdf_reverse = 0;
      for (int lane = 0; lane < 4; ++lane) {
        const BsdfValues alone = single[size_t(lane)].values(about({}), factors, wo, wi);
        ASSERT_NEAR(values.glossy[lane], alone.glossy[0], 1e-4f * alone.glossy[0] + 1e-6f);
        pdf += alone.pdf / 4;
        pdf_reverse += alone.pdf_reverse / 4;
      }
      ASSERT_NEAR(values.pdf, pdf, 1e-4f * pdf + 1e-6f);
      ASSERT_NEAR(values.pdf_reverse, pdf_reverse, 1e-4f * pdf_reverse + 1e-6f);
      parted += values.glossy[0] > 2 * values.glossy[3];
    }
  EXPECT_GT(parted, 100);
}

TEST(dispersive_interface, samples_as_its_density_says) {
  const RoughInterface boundary = dispersive();
  for (const Vec3f& wo : {outgoing_directions()[1], -outgoing_directions()[1]}) {
    const DirectionGrid grid({wo.x, wo.y, std::fabs(wo.z)});
    const int count = quick.samples / 4;
    std::vector<double> observed(grid.size() + 1), expected, wrong;
    for (int i = 0; i < count; ++i) {
      Sampler sampler(hash_mix(17, uint64_t(i)), 0);
      const float u_lobe = sampler.next_1d();
      const BsdfSample s = boundary.sample(about(lanes_nm), factors, wo, u_lobe, sampler.next_2d());
      observed[s.event == Lobes::none ? grid.size() : grid.cell_of(s.wi)] += 1;
    }
    double total = 0;
    for (size_t cell = 0; cell < grid.size(); ++cell) {
      const double share =
          grid.integrate(cell,
                         [&](const Vec3f& wi) {
                           return Vec3d(boundary.values(about(lanes_nm), factors, wo, wi).pdf, 0,
                                        0);
                         })
              .x;
      expected.push_back(share * count);
      wrong.push_back(share * count *
                      (cell % 2 ? 1 + 2 * quick.planted_error : 1 - 2 * quick.planted_error));
      total += share;
    }
    expected.push_back(std::max(0.0, 1 - total) * count);
    wrong.push_back(expected.back());
    EXPECT_GT(chi_square_p_value(observed, expected), 1e-3);
    EXPECT_LT(chi_square_p_value(observed, wrong), 1e-3);
  }
}

// What each lane sends where it goes itself, with the weights that all get.
TEST(dispersive_interface, no_lane_gains_or_loses) {
  const RoughInterface boundary = dispersive();
  for (const Vec3f& wo : {outgoing_directions()[0], -outgoing_directions()[1]}) {
    RunningStatistics sums[4];
    for (int i = 0; i < quick.samples / 4; ++i) {
      Sampler sampler(hash_mix(19, uint64_t(i)), 0);
      const float u_lobe = sampler.next_1d();
      const BsdfSample s = boundary.sample(about(lanes_nm), factors, wo, u_lobe, sampler.next_2d());
      for (int lane = 0; lane < 4; ++lane) sums[lane].add(double(s.weight[lane]));
    }
    for (int lane = 0; lane < 4; ++lane) {
      const InterfaceAlbedo alone = of_lane(lane).albedo(about({}), wo);
      EXPECT_NEAR(sums[lane].mean(), alone.reflected + alone.transmitted,
                  5 * sums[lane].standard_error() + 0.01)
          << lane;
    }
  }
}

// A lane that carries no light any more neither draws directions nor counts.
TEST(dispersive_interface, dead_lanes_do_not_count) {
  const RoughInterface boundary = dispersive(), alone = of_lane(2);
  const Wavelengths one = lanes_nm.only(2);
  const Vec3f wo = outgoing_directions()[1];
  for (uint32_t i = 0; i < 200; ++i) {
    const Vec3f wi = direction_of(alone, wo, i);
    const BsdfValues values = boundary.values(about(one), factors, wo, wi),
                     expected = alone.values(about({}), factors, wo, wi);
    ASSERT_NEAR(values.pdf, expected.pdf, 1e-4f * expected.pdf + 1e-6f);
    ASSERT_NEAR(values.glossy[2], expected.glossy[0], 1e-4f * expected.glossy[0] + 1e-6f);
    for (const int dead : {0, 1, 3}) ASSERT_EQ(values.glossy[dead], 0);
  }
}

// Two coats that are alike share their tables: the second costs nothing.
TEST(interface_albedos, are_made_once_for_all_that_are_alike) {
  const auto one = InterfaceAlbedos::of(frosted(0.2f).range(), 1.5f);
  EXPECT_EQ(one, InterfaceAlbedos::of(frosted(0.2f).range(), 1.5f));
  EXPECT_NE(one, InterfaceAlbedos::of(frosted(0.2f).range(), 1.6f));
  EXPECT_NE(one, InterfaceAlbedos::of(frosted(0.21f).range(), 1.5f));
}

}  // namespace
}  // namespace kaustik
