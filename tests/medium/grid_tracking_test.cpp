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
constexpr int tracked_count = 100'000;
constexpr double planted_tracking_error = 0.03;
#endif
constexpr double tracked_level = 1e-4;

/// 96 × 32 × 32 densities in a box of that shape, 0.96 m long. On the left they differ little; on
/// the right they are 1 here and there, and 0 else: bounds that tell little.
const GridVolume& uneven_grid() {
  static const GridVolume grid = [] {
    VolumeSamples samples{{96, 32, 32}, 1, {}, {}};
    for (uint64_t i = 0; i < 96 * 32 * 32; ++i) {
      const float u = Sampler(hash_mix(81, i), 0).next_1d();
      samples.values.push_back(i % 96 < 48 ? 0.02f + 0.01f * u : u < 0.015f ? 1.0f : 0.0f);
    }
    return GridVolume(samples, GridVolume::Filter::trilinear, GridVolume::Wrap::clamp,
                      Transform::scale({0.96, 0.32, 0.32}));
  }();
  return grid;
}

const Vec3f tracked_from(-0.2f, 0.05f, 0.1f), tracked_along = normalize(Vec3f(1, 0.15f, 0.08f));
constexpr float tracked_to = 1.15f;
GridCrossing crossing_of_all() { return {uneven_grid(), tracked_from, tracked_along, tracked_to}; }
double integral_to(float end) {
  return double(uneven_grid().integral(tracked_from, tracked_along, 0, end));
}

/// Thin enough for looks everywhere; so dense that cells are followed on the right; that little is
/// left; and lanes that differ, one of which nothing is taken from.
const std::array<Spectrum, 5> tracked_extinctions = {Spectrum(2), Spectrum(60),
                                                     Spectrum(120, 90, 140, 100),
                                                     Spectrum(4, 1, 0, 2), Spectrum(30, 90, 0, 45)};

/// What the cases above are about.
TEST(GridTracking, HasPiecesOfBothKinds) {
  GridCrossing crossing = crossing_of_all();
  GridCrossing::Piece piece{};
  int known = 0, unknown = 0;
  while (crossing.next(piece)) {
    const float range = piece.largest - piece.least, length = piece.end - piece.begin;
    known += 60 * range * length < 0.1f;
    unknown += 60 * range * length > piece.cells / 3;
  }
  EXPECT_GT(known, 1);
  EXPECT_GT(unknown, 1);
  EXPECT_GT(integral_to(tracked_to), 0.01);
}

Sampler numbers_of_try(uint64_t key, int i) { return {hash_mix(key, uint64_t(i)), 0}; }

TEST(GridTracking, TransmittancesHaveTheirMeans) {
  for (const Spectrum& extinction : tracked_extinctions) {
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
      const double expected = std::exp(-double(extinction[lane]) * integral_to(tracked_to));
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
  for (const Spectrum& extinction : tracked_extinctions)
    for (const int lane : {0, 1}) {
      std::vector<double> hits(bins + 1, 0.0), expected(bins + 1, 0.0);
      for (int i = 0; i < tracked_count; ++i) {
        Sampler numbers = numbers_of_try(83, i);
        const float depth = -std::log1p(-numbers.next_1d());
        const TrackedFlight flight =
            tracked_flight(crossing_of_all(), extinction, lane, depth, numbers);
        const float share = flight.distance / tracked_to;
        ASSERT_LE(share, 1);
        hits[size_t(flight.collided ? std::min(int(share * bins), bins - 1) : bins)] += 1;
      }
      const auto left = [&](int i) {
        return std::exp(-double(extinction[lane]) * integral_to(tracked_to * float(i) / bins));
      };
      for (int i = 0; i < bins; ++i) expected[size_t(i)] = tracked_count * (left(i) - left(i + 1));
      expected[bins] = tracked_count * left(bins);
      EXPECT_GT(chi_square_p_value(hits, expected), tracked_level) << extinction[lane];
      // A medium as much denser is told from this one.
      const double denser = double(extinction[lane]) * (1 + 6 * planted_tracking_error);
      const auto other = [&](int i) {
        return std::exp(-denser * integral_to(tracked_to * float(i) / bins));
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
  for (const Spectrum& extinction : tracked_extinctions) {
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
      const double left = std::exp(-double(extinction[k]) * integral_to(tracked_to));
      if (left < 1e-3) {
        EXPECT_NEAR(collided[size_t(k)].mean(), 1, 2e-3) << extinction[k];
        continue;
      }
      EXPECT_GT(z_test_p_value(collided[size_t(k)], 1 - left), tracked_level) << extinction[k];
      EXPECT_GT(z_test_p_value(passed[size_t(k)], left), tracked_level) << extinction[k];
      if (passed[size_t(k)].standard_error() > 0.005 * left) continue;
      EXPECT_LT(z_test_p_value(passed[size_t(k)], left * (1 + planted_tracking_error)),
                tracked_level);
    }
  }
}

/// The box and nothing else takes light, and where bounds tell all nothing is left to chance.
TEST(GridTracking, AnEvenGridHasNoNoise) {
  const GridVolume even({{200, 1, 1}, 1, std::vector<float>(200, 0.5f), {}},
                        GridVolume::Filter::trilinear, GridVolume::Wrap::clamp, Transform());
  for (int i = 0; i < 100; ++i) {
    const Spectrum left = tracked_transmittance({even, {-3, 0.5f, 0.5f}, {1, 0, 0}, infinity},
                                                Spectrum(8), numbers_of_try(85, i));
    EXPECT_NEAR(left[0], std::exp(-4.0), 1e-6);
    EXPECT_EQ(tracked_transmittance({even, {2, 0.5f, 0.5f}, {1, 0, 0}, infinity}, Spectrum(2),
                                    numbers_of_try(85, i)),
              Spectrum(1));
  }
}

/// Where densities are their bounds, rounding must not make light negative; far away from where the
/// line begins, and on lines in faces of regions, it is crossed as well.
TEST(GridTracking, OfDensitiesThatAreBoundsNothingIsNegative) {
  VolumeSamples samples{{64, 64, 1}, 1, {}, {}};
  for (uint64_t i = 0; i < 64 * 64; ++i)
    samples.values.push_back(Sampler(hash_mix(86, i), 0).next_1d() < 0.5f ? 0.0f : 0.3f);
  const GridVolume grid(samples, GridVolume::Filter::nearest, GridVolume::Wrap::repeat,
                        Transform());
  for (const Vec3f& from :
       {Vec3f(-0.5f, 0.3f, 0.5f), Vec3f(-1000, 0.4f, 0.5f), Vec3f(-0.5f, 0.25f, 0.5f)}) {
    const double expected = std::exp(-7.3 * double(grid.integral(from, {1, 0, 0}, 0, infinity)));
    RunningStatistics found;
    for (int i = 0; i < tracked_count; ++i) {
      const Spectrum left = tracked_transmittance({grid, from, {1, 0, 0}, infinity}, Spectrum(7.3f),
                                                  numbers_of_try(87, i));
      ASSERT_GE(left[0], 0);
      found.add(double(left[0]));
    }
    EXPECT_GT(z_test_p_value(found, expected), tracked_level);
    EXPECT_LT(z_test_p_value(found, expected * (1 + planted_tracking_error)), tracked_level);
  }
}

}  // namespace
}  // namespace kaustik
