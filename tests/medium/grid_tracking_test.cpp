// Flights and transmittances by looks at few places, against integrals that are known.

#include "kaustik/medium/grid_tracking.h"

#include <gtest/gtest.h>

#include <array>

#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int tracked_count = 20'000;
constexpr double planted_tracking_error = 0.1;
#else
constexpr int tracked_count = 200'000;
constexpr double planted_tracking_error = 0.03;
#endif
constexpr double tracked_level = 1e-4;

/// Random densities up to 1 in 64 cells along each axis, a third of them 0.
const GridVolume& rough_grid() {
  static const GridVolume grid = [] {
    VolumeSamples samples{{64, 64, 64}, 1, {}, {}};
    for (uint64_t i = 0; i < 64 * 64 * 64; ++i)
      samples.values.push_back(std::max(0.0f, Sampler(hash_mix(81, i), 0).next_1d() * 1.5f - 0.5f));
    return GridVolume(samples, GridVolume::Filter::trilinear, GridVolume::Wrap::clamp, Transform());
  }();
  return grid;
}

const Vec3f from(-0.2f, 0.1f, 0.3f), along = normalize(Vec3f(1, 0.5f, 0.2f));
constexpr float to = 1.3f;
GridCrossing crossing_of_all() { return {rough_grid(), from, along, to}; }
double integral_to(float end) { return double(rough_grid().integral(from, along, 0, end)); }

/// Thin enough for looks everywhere; for cells everywhere; and both; with lanes that differ, one
/// of which nothing is taken from.
const std::array<Spectrum, 5> extinctions = {Spectrum(0.5f), Spectrum(20), Spectrum(100),
                                             Spectrum(4, 1, 0, 2), Spectrum(30, 90, 60, 45)};

Sampler numbers_of_try(uint64_t key, int i) { return {hash_mix(key, uint64_t(i)), 0}; }

TEST(GridTracking, TransmittancesHaveTheirMeans) {
  for (const Spectrum& extinction : extinctions) {
    std::array<RunningStatistics, 4> lanes;
    for (int i = 0; i < tracked_count; ++i) {
      const Spectrum left =
          tracked_transmittance(crossing_of_all(), extinction, numbers_of_try(82, i));
      for (int lane = 0; lane < 4; ++lane) {
        ASSERT_GE(left[lane], 0);
        ASSERT_LE(left[lane], 1.0001f);
        lanes[size_t(lane)].add(double(left[lane]));
      }
    }
    for (int lane = 0; lane < 4; ++lane) {
      const double expected = std::exp(-double(extinction[lane]) * integral_to(to));
      const RunningStatistics& found = lanes[size_t(lane)];
      if (expected < 1e-4) continue;  // too rare to say much
      EXPECT_GT(z_test_p_value(found, expected), tracked_level)
          << extinction[lane] << ": " << found.mean() << " +- " << found.standard_error() << " for "
          << expected;
      if (found.standard_error() > 0.005 * expected) continue;
      EXPECT_LT(z_test_p_value(found, expected * (1 + planted_tracking_error)), tracked_level);
    }
  }
}

/// Light of a lane collides where its own extinction says, whichever lanes there are besides.
TEST(GridTracking, FlightsHaveTheirDensity) {
  constexpr int bins = 20;
  for (const Spectrum& extinction : extinctions)
    for (const int lane : {0, 1}) {
      std::vector<double> hits(bins + 1, 0.0), expected(bins + 1, 0.0);
      for (int i = 0; i < tracked_count; ++i) {
        Sampler numbers = numbers_of_try(83, i);
        const float depth = -std::log1p(-numbers.next_1d());
        const TrackedFlight flight =
            tracked_flight(crossing_of_all(), extinction, lane, depth, numbers);
        const float share = flight.distance / to;
        ASSERT_LE(share, 1);
        hits[size_t(flight.collided ? std::min(int(share * bins), bins - 1) : bins)] += 1;
      }
      const auto left = [&](int i) {
        return std::exp(-double(extinction[lane]) * integral_to(to * float(i) / bins));
      };
      for (int i = 0; i < bins; ++i) expected[size_t(i)] = tracked_count * (left(i) - left(i + 1));
      expected[bins] = tracked_count * left(bins);
      EXPECT_GT(chi_square_p_value(hits, expected), tracked_level) << extinction[lane];
      // A medium as much denser is told from this one.
      const double denser = double(extinction[lane]) * (1 + 2 * planted_tracking_error);
      const auto other = [&](int i) {
        return std::exp(-denser * integral_to(to * float(i) / bins));
      };
      for (int i = 0; i < bins; ++i)
        expected[size_t(i)] = tracked_count * (other(i) - other(i + 1));
      expected[bins] = tracked_count * other(bins);
      EXPECT_LT(chi_square_p_value(hits, expected), tracked_level) << extinction[lane];
    }
}

/// Flights of a lane that is chosen, weighed by all lanes together, bring each lane what it has
/// itself: at the end of the line, and in its collisions.
TEST(GridTracking, WeightsOfAllLanesHaveTheirMeans) {
  const Spectrum shares(0.4f, 0.3f, 0.1f, 0.2f);
  for (const Spectrum& extinction : extinctions) {
    std::array<RunningStatistics, 4> passed, collided;
    for (int i = 0; i < tracked_count; ++i) {
      Sampler numbers = numbers_of_try(84, i);
      const Vec2f u = numbers.next_2d();
      const int lane = u.x < 0.4f ? 0 : u.x < 0.7f ? 1 : u.x < 0.8f ? 2 : 3;
      const TrackedFlight flight =
          tracked_flight(crossing_of_all(), extinction, lane, -std::log1p(-u.y), numbers);
      const Spectrum density = shares * flight.left * (flight.collided ? extinction : Spectrum(1));
      const Spectrum weight =
          flight.left * (flight.collided ? extinction : Spectrum(1)) * (1 / density.sum());
      for (int k = 0; k < 4; ++k) {
        passed[size_t(k)].add(flight.collided ? 0 : double(weight[k]));
        collided[size_t(k)].add(flight.collided ? double(weight[k]) : 0);
      }
    }
    for (int k = 0; k < 4; ++k) {
      const double left = std::exp(-double(extinction[k]) * integral_to(to));
      if (left < 1e-3) {
        EXPECT_NEAR(collided[size_t(k)].mean(), 1, 2e-3) << extinction[k];
        continue;
      }
      EXPECT_GT(z_test_p_value(collided[size_t(k)], 1 - left), tracked_level) << extinction[k];
      EXPECT_GT(z_test_p_value(passed[size_t(k)], left), tracked_level) << extinction[k];
    }
  }
}

/// The box and nothing else takes light, and what a bound leaves open is looked at.
TEST(GridTracking, AnEvenGridHasNoNoise) {
  const GridVolume even({{40, 1, 1}, 1, std::vector<float>(40, 0.5f), {}},
                        GridVolume::Filter::trilinear, GridVolume::Wrap::clamp, Transform());
  for (int i = 0; i < 100; ++i) {
    const Spectrum left = tracked_transmittance({even, {-3, 0.5f, 0.5f}, {1, 0, 0}, infinity},
                                                Spectrum(2), numbers_of_try(85, i));
    EXPECT_NEAR(left[0], std::exp(-1.0), 1e-6);
    EXPECT_EQ(tracked_transmittance({even, {2, 0.5f, 0.5f}, {1, 0, 0}, infinity}, Spectrum(2),
                                    numbers_of_try(85, i)),
              Spectrum(1));
  }
}

}  // namespace
}  // namespace kaustik
