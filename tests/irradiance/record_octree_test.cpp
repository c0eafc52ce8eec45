#include "kaustik/irradiance/record_octree.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/irradiance/neighbor_clamping.h"
#include "kaustik/irradiance/spaced_subset.h"

namespace kaustik {
namespace {

constexpr float tolerance = 0.3f;

/// Random records near the unit sphere, `clustered` all at nearly one place; half of them serve
/// less far in one direction.
std::vector<CacheRecord> random_records(uint32_t count, bool clustered) {
  std::vector<CacheRecord> records(count);
  for (uint32_t i = 0; i < count; ++i) {
    Sampler s = Sampler::at(1, 0, Stream::training, i, 0);
    CacheRecord& r = records[i];
    r.normal = square_to_sphere(clustered ? s.next_2d() * 0.05f : s.next_2d());
    r.position = clustered ? Vec3f(s.next_1d(), s.next_1d(), s.next_1d()) * 1e-3f : r.normal;
    r.reach = 0.01f + 0.3f * std::pow(s.next_1d(), 3.0f);
    if (i % 2 == 0) {
      const float aspect = 1 + 4 * s.next_1d();
      const Vec3f axis = Frame(r.normal).to_world(Vec3f(0.6f, 0.8f, 0));
      r.squeeze = axis * (std::sqrt(sqr(aspect) - 1) / r.reach);
    }
    r.turning = i % 3 == 0 ? 4.0f : 1.0f;
    r.pixel_width = float(i % 4);
    r.irradiance = Spectrum(1 + s.next_1d(), s.next_1d(), 0, 0);
    for (int axis = 0; axis < 3; ++axis) {
      r.per_metre[axis] = Spectrum(s.next_1d() - 0.5f);
      r.per_normal[axis] = Spectrum(s.next_1d() - 0.5f);
    }
  }
  return records;
}

double sqr_of(double x) { return x * x; }

/// The definition in the header, record by record.
struct BruteForce {
  double best = infinity;  // ε²
  double weight = 0, lane0 = 0;
  double least = infinity, greatest = -infinity;  // of the lane

  BruteForce(const std::vector<CacheRecord>& records, const Vec3f& p, const Vec3f& n, double limit,
             double pixel_width) {
    for (const CacheRecord& r : records) {
      if (dot(n, r.normal) <= 0) continue;
      const Vec3f d = p - r.position;
      const double height = 0.5 * double(dot(d, n + r.normal));
      const double factor = height < 0 ? 10 : 3;
      const double minor_sq = 1 / (1 / double(sqr(r.reach)) + double(length_sq(r.squeeze)));
      const double narrower =
          pixel_width > 0 ? std::max(1.0, double(r.pixel_width) / (2 * pixel_width)) : 1.0;
      const double error_sq =
          sqr_of(narrower) * (double(length_sq(d)) / double(sqr(r.reach)) +
                              double(sqr(dot(d, r.squeeze))) + sqr_of(factor * height) / minor_sq) +
          double(r.turning) * (1 - double(dot(n, r.normal))) / double(sqr(tolerance));
      best = std::min(best, error_sq);
      if (error_sq >= limit * limit) continue;
      const double w = std::pow(1 - error_sq / (limit * limit), 2);
      weight += w;
      const auto value = double(r.extrapolate(d, n)[0]);
      lane0 += w * value;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
  }
};

void compare_with_brute_force(const std::vector<CacheRecord>& records, float scale) {
  const RecordOctree octree(records, tolerance);
  int hits = 0, served = 0;
  for (uint32_t i = 0; i < 300; ++i) {
    Sampler s = Sampler::at(2, 0, Stream::training, i, 0);
    const Vec3f n = square_to_sphere(s.next_2d());
    const Vec3f p = n * (scale * (0.97f + 0.06f * s.next_1d()));
    const float pixel = i % 3 == 0 ? 0.0f : 0.7f;
    for (const float relax : {1.0f, 1.5f, 4.0f}) {
      const BruteForce expected(records, p, n, double(relax * RecordOctree::overlap),
                                double(pixel));
      Spectrum e;
      const bool hit = octree.interpolate(p, n, relax, e, pixel);
      if (expected.weight > 1e-8) {
        hits += hit;
        if (relax == 1) {
          ASSERT_TRUE(hit);
          EXPECT_NEAR(e[0], std::max(0.0, expected.lane0 / expected.weight), 2e-4);
        } else if (hit) {  // of the widened records not all have to take part
          EXPECT_GE(e[0], std::max(0.0, expected.least) - 2e-4);
          EXPECT_LE(e[0], std::max(0.0, expected.greatest) + 2e-4);
        }
        EXPECT_GE(e[2], 0);
      } else if (expected.weight == 0) {
        EXPECT_FALSE(hit);
      }
      if (std::fabs(expected.best - 1) > 1e-4) {
        EXPECT_EQ(octree.serves(p, n, 1, pixel), expected.best < 1);
      }
      if (std::fabs(expected.best - 2) > 1e-4) {
        EXPECT_EQ(octree.serves(p, n, std::sqrt(2.0f), pixel), expected.best < 2);
      }
    }
    served += octree.serves(p, n, 1, pixel);
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(served, 10);
  EXPECT_LT(served, 300);
}

TEST(record_octree, agrees_with_brute_force) {
  compare_with_brute_force(random_records(3000, false), 1);
}

TEST(record_octree, agrees_with_brute_force_on_a_cluster) {
  compare_with_brute_force(random_records(500, true), 1e-3f);
}

TEST(record_octree, without_records_serves_nothing) {
  const RecordOctree octree;
  Spectrum e;
  EXPECT_FALSE(octree.serves({0, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(octree.interpolate({0, 0, 0}, {0, 0, 1}, 1, e));
  EXPECT_FALSE(octree.interpolate({0, 0, 0}, {0, 0, 1}, 3, e));
  EXPECT_FALSE(RecordOctree({}, tolerance).interpolate({0, 0, 0}, {0, 0, 1}, 1, e));
}

TEST(record_octree, a_point_that_is_no_number_finds_nothing) {
  const RecordOctree octree(random_records(100, false), tolerance);
  Spectrum e;
  const float nan = std::nanf("");
  for (const float relax : {1.0f, 2.0f}) {
    EXPECT_FALSE(octree.interpolate({nan, 0, 0}, {0, 0, 1}, relax, e));
    EXPECT_FALSE(octree.interpolate({0, 0, 1}, {nan, 0, 1}, relax, e));
    EXPECT_FALSE(octree.interpolate({infinity, 0, 1}, {0, 0, 1}, relax, e));
  }
}

TEST(neighbor_clamping, keeps_the_slope_below_one_and_takes_no_more) {
  const auto records = random_records(503, false);
  const auto distance = [](const CacheRecord& r) { return r.reach > 0.2f ? infinity : r.reach; };
  std::vector<NeighborClamping::Site> sites;
  for (const CacheRecord& r : records) sites.push_back({r.position, r.normal, distance(r)});
  const NeighborClamping clamping(sites);
  int lowered = 0;
  for (const CacheRecord& r : records) {
    float expected = distance(r);
    for (const CacheRecord& other : records)
      if (dot(r.normal, other.normal) >= 0)
        expected = std::min(expected, distance(other) + length(r.position - other.position));
    EXPECT_EQ(clamping.clamped(r.position, r.normal, distance(r)), expected);
    lowered += expected < distance(r);
  }
  EXPECT_GT(lowered, 100);
  EXPECT_EQ(NeighborClamping({}).clamped({0, 0, 0}, {0, 0, 1}, 3), 3);
}

TEST(spaced_subset, keeps_apart_and_leaves_no_gaps) {
  for (const float spacing : {0.07f, 0.125f, 0.3f}) {
    SpacedSubset subset;
    std::vector<Vec3f> picked;
    for (uint32_t i = 0; i < 2000; ++i) {
      Sampler s = Sampler::at(5, 0, Stream::training, i, 0);
      const Vec2f xy = s.next_2d();
      const Vec3f p(xy.x - 0.5f, xy.y - 0.5f, 0.3f * xy.x);
      float nearest = infinity;
      for (const Vec3f& q : picked) nearest = std::min(nearest, length(p - q));
      const bool taken = subset.pick(p, {0.1f, 0.2f, 1}, spacing);
      EXPECT_EQ(taken, nearest >= spacing);
      if (taken) picked.push_back(p);
    }
    // Other directions and much finer spacings don't mind.
    EXPECT_FALSE(subset.pick(picked[0], {0, 0, 1}, spacing));
    EXPECT_TRUE(subset.pick(picked[0], {0, 0, -1}, spacing));
    EXPECT_TRUE(subset.pick(picked[0], {0, 0, 1}, spacing / 8));
  }
}

}  // namespace
}  // namespace kaustik
